// The two cursors on the plots, and the exact values at them, asked of the server when they stand.

import { cursorNear, moved, noCursors, placed } from './cursors.js';

const kSettle_ms = 60;

export class CursorTool {
  at = noCursors();
  values = { a: null, b: null }; // {t, values} in the order of .channels, or null
  channels = [];
  #timer = null;

  constructor(scope, display, signals) {
    this.scope = scope;
    this.display = display;
    this.signals = signals;
    signals.on('run', () => this.clear());
    signals.on('restart', () => this.clear());
    signals.on('layout', () => this.#changed());
    signals.on('link', ({ state }) => {
      if (state === 'open' && this.shown) this.#changed();
    });
  }

  get shown() {
    return this.at.a !== null || this.at.b !== null;
  }

  place(name, t) {
    this.at = placed(this.at, name, t);
    this.#changed();
  }

  // Both on the screen, at a third and two thirds, or away.
  toggle() {
    if (this.shown) {
      this.clear();
      return;
    }
    const { t0, t1 } = this.display.frame();
    this.place('b', t0 + ((t1 - t0) * 2) / 3);
    this.place('a', t0 + (t1 - t0) / 3);
  }

  move(by) {
    this.at = moved(this.at, by);
    this.#changed();
  }

  choose(name) {
    this.at = { ...this.at, active: name };
    this.#changed();
  }

  near(t, reach) {
    return cursorNear(this.at, t, reach);
  }

  clear() {
    this.at = noCursors();
    this.#changed();
  }

  #changed() {
    this.signals.emit('cursors');
    this.signals.emit('draw');
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#ask(), kSettle_ms);
  }

  async #ask() {
    const channels = this.scope.run ? this.scope.wanted() : [];
    const { a, b } = this.at;
    const [at_a, at_b] = await Promise.all([this.#valuesAt(channels, a), this.#valuesAt(channels, b)]);
    if (a !== this.at.a || b !== this.at.b) return; // moved on meanwhile: the next answer counts
    this.channels = channels;
    this.values = { a: at_a, b: at_b };
    this.signals.emit('cursors');
  }

  async #valuesAt(channels, t) {
    if (t === null || channels.length === 0) return null;
    try {
      const reply = await this.scope.link.request({ op: 'values', run: this.scope.run.run, channels, t });
      if (!reply.ok) return null;
      // JSON has no NaN: what was not measured comes as null.
      return { t: reply.data.t, values: reply.data.values.map((value) => (value === null ? NaN : value)) };
    } catch {
      return null;
    }
  }
}
