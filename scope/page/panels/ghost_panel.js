// The ghost: the model that runs beside the rig, driven by the voltage that was sent. And any other run laid over this
// one, with a shift in time.

import { el, field, setText } from '../dom.js';
import { baseName } from '../settings/run_name.js';
import { section } from './section.js';

const kResync_s = 0.5;
const kReach_s = 5;                   // of the slider, either way

export class GhostPanel {
  constructor(scope, overlay, signals) {
    Object.assign(this, { scope, overlay });
    this.on = el('input', { type: 'checkbox', onchange: () => this.toggle() });
    this.resync = el('input', { type: 'checkbox', checked: true, onchange: () => this.#send() });
    this.sync = el('button', { type: 'button', text: 'Sync now', onclick: () => scope.link.send({ op: 'ghost_sync', run: scope.run.run }) });
    this.why = el('p', { class: 'hint' });
    this.other = el('select', { onchange: () => overlay.lay(this.other.value === '' ? null : Number(this.other.value)) });
    this.slider = el('input', { type: 'range', min: -kReach_s, max: kReach_s, step: 0.001, value: '0', 'aria-label': 'Shift of the other run, s', oninput: () => this.#shift(this.slider.value) });
    this.number = el('input', { type: 'number', step: 'any', value: '0', onchange: () => this.#shift(this.number.value) });
    this.element = section('ghost', 'Ghost and overlay', false,
      el('label', { class: 'check' }, this.on, 'Model beside the rig (dashed), residual below'),
      el('label', { class: 'check' }, this.resync, `set to the measured state every ${kResync_s} s`), el('div', { class: 'row' }, this.sync), this.why,
      field('Lay over', this.other), field('Shift', this.number, 's'), this.slider);
    for (const name of ['runs', 'run', 'layout']) signals.on(name, () => this.#show());
    // The ghost's channels are there once it has values: then its pane comes.
    signals.on('op:runs', () => {
      const has_values = scope.known.some((id) => id.startsWith('ghost.'));
      if (scope.ghost && has_values && !this.had_values) scope.setGhost(true);
      this.had_values = has_values;
    });
    signals.on('link', ({ state }) => { if (state === 'open' && scope.ghost) this.#send(); });
    signals.on('restart', () => { if (scope.ghost) this.#send(); });
  }

  async toggle(on = this.on.checked) {
    const { scope } = this;
    if (!scope.run) return;
    this.on.checked = on;
    this.why.textContent = '';
    if (scope.ghost !== on) scope.setGhost(on);
    this.#send();
  }

  async #send() {
    const { scope } = this;
    if (!scope.run) return;
    try {
      const reply = await scope.link.request({ op: 'ghost', run: scope.run.run, on: scope.ghost, resync_s: this.resync.checked ? kResync_s : 0 });
      if (!reply.ok) {
        setText(this.why, `No ghost: ${reply.text}`);
        if (scope.ghost) scope.setGhost(false);
      }
    } catch (error) {
      setText(this.why, `No ghost: ${error.message}`);
    }
    this.#show();
  }

  #shift(text) {
    const shift = Number(text);
    if (text === '' || !Number.isFinite(shift)) return;
    this.slider.value = String(shift);
    if (document.activeElement !== this.number) this.number.value = String(shift);
    this.overlay.setShift(shift);
  }

  #show() {
    const { scope } = this;
    this.on.checked = scope.ghost;
    this.sync.disabled = !scope.ghost;
    const others = scope.runs.filter((one) => one.run !== scope.run?.run);
    this.other.replaceChildren(el('option', { value: '', text: others.length > 0 ? 'nothing' : 'nothing (drop a log on the page)' }),
      ...others.map((one) => el('option', { value: String(one.run), text: `${baseName(one.name)}${one.kind === 'past' ? ' (before the restart)' : ''}`, selected: one.run === this.overlay.number })));
    this.other.disabled = others.length === 0;
  }
}
