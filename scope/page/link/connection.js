// The web socket to the server: requests with their replies, frames with their owners, and a connection that
// comes back by itself. Signals: "link" {state, text}, "op:NAME" message, "bins" frame, "capture" frame.
// States: connecting, open, stuck (nothing arrives), lost (tries again), refused (the token is wrong).

import { BackOff } from './back_off.js';
import { decodeBins, kAnswer, kCapture } from './frames.js';

const kProtocol = 'hydro.scope.v1';
const kRequest_ms = 10000;
const kPing_ms = 2000;
const kStuck_ms = 5000;
const kDead_ms = 12000;

export class Connection {
  #signals;
  #api;
  #socket = null;
  #wait = new BackOff();
  #pending = new Map(); // id -> {done, fail, timer}
  #last_id = 0;
  #heard_ms = 0;
  #state = '';
  #was_open = false;

  constructor(signals, api) {
    this.#signals = signals;
    this.#api = api;
    setInterval(() => this.#watch(), 1000);
  }

  get state() {
    return this.#state;
  }

  nextId() {
    this.#last_id += 1;
    return this.#last_id;
  }

  open() {
    this.#tell('connecting', this.#was_open ? 'connecting again' : 'connecting');
    const scheme = location.protocol === 'https:' ? 'wss' : 'ws';
    const socket = new WebSocket(
      `${scheme}://${location.host}/live?token=${encodeURIComponent(this.#api.token)}`,
      kProtocol,
    );
    socket.binaryType = 'arraybuffer';
    this.#socket = socket;
    socket.onopen = () => this.#opened();
    socket.onmessage = (event) => {
      if (socket === this.#socket) this.#receive(event.data);
    };
    socket.onclose = () => {
      if (socket === this.#socket) this.#closed();
    };
  }

  // False when there is no connection; then nothing is sent later.
  send(message) {
    if (this.#socket?.readyState !== WebSocket.OPEN) return false;
    this.#socket.send(JSON.stringify(message));
    return true;
  }

  // The reply {ok, text, data}, or, for a "get", the frame. Fails with an Error when there is no connection,
  // or no answer within patience_ms.
  request(message, patience_ms = kRequest_ms) {
    const id = this.nextId();
    return new Promise((done, fail) => {
      const timer = setTimeout(
        () => this.#fail(id, `the server did not answer within ${patience_ms / 1000} s`),
        patience_ms,
      );
      this.#pending.set(id, { done, fail, timer });
      if (!this.send({ ...message, id })) this.#fail(id, 'no connection to hydro-scope');
    });
  }

  #opened() {
    this.#wait.reset();
    this.#was_open = true;
    this.#heard_ms = performance.now();
    this.#tell('open', 'connected');
  }

  #receive(data) {
    this.#heard_ms = performance.now();
    if (this.#state === 'stuck') this.#tell('open', 'connected');
    if (typeof data !== 'string') this.#frame(decodeBins(data));
    else {
      const message = JSON.parse(data);
      if (message.op === 'reply') this.#settle(message.id, message);
      else this.#signals.emit(`op:${message.op}`, message);
    }
  }

  #frame(frame) {
    if (frame.flags & kAnswer) this.#settle(frame.id, frame);
    else this.#signals.emit(frame.flags & kCapture ? 'capture' : 'bins', frame);
  }

  #settle(id, answer) {
    const waiting = this.#pending.get(id);
    if (!waiting) return;
    this.#pending.delete(id);
    clearTimeout(waiting.timer);
    waiting.done(answer);
  }

  #fail(id, why) {
    const waiting = this.#pending.get(id);
    if (!waiting) return;
    this.#pending.delete(id);
    clearTimeout(waiting.timer);
    waiting.fail(new Error(why));
  }

  async #closed() {
    this.#socket = null;
    for (const id of [...this.#pending.keys()]) this.#fail(id, 'the connection to hydro-scope was lost');
    this.#tell('lost', 'no connection to hydro-scope: trying again');
    const refusal = await this.#api.refusal();
    if (refusal) this.#tell('refused', refusal);
    else setTimeout(() => this.open(), this.#wait.next());
  }

  // A socket may stand open while nothing comes through: ask, say so, and in the end begin anew.
  #watch() {
    if (this.#socket?.readyState !== WebSocket.OPEN) return;
    const silent = performance.now() - this.#heard_ms;
    if (silent > kDead_ms) {
      const socket = this.#socket;
      socket.onclose = null;
      socket.close();
      this.#closed();
      return;
    }
    if (silent > kStuck_ms) this.#tell('stuck', `hydro-scope has been silent for ${Math.round(silent / 1000)} s`);
    if (silent > kPing_ms) this.send({ op: 'ping', id: this.nextId() });
  }

  #tell(state, text) {
    this.#state = state;
    this.#signals.emit('link', { state, text });
  }
}
