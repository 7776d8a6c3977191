// Tests of what leaves the page: a window of a log as log, table and picture.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { readTable, until } from './browser.mjs';
import { kGap, kSpike, onALogWithAGap } from './gap_log.mjs';

let bench, page;

onALogWithAGap((open) => ({ bench, page } = open));

async function download(name) {
  const coming = page.waitForEvent('download');
  await page.locator('#section-files').getByRole('button', { name, exact: true }).click();
  const file = await coming;
  const where = bench.file(file.suggestedFilename());
  await file.saveAs(where);
  return where;
}

// Tests that the window between the cursors comes out as a table, a log, and pictures.
test('a window is cut out', async () => {
  await page.locator('#section-files summary').click();
  await page.keyboard.press('f');
  await page.evaluate(() => {
    hydroScope.cursors.place('a', 3.1995);
    hydroScope.cursors.place('b', 3.2495);
  });
  const { rows } = readTable(readFileSync(await download('CSV'), 'utf8'));
  assert.equal(rows.length, 50);
  assert.equal(Number(rows[10].p1_psi), kSpike.psi);
  const cut = await download('.lcmlog');
  assert.match(bench.run('hydro-log', 'info', cut), /log: complete/);
  assert.match(readFileSync(await download('SVG'), 'utf8'), /^<svg[^]*arm_angle \[rad\][^]*<path [^]*<\/svg>\n$/);
  assert.equal(
    readFileSync(await download('PNG'))
      .subarray(1, 4)
      .toString(),
    'PNG',
  );
});

// Tests that a cut has every row and every cell of the log's own export of that window, to the last digit, what was sent before and held too; and in
// SI the pressures in Pa with that in their names, and nothing else changed.
test('a cut in SI has the values of the export', async () => {
  const window = { from: 3.1995, to: 5.4995 }; // over the gap
  await page.evaluate(({ from, to }) => {
    hydroScope.cursors.place('a', from);
    hydroScope.cursors.place('b', to);
  }, window);
  bench.run('hydro-log', 'export', bench.file('spike.lcmlog'), '-o', bench.file('whole.csv'));
  const whole = readTable(readFileSync(bench.file('whole.csv'), 'utf8'));
  const wanted = whole.rows.filter(({ time_s }) => Number(time_s) >= window.from && Number(time_s) <= window.to);
  assert.equal(wanted.length, 2300 - (kGap.to - kGap.from));

  const paper = readTable(readFileSync(await download('CSV'), 'utf8'));
  assert.deepEqual(paper.columns, whole.columns);
  assert.equal(paper.rows.length, wanted.length);
  for (const [i, row] of wanted.entries()) {
    for (const column of whole.columns) assert.equal(paper.rows[i][column], row[column], `${column} of row ${i}`);
  }
  assert.notEqual(paper.rows[0].arm_ref_rad, '');

  await page.keyboard.press('u');
  const si = readTable(readFileSync(await download('CSV'), 'utf8'));
  await page.keyboard.press('u');
  const named = (column) => column.replace(/_psi$/, '_Pa');
  assert.deepEqual(si.columns, whole.columns.map(named));
  assert.deepEqual(
    whole.columns.filter((column) => named(column) !== column),
    ['pressure_ref_psi', 'p1_psi', 'p2_psi'],
  );
  assert.equal(si.rows.length, wanted.length);
  // 1 psi = 1 lbf/in^2, by the exact definitions of pound, standard gravity and inch.
  const kPascal = (0.45359237 * 9.80665) / 0.0254 ** 2;
  for (const [i, row] of paper.rows.entries()) {
    for (const column of whole.columns) {
      const found = si.rows[i][named(column)];
      if (!column.endsWith('_psi') || row[column] === '') assert.equal(found, row[column], `${column} of row ${i}`);
      else {
        const right = Number(row[column]) * kPascal;
        const error = Math.abs(Number(found) - right);
        assert.ok(error <= 1e-15 * Math.abs(right) + 1e-300, `${named(column)} of row ${i}: ${found}, not ${right}`);
      }
    }
  }
});

