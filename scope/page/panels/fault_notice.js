// Faults that hold the stack now, at the top of the page: the list of events tells what has been, this what
// is.

import { activeFaults } from '../settings/active_faults.js';

const kShortest_s = 0.3; // shorter ones are in the list; here they would only flicker

export class FaultNotice {
  constructor(scope, signals, notice) {
    Object.assign(this, { scope, notice });
    for (const name of ['clock', 'run', 'restart']) signals.on(name, () => this.#show());
  }

  #show() {
    const { run } = this.scope;
    const faults =
      run?.kind === 'live' && run.running !== false
        ? activeFaults(this.scope.eventsOf()).filter(
            (event) => event.kind === 'fault' && run.last - event.t > kShortest_s,
          )
        : [];
    if (faults.length === 0) {
      this.notice.clear('fault');
      return;
    }
    const words = faults.map((one) => [one.source, one.code, one.text].filter(Boolean).join(': ')).join('; ');
    this.notice.say(
      'fault',
      `${faults.length === 1 ? 'A fault holds' : `${faults.length} faults hold`} the voltage at zero: ${words}`,
      'bad',
    );
  }
}
