// SPDX-License-Identifier: MIT
// The picture as it comes enters; a canvas with exposure and tone curve leaves. Neither of these asks anything of the run.
import { useEffect, useRef, useState } from "preact/hooks";
import { significant } from "../shared/format.js";
import { balance, exposureFactor, middleLuminance, paint } from "./tone.js";
import { useFeed } from "./use_feed.js";
import { WalkControls, useWalk } from "./walk.jsx";

const kInterval = 66; // of repainting [ms]
const kExposureInterval = 500; // of looking for the middle luminance anew
const kSamples = 1 << 15; // for that, while the picture grows
const kFinalSamples = 1 << 22;

/** What a picture is, and what is said of it where that needs saying. */
const kKinds = {
  frame_buffer: ["the frame buffer", ""],
  radiosity: ["what elements hold so far", "What elements hold so far, as the camera sees them; mirrors and glass are black. The picture itself comes in the ray tracing stage."],
};

/** What is painted, and how; in a ref: it changes with every message. */
class Painter {
  constructor() {
    this.painted = null;
    this.exposed = 0;
  }

  begin(canvas, picture) {
    this.picture = picture;
    this.image = new ImageData(picture.width, picture.height);
    canvas.width = picture.width;
    canvas.height = picture.height;
    this.painted = null;
    this.exposed = 0;
    this.middle = 0;
    this.change = balance([], 1, "off");
  }

  /** Repaints what has changed; all of it where the way of painting has. final: no more pixels will come. */
  paint(canvas, picture, ev, curve, white, final) {
    if (this.picture !== picture) this.begin(canvas, picture);
    const now = performance.now();
    const state = `${picture.version} ${final}`;
    if (state !== this.measured && (final || now - this.exposed > kExposureInterval)) {
      const most = final ? kFinalSamples : kSamples;
      this.change = balance(picture.pixels, most, white);
      this.middle = middleLuminance(picture.pixels, most, this.change);
      this.exposed = now;
      this.measured = state;
    }
    const way = `${this.middle} ${this.change} ${ev} ${curve}`;
    const changes = way === this.painted ? picture.changes : [[0, picture.width * picture.height]];
    picture.changes = [];
    if (changes.length === 0) return;
    this.painted = way;
    let top = picture.height;
    let bottom = 0;
    for (const [first, end] of changes) {
      paint(picture.pixels, this.image.data, first, end, exposureFactor(this.middle, ev), curve, this.change);
      top = Math.min(top, Math.floor(first / picture.width));
      bottom = Math.max(bottom, Math.ceil(end / picture.width));
    }
    canvas.getContext("2d").putImageData(this.image, 0, 0, 0, top, picture.width, bottom - top);
  }
}

/**
 * onPick: called with [x, y] of a pixel that was clicked on, where there is a use for it. over: lies on top of the picture. children:
 * what else belongs to it. It can be walked through once the run is over.
 */
export function Picture({ feed, onPick, over, children }) {
  useFeed(feed, kInterval);
  const canvas = useRef(null);
  const painter = useRef(new Painter());
  const [ev, setEv] = useState(null);
  const [curve, setCurve] = useState(null);
  const { picture, machine, progress } = feed;
  const exposure = ev ?? machine.exposure_ev;
  const chosen = curve ?? machine.tone_curve;
  useEffect(() => {
    if (picture && canvas.current) painter.current.paint(canvas.current, picture, exposure, chosen, machine.white_balance, progress?.state === "done");
  });
  const pickAt = useRef(undefined);
  const walk = useWalk(feed, onPick && ((event) => pickAt.current(event)));
  if (!picture) return machine.what === "render" ? <section id="picture"><h2>Picture</h2><p>The picture is too large to be shown here.</p></section> : null;
  const pick = (event) => {
    const box = canvas.current.getBoundingClientRect();
    const at = (value, size, count) => Math.min(count - 1, Math.max(0, Math.floor((value / size) * count)));
    onPick([at(event.clientX - box.left, box.width, picture.width), at(event.clientY - box.top, box.height, picture.height)]);
  };
  pickAt.current = pick;
  const [kind, words] = kKinds[picture.kind] ?? [picture.kind, ""];
  return (
    <section id="picture">
      <h2>Picture</h2>
      <div class="frame">
      <canvas ref={canvas} role="img" {...(walk.handlers ?? { onClick: onPick && pick })}
          aria-label={`${machine.title}: ${kind}, ${picture.width} by ${picture.height} pixels`} />
      {over}
      </div>
      {words && <p class="soft">{words}</p>}
      <div class="choices">
        <label class="choice">
          Exposure{" "}
          <input type="range" id="exposure" min="-8" max="8" step="0.1" value={exposure}
            onInput={(event) => setEv(Number(event.target.value))} />
          <output for="exposure">{`${exposure > 0 ? "+" : ""}${significant(exposure)} EV`}</output>
        </label>
        <label class="choice">
          Tone curve{" "}
          <select id="curve" value={chosen} onChange={(event) => setCurve(event.target.value)}>
            <option value="filmic">filmic</option>
            <option value="linear">linear</option>
          </select>
        </label>
        <button onClick={() => (setEv(null), setCurve(null))}>As the .png</button>
      </div>
      <WalkControls walk={walk} start={feed.start} />
      {children}
    </section>
  );
}
