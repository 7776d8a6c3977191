// A section of the side: a heading that opens and closes, remembered in this tab.

import { el } from '../dom.js';

export function section(id, title, open, ...children) {
  const key = `hydro-scope.open.${id}`;
  const kept = sessionStorage.getItem(key);
  const details = el(
    'details',
    { class: 'section', id: `section-${id}`, open: kept === null ? open : kept === 'yes' },
    el('summary', {}, el('h2', { text: title })),
    el('div', { class: 'body' }, ...children),
  );
  details.addEventListener('toggle', () => sessionStorage.setItem(key, details.open ? 'yes' : 'no'));
  return details;
}
