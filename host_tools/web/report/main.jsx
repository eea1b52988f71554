// SPDX-License-Identifier: MIT
// The report of a run: the page's data enter, the page leaves (docs/report.md).
import { render } from "preact";
import { useMemo, useState } from "preact/hooks";
import "uplot/dist/uPlot.min.css";
import "../shared/theme.css";
import "./report.css";
import { kStages, stageName } from "../shared/words.js";
import { unpacked, viewOf } from "./data.js";
import { Energy } from "./energy.jsx";
import { FlameGraph } from "./flame_graph.jsx";
import { Histograms } from "./histograms.jsx";
import { Limits } from "./limits.jsx";
import { Maps } from "./map.jsx";
import { Overview } from "./overview.jsx";
import { Rounds } from "./rounds.jsx";
import { Settings } from "./settings.jsx";
import { TimeLine } from "./time_line.jsx";
import { Copies, Traffic } from "./traffic.jsx";

/** Stages as tabs: arrow keys go from one to the next (WAI-ARIA's pattern). */
function Tabs({ names, chosen, onChoose }) {
  const key = (event) => {
    const move = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!move) return;
    event.preventDefault();
    const next = names[(names.indexOf(chosen) + move + names.length) % names.length];
    onChoose(next);
    document.getElementById(`tab-${next}`).focus();
  };
  return (
    <div class="tabs" role="tablist" aria-label="Stages" onKeyDown={key}>
      {names.map((name) => (
        <button id={`tab-${name}`} role="tab" aria-selected={name === chosen} aria-controls="stage" tabIndex={name === chosen ? 0 : -1}
          onClick={() => onChoose(name)}>
          {name === "" ? "whole run" : stageName(name)}
        </button>
      ))}
    </div>
  );
}

function Report({ data }) {
  const { statistics } = data;
  const only = statistics.stages.length === 1;
  const [name, setName] = useState(only ? statistics.stages[0].name : "");
  const view = useMemo(() => viewOf(statistics, name), [name]);
  const [shown, setShown] = useState([0, statistics.virtual_cycles.total]);
  const choose = (next) => {
    const stage = viewOf(statistics, next);
    setName(next);
    setShown([stage.begin, stage.begin + stage.cycles]);
  };
  const names = ["", ...statistics.stages.map((stage) => stage.name)];
  return (
    <>
      <header>
        <h1>{data.title}</h1>
        <p class="soft">A run of Torolux {statistics.version}, engine {statistics.engine}</p>
      </header>
      <main>
        <Overview data={data} />
        {!only && <Tabs names={names} chosen={name} onChoose={choose} />}
        <div id="stage" role={only ? undefined : "tabpanel"} aria-labelledby={only ? undefined : `tab-${name}`}>
          {name !== "" && <p class="stage-words">{(kStages[name] ?? ["", ""])[1]}</p>}
          <Limits view={view} statistics={statistics} onStage={choose} />
          <Maps view={view} statistics={statistics} />
          <TimeLine statistics={statistics} shown={shown} onShown={setShown} />
          <Histograms view={view} />
          <Traffic view={view} statistics={statistics} />
        </div>
        {data.profile && <FlameGraph profile={data.profile} />}
        {statistics.rounds?.length > 0 && <Rounds rounds={statistics.rounds} energy={statistics.energy} />}
        {statistics.energy && <Energy energy={statistics.energy} />}
        {statistics.copies && <Copies copies={statistics.copies} />}
        <Settings statistics={statistics} />
      </main>
    </>
  );
}

const data = unpacked(JSON.parse(document.getElementById("data").textContent));
render(<Report data={data} />, document.getElementById("page"));
