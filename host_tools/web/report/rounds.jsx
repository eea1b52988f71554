// SPDX-License-Identifier: MIT
// The rounds of the radiosity stage: how what is unshot falls, how long rounds and their tails are, how many patches shoot.
import { useMemo } from "preact/hooks";
import { LineChart } from "../shared/charts.jsx";
import { grouped, percent, unitFor } from "../shared/format.js";

export function Rounds({ rounds, energy }) {
  const lengths = rounds.map((round) => round.end - round.begin);
  const unit = unitFor(Math.max(...lengths), "cycles");
  const { x, charts } = useMemo(() => {
    const column = (take) => rounds.map(take);
    const one = (name, values, colour) => ({ name, values, colour, stepped: false });
    return {
      x: column((_, i) => i + 1),
      charts: [
        { title: "Convergence", yLabel: "unshot, of the emitted [%]", log: true, series: [one("unshot at the selection [%]", column((round) => (round.unshot > 0 ? 100 * round.unshot : null)), 6)] },
        {
          title: "Length of rounds", yLabel: unit.unit,
          series: [
            one(`whole round [${unit.unit}]`, lengths.map((v) => v / unit.size), 0),
            one("its end: the last records on their way", column((round) => round.tail / unit.size), 3),
            one("choosing patches", column((round) => (round.chosen - round.begin) / unit.size), 1),
          ],
        },
        { title: "Patches that shoot", yLabel: "patches, PEs", series: [one("patches", column((round) => round.shooters), 0), one("PEs that have them", column((round) => round.pes), 2)] },
      ],
    };
  }, [rounds]);
  const all = lengths.reduce((total, v) => total + v, 0) || 1;
  const tails = rounds.reduce((total, round) => total + round.tail, 0);
  const choosing = rounds.reduce((total, round) => total + round.chosen - round.begin, 0);
  const shooters = rounds.reduce((total, round) => total + round.shooters, 0);
  const emitted = energy.emitted.reduce((total, v) => total + v, 0);
  const unshot = energy.unshot.reduce((total, v) => total + v, 0);
  return (
    <section id="rounds">
      <h2>Rounds and convergence</h2>
      <p>
        In {grouped(rounds.length)} {rounds.length === 1 ? "round" : "rounds"} {grouped(shooters)} patches shot their light{emitted > 0 ? `; ${percent(unshot / emitted)} of what is emitted was unshot in the end` : ""}. Of the rounds' time, {percent(tails / all)} was spent
        waiting for the last records of a round, and {percent(choosing / all)} on choosing who shoots next.
      </p>
      <div class="grid">
        {charts.map((chart) => <LineChart {...chart} x={x} xLabel="round" syncKey="rounds" whole points height={190} />)}
      </div>
    </section>
  );
}
