// Tests of logs in the page: a spike of one sample is seen, gaps are gaps, playing, stepping, seeking,
// opening.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { pixelsOf, until } from './browser.mjs';
import { kGap, kSpike, onALogWithAGap } from './gap_log.mjs';

let bench, page, table;

onALogWithAGap((open) => ({ bench, page, table } = open));

const paneOf = (channel) =>
  page.evaluate((id) => hydroScope.scope.layout.panes.findIndex((pane) => pane.channels.includes(id)), channel);

// Tests that with the whole run on the screen, six samples and more in a pixel, a single sample stands as
// tall as it was.
test('a spike of one sample is seen', async () => {
  const { samples, pixels } = await page.evaluate(() => ({
    samples: (hydroScope.display.last - hydroScope.display.first) * hydroScope.scope.run.rate_hz,
    pixels: hydroScope.display.pixels,
  }));
  assert.ok(samples > 5 * pixels, `${samples} samples on ${pixels} pixels`);
  const pane = await paneOf('p1');
  await until(
    page,
    (p) => hydroScope.panes.panes[p].chart.y(900) > hydroScope.panes.panes[p].chart.plot.bbox.top,
    pane,
  );
  const top = await pixelsOf(page, {
    pane,
    colour: 'c0',
    t0: kSpike.t - 0.05,
    t1: kSpike.t + 0.05,
    low: 0.9 * kSpike.psi,
    high: 1.02 * kSpike.psi,
  });
  assert.ok(top.length >= 1, 'nothing is drawn at the height of the spike');
  const columns = new Set(top.map(({ x }) => x));
  assert.ok(columns.size <= 3, `one sample is ${columns.size} pixels wide`);
  const beside = await pixelsOf(page, {
    pane,
    colour: 'c0',
    t0: kSpike.t + 0.3,
    t1: kSpike.t + 0.9,
    low: 0.5 * kSpike.psi,
    high: 1.02 * kSpike.psi,
  });
  assert.equal(beside.length, 0);
});

// Tests that where no sample was recorded no line is drawn.
test('a gap is a gap', async () => {
  const pane = await paneOf('p1');
  const middle = (kGap.from + kGap.to) / 2000;
  const inside = await pixelsOf(page, { pane, colour: 'c0', t0: middle - 0.05, t1: middle + 0.05, low: 0, high: 900 });
  assert.equal(inside.length, 0);
  const right = await pixelsOf(page, { pane, colour: 'c0', t0: middle + 0.11, t1: middle + 0.3, low: 0, high: 900 });
  assert.ok(right.length > 0, 'no line after the gap');
});

// Tests that each step of one sample shows the next row of the table, exactly.
test('seek and step by step', async () => {
  await page.evaluate((t) => hydroScope.display.seek(t), kSpike.t - 0.002);
  for (const row of [kSpike.row - 1, kSpike.row, kSpike.row + 1]) {
    await page.keyboard.press('.');
    const head = await page.evaluate(() => hydroScope.display.head);
    assert.equal(Math.round(head * 1000), row);
    const reply = await page.evaluate(
      (t) => hydroScope.link.request({ op: 'values', run: hydroScope.scope.run.run, channels: ['p1'], t }),
      head + 0.0001,
    );
    assert.equal(reply.data.values[0], Number(table.rows[row].p1_psi));
  }
  await page.keyboard.press(',');
  assert.equal(Math.round((await page.evaluate(() => hydroScope.display.head)) * 1000), kSpike.row);
});

// Tests that a log plays at the speed that was chosen, and stops when paused.
test('play at ten times', async () => {
  await page.getByLabel('Speed', { exact: true }).selectOption('10');
  await page.keyboard.press('Home');
  await page.evaluate(() => hydroScope.display.seek(0));
  const started = Date.now();
  await page.getByRole('button', { name: 'Play', exact: true }).click();
  await until(page, () => hydroScope.display.head >= 2);
  const wall = (Date.now() - started) / 1000;
  assert.ok(wall > 0.15, `2 s at ten times took ${wall} s`);
  await page.keyboard.press('Space');
  await until(page, () => !hydroScope.player.playing);
  const head = await page.evaluate(() => hydroScope.display.head);
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  assert.equal(await page.evaluate(() => hydroScope.display.head), head);
});

