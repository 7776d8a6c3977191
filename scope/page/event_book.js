// The events of all runs, each once, in the order of their numbers. The server numbers them per run, sends all that it
// keeps at each connection, and begins at 1 again when the stack was started again.

const kMost = 2000;

export class EventBook {
  #runs = new Map(); // run -> [event]

  // False when it is known already.
  add(event) {
    const list = this.#runs.get(event.run) ?? [];
    const known = list.find((one) => one.n === event.n);
    if (known && known.t === event.t && known.kind === event.kind && known.text === event.text) return false;
    // What was before a restart belongs to another run now, which the server lists as a past one.
    const kept = known || event.kind === 'restart' ? [] : list;
    kept.push(event);
    if (kept.length > kMost) kept.shift();
    this.#runs.set(event.run, kept);
    return true;
  }

  of(run) {
    return this.#runs.get(run) ?? [];
  }

  clear() {
    this.#runs.clear();
  }
}
