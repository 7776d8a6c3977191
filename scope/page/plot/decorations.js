// What is drawn under and over the curves: gaps in the run, the motor's voltage limits, marks of events,
// cursors, the trigger's level.

import uPlot from '../uplot/uPlot.esm.js';
import { runTime } from '../settings/numbers.js';
import { factorOf } from '../settings/units.js';
import { colourOf } from './colours.js';
import { gapsShown } from './trace_path.js';

// How strong the shade of a gap is, here and in a picture that is saved.
export const kGapAlpha = 0.14;

// state: {colours, traces, si, limits, events, cursors, trigger: {t, channel, level} or null,
// head: of the playback or null, rate_hz, first, last, top: is the first pane}
export function drawBelow(ctx, chart, state) {
  clipped(ctx, chart, () => {
    drawBeyondRun(ctx, chart, state);
    drawGaps(ctx, chart, state);
    if (state.traces.some((one) => one.id === 'voltage') && state.limits?.voltage_V) drawVoltageBand(ctx, chart, state);
  });
}

export function drawAbove(ctx, chart, state) {
  clipped(ctx, chart, () => {
    drawEvents(ctx, chart, state);
    if (state.head !== null) drawHead(ctx, chart, state);
    if (state.trigger) drawTrigger(ctx, chart, state);
    drawCursors(ctx, chart, state);
  });
}

function clipped(ctx, { plot: { bbox } }, draw) {
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  draw();
  ctx.restore();
}

function shade(ctx, chart, from, to, colour, alpha) {
  const { top, height, left, width } = chart.plot.bbox;
  const x0 = Math.max(left, chart.x(from));
  const x1 = Math.min(left + width, chart.x(to));
  if (x1 <= x0) return;
  ctx.globalAlpha = alpha;
  ctx.fillStyle = colour;
  ctx.fillRect(x0, top, x1 - x0, height);
  ctx.globalAlpha = 1;
}

// Before the run's first sample there is nothing to see, and that is not a line at zero.
function drawBeyondRun(ctx, chart, { colours, first }) {
  if (Number.isFinite(first)) shade(ctx, chart, chart.frame.t0, first, colours.panel, 1);
}

// The head of a playback; what comes after it is pale.
function drawHead(ctx, chart, { colours, head }) {
  const { top, height } = chart.plot.bbox;
  shade(ctx, chart, head, chart.frame.t1, colours.paper, 0.72);
  rule(ctx, chart.x(head), top, chart.x(head), top + height, colours.accent, [], 1.2);
}

function drawGaps(ctx, chart, state) {
  for (const [from, to] of gapsShown(chart.frame, state)) shade(ctx, chart, from, to, state.colours.warn, kGapAlpha);
}

// The voltages that the motor never sees: what lies beyond its limits is shaded.
function drawVoltageBand(ctx, chart, { colours, traces, si, limits }) {
  const one = traces.find((candidate) => candidate.id === 'voltage');
  const factor = factorOf(one.channel, si);
  const { left, width, top, height } = chart.plot.bbox;
  const upper = Math.max(top, Math.min(top + height, chart.y(limits.voltage_V * factor, one.axis)));
  const lower = Math.max(top, Math.min(top + height, chart.y(-limits.voltage_V * factor, one.axis)));
  ctx.fillStyle = colours.bad;
  ctx.globalAlpha = 0.1;
  ctx.fillRect(left, top, width, upper - top);
  ctx.fillRect(left, lower, width, top + height - lower);
  ctx.globalAlpha = 0.7;
  rule(ctx, left, upper, left + width, upper, colours.bad, [3, 3]);
  rule(ctx, left, lower, left + width, lower, colours.bad, [3, 3]);
  ctx.globalAlpha = 1;
}

function rule(ctx, x0, y0, x1, y1, colour, dash = [], width = 1) {
  ctx.strokeStyle = colour;
  ctx.lineWidth = width * uPlot.pxRatio;
  ctx.setLineDash(dash.map((length) => length * uPlot.pxRatio));
  ctx.beginPath();
  ctx.moveTo(x0, y0);
  ctx.lineTo(x1, y1);
  ctx.stroke();
  ctx.setLineDash([]);
}

