// SPDX-License-Identifier: MIT
// Proves: the display of a run shows its picture and torus while they change, ends as the .png is, works by keys alone,
// in light and dark, wide and narrow, asks nothing of any other place, and finds a server that comes back:
// display_test.mjs TOROLUX ROOT FOLDER. MODULES names where playwright-core is.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { checkLooks, launch, openPage } from "./browser.mjs";

const [, , torolux, root, folder] = process.argv;
const kTexts = [".soft", "h2", "dt"];

const children = [];

/** A run with a display; `ended` gives its exit code. */
async function start(words) {
  const child = spawn(torolux, words, { cwd: folder });
  children.push(child);
  let told = "";
  child.stderr.on("data", (text) => (told += text));
  child.stdout.on("data", () => {});
  const ended = new Promise((done) => child.on("exit", (code, signal) => done(code ?? signal)));
  for (let i = 0; i < 200 && !/http:\S+\n/.test(told); ++i) await new Promise((done) => setTimeout(done, 50));
  const url = told.match(/http:\S+/)?.[0];
  assert.ok(url, told);
  return { child, url, ended };
}

const kRender = ["render", `${root}/scenes/cornell_box`, "--quality", "draft", "--pes", "4x3", "--threads", "1"];

/** An own server, and what pages have in themselves. */
function open(browser, url, look) {
  const own = new URL(url).origin;
  return openPage(browser, url, new RegExp(`^(${own}/|data:)`), look);
}

/** A number that depends on every pixel of a canvas, and how many colours it has. */
function canvasOf(page, selector) {
  return page.evaluate((one) => {
    const shown = document.querySelector(one);
    const canvas = new OffscreenCanvas(shown.width, shown.height);
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(shown, 0, 0);
    const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
    const words = new Uint32Array(data.buffer);
    let hash = 0;
    for (const word of words) hash = (Math.imul(hash, 31) + word) | 0;
    return { hash, colours: new Set(words).size };
  }, selector);
}

/** Looks again and again until `good` says so of what `look` gives. */
async function until(what, look, good, seconds = 60) {
  for (let i = 0; i < 10 * seconds; ++i) {
    if (good(await look())) return;
    await new Promise((done) => setTimeout(done, 100));
  }
  assert.fail(`not in ${seconds} s: ${what}`);
}

/** While it runs: each of these takes several values. */
async function checkChanges(page) {
  const pictures = new Set();
  const maps = new Set();
  const done = new Set();
  await until("done", async () => {
    pictures.add((await canvasOf(page, "#picture canvas")).hash);
    maps.add((await canvasOf(page, "#torus canvas")).hash);
    done.add(await page.evaluate(() => document.querySelector("progress")?.value));
    return page.textContent("#progress h2");
  }, (text) => text === "Done");
  assert.ok(pictures.size > 3, `${pictures.size} pictures`);
  assert.ok(maps.size > 3, `${maps.size} maps`);
  assert.ok(done.size > 3, `${done.size} values of progress`);
}

/** Each channel of each pixel is that of the .png, but for a step where both round. */
async function checkPicture(page, file) {
  const png = `data:image/png;base64,${readFileSync(file).toString("base64")}`;
  const most = () => page.evaluate(async (address) => {
    const image = new Image();
    image.src = address;
    await image.decode();
    const bytes = (shown) => {
      const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
      context.drawImage(shown, 0, 0);
      return context.getImageData(0, 0, image.width, image.height).data;
    };
    const expected = bytes(image);
    return bytes(document.querySelector("#picture canvas")).reduce((worst, value, i) => Math.max(worst, Math.abs(value - expected[i])), 0);
  }, png);
  await until("the picture is the .png's", most, (worst) => worst <= 1, 3);
}

/** Everything that can be worked by pointer is reached by Tab, and shows that it is. */
async function checkKeys(page) {
  const reached = new Set();
  await page.evaluate(() => document.activeElement.blur());
  for (let i = 0; i < 30; ++i) {
    await page.keyboard.press("Tab");
    const [name, outline] = await page.evaluate(() => {
      const one = document.activeElement;
      return [one.id || `${one.closest("section")?.id} ${one.localName} ${one.textContent.slice(0, 20)}`, getComputedStyle(one).outlineStyle];
    });
    if (name.startsWith("undefined")) break;
    assert.notEqual(outline, "none", `the focus on ${name} is seen`);
    reached.add(name.startsWith("torus canvas") ? "torus canvas" : name);
  }
  for (const one of ["exposure", "curve", "picture button As the .png", "picture canvas ", "picture button Bookmark", "pe-figure", "torus canvas", "end button End the display"]) {
    const key = one.replace("end button", "progress button");
    assert.ok(reached.has(key), `${key} among ${[...reached].join(", ")}`);
  }
  const before = await canvasOf(page, "#picture canvas");
  await page.focus("#exposure");
  for (let i = 0; i < 5; ++i) await page.keyboard.press("ArrowRight");
  await until("another exposure", () => canvasOf(page, "#picture canvas"), ({ hash }) => hash !== before.hash, 3);
  await page.locator("#picture").getByText("As the .png").press("Enter");
  await until("as it was", () => canvasOf(page, "#picture canvas"), ({ hash }) => hash === before.hash, 3);
  await page.focus("#torus canvas");
  await page.keyboard.press("ArrowLeft");
  await page.keyboard.press("ArrowDown");
  assert.match(await page.textContent(".pe-details h3"), /^PE 7 \(column 3, row 1\)/);
  await page.selectOption("#pe-figure", "phase");
}

