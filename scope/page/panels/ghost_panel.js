// The ghost: the model that runs beside the rig, driven by the voltage that was sent. And any other run laid
// over this one, with a shift in time.

import { el, field, setText } from '../dom.js';
import { baseName } from '../settings/run_name.js';
import { section } from './section.js';

const kResync_s = 0.5;
const kReach_s = 5; // of the slider, either way, around the number last given

export class GhostPanel {
  constructor(scope, display, overlay, signals) {
    Object.assign(this, { scope, display, overlay });
    this.on = el('input', { type: 'checkbox', onchange: () => this.toggle() });
    this.resync = el('input', { type: 'checkbox', checked: true, onchange: () => this.#send() });
    this.sync = el('button', {
      type: 'button',
      text: 'Sync now',
      onclick: () => scope.link.send({ op: 'ghost_sync', run: scope.run.run }),
    });
    this.middle = 0;
    this.said = el('output', { class: 'result', role: 'status' });
    this.why = el('p', { class: 'hint' });
    this.other = el('select', {
      onchange: () => overlay.lay(this.other.value === '' ? null : Number(this.other.value)),
    });
    this.slider = el('input', {
      type: 'range',
      min: -kReach_s,
      max: kReach_s,
      step: 0.001,
      value: '0',
      'aria-label': 'Shift of the other run, s',
      oninput: () => this.#set(this.middle + Number(this.slider.value)),
    });
    this.number = el('input', {
      type: 'number',
      step: 'any',
      value: '0',
      onchange: () => this.#centre(this.number.value === '' ? NaN : Number(this.number.value)),
    });
    this.here = el('button', {
      type: 'button',
      text: 'Begin here',
      title: 'Shift its start to the left of the window',
      onclick: () => this.#centre(display.frame().t0 - overlay.run.first),
    });
    this.steps = el('button', {
      type: 'button',
      text: 'Align steps',
      title: 'Shift its first step of the reference onto the first one in the window',
      onclick: () => this.#alignSteps(),
    });
    this.element = section(
      'ghost',
      'Ghost and overlay',
      false,
      el('label', { class: 'check' }, this.on, 'Model beside the rig (dashed), residual below'),
      el('label', { class: 'check' }, this.resync, `set to the measured state every ${kResync_s} s`),
      el('div', { class: 'row' }, this.sync),
      this.why,
      field('Lay over', this.other),
      field('Shift', this.number, 's'),
      this.slider,
      el('div', { class: 'row' }, this.here, this.steps),
      this.said,
    );
    for (const name of ['runs', 'run', 'layout', 'overlay']) signals.on(name, () => this.#show());
    // The ghost's channels are there once it has values: then its pane comes.
    signals.on('op:runs', () => {
      const has_values = scope.known.some((id) => id.startsWith('ghost.'));
      if (scope.ghost && has_values && !this.had_values) scope.setGhost(true);
      this.had_values = has_values;
    });
    signals.on('link', ({ state }) => {
      if (state === 'open' && scope.ghost) this.#send();
    });
    signals.on('restart', () => {
      if (scope.ghost) this.#send();
    });
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
      const reply = await scope.link.request({
        op: 'ghost',
        run: scope.run.run,
        on: scope.ghost,
        resync_s: this.resync.checked ? kResync_s : 0,
      });
      if (!reply.ok) {
        setText(this.why, `No ghost: ${reply.text}`);
        if (scope.ghost) scope.setGhost(false);
      }
    } catch (error) {
      setText(this.why, `No ghost: ${error.message}`);
    }
    this.#show();
  }

  // Around this shift the slider moves from now on.
  #centre(shift) {
    if (!Number.isFinite(shift)) return;
    this.middle = shift;
    this.slider.value = '0';
    this.#set(shift);
  }

  #set(shift) {
    const rounded = Number(shift.toFixed(6));
    if (document.activeElement !== this.number) this.number.value = String(rounded);
    this.overlay.setShift(rounded);
  }

  #alignSteps() {
    const { t0, t1 } = this.display.frame();
    const steps = (run) =>
      this.scope
        .eventsOf(run)
        .filter((event) => event.kind === 'step')
        .map((event) => event.t)
        .sort((a, b) => a - b);
    const here = steps(this.scope.run).find((t) => t >= t0 && t <= t1);
    const there = steps(this.overlay.run)[0];
    const missing =
      here === undefined
        ? 'no step of the reference in the window'
        : there === undefined
          ? 'the other run has no step of its reference'
          : '';
    setText(this.said, missing);
    if (!missing) this.#centre(here - there);
  }

  #show() {
    const { scope } = this;
    this.on.checked = scope.ghost;
    this.sync.disabled = !scope.ghost;
    const others = scope.runs.filter((one) => one.run !== scope.run?.run);
    this.other.replaceChildren(
      el('option', { value: '', text: others.length > 0 ? 'nothing' : 'nothing (drop a log on the page)' }),
      ...others.map((one) =>
        el('option', {
          value: String(one.run),
          text: `${baseName(one.name)}${one.kind === 'past' ? ' (before the restart)' : ''}`,
          selected: one.run === this.overlay.number,
        }),
      ),
    );
    this.other.disabled = others.length === 0;
    for (const one of [this.number, this.slider, this.here, this.steps]) one.disabled = this.overlay.run === null;
  }
}
