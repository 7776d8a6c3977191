// Tests of tuning and references from the page on a running stack: accepted with the tick they act on, or
// refused in words.
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { test } from 'node:test';
import { openPage, streaming, until } from './browser.mjs';
import { onALivePage } from './live_page.mjs';

let bench, browser, page;

const opened = async (live) => {
  ({ bench, browser, page } = live);
  await page.locator('#section-tuning > summary').click();
  await page.locator('#section-reference > summary').click();
};

// In its first two seconds a stack may refuse: a controller has not said its values yet.
onALivePage(opened, { sets: ['reference.frequency_hz=0.05'], scopeSets: ['scope.control=true'], seconds: 3 });

const field = (key) => page.getByLabel(`${key}, new value`);
const result = () => page.locator('#section-tuning .result');
const inForce = (key) => page.locator(`[data-key="${key}"] .number`);

// Tests that a gain set from the page is accepted with its tick, shown as in force, and an event.
test('a gain acts from a tick on', async () => {
  assert.equal(await inForce('position.c2').textContent(), '1200');
  await field('position.c2').fill('1400');
  await page.getByRole('button', { name: 'Apply' }).click();
  await result()
    .getByText(/^Accepted\..*from tick \d+/)
    .waitFor();
  await inForce('position.c2').getByText('1400').waitFor();
  await page.locator('.events [data-kind=tuning]').first().waitFor();
});

// Tests that two values are one set: both act on the same tick.
test('two values are one set', async () => {
  await field('position.c1').fill('5500');
  await field('position.c2').fill('1300');
  await page.getByRole('button', { name: 'Apply 2 together' }).click();
  await inForce('position.c1').getByText('5500').waitFor();
  assert.equal(await inForce('position.c2').textContent(), '1300');
});

// Tests that what would be unstable is refused with the reason, and that nothing of it acts.
test('an unstable gain is refused', async () => {
  await field('position.c2').fill('1');
  await page.getByRole('button', { name: 'Apply' }).click();
  await result()
    .getByText(/^Refused: .*unstable/i)
    .waitFor();
  assert.equal(await inForce('position.c2').textContent(), '1300');
});

test('undo takes the last set back', async () => {
  await page.getByRole('button', { name: 'Undo' }).click();
  await inForce('position.c1').getByText('6000').waitFor();
  assert.equal(await inForce('position.c2').textContent(), '1400');
});

// Tests that a step commanded from the page moves the arm there.
test('a step from the page moves the arm', async () => {
  await page.locator('[data-key="reference.initial"]').fill('0.05');
  await page.getByRole('button', { name: 'Command it' }).click();
  await page
    .locator('#section-reference .result')
    .getByText(/^Accepted/)
    .waitFor();
  await until(page, () => {
    const { bins } = hydroScope.display.frame();
    const at = bins.t.length - 3;
    return Math.abs(bins.max.arm_ref[at] - 0.05) < 1e-6 && Math.abs(bins.max.arm_angle[at] - 0.05) < 0.01;
  });
});

// Tests that a step commanded from the page is one: the reference goes from where it was to its value with nothing in between.
test('a sharp step from the page', async () => {
  await page.locator('#section-reference [data-name=kind]').selectOption('sharp');
  await page.locator('[data-key="reference.to"]').fill('-0.05');
  const before = await page.locator('#section-reference .result').textContent(); // the answer to the step before
  await page.getByRole('button', { name: 'Command it' }).click();
  const accepted = await page.waitForFunction((old) => {
    const text = document.querySelector('#section-reference .result').textContent;
    return text !== old && /Accepted.* From tick \d+/.test(text) ? text : null;
  }, before);
  const begins = Number((await accepted.jsonValue()).match(/From tick (\d+)/)[1]) / 1000;
  await until(page, () => {
    const { bins } = hydroScope.display.frame();
    return Math.abs(bins.max.arm_ref[bins.t.length - 3] + 0.05) < 1e-6;
  });
  const seen = await page.evaluate(async (from) => {
    const { run, link } = hydroScope.scope;
    const values = [];
    for (let t = from + 0.002; t < Math.min(from + 1, run.last); t += 0.005) {
      const { data } = await link.request({ op: 'values', run: run.run, channels: ['arm_ref'], t });
      values.push(data.values[0]);
    }
    return values;
  }, begins);
  const between = seen.filter((value) => Math.abs(value - 0.05) > 1e-6 && Math.abs(value + 0.05) > 1e-6);
  assert.deepEqual(between, []);
  assert.ok(seen.some((value) => value > 0) && seen.some((value) => value < 0), `${seen}`);
});

// Tests that a sine begins when it is commanded, not as much later as the run is old: within two of its periods it has swung both
// ways.
test('a sine from the page begins now', async () => {
  await page.locator('#section-reference [data-name=kind]').selectOption('sine');
  await page.locator('[data-key="reference.amplitude"]').fill('0.08');
  await page.locator('[data-key="reference.frequency_hz"]').fill('1');
  await page.getByRole('button', { name: 'Command it' }).click();
  const accepted = page.locator('#section-reference .result').getByText(/^Accepted.*sine.* From tick \d+/);
  await accepted.waitFor();
  const begins = Number((await accepted.textContent()).match(/From tick (\d+)/)[1]) / 1000;
  await until(
    page,
    (from) => {
      const { bins } = hydroScope.display.frame();
      const inside = [...bins.t.keys()].filter((k) => bins.t[k] > from && bins.t[k] < from + 2);
      return inside.some((k) => bins.max.arm_ref[k] > 0.07) && inside.some((k) => bins.min.arm_ref[k] < -0.07);
    },
    begins,
  );
});

// Tests that the checks of axe find nothing to mend where values can be set.
test('accessibility of the fields and sliders', async () => {
  const { source } = createRequire(new URL('../../scope/page/package.json', import.meta.url))('axe-core');
  await page.evaluate(() =>
    document.querySelectorAll('details.group').forEach((one) => {
      one.open = true;
    }),
  );
  await page.evaluate(source);
  const { violations } = await page.evaluate(() => globalThis.axe.run('#side'));
  assert.deepEqual(
    violations.map(({ id, nodes }) => `${id}: ${nodes[0].html}`),
    [],
  );
});

// Tests that without control = true the values are shown and nothing can be set, not even past the page's
// buttons.
test('read only without control', async () => {
  const reader = await bench.scope();
  const other = await openPage(browser, reader.address);
  await streaming(other);
  await other.locator('#section-tuning > summary').click();
  await other.getByText('Read only').waitFor();
  assert.equal(await other.locator('#section-tuning input, #section-tuning button:visible').count(), 0);
  const reply = await other.evaluate(() => hydroScope.link.request({ op: 'set', entries: ['position.c2=1000'] }));
  assert.equal(reply.ok, false);
  await other.context().close();
});

test('no errors in the page', () => assert.deepEqual(page.problems, []));
