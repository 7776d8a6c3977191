// The panes as a file: PNG as they are on the screen, SVG drawn anew from the same bins.

import { el } from '../dom.js';
import { factorOf, unitOf } from '../settings/units.js';
import { runTime } from '../settings/numbers.js';
import { strokeOf } from './chart.js';
import { colourOf } from './colours.js';
import { kGapAlpha } from './decorations.js';
import { bridge, gapsShown, trace } from './trace_path.js';

const kTitle_px = 18;

// A Blob of image/png.
export function pngOf(panes, colours) {
  const charts = panes.map((pane) => ({ title: titleOf(pane), canvas: pane.host.querySelector('canvas') }));
  const ratio = devicePixelRatio;
  const width = Math.max(...charts.map(({ canvas }) => canvas.width));
  const height = charts.reduce((sum, { canvas }) => sum + canvas.height + kTitle_px * ratio, 0);
  const sheet = el('canvas', { width, height });
  const ctx = sheet.getContext('2d');
  ctx.fillStyle = colours.paper;
  ctx.fillRect(0, 0, width, height);
  ctx.font = `${11 * ratio}px Helvetica, Arial, "Liberation Sans", sans-serif`;
  let top = 0;
  for (const { title, canvas } of charts) {
    let left = 62 * ratio;
    for (const { text, colour } of title) {
      ctx.fillStyle = colours[colour] ?? colours.ink;
      ctx.fillText(text, left, top + 13 * ratio);
      left += ctx.measureText(text).width + 14 * ratio;
    }
    ctx.drawImage(canvas, 0, top + kTitle_px * ratio);
    top += canvas.height + kTitle_px * ratio;
  }
  return new Promise((done) => sheet.toBlob(done, 'image/png'));
}

// A Blob of image/svg+xml: paths, axes with numbers, names, gaps shaded, marks of the events (whose words appear on
// pointing). run: {name, first, last: s, events}.
export function svgOf(panes, colours, run) {
  const width = panes[0].host.clientWidth;
  const parts = [];
  let top = 0;
  for (const pane of panes) {
    parts.push(...paneSvg(pane, colours, top, run));
    top += pane.host.clientHeight + kTitle_px;
  }
  const { t0, t1 } = panes[0].chart.frame;
  const title = `${run.name}, ${runTime(t0)} to ${runTime(t1)} s`;
  const svg = `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${top + 8}" width="${width}" height="${top + 8}" font-family="Helvetica, Arial, sans-serif" font-size="11"><title>${escaped(title)}</title><rect width="100%" height="100%" fill="${colours.paper}"/>${parts.join('\n')}</svg>\n`;
  return new Blob([svg], { type: 'image/svg+xml' });
}

