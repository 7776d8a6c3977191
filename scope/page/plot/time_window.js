// The window of time that the plots show, and the time base: seconds a division in steps of 1, 2, 5.

export const kDivisions = 10;
const kShortest_s = 1e-3; // a division of 0.1 ms
const kLongest_s = 36000;

const kMantissas = [1, 2, 5];

// The 1-2-5 value next to `value`: the nearest one (steps 0), or so many steps longer or shorter.
export function stepped(value, steps = 0) {
  const decade = Math.floor(Math.log10(value) + 1e-9);
  const mantissa = value / 10 ** decade;
  let index = 3 * decade;
  if (steps > 0) index += mantissa >= 5 - 1e-9 ? 2 : mantissa >= 2 - 1e-9 ? 1 : 0;
  else if (steps < 0) index += mantissa > 5 + 1e-9 ? 3 : mantissa > 2 + 1e-9 ? 2 : mantissa > 1 + 1e-9 ? 1 : 0;
  else index += mantissa > 7.1 ? 3 : mantissa > 3.2 ? 2 : mantissa > 1.42 ? 1 : 0;
  index += steps;
  const power = Math.floor(index / 3);
  const exact = Number(`${kMantissas[index - 3 * power]}e${power}`);
  return exact;
}

export function limitSpan(span) {
  return Math.min(kLongest_s, Math.max(kShortest_s, span));
}

// {t0, t1} scaled about the time `about`; factor < 1 zooms in.
export function zoomed({ t0, t1 }, factor, about) {
  const span = limitSpan((t1 - t0) * factor);
  const share = (about - t0) / (t1 - t0);
  const start = about - share * span;
  return { t0: start, t1: start + span };
}

export function panned({ t0, t1 }, by) {
  return { t0: t0 + by, t1: t1 + by };
}

// What "fit" shows: the whole run, with at least a division when it has just begun.
export function fitted(first, last) {
  const span = limitSpan(Math.max(last - first, 0.01));
  return { t0: first, t1: first + span };
}

// The window that follows the newest sample; it begins with the run, so that a young run is not squeezed to
// the right.
export function following(first, last, span) {
  const t1 = Math.max(last, first + span);
  return { t0: t1 - span, t1 };
}
