// Tests that a latched fault is shown as what holds the stack, and that re-arming says what it will do, and
// then does it.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { openBrowser, openPage, streaming } from './browser.mjs';
import { Bench } from './stack.mjs';

let bench, browser, page;

// The motor passes this speed at the first step of the reference.
before(async () => {
  bench = await Bench.make();
  const explicit = 'limits.rearm=explicit';
  const stack = await bench.launch(bench.file('run.lcmlog'), [
    explicit,
    'limits.motor_speed=150',
    'reference.frequency_hz=0.02',
  ]);
  const scope = await bench.scope(undefined, { sets: [explicit, 'scope.control=true'] });
  await stack.line(/fault motor_speed_limit/);
  browser = await openBrowser();
  page = await openPage(browser, scope.address);
  await streaming(page, 0.5);
});
after(async () => {
  await browser?.close();
  await bench?.close();
});

test('a latched fault stands at the top', async () => {
  await page.getByText(/^(A fault holds|\d faults hold) the voltage at zero: .*motor_speed_limit/).waitFor();
});

// Tests that the dialog names the faults and the way that the arm would go, and that nothing happens unless
// it is confirmed.
test('re-arm says what it will do, and does it', async () => {
  await page.getByRole('button', { name: 'Re-arm …' }).click();
  const dialog = page.getByRole('dialog', { name: 'Re-arm?' });
  await dialog
    .getByText(/motor_speed_limit/)
    .first()
    .waitFor();
  await dialog.getByText(/The arm is at .* rad and its reference at .* rad now: it would move by .* rad\./).waitFor();
  assert.equal(await page.locator('.events [data-kind=rearm]').count(), 0);
  await dialog.getByRole('button', { name: 'Re-arm: the arm may move' }).click();
  await page.getByText(/^Re-armed: ended .*motor_speed_limit/).waitFor();
  await page.locator('.events [data-kind=rearm]').first().waitFor();
  assert.deepEqual(page.problems, []);
});
