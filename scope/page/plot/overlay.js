// Another run laid over the one that is shown, shifted in time: what was at t - shift there is drawn at t.

import { WindowCache } from './window_cache.js';

export class OverlayRun {
  number = null; // of the other run
  shift = 0; // s

  constructor(scope, signals) {
    this.scope = scope;
    this.signals = signals;
    this.cache = new WindowCache(scope.link, () => signals.emit('draw'));
    signals.on('runs', () => this.#check());
    signals.on('run', () => this.lay(null));
  }

  get run() {
    return this.number === null ? null : (this.scope.runs.find((one) => one.run === this.number) ?? null);
  }

  lay(number) {
    if (number === this.number) return;
    this.number = number;
    this.cache.forget();
    this.signals.emit('overlay');
  }

  setShift(shift) {
    this.shift = shift;
    this.signals.emit('shift', shift);
    this.signals.emit('draw');
  }

  // The channel of the other run, by id; null when nothing is laid over.
  channelOf() {
    const { run } = this;
    return run ? (id) => this.scope.channel(id, run) : null;
  }

  // {bins, shift} for a frame of the run shown; null when nothing is laid over.
  binsFor({ t0, t1 }, pixels) {
    const { run } = this;
    if (!run) return null;
    const known = run.channels.map((channel) => channel.id);
    const channels = this.scope.wanted().filter((id) => known.includes(id));
    return { bins: this.cache.bins(run, channels, t0 - this.shift, t1 - this.shift, pixels), shift: this.shift };
  }

  #check() {
    if (this.number !== null && !this.run) this.lay(null);
  }
}
