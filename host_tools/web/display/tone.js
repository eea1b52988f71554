// SPDX-License-Identifier: MIT
// Linear radiance enters, bytes of a canvas leave: white balance, exposure, curve and sRGB as a .png has them
// (host_tools/picture/tone_map.hpp and white_balance.hpp, host_tools/colour/white_point.hpp, whose names these are).

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

const kLuminance = [0.2126, 0.7152, 0.0722];
const kCones = [[0.4227253066602373, 0.49134528984985704, 0.027357931006333158],
  [0.05569966095947373, 0.9615340134311382, 0.0231838235557641], [0.021382652907183254, 0.08764189819640404, 0.9805081047709444]];
const kFromCones = [[2.53804403913589, -1.2932767170360702, -0.04023682650373315],
  [-0.14600372779718324, 1.1166481780947315, -0.022329049924768866], [-0.042298549805236604, -0.07160723960446692, 1.022752719264684]];
const kLeastChannel = 0.05;
const kUnchanged = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

function adaptationTo(light) {
  const grey = dot(kLuminance, light);
  const scales = kCones.map((row) => (grey * (row[0] + row[1] + row[2])) / dot(row, light));
  return kFromCones.map((row) => [0, 1, 2].map((c) => dot(row, kCones.map((cone, i) => scales[i] * cone[c]))));
}

/** Of what is not black, ascending; where there are more than `most` pixels, of every n-th. */
function luminances(pixels, most, weights) {
  const step = 3 * Math.max(1, Math.ceil(pixels.length / 3 / most));
  const values = [];
  for (let i = 0; i + 2 < pixels.length; i += step) {
    const value = weights[0] * pixels[i] + weights[1] * pixels[i + 1] + weights[2] * pixels[i + 2];
    if (Number.isFinite(value) && value > 0) values.push(value);
  }
  return Float64Array.from(values).sort();
}

function lightColour(pixels, most) {
  const values = luminances(pixels, most, kLuminance);
  if (values.length === 0) return [1, 1, 1];
  const tenth = Math.floor(values.length / 10);
  const lowest = values[tenth];
  const highest = values[values.length - 1 - tenth];
  const sum = [0, 0, 0];
  for (let i = 0; i + 2 < pixels.length; i += 3) {
    const pixel = [pixels[i], pixels[i + 1], pixels[i + 2]];
    const bright = dot(kLuminance, pixel);
    if (bright >= lowest && bright <= highest) for (let c = 0; c < 3; ++c) sum[c] += Math.max(pixel[c] / highest, 0) ** 6;
  }
  const greatest = Math.max(...sum);
  return greatest > 0 ? sum.map((value) => Math.max((value / greatest) ** (1 / 6), kLeastChannel)) : [1, 1, 1];
}

/** The change of colours. white: "off", "auto", or the change itself. most: as of middleLuminance. */
export function balance(pixels, most, white) {
  if (white === "auto") return adaptationTo(lightColour(pixels, most));
  return Array.isArray(white) ? white : kUnchanged;
}

/** Of what is not black, after the change; where there are more than `most` pixels, of every n-th. 0: all is black. */
export function middleLuminance(pixels, most, change) {
  const sorted = luminances(pixels, most, [0, 1, 2].map((c) => dot(kLuminance, change.map((row) => row[c]))));
  if (sorted.length === 0) return 0;
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
export function paint(pixels, bytes, first, end, factor, curve, change) {
  const isFilmic = curve === "filmic";
  const positive = (value) => (value > 0 && value < Infinity ? value : 0);
  for (let i = first; i < end; ++i) {
    const pixel = [pixels[3 * i], pixels[3 * i + 1], pixels[3 * i + 2]];
    const r = positive(dot(change[0], pixel) * factor);
    const g = positive(dot(change[1], pixel) * factor);
    const b = positive(dot(change[2], pixel) * factor);
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