// Text in markup: names of logs and channels may hold anything.
export function escaped(text) {
  return String(text).replace(/[&<>"']/g, (one) => `&#${one.charCodeAt(0)};`);
}

function titleOf(pane) {
  return [
    { text: pane.layout.title, colour: 'ink' },
    ...pane.parts.traces
      .filter((one) => one.kind === 'measured' && !one.hidden)
      .map((one) => ({ text: `${one.id} [${unitOf(one.channel, pane.chart.options.si)}]`, colour: one.colour })),
  ];
}

function paneSvg(pane, colours, offset, run) {
  const { chart } = pane;
  const ratio = devicePixelRatio;
  const { left, top, width, height } = chart.plot.bbox;
  const box = { x: left / ratio, y: offset + kTitle_px + top / ratio, w: width / ratio, h: height / ratio };
  const id = `clip${pane.index}`;
  const names = titleOf(pane)
    .map(({ text, colour }) => `<tspan fill="${colours[colour] ?? colours.ink}">${escaped(text)}  </tspan>`)
    .join('');
  const out = [
    `<text x="${box.x}" y="${offset + 13}" xml:space="preserve">${names}</text>`,
    `<clipPath id="${id}"><rect x="${box.x}" y="${box.y}" width="${box.w}" height="${box.h}"/></clipPath>`,
    `<rect x="${box.x}" y="${box.y}" width="${box.w}" height="${box.h}" fill="none" stroke="${colours.line}"/>`,
    ...axesSvg(chart, box, colours),
    ...gapsSvg(chart, box, colours, run),
    ...eventsSvg(chart, box, colours, run.events),
  ];
  for (const one of chart.options.traces.filter((candidate) => !candidate.hidden)) {
    const bins = one.kind === 'overlay' ? chart.other?.bins : chart.frame.bins;
    const shift = one.kind === 'overlay' ? (chart.other?.shift ?? 0) : 0;
    if (!bins?.min[one.id]) continue;
    const factor = factorOf(one.channel, chart.options.si);
    const steps = [];
    const point = (x, y) => `${(x / ratio).toFixed(2)} ${(offset + kTitle_px + y / ratio).toFixed(2)}`;
    const pen = { moveTo: (x, y) => steps.push(`M${point(x, y)}`), lineTo: (x, y) => steps.push(`L${point(x, y)}`) };
    trace(pen, bins, bins.min[one.id], bins.max[one.id], {
      x: (t) => chart.x(t + shift),
      y: (v) => chart.y(v * factor, one.axis),
      held: one.channel.step === true,
      bridge_s: bridge(one.channel, chart.options.rate_hz, bins.width),
    });
    const dash = { ghost: ' stroke-dasharray="5 4"', overlay: ' stroke-dasharray="2 2"' }[one.kind] ?? '';
    out.push(
      `<path clip-path="url(#${id})" d="${steps.join('')}" fill="none" stroke="${strokeOf(one, colours)}" stroke-width="1.2" stroke-linejoin="round"${dash}/>`,
    );
  }
  return out;
}

function gapsSvg(chart, box, colours, { first, last }) {
  const { t0, t1 } = chart.frame;
  const x = (t) => Math.min(box.w, Math.max(0, ((t - t0) / (t1 - t0)) * box.w));
  return gapsShown(chart.frame, { ...chart.options, first, last })
    .filter(([from, to]) => to > t0 && from < t1)
    .map(
      ([from, to]) =>
        `<rect class="gap" x="${(box.x + x(from)).toFixed(2)}" y="${box.y}" width="${(x(to) - x(from)).toFixed(2)}" height="${box.h}" fill="${colours.warn}" fill-opacity="${kGapAlpha}"><title>no samples from ${runTime(from)} to ${runTime(to)} s</title></rect>`,
    );
}

function eventsSvg(chart, box, colours, events) {
  const { t0, t1 } = chart.frame;
  return events
    .filter(({ t }) => t >= t0 && t <= t1)
    .map((event) => {
      const x = (box.x + ((event.t - t0) / (t1 - t0)) * box.w).toFixed(2);
      const words = [runTime(event.t), 's', event.kind, event.source, event.code, event.text].filter(Boolean).join(' ');
      return `<path d="M${x} ${box.y}v${box.h}" stroke="${colours[colourOf(event)]}" stroke-dasharray="2 3" stroke-opacity="${event.kind === 'step' ? 0.4 : 0.8}"><title>${escaped(words)}</title></path>`;
    });
}

// The numbers that uPlot put on its axes, at the same places.
function axesSvg(chart, box, colours) {
  const out = [];
  const [time, ...values] = chart.plot.axes;
  const text = (x, y, words, anchor) =>
    `<text x="${x.toFixed(1)}" y="${y.toFixed(1)}" fill="${colours.soft}" text-anchor="${anchor}">${escaped(words)}</text>`;
  (time._splits ?? []).forEach((t, i) => {
    const x = box.x + chart.plot.valToPos(t, 'x');
    out.push(`<path d="M${x.toFixed(2)} ${box.y}v${box.h}" stroke="${colours.fine}"/>`);
    if (time._values?.[i]) out.push(text(x, box.y + box.h + 14, time._values[i], 'middle'));
  });
  values.forEach((axis, i) => {
    if (!axis.show) return;
    (axis._splits ?? []).forEach((value, k) => {
      if (!axis._values?.[k]) return;
      const y = box.y + chart.plot.valToPos(value, `y${i}`);
      out.push(
        i === 0
          ? text(box.x - 6, y + 4, axis._values[k], 'end')
          : text(box.x + box.w + 6, y + 4, axis._values[k], 'start'),
      );
    });
  });
  return out;
}
