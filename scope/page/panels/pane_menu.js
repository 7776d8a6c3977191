// The menu of a pane: which channels it shows, where they go, its name and its place.

import { choice, el } from '../dom.js';
import * as layouts from '../settings/layout.js';

// A press elsewhere closes an open menu.
addEventListener('pointerdown', (event) => {
  for (const menu of document.querySelectorAll('.menu[open]')) {
    if (!menu.contains(event.target)) menu.open = false;
  }
});

export function paneMenu(scope, index) {
  const pane = scope.layout.panes[index];
  const set = (layout) => scope.setLayout(layout);
  const menu = el(
    'details',
    { class: 'menu' },
    el('summary', { 'aria-label': `Arrange pane ${index + 1}`, title: 'Arrange this pane', text: '⋯' }),
    el(
      'div',
      { class: 'sheet' },
      ...pane.channels.map((id) => channelRow(scope, index, id, set)),
      addRow(scope, index, set),
      el(
        'label',
        { class: 'field' },
        el('span', { class: 'name', text: 'Name' }),
        el('input', {
          value: pane.title,
          maxlength: 60,
          onchange: (event) => set(layouts.withTitle(scope.layout, index, event.target.value)),
        }),
      ),
      el(
        'div',
        { class: 'row' },
        button('Up', () => set(layouts.withPaneMoved(scope.layout, index, -1)), index === 0),
        button(
          'Down',
          () => set(layouts.withPaneMoved(scope.layout, index, 1)),
          index === scope.layout.panes.length - 1,
        ),
        button('Remove pane', () => set(layouts.withoutPane(scope.layout, index))),
      ),
    ),
  );
  menu.addEventListener('keydown', (event) => {
    if (event.key !== 'Escape') return;
    menu.open = false;
    menu.querySelector('summary').focus();
    event.stopPropagation();
  });
  return menu;
}

function button(text, onclick, disabled = false) {
  return el('button', { type: 'button', text, onclick, disabled });
}

function channelRow(scope, index, id, set) {
  const others = scope.layout.panes.map((pane, i) => [
    String(i),
    i === index ? 'here' : `pane ${i + 1}: ${pane.title || pane.channels.join(', ') || 'empty'}`,
  ]);
  const move = choice(
    [...others, [String(scope.layout.panes.length), 'a new pane']],
    String(index),
    (to) => set(layouts.withChannelMoved(scope.layout, index, Number(to), id)),
    { 'aria-label': `Move ${id} to` },
  );
  return el(
    'div',
    { class: 'row' },
    el('span', { class: 'grow', text: id, title: scope.channel(id)?.label ?? '' }),
    move,
    button('Remove', () => set(layouts.withoutChannel(scope.layout, index, id))),
  );
}

function addRow(scope, index, set) {
  const shown = scope.layout.panes[index].channels;
  const groups = new Map();
  for (const channel of scope.run?.channels ?? []) {
    if (shown.includes(channel.id)) continue;
    const name = channel.group || 'other';
    if (!groups.has(name)) groups.set(name, el('optgroup', { label: name }));
    groups.get(name).append(el('option', { value: channel.id, text: `${channel.id}: ${channel.label ?? ''}` }));
  }
  const select = el(
    'select',
    {
      'aria-label': `Add a channel to pane ${index + 1}`,
      onchange: (event) => set(layouts.withChannel(scope.layout, index, event.target.value)),
    },
    el('option', { value: '', text: 'Add a channel …', selected: true, disabled: true }),
    ...groups.values(),
  );
  return el('div', { class: 'row' }, select);
}
