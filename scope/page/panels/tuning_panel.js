// Gains and the like, in force and to be set. One "Apply" is one set: all of it acts on one tick of the loop, or none.

import { el, setText } from '../dom.js';
import { section } from './section.js';

const kReferencePrefix = 'reference.';

export class TuningPanel {
  #version = null;
  #fields = new Map();                // key -> {entry, slider, input}
  #edited = new Set();

  constructor(scope, signals) {
    this.scope = scope;
    this.rows = el('div', { class: 'form' });
    this.result = el('output', { class: 'result', role: 'status' });
    this.apply = el('button', { type: 'button', class: 'main', text: 'Apply', onclick: () => this.#apply() });
    this.undo = el('button', { type: 'button', text: 'Undo', title: 'Take the last set back', onclick: () => this.#undo() });
    this.buttons = el('div', { class: 'row' }, this.apply, this.undo);
    this.readonly = el('p', { class: 'hint', text: 'Read only: [scope] control = true in the configuration lets the page set values.' });
    this.element = section('tuning', 'Tuning', false, this.rows, this.readonly, this.buttons, this.result);
    this.element.hidden = true;
    signals.on('op:tuning', (message) => this.#values(message));
    signals.on('link', () => this.#enable());
  }

  #values(message) {
    this.control = message.control === true && this.scope.control;
    const entries = (message.entries ?? []).filter(({ key }) => !key.startsWith(kReferencePrefix));
    this.element.hidden = entries.length === 0;
    const same = entries.length === this.#fields.size && entries.every(({ key }) => this.#fields.has(key)) && this.built_for === this.control;
    if (!same) this.#build(entries);
    for (const entry of entries) {
      const row = this.#fields.get(entry.key);
      row.entry = entry;
      setText(row.in_force, number(entry.value));
      if (row.input && !this.#edited.has(entry.key)) this.#put(row, entry.value);
    }
    if (this.#version !== null && this.#version !== message.version && message.text) setText(this.result, message.text);
    this.#version = message.version;
    this.#enable();
  }

  #build(entries) {
    this.built_for = this.control;
    this.#fields.clear();
    this.#edited.clear();
    this.rows.replaceChildren(...entries.map((entry) => this.#row(entry)));
    this.readonly.hidden = this.control;
    this.buttons.hidden = !this.control;
  }

  #row(entry) {
    const in_force = el('span', { class: 'number', title: 'in force' });
    const row = { entry, in_force, input: null, slider: null };
    this.#fields.set(entry.key, row);
    const label = el('span', { class: 'name', title: [entry.what, entry.acts_in && `acts in ${entry.acts_in}`].filter(Boolean).join('; '), text: entry.key });
    const unit = el('span', { class: 'unit', text: entry.unit ?? '' });
    if (!this.control || typeof entry.value !== 'number') return el('div', { class: 'tuning', 'data-key': entry.key }, label, in_force, unit);
    row.input = el('input', { type: 'number', step: 'any', 'aria-label': `${entry.key}, ${entry.unit ?? ''}`, oninput: () => this.#edit(row, row.input.value, row.input) });
    const bounded = Number.isFinite(entry.min) && Number.isFinite(entry.max);
    if (bounded) row.slider = el('input', { type: 'range', min: entry.min, max: entry.max, step: (entry.max - entry.min) / 1000, 'aria-label': `${entry.key}, slider`, oninput: () => this.#edit(row, row.slider.value, row.slider) });
    return el('div', { class: 'tuning editable', 'data-key': entry.key }, label, in_force, unit, row.input, row.slider);
  }

  #edit(row, text, source) {
    const { key, value } = row.entry;
    const given = Number(text);
    if (text !== '' && given === value) this.#edited.delete(key);
    else this.#edited.add(key);
    if (source !== row.input) row.input.value = number(given);
    if (source !== row.slider && row.slider) row.slider.value = text;
    this.#enable();
  }

  #put(row, value) {
    row.input.value = number(value);
    if (row.slider) row.slider.value = String(value);
  }

  #enable() {
    this.apply.disabled = this.#edited.size === 0 || this.scope.link.state !== 'open';
    setText(this.apply, this.#edited.size > 1 ? `Apply ${this.#edited.size} together` : 'Apply');
    this.undo.disabled = this.scope.link.state !== 'open';
  }

  async #apply() {
    const keys = [...this.#edited];
    const entries = keys.map((key) => `${key}=${this.#fields.get(key).input.value}`);
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

function number(value) {
  return typeof value === 'number' ? String(Number(value.toPrecision(6))) : String(value);
}
