// SPDX-License-Identifier: MIT
// The command that repeats the run, to be copied, and every setting that determines it.
import { useState } from "preact/hooks";

/** A word as a POSIX shell takes it. */
export function quoted(word) {
  return /^[A-Za-z0-9_@%+=:,./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`;
}

/** {a: {b: 1}} -> [["a.b", 1]]. */
function flat(value, name = "") {
  if (value === null || typeof value !== "object") return [[name, value]];
  if (Array.isArray(value) && value.every((one) => one === null || typeof one !== "object")) return [[name, value.join(", ")]];
  return Object.entries(value).flatMap(([key, one]) => flat(one, name ? `${name}.${key}` : key));
}

async function copy(text, element) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    // Where pages from files may not: what is selected can be.
    getSelection().selectAllChildren(element);
    document.execCommand("copy");
  }
}

export function Settings({ statistics }) {
  const words = ["torolux", ...statistics.command_line].map(quoted);
  const command = words.join(" ");
  const [done, setDone] = useState(false);
  const click = async () => {
    await copy(command, document.getElementById("command"));
    setDone(true);
    setTimeout(() => setDone(false), 2000);
  };
  return (
    <section id="settings">
      <h2>The same again</h2>
      <p>This command repeats the run: the same picture, cycles and statistics.</p>
      <pre id="command" tabIndex={0}>{words.map((word, i) => <>{i > 0 && " "}<span>{word}</span></>)}</pre>
      <button id="copy" onClick={click}>{done ? "Copied" : "Copy"}</button>
      <span class="soft" role="status">{done ? " The command has been copied." : ""}</span>
      <details>
        <summary>All settings</summary>
        <table class="settings">
          <tbody>{flat(statistics.settings).map(([key, value]) => <tr><td>{key}</td><td class="words">{String(value)}</td></tr>)}</tbody>
        </table>
      </details>
    </section>
  );
}
