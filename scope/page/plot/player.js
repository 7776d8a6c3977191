// Plays a log: moves the head of the playback with the clock of the screen, at 0.1 to 10 times.

export const kSpeeds = [0.1, 0.2, 0.5, 1, 2, 5, 10];

export class Player {
  playing = false;
  speed = 1;
  #before_ms = 0;

  constructor(scope, display, signals) {
    Object.assign(this, { scope, display, signals });
    signals.on('run', () => this.pause());
    signals.on('view', () => {
      if (this.playing && display.mode !== 'follow') this.pause();
    });
  }

  // From the window's right end; from the start of the run when it stands at the end.
  play() {
    const { display } = this;
    if (this.scope.live || !this.scope.run) return;
    const shown = display.frame();
    const at = display.mode === 'follow' && display.head !== null ? display.head : Math.min(shown.t1, display.last);
    display.seek(at >= display.last - 1e-9 ? display.first : at);
    this.playing = true;
    this.#before_ms = performance.now();
    requestAnimationFrame(() => this.#advance());
    this.signals.emit('playing');
  }

  pause() {
    if (!this.playing) return;
    this.playing = false;
    this.signals.emit('playing');
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  setSpeed(speed) {
    this.speed = speed;
  }

  // One sample on or back.
  step(samples) {
    this.pause();
    const { display, scope } = this;
    if (scope.live) {
      display.pan(samples / scope.run.rate_hz);
      return;
    }
    const at =
      display.mode === 'follow' && display.head !== null ? display.head : Math.min(display.frame().t1, display.last);
    display.seek(at + samples / (scope.run.rate_hz || 1000));
  }

  #advance() {
    if (!this.playing) return;
    const now = performance.now();
    const { display } = this;
    display.seek(display.head + (this.speed * Math.min(250, now - this.#before_ms)) / 1000);
    this.#before_ms = now;
    if (display.head >= display.last) this.pause();
    else requestAnimationFrame(() => this.#advance());
  }
}
