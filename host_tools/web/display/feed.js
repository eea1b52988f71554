// SPDX-License-Identifier: MIT
// The server's endless answer enters (docs/display.md); the newest state of the run leaves, to whoever has asked to be
// told of changes. Connects again when the connection is lost.

import { readPackets } from "./packets.js";

/** As MessageType in host_tools/display/messages.hpp. */
const kTypes = ["alive", "machine", "picture", "pixels", "loads", "texts", "progress", "bye", "camera", "packets"];
const kHeader = 8;
const kMostBytes = 1 << 26; // of a message
const kLeastPause = 500; // before connecting again [ms]
const kMostPause = 5000;
const kSmoothing = 0.3; // weight of the newest look at the machine

const text = new TextDecoder();
const json = (bytes) => JSON.parse(text.decode(bytes));

/** Every request says the token, where the page's own address has one. */
export function address(path) {
  return path + location.search;
}

/** Chunks of any length enter, whole messages leave by `take(type, bytes)`. */
export class Parser {
  constructor(take) {
    this.take = take;
    this.rest = new Uint8Array(0);
  }

  add(chunk) {
    let bytes = chunk;
    if (this.rest.length > 0) {
      bytes = new Uint8Array(this.rest.length + chunk.length);
      bytes.set(this.rest);
      bytes.set(chunk, this.rest.length);
    }
    let at = 0;
    while (bytes.length - at >= kHeader) {
      const view = new DataView(bytes.buffer, bytes.byteOffset + at);
      const length = view.getUint32(4, true);
      if (length > kMostBytes) throw new Error("a message is too long");
      if (bytes.length - at < kHeader + length) break;
      this.take(kTypes[view.getUint32(0, true)], bytes.subarray(at + kHeader, at + kHeader + length));
      at += kHeader + length;
    }
    this.rest = bytes.slice(at);
  }
}

/** What is seen of PEs and links, 0..1 each, smoothed from look to look. */
class Loads {
  constructor(pes) {
    this.pes = pes;
    this.looks = 0;
    this.values = new Float32Array(pes);
    this.phases = new Uint8Array(pes);
    this.links = Object.fromEntries(["east", "west", "south", "north"].map((one) => [one, new Float32Array(pes)]));
  }

  take(bytes) {
    const view = new DataView(bytes.buffer, bytes.byteOffset);
    this.now = Number(view.getBigUint64(0, true));
    this.pixels = Number(view.getBigUint64(8, true));
    this.packets = view.getUint32(16, true);
    const column = (i) => bytes.subarray(24 + i * this.pes, 24 + (i + 1) * this.pes);
    const loads = column(0);
    // The first look, and the last one, of a machine at rest, are shown as they are.
    const weight = this.looks++ === 0 || loads.every((value) => value === 0) ? 1 : kSmoothing;
    for (let pe = 0; pe < this.pes; ++pe) this.values[pe] += weight * (loads[pe] / 255 - this.values[pe]);
    this.phases = column(1).slice();
    Object.values(this.links).forEach((link, i) => {
      const from = 24 + 2 * (i + 1) * this.pes;
      for (let pe = 0; pe < this.pes; ++pe) link[pe] += weight * (view.getUint16(from + 2 * pe, true) / 65535 - link[pe]);
    });
  }
}

class LivePicture {
  constructor({ width, height, kind }) {
    Object.assign(this, { width, height, kind });
    this.pixels = new Float32Array(3 * width * height);
    this.changes = []; // [first, end] of pixels, for whoever paints them
    this.version = 0;
  }

  take(bytes) {
    const view = new DataView(bytes.buffer, bytes.byteOffset);
    const first = view.getUint32(0, true);
    const count = view.getUint32(4, true);
    // The bytes lie anywhere; floats must lie at multiples of four.
    this.pixels.set(new Float32Array(bytes.slice(8, 8 + 12 * count).buffer), 3 * first);
    this.changes.push([first, first + count]);
    if (this.changes.length > 4096) this.changes = [[0, this.width * this.height]];
    ++this.version;
  }
}

/**
 * State: connection ("connecting", "open", "lost", "ended", "refused"), reason; machine, progress: as sent; picture,
 * loads; texts: lines; camera, start: of the picture, once it can be walked from there, and the first one.
 */
export class Feed {
  constructor() {
    this.connection = "connecting";
    this.texts = [];
    this.listeners = new Set();
    this.pause = kLeastPause;
    this.waiting = false;
  }

  /** listener: called after changes, at most once for each picture that the screen shows. Returns how to end that. */
  listen(listener) {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  changed() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      for (const listener of this.listeners) listener();
    });
  }

  take(type, bytes) {
    if (type === "machine") {
      this.machine = json(bytes);
      this.loads = new Loads(this.machine.columns * this.machine.rows);
      this.texts = [];
      this.picture = this.camera = this.start = undefined;
    } else if (type === "picture") {
      const picture = json(bytes);
      this.picture = picture.width * picture.height > 0 ? new LivePicture(picture) : undefined;
    } else if (type === "pixels") this.picture.take(bytes);
    else if (type === "loads") this.loads.take(bytes);
    else if (type === "texts") this.texts = json(bytes);
    else if (type === "progress") this.progress = json(bytes);
    else if (type === "packets") this.packets = readPackets(bytes);
    else if (type === "camera") {
      this.camera = json(bytes);
      this.start ??= this.camera;
    } else if (type === "bye") this.connection = "ended";
    this.changed();
  }

  async read(answer) {
    const parser = new Parser((type, bytes) => this.take(type, bytes));
    const reader = answer.body.getReader();
    for (;;) {
      const { done, value } = await reader.read();
      if (done || this.connection === "ended") return;
      parser.add(value);
    }
  }

  /** Until the server has said that it ends, or refuses. */
  async run() {
    while (this.connection !== "ended" && this.connection !== "refused") {
      try {
        const answer = await fetch(address("stream"), { cache: "no-store" });
        if (answer.ok) {
          this.connection = "open";
          this.pause = kLeastPause;
          this.changed();
          await this.read(answer);
        } else {
          this.reason = (await answer.text()).trim();
          if (answer.status !== 503) this.connection = "refused";
        }
      } catch {
        // The server is gone, or was never there: told below.
      }
      if (this.connection === "ended" || this.connection === "refused") break;
      this.connection = "lost";
      this.changed();
      await new Promise((done) => setTimeout(done, this.pause));
      this.pause = Math.min(kMostPause, 1.5 * this.pause);
    }
    this.changed();
  }
}

/** command: {do: name, ...}. Returns the answer; throws with what the server says where it refuses. */
export async function send(command) {
  const answer = await fetch(address("command"), {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(command),
  });
  const value = await answer.json().catch(() => ({}));
  if (!answer.ok || value.error) throw new Error(value.error ?? `the server answers ${answer.status}`);
  return value;
}
