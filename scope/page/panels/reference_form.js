// The reference from the page: its kind and its numbers, sent as one set of reference.* keys. The kinds'
// numbers are those of docs/configuration.md.

import { choice, el, field, setText } from '../dom.js';
import { section } from './section.js';

// A reference that is set while the stack runs counts its time from the tick at which it takes effect.
const kFromNow = ['reference.start_s=0'];

// name -> {text, keys: [[key, label, unit or '' for the signal's, first value]], fixed: entries that go with
// them}
const kKinds = {
  steps: { text: 'step to', keys: [['initial', 'Value', '', 0]], fixed: ['reference.steps=[]'] },
  sine: {
    text: 'sine',
    keys: [
      ['amplitude', 'Amplitude', '', 0.1],
      ['frequency_hz', 'Frequency', 'Hz', 0.5],
      ['offset', 'Offset', '', 0],
    ],
    fixed: kFromNow,
  },
  square: {
    text: 'square',
    keys: [
      ['amplitude', 'Amplitude', '', 0.1],
      ['frequency_hz', 'Frequency', 'Hz', 0.25],
      ['offset', 'Offset', '', 0],
    ],
    fixed: kFromNow,
  },
  chirp: {
    text: 'chirp',
    keys: [
      ['amplitude', 'Amplitude', '', 0.05],
      ['first_frequency_hz', 'From', 'Hz', 0.1],
      ['last_frequency_hz', 'To', 'Hz', 5],
      ['duration_s', 'In', 's', 10],
      ['offset', 'Offset', '', 0],
    ],
    fixed: kFromNow,
  },
};

export class ReferenceForm {
  #kind = 'steps';
  #inputs = new Map();

  constructor(scope, signals) {
    this.scope = scope;
    this.fields = el('div', { class: 'form' });
    this.result = el('output', { class: 'result', role: 'status' });
    this.send = el('button', { type: 'button', class: 'main', text: 'Command it', onclick: () => this.#send() });
    this.element = section(
      'reference',
      'Reference',
      false,
      field(
        'Kind',
        choice(
          Object.entries(kKinds).map(([kind, { text }]) => [kind, text]),
          this.#kind,
          (kind) => {
            this.#kind = kind;
            this.#build();
          },
          { 'data-name': 'kind' },
        ),
      ),
      this.fields,
      el('p', { class: 'hint', text: 'The arm moves. Limits of the position loop hold.' }),
      el('div', { class: 'row' }, this.send),
      this.result,
    );
    this.element.hidden = true;
    signals.on('tuning', (message) => {
      this.element.hidden = !(
        message.control === true &&
        scope.control &&
        message.entries?.some(({ key }) => key.startsWith('reference.'))
      );
    });
    signals.on('link', () => {
      this.send.disabled = scope.link.state !== 'open';
    });
    this.#build();
  }

  #build() {
    this.#inputs.clear();
    this.fields.replaceChildren(
      ...kKinds[this.#kind].keys.map(([key, label, unit, first]) => {
        const input = el('input', {
          type: 'number',
          step: 'any',
          value: String(first),
          'data-key': `reference.${key}`,
        });
        this.#inputs.set(key, input);
        return field(label, input, unit || this.scope.channel('arm_ref')?.unit || '');
      }),
    );
  }

  async #send() {
    const set = [...this.#inputs].map(([key, input]) => `reference.${key}=${input.value}`);
    const entries = [`reference.kind=${this.#kind}`, ...set, ...kKinds[this.#kind].fixed];
    try {
      const reply = await this.scope.link.request({ op: 'set', run: this.scope.run?.run ?? 0, entries });
      setText(
        this.result,
        reply.ok
          ? `Accepted. ${reply.text ?? ''}${reply.data?.tick !== undefined ? ` From tick ${reply.data.tick}.` : ''}`
          : `Refused: ${reply.text}`,
      );
      this.result.dataset.state = reply.ok ? 'good' : 'bad';
    } catch (error) {
      setText(this.result, `Not known whether it acts: ${error.message}`);
      this.result.dataset.state = 'bad';
    }
  }
}
