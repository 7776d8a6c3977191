// Tests of the trigger on a running stack: the picture stands still on a step or a level until the next one comes.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { until } from './browser.mjs';
import { onALivePage } from './live_page.mjs';
import { kAmplitude } from './stack.mjs';

let page;

onALivePage((live) => ({ page } = live));

const form = (name) => page.locator(`#section-trigger [data-name=${name}]`);
const captures = () => page.evaluate(() => hydroScope.trigger.captures);
const nextCapture = async () => until(page, (before) => hydroScope.trigger.captures > before, await captures());

// Tests that the step of the reference stands at the trigger, the picture does not move while the run goes
// on, and the next step takes its place.
test('the trigger stands still on a step of the reference', async () => {
  await form('on').selectOption('step');
  await form('span').fill('0.4');
  await form('span').press('Enter');
  await page.keyboard.press('t');
  await until(page, () => hydroScope.trigger.captures >= 1 && hydroScope.display.mode === 'trigger');
  const step = () =>
    page.evaluate((half) => {
      const { t, bins } = hydroScope.display.capture;
      // Bins narrower than a tick are without a sample now and then.
      const seen = [...bins.min.arm_ref.keys()].filter((i) => !Number.isNaN(bins.min.arm_ref[i]));
      const at = seen.find((i, k) => k > 0 && Math.abs(bins.min.arm_ref[i] - bins.min.arm_ref[seen[k - 1]]) > half);
      return {
        t,
        offset: bins.t[at] - t,
        width: bins.width,
        window: hydroScope.display.window,
        last: hydroScope.display.last,
      };
    }, kAmplitude);
  const first = await step();
  assert.ok(Math.abs(first.offset) <= 0.006 + first.width, `the step is ${first.offset} s from the trigger`);
  await until(page, (last) => hydroScope.display.last > last + 0.1, first.last);
  await nextCapture();
  const second = await step();
  assert.ok(second.t > first.t + 0.5, `${second.t} after ${first.t}`);
  assert.ok(Math.abs(second.offset) <= 0.006 + second.width);
  assert.deepEqual(second.window, first.window);
});

// Tests that cursors stay where they are on the standing picture when another capture takes its place.
test('cursors stay beside the trigger', async () => {
  const place = () => page.evaluate(() => hydroScope.cursors.at.a - hydroScope.display.capture.t);
  await page.evaluate(() => hydroScope.cursors.place('a', hydroScope.display.capture.t + 0.1));
  const first = await place();
  await nextCapture();
  assert.ok(Math.abs((await place()) - first) < 1e-9);
  await page.evaluate(() => hydroScope.cursors.clear());
});

// Tests that a level is crossed at the trigger, in the direction that was asked for.
test('a falling level of the arm angle', async () => {
  await form('on').selectOption('level');
  await form('channel').selectOption('arm_angle');
  await form('edge').selectOption('falling');
  await form('level').fill('0.02');
  await form('level').press('Enter');
  await nextCapture();
  const { before: above, after: below } = await page.evaluate(() => {
    const { t, bins } = hydroScope.display.capture;
    // The nearest on both sides that have a sample: a late plant skips some.
    const seen = [...bins.t.keys()].filter((i) => !Number.isNaN(bins.max.arm_angle[i]));
    return {
      before: bins.max.arm_angle[seen.findLast((i) => bins.t[i] < t - bins.width)],
      after: bins.min.arm_angle[seen.find((i) => bins.t[i] > t + bins.width)],
    };
  });
  assert.ok(above > 0.02 && below < 0.02, `${above} before, ${below} after`);
});

// Tests that the level's line can be dragged.
test('the level is dragged', async () => {
  const pane = await page.evaluate(() =>
    hydroScope.scope.layout.panes.findIndex((one) => one.channels.includes('arm_angle')),
  );
  const place = await page.evaluate((p) => {
    const { chart } = hydroScope.panes.panes[p];
    const box = chart.plot.over.getBoundingClientRect();
    return {
      x: box.x + box.width * 0.7,
      y: box.y + (chart.y(0.02) - chart.plot.bbox.top) / devicePixelRatio,
      to: box.y + (chart.y(-0.02) - chart.plot.bbox.top) / devicePixelRatio,
    };
  }, pane);
  await page.mouse.move(place.x, place.y);
  await page.mouse.down();
  await page.mouse.move(place.x, (place.y + place.to) / 2);
  await page.mouse.move(place.x, place.to);
  await page.mouse.up();
  const level = await page.evaluate(() => hydroScope.trigger.settings.level);
  assert.ok(Math.abs(level + 0.02) < 0.01, `the level is ${level}`);
});

