// Which panes there are and which channels each shows. Kept in localStorage by the configuration's name, so
// that every rig keeps the arrangement that its user made.

const kVersion = 1;
const kMostPanes = 24;

const kDefault = [
  { title: 'Pressure difference', channels: ['dp', 'dp_ref'] },
  { title: 'Pressures', channels: ['p1', 'p2'] },
  { title: 'Arm angle', channels: ['arm_angle', 'arm_ref'] },
  { title: 'Motor speed', channels: ['motor_speed'] },
  { title: 'Motor voltage', channels: ['voltage'] },
  { title: 'Loop timing', channels: ['period_us', 'latency_us'] },
];

const kResiduals = ['residual.p1', 'residual.p2', 'residual.motor_speed'];

// A layout is {panes: [{title, channels: [id], hidden: [id]}]}; all functions return a new one.

export function defaultLayout(known) {
  const panes = kDefault
    .map(({ title, channels }) => ({ title, channels: channels.filter((id) => known.includes(id)), hidden: [] }))
    .filter((pane) => pane.channels.length > 0);
  if (panes.length === 0 && known.length > 0) panes.push({ title: '', channels: known.slice(0, 2), hidden: [] });
  return { panes };
}

export function withChannel(layout, pane, id) {
  return edit(layout, pane, (old) => (old.channels.includes(id) ? old : { ...old, channels: [...old.channels, id] }));
}

export function withoutChannel(layout, pane, id) {
  return edit(layout, pane, (old) => ({
    ...old,
    channels: old.channels.filter((other) => other !== id),
    hidden: old.hidden.filter((other) => other !== id),
  }));
}

// Moves a channel to another pane; to === panes.length makes a new one.
export function withChannelMoved(layout, from, to, id) {
  if (from === to) return layout;
  const grown = to >= layout.panes.length ? withPane(layout) : layout;
  return withChannel(withoutChannel(grown, from, id), Math.min(to, grown.panes.length - 1), id);
}

export function withHidden(layout, pane, id, hide) {
  return edit(layout, pane, (old) => ({
    ...old,
    hidden: [...old.hidden.filter((other) => other !== id), ...(hide ? [id] : [])],
  }));
}

export function withPane(layout, title = '', channels = []) {
  if (layout.panes.length >= kMostPanes) return layout;
  return { panes: [...layout.panes, { title, channels, hidden: [] }] };
}

export function withoutPane(layout, pane) {
  return { panes: layout.panes.filter((_, i) => i !== pane) };
}

export function withPaneMoved(layout, pane, by) {
  const to = Math.min(layout.panes.length - 1, Math.max(0, pane + by));
  const panes = [...layout.panes];
  panes.splice(to, 0, ...panes.splice(pane, 1));
  return { panes };
}

export function withTitle(layout, pane, title) {
  return edit(layout, pane, (old) => ({ ...old, title }));
}

// The residuals have a pane of their own, which comes and goes with the ghost.
export function withResiduals(layout, known) {
  if (layout.panes.some((pane) => pane.channels.some((id) => id.startsWith('residual.')))) return layout;
  const channels = kResiduals.filter((id) => known.includes(id));
  return channels.length === 0 ? layout : withPane(layout, 'Residual: measured − ghost', channels);
}

export function withoutResiduals(layout) {
  return {
    panes: layout.panes.filter(
      (pane) => pane.channels.length === 0 || !pane.channels.every((id) => id.startsWith('residual.')),
    ),
  };
}

export function channelsOf(layout) {
  return [...new Set(layout.panes.flatMap((pane) => pane.channels))];
}

function edit(layout, pane, change) {
  return { panes: layout.panes.map((old, i) => (i === pane ? change(old) : old)) };
}

function key(name) {
  return `hydro-scope.layout.${name}`;
}

export function saveLayout(storage, name, layout) {
  storage.setItem(key(name), JSON.stringify({ version: kVersion, panes: layout.panes }));
}

export function forgetLayout(storage, name) {
  storage.removeItem(key(name));
}

// What was kept, or null when there is nothing usable: what stands in a browser may be from another version.
export function loadLayout(storage, name) {
  try {
    const kept = JSON.parse(storage.getItem(key(name)) ?? 'null');
    if (kept?.version !== kVersion || !Array.isArray(kept.panes) || kept.panes.length === 0) return null;
    return { panes: kept.panes.slice(0, kMostPanes).map(checkedPane) };
  } catch {
    return null;
  }
}

function checkedPane(pane) {
  const strings = (list) => (Array.isArray(list) ? list.filter((id) => typeof id === 'string') : []);
  return {
    title: typeof pane.title === 'string' ? pane.title : '',
    channels: strings(pane.channels),
    hidden: strings(pane.hidden),
  };
}
