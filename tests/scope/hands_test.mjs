// Tests of the page in the hand: a phone, the keyboard alone, light and dark, panes as the user arranged
// them.
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { test } from 'node:test';
import { openPage, streaming, until } from './browser.mjs';
import { onALivePage } from './live_page.mjs';

let scope, browser, page;

// The checks of accessibility keep the machine busy for seconds.
onALivePage((live) => ({ scope, browser, page } = live));

// Tests that a phone scrolls only downwards, and that STOP is on the screen and a finger wide wherever one
// has scrolled to.
test('a phone', async () => {
  const phone = await openPage(browser, scope.address, {
    viewport: { width: 390, height: 844 },
    hasTouch: true,
    isMobile: true,
  });
  await streaming(phone);
  for (const summary of await phone.locator('.section > summary:visible').all()) {
    if (!(await summary.evaluate((one) => one.parentElement.open))) await summary.tap();
  }
  const { wide, inner } = await phone.evaluate(() => ({
    wide: document.documentElement.scrollWidth,
    inner: innerWidth,
  }));
  assert.equal(inner, 390);
  assert.ok(wide <= inner, `the page is ${wide} pixels wide on a screen of ${inner}`);
  for (const y of [0, 700, 100000]) {
    await phone.evaluate((to) => scrollTo(0, to), y);
    const box = await phone.getByRole('button', { name: /^STOP/ }).boundingBox();
    assert.ok(box.y >= 0 && box.y + box.height <= 844 && box.height >= 44, `STOP is at ${box.y}`);
  }
  assert.deepEqual(phone.problems, []);
  await phone.context().close();
});

// Tests that what must be seen, such as the answer to STOP, is on a phone's screen wherever one has scrolled to, beside STOP itself.
test('notices on a phone', async () => {
  const phone = await openPage(browser, scope.address, {
    viewport: { width: 390, height: 844 },
    hasTouch: true,
    isMobile: true,
  });
  await streaming(phone);
  await phone.evaluate(() => hydroScope.notice.say('test', 'STOPPED: 4 processes have ended', 'stopped'));
  for (const y of [0, 700, 100000]) {
    await phone.evaluate((to) => scrollTo(0, to), y);
    const line = await phone.getByText('STOPPED: 4 processes have ended').boundingBox();
    const stop = await phone.getByRole('button', { name: /^STOP/ }).boundingBox();
    assert.ok(line.y >= 0 && line.y + line.height <= stop.y, `scrolled to ${y}, the line is at ${line.y}`);
    const above = await phone.evaluate(
      ([x, top]) => document.elementFromPoint(x, top).textContent,
      [line.x + 5, line.y + line.height / 2],
    );
    assert.match(above, /STOPPED/, 'nothing covers it');
  }
  await phone.context().close();
});

// Tests that the numbers of the cursors' table stay whole, however long they are, and that its panel is not wider for it.
test('numbers at the cursors', async () => {
  await page.keyboard.press('c');
  const cells = page.locator('#section-cursors td.number');
  await cells.first().waitFor();
  const broken = await page.evaluate(() => {
    const rows = [...document.querySelectorAll('#section-cursors td.number')];
    return rows.map((cell) => {
      cell.textContent = '\u22121.234e\u22127';
      const range = document.createRange();
      range.selectNodeContents(cell);
      return range.getClientRects().length;
    });
  });
  assert.ok(broken.length > 0);
  assert.deepEqual([...new Set(broken)], [1], 'each number is on one line');
  const side = await page.evaluate(() => {
    const aside = document.querySelector('aside');
    return aside.scrollWidth - aside.clientWidth;
  });
  assert.ok(side <= 1, `the panel is ${side} pixels too wide`);
  await page.keyboard.press('c'); // away again
});

