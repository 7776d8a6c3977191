// Gains and the like, in force and to be set. One "Apply" is one set: all of it acts on one tick of the loop,
// or none.

import { el, setText } from '../dom.js';
import { section } from './section.js';
import { TuningRow } from './tuning_row.js';

const kReferencePrefix = 'reference.';

export class TuningPanel {
  #version = null;
  #rows = new Map(); // key -> TuningRow
  #edited = new Set();

  constructor(scope, signals) {
    this.scope = scope;
    this.rows = el('div', { class: 'form' });
    this.result = el('output', { class: 'result', role: 'status' });
    this.apply = el('button', { type: 'button', class: 'main', text: 'Apply', onclick: () => this.#apply() });
    this.undo = el('button', {
      type: 'button',
      text: 'Undo',
      title: 'Take the last set back',
      onclick: () => this.#undo(),
    });
    this.buttons = el('div', { class: 'row buttons-bar' }, this.apply, this.undo);
    this.readonly = el('p', {
      class: 'hint',
      text: 'Read only: [scope] control = true in the configuration lets the page set values.',
    });
    this.element = section('tuning', 'Tuning', false, this.rows, this.readonly, this.buttons, this.result);
    this.element.hidden = true;
    signals.on('op:tuning', (message) => this.#values(message));
    signals.on('link', () => this.#enable());
  }

  #values(message) {
    this.control = message.control === true && this.scope.control;
    const entries = (message.entries ?? []).filter(({ key }) => !key.startsWith(kReferencePrefix));
    this.element.hidden = entries.length === 0;
    const same =
      entries.length === this.#rows.size &&
      entries.every(({ key }) => this.#rows.has(key)) &&
      this.built_for === this.control;
    if (!same) this.#build(entries);
    for (const entry of entries) this.#rows.get(entry.key).show(entry, this.#edited.has(entry.key));
    if (this.#version !== null && this.#version !== message.version && message.text) setText(this.result, message.text);
    this.#version = message.version;
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
    let group = '';
    this.rows.replaceChildren(
      ...entries.flatMap(({ key }) => {
        const [name] = key.split('.');
        const head = name === group ? [] : [el('h3', { text: name })];
        group = name;
        return [...head, this.#rows.get(key).element];
      }),
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
    const done = await this.#request({ op: 'set', entries });
    if (done) keys.forEach((key) => this.#edited.delete(key));
    this.#enable();
  }

  async #undo() {
    if (await this.#request({ op: 'undo' })) this.#edited.clear();
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
