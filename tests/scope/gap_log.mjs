// What tests of logs begin with: a log with a spike and a gap, and a page that shows it.

import { readFileSync, writeFileSync } from 'node:fs';
import { after, before } from 'node:test';
import { openBrowser, openPage, readTable, until } from './browser.mjs';
import { Bench, demoConfig } from './stack.mjs';

// One sample of p1, and rows (of 1 ms) that are taken out.
export const kSpike = { row: 3210, t: 3.21, psi: 900 };
export const kGap = { from: 5000, to: 5200 };

// Opens it before the file's tests and closes it after; `use` is given {bench, page, table: the rows of spike.lcmlog in the
// bench's folder}. The run as it was is sim.lcmlog.
export function onALogWithAGap(use) {
  let bench, browser;
  before(async () => {
    bench = await Bench.make();
    const table = makeLog(bench);
    const scope = await bench.scope(bench.file('spike.lcmlog'));
    browser = await openBrowser();
    const page = await openPage(browser, scope.address);
    await until(page, () => hydroScope.panes.panes.length > 0 && hydroScope.display.frame().bins.t.length > 100);
    use({ bench, page, table });
  });
  after(async () => {
    await browser?.close();
    await bench?.close();
  });
}

function makeLog(bench) {
  bench.run('hydro-sim', demoConfig(), '--time', 'lockstep', '--log', bench.file('sim.lcmlog'));
  bench.run('hydro-log', 'export', bench.file('sim.lcmlog'), '-o', bench.file('sim.csv'));
  const lines = readFileSync(bench.file('sim.csv'), 'utf8').trim().split('\n');
  const column = lines[0].split(',').indexOf('p1_psi');
  const cells = lines[1 + kSpike.row].split(',');
  cells[column] = String(kSpike.psi);
  lines[1 + kSpike.row] = cells.join(',');
  lines.splice(1 + kGap.from, kGap.to - kGap.from);
  writeFileSync(bench.file('spike.csv'), `${lines.join('\n')}\n`);
  bench.run('hydro-log', 'import', bench.file('spike.csv'), '-o', bench.file('spike.lcmlog'));
  return readTable(lines.join('\n'));
}
