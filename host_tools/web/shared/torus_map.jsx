// SPDX-License-Identifier: MIT
// A value for each PE and for each link enters; the torus, drawn on a canvas, leaves: PEs as squares, between neighbours
// a line for each direction, those around the edge as stubs. Pointer and arrow keys choose a PE.
import { useEffect, useRef } from "preact/hooks";
import { useWidth } from "./charts.jsx";
import { css, inkOn, scaleColour, themeColour, useDark } from "./colours.js";
import { kLinkDirections } from "./words.js";

const kSquare = 0.6; // of the distance between PEs
const kStub = 0.45; // room around the edge
const kMostEdge = 8000; // pixels of the canvas

/** The line of each direction from a PE at (0, 0), in distances between PEs: traffic keeps to the right. */
const kLines = {
  east: [kSquare / 2, 0.09, 1 - kSquare / 2, 0.09],
  west: [-kSquare / 2, -0.09, -1 + kSquare / 2, -0.09],
  south: [-0.09, kSquare / 2, -0.09, 1 - kSquare / 2],
  north: [0.09, -kSquare / 2, 0.09, -1 + kSquare / 2],
};

/** How far apart PEs are drawn [pixels]. */
function distance(columns, rows, width) {
  const fit = width / (columns - 1 + kSquare + 2 * kStub);
  return Math.min(Math.max(fit, 9), 72, kMostEdge / columns, kMostEdge / rows);
}

function place(pe, columns, step) {
  const edge = (kStub + kSquare / 2) * step;
  return [edge + (pe % columns) * step, edge + Math.floor(pe / columns) * step];
}

function drawLinks(context, { columns, links, linkMost }, pe, step, dark) {
  const [x, y] = place(pe, columns, step);
  for (const direction of kLinkDirections) {
    const [x1, y1, x2, y2] = kLines[direction].map((v) => v * step);
    const value = linkMost > 0 ? links[direction][pe] / linkMost : 0;
    context.strokeStyle = css(scaleColour(value, dark));
    context.lineWidth = Math.max(1, step * (0.04 + 0.08 * value));
    context.beginPath();
    context.moveTo(x + x1, y + y1);
    context.lineTo(x + x2, y + y2);
    context.stroke();
  }
}

function drawPe(context, { columns, values, most, chosen, peColour }, pe, step, dark) {
  const [x, y] = place(pe, columns, step);
  const size = kSquare * step;
  const colour = peColour ? peColour(pe) : scaleColour(most > 0 ? values[pe] / most : 0, dark);
  context.fillStyle = css(colour);
  context.fillRect(x - size / 2, y - size / 2, size, size);
  context.lineWidth = pe === chosen ? 3 : 1;
  context.strokeStyle = themeColour(pe === chosen ? "ink" : "line");
  context.strokeRect(x - size / 2, y - size / 2, size, size);
  if (size >= 19) {
    context.fillStyle = inkOn(colour);
    context.fillText(String(pe), x, y);
  }
}

function draw(canvas, props, step, dark) {
  const ratio = Math.min(devicePixelRatio, kMostEdge / Math.max(canvas.width, canvas.height, 1) || 1, 2);
  const edge = (2 * kStub + kSquare - 1) * step;
  const width = Math.ceil(props.columns * step + edge);
  const height = Math.ceil(props.rows * step + edge);
  const context = canvas.getContext("2d");
  if (canvas.width !== Math.floor(width * ratio) || canvas.height !== Math.floor(height * ratio)) {
    canvas.width = width * ratio;
    canvas.height = height * ratio;
    canvas.style.width = `${width}px`;
    canvas.style.height = `${height}px`;
  }
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.font = `${Math.min(12, step * 0.28)}px system-ui, sans-serif`;
  for (let pe = 0; pe < props.values.length; ++pe) drawLinks(context, props, pe, step, dark);
  for (let pe = 0; pe < props.values.length; ++pe) drawPe(context, props, pe, step, dark);
  props.overlay?.(context, (pe) => place(pe, props.columns, step), step);
}

const kMoves = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/**
 * columns, rows; values: by PE, most: what has the scale's last colour; links: {east: [by PE], ...}, linkMost likewise;
 * chosen: a PE; onChoose; onPick: one that was clicked on, or chosen when Enter came; label: what is seen, in words. peColour: of a PE, [r, g, b], in place of its value's;
 * overlay: draws on top, with the canvas's context, the place of a PE [pixels], and how far PEs are apart.
 */
export function TorusMap(props) {
  const { columns, rows, chosen, onChoose, onPick, label } = props;
  const dark = useDark();
  const canvas = useRef(null);
  const [box, width] = useWidth();
  const step = width > 0 ? distance(columns, rows, width) : 0;
  useEffect(() => {
    if (step > 0) draw(canvas.current, props, step, dark);
  });
  const at = (event) => {
    const bounds = canvas.current.getBoundingClientRect();
    const cell = (value, count) => Math.min(count - 1, Math.max(0, Math.floor(value / step - kStub - kSquare / 2 + 0.5)));
    const pe = cell(event.clientY - bounds.top, rows) * columns + cell(event.clientX - bounds.left, columns);
    onChoose(pe);
    return pe;
  };
  const key = (event) => {
    if (event.key === "Enter") onPick?.(chosen);
    const move = kMoves[event.key];
    if (!move) return;
    event.preventDefault();
    const x = ((chosen % columns) + move[0] + columns) % columns;
    const y = (Math.floor(chosen / columns) + move[1] + rows) % rows;
    onChoose(y * columns + x);
  };
  return (
    <div class="torus scroll" ref={box}>
      <canvas ref={canvas} tabIndex={0} role="application" aria-label={`${label}. Arrow keys choose a PE.`}
        onPointerMove={(event) => event.pointerType === "mouse" && at(event)} onClick={(event) => { const pe = at(event); onPick?.(pe); }} onKeyDown={key} />
    </div>
  );
}

/** The scale's colours from 0 to `most`, as text with its unit. */
export function ColourScale({ name, most }) {
  const dark = useDark();
  const stops = Array.from({ length: 21 }, (_, i) => css(scaleColour(i / 20, dark)));
  return (
    <div class="scale">
      <span>{name}: 0</span>
      <span class="ramp" style={{ background: `linear-gradient(to right, ${stops.join(",")})` }} />
      <span>{most}</span>
    </div>
  );
}
