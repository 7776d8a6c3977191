// Tests of the ghost: the model beside the running stack, whose residual is what it should be, noise and no
// more.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { until } from './browser.mjs';
import { onALivePage } from './live_page.mjs';

let page;

onALivePage((live) => ({ page } = live));

// Tests that the ghost's channels are laid over the measured ones, that a pane of residuals comes, and that
// the residuals of the very model that the plant simulates are of the size of the sensors' noise.
test('the ghost of the right model leaves noise', async () => {
  await page.keyboard.press('g');
  await page.locator('.pane h2', { hasText: 'Residual' }).waitFor();
  await until(page, () => {
    const { bins } = hydroScope.display.frame();
    return bins.min['ghost.p1'] && [...bins.min['residual.p1']].filter((value) => !Number.isNaN(value)).length > 100;
  });
  const kinds = await page.evaluate(() =>
    hydroScope.panes.panes[1].parts.traces.map(({ id, kind }) => `${id} ${kind}`),
  );
  assert.deepEqual(kinds, ['p1 measured', 'ghost.p1 ghost', 'p2 measured', 'ghost.p2 ghost']);
  const median = await page.evaluate(() => {
    const { bins } = hydroScope.display.frame();
    const sizes = [...bins.min['residual.p1']]
      .map((low, i) => (Math.abs(low) + Math.abs(bins.max['residual.p1'][i])) / 2)
      .filter((value) => !Number.isNaN(value))
      .sort((a, b) => a - b);
    return sizes[sizes.length >> 1];
  });
  // Extremes of some ten samples a bin lie at 1.5 standard deviations; 0 would be no residual at all.
  assert.ok(median > 0.3 && median < 4, `the residual of p1 is ${median} standard deviations`);
});

// Tests that the ghost goes, with its pane.
test('the ghost goes', async () => {
  await page.keyboard.press('g');
  await page.locator('.pane h2', { hasText: 'Residual' }).waitFor({ state: 'detached' });
  assert.equal(await page.evaluate(() => hydroScope.panes.panes[1].parts.traces.length), 2);
  assert.deepEqual(page.problems, []);
});
