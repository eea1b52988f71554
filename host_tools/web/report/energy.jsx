// SPDX-License-Identifier: MIT
// The energy balance of the radiosity stage: where the emitted flux has gone.
import { Legend, Stack } from "../shared/charts.jsx";
import { percent, significant } from "../shared/format.js";

const kParts = [
  ["absorbed", "absorbed by diffuse and glossy surfaces", "s0"],
  ["absorbed_specular", "absorbed by mirrors and glass", "s5"],
  ["unshot", "unshot: not yet sent on", "s1"],
  ["escaped", "escaped from the scene", "s2"],
  ["cut_off", "cut off after the most bounces", "s3"],
  ["back_side", "on back sides of surfaces", "s4"],
];

export function Energy({ energy }) {
  const total = (values) => values.reduce((all, value) => all + value, 0);
  const emitted = total(energy.emitted);
  if (!(emitted > 0)) return null;
  const parts = kParts.map(([key, name, colour]) => ({ key, name, colour, share: total(energy[key]) / emitted, text: percent(total(energy[key]) / emitted) }));
  return (
    <section id="energy">
      <h2>Energy balance</h2>
      <Stack parts={parts} label="Emitted flux" />
      <Legend parts={parts} />
      <div class="scroll">
        <table>
          <thead><tr><th>flux [W]</th><th>red</th><th>green</th><th>blue</th><th>of the emitted</th></tr></thead>
          <tbody>
            {[["emitted", "emitted"], ...kParts].map(([key, name]) => (
              <tr>
                <td>{name}</td>
                {energy[key].map((value) => <td>{significant(value, 5)}</td>)}
                <td>{percent(total(energy[key]) / emitted)}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
      <p class="soft">What is emitted less all the rest, in the worst channel: {significant(energy.closing_error, 2)} of it.</p>
    </section>
  );
}
