// Headless Chromium for the tests of the page, and what they ask of it.

import { createRequire } from 'node:module';
import { fileURLToPath } from 'node:url';
import { kPatience_ms } from './stack.mjs';

const { chromium } = createRequire(new URL('../../scope/page/package.json', import.meta.url))('playwright-core');

// --no-sandbox: CI runs as root. The other switches keep Chromium from calling home, which here would only
// fail.
const kSwitches = [
  '--headless',
  '--no-sandbox',
  '--disable-gpu',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];

export async function openBrowser() {
  return chromium.launch({ executablePath: fileURLToPath(new URL('gentle_chromium', import.meta.url)), args: kSwitches });
}

// A page on the scope; every script error and every breach of its content security policy fails the test.
export async function openPage(browser, address, options = {}) {
  const context = await browser.newContext({
    viewport: { width: 1280, height: 800 },
    acceptDownloads: true,
    ...options,
  });
  const page = await context.newPage();
  page.setDefaultTimeout(kPatience_ms);
  page.problems = [];
  page.on('pageerror', (error) => page.problems.push(error.stack ?? String(error)));
  page.on('console', (message) => {
    if (/Content Security Policy|Uncaught/.test(message.text())) page.problems.push(message.text());
  });
  await page.goto(address);
  return page;
}

// Waits until the expression over the page's parts (hydroScope) is true.
export function until(page, condition, argument) {
  return page.waitForFunction(condition, argument, { timeout: kPatience_ms, polling: 50 });
}

// Live, streaming, and with this many seconds of run.
export async function streaming(page, seconds = 0.5) {
  await page
    .locator('#link[data-state=open]')
    .waitFor()
    .catch(async () => {
      throw new Error(`not streaming: the page says "${await page.locator('#link').textContent()}"`);
    });
  await until(
    page,
    (least) => hydroScope.panes.frames > 3 && hydroScope.display.last > least && hydroScope.panes.panes.length > 0,
    seconds,
  );
}

// What the cursor table shows, every digit: {"dp.a": "1.25", ...}.
export async function cursorCells(page) {
  return page.evaluate(() =>
    Object.fromEntries(
      [...document.querySelectorAll('[data-cell]')].map((cell) => [
        cell.dataset.cell,
        cell.dataset.exact.replace('\u2212', '-'),
      ]),
    ),
  );
}

// Pixels of a pane that have a colour of the style sheet; ask: {pane, colour, t0, t1, low, high: values on
// its left axis}.
export function pixelsOf(page, ask) {
  return page.evaluate((ask) => {
    const { chart, host } = hydroScope.panes.panes[ask.pane];
    const canvas = host.querySelector('canvas');
    const wanted = hydroScope.panes.colours[ask.colour].match(/\w\w/g).map((hex) => parseInt(hex, 16));
    const [x0, x1] = [Math.floor(chart.x(ask.t0)), Math.ceil(chart.x(ask.t1))];
    const [y0, y1] = [Math.floor(chart.y(ask.high, 0)), Math.ceil(chart.y(ask.low, 0))];
    const { data, width } = canvas.getContext('2d').getImageData(x0, y0, Math.max(1, x1 - x0), Math.max(1, y1 - y0));
    const found = [];
    for (let i = 0; i < data.length; i += 4) {
      const near = wanted.every((value, k) => Math.abs(value - data[i + k]) < 60);
      if (near) found.push({ x: x0 + ((i / 4) % width), y: y0 + Math.floor(i / 4 / width) });
    }
    return found;
  }, ask);
}

// A table of hydro-log export: {columns, rows: [{name: text}]}.
export function readTable(text) {
  const [head, ...lines] = text.trim().split('\n');
  const columns = head.split(',');
  return {
    columns,
    rows: lines.map((line) => Object.fromEntries(line.split(',').map((cell, i) => [columns[i], cell]))),
  };
}
