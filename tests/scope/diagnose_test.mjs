// Tests that a window of a run goes to hydro-diagnose, and its report comes back in a frame that can do no
// harm.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { openBrowser, openPage, until } from './browser.mjs';
import { Bench, demoConfig } from './stack.mjs';

let bench, scope, browser, page;

before(async () => {
  bench = await Bench.make();
  bench.run('hydro-sim', demoConfig(), '--duration', '3', '--time', 'lockstep', '--log', bench.file('sim.lcmlog'));
  scope = await bench.scope(bench.file('sim.lcmlog'));
  browser = await openBrowser();
  page = await openPage(browser, scope.address);
  await until(page, () => hydroScope.panes.panes.length > 0 && hydroScope.display.frame().bins.t.length > 100);
});
after(async () => {
  await browser?.close();
  await bench?.close();
});

// The diagnosis gives way to everybody on the machine, so it may take many times what it computes.
test('a window is diagnosed and its report shown', { timeout: 850000 }, async () => {
  await page.locator('#section-files summary').click();
  await page.getByRole('button', { name: 'Diagnose' }).click();
  const show = page.getByRole('button', { name: 'Show the report' });
  await show.waitFor({ timeout: 800000 });
  assert.notEqual(await page.locator('#section-files .result').textContent(), '');
  await show.click();
  const frame = page.frameLocator('iframe.report');
  await frame.locator('h1').waitFor();
  assert.equal(await page.locator('iframe.report').getAttribute('sandbox'), 'allow-scripts');
  // The report's address needs no token and tells none, and the report cannot reach the page.
  const inside = page.frames().find((one) => one.url().includes('/api/reports/'));
  assert.doesNotMatch(inside.url(), /token/);
  assert.equal(
    await inside.evaluate(() => {
      try {
        return parent.document.title;
      } catch {
        return 'out of reach';
      }
    }),
    'out of reach',
  );
  await page.keyboard.press('Escape');
});

test('no errors in the page', () => assert.deepEqual(page.problems, []));
