// The live view of a run: which channels and how finely the server streams, and the bins that came.

import { BinStore, noBins } from './bin_store.js';

const kFps = 60;
const kSpare = 1.2; // bins kept, of those on the screen

export class Stream {
  #link;
  #id = null;
  #asked = null; // {run, channels, span, pixels}
  #store = null;
  #before = null; // the store of the view before this, until the first frame of this one

  constructor(link, signals) {
    this.#link = link;
    signals.on('bins', (frame) => this.#add(frame, signals));
    signals.on('link', ({ state }) => {
      if (state === 'open') this.#resume();
    });
    document.addEventListener('visibilitychange', () => (document.hidden ? this.#silence() : this.#resume()));
  }

  // Streams these channels; does nothing when that is what is streamed already.
  show(run, channels, span, pixels) {
    const asked = { run: run.run, session: run.session, channels, span, pixels: Math.max(50, Math.round(pixels)) };
    if (JSON.stringify(asked) === JSON.stringify(this.#asked)) return;
    if (asked.session === this.#asked?.session && this.#store && !this.#store.empty) this.#before = this.#store;
    else this.#before = null;
    this.#silence();
    this.#asked = asked;
    this.#store = new BinStore(channels, Math.ceil(asked.pixels * kSpare) + 4);
    this.#resume();
  }

  stop() {
    this.#silence();
    this.#asked = null;
    this.#store = null;
    this.#before = null;
  }

  // End of the newest bin, s; null before the first.
  get last() {
    const store = this.#shown();
    return store ? store.last : null;
  }

  between(t0, t1) {
    const store = this.#shown();
    return store ? store.between(t0, t1) : noBins();
  }

  #shown() {
    if (this.#store && !this.#store.empty) return this.#store;
    return this.#before;
  }

  #add(frame, signals) {
    if (frame.id !== this.#id || frame.min.length !== this.#store.channels.length) return;
    this.#store.add(frame);
    this.#before = null;
    signals.emit('data');
  }

  #silence() {
    if (this.#id !== null) this.#link.send({ op: 'unview', id: this.#id });
    this.#id = null;
  }

  #resume() {
    if (!this.#asked || document.hidden || this.#asked.channels.length === 0) return;
    this.#id = this.#link.nextId();
    const { run, channels, span, pixels } = this.#asked;
    this.#link.send({ op: 'view', id: this.#id, run, channels, span, pixels, fps: kFps });
  }
}
