// SPDX-License-Identifier: MIT
// The display of a run: the server's messages enter, the page leaves (docs/display.md).
import { render } from "preact";
import "uplot/dist/uPlot.min.css";
import "../shared/theme.css";
import "./display.css";
import { Answers, Lit, litPixels, useQuestions, wayOverlay } from "./ask.jsx";
import { Feed } from "./feed.js";
import { Charts } from "./history.jsx";
import { Pace } from "./pace.jsx";
import { packetOverlay } from "./packets.js";
import { Picture } from "./picture.jsx";
import { Connection, Progress, Texts } from "./progress.jsx";
import { Torus } from "./torus.jsx";
import { useFeed } from "./use_feed.js";

function Display({ feed }) {
  useFeed(feed, 500);
  const { machine, picture } = feed;
  const questions = useQuestions(feed);
  const { ask, answers, ready } = questions;
  const lit = litPixels(answers);
  const way = wayOverlay(answers.pixel?.story);
  if (machine) document.title = `${machine.title} - Torolux`;
  return (
    <>
      <header>
        <h1>{machine ? machine.title : "Torolux"}</h1>
        {machine && <p class="soft">{`${machine.columns} \u00d7 ${machine.rows} PEs, each a processor of ${machine.clock_hertz / 1e6} MHz`}</p>}
        <Connection feed={feed} />
      </header>
      {machine && (
        <main class={feed.picture ? "with-picture" : ""}>
          <Picture feed={feed} onPick={ready ? (at) => ask({ element: at, at }) : undefined}
            over={picture && lit.length > 0 && <Lit runs={lit} width={picture.width} height={picture.height} />} />
          <Progress feed={feed} />
          <Torus feed={feed} overlay={() => packetOverlay(feed.packets) ?? way} onPick={ready ? (pe) => ask({ pe }) : undefined}><Pace feed={feed} /></Torus>
          <Answers questions={questions} />
          <Texts feed={feed} />
          <Charts feed={feed} />
        </main>
      )}
    </>
  );
}

const feed = new Feed();
render(<Display feed={feed} />, document.getElementById("page"));
feed.run();
