// One uPlot: axes, grid and curves of a pane. The curves' points do not go through uPlot's data: each trace brings its
// own bins (the run's, the ghost's, another run's), and a path of minima and maxima.

import uPlot from '../uplot/uPlot.esm.js';
import { between } from './colours.js';
import { factorOf } from '../settings/units.js';
import { short } from '../settings/numbers.js';
import { bridge, trace } from './trace_path.js';
import { extent, StickyRange } from './value_range.js';

const kFont = '11px Helvetica, Arial, "Liberation Sans", sans-serif';
const kLeft = 62;
const kLeftNarrow = 46;               // on a phone every pixel counts
const kNarrow_px = 520;
const kRight = 14;
const kTimeAxis = 24;
const kLabel_px = 12;                 // between numbers of a value axis at least: a low pane still has two
// One pixel exactly: drawn without a graphics processor, anything wider takes ten times as long (4 and 50 ms for six panes).
const kLine = 1;

const kSteps = [];
for (let power = -7; power <= 8; power += 1) kSteps.push(Number(`1e${power}`), Number(`2e${power}`), Number(`5e${power}`));

export class Chart {
  #ranges = [new StickyRange(), new StickyRange()];
  #frame = { t0: 0, t1: 1, origin: 0 };
  #limits = [{ low: -1, high: 1 }, { low: -1, high: 1 }];

  // options: {traces, units, si, colours, time_axis: show its labels, right: leave room for a second axis, rate_hz, limits,
  // below(u, chart), above(u, chart): draw under and over the curves}
  constructor(host, options) {
    this.options = options;
    this.host = host;
    this.plot = new uPlot(this.#uplotOptions(), this.#data(), host);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (width > 0 && height > 0 && (width !== this.plot.width || height !== this.plot.height)) this.plot.setSize({ width, height });
  }

  // frame: {t0, t1, origin, bins}; other: {bins, shift} of the run laid over, or null.
  draw(frame, other, now_ms) {
    this.#frame = frame;
    this.other = other;
    this.#limits = this.#ranges.map((range, axis) => range.update(this.#extent(axis), now_ms));
    this.plot.setData(this.#data());
  }

  refit() {
    this.#ranges.forEach((range) => range.reset());
  }

  destroy() {
    this.plot.destroy();
  }

  get frame() { return this.#frame; }

  // Pixels of the canvas from run time and from values in the stack's units.
  x(t) {
    const { left, width } = this.plot.bbox;
    return left + (t - this.#frame.t0) / (this.#frame.t1 - this.#frame.t0) * width;
  }

  y(value, axis = 0) {
    const { top, height } = this.plot.bbox;
    const { low, high } = this.#limits[axis];
    return top + height - (value - low) / (high - low) * height;
  }

  valueAt(y_css, axis = 0) {
    const { low, high } = this.#limits[axis];
    const height = this.plot.bbox.height / uPlot.pxRatio;
    return low + (height - y_css) / height * (high - low);
  }

  #binsOf(one) { return one.kind === 'overlay' ? this.other?.bins : this.#frame.bins; }
  #shiftOf(one) { return one.kind === 'overlay' ? this.other?.shift ?? 0 : 0; }

  // In units shown: the factor is applied here and nowhere else in the drawing.
  #extent(axis) {
    let all = null;
    for (const one of this.options.traces) {
      const bins = this.#binsOf(one);
      if (one.axis !== axis || one.hidden || !bins) continue;
      const shift = this.#shiftOf(one);
      const seen = extent(bins, [one.id], this.#frame.t0 - shift, this.#frame.t1 - shift);
      if (!seen) continue;
      const found = this.#withLimits(seen, one);
      const factor = factorOf(one.channel, this.options.si);
      all = { low: Math.min(all?.low ?? Infinity, found.low * factor), high: Math.max(all?.high ?? -Infinity, found.high * factor) };
    }
    return all;
  }

  // The motor's limits come into view when the voltage comes near them, and not before: a small voltage stays legible.
  #withLimits(found, one) {
    const limit = one.id === 'voltage' ? this.options.limits?.voltage_V : undefined;
    if (!limit || Math.max(-found.low, found.high) < 0.5 * limit) return found;
    return { low: Math.min(found.low, -limit), high: Math.max(found.high, limit) };
  }

  #data() {
    const { t0, t1, origin } = this.#frame;
    return [[t0 - origin, t1 - origin], ...this.options.traces.map(() => [0, 0])];
  }

  #path(index) {
    const one = this.options.traces[index - 1];
    const path = new Path2D();
    const bins = this.#binsOf(one);
    const min = bins?.min[one.id];
    if (!min || one.hidden) return { stroke: path, fill: null, clip: null, band: null, gaps: null, flags: 0 };
    const factor = factorOf(one.channel, this.options.si);
    const shift = this.#shiftOf(one);
    trace(path, bins, min, bins.max[one.id], {
      x: (t) => this.x(t + shift), y: (value) => this.y(value * factor, one.axis), held: one.channel.step === true,
      bridge_s: bridge(one.channel, this.options.rate_hz, bins.width),
    });
    return { stroke: path, fill: null, clip: null, band: null, gaps: null, flags: 0 };
  }

  #series(one) {
    const { colours } = this.options;
    const look = { measured: {}, ghost: { dash: [5, 4] }, overlay: { dash: [2, 2], alpha: 0.8 } }[one.kind];
    return {
      scale: `y${one.axis}`, stroke: strokeOf(one, colours), ...look, width: kLine,
      points: { show: false }, paths: (u, index) => this.#path(index),
    };
  }