// Tests that two fingers zoom: what was between them stays between them.
test('pinch', async () => {
  const phone = await openPage(browser, scope.address, {
    viewport: { width: 390, height: 844 },
    hasTouch: true,
    isMobile: true,
  });
  await streaming(phone);
  const box = await phone.locator('.chart').first().boundingBox();
  const y = box.y + box.height / 2;
  const touch = await phone.context().newCDPSession(phone);
  const fingers = (type, ...at) =>
    touch.send('Input.dispatchTouchEvent', { type, touchPoints: at.map((x, id) => ({ x, y, id })) });
  const before = await phone.evaluate(() => {
    const { t0, t1 } = hydroScope.display.frame();
    return t1 - t0;
  });
  await fingers('touchStart', box.x + 150, box.x + 210);
  await fingers('touchMove', box.x + 120, box.x + 240);
  await fingers('touchMove', box.x + 90, box.x + 270);
  await fingers('touchEnd');
  const span = await phone.evaluate(() => hydroScope.display.window.t1 - hydroScope.display.window.t0);
  assert.ok(Math.abs(span / before - 1 / 3) < 0.05, `${span} of ${before} s`);
  await phone.context().close();
});

// Tests that keys alone pause, zoom, pan, set cursors and move them, mark, hide, and open and close the help.
test('the keyboard alone', async () => {
  await page.keyboard.press('Space');
  await until(page, () => hydroScope.display.mode === 'still');
  const first = await page.evaluate(() => hydroScope.display.window);
  await page.keyboard.press('ArrowLeft');
  const left = await page.evaluate(() => hydroScope.display.window);
  assert.ok(Math.abs(first.t0 - left.t0 - (first.t1 - first.t0) / 10) < 1e-9);
  await page.keyboard.press('c');
  const a = await page.evaluate(() => hydroScope.cursors.at.a);
  await page.keyboard.press('Shift+ArrowRight');
  assert.ok((await page.evaluate(() => hydroScope.cursors.at.a)) > a);
  await page.keyboard.press('m');
  await page.locator('.events [data-kind=mark]').first().waitFor();
  await page.keyboard.press('?');
  await page.getByRole('dialog', { name: 'Keys and gestures' }).waitFor();
  await page.keyboard.press('Escape');
  await page.getByRole('dialog').waitFor({ state: 'hidden' });
  await page.locator('[data-channel=dp_ref]').focus();
  await page.keyboard.press('Enter');
  assert.equal(await page.locator('[data-channel=dp_ref]').getAttribute('aria-pressed'), 'false');
  // The focus stays on it, though the panes were made anew.
  await page.keyboard.press('Enter');
  assert.equal(await page.locator('[data-channel=dp_ref]').getAttribute('aria-pressed'), 'true');
  await page.keyboard.press('l');
  await until(page, () => hydroScope.display.mode === 'follow');
});

// Tests that everything that can be pressed has a name, and that the focus goes through it all with Tab and
// is seen.
test('names and focus', async () => {
  const nameless = await page.evaluate(() =>
    [...document.querySelectorAll('button, select, input, summary, canvas[role]')]
      .filter(
        (one) =>
          one.offsetParent &&
          !(one.getAttribute('aria-label') || one.textContent.trim() || one.labels?.length || one.title),
      )
      .map((one) => one.outerHTML),
  );
  assert.deepEqual(nameless, []);
  await page.locator('#stop').focus();
  const outlines = [];
  for (let i = 0; i < 12; i += 1) {
    await page.keyboard.press('Tab');
    outlines.push(
      await page.evaluate(() => ({
        id: document.activeElement.id || document.activeElement.className,
        width: getComputedStyle(document.activeElement).outlineWidth,
      })),
    );
  }
  assert.deepEqual(
    outlines.filter(({ width }) => parseFloat(width) < 2),
    [],
  );
  assert.ok(new Set(outlines.map(({ id }) => id)).size >= 8);
});

// Tests that names say what a button does where its words alone do not, and that nothing is said that nobody asked for:
// a clock that is read aloud at each change drowns the faults.
test('names, and quiet', async () => {
  for (const name of ['Units: in · psi', 'Colours: Auto', 'STOP', 'Arrange pane 1']) {
    const named = name.startsWith('Arrange')
      ? page.getByLabel(name, { exact: true })
      : page.getByRole('button', { name, exact: true });
    assert.equal(await named.count(), 1, name);
  }
  for (const id of ['clock', 'base']) assert.equal(await page.locator(`#${id}`).getAttribute('aria-live'), 'off', id);
  assert.equal(await page.locator('.chip [aria-live], .chip output, [role=img] [aria-live]').count(), 0);
});

