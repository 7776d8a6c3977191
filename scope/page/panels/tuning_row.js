// One value that can be tuned: its name, what is in force, and how to give another: a slider and a field, or
// a field alone.

import { el, setText } from '../dom.js';

const kReach = 5; // a slider without limits goes from a fifth of the value to five times it

export class TuningRow {
  // edited(row): called at each change by the user
  constructor(given, control, edited) {
    const entry = { ...given, value: read(given.value) };
    this.edited = edited;
    this.in_force = el('span', { class: 'number', title: 'in force' });
    const what = [entry.what, entry.range && `[${entry.range}]`, entry.acts_in && `(${entry.acts_in})`]
      .filter(Boolean)
      .join(' ');
    this.element = el(
      'div',
      { class: 'tuning', 'data-key': entry.key },
      el('span', { class: 'name', title: entry.key, text: entry.key.slice(entry.key.indexOf('.') + 1) }),
      this.in_force,
      el('span', { class: 'unit', text: entry.unit === '1' ? '' : (entry.unit ?? '') }),
      what ? el('span', { class: 'what', text: what }) : null,
    );
    if (control) this.#makeFields(entry);
    this.show(entry, false);
  }

  get key() {
    return this.entry.key;
  }
  get given() {
    return this.input.value.trim();
  }
  get changed() {
    return this.given !== text(this.entry.value);
  }

  // The value in force; keep: what the user has typed stays.
  show(given, keep) {
    const entry = { ...given, value: read(given.value) };
    this.entry = entry;
    setText(this.in_force, shown(entry.value));
    if (this.input && !keep) {
      this.input.value = text(entry.value);
      this.#slide();
    }
  }

  #makeFields(entry) {
    const number = typeof entry.value === 'number';
    this.input = el('input', {
      type: number ? 'number' : 'text',
      step: 'any',
      class: number ? '' : 'wide',
      'aria-label': `${entry.key}, new value${entry.unit ? `, ${entry.unit}` : ''}`,
      oninput: () => {
        this.#slide();
        this.edited(this);
      },
    });
    this.element.append(this.input);
    if (!number || (entry.value === 0 && !bounded(entry))) return;
    this.scale = bounded(entry) ? linear(entry) : aroundValue(entry.value);
    this.slider = el('input', {
      type: 'range',
      min: 0,
      max: 1,
      step: 0.002,
      'aria-label': `${entry.key}, slider`,
      oninput: () => {
        this.input.value = text(Number(this.scale.value(Number(this.slider.value)).toPrecision(3)));
        this.edited(this);
      },
    });
    this.element.append(this.slider);
  }

  #slide() {
    if (this.slider) this.slider.value = String(this.scale.place(Number(this.input.value)));
  }
}

function bounded(entry) {
  return Number.isFinite(entry.min) && Number.isFinite(entry.max) && entry.max > entry.min;
}

function linear({ min, max }) {
  return { value: (place) => min + place * (max - min), place: (value) => (value - min) / (max - min) };
}

// Gains are felt as factors, so the slider is logarithmic around the value that was in force first.
function aroundValue(middle) {
  return {
    value: (place) => middle * kReach ** (2 * place - 1),
    place: (value) => (value / middle > 0 ? (Math.log(value / middle) / Math.log(kReach) + 1) / 2 : 0),
  };
}

// Numbers may come as text, as in a configuration; null: the key is not set.
function read(value) {
  return typeof value === 'string' && value.trim() !== '' && Number.isFinite(Number(value))
    ? Number(value)
    : (value ?? null);
}

function text(value) {
  if (value === null) return '';
  if (typeof value === 'number') return String(Number(value.toPrecision(6)));
  return typeof value === 'string' ? value : JSON.stringify(value);
}

function shown(value) {
  return value === null ? '–' : text(value);
}
