// SPDX-License-Identifier: MIT
// The figures of a stage enter; what limits it, in a sentence or two for people who have not read the code, leaves.
import { bytes, grouped, percent } from "../shared/format.js";
import { kBusKinds, kHostWork, kLinkDirections, kWaits, word } from "../shared/words.js";
import { greatest, peName, sum } from "./data.js";

/** The key of the greatest value that `take` finds, and its share of all. */
function largest(object, take) {
  const entries = Object.entries(object).map(([key, value]) => [key, take(value)]);
  const all = entries.reduce((total, [, value]) => total + value, 0);
  const [key, value] = entries.reduce((best, entry) => (entry[1] > best[1] ? entry : best));
  return { key, share: all > 0 ? value / all : 0 };
}

function busiestPe(stage, columns) {
  return peName(greatest(stage.pes.map((pe) => pe.busy_cycles)), columns);
}

function busiestLink(stage, columns) {
  const best = { busy: -1 };
  stage.links.forEach((links, pe) => {
    for (const direction of kLinkDirections) {
      if (links[direction].busy_cycles > best.busy) Object.assign(best, { busy: links[direction].busy_cycles, pe, direction });
    }
  });
  return `the link that leaves ${peName(best.pe, columns)} to the ${best.direction}`;
}

/** What the PEs' waits were for, apart from having nothing more to do. */
function waitsText(stage) {
  if (sum(stage.waits) === 0) return "";
  const { key, share } = largest(stage.waits, (value) => value);
  return ` Of all waiting of PEs, ${percent(share)} is ${word(kWaits, key)}.`;
}

/** Where subspaces stand on one PE alone although others have copies: what would let more be copied. */
function copiesText(stage, { copies, settings }) {
  const copied = copies?.[stage.name]?.subspaces;
  if (!copied || copied === copies.of_subspaces) return "";
  return ` ${grouped(copies.of_subspaces - copied)} of ${grouped(copies.of_subspaces)} subspaces stand on one PE alone, the rest on every one: with more memory than ${bytes(settings.pe_memory)} (--pe-memory) more of them could.`;
}

const kTexts = {
  work: (stage) => ({
    what: "The PEs' own work.",
    why: `On average the PEs are busy for ${percent(stage.limits.shares.work)} of the time; next to nothing else holds them up.`,
    help: "More PEs, or faster ones, would make this stage shorter.",
  }),
  balance: (stage, columns, statistics) => ({
    what: "The busiest PE: work is not spread evenly.",
    why: `${busiestPe(stage, columns)} is busy for ${percent(stage.limits.shares.work + stage.limits.shares.balance)} of the time, the PEs on average for ${percent(stage.limits.shares.work)}: most wait for the few that have more to do.`,
    help: `The same work spread evenly would take up to ${percent(stage.limits.shares.balance)} off this stage. The map shows where the load is.${copiesText(stage, statistics)}`,
  }),
  tail: (stage) => ({
    what: "The ends of rounds.",
    why: `For ${percent(stage.limits.shares.tail)} of the time a round has no more light to send out, and the machine waits for the last records on their way, or for the host to choose the next patches.`,
    help: "Fewer, larger rounds would help, or shorter ways for the last records.",
  }),
  waiting: (stage) => ({
    what: "Waiting for each other.",
    why: `Even the busiest PE has nothing to do for ${percent(stage.limits.shares.waiting)} of the time, and yet neither bus nor host, frame buffer or any link is busy enough to be the cause.${waitsText(stage)}`,
    help: "Delays add up: messages on their way, packets that are gathered before they are sent, or too few records under way at once to keep all PEs at work.",
  }),
  bus: (stage) => ({
    what: `The bus: it is busy for ${percent(stage.limits.shares.bus)} of the time.`,
    why: `All PEs share it with the host. Most of its time, ${percent(largest(stage.bus.kinds, (kind) => kind.cycles).share)}, goes to ${word(kBusKinds, largest(stage.bus.kinds, (kind) => kind.cycles).key)}.`,
    help: "More PEs would not help; a faster bus, or less to carry, would.",
  }),
  frame_buffer: (stage) => ({
    what: `The frame buffer: it is busy adding pixels for ${percent(stage.limits.shares.frame_buffer)} of the time.`,
    why: "The PEs find what pixels show faster than it can be added up.",
    help: "More PEs would not help; a faster frame buffer, or fewer samples, would.",
  }),
  host: (stage) => ({
    what: `The host: it is busy for ${percent(stage.limits.shares.host)} of the time.`,
    why: `The PEs wait for it. Most of its own time, ${percent(largest(stage.host_processor.work, (work) => work.own_cycles).share)}, goes to ${word(kHostWork, largest(stage.host_processor.work, (work) => work.own_cycles).key)}.`,
    help: "More PEs would not help; a faster host, or less for it to do, would.",
  }),
  link: (stage, columns) => ({
    what: `A link of the torus: the busiest one is busy for ${percent(stage.limits.shares.link)} of the time.`,
    why: `It is ${busiestLink(stage, columns)}.`,
    help: "Wider links, or another allocation of subspaces to PEs, would help.",
  }),
};

/** {what, why, help}: sentences. */
export function limitText(stage, statistics) {
  return kTexts[stage.limits.by](stage, statistics.settings.pes[0], statistics);
}

/** For the whole run: which stage takes most of it, and what limits that one. */
export function runText(statistics, stageTitle) {
  const { key, share } = largest(Object.fromEntries(statistics.stages.map((stage) => [stage.name, stage])), (stage) => stage.cycles);
  const stage = statistics.stages.find((one) => one.name === key);
  const text = limitText(stage, statistics);
  return {
    what: `Most of the time, ${percent(share)}, is ${stageTitle(key)}. What limits that stage: ${text.what[0].toLowerCase()}${text.what.slice(1)}`,
    why: text.why,
    help: text.help,
  };
}
