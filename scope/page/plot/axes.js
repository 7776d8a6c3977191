// The axes of a chart as uPlot wants them: time below, one or two value axes, numbers in steps of 1, 2, 5.

import { short } from '../settings/numbers.js';

const kFont = '11px Helvetica, Arial, "Liberation Sans", sans-serif';
const kLeft = 62;
const kLeftNarrow = 46; // on a phone every pixel counts
const kNarrow_px = 520;
const kRight = 14;
const kTimeAxis = 24;
const kTimeLabel_px = 90; // between numbers of the time axis at least
const kBesideLabel_px = 12; // the tick, and the gaps on both sides of the number
const kLabel_px = 12; // between numbers of a value axis at least: a low pane still has two
const kMostLabels = 5;

const kSteps = [];
for (let power = -7; power <= 8; power += 1)
  kSteps.push(Number(`1e${power}`), Number(`2e${power}`), Number(`5e${power}`));

// How wide a value axis is: all numbers have their place, and charts above each other the same one. room: {px, grown()}, what all of
// them share; it only grows. widthOf(text): in pixels.
export function valueAxisSize(labels, least_px, room, widthOf) {
  const needed =
    Math.ceil(Math.max(0, ...(labels ?? []).map((label) => widthOf(String(label ?? ''))))) + kBesideLabel_px;
  if (needed > Math.max(least_px, room.px)) {
    room.px = needed;
    room.grown();
  }
  return Math.max(least_px, room.px);
}

// {axes, padding}. options: {units, colours, time_axis: with numbers, right: leave room for a second value
// axis, room: of valueAxisSize}
export function chartAxes({ units, colours, time_axis, right, room }, width_px) {
  const grid = { stroke: () => colours.fine, width: 1 };
  const common = {
    font: kFont,
    stroke: () => colours.soft,
    ticks: { stroke: () => colours.line, width: 1, size: 4 },
    incrs: kSteps,
  };
  const value = {
    ...common,
    size: (u, labels) =>
      valueAxisSize(labels, width_px < kNarrow_px ? kLeftNarrow : kLeft, room, (text) => inFont(u.ctx, text)),
    gap: 4,
    space: (u, axis, low, high, pixels) => Math.max(kLabel_px, Math.min(2 * kLabel_px, pixels / kMostLabels)),
    values: valueLabels,
  };
  const second = units.length > 1;
  return {
    padding: [6, right ? 0 : kRight, time_axis ? 0 : 6, 0],
    axes: [
      {
        ...common,
        scale: 'x',
        size: time_axis ? kTimeAxis : 0,
        gap: 3,
        space: kTimeLabel_px,
        grid,
        values: time_axis ? timeLabels : () => [],
        ticks: { ...common.ticks, show: time_axis },
      },
      { ...value, scale: 'y0', grid },
      {
        ...value,
        scale: 'y1',
        side: 1,
        show: right,
        grid: { show: false },
        values: second ? valueLabels : () => [],
        ticks: { ...common.ticks, show: second },
      },
    ],
  };
}

function inFont(ctx, text) {
  ctx.save();
  ctx.font = kFont;
  const { width } = ctx.measureText(text);
  ctx.restore();
  return width;
}

function valueLabels(u, splits) {
  return splits.map((value) =>
    short(Math.abs(value) < 1e-12 ? 0 : Number(value.toPrecision(10)))
      .replace(/(\.\d*?)0+$/, '$1')
      .replace(/\.$/, ''),
  );
}

// With as many decimals as the steps need, and the unit behind the last.
function timeLabels(u, splits, axis, space, step) {
  const decimals = Math.min(7, Math.max(0, -Math.floor(Math.log10(step) + 1e-9)));
  const labels = splits.map((t) => t.toFixed(decimals).replace('-', '\u2212'));
  return labels.map((label, i) => (i === labels.length - 1 ? `${label} s` : label));
}
