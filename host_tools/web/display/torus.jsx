// SPDX-License-Identifier: MIT
// Loads of PEs and links enter, many times a second; the map of the torus leaves, and the figures of the PE chosen.
import { useRef, useState } from "preact/hooks";
import { css, hexColour, themeColour } from "../shared/colours.js";
import { grouped, percent } from "../shared/format.js";
import { ColourScale, TorusMap } from "../shared/torus_map.jsx";
import { kLinkDirections, phaseWords, word } from "../shared/words.js";
import { useFeed } from "./use_feed.js";

const kInterval = 66; // [ms]
const kIntervalOfMany = 150;
const kManyPes = 256;
const kNoPhase = 255;
const kLeastScale = 0.001;
const kFading = 0.98; // of the links' scale, from look to look

const kFigures = { load: "how busy they are", phase: "what they do" };

function phaseColour(phase) {
  return hexColour(themeColour(phase === kNoPhase ? "w4" : `s${phase % 9}`));
}

function PhaseLegend({ phases, words }) {
  const named = phases.map((name, i) => [name, i]).filter(([name]) => name !== null);
  const parts = [...named.map(([name, i]) => [word(words, name), i]), ["waiting", kNoPhase]];
  return (
    <ul class="legend">
      {parts.map(([name, phase]) => (
        <li><span class="swatch" style={{ background: css(phaseColour(phase)) }} />{name}</li>
      ))}
    </ul>
  );
}

function PeDetails({ feed, pe }) {
  const { loads, machine } = feed;
  const phase = loads.phases[pe];
  const rows = [
    ["busy", percent(loads.values[pe])],
    ["with", phase === kNoPhase ? "nothing: it waits" : word(phaseWords(machine.what), machine.phases[phase] ?? `phase ${phase}`)],
    ...kLinkDirections.map((one) => [`link to the ${one}`, percent(loads.links[one][pe])]),
  ];
  return (
    <div class="pe-details">
      <h3>PE {pe} (column {pe % machine.columns}, row {Math.floor(pe / machine.columns)})</h3>
      <table><tbody>{rows.map(([name, value]) => <tr><td>{name}</td><td>{value}</td></tr>)}</tbody></table>
    </div>
  );
}

/** overlay: gives TorusMap's; onPick: likewise. children: what else belongs to the map. */
export function Torus({ feed, overlay, onPick, children }) {
  const { loads, machine } = feed;
  useFeed(feed, loads.pes > kManyPes ? kIntervalOfMany : kInterval);
  const [chosen, setChosen] = useState(0);
  const [figure, setFigure] = useState("load");
  const linkMost = useRef(kLeastScale);
  const most = Math.max(...kLinkDirections.map((one) => loads.links[one].reduce((a, b) => Math.max(a, b), 0)));
  linkMost.current = Math.max(kLeastScale, most, kFading * linkMost.current);
  const mean = loads.values.reduce((a, b) => a + b, 0) / loads.pes;
  return (
    <section id="torus">
      <h2>The torus</h2>
      <div class="choices">
        <label class="choice">
          PEs by{" "}
          <select id="pe-figure" value={figure} onChange={(event) => setFigure(event.target.value)}>
            {Object.entries(kFigures).map(([key, name]) => <option value={key}>{name}</option>)}
          </select>
        </label>
        <span class="soft" id="torus-now">
          busy {percent(mean)} on average; {grouped(loads.packets ?? 0)} packets on the way
        </span>
      </div>
      <div class="map">
        <div>
          <TorusMap columns={machine.columns} rows={machine.rows} values={loads.values} most={1} links={loads.links}
            linkMost={linkMost.current} chosen={Math.min(chosen, loads.pes - 1)} onChoose={setChosen} onPick={onPick} overlay={overlay?.()}
            peColour={figure === "phase" ? (pe) => phaseColour(loads.phases[pe]) : undefined}
            label={`PEs by ${kFigures[figure]}, links by traffic`} />
          {figure === "load" ? <ColourScale name="PEs: busy" most={percent(1)} /> : <PhaseLegend phases={machine.phases} words={phaseWords(machine.what)} />}
          <ColourScale name="links: used" most={percent(linkMost.current)} />
        </div>
        <PeDetails feed={feed} pe={Math.min(chosen, loads.pes - 1)} />
      </div>
      {children}
    </section>
  );
}