// Tests that the bar of the whole run goes to the moment that is pressed.
test('scrub', async () => {
  const box = await page.locator('.overview').boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  const { head, last } = await page.evaluate(() => ({ head: hydroScope.display.head, last: hydroScope.display.last }));
  assert.ok(Math.abs(head - last / 2) < 0.02 * last, `${head} of ${last}`);
});

// Tests that the values at the end of the window are said with their time, as they stand in the log.
test('values in words', async () => {
  await page.evaluate((end) => hydroScope.display.showWindow(end - 0.1, end), kSpike.t + 1e-6);
  const psi = (row) => Number(table.rows[row].p1_psi).toPrecision(4);
  await until(page, () => {
    const { bins, t0, t1 } = hydroScope.display.frame();
    return hydroScope.display.cache.covers(t0, t1) && bins.width < 0.0011;
  });
  await page.keyboard.press('v');
  const said = await page.locator('#said').textContent();
  const [, time, value] = /^At ([\d.]+) s: .*, pressure of side 1 ([\d.]+) psi, /.exec(said) ?? [];
  assert.equal(time, '3.210');
  // A pixel may end at the sample after the moment.
  const right = [kSpike.row - 1, kSpike.row, kSpike.row + 1].map(psi);
  assert.ok(right.includes(value), `${value} psi, not one of ${right}`);
});

// Tests that the clock does not go on where the window is longer than the log.
test('the clock ends with the log', async () => {
  await page.evaluate(() => hydroScope.display.showWindow(hydroScope.display.last - 1, hydroScope.display.last + 1));
  const last = await page.evaluate(() => hydroScope.display.last);
  await page
    .locator('#clock')
    .getByText(`${last.toFixed(3)} s`, { exact: true })
    .waitFor();
});

// Tests that STOP and re-arm say why they do nothing in a log.
test('a log cannot be stopped', async () => {
  assert.equal(await page.locator('#stop').getAttribute('aria-disabled'), 'true');
  assert.equal(await page.locator('#rearm').isDisabled(), true);
  await page.keyboard.press('s');
  await page.getByText('There is nothing to stop').waitFor();
});

// Tests that a log that is dropped on the page is opened, shown, and can be laid over.
test('a log that is dropped on the page opens', async () => {
  const bytes = readFileSync(bench.file('sim.lcmlog')).toString('base64');
  await page.evaluate((text) => {
    const transfer = new DataTransfer();
    transfer.items.add(new File([Uint8Array.from(atob(text), (one) => one.charCodeAt(0))], 'dropped.lcmlog'));
    document.body.dispatchEvent(new DragEvent('drop', { bubbles: true, cancelable: true, dataTransfer: transfer }));
  }, bytes);
  await until(
    page,
    () => hydroScope.scope.run.name === 'dropped.lcmlog' && hydroScope.display.frame().bins.t.length > 100,
  );
  await page.locator('#section-ghost summary').click();
  await page.getByLabel('Lay over').selectOption('spike.lcmlog');
  await page.locator('#section-ghost').getByRole('spinbutton').fill('0.5');
  await page.locator('#section-ghost').getByRole('spinbutton').press('Enter');
  await until(
    page,
    () =>
      hydroScope.panes.panes[1].chart.other?.bins.t.length > 100 && hydroScope.panes.panes[1].chart.other.shift === 0.5,
  );
  const pane = await paneOf('p1');
  await until(
    page,
    (p) => hydroScope.panes.panes[p].chart.y(900) > hydroScope.panes.panes[p].chart.plot.bbox.top,
    pane,
  );
  const shifted = await page.evaluate(() => {
    const { bins, shift } = hydroScope.panes.panes[1].chart.other;
    return bins.t[bins.max.p1.findIndex((value) => value === 900)] + shift;
  });
  assert.ok(Math.abs(shifted - kSpike.t - 0.5) < 0.02, `the spike of the other run is at ${shifted}`);
  await page.getByRole('button', { name: 'Align steps' }).click();
  await until(page, () => hydroScope.overlay.shift === 0);
  await page.getByLabel('Shift of the other run').press('ArrowRight');
  assert.equal(await page.evaluate(() => hydroScope.overlay.shift), 0.001);
});

test('no errors in the page', () => assert.deepEqual(page.problems, []));
