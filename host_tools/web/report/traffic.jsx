// SPDX-License-Identifier: MIT
// What a stage carried and what its host did: records by kind on the torus, the bus by kind, the host's work; copies of
// subspaces, and records that were diverted.
import { Bar } from "../shared/charts.jsx";
import { bytes, grouped, percent, short } from "../shared/format.js";
import { kBusKinds, kHostWork, kRecordKinds, stageName, word } from "../shared/words.js";

/** rows: [name, cells..., share]. */
function Table({ title, heads, rows }) {
  if (rows.length === 0) return null;
  return (
    <div>
      <h3>{title}</h3>
      <div class="scroll">
        <table>
          <thead><tr>{heads.map((head, i) => <th class={i === heads.length - 1 ? "words" : ""}>{head}</th>)}</tr></thead>
          <tbody>
            {rows.map((row) => (
              <tr>
                {row.slice(0, -1).map((cell) => <td>{cell}</td>)}
                <td><div class="share"><span>{percent(row[row.length - 1])}</span><Bar share={row[row.length - 1]} /></div></td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </div>
  );
}

export function Traffic({ view, statistics }) {
  const kinds = Object.entries(view.kinds ?? {}).filter(([, kind]) => kind.records > 0);
  const records = kinds.reduce((all, [, kind]) => all + kind.bytes, 0) || 1;
  const clocks = statistics.settings.machine.host.clock_hertz / statistics.settings.machine.processor.clock_hertz;
  return (
    <section id="traffic">
      <h2>Torus, bus and host: {view.title}</h2>
      <div class="grid">
        <Table title="Records on the torus" heads={["kind", "records", "packets", "payload", "of the bytes"]}
          rows={kinds.map(([key, kind]) => [word(kRecordKinds, key), short(kind.records), short(kind.packets), bytes(kind.bytes), kind.bytes / records])} />
        <Table title="The bus" heads={["what", "transfers", "payload", "of the time"]}
          rows={Object.entries(view.bus.kinds).filter(([, kind]) => kind.transfers > 0).map(([key, kind]) => [word(kBusKinds, key), short(kind.transfers), bytes(kind.bytes), kind.cycles / view.cycles])} />
        <Table title="The host" heads={["work", "items", "of the time"]}
          rows={Object.entries(view.host_processor.work).filter(([, work]) => work.items > 0).map(([key, work]) => [word(kHostWork, key), short(work.items), work.own_cycles / clocks / view.cycles])} />
      </div>
      <p class="soft">
        {grouped(view.packets.delivered)} packets were delivered; {grouped(view.records.diverted)} records were diverted through
        the host's memory, as their PE had no room; at most {grouped(view.frame_buffer.queue_high_water)} messages waited for the frame buffer.
      </p>
    </section>
  );
}

export function Copies({ copies }) {
  return (
    <section id="copies">
      <h2>Copies of subspaces</h2>
      <p>Of {grouped(copies.of_subspaces)} subspaces with anything in them, those where most happens may stand on every PE, so that nothing is handed over there.</p>
      <div class="scroll">
        <table>
          <thead><tr><th>stage</th><th>subspaces on every PE</th><th>of all</th><th>memory of each PE</th><th>of it</th><th>surfaces on one PE alone</th></tr></thead>
          <tbody>
            {["radiosity", "ray_tracing"].map((stage) => (
              <tr>
                <td>{stageName(stage)}</td>
                <td>{grouped(copies[stage].subspaces)}</td>
                <td>{percent(copies[stage].subspaces / Math.max(1, copies.of_subspaces))}</td>
                <td>{bytes(copies[stage].bytes)}</td>
                <td>{percent(copies[stage].fraction)}</td>
                <td>{grouped(copies[stage].kept_surfaces)}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </section>
  );
}
