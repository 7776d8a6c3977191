// Tests that the page comes back by itself, and says so, when the server or the stack is started again.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { openPage, streaming, until } from './browser.mjs';
import { onALivePage } from './live_page.mjs';

let bench, stack, scope, browser, page;

onALivePage((live) => ({ bench, stack, scope, browser, page } = live), { log: 'one.lcmlog' });

// Tests that a killed server is noticed and named, and that its successor on the same port is found without a
// hand.
test('the server is started again', async () => {
  await scope.program.stop('SIGKILL');
  await page.locator('#link[data-state=lost]').waitFor();
  await page.getByText('No connection to hydro-scope: what is shown is old.').waitFor();
  scope = await bench.scope(undefined, { port: scope.port });
  await page.locator('#link[data-state=open]').waitFor();
  await page.locator('.notice [data-subject=link]').waitFor({ state: 'detached' });
  const frames = await page.evaluate(() => hydroScope.panes.frames);
  await until(
    page,
    (before) => hydroScope.panes.frames > before + 10 && hydroScope.display.frame().bins.t.length > 10,
    frames,
  );
});

// Tests that a server that hangs with its connections open is named as silent, and that the page goes on when
// it does.
test('the server hangs', async () => {
  scope.program.child.kill('SIGSTOP');
  try {
    await page.locator('#link[data-state=stuck]').waitFor();
    await page.getByText('what is shown may be old').waitFor();
  } finally {
    scope.program.child.kill('SIGCONT');
  }
  await page.locator('#link[data-state=open]').waitFor();
  const frames = await page.evaluate(() => hydroScope.panes.frames);
  await until(page, (before) => hydroScope.panes.frames > before + 10, frames);
});

// Tests that a stack that ends is named as silent, and that a new one is shown from its first second on.
test('the stack is started again', async () => {
  await stack.stop();
  await page.getByText(/The stack has been silent|The run has ended/).waitFor();
  const before = await page.evaluate(() => hydroScope.display.last);
  stack = await bench.launch(bench.file('two.lcmlog'));
  await page.getByText('The stack was started again: its time begins anew.').waitFor();
  await until(
    page,
    (last) =>
      hydroScope.display.last < last && hydroScope.display.last > 0.3 && hydroScope.display.frame().bins.t.length > 10,
    before,
  );
  const newest = await page.evaluate(() => hydroScope.display.frame().bins.t.at(-1));
  const latest = await page.evaluate(() => Math.max(0, ...hydroScope.scope.eventsOf().map(({ t }) => t)));
  assert.ok(latest < before, `an event of the run before, at ${latest} s, is shown in the new one`);
  assert.ok(newest < before, `the newest bin is at ${newest} s of a run that began anew`);
});

// Tests that a token that is no longer right after a restart of the server leads to a sentence, not to
// endless attempts.
test('a server with a new token', async () => {
  const again = await bench.scope(undefined, { token: 'abcdefabcdefabcdefabcdefabcdefab' });
  const other = await openPage(browser, again.address);
  await streaming(other);
  await again.program.stop('SIGKILL');
  await other.locator('#link[data-state=lost]').waitFor();
  await bench.scope(undefined, { port: again.port, token: '1'.repeat(32) });
  await other.getByText('hydro-scope makes a new one at each start').waitFor();
  await other.context().close();
});

test('no errors in the page', () => assert.deepEqual(page.problems, []));
