// Makes the pictures of docs/scope.md from a running stack: node tests/scope/pictures.mjs docs/pictures
// pngquant takes the number of colours down, so that each picture stays small.

import { execFileSync } from 'node:child_process';
import path from 'node:path';
import { openBrowser, openPage, streaming, until } from './browser.mjs';
import { Bench } from './stack.mjs';

const folder = process.argv[2] ?? 'docs/pictures';
const bench = await Bench.make();
// Slower than real time, so that a busy machine makes no gaps.
const kSlow = ['time.speed=0.25'];
const kFar = ['reference.amplitude=0.2', 'limits.arm_torque=500'];
await bench.launch(bench.file('run.lcmlog'), [...kSlow, ...kFar]);
const scope = await bench.scope(undefined, { sets: [...kSlow, 'scope.control=true'] });
const browser = await openBrowser();

async function picture(name, options, prepare, shot = {}) {
  const page = await openPage(browser, scope.address, options);
  await streaming(page, 1);
  await prepare(page);
  const raw = bench.file(`${name}.png`);
  await page.screenshot({ path: raw, ...shot });
  execFileSync('pngquant', ['--force', '--nofs', '--output', path.join(folder, `${name}.png`), '200', raw]);
  await page.context().close();
}

const kDesk = { viewport: { width: 1240, height: 760 } };

await picture('scope_live', kDesk, async (page) => {
  await until(page, () => hydroScope.display.last > 10.5);
  await page.evaluate(() => {
    const { t0, t1 } = hydroScope.display.frame();
    hydroScope.cursors.place('b', t0 + 0.62 * (t1 - t0));
    hydroScope.cursors.place('a', t0 + 0.5 * (t1 - t0));
  });
  await page.locator('#section-trigger > summary').click();
  await page.locator('[data-cell="dp.difference"]').waitFor();
  await until(page, () => !document.querySelector('[data-cell="p1.difference"]')?.textContent.includes('–'));
});

await picture('scope_trigger', { ...kDesk, colorScheme: 'dark' }, async (page) => {
  await page.locator('#section-trigger [data-name=on]').selectOption('step');
  await page.locator('#section-trigger [data-name=span]').fill('0.8');
  await page.locator('#section-trigger [data-name=span]').press('Enter');
  await page.getByRole('button', { name: 'Trigger on' }).click();
  await until(page, () => hydroScope.trigger.captures > 1);
  await page.evaluate(() => new Promise((done) => setTimeout(done, 200)));
});

await picture('scope_ghost', kDesk, async (page) => {
  await page.evaluate(() => hydroScope.scope.setLayout({ panes: hydroScope.scope.layout.panes.slice(0, 4) }));
  await page.keyboard.press('g');
  await page.locator('#section-trigger > summary').click();
  await page.locator('#section-ghost > summary').click();
  await until(page, () => {
    const low = hydroScope.display.frame().bins.min['residual.p1'];
    return low && [...low].filter((value) => !Number.isNaN(value)).length > 0.9 * hydroScope.display.pixels;
  });
  await page.keyboard.press('Escape');
  await page.locator('#toggle').click();
  await page.evaluate(() => {
    const { t1 } = hydroScope.display.frame();
    hydroScope.display.showWindow(t1 - 2.6, t1 - 0.1);
  });
  await until(page, () => hydroScope.display.frame().bins.width < 0.005);
});

await picture('scope_tuning', kDesk, async (page) => {
  for (const name of ['trigger', 'cursors', 'events']) await page.locator(`#section-${name} > summary`).click();
  await page.locator('#section-tuning > summary').click();
  await page
    .locator('#section-tuning .group')
    .first()
    .evaluate((group) => (group.open = false));
  await page.getByLabel('position.c1, new value').fill('3000');
  await page.getByLabel('position.c2, new value').fill('900');
  await page.getByRole('button', { name: 'Apply 2 together' }).click();
  await page
    .locator('#section-tuning .result')
    .getByText(/^Accepted/)
    .waitFor();
  const set = await page.evaluate(() => hydroScope.display.last);
  await until(page, (then) => hydroScope.display.last > then + 5, set);
});

await picture(
  'scope_phone',
  { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, colorScheme: 'dark' },
  async (page) => {
    await until(page, () => hydroScope.display.last > 10);
  },
);

await browser.close();
await bench.close();
