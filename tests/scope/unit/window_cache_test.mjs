// Tests of the cache of a window's bins: one request at a time, wider than shown, anew when it falls short.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { WindowCache } from '../../../scope/page/plot/window_cache.js';

const kRun = { run: 0, session: 's', rate_hz: 1000, last: 100 };

// A server that answers when it is told to.
class Link {
  asked = [];

  request(message) {
    return new Promise((done, fail) => this.asked.push({ message, done, fail }));
  }

  async answer() {
    const { message, done } = this.asked.at(-1);
    const bins = message.pixels;
    const width = (message.t1 - message.t0) / bins;
    const values = Float64Array.from({ length: bins }, (_, i) => i);
    done({ t0: message.t0, width, bins, min: [values], max: [values] });
    await new Promise((turn) => setImmediate(turn));
  }
}

const make = () => {
  const link = new Link();
  let drawn = 0;
  const cache = new WindowCache(link, () => (drawn += 1));
  return { link, cache, drawn: () => drawn };
};

test('a window is asked for once, half as wide again on either side', async () => {
  const { link, cache, drawn } = make();
  assert.equal(cache.bins(kRun, ['dp'], 10, 20, 100).t.length, 0);
  cache.bins(kRun, ['dp'], 10, 20, 100);
  assert.equal(link.asked.length, 1);
  const { t0, t1, pixels } = link.asked[0].message;
  assert.deepEqual([t0, t1, pixels], [5, 25, 200]);
  await link.answer();
  assert.equal(drawn(), 1);
  assert.equal(cache.bins(kRun, ['dp'], 10, 20, 100).t.length, 200);
  assert.equal(cache.bins(kRun, ['dp'], 6, 16, 100).t.length, 200);
  assert.equal(link.asked.length, 1);
});

test('a window beyond what is there, a finer one, and other channels are asked for', async () => {
  const { link, cache } = make();
  cache.bins(kRun, ['dp'], 10, 20, 100);
  await link.answer();
  assert.equal(cache.bins(kRun, ['dp'], 20, 30, 100).t.length, 200); // what is there is shown meanwhile
  assert.equal(link.asked.length, 2);
  await link.answer();
  cache.bins(kRun, ['dp'], 22, 24, 100);
  assert.equal(link.asked.length, 3);
  await link.answer();
  assert.equal(cache.bins(kRun, ['p1'], 22, 24, 100).t.length, 0);
  assert.equal(link.asked.length, 4);
});

// Tests that a server that refuses is not asked again at once, and that bins of an earlier session are never shown.
test('refusals and restarts', async () => {
  const { link, cache } = make();
  cache.bins(kRun, ['dp'], 10, 20, 100);
  link.asked[0].done({ op: 'reply', ok: false, text: 'no such run' });
  await new Promise((turn) => setImmediate(turn));
  cache.bins(kRun, ['dp'], 10, 20, 100);
  assert.equal(link.asked.length, 1);
  const other = make();
  other.cache.bins(kRun, ['dp'], 10, 20, 100);
  await other.link.answer();
  assert.equal(other.cache.bins({ ...kRun, session: 't' }, ['dp'], 10, 20, 100).t.length, 0);
});
