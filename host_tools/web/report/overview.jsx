// SPDX-License-Identifier: MIT
// The picture, the machine in words, and the run's main figures.
import { bytes, grouped, percent, seconds, short, significant } from "../shared/format.js";
import { clockHertz } from "./data.js";

function machineText({ settings, copies }) {
  const [columns, rows] = settings.pes;
  const machine = settings.machine;
  const sentences = [
    `A torus of ${columns} \u00d7 ${rows} PEs, ${grouped(columns * rows)} in all, each a RISC-V processor of ${significant(machine.processor.clock_hertz / 1e6)} MHz with ${bytes(settings.pe_memory)} of its own memory.`,
  ];
  if (settings.subspaces) {
    const scheme = settings.scheme === "paper" ? "Light is shared out as the paper has it (scheme paper)" : `Scene and work are shared out by scheme ${settings.scheme}`;
    sentences.push(`Space is cut into ${settings.subspaces.join(" \u00d7 ")} subspaces, ${copies ? `${grouped(copies.of_subspaces)} of them with anything in them, ` : ""}each of which belongs to one PE (allocation ${settings.allocation}). ${scheme}.`);
  }
  sentences.push(`PEs talk over links of ${machine.torus.flit_bytes} bytes per flit, and with the host and the frame buffer over one bus.`);
  return sentences.join(" ");
}

function tiles(statistics) {
  const hertz = clockHertz(statistics);
  const total = statistics.virtual_cycles.total;
  const pes = statistics.settings.pes[0] * statistics.settings.pes[1];
  const list = [
    ["virtual time", seconds(total / hertz), `${short(total)} cycles`],
    ["PEs busy", percent(statistics.busy_cycles / pes / total), "on average"],
    ["packets", short(statistics.packets.delivered), `${significant(statistics.hops.mean)} hops on average`],
  ];
  if (statistics.rays !== undefined) list.push(["camera rays", short(statistics.rays), `${statistics.settings.samples} per pixel`]);
  if (statistics.shots) list.push(["patches shot", short(statistics.shots), `${statistics.rounds.length} rounds`]);
  if (statistics.records.created) list.push(["records", short(statistics.records.created), `${short(statistics.records.diverted)} diverted`]);
  return list;
}

/** Small pictures are shown larger, their pixels as squares [pixels]. */
const kLeastWidth = 320;

export function Overview({ data }) {
  const { statistics, picture } = data;
  return (
    <section id="overview" class={picture ? "with-picture" : ""}>
      {picture && (
        <figure class="picture">
          <img src={picture.png} style={{ width: `${Math.max(kLeastWidth, picture.shown_width)}px` }} alt={`The picture of ${data.title}`} />
          <figcaption>
            {picture.width} × {picture.height} pixels{picture.shown_width < picture.width ? `, shown at ${picture.shown_width} × ${picture.shown_height}` : ""}
          </figcaption>
        </figure>
      )}
      <div>
        <h2>The machine</h2>
        <p>{machineText(statistics)}</p>
        <dl class="tiles">
          {tiles(statistics).map(([name, value, more]) => (
            <div><dt>{name}</dt><dd>{value}</dd><dd class="soft">{more}</dd></div>
          ))}
        </dl>
        <p class="soft">
          Times are virtual: of the machine's own clocks, the same for every repetition of this run. On the computer that
          emulated it, it took {seconds(statistics.wall_seconds)}.
        </p>
      </div>
    </section>
  );
}
