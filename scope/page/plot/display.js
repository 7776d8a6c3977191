// Which window of time is on the screen, and the bins for it. Three ways to look:
//   follow   the newest sample is at the right (live), or the head of the playback is (logs)
//   still    a window that the user chose; it stays while the run goes on
//   trigger  the newest capture, which stands still around its trigger until the next one comes
// Signals: "view" when the way of looking or the window changed, "draw" when the picture must be drawn again.

import { noBins } from './bin_store.js';
import { fitted, following, limitSpan, panned, stepped, zoomed, kDivisions } from './time_window.js';
import { Stream } from './stream.js';
import { WindowCache } from './window_cache.js';

export class Display {
  mode = 'follow';
  window = { t0: 0, t1: 10 }; // in trigger mode: relative to the trigger
  capture = null; // {t, t0, t1, bins, count}
  head = null; // of the playback of a log, s

  constructor(scope, signals) {
    this.scope = scope;
    this.signals = signals;
    this.pixels = 1000;
    this.stream = new Stream(scope.link, signals);
    this.cache = new WindowCache(scope.link, () => signals.emit('draw'));
    signals.on('run', () => this.#begin());
    signals.on('restart', () => this.#begin());
    signals.on('runs', () => {
      if (!scope.live) this.cache.forget();
    }); // a log's ghost may be complete by now
    for (const name of ['data', 'clock', 'layout', 'preferences', 'events']) signals.on(name, () => this.#changed());
  }

  get span() {
    return this.scope.preferences.span;
  }
  get last() {
    return Math.max(this.scope.run?.last ?? 0, this.stream.last ?? 0);
  }
  get first() {
    return this.scope.run?.first ?? 0;
  }

  // {t0, t1, origin, bins}: the window in run time, the time that the axis calls 0, and the bins.
  frame() {
    const { run } = this.scope;
    if (!run) return { ...this.window, origin: 0, bins: noBins() };
    if (this.mode === 'trigger') return this.#captured();
    if (this.mode === 'follow' && this.scope.live) {
      this.window = following(this.first, this.stream.last ?? run.last, this.span);
      return { ...this.window, origin: 0, bins: this.stream.between(this.window.t0, this.window.t1) };
    }
    if (this.mode === 'follow') this.window = following(this.first, this.head ?? run.last, this.span);
    return { ...this.window, origin: 0, bins: this.#binsOf(this.window.t0, this.window.t1) };
  }

  follow() {
    this.#look('follow');
  }

  pause() {
    const { t0, t1, origin } = this.frame();
    this.window = { t0: t0 - origin, t1: t1 - origin };
    if (this.mode !== 'trigger') this.#look('still');
  }

  trigger() {
    this.window = this.capture
      ? { t0: this.capture.t0 - this.capture.t, t1: this.capture.t1 - this.capture.t }
      : { t0: 0, t1: 1 };
    this.#look('trigger');
  }

  // The next capture takes the place of the last; a zoom into the capture before it stays.
  show(capture) {
    const before = this.capture;
    this.capture = capture;
    if (this.mode !== 'trigger') return;
    const same = before && Math.abs(before.t1 - before.t0 - (capture.t1 - capture.t0)) < 1e-9;
    if (!same) this.trigger();
    this.#changed();
  }

  zoom(factor, about) {
    if (this.mode === 'trigger') this.#setWindow(zoomed(this.window, factor, about - this.#origin()));
    else this.#still(zoomed(this.frame(), factor, about));
  }

  pan(by) {
    if (this.mode === 'trigger') this.#setWindow(panned(this.window, by));
    else this.#still(panned(this.frame(), by));
  }

  showWindow(t0, t1) {
    const origin = this.mode === 'trigger' ? this.#origin() : 0;
    const window = { t0: t0 - origin, t1: t0 - origin + limitSpan(t1 - t0) };
    if (this.mode === 'trigger') this.#setWindow(window);
    else this.#still(window);
  }

  // The whole run, or the whole capture.
  fit() {
    if (this.mode === 'trigger') this.trigger();
    else this.#still(fitted(this.first, this.last));
  }

  centre(t) {
    if (this.mode === 'trigger') this.follow();
    const { t0, t1 } = this.frame();
    this.#still(panned({ t0, t1 }, t - (t0 + t1) / 2));
  }

  // The time base, one step of 1-2-5 longer or shorter; what is at the right (following) or in the middle
  // stays.
  step(steps) {
    const { t0, t1 } = this.frame();
    const shown = this.mode === 'follow' ? this.span : t1 - t0;
    const span = limitSpan(stepped(shown / kDivisions, steps) * kDivisions);
    if (this.mode === 'follow') this.scope.prefer({ span });
    else this.zoom(span / shown, (t0 + t1) / 2);
    this.#changed();
  }

  // Plays and scrubs: the head of the playback, within the run.
  seek(t) {
    this.head = Math.min(this.last, Math.max(this.first, t));
    this.mode = 'follow';
    this.#changed();
  }

  subscribe() {
    if (this.scope.live) this.stream.show(this.scope.run, this.scope.wanted(), this.span, this.pixels);
    else this.stream.stop();
  }

  #captured() {
    const { capture } = this;
    if (!capture) return { ...this.window, origin: 0, bins: noBins() };
    const t0 = capture.t + this.window.t0;
    const t1 = capture.t + this.window.t1;
    const zoomed_in = t1 - t0 < 0.999 * (capture.t1 - capture.t0) || t0 < capture.t0 - 1e-9 || t1 > capture.t1 + 1e-9;
    const fine = zoomed_in ? this.#binsOf(t0, t1) : null;
    return { t0, t1, origin: capture.t, bins: fine && this.cache.covers(t0, t1) ? fine : capture.bins };
  }

  #binsOf(t0, t1) {
    const bins = this.cache.bins({ ...this.scope.run, last: this.last }, this.scope.wanted(), t0, t1, this.pixels);
    return bins.t.length === 0 && this.scope.live ? this.stream.between(t0, t1) : bins;
  }

  #origin() {
    return this.capture?.t ?? 0;
  }

  #begin() {
    this.cache.forget();
    this.stream.stop();
    this.capture = null;
    this.head = null;
    if (this.scope.live) this.mode = this.mode === 'trigger' ? 'trigger' : 'follow';
    else {
      this.mode = 'still';
      this.window = fitted(this.first, this.last);
    }
    this.#changed();
  }

  #still(window) {
    this.mode = 'still';
    this.#setWindow(window);
  }

  #setWindow({ t0, t1 }) {
    this.window = { t0, t1 };
    this.#changed();
  }

  #look(mode) {
    this.mode = mode;
    this.#changed();
  }

  #changed() {
    this.subscribe();
    this.signals.emit('view');
    this.signals.emit('draw');
  }
}
