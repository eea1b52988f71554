// SPDX-License-Identifier: MIT
// What is asked of an element, a pixel or a PE enters; the run's answer leaves as tables, as pixels lit up in the picture
// and as a ray's way over the torus.
import { useEffect, useRef, useState } from "preact/hooks";
import { themeColour } from "../shared/colours.js";
import { bytes, grouped, percent, significant } from "../shared/format.js";
import { phaseWords, stageName, word } from "../shared/words.js";
import { send } from "./feed.js";

const kMostEvents = 400; // of a story, in the page
const kWay = 3; // width of a way [CSS pixels]

/** The last answers: element, pixel, pe as docs/display.md has them; error; busy. `ask(question)` asks for another. */
export function useQuestions(feed) {
  const [answers, setAnswers] = useState({});
  const newest = useRef(0);
  const ask = (question) => {
    const number = ++newest.current;
    setAnswers((before) => ({ ...before, busy: true, error: undefined }));
    send({ do: "ask", ...question }).then(
      (answer) => number === newest.current && setAnswers((before) => ({ ...(question.pixel ? before : {}), ...answer, at: question.pixel ? before.at : question.at, busy: false })),
      (error) => number === newest.current && setAnswers({ error: error.message }),
    );
  };
  // Of another camera nothing of it is true any more.
  useEffect(() => {
    ++newest.current;
    setAnswers({});
  }, [feed.camera]);
  return { answers, ask, forget: () => setAnswers({}), ready: feed.camera !== undefined };
}

/** Those pixels that an answer is about: [[first, count], ...]. */
export function litPixels({ element, pe }) {
  return (pe ?? element)?.seen ?? [];
}

/** On top of the picture: everything else is darkened. */
export function Lit({ runs, width, height }) {
  const canvas = useRef(null);
  useEffect(() => {
    const image = new ImageData(width, height);
    const words = new Uint32Array(image.data.buffer);
    words.fill(0xb0000000);
    for (const [first, count] of runs) words.fill(0, first, first + count);
    canvas.current.getContext("2d").putImageData(image, 0, 0);
  }, [runs, width, height]);
  return <canvas class="lit" ref={canvas} width={width} height={height} aria-hidden="true" />;
}

/** A story's packets, for TorusMap's overlay: lines between neighbours, stubs where a way goes round the edge. */
export function wayOverlay(story) {
  const ways = (story ?? []).map((event) => event.routers).filter(Boolean);
  if (ways.length === 0) return undefined;
  return (context, place, step) => {
    context.strokeStyle = themeColour("s3");
    context.lineWidth = kWay;
    for (const way of ways) {
      for (let i = 1; i < way.length; ++i) {
        const [x1, y1] = place(way[i - 1]);
        const [x2, y2] = place(way[i]);
        const round = Math.hypot(x2 - x1, y2 - y1) > 1.5 * step;
        const [dx, dy] = round ? [-Math.sign(x2 - x1) * step * 0.5, -Math.sign(y2 - y1) * step * 0.5] : [x2 - x1, y2 - y1];
        context.beginPath();
        context.moveTo(x1, y1);
        context.lineTo(x1 + dx, y1 + dy);
        if (round) {
          context.moveTo(x2 - dx, y2 - dy);
          context.lineTo(x2, y2);
        }
        context.stroke();
      }
    }
  };
}

const triple = (values) => values.map((value) => significant(value)).join("  ");
const sum = (values) => values.reduce((a, b) => a + b, 0);

function Rows({ rows }) {
  return (
    <div class="scroll">
      <table><tbody>{rows.map(([name, value]) => <tr><td>{name}</td><td>{value}</td></tr>)}</tbody></table>
    </div>
  );
}