  #uplotOptions() {
    const { traces, units, colours, time_axis, right } = this.options;
    const common = { font: kFont, stroke: () => colours.soft, ticks: { stroke: () => colours.line, width: 1, size: 4 } };
    const left = this.host.clientWidth < kNarrow_px ? kLeftNarrow : kLeft;
    const scale = (axis) => ({ auto: true, range: () => [this.#limits[axis].low, this.#limits[axis].high] });
    const values = (u, splits) => splits.map((value) => short(Math.abs(value) < 1e-12 ? 0 : Number(value.toPrecision(10))).replace(/(\.\d*?)0+$/, '$1').replace(/\.$/, ''));
    return {
      width: Math.max(100, this.host.clientWidth), height: Math.max(60, this.host.clientHeight), pxAlign: 0,
      padding: [6, right ? 0 : kRight, time_axis ? 0 : 6, 0],
      cursor: { show: false }, legend: { show: false }, select: { show: false },
      scales: { x: { time: false, range: (u, low, high) => [low, high] }, y0: scale(0), y1: scale(1) },
      axes: [
        { ...common, scale: 'x', size: time_axis ? kTimeAxis : 0, gap: 3, incrs: kSteps, space: 90, grid: { stroke: () => colours.fine, width: 1 },
          values: time_axis ? (u, splits, i, space, step) => splits.map((t, k) => (k === splits.length - 1 ? `${timeLabel(t, step)} s` : timeLabel(t, step))) : () => [], ticks: { ...common.ticks, show: time_axis } },
        { ...common, scale: 'y0', size: left, gap: 4, incrs: kSteps, space: (u, axis, low, high, pixels) => Math.max(kLabel_px, Math.min(2 * kLabel_px, pixels / 5)), grid: { stroke: () => colours.fine, width: 1 }, values },
        { ...common, scale: 'y1', side: 1, show: right, size: left, gap: 4, incrs: kSteps, space: (u, axis, low, high, pixels) => Math.max(kLabel_px, Math.min(2 * kLabel_px, pixels / 5)), grid: { show: false }, values: units.length > 1 ? values : () => [], ticks: { ...common.ticks, show: units.length > 1 } },
      ],
      series: [{}, ...traces.map((one) => this.#series(one)), { scale: 'y1', show: false }],
      hooks: {
        drawAxes: [(u) => this.options.below(u.ctx, this)],
        draw: [(u) => this.options.above(u.ctx, this)],
      },
    };
  }
}

// Of a trace, as the pictures of a window use it too.
export function strokeOf(one, colours) {
  return one.kind === 'ghost' ? between(colours[one.colour], colours.ink) : colours[one.colour];
}

function timeLabel(t, step) {
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  return t.toFixed(Math.min(7, decimals)).replace('-', '\u2212');
}
