// SPDX-License-Identifier: MIT
// Proves: a report opens from a file without a network, in light and dark, wide and narrow, without an error; all parts
// are there; tabs, map, brush and copying work by pointer and by keys: report_test.mjs FOLDER, with render.html,
// run.html and profile.html in it. MODULES names where playwright-core is.
import assert from "node:assert/strict";
import { join } from "node:path";
import { checkLooks, launch, openPage } from "./browser.mjs";

const folder = process.argv[2];
const kSections = ["overview", "limits", "map", "time-line", "histograms", "traffic", "rounds", "energy", "copies", "settings"];
const kStages = ["load", "radiosity", "read", "load_again", "ray_tracing"];

async function open(browser, file, look) {
  const report = await openPage(browser, `file://${join(folder, file)}`, /^(file|data):/, look);
  await report.page.waitForSelector("#settings");
  return report;
}

const kTexts = [".soft", "h2", "th", ".verdict"];

async function checkTabs(page) {
  for (const stage of kStages) {
    await page.click(`#tab-${stage}`);
    assert.equal(await page.getAttribute(`#tab-${stage}`, "aria-selected"), "true");
    assert.ok((await page.textContent("#limits .verdict")).length > 5, stage);
    for (const section of kSections) assert.equal(await page.locator(`#${section}`).count(), 1, `${section} in ${stage}`);
  }
  await page.keyboard.press("ArrowRight"); // around to the first
  assert.equal(await page.getAttribute("#tab-", "aria-selected"), "true");
  await page.keyboard.press("ArrowRight");
  assert.equal(await page.evaluate(() => document.activeElement.id), "tab-load");
  await page.click("#tab-");
}

/** The canvas is painted, and a PE can be chosen by pointer and keys. */
async function checkMap(page) {
  const colours = await page.evaluate(() => {
    const canvas = document.querySelector("#map canvas");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return new Set(new Uint32Array(data.buffer)).size;
  });
  assert.ok(colours > 20, `the map has ${colours} colours`);
  const canvas = page.locator("#map canvas");
  const box = await canvas.boundingBox();
  await canvas.click({ position: { x: box.width - 50, y: box.height - 50 } });
  assert.match(await page.textContent(".pe-details h3"), /^PE 11 \(column 3, row 2\)$/);
  await canvas.focus();
  await page.keyboard.press("ArrowRight"); // around the torus
  assert.match(await page.textContent(".pe-details h3"), /^PE 8 /);
  await page.keyboard.press("ArrowUp");
  assert.match(await page.textContent(".pe-details h3"), /^PE 4 /);
  for (const value of await page.locator("#pe-figure option").evaluateAll((all) => all.map((one) => one.value))) {
    await page.selectOption("#pe-figure", value);
  }
  await page.selectOption("#link-figure", "packets");
  assert.match(await page.textContent("#map"), /links: packets: 0/);
}

async function checkBrush(page) {
  const shown = () => page.textContent("#shown");
  const whole = await shown();
  const chart = page.locator("#time-line .u-over").first();
  await chart.scrollIntoViewIfNeeded();
  const box = await chart.boundingBox();
  await page.mouse.move(box.x + box.width * 0.25, box.y + 40);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.5, box.y + 40, { steps: 5 });
  await page.mouse.up();
  const brushed = await shown();
  assert.notEqual(brushed, whole);
  await page.getByLabel("Shown from").focus();
  await page.keyboard.press("ArrowRight");
  assert.notEqual(await shown(), brushed);
  await page.getByText("Show all").click();
  assert.equal(await shown(), whole);
}

async function checkCopying(page) {
  await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
  await page.click("#copy");
  const copied = await page.evaluate(() => navigator.clipboard.readText());
  assert.match(copied, /^torolux render .*cornell_box .*--pes 4x3/);
  assert.equal(copied, await page.textContent("#command"));
}

