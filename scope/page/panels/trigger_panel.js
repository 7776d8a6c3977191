// The trigger as on an oscilloscope: what it waits for, how it goes on, and what it does at the moment.

import { choice, el, field, setText } from '../dom.js';
import { kCauses, kEdges, kModes, offeredHysteresis } from '../settings/trigger_settings.js';
import { factorOf, unitOf } from '../settings/units.js';
import { section } from './section.js';

const kCauseNames = { level: 'a level', fault: 'a fault', step: 'a step of the reference' };
const kEdgeNames = { rising: 'rising ↗', falling: 'falling ↘', either: 'either ↕' };
const kStates = { armed: 'waiting', triggered: 'triggered', stopped: 'stopped', auto: 'free running' };

export class TriggerPanel {
  constructor(scope, trigger, display, signals) {
    Object.assign(this, { scope, trigger, display });
    this.state = el('output', { class: 'state', 'aria-label': 'trigger state' });
    this.body = el('div', { class: 'form' });
    this.element = section('trigger', 'Trigger', true, this.body);
    for (const name of ['run', 'layout', 'preferences', 'runs']) signals.on(name, () => this.#build());
    signals.on('trigger', () => this.#show());
    this.#build();
  }

  #number(name, label, unit, factor = 1, step = 'any') {
    const input = el('input', {
      type: 'number',
      step,
      value: String(Number((this.trigger.settings[name] * factor).toPrecision(6))),
      'data-name': name,
      onchange: (event) =>
        this.trigger.change({ [name]: event.target.value === '' ? NaN : Number(event.target.value) / factor }),
    });
    return field(label, input, unit);
  }

  #build() {
    if (this.body.contains(document.activeElement) && document.activeElement.matches('input, select')) {
      this.#show();
      return;
    }
    const { settings } = this.trigger;
    const { si } = this.scope.preferences;
    const channel = this.scope.channel(settings.channel);
    const unit = channel ? unitOf(channel, si) : '';
    const factor = channel ? factorOf(channel, si) : 1;
    const level = settings.on === 'level';
    this.switch = el('button', {
      type: 'button',
      class: 'main',
      onclick: () => (this.trigger.on ? this.trigger.stop() : this.trigger.start()),
    });
    this.arm = el('button', { type: 'button', text: 'Arm again', onclick: () => this.trigger.arm() });
    this.body.replaceChildren(
      field(
        'On',
        choice(
          kCauses.map((one) => [one, kCauseNames[one]]),
          settings.on,
          (on) => this.#change({ on }),
          { 'data-name': 'on' },
        ),
      ),
      ...(level
        ? [
            field(
              'Channel',
              choice(
                (this.scope.run?.channels ?? []).map((one) => [one.id, one.id]),
                settings.channel,
                (id) => this.#channel(id),
                { 'data-name': 'channel' },
              ),
            ),
            field(
              'Edge',
              choice(
                kEdges.map((one) => [one, kEdgeNames[one]]),
                settings.edge,
                (edge) => this.#change({ edge }),
                { 'data-name': 'edge' },
              ),
            ),
            this.#number('level', 'Level', unit, factor),
            this.#number('hysteresis', 'Hysteresis', unit, factor),
          ]
        : []),
      this.#number('holdoff', 'Hold-off', 's'),
      this.#number('pre', 'Pre-trigger', '%', 100),
      this.#number('span', 'Length', 's'),
      field(
        'Mode',
        choice(
          kModes.map((one) => [one, one]),
          settings.mode,
          (mode) => this.#change({ mode }),
          { 'data-name': 'mode' },
        ),
      ),
      el('div', { class: 'row' }, this.switch, this.arm, this.state),
    );
    this.#show();
  }

  // Channels change their unit, so the form is made anew.
  #channel(id) {
    const value = this.display.frame().bins;
    const min = value.min[id];
    const changes = { channel: id };
    if (min && min.length > 0) {
      let low = Infinity;
      let high = -Infinity;
      for (let i = 0; i < min.length; i += 1) {
        if (min[i] < low) low = min[i];
        if (value.max[id][i] > high) high = value.max[id][i];
      }
      if (low < high)
        Object.assign(changes, {
          level: Number(((low + high) / 2).toPrecision(3)),
          hysteresis: offeredHysteresis(low, high),
        });
    }
    this.#change(changes);
  }

  #change(changes) {
    this.trigger.change(changes);
    document.activeElement?.blur?.();
    this.#build();
  }

  #show() {
    const { trigger } = this;
    setText(this.switch, trigger.on ? 'Trigger off' : 'Trigger on');
    this.switch.disabled = !this.scope.live;
    this.switch.title = this.scope.live ? 'T' : 'The trigger watches a running stack; in a log, seek and zoom';
    this.arm.disabled = !trigger.on || trigger.settings.mode !== 'single';
    const level = this.body.querySelector('[data-name=level]');
    if (level && document.activeElement !== level) level.value = String(Number(trigger.levelShown().toPrecision(6)));
    const error = trigger.error;
    setText(
      this.state,
      error ||
        (trigger.on
          ? `${kStates[trigger.state] ?? trigger.state}${trigger.captures ? `, ${trigger.captures} caught` : ''}${trigger.text ? `: ${trigger.text}` : ''}`
          : this.scope.live
            ? 'off'
            : 'live runs only'),
    );
    this.state.dataset.state = error ? 'bad' : trigger.on ? trigger.state : '';
  }
}
