// Tests of the store of streamed bins and of the frames that fill it.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { decodeBins, encodeBins } from '../../../scope/page/link/frames.js';
import { BinStore } from '../../../scope/page/plot/bin_store.js';

const frame = (t0, width, values) =>
  decodeBins(encodeBins({ id: 1, run: 0, t0, width, min: [values], max: [values.map((v) => v + 1)] }));

// Tests that a frame comes out as it went in, bit for bit, with NaN where there was no sample.
test('frames carry doubles unchanged', () => {
  const min = [
    [0.1, -0, NaN],
    [1e-300, 2, 3],
  ];
  const max = [
    [0.2, 1, NaN],
    [1e300, 2, 4],
  ];
  const got = decodeBins(encodeBins({ id: 7, run: 2, flags: 3, t0: 1.25, width: 0.001, min, max }));
  assert.equal(got.id, 7);
  assert.equal(got.run, 2);
  assert.equal(got.flags, 3);
  assert.equal(got.t0, 1.25);
  assert.deepEqual(
    got.min.map((a) => [...a]),
    min,
  );
  assert.deepEqual(
    got.max.map((a) => [...a]),
    max,
  );
});

// Tests that a frame that is cut short, or of another kind, is refused and not read beyond its end.
test('torn and foreign frames are refused', () => {
  const whole = encodeBins({ id: 1, run: 0, t0: 0, width: 1, min: [[1, 2]], max: [[1, 2]] });
  assert.throws(() => decodeBins(whole.slice(0, whole.byteLength - 8)), /bytes: 1 channels of 2 bins take 72/);
  assert.throws(() => decodeBins(new ArrayBuffer(8)), /its header has 40/);
  new DataView(whole).setUint32(0, 9, true);
  assert.throws(() => decodeBins(whole), /kind 9/);
});

// Tests that the newest bin, sent again when it is complete, replaces its first version.
test('a bin that is sent again replaces the first', () => {
  const store = new BinStore(['dp'], 8);
  store.add(frame(1.0, 0.5, [10, 20]));
  store.add(frame(1.5, 0.5, [25, 30]));
  const bins = store.between(1, 2.4);
  assert.deepEqual([...bins.t], [1.25, 1.75, 2.25]);
  assert.deepEqual([...bins.min.dp], [10, 25, 30]);
  assert.deepEqual([...bins.max.dp], [11, 26, 31]);
});

// Tests that bins that were never sent are without samples, and that the store keeps its size.
test('gaps are without samples, and the oldest bins go', () => {
  const store = new BinStore(['dp'], 4);
  store.add(frame(0, 1, [1, 2]));
  store.add(frame(4, 1, [5, 6]));
  assert.equal(store.first, 2);
  assert.deepEqual([...store.between(2, 6).min.dp], [NaN, NaN, 5, 6]);
});

// Tests that a frame longer than the store leaves its newest bins, and that a restart of the run begins anew.
test('long frames and restarts', () => {
  const store = new BinStore(['dp'], 4);
  store.add(frame(0, 1, [1, 2, 3, 4, 5, 6]));
  assert.deepEqual([...store.between(0, 10).min.dp], [3, 4, 5, 6]);
  store.add(frame(100, 1, [7]));
  assert.deepEqual([...store.between(0, 200).min.dp], [7]);
  store.add(frame(0, 1, [8, 9]));
  assert.deepEqual([...store.between(0, 200).min.dp], [8, 9]);
});

// Tests that bins centred on samples stand at the samples, whatever the last digits of their first bin's
// time.
test('bins of one sample stand at the sample', () => {
  const store = new BinStore(['dp'], 8);
  store.add(frame(4999.5 * 0.001, 0.001, [1, 2]));
  store.add(frame(5001.5 * 0.001 + 1e-12, 0.001, [3]));
  store.add(frame(5002.5 * 0.001 - 1e-12, 0.001, [4]));
  const bins = store.between(5, 5.003);
  assert.deepEqual(
    [...bins.t].map((t) => Number(t.toFixed(9))),
    [5, 5.001, 5.002, 5.003],
  );
  assert.deepEqual([...bins.min.dp], [1, 2, 3, 4]);
});
