// The stack's processes: how fast each loop runs, what it missed, how late it was, and whether it is in
// fault.

import { el } from '../dom.js';
import { short } from '../settings/numbers.js';
import { section } from './section.js';

export class LoopsPanel {
  constructor(signals) {
    this.rows = el('tbody');
    this.table = el(
      'table',
      {},
      el('caption', { class: 'unseen', text: 'Processes of the stack' }),
      el(
        'thead',
        {},
        el('tr', {}, ...['loop', 'Hz', 'missed', 'p99 µs', 'lost'].map((text) => el('th', { text, scope: 'col' }))),
      ),
      this.rows,
    );
    this.element = section('loops', 'Processes', false, this.table);
    this.element.hidden = true;
    signals.on('processes', ({ list }) => this.#show(list ?? []));
  }

  #show(list) {
    this.element.hidden = list.length === 0;
    this.rows.replaceChildren(
      ...list.flatMap((one) => {
        const row = el(
          'tr',
          { 'data-role': one.role, class: one.fault ? 'bad' : '' },
          el('th', { scope: 'row', text: one.role, title: one.host ?? '' }),
          ...[one.rate_hz, one.missed, one.latency_p99_us, one.lost].map((value) =>
            el('td', { class: 'number', text: typeof value === 'number' ? short(value) : '–' }),
          ),
        );
        const words = [one.state && one.state !== 'running' ? one.state : '', one.fault].filter(Boolean).join(': ');
        return words
          ? [row, el('tr', { class: one.fault ? 'bad' : '' }, el('td', { colspan: '5', class: 'words', text: words }))]
          : [row];
      }),
    );
  }
}
