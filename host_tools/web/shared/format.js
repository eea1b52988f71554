// SPDX-License-Identifier: MIT
// Numbers enter, texts for people leave: as docs/statistics.md names them, with units.

const kThin = "\u202f";

/** 1234567 -> "1 234 567". */
export function grouped(value) {
  return String(Math.round(value)).replace(/\B(?=(\d{3})+$)/g, kThin);
}

/** At most `digits` significant ones: 0.01234 -> "0.0123". */
export function significant(value, digits = 3) {
  if (value === 0) return "0";
  if (!Number.isFinite(value)) return String(value);
  const size = Math.abs(value);
  if (size >= 1e15 || size < 1e-4) return value.toExponential(digits - 1);
  if (size >= 10 ** digits) return grouped(value);
  return String(Number(value.toPrecision(digits)));
}

/** 0.123 -> "12 %"; what is small keeps a digit or two. */
export function percent(share) {
  const value = 100 * share;
  if (value === 0) return `0${kThin}%`;
  if (value < 0.01) return `<${kThin}0.01${kThin}%`;
  const text = value >= 99.95 ? "100" : value >= 9.95 ? value.toFixed(value > 99 || value < 20 ? 1 : 0) : significant(value, 2);
  return `${text}${kThin}%`;
}

const kPrefixes = [[1e12, "T"], [1e9, "G"], [1e6, "M"], [1e3, "k"]];

/** 12 345 678 -> "12.3 M". */
export function short(value) {
  for (const [size, prefix] of kPrefixes) {
    if (Math.abs(value) >= size) return `${significant(value / size)}${kThin}${prefix}`;
  }
  return significant(value);
}

/** A factor and its prefix in which all numbers up to `most` are read easily, for an axis. */
export function unitFor(most, unit) {
  for (const [size, prefix] of kPrefixes) {
    if (most >= 2 * size) return { size, unit: prefix + (unit === "cycles" ? `\u00a0${unit}` : unit) };
  }
  return { size: 1, unit };
}

/** Seconds of virtual or wall time. */
export function seconds(value) {
  if (value >= 100) return `${Math.floor(value / 60)}${kThin}min ${Math.round(value % 60)}${kThin}s`;
  if (value >= 1) return `${significant(value)}${kThin}s`;
  if (value >= 1e-3) return `${significant(value * 1e3)}${kThin}ms`;
  return `${significant(value * 1e6)}${kThin}\u00b5s`;
}

export function bytes(value) {
  for (const [size, unit] of [[2 ** 30, "GiB"], [2 ** 20, "MiB"], [2 ** 10, "KiB"]]) {
    if (value >= size) return `${significant(value / size)}${kThin}${unit}`;
  }
  return `${grouped(value)}${kThin}bytes`;
}
