// What the server streams for one view: the newest bins of each channel, on a grid of equal widths. Bin k
// covers [(k + phase) width, (k + 1 + phase) width); the server chooses the grid: whole multiples of the
// width (phase 0), or, for bins of a sample each, bins centred on the samples (phase 0.5). Holds a fixed
// number of bins, so that a day of streaming takes no more memory than a minute.

export class BinStore {
  // channels: ids in the order of the frames; capacity: bins kept.
  constructor(channels, capacity) {
    this.channels = channels;
    this.width = 1; // s, of the frames
    this.phase = 0;
    this.capacity = capacity;
    this.first = 0; // index of the oldest bin kept
    this.end = 0; // one past the newest
    this.min = channels.map(() => new Float64Array(capacity).fill(NaN));
    this.max = channels.map(() => new Float64Array(capacity).fill(NaN));
  }

  get empty() {
    return this.end === this.first;
  }
  get last() {
    return (this.end + this.phase) * this.width;
  }

  // A frame replaces the bins that it repeats (the newest was incomplete); bins between are without samples.
  add(frame) {
    if (frame.bins === 0) return;
    // A quarter of a bin keeps rounding errors of t0 from choosing another bin, on either grid.
    const start = Math.floor(frame.t0 / frame.width + 0.25);
    if (this.empty || frame.width !== this.width) this.#regrid(frame, start);
    const stop = start + frame.bins;
    if (this.empty || start > this.end + this.capacity || stop <= this.first) this.#restart(start);
    for (let k = this.end; k < start; k += 1) this.#clear(k);
    for (let k = Math.max(start, stop - this.capacity); k < stop; k += 1) {
      const slot = this.#slot(k);
      for (let c = 0; c < this.channels.length; c += 1) {
        this.min[c][slot] = frame.min[c][k - start];
        this.max[c][slot] = frame.max[c][k - start];
      }
    }
    this.end = Math.max(this.end, stop);
    this.first = Math.max(Math.min(this.first, start), this.end - this.capacity);
  }

  // The bins of [t0, t1] and one on either side, in order, with the bin's middle as time.
  // {t: Float64Array, min: {id: Float64Array}, max: {id: ...}, width}
  between(t0, t1) {
    const from = Math.max(this.first, Math.floor(t0 / this.width - this.phase) - 1);
    const to = Math.max(from, Math.min(this.end, Math.ceil(t1 / this.width - this.phase) + 1));
    const count = to - from;
    const bins = { t: new Float64Array(count), min: {}, max: {}, width: this.width };
    for (let i = 0; i < count; i += 1) bins.t[i] = (from + i + 0.5 + this.phase) * this.width;
    this.channels.forEach((id, c) => {
      bins.min[id] = this.#copy(this.min[c], from, count);
      bins.max[id] = this.#copy(this.max[c], from, count);
    });
    return bins;
  }

  #slot(k) {
    return ((k % this.capacity) + this.capacity) % this.capacity;
  }

  #copy(ring, from, count) {
    const slot = this.#slot(from);
    const out = new Float64Array(count);
    const head = Math.min(count, this.capacity - slot);
    out.set(ring.subarray(slot, slot + head));
    out.set(ring.subarray(0, count - head), head);
    return out;
  }

  #clear(k) {
    const slot = this.#slot(k);
    for (let c = 0; c < this.channels.length; c += 1) {
      this.min[c][slot] = NaN;
      this.max[c][slot] = NaN;
    }
  }

  #regrid(frame, start) {
    this.width = frame.width;
    this.phase = Math.round(2 * (frame.t0 / frame.width - start)) / 2;
    this.#restart(start);
  }

  #restart(k) {
    this.first = k;
    this.end = k;
  }
}

// The bins of one answer of the server (a "get" or a capture) in the form of between(). Where the server
// widened bins to the sampling interval, each is one sample, and stands at that sample's time rather than in
// the bin's middle.
export function binsOf(frame, channels, rate_hz = 0) {
  const bins = { t: new Float64Array(frame.bins), min: {}, max: {}, width: frame.width };
  const offset = Math.abs(frame.width * rate_hz - 1) < 0.01 ? 0 : 0.5;
  for (let i = 0; i < frame.bins; i += 1) bins.t[i] = frame.t0 + (i + offset) * frame.width;
  channels.forEach((id, c) => {
    bins.min[id] = frame.min[c];
    bins.max[id] = frame.max[c];
  });
  return bins;
}

export function noBins() {
  return { t: new Float64Array(0), min: {}, max: {}, width: 1 };
}
