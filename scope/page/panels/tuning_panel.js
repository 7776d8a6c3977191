// Gains and the like, in force and to be set. One "Apply" is one set: all of it acts on one tick of the loop,
// or none.

import { el, setText } from '../dom.js';
import { section } from './section.js';
import { TuningRow } from './tuning_row.js';

const kReferencePrefix = 'reference.';
const kOpenGroups = ['pressure', 'position'];

function groupOf({ key }) {
  return key.split('.')[0];
}

export class TuningPanel {
  #rows = new Map(); // key -> TuningRow
  #edited = new Set();

  constructor(scope, signals) {
    this.scope = scope;
    this.in_force = el('p', { class: 'hint' });
    this.rows = el('div', { class: 'form' });
    // Long answers scroll, so they can have the focus.
    this.result = el('output', { class: 'result', role: 'status', tabindex: '0', 'aria-label': 'Answer of the stack' });
    this.apply = el('button', { type: 'button', class: 'main', text: 'Apply', onclick: () => this.#apply() });
    this.undo = el('button', {
      type: 'button',
      text: 'Undo',
      title: 'Take the last set back',
      onclick: () => this.#undo(),
    });
    // The answer stands with the buttons, in view wherever one has scrolled to.
    this.buttons = el('div', { class: 'buttons-bar' }, el('div', { class: 'row' }, this.apply, this.undo), this.result);
    this.readonly = el('p', {
      class: 'hint',
      text: 'Read only: [scope] control = true in the configuration lets the page set values.',
    });
    this.element = section('tuning', 'Tuning', false, this.in_force, this.readonly, this.rows, this.buttons);
    this.element.hidden = true;
    signals.on('tuning', (message) => this.#values(message));
    signals.on('link', () => this.#enable());
  }

  #values(message) {
    this.control = message.control === true && this.scope.control;
    const entries = (message.entries ?? []).filter(({ key }) => !key.startsWith(kReferencePrefix));
    this.element.hidden = entries.length === 0;
    // Another joint's values: what was typed is not for it.
    const same =
      this.built_of === message.run &&
      entries.length === this.#rows.size &&
      entries.every(({ key }) => this.#rows.has(key)) &&
      this.built_for === this.control;
    this.built_of = message.run;
    if (!same) this.#build(entries);
    for (const entry of entries) this.#rows.get(entry.key).show(entry, this.#edited.has(entry.key));
    setText(
      this.in_force,
      message.text || (message.version === 0 ? 'In force: as configured' : `In force: version ${message.version}`),
    );
    this.#enable();
  }

  #build(entries) {
    this.built_for = this.control;
    this.#edited.clear();
    const edited = (row) => {
      if (row.changed) this.#edited.add(row.key);
      else this.#edited.delete(row.key);
      this.#enable();
    };
    this.#rows = new Map(entries.map((entry) => [entry.key, new TuningRow(entry, this.control, edited)]));
    const groups = new Map();
    for (const entry of entries) groups.set(groupOf(entry), [...(groups.get(groupOf(entry)) ?? []), entry]);
    this.rows.replaceChildren(
      ...[...groups].map(([name, list]) =>
        el(
          'details',
          { class: 'group', open: kOpenGroups.includes(name) },
          el('summary', { text: name }),
          ...list.map(({ key }) => this.#rows.get(key).element),
        ),
      ),
    );
    this.readonly.hidden = this.control;
    this.buttons.hidden = !this.control;
  }

  #enable() {
    this.apply.disabled = this.#edited.size === 0 || this.scope.link.state !== 'open';
    setText(this.apply, this.#edited.size > 1 ? `Apply ${this.#edited.size} together` : 'Apply');
    this.undo.disabled = this.scope.link.state !== 'open';
  }

  async #apply() {
    const keys = [...this.#edited];
    const entries = keys.map((key) => `${key}=${this.#rows.get(key).given}`);
    const done = await this.#request({ op: 'set', run: this.scope.run?.run ?? 0, entries });
    if (done) keys.forEach((key) => this.#edited.delete(key));
    this.#enable();
  }

  async #undo() {
    if (await this.#request({ op: 'undo', run: this.scope.run?.run ?? 0 })) this.#edited.clear();
    this.#enable();
  }

  async #request(message) {
    this.result.dataset.state = '';
    setText(this.result, 'sent');
    try {
      const reply = await this.scope.link.request(message);
      const when = reply.data?.tick !== undefined ? ` It acts from tick ${reply.data.tick}.` : '';
      setText(this.result, reply.ok ? `Accepted. ${reply.text ?? ''}${when}` : `Refused: ${reply.text}`);
      this.result.dataset.state = reply.ok ? 'good' : 'bad';
      return reply.ok;
    } catch (error) {
      setText(this.result, `Not known whether it acts: ${error.message}`);
      this.result.dataset.state = 'bad';
      return false;
    }
  }
}
