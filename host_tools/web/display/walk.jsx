// SPDX-License-Identifier: MIT
// Mouse, touch and keys on the picture enter; cameras leave, to the run that makes views of them. Bookmarks become lines
// of a scene.toml or of a path's file.
import { useRef, useState } from "preact/hooks";
import { move, toml, turn } from "./camera.js";
import { send } from "./feed.js";

const kStep = 0.05; // of the distance to the point looked at
const kAngle = (4 * Math.PI) / 180;
const kFast = 4; // with the shift key
const kClick = 4; // [CSS pixels] a pointer that has moved less has clicked

const kKeys = {
  w: { ahead: kStep }, s: { ahead: -kStep }, a: { right: -kStep }, d: { right: kStep },
  r: { up: kStep }, f: { up: -kStep },
  ArrowLeft: [-kAngle, 0], ArrowRight: [kAngle, 0], ArrowUp: [0, -kAngle], ArrowDown: [0, kAngle],
};

/** One request at a time; the newest camera that waits is sent next. */
class Sender {
  send(camera, onFault) {
    this.next = camera;
    if (this.busy) return;
    const newest = this.next;
    this.next = undefined;
    this.busy = true;
    send({ do: "view", ...newest }).then(() => onFault(""), (error) => onFault(error.message)).finally(() => {
      this.busy = false;
      if (this.next) this.send(this.next, onFault);
    });
  }
}

/**
 * Returns what a canvas needs to be walked by (handlers, tabIndex), or undefined while the scene is not solved; the
 * camera; `go(camera)`; and what went wrong. onPick: called with the event of a click.
 */
export function useWalk(feed, onPick) {
  const own = useRef(undefined); // where somebody has gone; the run follows
  const sender = useRef(new Sender());
  const drag = useRef(undefined);
  const [fault, setFault] = useState("");
  if (!feed.camera) return { fault };
  const camera = () => own.current ?? feed.camera;
  const go = (to) => {
    own.current = to;
    sender.current.send(to, setFault);
  };
  const onKeyDown = (event) => {
    const key = kKeys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!key || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    const fast = event.shiftKey ? kFast : 1;
    if (Array.isArray(key)) go(turn(camera(), key[0] * fast, key[1] * fast));
    else go(move(camera(), Object.fromEntries(Object.entries(key).map(([way, step]) => [way, step * fast]))));
  };
  const onPointerDown = (event) => {
    if (event.button !== 0) return;
    event.currentTarget.setPointerCapture(event.pointerId);
    drag.current = { x: event.clientX, y: event.clientY, from: camera(), far: false };
  };
  const onPointerMove = (event) => {
    const begun = drag.current;
    if (!begun) return;
    const [x, y] = [event.clientX - begun.x, event.clientY - begun.y];
    begun.far ||= Math.hypot(x, y) >= kClick;
    if (!begun.far) return;
    // The point under the mouse stays under it, in the picture's middle.
    const angle = (camera().fov * Math.PI) / 180 / event.currentTarget.getBoundingClientRect().height;
    const sign = event.shiftKey ? 1 : -1;
    go(turn(begun.from, sign * x * angle, sign * y * angle, event.shiftKey));
  };
  const onPointerUp = (event) => {
    const begun = drag.current;
    drag.current = undefined;
    if (begun && !begun.far) onPick?.(event);
  };
  const onWheel = (event) => {
    event.preventDefault();
    go(move(camera(), { ahead: -Math.sign(event.deltaY) * kStep }));
  };
  const handlers = { onKeyDown, onPointerDown, onPointerMove, onPointerUp, onPointerCancel: () => (drag.current = undefined), onWheel, tabIndex: 0, class: "walk" };
  return { handlers, camera, go, fault };
}

/** walk: as useWalk returns it. start: the camera of the first picture. */
export function WalkControls({ walk, start }) {
  const [marks, setMarks] = useState([]);
  if (!walk.handlers) return null;
  const text = marks.map((camera) => toml(camera, "[[camera]]")).join("\n");
  return (
    <details id="walk" open>
      <summary>Walk through the scene</summary>
      <p class="soft">
        Drag to turn, with shift to go round what is in the middle; wheel, or the keys <kbd>W</kbd> <kbd>A</kbd> <kbd>S</kbd> <kbd>D</kbd> to
        move, <kbd>R</kbd> <kbd>F</kbd> up and down, arrows to turn, while the picture has the focus.
      </p>
      <div class="choices">
        <button onClick={() => walk.go(start)}>Back to the start</button>
        <button onClick={() => setMarks([...marks, walk.camera()])}>Bookmark</button>
        {marks.map((camera, i) => <button onClick={() => walk.go(camera)}>{`Bookmark ${i + 1}`}</button>)}
      </div>
      {walk.fault && <p role="alert">{walk.fault}</p>}
      {marks.length > 0 && (
        <>
          <label for="marks">
            For <code>--path FILE</code>; one of them, with <code>[camera]</code> in place of <code>[[camera]]</code>, for a scene.toml:
          </label>
          <textarea id="marks" readOnly rows={Math.min(12, text.split("\n").length)} value={text} />
        </>
      )}
    </details>
  );
}
