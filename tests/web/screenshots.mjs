// SPDX-License-Identifier: MIT
// The pictures of pages in docs/images, as the program makes them: screenshots.mjs TOROLUX ROOT. MODULES names where
// playwright-core is.
import { execFileSync, spawn } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { launch, openPage } from "./browser.mjs";

const [, , torolux, root] = process.argv;
const kShown = ["render", `${root}/scenes/cornell_spheres`, "--pes", "8x8", "--quality", "draft", "--size", "400x400",
  "--samples", "36", "--exposure", "0.5", "--output", "shown.png", "--display", "0"];

/** Of a run with a display: what it prints first, its address. */
function addressOf(run) {
  return new Promise((found, failed) => {
    let told = "";
    run.stderr.on("data", (text) => {
      told += text;
      if (/http:\S+\n/.test(told)) found(told.match(/http:\S+/)[0]);
    });
    run.on("exit", () => failed(new Error(told)));
  });
}

/** While camera rays are under way, half of them done. */
async function showDisplay(browser, folder) {
  const run = spawn(torolux, kShown, { cwd: folder, stdio: ["ignore", "ignore", "pipe"] });
  try {
    const { page } = await openPage(browser, await addressOf(run), /./, { width: 1000 });
    await page.waitForFunction(() => {
      const share = document.querySelector("#progress h2")?.textContent.match(/^ray tracing, ([0-9.]+)/);
      return share && Number(share[1]) >= 55;
    }, undefined, { timeout: 600_000 });
    const { y, height } = await page.locator("#torus").boundingBox();
    await page.screenshot({ path: join(root, "docs/images/display.jpg"), quality: 80, fullPage: true,
      clip: { x: 0, y: 0, width: 1000, height: y + height } });
  } finally {
    run.kill("SIGINT");
  }
}

async function showProfile(browser, folder) {
  execFileSync(torolux, ["profile", `${root}/build/firmware/bin/known_calls.elf`, "--pes", "2x1", "--quiet", "--report", "profile.html"], { cwd: folder });
  const { page } = await openPage(browser, `file://${join(folder, "profile.html")}`, /./, { width: 1000 });
  await page.locator("#profile .frame", { has: page.locator("title", { hasText: "countdown" }) }).first().hover();
  await page.locator("#profile").screenshot({ path: join(root, "docs/images/profile.png") });
}

const folder = mkdtempSync(join(tmpdir(), "torolux-"));
const browser = await launch();
try {
  await showDisplay(browser, folder);
  await showProfile(browser, folder);
} finally {
  await browser.close();
  rmSync(folder, { recursive: true });
}
