// SPDX-License-Identifier: MIT
// Numbers from 0 to 1 enter, colours leave: perceptually even (viridis, Smith and van der Walt 2015), from what lies
// close to the page's ground to what stands out from it.
import { useEffect, useState } from "preact/hooks";

const kViridis = [
  [68, 1, 84], [71, 19, 101], [72, 36, 117], [70, 52, 128], [65, 68, 135], [59, 82, 139], [53, 95, 141], [47, 108, 142],
  [42, 120, 142], [37, 132, 142], [33, 145, 140], [30, 156, 137], [34, 168, 132], [47, 180, 124], [68, 191, 112],
  [94, 201, 98], [122, 209, 81], [155, 217, 60], [189, 223, 38], [223, 227, 24], [253, 231, 37],
];

/** [r, g, b], 0..255. dark: on a dark ground, where more is brighter; on a light one more is darker. */
export function scaleColour(value, dark) {
  const v = Math.min(1, Math.max(0, Number.isFinite(value) ? value : 0));
  const place = (dark ? v : 1 - v) * (kViridis.length - 1);
  const i = Math.min(kViridis.length - 2, Math.floor(place));
  return kViridis[i].map((c, k) => Math.round(c + (kViridis[i + 1][k] - c) * (place - i)));
}

export function css([r, g, b]) {
  return `rgb(${r},${g},${b})`;
}

/** Black or white, whichever can be read on it (WCAG's relative luminance). */
export function inkOn([r, g, b]) {
  const linear = (c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4);
  return 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b) > 0.18 ? "#000" : "#fff";
}

/** "#rrggbb" -> [r, g, b]. */
export function hexColour(text) {
  return [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16));
}

/** A colour of theme.css, as it is now. */
export function themeColour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/** Whether the page is dark; renders again when that changes. */
export function useDark() {
  const query = matchMedia("(prefers-color-scheme: dark)");
  const [dark, setDark] = useState(query.matches);
  useEffect(() => {
    const change = () => setDark(query.matches);
    query.addEventListener("change", change);
    return () => query.removeEventListener("change", change);
  }, []);
  return dark;
}