// Tests that a single trigger catches once, says that it has stopped, and catches again when it is armed.
test('single, and armed again', async () => {
  await form('mode').selectOption('single');
  await nextCapture();
  await until(page, () => hydroScope.trigger.state === 'stopped');
  const caught = await captures();
  const last = await page.evaluate(() => hydroScope.display.last);
  await until(page, (before) => hydroScope.display.last > before + 2.2, last);
  assert.equal(await captures(), caught);
  await page.getByRole('button', { name: 'Arm again' }).click();
  await nextCapture();
});

// Tests that settings that cannot be are named, and not sent.
test('a wrong setting is named', async () => {
  await form('pre').fill('150');
  await form('pre').press('Enter');
  await page.getByText('pre-trigger is 1.5: give a number from 0 to 1').waitFor();
  await form('pre').fill('25');
  await form('pre').press('Enter');
  await page.keyboard.press('Escape');
});

// How each of the next `count` captures with these settings came about ("triggered" or "auto") and when, as the server
// says it, with the time from there to the first reference below the level; with `from`, counted from the first of that kind on.
async function causes(settings, count, from = null) {
  const seen = await page.evaluateHandle(
    ([changes, first]) => {
      const list = [];
      let begun = first === null;
      hydroScope.signals.on('op:trigger', ({ state, t }) => {
        if (!['triggered', 'auto'].includes(state)) return;
        begun ||= state === first;
        if (begun) list.push({ state, t });
      });
      // The picture comes after its message; the next one, of a stack that a busy machine disturbs, may be another kind.
      hydroScope.signals.on('capture', () => {
        const { t, bins } = hydroScope.display.capture;
        const at = bins.t.findIndex(
          (one, i) => one > t - 0.3 && bins.min.arm_ref[i] <= hydroScope.trigger.settings.level,
        );
        if (list.length > 0) list.at(-1).edge ??= bins.t[at] - t;
      });
      hydroScope.trigger.change(changes);
      return list;
    },
    [settings, from],
  );
  await until(page, ([list, n]) => list[n - 1]?.edge !== undefined, [seen, count]);
  return (await seen.jsonValue()).slice(0, count);
}

// Tests that auto runs free while nothing triggers, and says so; and that once something does, more often than it
// would run free, every picture is one of the trigger's. The reference falls every 2 s, also where a late plant lets the arm swing.
test('auto runs free, and stands still on what triggers', async () => {
  const span = 1.6; // a falling edge comes every 2 s
  const never = { on: 'level', channel: 'arm_ref', edge: 'falling', level: 10, hysteresis: 0.02, mode: 'auto', span };
  const free = await causes(never, 3);
  assert.deepEqual(
    free.map(({ state }) => state),
    ['auto', 'auto', 'auto'],
  );
  assert.ok(free[2].t - free[0].t >= 2 * span - 0.01, `three pictures in ${free[2].t - free[0].t} s`);
  await page
    .locator('#section-trigger .state')
    .getByText(/^free running/)
    .waitFor();

  const caught = await causes({ level: 0.02 }, 3, 'triggered');
  assert.deepEqual(
    caught.map(({ state }) => state),
    ['triggered', 'triggered', 'triggered'],
  );
  for (const [i, one] of caught.slice(1).entries())
    assert.ok(Math.abs(one.t - caught[i].t - 2) < 0.3, `${one.t} after ${caught[i].t}: not the next falling edge`);
  for (const { t, edge } of caught)
    assert.ok(Math.abs(edge) <= 0.01, `the edge is ${edge} s from the trigger at ${t} s`);
});

test('no errors in the page', () => assert.deepEqual(page.problems, []));
