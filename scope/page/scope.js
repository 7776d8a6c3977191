// What the page knows: the runs, the one that is looked at, its events, its layout, and the user's
// preferences. Signals: "runs", "run" (another one is shown), "layout", "preferences", "clock", "events",
// "restart", "tuning" and "processes" (of the run that is shown).

import { EventBook } from './event_book.js';
import * as layouts from './settings/layout.js';
import { baseName } from './settings/run_name.js';
import { loadPreferences, savePreferences } from './settings/preferences.js';

// Messages about one run, of which the newest holds: those of the run that is shown are told on under their own names.
const kOfARun = ['tuning', 'processes'];

export class Scope {
  hello = null;
  runs = [];
  run = null; // the RUN shown
  layout = { panes: [] };
  events = new EventBook();
  ghost = false;
  #told = Object.fromEntries(kOfARun.map((name) => [name, new Map()])); // name -> run -> the newest message

  constructor(link, api, signals, storage) {
    this.link = link;
    this.api = api;
    this.signals = signals;
    this.storage = storage;
    this.preferences = loadPreferences(storage);
    signals.on('op:hello', (message) => this.#greeted(message));
    signals.on('op:runs', (message) => this.#setRuns(message.runs));
    signals.on('op:clock', (message) => this.#tick(message));
    signals.on('op:event', (message) => this.#event(message));
    for (const name of kOfARun) {
      signals.on(`op:${name}`, (message) => {
        this.#told[name].set(message.run ?? 0, message);
        if ((message.run ?? 0) === this.run?.run) signals.emit(name, message);
      });
    }
  }

  get live() {
    return this.run?.kind === 'live';
  }
  get control() {
    return this.hello?.control === true;
  }
  get known() {
    return (this.run?.channels ?? []).map((channel) => channel.id);
  }

  channel(id, run = this.run) {
    return run?.channels.find((channel) => channel.id === id);
  }

  eventsOf(run = this.run) {
    return run ? this.events.of(run.run) : [];
  }

  // Channels that the panes need, and the ghost's of those that are measured.
  wanted() {
    const shown = layouts.channelsOf(this.layout).filter((id) => this.known.includes(id));
    const ghosts = this.ghost ? shown.map((id) => `ghost.${id}`).filter((id) => this.known.includes(id)) : [];
    return [...new Set([...shown, ...ghosts])];
  }

  select(number) {
    const run = this.runs.find((one) => one.run === number);
    if (!run || run === this.run) return;
    this.run = run;
    this.layout = layouts.loadLayout(this.storage, baseName(run.name)) ?? layouts.defaultLayout(this.known);
    this.ghost = false;
    this.signals.emit('run', run);
    this.signals.emit('layout');
    for (const name of kOfARun)
      this.signals.emit(name, this.#told[name].get(number) ?? { run: number, entries: [], list: [] });
  }

  setLayout(layout) {
    this.layout = layout;
    layouts.saveLayout(this.storage, baseName(this.run.name), layout);
    this.signals.emit('layout');
  }

  resetLayout() {
    layouts.forgetLayout(this.storage, baseName(this.run.name));
    this.layout = layouts.defaultLayout(this.known);
    this.signals.emit('layout');
  }

  setGhost(on) {
    this.ghost = on;
    this.setLayout(on ? layouts.withResiduals(this.layout, this.known) : layouts.withoutResiduals(this.layout));
  }

  prefer(changes) {
    Object.assign(this.preferences, changes);
    savePreferences(this.storage, this.preferences);
    this.signals.emit('preferences', changes);
  }

  #greeted(message) {
    this.hello = message;
    this.events.clear(); // the server sends all that it keeps again
    this.#setRuns(message.runs);
    this.signals.emit('hello', message);
    this.signals.emit('events');
  }

  #setRuns(runs) {
    const shown = this.run;
    this.runs = runs;
    const again = runs.find((one) => one.run === shown?.run && one.kind === shown.kind && one.name === shown.name);
    if (!again) {
      this.run = null;
      this.select((runs.find((one) => one.kind === 'live') ?? runs[0])?.run);
    } else {
      const fewer = shown.channels.length !== again.channels.length;
      this.run = again;
      if (shown.session !== again.session) this.signals.emit('restart', again);
      if (fewer || this.layout.panes.length === 0) this.#channelsChanged();
    }
    this.signals.emit('runs');
  }

  #channelsChanged() {
    const kept = layouts.loadLayout(this.storage, baseName(this.run.name));
    this.layout = kept ?? layouts.defaultLayout(this.known);
    if (this.ghost) this.layout = layouts.withResiduals(this.layout, this.known);
    this.signals.emit('layout');
  }

  #tick(message) {
    const run = this.runs.find((one) => one.run === message.run);
    if (!run) return;
    run.last = message.last;
    if (typeof message.first === 'number') run.first = message.first;
    run.running = message.running;
    run.silent_s = message.silent_s;
    if (run === this.run) this.signals.emit('clock', run);
  }

  #event(event) {
    if (!this.events.add(event)) return;
    this.signals.emit('event', event);
    if (event.run === this.run?.run) this.signals.emit('events');
  }
}
