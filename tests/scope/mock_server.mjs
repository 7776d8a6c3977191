// A stand-in of hydro-scope for work on the page alone: its protocol over made-up signals. Not used by the
// tests of the running stack.   node tests/scope/mock_server.mjs [PORT] [--log]
import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { encodeBins } from '../../scope/page/link/frames.js';

const kPage = fileURLToPath(new URL('../../scope/page/', import.meta.url));
const { WebSocketServer } = createRequire(path.join(kPage, 'package.json'))('ws');
const kToken = process.env.HYDRO_SCOPE_TOKEN ?? '0123456789abcdef0123456789abcdef';
const kTypes = {
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript; charset=utf-8',
  '.css': 'text/css',
  '.svg': 'image/svg+xml',
};
const kCsp =
  "default-src 'self'; connect-src 'self'; style-src 'self'; img-src 'self' blob: data:; frame-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
const kRate = 1000;
const psi = { unit: 'MPa', factor: 0.00689476 };
const start_ms = Date.now() - 8000;
const log = process.argv.includes('--log');
const last = () => (log ? 42 : (Date.now() - start_ms) / 1000);

const square = (t) => (Math.floor(t / 2) % 2 ? 0.25 : -0.15);
const arm = (t) => square(t) + (square(t - 2) - square(t)) * Math.exp(-3 * (t % 2)) * Math.cos(9 * (t % 2));
const noise = (k) => (Math.sin(k * 12.9898) * 43758.5453) % 1;
const kSignals = {
  dp: [
    (t, k) => 300 * (arm(t) - square(t)) + 2 * noise(k) + (k % 3700 === 0 ? 90 : 0),
    'pressure difference p2 - p1',
    'pressure',
    'psi',
    psi,
  ],
  dp_ref: [(t) => 300 * (arm(t) - square(t)), 'reference of the pressure difference', 'pressure', 'psi', psi, true],
  p1: [(t, k) => 220 - 150 * (arm(t) - square(t)) + noise(k), 'pressure 1', 'pressure', 'psi', psi],
  p2: [(t, k) => 220 + 150 * (arm(t) - square(t)) + noise(k + 7), 'pressure 2', 'pressure', 'psi', psi],
  arm_angle: [(t) => arm(t), 'arm angle', 'arm', 'rad'],
  arm_ref: [(t) => square(t), 'reference of the arm angle', 'arm', 'rad', null, true],
  motor_speed: [
    (t, k) => 60 * Math.sin(9 * (t % 2)) * Math.exp(-3 * (t % 2)) + 0.3 * noise(k),
    'motor speed',
    'motor',
    'rad/s',
  ],
  voltage: [
    (t) => Math.max(-10, Math.min(10, 14 * Math.exp(-3 * (t % 2)) * Math.cos(9 * (t % 2)))),
    'motor voltage',
    'motor',
    'V',
    null,
    true,
  ],
  period_us: [(t, k) => 1000 + 30 * noise(k) + (k % 1500 === 0 ? 400 : 0), 'period of the plant', 'timing', 'us'],
  latency_us: [(t, k) => 120 + 25 * noise(k + 3), 'command after state', 'timing', 'us'],
  'ghost.dp': [(t) => 305 * (arm(t) - square(t)), 'dp of the ghost', 'ghost', 'psi', psi],
  'ghost.p1': [(t) => 220 - 152 * (arm(t) - square(t)), 'p1 of the ghost', 'ghost', 'psi', psi],
  'residual.p1': [(t, k) => 2 * noise(k), 'residual of p1', 'residual', 'noise sd'],
};
const kChannels = Object.entries(kSignals).map(([id, [, label, group, unit, si, step]]) => ({
  id,
  label,
  group,
  unit,
  ...(si ? { si } : {}),
  step: step === true,
}));
const runs = () => [
  {
    run: 0,
    name: log ? 'mock.lcmlog' : 'mock.toml',
    kind: log ? 'log' : 'live',
    first: 0,
    last: last(),
    rate_hz: kRate,
    session: 'm1',
    channels: kChannels,
    limits: { voltage_V: 10, pressure: 2000 },
  },
  {
    run: 1,
    name: 'before <b>.lcmlog',
    kind: 'log',
    first: 0,
    last: 20,
    rate_hz: kRate,
    session: 'm2',
    channels: kChannels.slice(0, 10),
  },
];

