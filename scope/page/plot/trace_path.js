// How bins become a line: each bin is a vertical stroke from its minimum to its maximum, joined to its
// neighbours, so that a spike of one sample stands as tall as it was, however many samples share its pixel.

// Longest distance between two bins with samples that is still one curve; a longer one is a gap in the run.
export function bridge(channel, rate_hz, width) {
  const sample = rate_hz > 0 ? 1 / rate_hz : 0;
  return channel.id?.startsWith('loop.') ? 2.5 + width : 3 * sample + 1.5 * width;
}

// Calls pen.moveTo(x, y) and pen.lineTo(x, y) with pixels. x(t), y(value) are the scales; held: keep the
// value up to the next bin (commands and references).
export function trace(pen, bins, min, max, { x, y, held, bridge_s }) {
  let last_t = -Infinity;
  let last_y = 0;
  for (let i = 0; i < bins.t.length; i += 1) {
    const low = min[i];
    const high = max[i];
    if (Number.isNaN(low)) continue;
    const at = x(bins.t[i]);
    let y_low = y(low);
    let y_high = y(high);
    const joined = bins.t[i] - last_t <= bridge_s;
    if (joined && Math.abs(y_high - last_y) < Math.abs(y_low - last_y)) [y_low, y_high] = [y_high, y_low];
    if (!joined) pen.moveTo(at, y_low);
    else if (held) {
      pen.lineTo(at, last_y);
      pen.lineTo(at, y_low);
    } else pen.lineTo(at, y_low);
    if (y_high !== y_low) pen.lineTo(at, y_high);
    else if (!joined) pen.lineTo(at + 0.5, y_low); // a lone sample is a dot, not nothing
    last_y = y_high;
    last_t = bins.t[i];
  }
}

// The spans [from, to] inside [first, last] in which `min` has no samples for longer than bridge_s.
export function gapsIn(bins, min, bridge_s, first, last) {
  const gaps = [];
  let seen = null;
  for (let i = 0; i < bins.t.length; i += 1) {
    if (Number.isNaN(min[i])) continue;
    const t = bins.t[i];
    if (seen !== null && t - seen > bridge_s && t > first && seen < last) gaps.push([seen, t]);
    seen = t;
  }
  return gaps;
}

// The gaps that a pane shows: those of its first visible measured curve. frame: {bins}; state: {traces, rate_hz, first,
// last: of the run, s}.
export function gapsShown({ bins }, { traces, rate_hz, first, last }) {
  const one = traces.find((candidate) => candidate.kind === 'measured' && !candidate.hidden);
  if (!one || !bins?.min[one.id]) return [];
  return gapsIn(bins, bins.min[one.id], bridge(one.channel, rate_hz, bins.width), first, last);
}
