// Which curves a pane draws: its channels, the ghost's of the same channels, and those of the run that is
// laid over.

import { unitOf } from '../settings/units.js';
import { kTraceColours } from './colours.js';

export const kMostUnits = 2; // a value axis on either side

// [{id, of, channel, kind: 'measured'|'ghost'|'overlay', colour: 'c0'.., axis: 0|1, hidden}] and the units of
// the axes.
export function tracesOf(pane, { channel, ghost, overlay, si }) {
  const units = [];
  const traces = [];
  pane.channels.forEach((id, i) => {
    const main = channel(id);
    if (!main) return;
    const unit = unitOf(main, si);
    if (!units.includes(unit)) units.push(unit);
    const common = {
      of: id,
      colour: `c${i % kTraceColours}`,
      axis: Math.min(units.indexOf(unit), kMostUnits - 1),
      hidden: pane.hidden.includes(id),
    };
    traces.push({ ...common, id, channel: main, kind: 'measured' });
    const modelled = ghost ? channel(`ghost.${id}`) : null;
    if (modelled) traces.push({ ...common, id: modelled.id, channel: modelled, kind: 'ghost' });
    const other = overlay?.(id);
    if (other) traces.push({ ...common, id, channel: other, kind: 'overlay' });
  });
  return { traces, units: units.slice(0, kMostUnits) };
}
