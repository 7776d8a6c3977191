// The reference from the page: its kind and its numbers, sent as one set of reference.* keys. The kinds'
// numbers are those of docs/configuration.md.

import { choice, el, field, setText } from '../dom.js';
import { section } from './section.js';

// A reference that is set while the stack runs counts its time from the tick at which it takes effect.
const kFromNow = ['reference.start_s=0'];

// name -> {text, keys: [[key, label, unit or '' for the signal's, first value]], fixed: entries that go with
// them}
const kKinds = {
  // A new reference is reached from where the old one is, on a straight line within limits.return_s.
  steps: { text: 'go to', keys: [['initial', 'Value', '', 0]], fixed: ['reference.steps=[]'] },
  // So it waits there for that time, and jumps then.
  sharp: { text: 'step to', kind: 'steps', keys: [['to', 'Value', '', 0]], entries: sharpStep },
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

// now: the reference as it is; return_s: limits.return_s.
export function sharpStep({ to }, now, return_s) {
  const at = Number((return_s + 0.1).toPrecision(6));
  return [`reference.initial=${now}`, `reference.steps=[[${at}, ${to}]]`];
}

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
      el('p', { class: 'hint', text: 'The machine may move. Limits of the position loop hold.' }),
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

  // Of what the new reference begins from.
  async #referenceNow() {
    const { run, link } = this.scope;
    const { ok, text, data } = await link.request({ op: 'values', run: run.run, channels: ['arm_ref'], t: run.last });
    const now = data?.values?.[0];
    if (!ok || typeof now !== 'number') throw new Error(text || 'the reference is not known');
    return now;
  }

  async #entries() {
    const chosen = kKinds[this.#kind];
    const kind = `reference.kind=${chosen.kind ?? this.#kind}`;
    const numbers = Object.fromEntries([...this.#inputs].map(([key, input]) => [key, input.value]));
    if (chosen.entries) {
      const now = await this.#referenceNow();
      return [kind, ...chosen.entries(numbers, now, this.scope.run.limits?.return_s ?? 0.5)];
    }
    return [kind, ...Object.entries(numbers).map(([key, value]) => `reference.${key}=${value}`), ...chosen.fixed];
  }

  async #send() {
    try {
      const entries = await this.#entries();
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
