// The page's one dialog. It is not modal on purpose: STOP stays within reach of the mouse, a finger and the
// keyboard whatever is open.

import { byId, el } from '../dom.js';

let before = null;

// buttons: [{text, act, main: bool}]; "Close" is added when there are none.
export function showDialog(title, content, buttons = []) {
  const dialog = byId('dialog');
  if (!dialog.open) before = document.activeElement;
  const last = buttons.length > 0 ? buttons : [{ text: 'Close', main: true }];
  dialog.replaceChildren(
    el('h2', { id: 'dialog-title', text: title }),
    ...content,
    el(
      'div',
      { class: 'row buttons' },
      ...last.map(({ text, act, main }) =>
        el('button', {
          type: 'button',
          text,
          class: main ? 'main' : '',
          onclick: () => {
            closeDialog();
            act?.();
          },
        }),
      ),
    ),
  );
  // On STOP too, which is one of the dialog's stops.
  dialog.onkeydown = byId('stop').onkeydown = (event) => {
    if (!dialog.open) return;
    if (event.key === 'Escape') {
      closeDialog();
      event.stopPropagation();
    }
    if (event.key === 'Tab') keepInside(dialog, event);
  };
  if (!dialog.open) dialog.show();
  (dialog.querySelector('.buttons .main') ?? dialog.querySelector('button')).focus();
}

export function closeDialog() {
  const dialog = byId('dialog');
  if (!dialog.open) return;
  dialog.close();
  before?.focus?.();
}

// Tab goes round between the dialog and STOP, which is always one of its stops.
function keepInside(dialog, event) {
  const stops = [...dialog.querySelectorAll('button, input, select, a[href]'), byId('stop')].filter(
    (one) => !one.disabled,
  );
  const at = stops.indexOf(document.activeElement);
  if (at < 0) return;
  event.preventDefault();
  stops[(at + (event.shiftKey ? stops.length - 1 : 1)) % stops.length].focus();
}
