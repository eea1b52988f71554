// SPDX-License-Identifier: MIT
// What tests of pages have in common: Chromium, a page whose every fault is noted, and what each page must look like.
// MODULES names where playwright-core is.
import assert from "node:assert/strict";
import { createRequire } from "node:module";

const { chromium } = createRequire(`${process.env.MODULES}/`)("playwright-core");
const kFlags = ["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-component-update",
  "--disable-sync", "--no-first-run", "--disable-quic"];

export function launch() {
  return chromium.launch({ executablePath: "/usr/bin/chromium", args: kFlags });
}

/**
 * Opens a page; whatever is told on the console, thrown, or asked of another place than `own` (a pattern of addresses)
 * makes `faults` longer.
 */
export async function openPage(browser, url, own, { colorScheme = "light", width = 1280 } = {}) {
  const context = await browser.newContext({ colorScheme, viewport: { width, height: 900 } });
  const page = await context.newPage();
  const faults = [];
  page.on("console", (message) => faults.push(`console: ${message.text()}`));
  page.on("pageerror", (error) => faults.push(`thrown: ${error.stack}`));
  page.on("request", (request) => own.test(request.url()) || faults.push(`request: ${request.url()}`));
  await page.goto(url);
  return { page, faults, close: () => context.close() };
}

/** Text of each selector can be told from its ground (WCAG AA: 4.5), and nothing is wider than the window. */
export async function checkLooks(page, selectors) {
  assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "the page is wider than the window");
  const contrast = await page.evaluate((all) => {
    const light = (colour) => {
      const parts = colour.match(/[\d.]+/g).slice(0, 3).map((c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4));
      return 0.2126 * parts[0] + 0.7152 * parts[1] + 0.0722 * parts[2] + 0.05;
    };
    const ground = light(getComputedStyle(document.body).backgroundColor);
    return all.map((one) => {
      const ink = light(getComputedStyle(document.querySelector(one)).color);
      return Math.max(ink, ground) / Math.min(ink, ground);
    });
  }, selectors);
  assert.ok(Math.min(...contrast) >= 4.5, `contrast ${contrast}`);
}