async function checkRender(browser) {
  const report = await open(browser, "render.html");
  for (const section of kSections) assert.equal(await report.page.locator(`#${section}`).count(), 1, section);
  assert.ok(await report.page.evaluate(() => document.querySelector(".picture img").naturalWidth === 96), "the picture");
  assert.ok((await report.page.locator(".uplot").count()) >= 8, "charts");
  assert.ok((await report.page.locator("rect.column").count()) > 20, "histograms");
  await checkLooks(report.page, kTexts);
  await checkTabs(report.page);
  await checkMap(report.page);
  await checkBrush(report.page);
  await checkCopying(report.page);
  await report.page.emulateMedia({ colorScheme: "dark" }); // changes while it is open
  await checkLooks(report.page, kTexts);
  assert.deepEqual(report.faults, []);
  await report.close();
}

async function checkRun(browser) {
  const report = await open(browser, "run.html");
  assert.equal(await report.page.locator("#map canvas").count(), 1);
  assert.equal(await report.page.locator("#energy, #rounds, #copies, .picture, .tabs").count(), 0);
  await checkLooks(report.page, kTexts);
  assert.deepEqual(report.faults, []);
  await report.close();
}

/** The flame graph: frames by pointer and keys, closer and back, what is found. */
async function checkProfile(browser) {
  const report = await open(browser, "profile.html");
  const { page } = report;
  const chosen = () => page.textContent("#profile .flame-path strong");
  const frames = () => page.locator("#profile .frame").count();
  await page.locator("#profile .frame").first().waitFor();  // drawn once the page has its width
  const all = await frames();
  assert.ok(all > 15, `${all} frames`);
  assert.equal(await chosen(), "all");
  await page.locator("#profile .flame").focus();
  for (const name of ["_start", "boot", "torolux::pe::pe_main(torolux::pe::Niu&)"]) {
    await page.keyboard.press("ArrowDown");
    assert.equal(await chosen(), name);
  }
  await page.keyboard.press("ArrowUp");
  assert.equal(await chosen(), "boot");
  await page.locator("#profile .frame", { has: page.locator("title", { hasText: "all_calls" }) }).click();
  assert.equal(await chosen(), "all_calls");
  assert.match(await page.textContent(".flame-details"), /itself.*21.cycles.*calls1$/);
  assert.ok((await frames()) < all, "closer");
  await page.keyboard.press("ArrowDown");
  await page.keyboard.press("Enter");
  assert.equal(await chosen(), "countdown");
  await page.keyboard.press("Escape");
  assert.equal(await chosen(), "all_calls");
  await page.click("#flame-all");
  assert.equal(await frames(), all);
  await page.fill("#flame-find", "WAITS: receive");
  assert.match(await page.textContent("#profile .choices"), /[0-9.]+.% of all cycles/);
  assert.equal(await page.locator("#profile .frame.faint").count(), all - 1);
  await checkLooks(page, [...kTexts, ".flame-path strong", ".flame-details dt"]);
  assert.deepEqual(report.faults, []);
  await report.close();
}

async function showProfile(browser, look) {
  const report = await open(browser, "profile.html", look);
  await report.page.waitForTimeout(300);
  await checkLooks(report.page, kTexts);
  await report.page.locator("#profile").screenshot({ path: join(folder, `profile_${look.colorScheme}_${look.width}.png`) });
  assert.deepEqual(report.faults, []);
  await report.close();
}

async function takeScreenshots(browser) {
  for (const colorScheme of ["light", "dark"]) {
    for (const width of [1280, 390]) {
      await showProfile(browser, { colorScheme, width });
      const report = await open(browser, "render.html", { colorScheme, width });
      await report.page.click("#tab-radiosity");
      await report.page.waitForTimeout(300);
      await checkLooks(report.page, kTexts);
      await report.page.screenshot({ path: join(folder, `report_${colorScheme}_${width}.png`), fullPage: true });
      assert.deepEqual(report.faults, []);
      await report.close();
    }
  }
}

const browser = await launch();
try {
  await checkRender(browser);
  await checkRun(browser);
  await checkProfile(browser);
  await takeScreenshots(browser);
} finally {
  await browser.close();
}
console.log("reports: passed");
