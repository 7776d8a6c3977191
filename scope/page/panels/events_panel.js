// Faults, steps, stops, tunings, gaps and marks as a list; a press shows the moment. New faults are also said
// to those who cannot see the marks.

import { byId, el } from '../dom.js';
import { colourOf } from '../plot/colours.js';
import { runTime } from '../settings/numbers.js';
import { section } from './section.js';

const kNames = {
  fault: 'fault',
  fault_end: 'fault over',
  step: 'step',
  stop: 'STOP',
  rearm: 're-armed',
  tuning: 'tuning',
  gap: 'gap',
  mark: 'mark',
  restart: 'restart',
};
const kMostShown = 200;
const kQuiet_ms = 2000;
const kRenew_ms = 150; // a storm of events must not take the time of the drawing

export class EventsPanel {
  items = new Map(); // event -> its element
  #asked = false;
  #said_ms = -Infinity;
  #joined_ms = performance.now();

  constructor(scope, display, signals) {
    Object.assign(this, { scope, display, signals });
    this.list = el('ol', { class: 'events', tabindex: '0', 'aria-label': 'Events, newest first' });
    this.empty = el('p', { class: 'hint', text: 'Nothing has happened yet. M marks a moment.' });
    this.filter = el(
      'label',
      { class: 'check' },
      (this.all = el('input', { type: 'checkbox', checked: true, onchange: () => this.#show() })),
      'steps too',
    );
    this.words = el('input', {
      type: 'text',
      maxlength: 120,
      placeholder: 'note for a mark',
      'aria-label': 'Note for a mark',
      onkeydown: (event) => {
        if (event.key === 'Enter') this.#mark();
      },
    });
    this.count = el('span', { class: 'count' });
    this.element = section(
      'events',
      'Events',
      true,
      el(
        'div',
        { class: 'row nowrap' },
        this.words,
        el('button', { type: 'button', text: 'Mark', title: 'Mark now (M)', onclick: () => this.#mark() }),
      ),
      el('div', { class: 'row' }, this.count, this.filter),
      this.empty,
      this.list,
    );
    signals.on('events', () => this.#ask());
    signals.on('run', () => this.#ask());
    signals.on('hello', () => {
      this.#joined_ms = performance.now();
    });
    signals.on('event', (event) => this.#say(event));
  }

  #mark() {
    this.signals.emit('mark', this.words.value.trim());
    this.words.value = '';
  }

  #ask() {
    if (this.#asked) return;
    this.#asked = true;
    setTimeout(() => {
      this.#asked = false;
      this.#show();
    }, kRenew_ms);
  }

  #show() {
    const all = this.scope.eventsOf();
    const events = all.filter((event) => this.all.checked || event.kind !== 'step');
    const faults = all.filter((event) => event.kind === 'fault').length;
    this.count.textContent = `${all.length} events, ${faults} ${faults === 1 ? 'fault' : 'faults'}`;
    this.empty.hidden = events.length > 0;
    const shown = [...events].sort((one, other) => other.t - one.t || other.n - one.n).slice(0, kMostShown);
    this.#lay(shown);
  }

  // Items that are there stay, so that the focus and the place that one has scrolled to stay too.
  #lay(shown) {
    const kept = new Map();
    shown.forEach((event, i) => {
      const item = this.items.get(event) ?? this.#item(event);
      kept.set(event, item);
      if (this.list.children[i] !== item) this.list.insertBefore(item, this.list.children[i] ?? null);
    });
    while (this.list.children.length > shown.length) this.list.lastElementChild.remove();
    this.items = kept;
  }

  #item(event) {
    const what = [event.source, event.code, event.text].filter(Boolean).join(': ');
    return el(
      'li',
      { 'data-kind': event.kind, class: colourOf(event) },
      el(
        'button',
        { type: 'button', title: 'Show this moment', onclick: () => this.display.centre(event.t) },
        el('span', { class: 'time', text: runTime(event.t) }),
        el('span', { class: 'kind', text: kNames[event.kind] ?? event.kind }),
        el('span', { class: 'what', text: what }),
      ),
    );
  }

  // What the server sends again on connecting is no news, and a storm of faults is said once.
  #say(event) {
    const now = performance.now();
    if (event.kind !== 'fault' || now - this.#joined_ms < 1000 || now - this.#said_ms < kQuiet_ms) return;
    this.#said_ms = now;
    byId('fault').textContent =
      `Fault at ${runTime(event.t)} s: ${[event.source, event.code, event.text].filter(Boolean).join(' ')}`;
  }
}
