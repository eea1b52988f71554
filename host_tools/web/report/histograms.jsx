// SPDX-License-Identifier: MIT
// Histograms of a stage: hops, latency, records in a packet; subspaces that light and rays went through.
import { BarChart } from "../shared/charts.jsx";
import { percent, short } from "../shared/format.js";
import { stageName } from "../shared/words.js";

/** counts -> bars without the empty end, in percent of all. name: of the class i. */
function barsOf(counts, what, name = String) {
  const all = counts.reduce((total, count) => total + count, 0);
  if (all === 0) return [];
  let end = counts.length;
  while (counts[end - 1] === 0) --end;
  return counts.slice(0, end).map((count, i) => ({
    name: name(i),
    value: (100 * count) / all,
    tip: `${name(i)}: ${short(count)} ${what}, ${percent(count / all)}`,
  }));
}

function latencyClass(i) {
  return i === 0 ? "0" : short(2 ** (i - 1)).replace(/\s/g, "");
}

function visitCharts(visits) {
  return Object.entries(visits ?? {})
    .filter(([, counts]) => counts)
    .map(([stage, counts]) => ({
      title: `Subspaces that a path segment goes through, ${stageName(stage)}`,
      xLabel: "subspaces", yLabel: "of segments [%]",
      bars: barsOf(counts, "segments", (i) => (i === 63 ? "63+" : String(i))),
    }));
}

export function Histograms({ view }) {
  const { histograms } = view;
  const charts = [
    { title: "Links that a packet crosses", xLabel: "hops", yLabel: "of packets [%]", bars: barsOf(histograms.packets_by_hops, "packets") },
    { title: "A packet's time on its way", xLabel: "latency, from [cycles] up to twice that", yLabel: "of packets [%]", bars: barsOf(histograms.packets_by_latency, "packets", latencyClass) },
    { title: "Records in a packet", xLabel: "records", yLabel: "of packets [%]", bars: barsOf(histograms.packets_by_records, "packets") },
    ...visitCharts(view.visits),
  ].filter((chart) => chart.bars.length > 0);
  return (
    <section id="histograms">
      <h2>Histograms: {view.title}</h2>
      {charts.length === 0 && <p>No packet was sent in this stage.</p>}
      <div class="grid">{charts.map((chart) => <BarChart {...chart} />)}</div>
    </section>
  );
}
