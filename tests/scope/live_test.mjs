// Tests of the live picture of a running stack: it moves, its values are the log's, zoom and cursors work
// meanwhile.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { cursorCells, readTable, streaming, until } from './browser.mjs';
import { onALivePage } from './live_page.mjs';

let bench, stack, scope, page;

onALivePage((live) => ({ bench, stack, scope, page } = live), { seconds: 3 });

// Tests that the panes of the first visit are those of the rig, and that they move.
test('the default panes move', async () => {
  const titles = await page.locator('.pane h2').allTextContents();
  assert.deepEqual(titles, [
    'Pressure difference',
    'Pressures',
    'Arm angle',
    'Motor speed',
    'Motor voltage',
    'Loop timing',
  ]);
  const picture = () => page.evaluate(() => hydroScope.panes.panes[2].host.querySelector('canvas').toDataURL());
  const first = await picture();
  const { frames, last } = await page.evaluate(() => ({
    frames: hydroScope.panes.frames,
    last: hydroScope.display.last,
  }));
  await until(
    page,
    (before) => hydroScope.panes.frames > before.frames + 10 && hydroScope.display.last > before.last + 0.2,
    { frames, last },
  );
  assert.notEqual(await picture(), first);
  assert.match(await page.locator('[data-channel=dp] .value').textContent(), /\d/);
});

// Tests that the token is in no address that can be seen, and that it survives a reload.
test('the token is out of sight and kept for the tab', async () => {
  assert.equal(await page.evaluate(() => location.href), `${scope.origin}/`);
  await page.reload();
  await streaming(page);
});

// Tests that while it streams, the plots can be paused, zoomed and followed again, and that the server's
// history fills them.
test('zoom and pause while it streams', async () => {
  await page.keyboard.press('Space');
  await until(page, () => hydroScope.display.mode === 'still');
  const { t0, t1 } = await page.evaluate(() => hydroScope.display.window);
  const box = await page.locator('.chart').first().boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.wheel(0, -800);
  await until(page, (span) => hydroScope.display.window.t1 - hydroScope.display.window.t0 < 0.5 * span, t1 - t0);
  await until(page, () => {
    const { t0: from, t1: to, bins } = hydroScope.display.frame();
    return (
      bins.width < 1.3 * Math.max((to - from) / hydroScope.display.pixels, 0.001) &&
      bins.t.some((t, i) => t > from && t < to && !Number.isNaN(bins.min.dp[i]))
    );
  });
  const before = await page.evaluate(() => ({ window: hydroScope.display.window, last: hydroScope.display.last }));
  await until(page, (last) => hydroScope.display.last > last + 0.3, before.last);
  assert.deepEqual(await page.evaluate(() => hydroScope.display.window), before.window);
  await page.keyboard.press('l');
  await until(page, () => hydroScope.display.mode === 'follow');
});

// Tests that drawing all panes, rasterised without a graphics processor, takes less than half of a sixtieth
// of a second. The best of many is taken, as others use this machine: of more, while none was fast enough.
test('drawing leaves time for 60 frames a second', async () => {
  const best = await page.evaluate(async () => {
    let least = Infinity;
    for (let k = 0; k < 25 || (k < 400 && least >= 1000 / 60 / 2); k += 1) {
      const start = performance.now();
      const frame = hydroScope.display.frame();
      for (const pane of hydroScope.panes.panes) pane.draw(frame, null, start);
      await Promise.resolve(); // uPlot draws at the end of the turn
      for (const pane of hydroScope.panes.panes)
        pane.host.querySelector('canvas').getContext('2d').getImageData(0, 0, 1, 1);
      least = Math.min(least, performance.now() - start);
    }
    return least;
  });
  assert.ok(best < 1000 / 60 / 2, `the fastest of 400 drawings took ${best} ms`);
});

// Tests that the time base goes in steps of 1, 2, 5 and the stream follows it.
test('the time base', async () => {
  assert.equal(await page.locator('#base').textContent(), '1 s/div');
  await page.keyboard.press('+');
  assert.equal(await page.locator('#base').textContent(), '500 ms/div');
  await page.getByRole('button', { name: 'Longer time base' }).click();
  await page.getByRole('button', { name: 'Longer time base' }).click();
  assert.equal(await page.locator('#base').textContent(), '2 s/div');
  await page.keyboard.press('+');
});

// Tests that what the cursors read are the log's doubles, every digit, and that the differences are those of
// the log.
test('values and differences at the cursors equal the log', async () => {
  const last = await page.evaluate(() => hydroScope.display.last);
  const [a, b] = [Math.floor(last * 1000 - 900) / 1000, Math.floor(last * 1000 - 250) / 1000];
  // Half a tick after a sample: the value is that of the sample before.
  await page.evaluate(
    ([ta, tb]) => {
      hydroScope.cursors.place('b', tb + 0.0005);
      hydroScope.cursors.place('a', ta + 0.0005);
    },
    [a, b],
  );
  await page.locator('[data-cell="dp.difference"]').waitFor();
  await until(page, () => !document.querySelector('[data-cell="p1.difference"]')?.textContent.includes('–'));
  const cells = await cursorCells(page);
  assert.equal(await page.locator('[data-span="Δt"]').textContent(), '650 ms');
  assert.equal(await page.locator('[data-span="1/Δt"]').textContent(), '1.538 Hz');
  const times = await page.evaluate(() => [hydroScope.cursors.values.a.t, hydroScope.cursors.values.b.t]);

  await stack.stop();
  bench.run('hydro-log', 'export', bench.file('run.lcmlog'), '-o', bench.file('run.csv'));
  const { rows } = readTable(readFileSync(bench.file('run.csv'), 'utf8'));
  const row = (t) => rows.find((one) => Math.abs(Number(one.time_s) - t) < 1e-9);
  const columns = { p1: 'p1_psi', p2: 'p2_psi', arm_angle: 'arm_angle_rad', motor_speed: 'motor_speed_rad_s' };
  for (const [channel, column] of Object.entries(columns)) {
    assert.equal(Number(cells[`${channel}.a`]), Number(row(times[0])[column]), `${channel} at A`);
    assert.equal(Number(cells[`${channel}.b`]), Number(row(times[1])[column]), `${channel} at B`);
    assert.equal(Number(cells[`${channel}.difference`]), Number(row(times[1])[column]) - Number(row(times[0])[column]));
  }
  assert.equal(Number(cells['dp.a']), Number(row(times[0]).p2_psi) - Number(row(times[0]).p1_psi));
});

// Tests that no script failed, and that nothing broke the content security policy.
test('no errors in the page', () => assert.deepEqual(page.problems, []));
