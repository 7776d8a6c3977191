// A pane: the chips of its channels with their values, its menu, and its chart.

import { el, setText } from '../dom.js';
import { paneMenu } from '../panels/pane_menu.js';
import * as layouts from '../settings/layout.js';
import { short } from '../settings/numbers.js';
import { factorOf, unitOf } from '../settings/units.js';
import { Chart } from './chart.js';
import { drawAbove, drawBelow } from './decorations.js';
import { tracesOf } from './traces.js';

const kDragged = 'application/x-hydro-channel';

export class Pane {
  // context: {scope, overlay: OverlayRun, colours, state(): what decorations draw}
  constructor(context, index, { is_last, right, room }) {
    const { scope } = context;
    this.scope = scope;
    this.index = index;
    this.layout = scope.layout.panes[index];
    this.parts = tracesOf(this.layout, {
      channel: (id) => scope.channel(id),
      ghost: scope.ghost,
      overlay: context.overlay.channelOf(),
      si: scope.preferences.si,
    });
    this.values = new Map();
    this.host = el('div', { class: 'chart', role: 'img', 'aria-label': this.#summary() });
    this.element = el(
      'section',
      { class: 'pane', 'aria-label': this.#name(), 'data-pane': index, 'data-last': is_last },
      el(
        'header',
        {},
        el('h2', { text: this.layout.title }),
        el('div', { class: 'chips' }, ...this.#chips()),
        paneMenu(scope, index),
      ),
      this.host,
    );
    this.#acceptChannels();
    const state = () => ({ ...context.state(), traces: this.parts.traces, top: index === 0 });
    this.chartOptions = {
      ...this.parts,
      si: scope.preferences.si,
      colours: context.colours,
      time_axis: is_last,
      right,
      room,
      rate_hz: scope.run.rate_hz,
      limits: scope.run.limits,
      below: (ctx, chart) => drawBelow(ctx, chart, state()),
      above: (ctx, chart) => drawAbove(ctx, chart, state()),
    };
  }

  // The chart measures its place, so the element must be in the page by now.
  start() {
    this.chart = new Chart(this.host, this.chartOptions);
    this.observer = new ResizeObserver(() => this.chart.resize());
    this.observer.observe(this.host);
  }

  stop() {
    this.observer?.disconnect();
    this.chart?.destroy();
  }

  draw(frame, other, now_ms) {
    this.chart.draw(frame, other, now_ms);
  }

  // The values beside the names: at time t, from the bins shown.
  showValues(bins, t) {
    for (const [id, output] of this.values) {
      const channel = this.scope.channel(id);
      setText(output, short(valueAt(bins, id, t) * factorOf(channel, this.scope.preferences.si)));
    }
  }

  // The same in words.
  said(bins, t) {
    return [...this.values.keys()]
      .filter((id) => !this.layout.hidden.includes(id))
      .map((id) => {
        const channel = this.scope.channel(id);
        const { si } = this.scope.preferences;
        return `${channel.label} ${short(valueAt(bins, id, t) * factorOf(channel, si))} ${unitOf(channel, si)}`;
      });
  }

  #name() {
    return `Pane ${this.index + 1}${this.layout.title ? `: ${this.layout.title}` : ''}`;
  }

  #summary() {
    const names = this.parts.traces.map(({ kind, channel }) =>
      kind === 'overlay' ? `${channel.label} of the other run` : channel.label,
    );
    return names.length > 0 ? `Curves over time of ${names.join(', ')}` : 'Empty pane: add a channel with its menu';
  }

  #chips() {
    return this.layout.channels.map((id, i) => {
      const channel = this.scope.channel(id);
      if (!channel) return el('span', { class: 'chip absent', title: 'This run does not have this channel', text: id });
      const hidden = this.layout.hidden.includes(id);
      const value = el('span', { class: 'value' });
      this.values.set(id, value);
      return el(
        'button',
        {
          class: 'chip',
          type: 'button',
          draggable: 'true',
          'aria-pressed': String(!hidden),
          'data-channel': id,
          title: `${channel.label}. Press to ${hidden ? 'show' : 'hide'}; drag it to another pane.`,
          onclick: () => this.scope.setLayout(layouts.withHidden(this.scope.layout, this.index, id, !hidden)),
          ondragstart: (event) => event.dataTransfer.setData(kDragged, JSON.stringify({ from: this.index, id })),
        },
        el('span', { class: `swatch c${i % 8}` }),
        el('span', { class: 'id', text: id }),
        value,
        el('span', { class: 'unit', text: unitOf(channel, this.scope.preferences.si) }),
      );
    });
  }

  #acceptChannels() {
    this.element.addEventListener('dragover', (event) => {
      if (event.dataTransfer.types.includes(kDragged)) event.preventDefault();
    });
    this.element.addEventListener('drop', (event) => {
      const text = event.dataTransfer.getData(kDragged);
      if (!text) return;
      event.preventDefault();
      const { from, id } = JSON.parse(text);
      this.scope.setLayout(layouts.withChannelMoved(this.scope.layout, from, this.index, id));
    });
  }
}

// The value of the newest bin with a sample at or before t: its middle, which for a single sample is the
// sample.
export function valueAt(bins, id, t) {
  const min = bins.min[id];
  if (!min) return NaN;
  let low = 0;
  let high = bins.t.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (bins.t[middle] - bins.width / 2 <= t) low = middle + 1;
    else high = middle;
  }
  for (let i = low - 1; i >= Math.max(0, low - 40); i -= 1) {
    if (!Number.isNaN(min[i])) return (min[i] + bins.max[id][i]) / 2;
  }
  return NaN;
}
