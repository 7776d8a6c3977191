// Starts the programs under test on a UDP port of their own, and always ends them. The programs come from
// HYDRO_BIN, the configurations from HYDRO_CONFIG; without them, from the source tree and its build folder.
// HYDRO_SCOPE_PAGE names a folder of the page's files that is served instead of those inside hydro-scope.

import { execFileSync, spawn } from 'node:child_process';
import { createSocket } from 'node:dgram';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';

const kRoot = fileURLToPath(new URL('../../', import.meta.url));
const kBin = process.env.HYDRO_BIN ?? path.join(kRoot, 'build', 'bin');
const kConfig = process.env.HYDRO_CONFIG ?? path.join(kRoot, 'config');
export const kToken = 'f00df00df00df00df00df00df00df00d';
// How long to wait for what should come soon. Nothing passes because of it, so it may be long: the machine is
// shared.
export const kPatience_ms = 90000;
// How far and how strongly the stack of launch() moves: so gently that a command held for a second, because a browser starts, axe
// counts or the machine was given to others, does not carry the arm out of its cylinder.
export const kAmplitude = 0.05; // rad
const kTorque = 60; // in-lbf

export function demoConfig() {
  return path.join(kConfig, 'demo.toml');
}

// A child process whose lines can be waited for.
class Program {
  constructor(name, args, env = {}) {
    this.name = name;
    this.lines = [];
    this.waiting = [];
    this.child = spawn(path.join(kBin, name), args, {
      env: { ...process.env, ...env },
      stdio: ['ignore', 'pipe', 'pipe'],
    });
    this.ended = new Promise((done) => {
      const end = (code, signal) => {
        this.over = true;
        this.#wake();
        done({ code, signal });
      };
      this.child.on('exit', end);
      this.child.on('error', (error) => {
        this.lines.push(error.message);
        end(null, null);
      });
    });
    for (const stream of [this.child.stdout, this.child.stderr]) {
      let rest = '';
      stream.on('data', (bytes) => {
        const parts = (rest + bytes).split('\n');
        rest = parts.pop();
        this.lines.push(...parts);
        this.#wake();
      });
    }
  }

  // The first line that matches; fails when the program ends without it, or after kPatience_ms.
  line(pattern) {
    return new Promise((done, fail) => {
      const say = (why) =>
        fail(new Error(`${this.name}: ${why} without a line like ${pattern}; it said:\n${this.lines.join('\n')}`));
      const timer = setTimeout(() => say(`waited ${kPatience_ms} ms`), kPatience_ms);
      const look = () => {
        const found = this.lines.map((line) => pattern.exec(line)).find(Boolean);
        if (!found && !this.over) return false;
        clearTimeout(timer);
        if (found) done(found);
        else say('ended');
        return true;
      };
      if (!look()) this.waiting.push(look);
    });
  }

  async stop(signal = 'SIGINT') {
    this.stopped = true;
    if (!this.over) this.child.kill(signal);
    const late = setTimeout(() => this.child.kill('SIGKILL'), kPatience_ms);
    const outcome = await this.ended;
    clearTimeout(late);
    return outcome;
  }

  #wake() {
    this.waiting = this.waiting.filter((look) => !look());
  }
}

// Folder, bus address and programs of one test file.
export class Bench {
  #programs = [];

  constructor() {
    this.folder = mkdtempSync(path.join(tmpdir(), 'hydro-scope-'));
    // However this process ends, its programs do not outlive it.
    process.on('exit', () =>
      this.#programs.forEach(({ over, child }) => {
        if (!over) child.kill('SIGINT');
      }),
    );
    for (const signal of ['SIGINT', 'SIGTERM']) process.once(signal, () => process.exit(1));
  }

  static async make() {
    const bench = new Bench();
    bench.url = `udpm://239.255.76.67:${await freeUdpPort()}?ttl=0`;
    return bench;
  }

  file(name) {
    return path.join(this.folder, name);
  }

  // Runs a program to its end; its standard output. Fails with its words when its exit code is not 0.
  run(name, ...args) {
    return execFileSync(path.join(kBin, name), args, { encoding: 'utf8', stdio: ['ignore', 'pipe', 'pipe'] });
  }

  // The stack of config/demo.toml, moving to and fro until it is stopped. sets: "section.key=value". It bears that a machine with other
  // work (a browser starts, a compiler runs) keeps a loop waiting: what is too old is other tests' subject.
  async launch(log, sets = []) {
    const moving = [
      'reference.kind=square',
      `reference.amplitude=${kAmplitude}`,
      'reference.frequency_hz=0.5',
      'time.duration_s=0',
      `limits.arm_torque=${kTorque}`,
      'limits.stale_input_s=1',
    ];
    const stack = this.#start('hydro-launch', [
      path.join(kConfig, 'demo.toml'),
      '--log',
      log,
      ...this.#sets([...moving, ...sets]),
    ]);
    await stack.line(/ready after/);
    return stack;
  }

  // hydro-scope of the same configuration, or of a log; {program, port, address}.
  async scope(what = path.join(kConfig, 'demo.toml'), { port = 0, token = kToken, sets = [] } = {}) {
    const page = process.env.HYDRO_SCOPE_PAGE ? ['--page', process.env.HYDRO_SCOPE_PAGE] : [];
    const own = what.endsWith('.toml') ? this.#sets(sets) : [];
    const program = this.#start('hydro-scope', [what, '--port', String(port), ...page, ...own], {
      HYDRO_SCOPE_TOKEN: token,
    });
    const [, host, got] = await program.line(/open http:\/\/([\d.]+):(\d+)\//);
    return {
      program,
      port: Number(got),
      address: `http://${host}:${got}/#token=${token}`,
      origin: `http://${host}:${got}`,
    };
  }

  async close() {
    for (const program of this.#programs.reverse()) await program.stop();
    rmSync(this.folder, { recursive: true, force: true });
  }

  #sets(sets) {
    return [`bus.url=${this.url}`, ...sets].flatMap((one) => ['--set', one]);
  }

  #start(name, args, env) {
    const program = new Program(name, args, env);
    this.#programs.push(program);
    return program;
  }
}

function freeUdpPort() {
  return new Promise((done) => {
    const socket = createSocket('udp4');
    socket.bind(0, '127.0.0.1', () => {
      const { port } = socket.address();
      socket.close(() => done(port));
    });
  });
}