// Tests that the curves have their newest values in words: in the names of their buttons, and said on request with their
// time, without those that are hidden.
test('values in words', async () => {
  await page.getByRole('button', { name: /^arm_angle \u2212?[\d.]+ rad$/ }).waitFor();
  await page.getByRole('img', { name: 'Curves over time of arm angle, reference of the arm angle' }).waitFor();
  await page.keyboard.press('Space');
  await until(page, () => hydroScope.display.mode === 'still');
  await page.locator('[data-channel=p2]').press('Enter');
  await page.keyboard.press('v');
  const said = await page.locator('#said[role=status]').textContent();
  const [, time] = /^At ([\d.]+) s: .*, arm angle \u2212?[\d.]+ rad, /.exec(said) ?? [];
  const last = await page.evaluate(() => hydroScope.display.last);
  assert.ok(last - Number(time) > -0.01 && last - Number(time) < 4, `${said}; now it is ${last} s`);
  const labels = await page.evaluate(() => ['p1', 'p2'].map((id) => hydroScope.scope.channel(id).label));
  assert.ok(said.includes(`${labels[0]} `) && !said.includes(`${labels[1]} `), said);
  await page.locator('[data-channel=p2]').press('Enter');
  await page.keyboard.press('l');
});

// Tests that a pane is arranged with keys alone: its menu opens, takes a channel away, and gives the focus back.
test('the menu of a pane with keys', async () => {
  const menu = page.getByLabel('Arrange pane 1', { exact: true });
  await menu.focus();
  await page.keyboard.press('Enter');
  await page.getByLabel('Move dp to').waitFor();
  await page.keyboard.press('Tab');
  await page.keyboard.press('Tab');
  await page.keyboard.press('Enter'); // Remove, beside "Move dp to"
  await until(page, () => !hydroScope.scope.layout.panes[0].channels.includes('dp'));
  await page.keyboard.press('Escape');
  await page.getByLabel('Move dp_ref to').waitFor({ state: 'hidden' });
  assert.equal(await page.evaluate(() => document.activeElement.getAttribute('aria-label')), 'Arrange pane 1');
  await page.getByRole('button', { name: 'Default panes' }).click();
});

// Tests that the table of the cursors, with the widest names and numbers, is not cut off at the side.
test('the cursors have room', async () => {
  if (!(await page.evaluate(() => hydroScope.cursors.shown))) await page.keyboard.press('c');
  await page.locator('[data-cell="motor_speed.difference"]').waitFor();
  await until(page, () => !document.querySelector('[data-cell="p1.difference"]')?.textContent.includes('–'));
  const { table, room } = await page.evaluate(() => {
    for (const cell of document.querySelectorAll('#section-cursors td.number'))
      cell.textContent = '\u22122.842e\u221214';
    return {
      table: document.querySelector('#section-cursors table').getBoundingClientRect().right,
      room: document.querySelector('#section-cursors .hint').parentElement.getBoundingClientRect().right,
    };
  });
  assert.ok(table <= room, `the table ends at ${table}, its place at ${room}`);
  await page.keyboard.press('c');
});

// Tests that when the system turns dark, all that is drawn does: the panes and the bar of the whole run.
test("the system's colours", async () => {
  const corner = () =>
    page.evaluate(() => [
      document.querySelector('.overview').getContext('2d').getImageData(3, 3, 1, 1).data[0],
      parseInt(hydroScope.panes.colours.paper.slice(1, 3), 16),
    ]);
  await page.emulateMedia({ colorScheme: 'light' });
  await until(page, () => hydroScope.panes.colours.paper === '#ffffff');
  assert.ok(Math.min(...(await corner())) > 150, `${await corner()}`);
  await page.emulateMedia({ colorScheme: 'dark' });
  await until(page, () => hydroScope.panes.colours.paper !== '#ffffff');
  assert.ok(Math.max(...(await corner())) < 100, `${await corner()}`);
  await page.emulateMedia({ colorScheme: 'light' });
});

// Tests that a channel's name can be dragged to another pane.
test('a channel is dragged to another pane', async () => {
  await page.dragAndDrop('[data-channel=arm_ref]', '[data-pane="0"] .chart');
  await until(page, () => hydroScope.scope.layout.panes[0].channels.includes('arm_ref'));
  assert.deepEqual(await page.evaluate(() => hydroScope.scope.layout.panes[2].channels), ['arm_angle']);
  await page.getByRole('button', { name: 'Default panes' }).click();
});