function binsOf(ids, first_sample, width, count, end) {
  const min = ids.map(() => new Float64Array(count).fill(NaN));
  const max = ids.map(() => new Float64Array(count).fill(NaN));
  for (let b = 0; b < count; b += 1) {
    const from = Math.ceil((first_sample + b * width) * kRate - 1e-6);
    const to = Math.min(Math.ceil((first_sample + (b + 1) * width) * kRate - 1e-6), Math.floor(end * kRate) + 1);
    const stride = Math.max(1, Math.floor((to - from) / 40));
    for (let k = Math.max(0, from); k < to; k += stride) {
      if (k > 5000 && k < 5300) continue;
      ids.forEach((id, c) => {
        const value = kSignals[id][0](k / kRate, k);
        if (!(min[c][b] <= value)) min[c][b] = value;
        if (!(max[c][b] >= value)) max[c][b] = value;
      });
    }
  }
  return { min, max };
}

function serve(socket) {
  const views = new Map();
  const say = (message) => socket.send(JSON.stringify(message));
  say({ op: 'hello', program: 'mock 0', control: true, runs: runs(), units: 'in, lbf, s, psi, rad' });
  [
    [1, 2, 'step', 'reference', '0.25 rad'],
    [2, 5, 'gap', 'bus', '300 ticks are missing'],
    [3, 6.4, 'fault', 'pressure_ctrl', 'the state is 120 ms old <img src=x>', 'stale_state'],
    [4, 6.9, 'fault_end', 'pressure_ctrl', '', 'stale_state'],
  ].forEach(([n, t, kind, source, text, code]) => say({ op: 'event', run: 0, n, t, kind, source, text, code }));
  say({
    op: 'tuning',
    version: 1,
    control: true,
    entries: [
      {
        key: 'position.c1',
        value: 6000,
        unit: 'psi/rad',
        min: 100,
        max: 20000,
        what: 'stiffness',
        acts_in: 'position_ctrl',
      },
      {
        key: 'position.c2',
        value: 1200,
        unit: 'psi s/rad',
        min: 10,
        max: 5000,
        what: 'damping',
        acts_in: 'position_ctrl',
      },
      { key: 'reference.kind', value: 'steps' },
    ],
  });
  let n = 10;
  const timer = setInterval(() => {
    for (const [id, view] of views) {
      const width = view.span / view.pixels;
      const stop = Math.floor(last() / width) + 1;
      if (stop <= view.sent) continue;
      const count = stop - view.sent;
      socket.send(
        encodeBins({
          id,
          run: view.run,
          flags: 1,
          t0: view.sent * width,
          width,
          ...binsOf(view.channels, view.sent * width, width, count, last()),
        }),
      );
      view.sent = stop - 1;
    }
  }, 16);
  const slow = setInterval(() => say({ op: 'clock', run: 0, last: last(), running: true, silent_s: 0 }), 100);
  const trigger_timer = setInterval(() => {
    for (const [id, view] of views.triggers ?? []) {
      const t = Math.floor(last() / 2) * 2 - 2 + 0.0;
      if (t === view.caught || view.stopped) continue;
      view.caught = t;
      view.stopped = view.mode === 'single';
      say({ op: 'trigger', id, t, state: view.stopped ? 'stopped' : 'triggered' });
      const width = view.span / view.pixels;
      socket.send(
        encodeBins({
          id,
          run: 0,
          flags: 4,
          t0: t - view.pre * view.span,
          width,
          ...binsOf(view.channels, t - view.pre * view.span, width, view.pixels, last()),
        }),
      );
    }
  }, 100);
  socket.on('close', () => [timer, slow, trigger_timer].forEach(clearInterval));
  const processes = setInterval(
    () =>
      say({
        op: 'processes',
        list: [
          { role: 'plant', host: '', state: 'running', rate_hz: 1000, missed: 0, latency_p99_us: 130.2, lost: 0 },
          {
            role: 'pressure_ctrl',
            state: 'running',
            rate_hz: 1000,
            missed: 2,
            latency_p99_us: 210,
            lost: 0,
            fault: 'stale_state',
          },
        ],
      }),
    1000,
  );
  socket.on('close', () => clearInterval(processes));
  socket.on('message', (data) => {
    const m = JSON.parse(data);
    if (m.op === 'view')
      views.set(m.id, { ...m, sent: Math.max(0, Math.floor((last() - m.span) / (m.span / m.pixels))) });
    else if (m.op === 'unview') views.delete(m.id);
    else if (m.op === 'get') {
      const width = Math.max((m.t1 - m.t0) / m.pixels, 1 / kRate);
      const t0 = width === 1 / kRate ? Math.ceil(m.t0 * kRate) / kRate : m.t0;
      const count = Math.max(0, Math.min(Math.ceil((m.t1 - t0) / width), Math.floor((last() - t0) / width) + 1));
      socket.send(
        encodeBins({ id: m.id, run: m.run, flags: 2, t0, width, ...binsOf(m.channels, t0, width, count, last()) }),
      );
    } else if (m.op === 'values') {
      const k = Math.floor(Math.min(m.t, last()) * kRate + 1e-9);
      say({
        op: 'reply',
        id: m.id,
        ok: true,
        data: { t: k / kRate, values: m.channels.map((id) => kSignals[id][0](k / kRate, k)) },
      });
    } else if (m.op === 'mark')
      say({ op: 'event', run: 0, n: n++, t: m.t, kind: 'mark', source: 'page', text: m.text });
    else if (m.op === 'stop') {
      say({ op: 'reply', id: m.id, ok: true, text: 'the voltage is held at 0 V' });
      say({ op: 'event', run: 0, n: n++, t: last(), kind: 'stop', source: 'page', text: 'STOP' });
    } else if (m.op === 'trigger') (views.triggers ??= new Map()).set(m.id, { ...m, caught: -1 });
    else if (m.op === 'untrigger') views.triggers?.delete(m.id);
    else if (m.op === 'arm') {
      const v = views.triggers?.get(m.id);
      if (v) v.stopped = false;
    } else
      say({
        op: 'reply',
        id: m.id,
        ok: m.op !== 'set',
        text: m.op === 'set' ? 'position.c2 would leave a margin of -3 degrees' : '',
      });
  });
}

