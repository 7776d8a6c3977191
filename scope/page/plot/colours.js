// Colours and widths of the drawing, read from the style sheet so that light and dark stand in one place.

const kNames = [
  'ink',
  'soft',
  'line',
  'fine',
  'edge',
  'paper',
  'panel',
  'accent',
  'bad',
  'warn',
  'cursor',
  'trigger',
  'c0',
  'c1',
  'c2',
  'c3',
  'c4',
  'c5',
  'c6',
  'c7',
];

export const kTraceColours = 8;

export function readColours(root = document.documentElement) {
  const style = getComputedStyle(root);
  return Object.fromEntries(kNames.map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
}

export function colourOf(event) {
  if (event.kind === 'fault' || event.kind === 'stop') return 'bad';
  if (event.kind === 'fault_end' || event.kind === 'gap' || event.kind === 'restart') return 'warn';
  if (event.kind === 'mark' || event.kind === 'tuning' || event.kind === 'rearm') return 'accent';
  return 'soft';
}

// Half way between two colours #rrggbb: the ghost's curve must be told from the measured one that it lies on.
export function between(one, other) {
  const parts = (colour) => colour.match(/[0-9a-f]{2}/gi).map((hex) => parseInt(hex, 16));
  const a = parts(one);
  const b = parts(other);
  return `#${a
    .map((value, i) =>
      Math.round((value + b[i]) / 2)
        .toString(16)
        .padStart(2, '0'),
    )
    .join('')}`;
}
