// What the cursors read: exact values of every channel shown, and the differences.

import { el } from '../dom.js';
import { cursorRows, interval } from '../plot/cursors.js';
import { duration, exact, frequency, runTime, short } from '../settings/numbers.js';
import { factorOf, unitOf } from '../settings/units.js';
import { section } from './section.js';

export class CursorPanel {
  constructor(scope, cursors, signals) {
    Object.assign(this, { scope, cursors });
    this.hint = el('p', {
      class: 'hint',
      text: 'C sets two cursors; drag them, or move the active one with Shift and the arrows.',
    });
    this.spans = el('dl', { class: 'spans' });
    this.rows = el('tbody');
    this.table = el(
      'table',
      {},
      el('caption', { class: 'unseen', text: 'Values at the cursors' }),
      el(
        'thead',
        {},
        el(
          'tr',
          {},
          ...['channel', 'A', 'B', 'B − A', 'unit'].map((text, i) =>
            el('th', { scope: 'col' }, el('span', { class: i % 4 === 0 ? 'unseen' : '', text })),
          ),
        ),
      ),
      this.rows,
    );
    this.element = section('cursors', 'Cursors', true, this.hint, this.spans, this.table);
    signals.on('cursors', () => this.#show());
    signals.on('preferences', () => this.#show());
    this.#show();
  }

  #show() {
    const { at, values, channels, shown } = this.cursors;
    this.hint.hidden = shown;
    this.table.hidden = !shown;
    this.spans.hidden = !shown;
    if (!shown) return;
    this.element.open = true;
    const between = interval(at);
    this.spans.replaceChildren(
      ...this.#span('A', runTime(at.a ?? NaN, 0.01), 's'),
      ...this.#span('B', runTime(at.b ?? NaN, 0.01), 's'),
      ...this.#span('Δt', between ? duration(between.dt) : '–', ''),
      ...this.#span('1/Δt', between ? frequency(between.rate) : '–', ''),
    );
    const { si } = this.scope.preferences;
    this.rows.replaceChildren(
      ...cursorRows(channels, values.a, values.b).map(({ id, a, b, difference }) => {
        const channel = this.scope.channel(id);
        const factor = channel ? factorOf(channel, si) : 1;
        const cell = (value, name) =>
          el('td', {
            class: 'number',
            'data-cell': `${id}.${name}`,
            'data-exact': exact(value * factor),
            title: exact(value * factor),
            text: short(value * factor),
          });
        return el(
          'tr',
          {},
          el('th', { scope: 'row', text: id }),
          cell(a, 'a'),
          cell(b, 'b'),
          cell(difference, 'difference'),
          el('td', { class: 'unit', text: channel ? unitOf(channel, si) : '' }),
        );
      }),
    );
  }

  #span(name, value, unit) {
    return [el('dt', { text: name }), el('dd', { 'data-span': name, text: `${value} ${unit}`.trim() })];
  }
}