// The commonest colour of a picture's column at x, from y on, on paper. Runs in the page.
function colourOfColumn(picture, x, y, height) {
  const canvas = document.createElement('canvas');
  Object.assign(canvas, { width: picture.width, height: picture.height });
  const ctx = canvas.getContext('2d');
  ctx.fillStyle = hydroScope.panes.colours.paper;
  ctx.fillRect(0, 0, canvas.width, canvas.height);
  ctx.drawImage(picture, 0, 0);
  const { data } = ctx.getImageData(Math.round(x), Math.round(y) + 2, 1, Math.round(height) - 4);
  const seen = new Map();
  for (let i = 0; i < data.length; i += 4) {
    const name = data.slice(i, i + 3).join(' ');
    seen.set(name, (seen.get(name) ?? 0) + 1);
  }
  return [...seen]
    .sort((one, other) => other[1] - one[1])[0][0]
    .split(' ')
    .map(Number);
}

// The gaps of an SVG, each with the colours inside, beside the mark of its event, and outside.
function gapsOf(svg) {
  return page.evaluate(async (text) => {
    const picture = new Image();
    picture.src = `data:image/svg+xml,${encodeURIComponent(text)}`;
    await picture.decode();
    const root = new DOMParser().parseFromString(text, 'image/svg+xml').documentElement;
    return [...root.querySelectorAll('rect.gap')].map((one) => {
      const [x, y, width, height] = ['x', 'y', 'width', 'height'].map((name) => Number(one.getAttribute(name)));
      return {
        from: x,
        to: x + width,
        words: one.textContent,
        inside: colourOfColumn(picture, x + width / 3, y, height),
        outside: colourOfColumn(picture, x + 1.5 * width, y, height),
      };
    });
  }, svg);
}

// Tests that the picture that is saved has the missing stretch of the log where the screen has it, in the same colour, in
// every pane, and none where the window has no gap.
test('an SVG shades the gap as the screen does', async () => {
  await page.keyboard.press('c');
  await page.evaluate(`globalThis.colourOfColumn = ${colourOfColumn}`);
  await page.evaluate(() => hydroScope.display.showWindow(4, 7));
  await until(page, () => hydroScope.display.frame().bins.width <= 3.1 / hydroScope.display.pixels);
  const gaps = await gapsOf(readFileSync(await download('SVG'), 'utf8'));
  const screen = await page.evaluate(
    ([from, to]) => {
      return hydroScope.panes.panes.map(({ chart, host }) => {
        const { top, height } = chart.plot.bbox;
        const column = (t) => colourOfColumn(host.querySelector('canvas'), chart.x(t), top, height);
        return {
          from: chart.x(from) / devicePixelRatio,
          to: chart.x(to) / devicePixelRatio,
          inside: column(from + (to - from) / 3),
          outside: column(from + 1.5 * (to - from)),
        };
      });
    },
    [(kGap.from - 1) / 1000, kGap.to / 1000],
  );
  assert.ok(screen.length >= 5);
  assert.equal(gaps.length, screen.length, 'a gap in every pane');
  for (const [i, { from, to, words, inside, outside }] of gaps.entries()) {
    assert.ok(Math.abs(from - screen[i].from) < 1.5, `pane ${i}: from ${from}, on the screen ${screen[i].from}`);
    assert.ok(Math.abs(to - screen[i].to) < 1.5, `pane ${i}: to ${to}, on the screen ${screen[i].to}`);
    const apart = inside.map((part, k) => Math.abs(part - screen[i].inside[k]));
    assert.ok(Math.max(...apart) <= 3, `pane ${i}: the gap is ${inside}, on the screen ${screen[i].inside}`);
    assert.notDeepEqual(inside, outside);
    assert.match(words, /^no samples from 4\.99\d to 5\.20\d s$/);
  }
  await page.evaluate(() => hydroScope.display.showWindow(6, 7));
  await until(page, () => hydroScope.display.frame().bins.width <= 1.1 / hydroScope.display.pixels);
  assert.deepEqual(await gapsOf(readFileSync(await download('SVG'), 'utf8')), []);
});

test('no errors in the page', () => assert.deepEqual(page.problems, []));
