// The range of a value axis: wide enough at once, narrower only when the data have been well inside for a
// while, so that the axis does not breathe while it streams.

const kMargin = 0.06;
const kShrinkBelow = 0.6; // of the range shown
const kShrinkAfter_ms = 1500;

// The smallest and largest value of bins in [t0, t1]; null without any.
export function extent(bins, ids, t0, t1) {
  let low = Infinity;
  let high = -Infinity;
  for (const id of ids) {
    const min = bins.min[id];
    const max = bins.max[id];
    if (!min) continue;
    for (let i = 0; i < bins.t.length; i += 1) {
      if (bins.t[i] < t0 - bins.width || bins.t[i] > t1 + bins.width) continue;
      if (min[i] < low) low = min[i];
      if (max[i] > high) high = max[i];
    }
  }
  return low <= high ? { low, high } : null;
}

// A little more than the data; a constant gets a range around it.
export function padded({ low, high }) {
  const spread = high - low;
  const margin =
    spread > 1e-12 * Math.max(1, Math.abs(low), Math.abs(high))
      ? spread * kMargin
      : Math.max(Math.abs(high) * 0.1, 1e-6);
  return { low: low - margin, high: high + margin };
}

export class StickyRange {
  #range = null;
  #small_since = null;

  // The range to show for these data at this time, ms.
  update(data, now_ms) {
    if (!data) return this.#range ?? { low: -1, high: 1 };
    const wanted = padded(data);
    const shown = this.#range;
    if (!shown) return this.#set(wanted);
    if (data.low < shown.low || data.high > shown.high) {
      return this.#set({ low: Math.min(shown.low, wanted.low), high: Math.max(shown.high, wanted.high) });
    }
    if (wanted.high - wanted.low > kShrinkBelow * (shown.high - shown.low)) {
      this.#small_since = null;
      return shown;
    }
    this.#small_since ??= now_ms;
    return now_ms - this.#small_since > kShrinkAfter_ms ? this.#set(wanted) : shown;
  }

  reset() {
    this.#range = null;
    this.#small_since = null;
  }

  #set(range) {
    this.#range = range;
    this.#small_since = null;
    return range;
  }
}
