// Tests of STOP and re-arm: one press stops the running stack, the page says when it is confirmed.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { onALivePage } from './live_page.mjs';

let stack, scope, page;

onALivePage((live) => ({ stack, scope, page } = live), {
  sets: ['limits.rearm=explicit'],
  scopeSets: ['limits.rearm=explicit', 'scope.control=true'],
  seconds: 1.5,
});

// Tests that re-arming says what it will do, and does nothing when it is not wanted.
test('re-arm asks first', async () => {
  await page.getByRole('button', { name: 'Re-arm …' }).click();
  await page.getByRole('dialog').getByText('the reference comes back from where the arm is').waitFor();
  assert.equal(await page.evaluate(() => document.activeElement.textContent), 'Leave it at zero');
  // STOP stays within reach: Tab goes to it out of the dialog.
  await page.keyboard.press('Tab');
  await page.keyboard.press('Tab');
  assert.equal(await page.evaluate(() => document.activeElement.id), 'stop');
  await page.keyboard.press('Shift+Tab');
  await page.keyboard.press('Escape');
  await page.getByRole('dialog').waitFor({ state: 'hidden' });
});

// Tests that one press of STOP ends the stack with its output at zero, that this is confirmed, and that it is
// an event.
test('STOP stops with one press', async () => {
  stack.stopped = true;
  await page.getByRole('button', { name: /^STOP/ }).click();
  await page.getByText(/^STOPPED: /).waitFor();
  await page.locator('.events [data-kind=stop]').first().waitFor();
  await stack.line(/plant: the output reads back 0 V/);
  assert.notEqual((await stack.ended).signal, 'SIGKILL');
  await page.locator('#link').getByText('run ended').waitFor();
  assert.equal(await page.locator('#rearm').isDisabled(), true);
});

// Tests that STOP without a connection says that it is not confirmed and goes on trying, and works by its key
// in a field.
test('STOP without a connection is not silent', async () => {
  await scope.program.stop('SIGKILL');
  await page.locator('#link[data-state=lost]').waitFor();
  await page.locator('#section-trigger [data-name=level]').focus();
  await page.keyboard.press('F9');
  await page.getByText('STOP is not confirmed').waitFor();
  await page.getByRole('button', { name: 'Stop trying' }).click();
});

test('no errors in the page', () => assert.deepEqual(page.problems, []));
