// Tests of tuning and references from the page on a running stack: accepted with the tick they act on, or
// refused in words.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { openBrowser, openPage, streaming, until } from './browser.mjs';
import { Bench } from './stack.mjs';

let bench, browser, page;

before(async () => {
  bench = await Bench.make();
  await bench.launch(bench.file('run.lcmlog'), ['reference.frequency_hz=0.05']);
  const scope = await bench.scope(undefined, { sets: ['scope.control=true'] });
  browser = await openBrowser();
  page = await openPage(browser, scope.address);
  await streaming(page, 1);
  await page.locator('#section-tuning > summary').click();
  await page.locator('#section-reference > summary').click();
});
after(async () => {
  await browser?.close();
  await bench?.close();
});

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
