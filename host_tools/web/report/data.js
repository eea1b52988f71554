// SPDX-License-Identifier: MIT
// The JSON in the page enters; the run, and what the page shows of it for a stage, leave.
import { phaseWords, stageName } from "../shared/words.js";

/** Undoes html_report.cpp's packing of tables into columns. */
export function unpacked(json) {
  if (Array.isArray(json)) return json.map(unpacked);
  if (json === null || typeof json !== "object") return json;
  if ("$rows" in json) {
    const columns = Object.entries(json.$columns).map(([key, column]) => [key, unpacked(column)]);
    return Array.from({ length: json.$rows }, (_, i) => Object.fromEntries(columns.map(([key, column]) => [key, column[i]])));
  }
  return Object.fromEntries(Object.entries(json).map(([key, value]) => [key, unpacked(value)]));
}

/** name: of a stage, or "" for the whole run: the same keys (docs/statistics.md), with begin, cycles, title and words for phases. */
export function viewOf(statistics, name) {
  const total = statistics.virtual_cycles.total;
  const words = phaseWords(statistics.settings.command);
  if (name === "") return { ...statistics, words, name, title: "the whole run", begin: 0, cycles: total };
  const stage = statistics.stages.find((one) => one.name === name);
  return { ...stage, words, title: stageName(name), visits: statistics.visits && { [name]: statistics.visits[name] } };
}

/** Of the PEs' clock; cycles of the statistics are its cycles. */
export function clockHertz(statistics) {
  return statistics.settings.machine.processor.clock_hertz;
}

export function sum(object) {
  return Object.values(object).reduce((all, value) => all + value, 0);
}

/** Index of the greatest value. */
export function greatest(values) {
  let best = 0;
  values.forEach((value, i) => {
    if (value > values[best]) best = i;
  });
  return best;
}

/** "PE 37 (column 5, row 2)". */
export function peName(pe, columns) {
  return `PE ${pe} (column ${pe % columns}, row ${Math.floor(pe / columns)})`;
}
