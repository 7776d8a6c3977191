// Faults and stops that have begun and not ended.
export function activeFaults(events) {
  const active = new Map();
  for (const event of events) {
    const name = `${event.source}|${event.code ?? event.text}`;
    if (event.kind === 'fault') active.set(name, event);
    else if (event.kind === 'stop') active.set('stop', event);
    else if (event.kind === 'fault_end') active.delete(name);
    else if (event.kind === 'rearm' || event.kind === 'restart') active.clear();
  }
  return [...active.values()];
}
