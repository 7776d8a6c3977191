// Two cursors on the time axis and what lies between them.

export function noCursors() {
  return { a: null, b: null, active: 'a' };
}

export function placed(cursors, name, t) {
  return { ...cursors, [name]: t, active: name };
}

export function moved(cursors, by) {
  const at = cursors[cursors.active];
  return at === null ? cursors : { ...cursors, [cursors.active]: at + by };
}

// The cursor within reach of t, the nearer one; null when neither is.
export function cursorNear(cursors, t, reach) {
  const near = ['a', 'b'].filter((name) => cursors[name] !== null && Math.abs(cursors[name] - t) <= reach);
  near.sort((one, other) => Math.abs(cursors[one] - t) - Math.abs(cursors[other] - t));
  return near[0] ?? null;
}

// {dt, rate}: b - a in seconds and its inverse; null unless both stand.
export function interval(cursors) {
  if (cursors.a === null || cursors.b === null) return null;
  const dt = cursors.b - cursors.a;
  return { dt, rate: 1 / dt };
}

// Rows {id, a, b, difference} of the channels, from the exact values at the cursors ({t, values} in the
// channels' order, or null).
export function cursorRows(channels, at_a, at_b) {
  return channels.map((id, i) => {
    const a = at_a?.values?.[i] ?? NaN;
    const b = at_b?.values?.[i] ?? NaN;
    return { id, a, b, difference: b - a };
  });
}
