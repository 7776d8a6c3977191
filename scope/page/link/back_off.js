// How long to wait before the next attempt to connect: soon at first, never longer than two seconds, as the
// server is on this machine and a person waits for the picture.

const kFirst_ms = 250;
const kLongest_ms = 2000;

export class BackOff {
  #next = kFirst_ms;

  next() {
    const wait = this.#next;
    this.#next = Math.min(kLongest_ms, this.#next * 2);
    return wait;
  }

  reset() {
    this.#next = kFirst_ms;
  }
}
