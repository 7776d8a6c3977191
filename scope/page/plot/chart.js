// One uPlot: axes, grid and curves of a pane. The curves' points do not go through uPlot's data: each trace
// brings its own bins (the run's, the ghost's, another run's), and a path of minima and maxima.

import uPlot from '../uplot/uPlot.esm.js';
import { factorOf } from '../settings/units.js';
import { chartAxes } from './axes.js';
import { between } from './colours.js';
import { bridge, trace } from './trace_path.js';
import { extent, StickyRange } from './value_range.js';

// One pixel exactly: drawn without a graphics processor, anything wider takes ten times as long (4 and 50 ms
// for six panes).
const kLine = 1;

export class Chart {
  #ranges = [new StickyRange(), new StickyRange()];
  #frame = { t0: 0, t1: 1, origin: 0 };
  #limits = [
    { low: -1, high: 1 },
    { low: -1, high: 1 },
  ];

  // options: {traces, units, si, colours, time_axis: show its labels, right: leave room for a second axis,
  // rate_hz, limits, below(u, chart), above(u, chart): draw under and over the curves}
  constructor(host, options) {
    this.options = options;
    this.host = host;
    this.plot = new uPlot(this.#uplotOptions(), this.#data(), host);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (width > 0 && height > 0 && (width !== this.plot.width || height !== this.plot.height))
      this.plot.setSize({ width, height });
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

  get frame() {
    return this.#frame;
  }

  // Pixels of the canvas from run time and from values in the stack's units.
  x(t) {
    const { left, width } = this.plot.bbox;
    return left + ((t - this.#frame.t0) / (this.#frame.t1 - this.#frame.t0)) * width;
  }

  y(value, axis = 0) {
    const { top, height } = this.plot.bbox;
    const { low, high } = this.#limits[axis];
    return top + height - ((value - low) / (high - low)) * height;
  }

  valueAt(y_css, axis = 0) {
    const { low, high } = this.#limits[axis];
    const height = this.plot.bbox.height / uPlot.pxRatio;
    return low + ((height - y_css) / height) * (high - low);
  }

  #binsOf(one) {
    return one.kind === 'overlay' ? this.other?.bins : this.#frame.bins;
  }
  #shiftOf(one) {
    return one.kind === 'overlay' ? (this.other?.shift ?? 0) : 0;
  }

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
      all = {
        low: Math.min(all?.low ?? Infinity, found.low * factor),
        high: Math.max(all?.high ?? -Infinity, found.high * factor),
      };
    }
    return all;
  }

  // The motor's limits come into view when the voltage comes near them, and not before: a small voltage stays
  // legible.
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
      x: (t) => this.x(t + shift),
      y: (value) => this.y(value * factor, one.axis),
      held: one.channel.step === true,
      bridge_s: bridge(one.channel, this.options.rate_hz, bins.width),
    });
    return { stroke: path, fill: null, clip: null, band: null, gaps: null, flags: 0 };
  }

  #series(one) {
    const { colours } = this.options;
    const look = { measured: {}, ghost: { dash: [5, 4] }, overlay: { dash: [2, 2], alpha: 0.8 } }[one.kind];
    return {
      scale: `y${one.axis}`,
      stroke: strokeOf(one, colours),
      ...look,
      width: kLine,
      points: { show: false },
      paths: (u, index) => this.#path(index),
    };
  }

  #uplotOptions() {
    const { clientWidth: width, clientHeight: height } = this.host;
    const scale = (axis) => ({ auto: true, range: () => [this.#limits[axis].low, this.#limits[axis].high] });
    return {
      ...chartAxes(this.options, width),
      width: Math.max(100, width),
      height: Math.max(60, height),
      pxAlign: 0,
      cursor: { show: false },
      legend: { show: false },
      select: { show: false },
      scales: { x: { time: false, range: (u, low, high) => [low, high] }, y0: scale(0), y1: scale(1) },
      series: [{}, ...this.options.traces.map((one) => this.#series(one)), { scale: 'y1', show: false }],
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
