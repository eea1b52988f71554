// SPDX-License-Identifier: MIT
// Where cycles go, by call path: the profile of a run enters, a flame graph leaves, by mouse, keys and touch.
import { useMemo, useState } from "preact/hooks";
import { useWidth } from "../shared/charts.jsx";
import { grouped, percent } from "../shared/format.js";
import { ancestors, cyclesOf, isWait, layOut, neighbour, treeOf } from "./call_tree.js";

const kRow = 22; // [pixels]
const kLeast = 0.7;
const kLetter = 6.6; // about, of a frame's text
const kColours = 9; // s0 .. s8 of the theme

/** The same for a function wherever it is. */
function colourOf(profile, path) {
  if (path.parent === null) return "w4";
  if (isWait(profile, path.name)) return `w${path.name}`;
  let hash = 0;
  for (const letter of profile.names[path.name]) hash = (hash * 31 + letter.charCodeAt(0)) % 65521;
  return `s${hash % kColours}`;
}

function nameOf(profile, path) {
  return path.parent === null ? "all" : profile.names[path.name];
}

function fitting(name, width) {
  const letters = Math.floor((width - 8) / kLetter);
  if (letters < 3) return "";
  return name.length <= letters ? name : `${name.slice(0, letters - 1)}\u2026`;
}

function Frame({ profile, frame, chosen, found, onChoose, onZoom }) {
  const { path, x, width, row } = frame;
  const name = nameOf(profile, path);
  const faint = frame.above || (found && !found(path));
  return (
    <g class={`frame${faint ? " faint" : ""}${path === chosen ? " chosen" : ""}`} transform={`translate(${x} ${row * kRow})`}
      onMouseEnter={() => onChoose(path)} onClick={() => onZoom(path)}>
      <title>{name}</title>
      <rect class="under" width={Math.max(0.5, width - 1)} height={kRow - 2} rx="2" />
      <rect class="over" width={Math.max(0.5, width - 1)} height={kRow - 2} rx="2" style={{ fill: `var(--${colourOf(profile, path)})` }} />
      <text x="4" y={kRow / 2 + 3}>{fitting(name, width)}</text>
    </g>
  );
}

function Details({ profile, path, all }) {
  const rows = [
    ["of all", `${percent(path.total / all.total)}, ${grouped(path.total)} cycles`],
    ["itself", `${percent(path.self / all.total)}, ${grouped(path.self)} cycles`],
    ["of its caller", path.parent ? percent(path.total / path.parent.total) : "\u2013"],
    ["calls", path.parent && !isWait(profile, path.name) ? grouped(path.calls) : "\u2013"],
  ];
  return (
    <div class="flame-details" aria-live="polite">
      <p class="flame-path">
        {ancestors(path).slice(1).map((one) => <span class="soft">{nameOf(profile, one)} {"\u203a"} </span>)}
        <strong>{nameOf(profile, path)}</strong>
      </p>
      <dl>{rows.map(([name, value]) => <div><dt>{name}</dt><dd>{value}</dd></div>)}</dl>
    </div>
  );
}

function whose(profile) {
  return profile.pes === 1 ? "one PE" : `${grouped(profile.pes)} PEs together`;
}

export function FlameGraph({ profile }) {
  const [box, width] = useWidth();
  const paths = useMemo(() => treeOf(profile), [profile]);
  const [root, setRoot] = useState(paths[0]);
  const [chosen, setChosen] = useState(paths[0]);
  const [text, setText] = useState("");
  const frames = useMemo(() => layOut(paths, root, width, kLeast), [paths, root, width]);
  const wanted = text.toLowerCase();
  const found = wanted === "" ? null : (path) => nameOf(profile, path).toLowerCase().includes(wanted);
  const rows = frames.reduce((most, frame) => Math.max(most, frame.row + 1), 1);
  const zoom = (path) => {
    setRoot(path);
    setChosen(path);
  };
  const key = (event) => {
    const next = neighbour(chosen, event.key);
    if (next) setChosen(next);
    else if (event.key === "Enter" || event.key === " ") zoom(chosen);
    else if (event.key === "Escape") zoom(root.parent ?? root);
    else if (!event.key.startsWith("Arrow")) return;
    event.preventDefault();
  };
  return (
    <section id="profile">
      <h2>Where the cycles go, by call path</h2>
      <p class="soft">
        {grouped(paths[0].total)} cycles of {whose(profile)}, until each had ended. As wide as its cycles: a function stands under its
        caller, what it waits for under it. Click, or Enter, to look closer; arrow keys go from one to the next, Escape back.
      </p>
      <div class="choices">
        <label class="choice">Find <input id="flame-find" type="search" value={text} onInput={(event) => setText(event.target.value)} /></label>
        {found && <span class="soft" aria-live="polite">{percent(cyclesOf(paths, found) / paths[0].total)} of all cycles</span>}
        {root !== paths[0] && <button id="flame-all" onClick={() => zoom(paths[0])}>Show all</button>}
      </div>
      <div ref={box} class="flame" tabIndex="0" role="group" aria-label="Flame graph; arrow keys move, Enter looks closer" onKeyDown={key}>
        {width > 0 && (
          <svg width={width} height={rows * kRow} aria-hidden="true">
            {frames.map((frame) => (
              <Frame key={frame.path.index} profile={profile} frame={frame} chosen={chosen} found={found} onChoose={setChosen} onZoom={zoom} />
            ))}
          </svg>
        )}
      </div>
      <Details profile={profile} path={chosen} all={paths[0]} />
      {profile.left_out > 0 && <p class="soft">Paths of less than {percent(profile.left_out)} each are left out here.</p>}
    </section>
  );
}
