// SPDX-License-Identifier: MIT
// What the feed has told, look by look, enters; charts over the time that has passed leave.
import { useEffect, useMemo, useState } from "preact/hooks";
import { LineChart } from "../shared/charts.jsx";
import { kLinkDirections } from "../shared/words.js";

const kInterval = 500; // from point to point, at first [ms]
const kMostPoints = 480; // then every other one is dropped, and points come half as often

const kColumns = ["x", "load", "links", "packets", "unshot"];

/** As long as the page lives. */
class History {
  constructor() {
    for (const column of kColumns) this[column] = [];
    this.interval = kInterval;
    this.next = 0;
  }

  /** False: it is too early, or nothing runs. */
  add({ loads, progress }) {
    if (progress?.state !== "running" || loads.now === undefined || 1000 * progress.elapsed < this.next) return false;
    if (progress.elapsed < this.x[this.x.length - 1]) return false;
    this.next = 1000 * progress.elapsed + this.interval;
    const links = kLinkDirections.flatMap((one) => [...loads.links[one]]);
    this.x.push(progress.elapsed);
    this.load.push((100 * loads.values.reduce((a, b) => a + b, 0)) / loads.pes);
    this.links.push((100 * links.reduce((a, b) => a + b, 0)) / links.length);
    this.packets.push(loads.packets);
    this.unshot.push(progress.stage === "radiosity" && progress.unshot > 0 ? 100 * progress.unshot : null);
    if (this.x.length > kMostPoints) {
      for (const column of kColumns) this[column] = this[column].filter((_, i) => i % 2 === 0);
      this.interval *= 2;
    }
    return true;
  }
}

export function Charts({ feed }) {
  const history = useMemo(() => new History(), []);
  const [count, setCount] = useState(0);
  useEffect(() => feed.listen(() => history.add(feed) && setCount((before) => before + 1)), [feed]);
  const charts = useMemo(() => {
    const list = [
      {
        key: "load", title: "PEs and links", yLabel: "in use [%]", max: 100,
        series: [{ name: "PEs busy [%]", values: [...history.load], area: true }, { name: "links used [%]", values: [...history.links], colour: 1 }],
      },
      { key: "packets", title: "Packets on the torus", yLabel: "packets", series: [{ name: "packets", values: [...history.packets], colour: 2 }] },
    ];
    if (history.unshot.some((value) => value !== null)) {
      list.push({ key: "unshot", title: "Unshot flux", yLabel: "of the emitted [%]", log: true, series: [{ name: "unshot [%]", values: [...history.unshot], colour: 6 }] });
    }
    return list;
  }, [count]);
  const x = useMemo(() => [...history.x], [count]);
  if (x.length < 2) return null;
  return (
    <section id="history">
      <h2>So far</h2>
      <div class="grid">
        {charts.map((chart) => (
          <LineChart {...chart} x={x} xLabel="time [s]" syncKey="history" height={150} />
        ))}
      </div>
    </section>
  );
}
