// Numbers as people read them beside a plot.

const kMinus = '\u2212';

// Four significant digits, no exponent for what a rig measures.
export function short(value) {
  if (value === null || value === undefined || Number.isNaN(value)) return '–';
  if (!Number.isFinite(value)) return value > 0 ? '∞' : `${kMinus}∞`;
  const size = Math.abs(value);
  let text;
  if (size === 0) text = '0';
  else if (size >= 1e7 || size < 1e-4) text = value.toExponential(3);
  else if (size >= 1000) text = value.toFixed(size >= 10000 ? 0 : 1);
  else text = value.toFixed(Math.max(0, 3 - Math.floor(Math.log10(size))));
  return text.replace('-', kMinus);
}

// Every digit that the double has.
export function exact(value) {
  return Number.isNaN(value) ? '–' : String(value).replace('-', kMinus);
}

// A time span with its unit: 200 µs, 5 ms, 1 s, 2 min.
export function duration(seconds) {
  const size = Math.abs(seconds);
  const sign = seconds < 0 ? kMinus : '';
  if (size === 0) return '0 s';
  if (size < 1e-3) return `${sign}${trimmed(size * 1e6)} µs`;
  if (size < 1) return `${sign}${trimmed(size * 1e3)} ms`;
  if (size < 600) return `${sign}${trimmed(size)} s`;
  return `${sign}${trimmed(size / 60)} min`;
}

// Run time in seconds with as many decimals as the span shown needs.
export function runTime(t, span = 10) {
  if (!Number.isFinite(t)) return '–';
  const decimals = Math.min(6, Math.max(3, 3 - Math.floor(Math.log10(span))));
  return t.toFixed(decimals).replace('-', kMinus);
}

export function frequency(hertz) {
  const size = Math.abs(hertz);
  if (!Number.isFinite(size)) return '–';
  return size >= 1000 ? `${trimmed(size / 1000)} kHz` : `${trimmed(size)} Hz`;
}

function trimmed(value) {
  return String(Number(value.toPrecision(4)));
}
