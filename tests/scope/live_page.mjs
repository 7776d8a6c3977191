// What most tests of the page begin with: a stack that moves to and fro, hydro-scope beside it, and a page that streams.

import assert from 'node:assert/strict';
import { after, before, beforeEach } from 'node:test';
import { openBrowser, openPage, streaming } from './browser.mjs';
import { Bench } from './stack.mjs';

// Opens them before the file's tests and closes them after; `use` is given {bench, stack, scope, browser, page} and awaited. sets: of the
// stack;
// scopeSets: of hydro-scope; seconds: of the run, before the first test.
export function onALivePage(use, { log = 'run.lcmlog', sets = [], scopeSets = [], seconds = 1 } = {}) {
  let bench, browser, stack;
  before(async () => {
    bench = await Bench.make();
    stack = await bench.launch(bench.file(log), sets);
    const scope = await bench.scope(undefined, { sets: scopeSets });
    browser = await openBrowser();
    const page = await openPage(browser, scope.address);
    await streaming(page, seconds);
    await use({ bench, stack, scope, browser, page });
  });
  // Where the stack has ended by itself (a machine that stood still lets the arm leave its limits), each test would wait in vain, and
  // steady.py would have no time to repeat them.
  beforeEach(() => assert.ok(!stack.over || stack.stopped, 'the stack has ended'));
  after(async () => {
    console.log(stack?.lines.join('\n'));
    await browser?.close();
    await bench?.close();
  });
}
