// SPDX-License-Identifier: MIT
// A camera ({eye, look_at, up, fov}) and how somebody moves enter; the camera afterwards leaves.

const add = (a, b, factor = 1) => a.map((x, i) => x + factor * b[i]);
const scale = (a, factor) => a.map((x) => factor * x);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.sqrt(dot(a, a));
const unit = (a) => scale(a, 1 / length(a));

const kSteepest = (85 * Math.PI) / 180; // from the horizon

/** About a unit axis, counter-clockwise. */
function turned(v, axis, angle) {
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return add(add(scale(v, c), cross(axis, v), s), axis, dot(axis, v) * (1 - c));
}

function frame(camera) {
  const up = unit(camera.up);
  const way = add(camera.look_at, camera.eye, -1);
  const forward = unit(way);
  return { up, forward, right: unit(cross(forward, up)), distance: length(way) };
}

/** right, down: angles [radians]. About itself; or, `around`, about the point that it looks at. */
export function turn(camera, right, down, around = false) {
  const { up, forward, right: side, distance } = frame(camera);
  const height = Math.asin(Math.max(-1, Math.min(1, dot(forward, up))));
  const wanted = Math.max(-kSteepest, Math.min(kSteepest, height - down));
  const looks = scale(turned(turned(forward, side, wanted - height), up, -right), distance);
  return around
    ? { ...camera, eye: add(camera.look_at, looks, -1) }
    : { ...camera, look_at: add(camera.eye, looks) };
}

/** By parts of the distance to the point looked at, which moves along. */
export function move(camera, { ahead = 0, right = 0, up: rise = 0 }) {
  const { up, forward, right: side, distance } = frame(camera);
  const step = scale(add(add(scale(forward, ahead), side, right), up, rise), distance);
  return { ...camera, eye: add(camera.eye, step), look_at: add(camera.look_at, step) };
}

/** As lines of a scene.toml, or of a path's file. */
export function toml(camera, heading) {
  const vector = (v) => `[${v.map((x) => Number(x.toPrecision(7))).join(", ")}]`;
  return [heading, ...["eye", "look_at", "up"].map((key) => `${key} = ${vector(camera[key])}`),
    ...["fov", "aperture", "focus"].filter((key) => key in camera).map((key) => `${key} = ${Number(camera[key].toPrecision(7))}`), ""].join("\n");
}
