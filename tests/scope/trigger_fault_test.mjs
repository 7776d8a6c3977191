// Tests of the trigger on faults: a running stack is provoked by a limit that is set below what a step of the reference
// needs, and re-armed, which lets the next step pass it again.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { until } from './browser.mjs';
import { onALivePage } from './live_page.mjs';
import { demoConfig } from './stack.mjs';

let bench, page;

// A fault holds the stack at zero volts and does not end it; that the machine is busy is none.
const sets = ['rearm=explicit', 'stale_input_s=10', 'stale_logger_s=30', 'stale_supervisor_s=30'];
onALivePage((live) => ({ bench, page } = live), { sets: sets.map((one) => `limits.${one}`), seconds: 3 });

const captures = () => page.evaluate(() => hydroScope.trigger.captures);
const stack = (name, ...args) => bench.run(name, demoConfig(), '--set', `bus.url=${bench.url}`, ...args);
const faults = () =>
  page.evaluate(() =>
    hydroScope.scope
      .eventsOf()
      .filter(({ kind }) => kind === 'fault')
      .map(({ t }) => t),
  );
const nextFault = async (known) =>
  until(page, (n) => hydroScope.scope.eventsOf().filter(({ kind }) => kind === 'fault').length > n, known);

// Tests that a trigger on faults waits through steps and edges until a limit is passed, has the fault at its moment,
// with the motor beyond its limit just there and the voltage at zero from there on, and stands still.
test('a fault', async () => {
  const limit = 35; // rad/s; a step of the reference takes the motor beyond 70
  await page.evaluate(() => {
    hydroScope.trigger.change({ on: 'fault', mode: 'normal', span: 0.4 });
    hydroScope.trigger.start();
  });
  await until(page, () => hydroScope.trigger.state === 'armed');
  const before = await captures();
  const from = await page.evaluate(() => hydroScope.display.last);
  await until(page, (last) => hydroScope.display.last > last + 2.2, from);
  assert.equal(await captures(), before, 'caught something without a fault');

  stack('hydro-set', `limits.motor_speed=${limit}`);
  await until(page, (n) => hydroScope.trigger.captures > n, before);
  const seen = await page.evaluate(() => {
    const { t, t1, bins } = hydroScope.display.capture;
    const set = hydroScope.scope.eventsOf().findLast(({ kind }) => kind === 'tuning').t;
    const size = (id, i) => Math.max(Math.abs(bins.min[id][i]), Math.abs(bins.max[id][i]));
    const within = (id, low, high) =>
      Math.max(...[...bins.t.keys()].filter((i) => bins.t[i] > low && bins.t[i] < high).map((i) => size(id, i) || 0));
    return {
      t,
      shown: hydroScope.display.mode,
      // The motor may have been on its way when the limit was set.
      before: within('motor_speed', Math.max(set, t - 0.05), t - 0.02),
      there: within('motor_speed', t - 0.02, t + 0.02),
      volts_before: within('voltage', t - 0.05, t),
      volts_after: within('voltage', t + 0.02, t1),
    };
  });
  assert.equal(seen.shown, 'trigger');
  const known = await faults();
  assert.ok(
    known.some((t) => Math.abs(t - seen.t) < 1e-9),
    `the trigger is at ${seen.t} s, faults at ${known}`,
  );
  assert.ok(seen.there > limit, `the motor runs at ${seen.there} rad/s at the trigger`);
  assert.ok(seen.before <= limit, `the motor ran at ${seen.before} rad/s, and nothing triggered`);
  assert.ok(
    seen.volts_before > 1 && seen.volts_after === 0,
    `${seen.volts_before} V before, ${seen.volts_after} after`,
  );

  const count = await captures();
  await until(page, (last) => hydroScope.display.last > last + 1, await page.evaluate(() => hydroScope.display.last));
  assert.equal(await captures(), count);
  assert.equal(await page.evaluate(() => hydroScope.display.capture.t), seen.t);
});

// Tests that a single trigger on faults catches one fault, lets the next one pass, and catches again once armed.
test('a single fault', async () => {
  await page.evaluate(() => hydroScope.trigger.change({ mode: 'single' }));
  await until(page, () => hydroScope.trigger.state === 'armed');
  const again = async () => {
    const known = (await faults()).length;
    stack('hydro-launch', '--rearm');
    await nextFault(known);
  };
  const count = await captures();
  await again();
  await until(page, () => hydroScope.trigger.state === 'stopped');
  assert.equal(await captures(), count + 1);
  const { t } = await page.evaluate(() => hydroScope.display.capture);

  await again();
  const newest = Math.max(...(await faults()));
  assert.ok(newest > t, 'there was no later fault');
  await until(page, (then) => hydroScope.display.last > then + 1, newest);
  assert.equal(await captures(), count + 1, 'the second fault was caught, too');
  assert.equal(await page.evaluate(() => hydroScope.display.capture.t), t);

  await page.getByRole('button', { name: 'Arm again' }).click();
  await until(page, () => hydroScope.trigger.state === 'armed');
  await again();
  await until(page, (n) => hydroScope.trigger.captures === n, count + 2);
  assert.ok((await page.evaluate(() => hydroScope.display.capture.t)) > newest);
});

test('no errors in the page', () => assert.deepEqual(page.problems, []));