/** By keys and mouse elsewhere, and back: the picture is the first one to the byte, but for the page's own rounding. */
async function checkWalk(page, file) {
  const done = async (what) => {
    await page.waitForTimeout(500);  // the heading comes after the picture: it may still tell of the view before
    await until(what, () => page.textContent("#progress h2"), (text) => text === "Done", 30);
    await page.waitForTimeout(500);  // the exposure of all of it comes with the next painting
  };
  const start = await canvasOf(page, "#picture canvas");
  await page.focus("#picture canvas");
  for (const key of ["ArrowRight", "w", "W", "d", "r", "ArrowUp"]) await page.keyboard.press(key);
  await until("another view", () => canvasOf(page, "#picture canvas"), ({ hash }) => hash !== start.hash, 10);
  await done("a view by keys");
  const keys = await canvasOf(page, "#picture canvas");
  await page.getByText("Bookmark", { exact: true }).press("Enter");
  assert.match(await page.inputValue("#marks"), /^\[\[camera\]\]\neye = \[.*\]\nlook_at = \[.*\]\nup = \[0, 1, 0\]\nfov = [0-9.]+\n$/);
  const box = await page.locator("#picture canvas").boundingBox();
  await page.mouse.move(box.x + 200, box.y + 200);
  await page.mouse.down();
  await page.mouse.move(box.x + 260, box.y + 230, { steps: 4 });
  await page.mouse.up();
  await until("a third view", () => canvasOf(page, "#picture canvas"), ({ hash }) => ![start.hash, keys.hash].includes(hash), 10);
  await done("a view by mouse");
  await page.getByText("Bookmark 1").press("Enter");
  await until("the bookmark's", () => canvasOf(page, "#picture canvas"), ({ hash }) => hash === keys.hash, 30);
  await page.getByText("Back to the start").press("Enter");
  await until("the start's", () => canvasOf(page, "#picture canvas"), ({ hash }) => hash === start.hash, 30);
  await done("the first view");
  await checkPicture(page, file);
}

/** A click on the picture and on a PE, then by keys; what is told is lit up in the picture. */
async function checkAsking(page) {
  const heading = () => page.textContent("#answers").then((text) => text ?? "");
  const shown = await canvasOf(page, "#picture canvas");
  await page.evaluate(() => scrollTo(0, 0));
  const box = await page.locator("#picture canvas").boundingBox();
  await page.mouse.click(box.x + box.width * 0.35, box.y + box.height * 0.8);
  await until("the element", heading, (text) => /Element \d+, front, of white.*Where its light comes from/.test(text), 10);
  assert.ok((await canvasOf(page, "#picture canvas.lit")).colours === 2, "some of the picture is lit up");
  await page.screenshot({ path: join(folder, "display_element.png"), fullPage: true });
  await page.getByText("Follow its ray").press("Enter");
  await until("its story", heading, (text) => /The ray of pixel \d+, \d+, sample 0.*the pixel has got/.test(text), 10);
  await page.screenshot({ path: join(folder, "display_story.png"), fullPage: true });
  assert.equal((await canvasOf(page, "#picture canvas")).hash, shown.hash, "the picture stays");
  await page.focus("#torus canvas");
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("Enter");
  await until("the PE", heading, (text) => /PE \d+ \(column \d, row \d\).*local memory/.test(text), 10);
  await page.screenshot({ path: join(folder, "display_pe.png"), fullPage: true });
  await checkLooks(page, kTexts);
  await page.getByText("Close", { exact: true }).press("Enter");
  assert.equal(await page.locator("#picture canvas.lit").count(), 0);
}

async function checkRender(browser) {
  // It stands until the page is there, however long that takes on a busy computer.
  const run = await start([...kRender, "--size", "640x480", "--samples", "16", "--output", "box.png", "--display", "0", "--paused"]);
  const { page, faults, close } = await open(browser, run.url);
  await page.waitForSelector("#torus canvas");
  await page.getByText("Full speed").press("Enter");
  await checkChanges(page);
  await checkPicture(page, join(folder, "box.png"));
  await checkKeys(page);
  await checkLooks(page, kTexts);
  await takeScreenshots(browser, run.url, "display_done");
  await checkAsking(page);
  await checkWalk(page, join(folder, "box.png"));
  await page.getByText("End the display").press("Enter");
  await until("the page says that it is over", () => page.textContent("#connection"), (text) => /has ended/.test(text), 5);
  assert.equal(await run.ended, 0);
  assert.deepEqual(faults, []);
  await close();
}

