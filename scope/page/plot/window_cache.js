// Bins of a window of a run that stands still, is being panned, or is played: asked of the server a little
// wider than shown, one request at a time, and drawn in the meantime as well as what is there allows.

import { binsOf, noBins } from './bin_store.js';

const kMargin = 0.5; // of the window, on either side
const kCoarser = 1.25; // bins this much wider than a pixel are asked anew
const kGrowth_ms = 200; // how often a window that reaches into the present is asked anew
const kRetry_ms = 1000;

export class WindowCache {
  #link;
  #redraw;
  #have = null; // {key, t0, t1, width, end, asked_ms, bins}
  #busy = false;
  #failed_ms = -Infinity;

  constructor(link, redraw) {
    this.#link = link;
    this.#redraw = redraw;
  }

  // The best bins there are for [t0, t1] of this run {run, last, session}; asks for better ones when these
  // fall short.
  bins(run, channels, t0, t1, pixels) {
    const key = `${run.run}|${run.session}|${channels.join(' ')}`;
    const width = (t1 - t0) / pixels;
    if (!this.#suits(key, t0, t1, width, run.last)) this.#ask(key, run, channels, t0, t1, pixels);
    return this.#have?.key === key ? this.#have.bins : noBins();
  }

  covers(t0, t1) {
    return this.#have !== null && this.#have.t0 <= t0 && this.#have.t1 >= t1;
  }

  forget() {
    this.#have = null;
  }

  #suits(key, t0, t1, width, last) {
    const have = this.#have;
    if (!have || have.key !== key || have.t0 > t0 || have.t1 < t1 || have.width > kCoarser * width) return false;
    const grown = last > have.end && t1 > have.end;
    return !grown || performance.now() - have.asked_ms < kGrowth_ms;
  }

  async #ask(key, run, channels, t0, t1, pixels) {
    const now = performance.now();
    if (this.#busy || channels.length === 0 || now - this.#failed_ms < kRetry_ms) return;
    this.#busy = true;
    const margin = kMargin * (t1 - t0);
    const wide = { t0: t0 - margin, t1: t1 + margin };
    const end = run.last;
    try {
      const answer = await this.#link.request({
        op: 'get',
        run: run.run,
        channels,
        ...wide,
        pixels: Math.ceil(pixels * (1 + 2 * kMargin)),
      });
      if (answer.op === 'reply') throw new Error(answer.text);
      this.#have = {
        key,
        ...wide,
        width: (t1 - t0) / pixels,
        end,
        asked_ms: now,
        bins: binsOf(answer, channels, run.rate_hz),
      };
    } catch {
      this.#failed_ms = performance.now();
      setTimeout(this.#redraw, kRetry_ms);
    }
    this.#busy = false;
    this.#redraw();
  }
}
