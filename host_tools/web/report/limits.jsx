// SPDX-License-Identifier: MIT
// What limits a stage, or each stage of the run: sentences, and the shares from which they follow.
import { Bar, Legend, Stack } from "../shared/charts.jsx";
import { percent, short } from "../shared/format.js";
import { kWaits, stageName, word } from "../shared/words.js";
import { limitText, runText } from "./limits.js";

function sharesOf(stage) {
  const { work, balance, waiting } = stage.limits.shares;
  return [
    { name: "all PEs work", share: work, colour: "s0", text: percent(work) },
    { name: "only the busiest work", share: balance, colour: "s1", text: percent(balance) },
    { name: "even the busiest waits", share: waiting, colour: "w0", text: percent(waiting) },
  ];
}

const kParts = [["bus", "bus"], ["host", "host"], ["frame_buffer", "frame buffer"], ["link", "busiest link of the torus"]];
/** kSaturated of host_tools/report/limits.hpp. */
const kSaturated = 0.8;

function OtherParts({ stage }) {
  const shares = stage.limits.shares;
  return (
    <table class="bars-table">
      <thead><tr><th>part of the machine</th><th>busy</th><th class="words">of the stage; beyond the mark it limits</th></tr></thead>
      <tbody>
        {kParts.map(([key, name]) => (
          <tr><td>{name}</td><td>{percent(shares[key])}</td><td><Bar share={shares[key]} mark={kSaturated} /></td></tr>
        ))}
        {shares.tail > 0 && (
          <tr><td>ends of rounds</td><td>{percent(shares.tail)}</td><td><Bar share={shares.tail} colour="s3" /></td></tr>
        )}
      </tbody>
    </table>
  );
}

/** Where the time of all PEs goes: phases, waits, nothing more to do. */
function PeTime({ view }) {
  const all = view.pes.reduce((total, pe) => total + pe.cycles, 0) || 1;
  const part = (name, cycles, colour) => ({ name, share: cycles / all, colour, text: percent(cycles / all) });
  const phases = Object.entries(view.phases).map(([key, cycles], i) => part(word(view.words, key), cycles, `s${i % 9}`));
  const waits = Object.entries({ ...view.waits, idle_at_end: view.idle_at_end });
  const parts = phases.concat(waits.map(([key, cycles], i) => part(word(kWaits, key), cycles, `w${i}`)));
  const shown = parts.filter((one) => one.share > 0.00005);
  return (
    <>
      <h3>Where the PEs' time goes</h3>
      <Stack parts={shown} label="Time of all PEs" />
      <Legend parts={shown} />
    </>
  );
}

function Sentences({ text }) {
  return (
    <>
      <p class="verdict">{text.what}</p>
      <p>{text.why} {text.help}</p>
    </>
  );
}

function StageRow({ stage, total, statistics, onStage }) {
  const parts = sharesOf(stage);
  return (
    <tr>
      <td><button class="plain" onClick={() => onStage(stage.name)}>{stageName(stage.name)}</button></td>
      <td>{short(stage.cycles)}</td>
      <td>{percent(stage.cycles / total)}</td>
      <td class="wide"><Stack parts={parts} label={stageName(stage.name)} /></td>
      <td class="words sentence">{limitText(stage, statistics).what}</td>
    </tr>
  );
}

export function Limits({ view, statistics, onStage }) {
  if (view.name !== "") {
    return (
      <section id="limits">
        <h2>What limits {view.title}</h2>
        <Sentences text={limitText(view, statistics)} />
        <h3>The stage's time</h3>
        <Stack parts={sharesOf(view)} label="Time of the stage" />
        <Legend parts={sharesOf(view)} />
        <OtherParts stage={view} />
        <PeTime view={view} />
      </section>
    );
  }
  return (
    <section id="limits">
      <h2>What limits the run</h2>
      <Sentences text={runText(statistics, stageName)} />
      <div class="scroll">
        <table>
          <thead><tr><th>stage</th><th>cycles</th><th>of the run</th><th class="words wide">its time</th><th class="words">what limits it</th></tr></thead>
          <tbody>
            {statistics.stages.map((stage) => (
              <StageRow stage={stage} total={view.cycles} statistics={statistics} onStage={onStage} />
            ))}
          </tbody>
        </table>
      </div>
      <div class="wide">
        <Legend parts={sharesOf(statistics.stages[0]).map((part) => ({ ...part, text: "" }))} />
      </div>
      <PeTime view={view} />
    </section>
  );
}
