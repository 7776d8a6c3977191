// Tests that a latched fault is shown as what holds the stack, and that re-arming says what it will do, and
// then does it.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { openBrowser, openPage, streaming, until } from './browser.mjs';
import { Bench } from './stack.mjs';

let bench, browser, page;

// The motor passes this speed at the first step of the reference.
before(async () => {
  bench = await Bench.make();
  const explicit = 'limits.rearm=explicit';
  const stack = await bench.launch(bench.file('run.lcmlog'), [
    explicit,
    'limits.motor_speed=150',
    'limits.arm_torque=500',
    'reference.amplitude=0.2',
    'limits.return_s=2', // slow enough that the limit is not passed again
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
  const way = await dialog.locator('.way').textContent();
  const told = new RegExp(
    '^If it were re-armed now: the arm is at (\\S+) rad; its reference comes back to (\\S+) rad: the reference moves by (\\S+) rad in 2 s, at up to (\\S+) rad/s',
  ).exec(way);
  assert.ok(told, way);
  const [present, target, distance, rate] = told.slice(1).map((text) => Number(text.replace('\u2212', '-')));
  assert.ok(Math.abs(target - present - distance) < 2e-3, way);
  assert.ok(Math.abs(Math.abs(distance) / 2 - rate) < 0.02 * rate + 1e-3, way);
  assert.ok(Math.abs(distance) > 0.01, `the arm was far from its reference: ${way}`);
  assert.equal(await page.locator('.events [data-kind=rearm]').count(), 0);
  await dialog.getByRole('button', { name: 'Re-arm: the arm may move' }).click();
  await page
    .getByText(/^Re-armed: ended .*motor_speed_limit/)
    .waitFor()
    .catch(async (error) => {
      throw new Error(`${error.message}\nthe page says: ${await page.locator('body').innerText()}`);
    });
  await page.locator('.events [data-kind=rearm]').first().waitFor();
  // And so it does: after the two seconds, and the time that the loops take.
  await until(
    page,
    async (wanted) => {
      const { run, link } = hydroScope.scope;
      const { data } = await link.request({ op: 'values', run: run.run, channels: ['arm_angle'], t: run.last });
      return Math.abs(data.values[0] - wanted) < 0.02;
    },
    target,
  );
  assert.deepEqual(page.problems, []);
});
