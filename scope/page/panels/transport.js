// The whole run in one bar, with the window that the panes show; drag or press to go there. For logs: play,
// step, speed.

import { choice, el, icon, setText } from '../dom.js';
import { colourOf, readColours } from '../plot/colours.js';
import { kSpeeds } from '../plot/player.js';
import { runTime } from '../settings/numbers.js';
import { WindowCache } from '../plot/window_cache.js';

const kRedraw_ms = 250;
const kIcons = {
  start: 'M2 3h2v10H2zM9 3v10L4 8zM15 3v10L10 8z',
  play: 'M4 2.5v11L14 8z',
  pause: 'M4 3h3v10H4zM9 3h3v10H9z',
  on: 'M4 3v10l6-5zM11 3h2v10h-2z',
  one_back: 'M12 3v10L6 8zM3 3h2v10H3z',
};

export class Transport {
  #drawn_ms = 0;
  #drag = null;
  #colours = null;

  constructor({ host, scope, display, player, signals }) {
    Object.assign(this, { scope, display, player });
    this.cache = new WindowCache(scope.link, () => this.#draw(true));
    this.canvas = el('canvas', {
      class: 'overview',
      role: 'slider',
      tabindex: '0',
      'aria-label': 'Window in the run',
      'aria-valuemin': '0',
    });
    const button = (sign, label, act) =>
      el('button', { type: 'button', 'aria-label': label, title: label, onclick: act }, icon(kIcons[sign]));
    this.play = button('play', 'Play or pause (Space)', () => player.toggle());
    this.speed = choice(
      kSpeeds.map((speed) => [String(speed), `${speed}×`]),
      '1',
      (speed) => player.setSpeed(Number(speed)),
      { 'aria-label': 'Speed' },
    );
    this.controls = el(
      'div',
      { class: 'row controls' },
      button('start', 'To the start (Home)', () => display.seek(display.first)),
      button('one_back', 'One sample back (,)', () => player.step(-1)),
      this.play,
      button('on', 'One sample on (.)', () => player.step(1)),
      this.speed,
    );
    this.ends = el('span', { class: 'ends' });
    host.append(this.controls, this.canvas, this.ends);
    this.#listen();
    for (const name of ['run', 'restart', 'layout', 'preferences'])
      signals.on(name, () => {
        this.#colours = null;
        this.#kind();
        this.#draw(true);
      });
    for (const name of ['drawn', 'playing']) signals.on(name, () => this.#draw());
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
      this.#colours = null;
      this.#draw(true);
    });
    new ResizeObserver(() => this.#draw(true)).observe(this.canvas);
    this.#kind();
  }

  #kind() {
    this.controls.hidden = this.scope.live || !this.scope.run;
  }

  #listen() {
    const { canvas } = this;
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.#drag = true;
      this.#go(event);
    });
    canvas.addEventListener('pointermove', (event) => {
      if (this.#drag) this.#go(event);
    });
    canvas.addEventListener('pointerup', () => {
      this.#drag = null;
    });
    canvas.addEventListener('pointercancel', () => {
      this.#drag = null;
    });
  }

  // The pressed moment comes to the middle; a log that was shown as a whole is shown in the time base from
  // now on.
  #go(event) {
    const box = this.canvas.getBoundingClientRect();
    const { first, last } = this.display;
    const t = first + Math.min(1, Math.max(0, (event.clientX - box.left) / box.width)) * (last - first);
    const { t0, t1 } = this.display.frame();
    const span = Math.min(t1 - t0, this.display.span);
    if (!this.scope.live && this.display.mode === 'follow') this.display.seek(t);
    else if (t1 - t0 > 0.9 * (last - first) && !this.scope.live) this.display.showWindow(t - span / 2, t + span / 2);
    else this.display.centre(t);
  }

  #draw(now = false) {
    const ms = performance.now();
    const { scope, display, canvas } = this;
    if (!scope.run || (!now && scope.live && ms - this.#drawn_ms < kRedraw_ms && display.mode === 'follow')) return;
    this.#drawn_ms = ms;
    this.play.querySelector('path').setAttribute('d', kIcons[this.player.playing ? 'pause' : 'play']);
    const { first, last } = display;
    const { t0, t1 } = display.window.t1 > display.window.t0 ? display.frame() : { t0: first, t1: last };
    setText(
      this.ends,
      `${runTime(Math.max(first, t0), 100)} – ${runTime(Math.min(last, t1), 100)} of ${runTime(last, 100)} s`,
    );
    canvas.setAttribute('aria-valuemax', last.toFixed(2));
    canvas.setAttribute('aria-valuenow', Math.min(last, t1).toFixed(2));
    canvas.setAttribute('aria-valuetext', this.ends.textContent);
    const width = Math.round(canvas.clientWidth * devicePixelRatio);
    const height = Math.round(canvas.clientHeight * devicePixelRatio);
    if (width === 0 || last <= first) return;
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    this.#colours ??= readColours();
    this.#paint(canvas.getContext('2d'), width, height, { first, last, t0, t1 });
  }

  #paint(ctx, width, height, { first, last, t0, t1 }) {
    const colours = this.#colours;
    const x = (t) => ((t - first) / (last - first)) * width;
    ctx.fillStyle = colours.panel;
    ctx.fillRect(0, 0, width, height);
    const channel = this.scope.layout.panes
      .find((pane) => pane.channels.some((id) => this.scope.known.includes(id)))
      ?.channels.find((id) => this.scope.known.includes(id));
    if (channel)
      this.#curve(ctx, this.cache.bins({ ...this.scope.run, last }, [channel], first, last, width), channel, x, height);
    for (const event of this.scope.eventsOf()) {
      if (event.kind === 'step') continue;
      ctx.fillStyle = colours[colourOf(event)];
      ctx.fillRect(x(event.t) - 0.5, 0, 1.5, height);
    }
    ctx.fillStyle = colours.accent;
    ctx.globalAlpha = 0.2;
    ctx.fillRect(x(t0), 0, Math.max(2, x(t1) - x(t0)), height);
    ctx.globalAlpha = 1;
    ctx.strokeStyle = colours.accent;
    ctx.strokeRect(x(t0) + 0.5, 0.5, Math.max(2, x(t1) - x(t0)) - 1, height - 1);
  }

  #curve(ctx, bins, id, x, height) {
    const min = bins.min[id];
    if (!min) return;
    let low = Infinity;
    let high = -Infinity;
    for (let i = 0; i < min.length; i += 1) {
      if (min[i] < low) low = min[i];
      if (bins.max[id][i] > high) high = bins.max[id][i];
    }
    const y = (value) => height - 3 - ((value - low) / Math.max(high - low, 1e-12)) * (height - 6);
    ctx.fillStyle = this.#colours.soft;
    for (let i = 0; i < min.length; i += 1) {
      if (!Number.isNaN(min[i]))
        ctx.fillRect(
          x(bins.t[i] - bins.width / 2),
          y(bins.max[id][i]),
          Math.max(1, x(bins.width) - x(0)),
          Math.max(1, y(min[i]) - y(bins.max[id][i])),
        );
    }
  }
}