// Tests that panes that were arranged are there again after a reload, under this configuration's name.
test('an arrangement is kept', async () => {
  await page.getByRole('button', { name: 'Add pane' }).click();
  assert.equal(await page.locator('.pane').count(), 7);
  await page.getByLabel('Arrange pane 7').click();
  await page.getByLabel('Add a channel to pane 7').selectOption('arm_speed');
  await page.getByLabel('Arrange pane 2').click();
  await page.getByLabel('Move p2 to').selectOption('6');
  await page.reload();
  await streaming(page);
  const panes = await page.evaluate(() => hydroScope.scope.layout.panes.map((pane) => pane.channels));
  assert.deepEqual([panes[1], panes[6]], [['p1'], ['arm_speed', 'p2']]);
  await page.getByRole('button', { name: 'Default panes' }).click();
  assert.equal(await page.locator('.pane').count(), 6);
});

// Tests that SI units change names and numbers together, by the factor that the server gives.
test('SI units', async () => {
  await page.keyboard.press('u');
  await until(page, () => document.querySelector('[data-channel=p1] .unit').textContent === 'MPa');
  await until(page, () => Math.abs(Number(document.querySelector('[data-channel=p1] .value').textContent)) < 14);
  await page.keyboard.press('u');
});

// Tests that the checks of axe find nothing to mend, with every section open, on a desk and on a phone.
for (const width of [1280, 390]) {
  test(`accessibility by axe at ${width} pixels`, async () => {
    const { source } = createRequire(new URL('../../scope/page/package.json', import.meta.url))('axe-core');
    const audited = await openPage(browser, scope.address, { viewport: { width, height: 844 } });
    await streaming(audited);
    await audited.evaluate(() =>
      document.querySelectorAll('details.section').forEach((one) => {
        one.open = true;
      }),
    );
    await audited.keyboard.press('c');
    await audited.locator('[data-cell="dp.difference"]').waitFor();
    await audited.evaluate(source);
    const { violations } = await audited.evaluate(() => globalThis.axe.run());
    assert.deepEqual(
      violations.map(({ id, nodes }) => `${id}: ${nodes[0].html}`),
      [],
    );
    await audited.context().close();
  });
}

// Tests that for those who asked for less motion the picture moves on a few times a second, not sixty.
test('less motion on request', async () => {
  const calm = await openPage(browser, scope.address, { reducedMotion: 'reduce' });
  await streaming(calm);
  const start = await calm.evaluate(() => ({ frames: hydroScope.panes.frames, last: hydroScope.display.last }));
  await until(calm, (from) => hydroScope.display.last > from + 2, start.last);
  const end = await calm.evaluate(() => ({ frames: hydroScope.panes.frames, last: hydroScope.display.last }));
  const rate = (end.frames - start.frames) / (end.last - start.last);
  assert.ok(rate > 0 && rate < 8, `${rate} frames a second`);
  await calm.context().close();
});

// Tests that words on the page keep a contrast of 4.5 to 1 in light and in dark (WCAG AA).
for (const colours of ['light', 'dark']) {
  test(`contrast, ${colours}`, async () => {
    await page.emulateMedia({ colorScheme: colours });
    const poor = await page.evaluate(() => {
      const channels = (text) => text.match(/[\d.]+/g).map(Number);
      const light = ([r, g, b]) =>
        [r, g, b]
          .map((v) => v / 255)
          .map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4))
          .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
      const behind = (one) => {
        for (let at = one; at; at = at.parentElement) {
          const colour = channels(getComputedStyle(at).backgroundColor);
          if (colour.length < 4 || colour[3] > 0.5) return colour;
        }
        return [255, 255, 255];
      };
      return [...document.querySelectorAll('body *')]
        .filter(
          (one) =>
            one.offsetParent &&
            !one.closest(':disabled, [aria-disabled=true]') &&
            [...one.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim()),
        )
        .map((one) => {
          const [a, b] = [light(channels(getComputedStyle(one).color)), light(behind(one))].sort((x, y) => y - x);
          return { text: one.textContent.trim().slice(0, 30), ratio: (a + 0.05) / (b + 0.05) };
        })
        .filter(({ ratio }) => ratio < 4.5);
    });
    assert.deepEqual(poor, []);
  });
}

test('no errors in the page', () => assert.deepEqual(page.problems, []));
