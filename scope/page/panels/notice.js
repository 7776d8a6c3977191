// Lines at the top of the page that must be seen: no connection, STOP, refusals. One line a subject.

import { byId, el } from '../dom.js';

export class Notice {
  #lines = new Map();

  // kind: info, warn, bad, stopped; actions: [{text, act}]; extra: an element, such as a field.
  say(subject, text, kind = 'info', actions = [], extra = null) {
    const old = this.#lines.get(subject);
    if (old?.text === text && old.kind === kind) return;
    this.#lines.set(subject, { text, kind, actions, extra });
    this.#show();
  }

  clear(subject) {
    if (this.#lines.delete(subject)) this.#show();
  }

  #show() {
    const host = byId('notice');
    host.hidden = this.#lines.size === 0;
    host.replaceChildren(
      ...[...this.#lines].map(([subject, { text, kind, actions, extra }]) =>
        el(
          'div',
          { class: `line ${kind}`, 'data-subject': subject },
          el('span', { class: 'grow', text }),
          extra,
          ...actions.map((one) => el('button', { type: 'button', text: one.text, onclick: one.act })),
        ),
      ),
    );
  }
}
