// All panes, one above the other over the same time, drawn together at most once a frame of the screen.

import { el } from '../dom.js';
import { unitOf } from '../settings/units.js';
import { runTime } from '../settings/numbers.js';
import { readColours } from './colours.js';
import { Pane } from './pane.js';

const kCalm_ms = 250; // between frames for those who asked for less motion
const kMostPixels = 4000;
const kSettle_ms = 1700;
const kValues_ms = 120; // how often the values beside the names change: digits faster than that are not read

export class Panes {
  panes = [];
  hover = null; // run time under the pointer
  frames = 0; // drawn so far

  // parts: {scope, display, overlay, cursors: CursorTool, trigger: Trigger, signals, host}
  constructor(parts) {
    Object.assign(this, parts);
    this.colours = readColours();
    this.calm = matchMedia('(prefers-reduced-motion: reduce)');
    this.asked = false;
    this.values_ms = 0;
    for (const name of ['layout', 'run', 'overlay', 'rebuild']) this.signals.on(name, () => this.rebuild());
    this.signals.on('preferences', (changes) => {
      if ('theme' in changes || 'si' in changes) this.rebuild();
    });
    this.signals.on('draw', () => this.#ask());
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.rebuild());
    new ResizeObserver(() => this.#measure()).observe(this.host);
  }

  rebuild() {
    this.panes.forEach((pane) => pane.stop());
    this.panes = [];
    this.colours = readColours();
    const { scope } = this;
    if (!scope.run) {
      this.host.replaceChildren();
      return;
    }
    const count = scope.layout.panes.length;
    const right = scope.layout.panes.some(
      (pane) =>
        new Set(
          pane.channels
            .map((id) => scope.channel(id))
            .filter(Boolean)
            .map((one) => unitOf(one, scope.preferences.si)),
        ).size > 1,
    );
    const room = { px: 0, grown: () => this.#alignAxes() };
    const open = this.#openMenu();
    const focused = document.activeElement?.dataset?.channel;
    this.panes = scope.layout.panes.map(
      (_, i) =>
        new Pane({ scope, overlay: this.overlay, colours: this.colours, state: () => this.#state() }, i, {
          is_last: i === count - 1,
          right,
          room,
        }),
    );
    this.host.replaceChildren(...this.panes.map((pane) => pane.element), ...(count === 0 ? [this.#nothing()] : []));
    this.panes.forEach((pane) => pane.start());
    if (open !== null) this.#openAgain(open);
    else if (focused) this.host.querySelector(`.chip[data-channel="${CSS.escape(focused)}"]`)?.focus();
    this.#measure();
    this.#ask();
  }

  // When the numbers of one chart need more room, all make it.
  #alignAxes() {
    queueMicrotask(() => this.panes.forEach((pane) => pane.chart?.plot?.redraw(false, true)));
  }

  refit() {
    this.panes.forEach((pane) => pane.chart.refit());
    this.#ask();
  }

  // The values beside the names in words, and the time that they are of.
  said() {
    if (!this.scope.run) return 'no run';
    const frame = this.display.frame();
    const at = this.#valuesAt(frame);
    return `At ${runTime(at)} s: ${this.panes.flatMap((pane) => pane.said(frame.bins, at)).join(', ')}`;
  }

  // Under the pointer, else the newest shown.
  #valuesAt({ t1 }) {
    if (this.hover !== null) return this.hover;
    const { mode, last, head } = this.display;
    if (mode !== 'follow') return Math.min(t1, last);
    return this.scope.live ? last : (head ?? Math.min(t1, last));
  }

  #state() {
    const { scope, display } = this;
    return {
      colours: this.colours,
      si: scope.preferences.si,
      limits: scope.run.limits,
      events: scope.eventsOf(),
      cursors: this.cursors.at,
      trigger: this.trigger.drawn(),
      rate_hz: scope.run.rate_hz,
      first: display.first,
      last: display.last,
      head: display.mode === 'follow' && !scope.live ? display.head : null,
    };
  }

  #ask() {
    if (this.asked) return;
    this.asked = true;
    const draw = () =>
      requestAnimationFrame((now) => {
        this.asked = false;
        this.#draw(now);
      });
    if (this.calm.matches && this.display.mode === 'follow') setTimeout(draw, kCalm_ms);
    else draw();
  }

  #draw(now_ms) {
    if (!this.scope.run) return;
    const frame = this.display.frame();
    const other = this.overlay.binsFor(frame, this.display.pixels);
    for (const pane of this.panes) pane.draw(frame, other, now_ms);
    this.frames += 1;
    if (now_ms - this.values_ms > kValues_ms || this.hover !== null) {
      this.values_ms = now_ms;
      const at = this.#valuesAt(frame);
      for (const pane of this.panes) pane.showValues(frame.bins, at);
    }
    this.#settle();
    this.signals.emit('drawn', frame);
  }

  // Where nothing streams, the picture is drawn once more after a while, so that value axes that were wide
  // can shrink.
  #settle() {
    clearTimeout(this.settling);
    if (!this.scope.live && !this.settled)
      this.settling = setTimeout(() => {
        this.settled = true;
        this.#ask();
      }, kSettle_ms);
    else this.settled = false;
  }

  #measure() {
    const chart = this.panes[0]?.chart;
    if (!chart) return;
    this.panes.forEach((pane) => pane.chart.resize());
    const width = Math.min(kMostPixels, this.panes[0].chart.plot.over.clientWidth * devicePixelRatio);
    if (width > 0 && Math.abs(width - this.display.pixels) > 1) {
      this.display.pixels = width;
      this.display.subscribe();
    }
    this.#ask();
  }

  #openMenu() {
    const index = [...this.host.querySelectorAll('.pane')].findIndex((pane) => pane.querySelector('.menu')?.open);
    return index < 0 ? null : index;
  }

  #openAgain(index) {
    const menu = this.panes[Math.min(index, this.panes.length - 1)]?.element.querySelector('.menu');
    if (!menu) return;
    menu.open = true;
    menu.querySelector('summary').focus();
  }

  #nothing() {
    return el('p', {
      class: 'empty',
      text: 'No panes. “Add pane” makes one; “Default panes” brings the first ones back.',
    });
  }
}
