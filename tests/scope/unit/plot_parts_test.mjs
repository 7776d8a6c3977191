// Tests of the time base, the value axis, the cursors and the line drawn from bins.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { cursorNear, cursorRows, interval, moved, noCursors, placed } from '../../../scope/page/plot/cursors.js';
import { valueAxisSize } from '../../../scope/page/plot/axes.js';
import { sharpStep } from '../../../scope/page/panels/reference_form.js';
import { fitted, following, stepped, zoomed } from '../../../scope/page/plot/time_window.js';
import { bridge, gapsIn, gapsShown, trace } from '../../../scope/page/plot/trace_path.js';
import { between, colourOf } from '../../../scope/page/plot/colours.js';
import { tracesOf } from '../../../scope/page/plot/traces.js';
import { extent, StickyRange } from '../../../scope/page/plot/value_range.js';

// Tests that the time base goes 1, 2, 5, 10 both ways, and from values in between to the next one.
test('the time base steps 1-2-5', () => {
  const up = [0.001];
  for (let i = 0; i < 6; i += 1) up.push(stepped(up.at(-1), 1));
  assert.deepEqual(up, [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1]);
  assert.equal(stepped(1, -1), 0.5);
  assert.equal(stepped(2, -1), 1);
  assert.equal(stepped(3, -1), 2);
  assert.equal(stepped(3, 1), 5);
  assert.equal(stepped(0.9), 1);
  assert.equal(stepped(4), 5);
});

// Tests that a value axis has room for all its numbers, minus signs too, that charts above each other share it, and that it does not shrink.
test('numbers of a value axis', () => {
  let grown = 0;
  const room = { px: 0, grown: () => (grown += 1) };
  const widthOf = (text) => 7 * text.length;
  assert.equal(valueAxisSize(['\u22121', '0', '1'], 46, room, widthOf), 46);
  assert.equal(valueAxisSize(null, 46, room, widthOf), 46);
  assert.equal(grown, 0);
  const wide = valueAxisSize(['\u22125000000', '0', '5000000'], 46, room, widthOf);
  assert.ok(wide >= 8 * 7 + 8, `${wide}`);
  assert.equal(grown, 1);
  assert.equal(valueAxisSize(['1'], 46, room, widthOf), wide, 'the other charts stand below it');
  assert.equal(valueAxisSize(['1'], 62, { px: 0, grown() {} }, widthOf), 62);
});

// Tests that a sharp step begins where the reference is and jumps when a new reference is followed at full.
test('a sharp step', () => {
  assert.deepEqual(sharpStep({ to: '0.3' }, 0.1, 0.5), ['reference.initial=0.1', 'reference.steps=[[0.6, 0.3]]']);
  assert.deepEqual(sharpStep({ to: '-5' }, 2, 0), ['reference.initial=2', 'reference.steps=[[0.1, -5]]']);
});

// Tests that zooming keeps the time under the pointer where it is.
test('zoom keeps the time under the pointer', () => {
  const out = zoomed({ t0: 10, t1: 20 }, 0.5, 12);
  assert.deepEqual(out, { t0: 11, t1: 16 });
  assert.equal(zoomed({ t0: 0, t1: 0.002 }, 1e-6, 0.001).t1 > 0.001, true);
});

test('a young run begins at the left', () => {
  assert.deepEqual(following(0, 2, 10), { t0: 0, t1: 10 });
  assert.deepEqual(following(0, 12, 10), { t0: 2, t1: 12 });
  assert.deepEqual(fitted(3, 8), { t0: 3, t1: 8 });
});

// Tests that the axis grows at once and shrinks only after the data were small for a while.
test('the value axis does not breathe', () => {
  const axis = new StickyRange();
  const first = axis.update({ low: 0, high: 100 }, 0);
  assert.deepEqual(first, { low: -6, high: 106 });
  assert.equal(axis.update({ low: 0, high: 200 }, 10).high, 212);
  assert.equal(axis.update({ low: 0, high: 10 }, 20).high, 212);
  assert.equal(axis.update({ low: 0, high: 10 }, 1000).high, 212);
  assert.equal(axis.update({ low: 0, high: 10 }, 2000).high, 10.6);
});

const bins = {
  t: Float64Array.of(0.5, 1.5, 2.5, 6.5),
  width: 1,
  min: { dp: Float64Array.of(1, -3, 2, 5) },
  max: { dp: Float64Array.of(1, 9, 2, 5) },
};

test('the extent takes minima and maxima', () => {
  assert.deepEqual(extent(bins, ['dp'], 0, 3), { low: -3, high: 9 });
  assert.equal(extent(bins, ['p1'], 0, 3), null);
});

