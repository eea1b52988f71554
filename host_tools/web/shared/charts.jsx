// SPDX-License-Identifier: MIT
// Series of numbers enter; line charts (uPlot) that can be brushed, and bars, leave.
import { useEffect, useRef, useState } from "preact/hooks";
import uPlot from "uplot";
import { themeColour, useDark } from "./colours.js";
import { significant } from "./format.js";

/** A reference, and the width in pixels of the element that has it. */
export function useWidth() {
  const ref = useRef(null);
  const [width, setWidth] = useState(0);
  useEffect(() => {
    const watch = new ResizeObserver(([entry]) => setWidth(Math.floor(entry.contentRect.width)));
    watch.observe(ref.current);
    return () => watch.disconnect();
  }, []);
  return [ref, width];
}

function axis(label, more) {
  return {
    label,
    stroke: themeColour("soft"),
    labelFont: "12px system-ui, sans-serif",
    font: "11px system-ui, sans-serif",
    labelSize: 18,
    grid: { stroke: themeColour("grid"), width: 1 },
    ticks: { stroke: themeColour("line"), width: 1, size: 4 },
    ...more,
  };
}

/** Bands of the horizontal axis: [{begin, end, name}], every other one tinted. */
function drawBands(plot, bands, named) {
  const { ctx, bbox } = plot;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
  ctx.textBaseline = "top";
  ctx.textAlign = "left";
  bands.forEach((band, i) => {
    const from = Math.max(bbox.left, plot.valToPos(band.begin, "x", true));
    const to = Math.min(bbox.left + bbox.width, plot.valToPos(band.end, "x", true));
    if (to <= from) return;
    if (i % 2 === 1) {
      ctx.fillStyle = themeColour("band");
      ctx.fillRect(from, bbox.top, to - from, bbox.height);
    }
    if (named && ctx.measureText(band.name).width + 8 * devicePixelRatio < to - from) {
      ctx.fillStyle = themeColour("soft");
      ctx.fillText(band.name, from + 4 * devicePixelRatio, bbox.top + 3 * devicePixelRatio);
    }
  });
  ctx.restore();
}

/** Distances of ticks where there are only whole numbers. */
const kWholeSteps = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000];

