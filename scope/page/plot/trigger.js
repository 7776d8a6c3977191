// The trigger: its settings, the server that waits for it, and what it caught.

import { defaultTrigger, triggerError, triggerMessage } from '../settings/trigger_settings.js';
import { factorOf } from '../settings/units.js';
import { binsOf } from './bin_store.js';

export class Trigger {
  settings = defaultTrigger();
  on = false;
  state = ''; // armed, triggered, stopped, auto
  text = '';
  captures = 0;
  #id = null;
  #channels = [];
  #catalogue = new Map(); // the triggers' times by id, as the state message tells them

  constructor(scope, display, signals) {
    this.scope = scope;
    this.display = display;
    this.signals = signals;
    signals.on('level', ({ value }) => this.setLevelShown(value));
    signals.on('op:trigger', (message) => this.#told(message));
    signals.on('capture', (frame) => this.#caught(frame));
    signals.on('link', ({ state }) => {
      if (state === 'open' && this.on) this.start();
    });
    signals.on('layout', () => {
      if (this.on) this.start();
    });
    signals.on('run', () => this.stop());
    signals.on('restart', () => {
      if (this.on) this.start();
    });
  }

  // Why the settings cannot be used, or ''.
  get error() {
    return triggerError(this.settings);
  }

  change(changes) {
    Object.assign(this.settings, changes);
    if (this.on && !this.error) this.start();
    this.signals.emit('trigger');
    this.signals.emit('draw');
  }

  start() {
    if (this.error || !this.scope.run) return;
    this.#release();
    this.on = true;
    this.state = 'armed';
    this.text = '';
    this.#id = this.scope.link.nextId();
    const { channel, on } = this.settings;
    this.#channels = [...new Set([...this.scope.wanted(), ...(on === 'level' ? [channel] : [])])];
    this.scope.link.send(
      triggerMessage(this.settings, this.#id, this.scope.run.run, this.#channels, Math.round(this.display.pixels)),
    );
    if (this.display.mode !== 'trigger') this.display.trigger();
    this.signals.emit('trigger');
  }

  // A single trigger that has caught something waits for the next.
  arm() {
    if (this.#id === null) {
      this.start();
      return;
    }
    this.state = 'armed';
    this.scope.link.send({ op: 'arm', id: this.#id });
    this.signals.emit('trigger');
  }

  stop() {
    this.#release();
    this.on = false;
    this.state = '';
    if (this.display.mode === 'trigger') this.display.follow();
    this.signals.emit('trigger');
  }

  // What the panes draw: {t, channel, level}, each null where it does not apply.
  drawn() {
    if (!this.on) return null;
    const { on, channel, level } = this.settings;
    return {
      t: this.display.mode === 'trigger' ? (this.display.capture?.t ?? null) : null,
      channel,
      level: on === 'level' ? level : null,
    };
  }

  // The level in the units shown, and back.
  levelShown() {
    return this.settings.level * this.#factor();
  }
  setLevelShown(value) {
    this.change({ level: Number((value / this.#factor()).toPrecision(4)) });
  }

  #factor() {
    const channel = this.scope.channel(this.settings.channel);
    return channel ? factorOf(channel, this.scope.preferences.si) : 1;
  }

  #release() {
    if (this.#id !== null) this.scope.link.send({ op: 'untrigger', id: this.#id });
    this.#id = null;
  }

  #told(message) {
    if (message.id !== this.#id) return;
    this.state = message.state;
    this.text = message.text ?? '';
    if (typeof message.t === 'number') this.#catalogue.set(message.id, message.t);
    this.signals.emit('trigger');
  }

  #caught(frame) {
    if (frame.id !== this.#id || frame.min.length !== this.#channels.length) return;
    this.captures += 1;
    const { pre, span } = this.settings;
    const t = this.#timeOf(frame, pre * span);
    this.display.show({
      t,
      t0: t - pre * span,
      t1: t + (1 - pre) * span,
      bins: binsOf(frame, this.#channels, this.scope.run.rate_hz),
      count: this.captures,
    });
    this.signals.emit('trigger');
  }

  // The frame begins with a whole bin, so the exact time is the one that the state message tells, where it
  // came first.
  #timeOf(frame, pre_s) {
    const told = this.#catalogue.get(frame.id);
    const near = frame.t0 + pre_s;
    return told !== undefined && Math.abs(told - near) < 2 * frame.width + 1e-9 ? told : near;
  }
}
