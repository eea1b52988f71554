// SPDX-License-Identifier: MIT
// The time line: load, packets, bus, frame buffer, host, records in flight and unshot flux over virtual time. What is
// brushed in any chart, or chosen by the two handles, is shown in all.
import { useMemo } from "preact/hooks";
import { LineChart } from "../shared/charts.jsx";
import { seconds, short, significant, unitFor } from "../shared/format.js";
import { stageName } from "../shared/words.js";
import { clockHertz } from "./data.js";

/** Columns over slices; the last slice is shorter, and its end is a point of its own. */
function columnsOf({ time_line: line, virtual_cycles: cycles }, unit) {
  const total = cycles.total;
  const { slices, slice_cycles: width } = line;
  const length = (i) => Math.min(width, total - i * width);
  const column = (take) => {
    const values = slices.map((slice, i) => take(slice, length(i)));
    return [...values, values[values.length - 1]];
  };
  return {
    x: [...slices.map((_, i) => (i * width) / unit.size), total / unit.size],
    load: column((slice) => 100 * slice.load),
    packets: column((slice, cycles_) => (1000 * slice.packets) / cycles_),
    bus: column((slice, cycles_) => (100 * slice.bus_cycles) / cycles_),
    frame_buffer: column((slice, cycles_) => (100 * slice.frame_buffer_cycles) / cycles_),
    host: column((slice, cycles_) => (100 * slice.host_cycles) / cycles_),
    records: column((slice) => slice.records_in_flight),
    unshot: column((slice) => (slice.unshot > 0 ? 100 * slice.unshot : null)),
  };
}

function chartsOf(c) {
  const charts = [
    { key: "load", title: "Load of the PEs", yLabel: "busy, mean [%]", max: 100, series: [{ name: "busy [%]", values: c.load, area: true }], namedBands: true, height: 170 },
    { key: "packets", title: "Packets on the torus", yLabel: "per 1 000 cycles", series: [{ name: "packets delivered per 1 000 cycles", values: c.packets, colour: 1 }] },
    {
      key: "parts", title: "Bus, frame buffer and host", yLabel: "busy [%]", max: 100,
      series: [
        { name: "bus [%]", values: c.bus, colour: 0 },
        { name: "frame buffer [%]", values: c.frame_buffer, colour: 2, dash: [6, 3] },
        { name: "host [%]", values: c.host, colour: 3, dash: [2, 2] },
      ],
    },
  ];
  if (c.records.some((value) => value > 0)) {
    charts.push({ key: "records", title: "Records in flight", yLabel: "records, mean", series: [{ name: "records", values: c.records, colour: 4 }] });
  }
  if (c.unshot.some((value) => value !== null)) {
    charts.push({ key: "unshot", title: "Unshot flux", yLabel: "of the emitted [%]", log: true, series: [{ name: "unshot [%]", values: c.unshot, colour: 6 }] });
  }
  return charts;
}

/** Two handles over the whole run: reachable by keys, and by pointer. */
function Brush({ total, window: [from, to], onWindow }) {
  const steps = 1000;
  const position = (value) => Math.round((value / total) * steps);
  const set = (begin, end) => end > begin && onWindow([(begin / steps) * total, (end / steps) * total]);
  return (
    <div class="brush">
      <span class="chosen" style={{ left: `${(100 * from) / total}%`, right: `${100 - (100 * to) / total}%` }} />
      <input type="range" min="0" max={steps} value={position(from)} aria-label="Shown from"
        onInput={(event) => set(Number(event.target.value), position(to))} />
      <input type="range" min="0" max={steps} value={position(to)} aria-label="Shown to"
        onInput={(event) => set(position(from), Number(event.target.value))} />
    </div>
  );
}

/** shown: [from, to] in cycles. */
export function TimeLine({ statistics, shown, onShown }) {
  const total = statistics.virtual_cycles.total;
  const hertz = clockHertz(statistics);
  const unit = unitFor(total, "cycles");
  const charts = useMemo(() => chartsOf(columnsOf(statistics, unit)), [statistics]);
  const x = useMemo(() => columnsOf(statistics, unit).x, [statistics]);
  const bands = useMemo(
    () => statistics.stages.map((stage) => ({ name: stageName(stage.name), begin: stage.begin / unit.size, end: (stage.begin + stage.cycles) / unit.size })),
    [statistics],
  );
  const clamp = (value) => Math.min(total, Math.max(0, value));
  const brushed = ([from, to]) => onShown([clamp(from * unit.size), clamp(to * unit.size)]);
  return (
    <section id="time-line">
      <h2>Time line</h2>
      <div class="choices">
        <span id="shown">
          Shown: cycles {short(shown[0])} to {short(shown[1])}, {seconds((shown[1] - shown[0]) / hertz)} of {seconds(total / hertz)}
        </span>
        <button onClick={() => onShown([0, total])}>Show all</button>
      </div>
      <p class="soft">Drag over a chart, or move the handles, to look closer. A step is a slice of {short(statistics.time_line.slice_cycles)} cycles.</p>
      <Brush total={total} window={shown} onWindow={onShown} />
      {charts.map((chart) => (
        <LineChart {...chart} x={x} xLabel={`virtual time [${unit.unit}]`} window={[shown[0] / unit.size, shown[1] / unit.size]}
          onWindow={brushed} bands={bands} syncKey="time" xValue={(v) => `${significant(v, 4)} ${unit.unit}`} />
      ))}
    </section>
  );
}