function options(props, width, onSelect) {
  const { title, xLabel, yLabel, series, log, max, bands, syncKey, height = 150, xValue, points } = props;
  return {
    title,
    width,
    height,
    cursor: {
      drag: { x: Boolean(onSelect), y: false, setScale: false },
      sync: syncKey ? { key: syncKey, setSeries: false } : undefined,
      points: { size: 6 },
    },
    legend: { live: true },
    scales: {
      x: { time: false },
      y: log ? { distr: 3 } : { range: (_, __, most) => [0, max ?? (most > 0 ? most * 1.08 : 1)] },
    },
    axes: [
      axis(xLabel, { size: 30, incrs: props.whole ? kWholeSteps : undefined, values: (_, ticks) => ticks.map((v) => (v === null ? "" : significant(v, 6))) }),
      axis(yLabel, { size: 58, values: (_, ticks) => ticks.map((v) => (v === null ? "" : significant(v, 4))) }),
    ],
    series: [
      { label: xLabel.replace(/ \[.*/, ""), value: (_, v) => (v === null ? "-" : xValue ? xValue(v) : significant(v, 6)) },
      ...series.map((one, i) => ({
        label: one.name,
        stroke: themeColour(`s${one.colour ?? i}`),
        fill: one.area ? themeColour(`s${one.colour ?? i}`) + "33" : undefined,
        width: 1.5,
        dash: one.dash,
        points: { show: Boolean(points) && one.values.length < 80, size: 4 },
        paths: one.stepped === false ? undefined : uPlot.paths.stepped({ align: 1 }),
        value: (_, v) => (v === null || v === undefined ? "-" : significant(v, 4)),
      })),
    ],
    hooks: {
      drawClear: bands ? [(plot) => drawBands(plot, bands, props.namedBands)] : [],
      setSelect: onSelect
        ? [
            (plot) => {
              const { left, width: wide } = plot.select;
              if (wide < 4) return;
              onSelect([plot.posToVal(left, "x"), plot.posToVal(left + wide, "x")]);
              plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
            },
          ]
        : [],
    },
  };
}

/**
 * props: title, xLabel, yLabel (with units), x: numbers, series: [{name, values, colour?, area?, stepped?, dash?}],
 * whole: x are whole numbers, window: [from, to] shown, onWindow: called with what was brushed, log, max, bands, namedBands, syncKey, height.
 */
export function LineChart(props) {
  const dark = useDark();
  const [box, width] = useWidth();
  const plot = useRef(null);
  const brushed = useRef(null);
  brushed.current = props.onWindow;
  const { x, series, window: shown } = props;
  const data = [x, ...series.map((one) => one.values)];
  useEffect(() => {
    if (width === 0) return undefined;
    const select = props.onWindow ? (range) => brushed.current(range) : null;
    plot.current = new uPlot(options(props, width, select), data, box.current);
    return () => {
      plot.current.destroy();
      plot.current = null;
    };
  }, [dark, width > 0, props.title, series.map((one) => one.name).join()]);
  useEffect(() => {
    if (!plot.current) return;
    plot.current.setData(data);
    if (shown) plot.current.setScale("x", { min: shown[0], max: shown[1] });
  }, [dark, width > 0, x, series]);
  useEffect(() => {
    if (plot.current && width > 0) plot.current.setSize({ width, height: props.height ?? 150 });
  }, [width]);
  useEffect(() => {
    if (plot.current && shown) plot.current.setScale("x", { min: shown[0], max: shown[1] });
  }, [shown?.[0], shown?.[1]]);
  return <div class="chart" ref={box} role="img" aria-label={`${props.title}: ${props.yLabel} over ${props.xLabel}`} />;
}

/** Ticks of an axis from 0, five at most: numbers of the form 1, 2 or 5 times a power of ten. */
function ticksTo(most) {
  const raw = most / 4;
  const size = 10 ** Math.floor(Math.log10(raw));
  const step = size * [1, 2, 5, 10].find((factor) => factor * size >= raw * 0.999);
  const ticks = [];
  for (let v = 0; v <= most * 1.0001; v += step) ticks.push(v);
  return ticks;
}

/** props: title, xLabel, yLabel, bars: [{name, value, tip}] with values >= 0, height. */
export function BarChart({ title, xLabel, yLabel, bars, height = 190 }) {
  const [box, width] = useWidth();
  const left = 52;
  const bottom = 40;
  const top = 8;
  const most = Math.max(...bars.map((bar) => bar.value), 1e-12) * 1.05;
  const wide = Math.max(1, (width - left - 6) / bars.length);
  const y = (value) => top + (height - top - bottom) * (1 - value / most);
  const every = Math.ceil((Math.max(...bars.map((bar) => bar.name.length)) * 6.5 + 6) / wide);
  return (
    <figure class="bars">
      <figcaption>{title}</figcaption>
      <div ref={box}>
        {width > 0 && (
          <svg width={width} height={height} role="img" aria-label={`${title}: ${yLabel} over ${xLabel}`}>
            {ticksTo(most).map((tick) => (
              <g>
                <line x1={left} x2={width - 6} y1={y(tick)} y2={y(tick)} stroke="var(--grid)" />
                <text x={left - 5} y={y(tick) + 4} text-anchor="end">{significant(tick, 3)}</text>
              </g>
            ))}
            {bars.map((bar, i) => (
              <g>
                <rect class="column" x={left + i * wide + wide * 0.08} width={wide * 0.84} y={y(bar.value)}
                  height={Math.max(0, y(0) - y(bar.value))} fill="var(--s0)">
                  <title>{bar.tip}</title>
                </rect>
                {i % every === 0 && (
                  <text x={left + (i + 0.5) * wide} y={height - bottom + 14} text-anchor="middle">{bar.name}</text>
                )}
              </g>
            ))}
            <line x1={left} x2={width - 6} y1={y(0)} y2={y(0)} stroke="var(--line)" />
            <text x={(left + width) / 2} y={height - 5} text-anchor="middle">{xLabel}</text>
            <text transform={`translate(12 ${(top + height - bottom) / 2}) rotate(-90)`} text-anchor="middle">{yLabel}</text>
          </svg>
        )}
      </div>
    </figure>
  );
}

/** parts: [{name, share, colour: name of a colour of the theme, text}], shares of `whole` (1). */
export function Stack({ parts, label }) {
  return (
    <div class="stack" role="img" aria-label={`${label}: ${parts.map((part) => `${part.name} ${part.text}`).join(", ")}`}>
      {parts.map((part) => (
        <span style={{ width: `${100 * part.share}%`, background: `var(--${part.colour})` }} title={`${part.name}: ${part.text}`} />
      ))}
    </div>
  );
}

export function Legend({ parts }) {
  return (
    <ul class="legend">
      {parts.map((part) => (
        <li>
          <span class="swatch" style={{ background: `var(--${part.colour})` }} />
          {part.name} {part.text}
        </li>
      ))}
    </ul>
  );
}

/** share: 0..1. mark: another share at which a line stands. */
export function Bar({ share, colour = "s0", mark }) {
  return (
    <div class="bar">
      <span style={{ width: `${Math.min(100, 100 * share)}%`, background: `var(--${colour})` }} />
      {mark !== undefined && <i style={{ left: `${100 * mark}%` }} />}
    </div>
  );
}
