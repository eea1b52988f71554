// SPDX-License-Identifier: MIT
// What the run tells of itself enters; where it is, how long it takes, and the button that ends it, leave.
import { useState } from "preact/hooks";
import { grouped, percent, seconds, significant } from "../shared/format.js";
import { send } from "./feed.js";
import { useFeed } from "./use_feed.js";

const kInterval = 200; // [ms]

const kConnections = {
  connecting: "Connecting …",
  lost: "The connection is lost. Trying again …",
  ended: "Torolux has ended. What is shown is the last that it told.",
};

function stateText({ state, stage, fraction, draft, error, samples, of_samples }) {
  if (state === "preparing") return "Preparing: the scene is cut up and shared out";
  if (state === "done") return "Done";
  if (state === "walking") return samples === 0 ? "A view, coarse" : `A view, ${samples} of ${of_samples} samples`;
  if (state === "failed") return `Failed: ${error}`;
  if (stage === undefined) return "Running";
  return `${draft ? "Draft: " : ""}${stage}, ${percent(fraction)}`;
}

function figures({ progress, machine }) {
  const list = [["elapsed", seconds(progress.elapsed)]];
  if (progress.state === "running" && progress.overall !== undefined) {
    list.push(["time left", progress.seconds_left >= 0 ? `about ${seconds(progress.seconds_left)}` : "not known yet"]);
  }
  if (progress.virtual_time !== undefined) list.push(["virtual time", seconds(progress.virtual_time / machine.clock_hertz)]);
  if (progress.stage === "radiosity") list.push(["unshot", percent(progress.unshot)]);
  if (progress.credits_total > 0 && progress.state === "running") {
    list.push(["records in flight", grouped(progress.credits_total - progress.credits_home)]);
  }
  return list;
}

/** Ends the display; while the run goes on that ends it, too, and is asked again. */
function End({ running }) {
  const [asked, setAsked] = useState(false);
  const [fault, setFault] = useState("");
  const end = () => send({ do: "end" }).catch((error) => setFault(error.message));
  return (
    <div class="choices" id="end">
      {!running && <button onClick={end}>End the display</button>}
      {running && !asked && <button onClick={() => setAsked(true)}>Stop the run</button>}
      {running && asked && (
        <>
          <span>The run ends without a picture.</span>
          <button onClick={end}>Stop it</button>
          <button onClick={() => setAsked(false)} ref={(button) => button?.focus()}>Go on</button>
        </>
      )}
      {fault && <span role="alert">{fault}</span>}
    </div>
  );
}

/** children: further controls of the run. */
export function Progress({ feed, children }) {
  useFeed(feed, kInterval);
  const { progress, connection } = feed;
  if (!progress) return null;
  const over = ["done", "failed", "walking"].includes(progress.state);
  return (
    <section id="progress">
      <h2>{stateText(progress)}</h2>
      {progress.overall !== undefined && (
        <p>
          <progress value={progress.overall} max="1" aria-label="Done of all stages" /> {percent(progress.overall)}
        </p>
      )}
      <dl class="tiles">
        {figures(feed).map(([name, value]) => <div><dt>{name}</dt><dd>{value}</dd></div>)}
      </dl>
      {children}
      {connection === "open" && <End running={!over} />}
    </section>
  );
}

export function Connection({ feed }) {
  useFeed(feed, kInterval);
  const words = feed.connection === "refused" ? feed.reason : kConnections[feed.connection];
  return <p id="connection" role="status" class={words ? "told" : ""}>{words ?? ""}</p>;
}

/** Lines that PEs have said; none: nothing is shown. */
export function Texts({ feed }) {
  useFeed(feed, kInterval);
  if (feed.texts.length === 0) return null;
  return (
    <section id="texts">
      <h2>What PEs say</h2>
      <pre tabIndex={0}>{feed.texts.join("\n")}</pre>
      <p class="soft">The last {significant(feed.texts.length)} lines.</p>
    </section>
  );
}
