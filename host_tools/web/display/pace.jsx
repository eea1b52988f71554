// SPDX-License-Identifier: MIT
// How fast the run goes: a slider, a pause and single steps enter, commands leave.
import { useState } from "preact/hooks";
import { grouped } from "../shared/format.js";
import { send } from "./feed.js";
import { useFeed } from "./use_feed.js";

const kInterval = 66; // [ms]
const kSlowest = 1; // exponents of ten of the slider [cycles in a second]
const kFastest = 8;
const kFirst = 3;
const kSteps = { event: "next event", packet: "next packet", round: "next round" };

/** Controls of the run's speed, while it goes on. */
export function Pace({ feed }) {
  useFeed(feed, kInterval);
  const [exponent, setExponent] = useState(kFirst);
  const [fault, setFault] = useState("");
  const { packets, progress } = feed;
  if (!["preparing", "running"].includes(progress?.state)) return null;
  const tell = (command) => send({ do: "pace", ...command }).then(() => setFault(""), (error) => setFault(error.message));
  const slow = (power) => tell({ speed: 10 ** power });
  const speed = packets?.speed ?? -1;
  const now = speed < 0 ? "as fast as it goes" : speed === 0 ? `stands at cycle ${grouped(packets.now)}` : `cycle ${grouped(packets.now)}`;
  return (
    <div id="pace">
      <h3>Speed</h3>
      <div class="choices">
        <button onClick={() => tell({ speed: "free" })}>Full speed</button>
        <button onClick={() => slow(exponent)}>Slow motion</button>
        <button onClick={() => tell({ speed: 0 })}>Stand</button>
        {Object.entries(kSteps).map(([step, name]) => <button onClick={() => tell({ step })}>{name[0].toUpperCase() + name.slice(1)}</button>)}
      </div>
      <label class="choice">
        Slow motion{" "}
        <input type="range" id="speed" min={kSlowest} max={kFastest} step="0.25" value={exponent}
          onInput={(event) => { setExponent(Number(event.target.value)); if (speed > 0) slow(Number(event.target.value)); }} />
        <output for="speed">{`${grouped(Number((10 ** exponent).toPrecision(2)))} cycles/s`}</output>
      </label>
      <p class="soft" id="pace-now" role="status">
        {now}
        {packets && speed >= 0 && `; packets on their way: ${grouped(packets.list.length + packets.leftOut)}`}
      </p>
      {fault && <p role="alert">{fault}</p>}
    </div>
  );
}
