// Tests of who may look: a wrong token and a foreign origin may not, and the page says what to do.
import assert from 'node:assert/strict';
import { createServer } from 'node:http';
import { after, before, test } from 'node:test';
import { openBrowser, openPage, streaming, until } from './browser.mjs';
import { Bench, kToken } from './stack.mjs';

let bench, scope, browser, foreign;

before(async () => {
  bench = await Bench.make();
  await bench.launch(bench.file('run.lcmlog'));
  scope = await bench.scope();
  browser = await openBrowser();
  foreign = createServer((request, response) =>
    response.writeHead(200, { 'Content-Type': 'text/html' }).end('<title>elsewhere</title>'),
  );
  await new Promise((done) => foreign.listen(0, '127.0.0.1', done));
});
after(async () => {
  foreign?.close();
  await browser?.close();
  await bench?.close();
});

// Tests that a wrong token shows no data but a sentence, and that the right one, given there, opens the
// picture.
test('a wrong token is refused in words, and can be mended on the page', async () => {
  const page = await openPage(browser, `${scope.origin}/#token=${'0'.repeat(32)}`);
  await page.locator('#link[data-state=refused]').waitFor();
  await page.getByText('The token is not (or no longer) right').waitFor();
  assert.equal(await page.evaluate(() => hydroScope.scope.hello), null);
  await page.getByLabel('Token or address').fill(scope.address);
  await page.getByRole('button', { name: 'Connect' }).click();
  await streaming(page);
  assert.deepEqual(page.problems, []);
  await page.context().close();
});

test('without a token the page says where it is', async () => {
  const page = await openPage(browser, `${scope.origin}/`);
  await page.getByText('A token is needed').waitFor();
  assert.equal((await fetch(`${scope.origin}/api/status`)).status, 401);
  await page.context().close();
});

// Tests that a page of another origin gets neither the web socket nor the answers, even with the right token.
test('a foreign origin is refused', async () => {
  const page = await openPage(browser, `http://127.0.0.1:${foreign.address().port}/`);
  const outcome = await page.evaluate(
    ([port, token]) =>
      new Promise((done) => {
        const socket = new WebSocket(`ws://127.0.0.1:${port}/live?token=${token}`, 'hydro.scope.v1');
        socket.onopen = () => done('open');
        socket.onerror = () => done('refused');
      }),
    [scope.port, kToken],
  );
  assert.equal(outcome, 'refused');
  const answer = await page.evaluate(
    ([origin, token]) =>
      fetch(`${origin}/api/status?token=${token}`).then(
        () => 'read',
        () => 'refused',
      ),
    [scope.origin, kToken],
  );
  assert.equal(answer, 'refused');
  await page.context().close();
});

// Tests that what a fault's or a mark's text says is shown as text, whatever it looks like.
test('hostile text stays text', async () => {
  const page = await openPage(browser, scope.address);
  await streaming(page);
  const nasty = '<img src=x onerror="document.title=1"><script>document.title=2</script>';
  await page.evaluate(
    (text) => hydroScope.link.send({ op: 'mark', run: hydroScope.scope.run.run, t: hydroScope.display.last, text }),
    nasty,
  );
  await until(page, () => document.querySelector('.events [data-kind=mark]'));
  assert.ok((await page.locator('.events [data-kind=mark] .what').first().textContent()).includes('<script>'));
  assert.equal(await page.locator('.events img, .events script').count(), 0);
  assert.equal(await page.title(), 'demo.toml · hydro-scope');
  assert.deepEqual(page.problems, []);
  await page.context().close();
});

// Tests that the page runs under a policy that allows nothing from elsewhere and no inline script.
test('the content security policy is strict', async () => {
  const answer = await fetch(`${scope.origin}/`);
  const policy = answer.headers.get('content-security-policy');
  assert.match(policy, /default-src 'self'/);
  assert.doesNotMatch(policy, /script-src[^;]*unsafe|unsafe-eval|\*/);
  assert.equal(answer.headers.get('referrer-policy'), 'no-referrer');
});
