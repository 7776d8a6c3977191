// How the connection stands: with the server, with the stack behind it, and what was dropped on the way.

import { byId, el, setText } from '../dom.js';
import { keepToken, tokenIn } from '../link/token.js';

const kWords = {
  connecting: 'connecting',
  open: 'connected',
  stuck: 'no data',
  lost: 'no connection',
  refused: 'refused',
};
const kSilent_s = 1;

export class LinkPanel {
  constructor(scope, link, api, signals, notice) {
    Object.assign(this, { scope, link, api, signals, notice });
    signals.on('link', (news) => this.#link(news));
    signals.on('clock', (run) => this.#clock(run));
    signals.on('run', () => this.#lamp());
    signals.on('op:dropped', (message) => this.#drop(message));
    signals.on('restart', () =>
      this.notice.say('restart', 'The stack was started again: its time begins anew.', 'info', [
        { text: 'Dismiss', act: () => this.notice.clear('restart') },
      ]),
    );
  }

  #link({ state, text }) {
    this.#lamp();
    this.notice.clear('silent');
    if (state === 'open') {
      this.notice.clear('link');
      return;
    }
    if (state === 'refused') this.notice.say('link', text, 'bad', [], this.#tokenField());
    else if (state === 'lost')
      this.notice.say('link', 'No connection to hydro-scope: what is shown is old. Trying again by itself.', 'bad');
    else if (state === 'stuck') this.notice.say('link', `${text}: what is shown may be old.`, 'warn');
  }

  #clock(run) {
    if (this.link.state !== 'open') return;
    if (run.kind === 'live' && run.silent_s > kSilent_s) {
      const what =
        run.running === false ? 'The run has ended' : `The stack has been silent for ${Math.round(run.silent_s)} s`;
      this.notice.say('silent', `${what}. The page goes on by itself when the stack is started again.`, 'warn');
    } else this.notice.clear('silent');
    this.#lamp();
  }

  #lamp() {
    const { run } = this.scope;
    const { state } = this.link;
    const silent = run?.kind === 'live' && run.silent_s > kSilent_s;
    const lamp = byId('link');
    const stale = String(run?.kind === 'live' && (silent || state !== 'open'));
    if (document.body.dataset.stale !== stale) {
      document.body.dataset.stale = stale;
      this.signals.emit('silence');
    }
    const shown = state === 'open' && silent ? 'stuck' : state === 'open' && run?.kind === 'log' ? 'log' : state;
    lamp.dataset.state = shown;
    const words =
      state !== 'open'
        ? kWords[state]
        : silent
          ? run.running === false
            ? 'run ended'
            : 'stack silent'
          : run?.kind === 'log'
            ? 'log'
            : run
              ? 'live'
              : 'waiting for a stack';
    setText(lamp, words ?? state);
  }

  // The server counts from the start of the connection.
  #drop(dropped) {
    const output = byId('dropped');
    output.hidden = false;
    setText(output, `dropped ${dropped.frames} frames`);
    output.title =
      `This browser was too slow: ${dropped.frames} frames with ${dropped.bins} bins were not sent. ` +
      "Nothing is missing in the server's history: pause or zoom to see it.";
  }

  #tokenField() {
    const input = el('input', {
      'aria-label': 'Token or address',
      placeholder: 'address or token',
      autocomplete: 'off',
      spellcheck: 'false',
    });
    const use = () => {
      const token = tokenIn(input.value);
      if (!token) {
        input.setAttribute('aria-invalid', 'true');
        return;
      }
      this.api.token = token;
      keepToken(token, sessionStorage);
      this.notice.clear('link');
      this.link.open();
    };
    input.addEventListener('keydown', (event) => {
      if (event.key === 'Enter') use();
    });
    return el('span', { class: 'row' }, input, el('button', { type: 'button', text: 'Connect', onclick: use }));
  }
}