function Element({ of }) {
  const all = of.sources.reduce((total, one) => total + sum(one.emitted_w) + sum(one.reflected_w), 0);
  return (
    <>
      <h3>{`Element ${of.element}, ${of.side}, of ${of.material}`}</h3>
      <Rows rows={[
        ["patch", `${of.patch}: element ${of.of_patch + 1} of ${of.patch_elements}`],
        ["area", `${significant(of.area)} m\u00b2, seen in ${grouped(of.pixels)} pixels`],
        ["owner", `PE ${of.owner}; subspace ${of.subspace.join(", ")}`],
        ["in ray tracing", of.keeper === null ? "at every PE that has its polygon" : `PE ${of.keeper}`],
        ["incident [W], R G B", triple(of.incident_w)],
        ...(of.direct_w === null
          ? [["gathered by its rays", triple(of.gathered_w)], ["of the incident, kept", triple(of.apart_w)]]
          : [["of it, from emitters", triple(of.direct_w)]]),
        ["reflectance", triple(of.reflectance)],
        ["radiosity [W/m\u00b2]", triple(of.radiosity)],
      ]} />
      <h4>Where its light comes from</h4>
      <Rows rows={of.sources.slice(0, 8).map((one) => [
        percent((sum(one.emitted_w) + sum(one.reflected_w)) / all), `patch ${one.patch} of ${one.material}, PE ${one.pe}`,
      ])} />
    </>
  );
}

function Pixel({ of }) {
  return (
    <>
      <h3>{`The ray of pixel ${of.column}, ${of.row}, sample ${of.sample}`}</h3>
      <p>{`The pixel has ${triple(of.radiance)} W/(m\u00b2 sr).`}</p>
      <div class="scroll story" tabIndex={0} role="region" aria-label="Its story">
        <table>
          <thead><tr><th scope="col">cycle</th><th scope="col">where</th><th scope="col">what</th></tr></thead>
          <tbody>
            {of.story.slice(0, kMostEvents).map(({ cycle, who, what }) => <tr><td>{grouped(cycle)}</td><td>{who}</td><td>{what}</td></tr>)}
          </tbody>
        </table>
      </div>
      {of.story.length > kMostEvents && <p class="soft">{`${grouped(of.story.length - kMostEvents)} more; torolux inspect tells all.`}</p>}
    </>
  );
}

function PeStage({ of }) {
  const own = of.subspaces.length;
  const most = (all) => Object.entries(all).filter(([, value]) => value > 0).sort((a, b) => b[1] - a[1]);
  const { figures } = of; // null: the stage was left out
  return (
    <>
      <h4>{stageName(of.name)}</h4>
      <Rows rows={[
        ["subspaces", `${grouped(own)} of its own, ${grouped(of.common_subspaces)} at every PE`],
        ["polygons", grouped(of.polygons)],
        ["local memory", `${bytes(of.used_bytes)} of ${bytes(of.available_bytes)}`],
        ...most(of.stores).map(([name, size]) => [name, bytes(size)]),
      ]} />
      {figures && (
        <Rows rows={[
          ["cycles", grouped(figures.cycles)],
          ...most(figures.phase_cycles).map(([name, cycles]) => [word(phaseWords("render"), name), percent(cycles / figures.cycles)]),
          ["packets sent, received", `${grouped(figures.packets_sent)}, ${grouped(figures.packets_delivered)}`],
          ["record slots in use, at most", grouped(figures.record_slots_high_water)],
          ["receive buffers, at most", grouped(figures.receive_buffers_high_water)],
        ]} />
      )}
    </>
  );
}

function Pe({ of }) {
  const lit = of.seen_as === "subspaces" ? "what stands in its subspaces" : "the patches that it owns: every PE has all subspaces";
  return (
    <>
      <h3>{`PE ${of.pe} (column ${of.column}, row ${of.row})`}</h3>
      <p>{`Lit up in the picture: ${lit}.`}</p>
      <div class="columns">{of.stages.map((stage) => <div><PeStage of={stage} /></div>)}</div>
    </>
  );
}

/** questions: as useQuestions returns it. */
export function Answers({ questions }) {
  const { answers, ask, forget, ready } = questions;
  if (!ready) return null;
  const { at, element, pixel, pe, error, busy } = answers;
  return (
    <section id="answers">
      <h2>Ask</h2>
      <p class="soft" role="status">
        {busy ? "Asking …" : "A click on the picture asks for the element there; a click on a PE of the torus, or Enter, for that PE."}
      </p>
      {error && <p role="alert">{error}</p>}
      {element === null && <p>There is no lit surface.</p>}
      {element && <Element of={element} />}
      {pixel && <Pixel of={pixel} />}
      {pe && <Pe of={pe} />}
      <div class="choices">
        {at && <button onClick={() => ask({ pixel: at })}>Follow its ray</button>}
        {(element !== undefined || pe || error) && <button onClick={forget}>Close</button>}
      </div>
    </section>
  );
}