const server = createServer(async (request, response) => {
  const { pathname, searchParams } = new URL(request.url, 'http://x');
  if (pathname.startsWith('/api/')) {
    const right = request.headers.authorization === `Bearer ${kToken}` || searchParams.get('token') === kToken;
    response
      .writeHead(right ? 200 : 401, { 'Content-Type': 'application/json' })
      .end(JSON.stringify(right ? {} : { error: 'wrong token' }));
    return;
  }
  const name =
    pathname === '/'
      ? 'index.html'
      : pathname.startsWith('/assets/uplot/')
        ? `node_modules/uplot/dist/${path.basename(pathname)}`
        : path.normalize(pathname.replace('/assets/', ''));
  try {
    const bytes = await readFile(path.join(kPage, name));
    response
      .writeHead(200, {
        'Content-Type': kTypes[path.extname(name)] ?? 'application/octet-stream',
        'Content-Security-Policy': kCsp,
      })
      .end(bytes);
  } catch {
    response.writeHead(404).end();
  }
});
const sockets = new WebSocketServer({ noServer: true, handleProtocols: () => 'hydro.scope.v1' });
server.on('upgrade', (request, socket, head) => {
  if (new URL(request.url, 'http://x').searchParams.get('token') !== kToken)
    socket.end('HTTP/1.1 401 Unauthorized\r\n\r\n');
  else sockets.handleUpgrade(request, socket, head, serve);
});
server.listen(Number(process.argv[2] ?? 8764), '127.0.0.1', () =>
  console.log(`open http://127.0.0.1:${server.address().port}/#token=${kToken}`),
);
