// SPDX-License-Identifier: MIT
// Maps of the torus: a figure of each PE and of each link, by choice; beside it all figures of the PE that is chosen.
import { useMemo, useState } from "preact/hooks";
import { grouped, percent, short } from "../shared/format.js";
import { ColourScale, TorusMap } from "../shared/torus_map.jsx";
import { kLinkDirections, kWaits, word } from "../shared/words.js";
import { greatest, peName } from "./data.js";

/** By key: [group, name, value of a PE, whether it is a share of its time]. */
function peFigures(view) {
  const list = { busy: ["Load", "busy", (pe) => pe.busy_cycles, true] };
  for (const key of Object.keys(view.phases)) {
    if (view.phases[key] > 0) list[`phase ${key}`] = ["Busy, by phase", word(view.words, key), (pe) => pe.phase_cycles[key], true];
  }
  for (const key of Object.keys(view.waits)) list[`wait ${key}`] = ["Waiting", word(kWaits, key), (pe) => pe.waits[key], true];
  list["wait end"] = ["Waiting", kWaits.idle_at_end, (pe) => pe.idle_at_end, true];
  list.sent = ["Counts", "packets sent", (pe) => pe.packets_sent, false];
  list.delivered = ["Counts", "packets delivered", (pe) => pe.packets_delivered, false];
  list.diverted = ["Counts", "records diverted", (pe) => pe.records_diverted, false];
  list.instructions = ["Counts", "instructions", (pe) => pe.instructions, false];
  list.slots = ["Counts", "record slots, most in use at once", (pe) => pe.record_slots_high_water, false];
  return list;
}

const kLinkFigures = {
  busy: ["links: busy", (link) => link.busy_cycles, true],
  stalled: ["links: stalled, no room at the other end", (link) => link.stalled_cycles, true],
  packets: ["links: packets", (link) => link.packets, false],
};

function Choice({ id, label, value, onChange, groups }) {
  return (
    <label class="choice">
      {label}{" "}
      <select id={id} value={value} onChange={(event) => onChange(event.target.value)}>
        {groups.map(([name, options]) =>
          name ? (
            <optgroup label={name}>{options.map(([key, text]) => <option value={key}>{text}</option>)}</optgroup>
          ) : (
            options.map(([key, text]) => <option value={key}>{text}</option>)
          ),
        )}
      </select>
    </label>
  );
}

function PeDetails({ view, pe, columns }) {
  const figures = view.pes[pe];
  const share = (cycles) => percent(figures.cycles > 0 ? cycles / figures.cycles : 0);
  const phases = Object.entries(figures.phase_cycles).filter(([, cycles]) => cycles > 0);
  const rows = [
    ["busy", share(figures.busy_cycles)],
    ...phases.map(([key, cycles]) => [`\u2003${word(view.words, key)}`, share(cycles)]),
    ...Object.entries(figures.waits).map(([key, cycles]) => [word(kWaits, key), share(cycles)]),
    [kWaits.idle_at_end, share(figures.idle_at_end)],
    ["packets sent", grouped(figures.packets_sent)],
    ["packets delivered", grouped(figures.packets_delivered)],
    ["records diverted", grouped(figures.records_diverted)],
    ...kLinkDirections.map((direction) => [`link to the ${direction}, busy`, percent(view.links[pe][direction].busy_cycles / view.cycles)]),
  ];
  return (
    <div class="pe-details" aria-live="polite">
      <h3>{peName(pe, columns)}</h3>
      <table><tbody>{rows.map(([name, value]) => <tr><td>{name}</td><td>{value}</td></tr>)}</tbody></table>
    </div>
  );
}

export function Maps({ view, statistics }) {
  const [columns, rows] = statistics.settings.pes;
  const [figure, setFigure] = useState("busy");
  const [linkFigure, setLinkFigure] = useState("busy");
  const figures = useMemo(() => peFigures(view), [view]);
  const known = figures[figure] ? figure : "busy";
  const [, name, take, isShare] = figures[known];
  const values = useMemo(() => view.pes.map((pe) => (isShare ? (pe.cycles > 0 ? take(pe) / pe.cycles : 0) : take(pe))), [view, known]);
  const [linkName, takeLink, linkIsShare] = kLinkFigures[linkFigure];
  const links = useMemo(
    () => Object.fromEntries(kLinkDirections.map((one) => [one, view.links.map((pe) => takeLink(pe[one]) / (linkIsShare ? view.cycles : 1))])),
    [view, linkFigure],
  );
  // Until one is chosen, the one with the most.
  const [wanted, setWanted] = useState(null);
  const chosen = wanted ?? greatest(values);
  const most = values[greatest(values)];
  const mean = values.reduce((all, value) => all + value, 0) / values.length;
  const linkMost = Math.max(...kLinkDirections.map((one) => links[one][greatest(links[one])]));
  const text = (value, shared) => (shared ? percent(value) : short(value));
  const groups = [...new Set(Object.values(figures).map(([group]) => group))].map((group) => [
    group,
    Object.entries(figures).filter(([, one]) => one[0] === group).map(([key, one]) => [key, one[1]]),
  ]);
  return (
    <section id="map">
      <h2>Map of the torus: {view.title}</h2>
      <div class="choices">
        <Choice id="pe-figure" label="PEs" value={known} onChange={setFigure} groups={groups} />
        <Choice id="link-figure" label="Links" value={linkFigure} onChange={setLinkFigure}
          groups={[["", Object.entries(kLinkFigures).map(([key, [text_]]) => [key, text_.replace("links: ", "")])]]} />
      </div>
      <div class="map">
        <div class="map-left">
          <TorusMap columns={columns} rows={rows} values={values} most={most} links={links} linkMost={linkMost}
            chosen={chosen} onChoose={setWanted} label={`PEs: ${name}; ${linkName}`} />
          <ColourScale name={`PEs: ${name}`} most={text(most, isShare) + (isShare ? " of its time" : "")} />
          <ColourScale name={linkName} most={text(linkMost, linkIsShare) + (linkIsShare ? " of the time" : "")} />
          <p class="soft">
            Over all PEs: mean {text(mean, isShare)}, least {text(Math.min(...values), isShare)}, most {text(most, isShare)}, at {peName(greatest(values), columns)}.
            Each neighbour is reached by a line for each direction; those at the edge lead around to the other side.
          </p>
        </div>
        <PeDetails view={view} pe={chosen} columns={columns} />
      </div>
    </section>
  );
}
