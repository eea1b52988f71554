// SPDX-License-Identifier: MIT
// Linear radiance enters, bytes of a canvas leave: exposure, curve and sRGB as a .png has them
// (host_tools/picture/tone_map.hpp, whose names these are).

const kMiddleGrey = 0.18;
const kWhite = 16;
const kContrast = 1.3;
const kDesaturation = 0.15;

const kC = (kMiddleGrey ** (kContrast - 1) - kMiddleGrey ** kContrast) / (1 - (kMiddleGrey / kWhite) ** kContrast);
const kB = 1 - kC * kWhite ** -kContrast;

function filmic(x) {
  const power = Math.min(x, kWhite) ** kContrast;
  return power / (kB * power + kC);
}

/** sRGB bytes of linear values i / 65535. */
const kSrgb = Uint8Array.from({ length: 65536 }, (_, i) => {
  const value = i / 65535;
  return Math.round(255 * (value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055));
});

/** Of what is not black; where there are more than `most` pixels, of every n-th. 0: all is black. */
export function middleLuminance(pixels, most) {
  const step = 3 * Math.max(1, Math.ceil(pixels.length / 3 / most));
  const values = [];
  for (let i = 0; i + 2 < pixels.length; i += step) {
    const value = 0.2126 * pixels[i] + 0.7152 * pixels[i + 1] + 0.0722 * pixels[i + 2];
    if (Number.isFinite(value) && value > 0) values.push(value);
  }
  if (values.length === 0) return 0;
  const sorted = Float64Array.from(values).sort();
  const tenth = Math.floor(sorted.length / 10);
  let sum = 0;
  for (let i = tenth; i < sorted.length - tenth; ++i) sum += Math.log2(sorted[i]);
  return 2 ** (sum / (sorted.length - 2 * tenth));
}

/** From radiance to linear display values before the curve. */
export function exposureFactor(middle, ev) {
  return (middle > 0 ? kMiddleGrey / middle : 1) * 2 ** ev;
}

/** Pixels first..end - 1 into the canvas's bytes. curve: "filmic" or "linear". */
export function paint(pixels, bytes, first, end, factor, curve) {
  const isFilmic = curve === "filmic";
  const positive = (value) => (value > 0 && value < Infinity ? value : 0);
  for (let i = first; i < end; ++i) {
    const r = positive(pixels[3 * i] * factor);
    const g = positive(pixels[3 * i + 1] * factor);
    const b = positive(pixels[3 * i + 2] * factor);
    const peak = Math.max(r, g, b);
    let scale = 1;
    let white = 0;
    let top = peak;
    if (isFilmic && peak > 0) {
      top = filmic(peak);
      scale = top / peak;
      white = peak > 1 ? 1 - 1 / (kDesaturation * (peak - 1) + 1) : 0;
    }
    const byte = (value) => {
      const scaled = value * scale;
      return kSrgb[Math.round(65535 * Math.min(scaled + (top - scaled) * white, 1))];
    };
    bytes[4 * i] = byte(r);
    bytes[4 * i + 1] = byte(g);
    bytes[4 * i + 2] = byte(b);
    bytes[4 * i + 3] = 255;
  }
}