/** A page that comes late and one that is narrow see the whole state. */
async function takeScreenshots(browser, url, name) {
  for (const colorScheme of ["light", "dark"]) {
    for (const width of [1280, 390]) {
      const { page, faults, close } = await open(browser, url, { colorScheme, width });
      await page.waitForSelector("#torus canvas");
      await until("a picture", () => canvasOf(page, "#picture canvas"), ({ colours }) => colours > 100, 10);
      await checkLooks(page, kTexts);
      await page.screenshot({ path: join(folder, `${name}_${colorScheme}_${width}.png`), fullPage: true });
      assert.deepEqual(faults, []);
      await close();
    }
  }
}

/** Stopped from the page, with the question asked; then another run at the same port is found by itself. */
async function checkStopping(browser) {
  const run = await start([...kRender, "--quality", "fine", "--size", "64x64", "--no-picture", "--display", "0"]);
  const { page, faults, close } = await open(browser, run.url);
  await page.getByText("Stop the run").click();
  await page.getByText("Go on").press("Enter");
  await page.getByText("Stop the run").click();
  await page.getByText("Stop it").click();
  assert.equal(await run.ended, 130);
  await until("the page says that it is over", () => page.textContent("#connection"), (text) => /has ended/.test(text), 5);
  assert.deepEqual(faults, []);
  await close();
}

async function checkReconnecting(browser) {
  const image = ["run", `${root}/build/firmware/bin/hello.elf`];
  const first = await start([...image, "--pes", "2x2", "--display", "0"]);
  const { page, faults, close } = await open(browser, first.url);
  await until("what PEs say", () => page.textContent("#texts pre"), (text) => /Hello from PE 3/.test(text), 10);
  assert.equal(await page.locator("#picture").count(), 0);
  first.child.kill("SIGKILL");
  await first.ended;
  await until("the page says that it is alone", () => page.textContent("#connection"), (text) => /Trying again/.test(text), 5);
  const second = await start([...image, "--pes", "4x2", "--display", new URL(first.url).port]);
  await until("the page shows the other run", () => page.textContent("header"), (text) => /4 . 2 PEs/.test(text), 20);
  await page.getByText("End the display").click();
  assert.equal(await second.ended, 0);
  // Chromium says on the console that nobody answers; nothing else is told.
  assert.deepEqual(faults.filter((fault) => !/ERR_CONNECTION_REFUSED|ERR_INCOMPLETE_CHUNKED|ERR_CONNECTION_RESET/.test(fault)), []);
  await close();
}

/** An image that would be over at once stands until the page lets it go: packet by packet, slowly, at full speed. */
async function checkPace(browser) {
  const run = await start(["run", `${root}/build/firmware/bin/token.elf`, "--pes", "4x3", "--display", "0", "--paused"]);
  const { page, faults, close } = await open(browser, run.url);
  await page.waitForSelector("#pace");
  const now = async () => Number((await page.textContent("#pace-now")).match(/cycle ([\d\s]+)/)?.[1].replace(/\s/g, "") ?? -1);
  const cycles = [0];
  for (const name of ["Next packet", "Next packet", "Next event", "Next packet"]) {
    await page.getByText(name).press("Enter");
    await until(name, now, (cycle) => cycle > cycles.at(-1), 5);
    await page.waitForTimeout(200);
    cycles.push(await now());
    await page.waitForTimeout(200);
    assert.equal(await now(), cycles.at(-1), "it stands");
  }
  const maps = new Set();
  await page.focus("#speed");
  await page.keyboard.press("Home");  // 10 cycles in a second: the whole run has some hundred
  await page.getByText("Slow motion", { exact: true }).first().press("Enter");
  await until("packets on their way", async () => {
    maps.add((await canvasOf(page, "#torus canvas")).hash);
    return Math.min(maps.size, Number((await page.textContent("#pace-now")).match(/way: (\d+)/)?.[1] ?? 0) > 0 ? 99 : 0);
  }, (seen) => seen > 3, 20);
  await page.screenshot({ path: join(folder, "display_slow.png"), fullPage: true });
  await page.getByText("Full speed").press("Enter");
  await until("done", () => page.textContent("#progress h2"), (text) => text === "Done", 20);
  assert.match(await page.textContent("#texts"), /PE 0/);
  await page.getByText("End the display").press("Enter");
  assert.equal(await run.ended, 0);
  assert.deepEqual(faults, []);
  await close();
}

const browser = await launch();
try {
  await checkRender(browser);
  await checkStopping(browser);
  await checkPace(browser);
  await checkReconnecting(browser);
} finally {
  for (const child of children) child.kill("SIGKILL"); // those that a fault has left behind
  await browser.close();
}
console.log("display: passed");
