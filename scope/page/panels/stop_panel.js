// STOP and re-arm. One press sends STOP; it is repeated until the server confirms that the stack has stopped
// with its output at zero, or the user says that this is no longer wanted. Re-arming says what it will do
// before it does it.

import { byId, el } from '../dom.js';
import { activeFaults } from '../settings/active_faults.js';
import { showDialog } from './dialog.js';

const kAgain_ms = 500;
const kForecast_ms = 6000; // a stack describes itself once a second; of one that is silent nothing is known after 2.5 s
const kPatience_ms = 5000; // a stack takes a second or two to end; then STOP is sent again

export class StopPanel {
  #trying = false;
  #state = ''; // '', asked, confirmed, failed

  constructor(scope, signals, notice) {
    this.scope = scope;
    this.notice = notice;
    this.stop = byId('stop');
    this.rearm = byId('rearm');
    this.stop.addEventListener('click', () => this.press());
    this.rearm.addEventListener('click', () => this.#askRearm());
    for (const name of ['run', 'runs', 'hello', 'link', 'silence']) signals.on(name, () => this.#show());
    signals.on('restart', () => this.#set('', ''));
    signals.on('event', (event) => {
      if (event.kind === 'rearm' && this.#state === 'confirmed') this.#set('', '');
    });
  }

  get run() {
    return this.scope.run?.kind === 'live' ? this.scope.run : this.scope.runs.find((one) => one.kind === 'live');
  }

  async press() {
    if (!this.run && this.scope.hello) {
      this.notice.say('stop', 'There is nothing to stop: this is a log, not a running stack.', 'info');
      return;
    }
    if (this.#trying) return;
    this.#trying = true;
    this.#set('asked', 'STOP is sent; not confirmed yet');
    while (this.#trying) {
      try {
        const reply = await this.scope.link.request({ op: 'stop' }, kPatience_ms);
        if (reply.ok) {
          this.#trying = false;
          this.#set('confirmed', (reply.text || 'the voltage is held at zero').replace(/^stopped: */i, ''));
          break;
        }
        this.#set('failed', `STOP is not confirmed: ${reply.text}. Trying again`);
      } catch (error) {
        this.#set(
          'failed',
          `STOP is not confirmed: ${error.message}. Trying again; use the rig's own switch if it must stop now`,
        );
      }
      await new Promise((done) => setTimeout(done, kAgain_ms));
    }
  }

  #giveUp() {
    this.#trying = false;
    this.#set('', '');
  }

  #set(state, text) {
    this.#state = state;
    if (state === '') this.notice.clear('stop');
    else {
      const kind = { asked: 'warn', confirmed: 'stopped', failed: 'bad' }[state];
      const actions =
        state === 'failed' || state === 'asked'
          ? [{ text: 'Stop trying', act: () => this.#giveUp() }]
          : [{ text: 'Dismiss', act: () => this.notice.clear('stop') }];
      this.notice.say('stop', state === 'confirmed' ? `STOPPED: ${text}` : text, kind, actions);
    }
    this.#show();
  }

  #show() {
    const log = this.scope.hello !== null && !this.run;
    this.stop.dataset.state = this.#state;
    // aria-disabled, not disabled: the button can still be reached, and says why it does nothing.
    this.stop.setAttribute('aria-disabled', String(log));
    this.stop.title = log
      ? 'This is a log: there is nothing to stop'
      : 'Zero volts at once, and the stack ends (S; F9 anywhere). hydro-launch starts it again';
    this.rearm.disabled = this.#whyNoRearm() !== '';
    this.rearm.title = this.#whyNoRearm() || 'End the latched faults that hold the voltage at zero';
  }

  #whyNoRearm() {
    if (!this.run) return 'This is a log: there is nothing to re-arm';
    if (this.run.running === false) return 'The stack is not running: hydro-launch starts it';
    if (!this.scope.control) return 'This page may not re-arm: [scope] control = true in the configuration allows it';
    if (this.scope.link.state !== 'open') return 'There is no connection to hydro-scope';
    return '';
  }

  // Where the machine would move to if it were re-armed now. The server works it out from the configuration in force: the
  // reference that is shown follows the arm while the voltage is held at zero.
  async #way() {
    const unknown = (why) => `Where the machine would move to is not known: ${why}.`;
    try {
      const { ok, text } = await this.scope.link.request({ op: 'rearm_forecast' }, kForecast_ms);
      return ok ? `If it were re-armed now: ${text}.` : unknown(text);
    } catch (error) {
      return unknown(error.message);
    }
  }

  // The reference may go on while the dialog is open.
  async #keepTelling(way) {
    while (way.isConnected && byId('dialog').open) {
      way.textContent = await this.#way();
      await new Promise((done) => setTimeout(done, kAgain_ms));
    }
  }

  async #askRearm() {
    const way = el('p', { class: 'strong way', text: await this.#way() });
    const faults = activeFaults(this.scope.eventsOf(this.run));
    const held =
      faults.length === 0 ? 'No fault is active that this page knows of.' : 'These hold the voltage at zero now:';
    showDialog(
      'Re-arm?',
      [
        el('p', {
          text: 'Re-arming ends every latched fault whose cause is gone (limits.rearm = "explicit"). The control loops then act again: from the next tick the motor gets the voltage that they ask for, and the reference comes back from where the arm is to where it would be by now.',
        }),
        way,
        el('p', { text: held }),
        ...(faults.length > 0
          ? [
              el(
                'ul',
                {},
                ...faults.map((fault) =>
                  el('li', { text: `${fault.source || 'stack'}: ${fault.code || ''} ${fault.text || ''}` }),
                ),
              ),
            ]
          : []),
        el('p', { class: 'strong', text: 'Look at the rig: nobody may be within the reach of the arm.' }),
      ],
      [
        { text: 'Leave it at zero', main: true },
        { text: 'Re-arm: the arm may move', act: () => this.#rearm() },
      ],
    );
    this.#keepTelling(way);
  }

  async #rearm() {
    try {
      const reply = await this.scope.link.request({ op: 'rearm' });
      if (reply.ok) this.#set('', '');
      this.notice.say(
        'rearm',
        reply.ok ? `Re-armed: ${(reply.text ?? '').replace(/^re-armed: */i, '')}` : `Not re-armed: ${reply.text}`,
        reply.ok ? 'info' : 'bad',
        [{ text: 'Dismiss', act: () => this.notice.clear('rearm') }],
      );
    } catch (error) {
      this.notice.say('rearm', `Not re-armed: ${error.message}`, 'bad', [
        { text: 'Dismiss', act: () => this.notice.clear('rearm') },
      ]);
    }
  }
}