function drawEvents(ctx, chart, { colours, events, top: labels }) {
  const { top, height, left, width } = chart.plot.bbox;
  const { t0, t1 } = chart.frame;
  let free = left;
  for (const event of events) {
    if (event.t < t0 || event.t > t1) continue;
    const x = chart.x(event.t);
    const colour = colours[colourOf(event)];
    ctx.globalAlpha = event.kind === 'step' ? 0.35 : 0.8;
    rule(ctx, x, top, x, top + height, colour, event.kind === 'fault' ? [] : [2, 3]);
    ctx.globalAlpha = 1;
    if (labels && event.kind !== 'step' && x >= free)
      free = label(ctx, x, top, labelOf(event), colour, colours, { left: free, right: left + width });
  }
}

// A tuning says what was set; its number and tick are in the list.
function labelOf({ kind, code, text }) {
  if (kind === 'tuning' && code === 'refused') return 'set refused';
  if (kind === 'tuning') return text.replace(/^version [^:]*: /, '') || code;
  return code || text || kind;
}

// Text at the top of a mark, right of it, or left of it where that is cut off and `room` {left, right} has place for it;
// returns where the next one has room.
function label(ctx, mark, top, text, colour, colours, room = null) {
  const ratio = uPlot.pxRatio;
  ctx.font = `${10.5 * ratio}px Helvetica, Arial, "Liberation Sans", sans-serif`;
  ctx.textBaseline = 'top';
  ctx.textAlign = 'left';
  const shown = text.length > 32 ? `${text.slice(0, 31)}…` : text;
  const width = ctx.measureText(shown).width;
  const over = room !== null && mark + width + 8 * ratio > room.right && mark - width - 8 * ratio >= room.left;
  const x = over ? mark - width - 8 * ratio : mark;
  ctx.globalAlpha = 0.85;
  ctx.fillStyle = colours.paper;
  ctx.fillRect(x + 2 * ratio, top + ratio, width + 4 * ratio, 13 * ratio);
  ctx.globalAlpha = 1;
  ctx.fillStyle = colour;
  ctx.fillText(shown, x + 4 * ratio, top + 2 * ratio);
  return x + width + 12 * ratio;
}

function drawTrigger(ctx, chart, { colours, trigger, traces, si, top: labels }) {
  const { top, height, left, width } = chart.plot.bbox;
  if (trigger.t !== null) {
    rule(ctx, chart.x(trigger.t), top, chart.x(trigger.t), top + height, colours.trigger, [6, 3]);
    if (labels) label(ctx, chart.x(trigger.t), top, `trigger at ${runTime(trigger.t)} s`, colours.trigger, colours);
  }
  const one = traces.find((candidate) => candidate.kind === 'measured' && candidate.id === trigger.channel);
  if (!one || trigger.level === null) return;
  const y = chart.y(trigger.level * factorOf(one.channel, si), one.axis);
  rule(ctx, left, y, left + width, y, colours.trigger, [6, 3]);
  const size = 5 * uPlot.pxRatio;
  ctx.fillStyle = colours.trigger;
  ctx.beginPath();
  ctx.moveTo(left, y - size);
  ctx.lineTo(left + 1.6 * size, y);
  ctx.lineTo(left, y + size);
  ctx.fill();
}

function drawCursors(ctx, chart, { colours, cursors, top: labels }) {
  const { top, height } = chart.plot.bbox;
  for (const name of ['a', 'b']) {
    if (cursors[name] === null) continue;
    const x = chart.x(cursors[name]);
    rule(ctx, x, top, x, top + height, colours.cursor, name === 'a' ? [] : [7, 3], cursors.active === name ? 1.6 : 1);
    if (labels) label(ctx, x, top, name.toUpperCase(), colours.cursor, colours);
  }
}