// Tests that a bin's line reaches its minimum and its maximum, and that a gap is not bridged.
test('a spike is drawn from minimum to maximum, a gap is not drawn', () => {
  const strokes = [];
  const pen = { moveTo: (x, y) => strokes.push(['move', x, y]), lineTo: (x, y) => strokes.push(['line', x, y]) };
  trace(pen, bins, bins.min.dp, bins.max.dp, { x: (t) => t, y: (v) => v, held: false, bridge_s: 2 });
  assert.deepEqual(strokes, [
    ['move', 0.5, 1],
    ['line', 1, 1],
    ['line', 1.5, -3],
    ['line', 1.5, 9],
    ['line', 2.5, 2],
    ['move', 6.5, 5],
    ['line', 7, 5],
  ]);
  assert.deepEqual(gapsIn(bins, bins.min.dp, 2, 0, 10), [[2.5, 6.5]]);
});

// Tests that a pane's gaps are those of its first curve that is seen, and none where no curve is.
test('the gaps that a pane shows', () => {
  const channel = { id: 'dp' };
  const frame = { bins: { ...bins, min: { ...bins.min, p1: Float64Array.of(1, NaN, 2, 5) } } };
  const trace = (id, hidden = false, kind = 'measured') => ({ id, hidden, kind, channel });
  const gaps = (...traces) => gapsShown(frame, { traces, rate_hz: 2, first: 0, last: 10 });
  assert.deepEqual(gaps(trace('dp')), [[2.5, 6.5]]);
  assert.deepEqual(gaps(trace('p1', true), trace('p1', false, 'ghost'), trace('dp')), [[2.5, 6.5]]);
  assert.deepEqual(gaps(trace('dp', true)), []);
  assert.deepEqual(gaps(trace('gone')), []);
});

// Tests that a held value is a staircase.
test('held values step', () => {
  const strokes = [];
  const pen = { moveTo: (x, y) => strokes.push([x, y]), lineTo: (x, y) => strokes.push([x, y]) };
  const step = { t: Float64Array.of(0, 1), width: 1 };
  trace(pen, step, Float64Array.of(1, 4), Float64Array.of(1, 4), { x: (t) => t, y: (v) => v, held: true, bridge_s: 2 });
  assert.deepEqual(strokes, [
    [0, 1],
    [0.5, 1],
    [1, 1],
    [1, 4],
  ]);
});

// Tests that bins narrower than the sampling interval are one curve: empty bins between samples are no gaps.
test('narrow bins are bridged', () => {
  assert.equal(bridge({ id: 'dp' }, 1000, 1e-4) > 0.002, true);
  assert.equal(bridge({ id: 'dp' }, 1000, 1e-4) < 0.005, true);
});

test('cursors measure intervals and differences', () => {
  let cursors = placed(placed(noCursors(), 'a', 1), 'b', 1.25);
  assert.deepEqual(interval(cursors), { dt: 0.25, rate: 4 });
  assert.equal(interval(noCursors()), null);
  cursors = moved(cursors, 0.25);
  assert.equal(cursors.b, 1.5);
  assert.equal(cursorNear(cursors, 1.1, 0.2), 'a');
  assert.equal(cursorNear(cursors, 1.3, 0.01), null);
  assert.deepEqual(cursorRows(['dp'], { values: [3] }, { values: [10] }), [{ id: 'dp', a: 3, b: 10, difference: 7 }]);
});

// Tests that a pane draws its channels, the ghost's and the other run's of the same name, on an axis for each
// unit.
test('the traces of a pane', () => {
  const channels = {
    p1: { id: 'p1', unit: 'psi' },
    voltage: { id: 'voltage', unit: 'V' },
    'ghost.p1': { id: 'ghost.p1', unit: 'psi' },
  };
  const { traces, units } = tracesOf(
    { channels: ['p1', 'voltage', 'gone'], hidden: ['voltage'] },
    { channel: (id) => channels[id], ghost: true, overlay: (id) => (id === 'p1' ? channels.p1 : undefined), si: false },
  );
  assert.deepEqual(units, ['psi', 'V']);
  assert.deepEqual(
    traces.map(({ id, kind, axis, hidden }) => [id, kind, axis, hidden]),
    [
      ['p1', 'measured', 0, false],
      ['ghost.p1', 'ghost', 0, false],
      ['p1', 'overlay', 0, false],
      ['voltage', 'measured', 1, true],
    ],
  );
});

test('colours of events and between two colours', () => {
  assert.equal(colourOf({ kind: 'fault' }), 'bad');
  assert.equal(colourOf({ kind: 'mark' }), 'accent');
  assert.equal(between('#000000', '#ff8001'), '#804001');
});
