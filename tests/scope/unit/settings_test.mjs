// Tests of what the page keeps and sends: layouts, preferences, the trigger, units, the token.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { EventBook } from '../../../scope/page/event_book.js';
import { BackOff } from '../../../scope/page/link/back_off.js';
import { takeToken, tokenIn } from '../../../scope/page/link/token.js';
import { activeFaults } from '../../../scope/page/settings/active_faults.js';
import * as layouts from '../../../scope/page/settings/layout.js';
import { duration, exact, frequency, short } from '../../../scope/page/settings/numbers.js';
import { loadPreferences, savePreferences } from '../../../scope/page/settings/preferences.js';
import { defaultTrigger, triggerError, triggerMessage } from '../../../scope/page/settings/trigger_settings.js';
import { factorOf, unitOf } from '../../../scope/page/settings/units.js';

class Storage {
  #kept = new Map();
  getItem(key) {
    return this.#kept.get(key) ?? null;
  }
  setItem(key, value) {
    this.#kept.set(key, String(value));
  }
  removeItem(key) {
    this.#kept.delete(key);
  }
}

const kKnown = ['dp', 'dp_ref', 'p1', 'p2', 'residual.p1'];

test('the first layout shows what the run has', () => {
  const { panes } = layouts.defaultLayout(kKnown);
  assert.deepEqual(
    panes.map((pane) => pane.channels),
    [
      ['dp', 'dp_ref'],
      ['p1', 'p2'],
    ],
  );
});

test('channels and panes move', () => {
  let layout = layouts.defaultLayout(kKnown);
  layout = layouts.withChannelMoved(layout, 0, 1, 'dp_ref');
  assert.deepEqual(
    layout.panes.map((pane) => pane.channels),
    [['dp'], ['p1', 'p2', 'dp_ref']],
  );
  layout = layouts.withChannelMoved(layout, 1, 2, 'p2');
  assert.deepEqual(
    layout.panes.map((pane) => pane.channels),
    [['dp'], ['p1', 'dp_ref'], ['p2']],
  );
  layout = layouts.withPaneMoved(layout, 2, -2);
  assert.deepEqual(layout.panes[0].channels, ['p2']);
  layout = layouts.withHidden(layout, 0, 'p2', true);
  assert.deepEqual(layout.panes[0].hidden, ['p2']);
  assert.deepEqual(layouts.withoutChannel(layout, 0, 'p2').panes[0], { title: '', channels: [], hidden: [] });
});

test('the residual pane comes once and goes', () => {
  const first = layouts.defaultLayout(kKnown);
  const shown = layouts.withResiduals(layouts.withResiduals(first, kKnown), kKnown);
  assert.equal(shown.panes.length, 3);
  assert.deepEqual(layouts.withoutResiduals(shown), first);
});

test('layouts are kept by name, and what is not a layout is ignored', () => {
  const storage = new Storage();
  const layout = layouts.defaultLayout(kKnown);
  layouts.saveLayout(storage, 'demo.toml', layout);
  assert.deepEqual(layouts.loadLayout(storage, 'demo.toml'), layout);
  assert.equal(layouts.loadLayout(storage, 'paper.toml'), null);
  storage.setItem('hydro-scope.layout.paper.toml', '{"version":1,"panes":[{"channels":[1,"dp"]}]}');
  assert.deepEqual(layouts.loadLayout(storage, 'paper.toml').panes, [{ title: '', channels: ['dp'], hidden: [] }]);
  storage.setItem('hydro-scope.layout.paper.toml', '{"version":');
  assert.equal(layouts.loadLayout(storage, 'paper.toml'), null);
});

test('preferences outside their ranges are ignored', () => {
  const storage = new Storage();
  savePreferences(storage, { theme: 'dark', si: true, span: 5 });
  assert.deepEqual(loadPreferences(storage), { theme: 'dark', si: true, span: 5 });
  savePreferences(storage, { theme: 'pink', si: 1, span: -1 });
  assert.deepEqual(loadPreferences(storage), { theme: 'auto', si: false, span: 10 });
});

test('the trigger names what is wrong with it', () => {
  assert.equal(triggerError(defaultTrigger()), '');
  assert.equal(triggerError({ ...defaultTrigger(), pre: 1.5 }), 'pre-trigger is 1.5: give a number from 0 to 1');
  assert.equal(triggerError({ ...defaultTrigger(), hysteresis: -1 }), 'hysteresis is -1: give a number at least 0');
  assert.equal(triggerError({ ...defaultTrigger(), level: NaN }), 'level: give a number');
  assert.deepEqual(triggerMessage({ ...defaultTrigger(), level: 100 }, 4, 0, ['dp'], 900), {
    op: 'trigger',
    id: 4,
    run: 0,
    channels: ['dp'],
    channel: 'dp',
    level: 100,
    edge: 'rising',
    hysteresis: 0,
    holdoff: 0.1,
    pre: 0.25,
    mode: 'normal',
    on: 'level',
    span: 0.5,
    pixels: 900,
  });
});

test('units follow the switch', () => {
  const dp = { unit: 'psi', si: { unit: 'MPa', factor: 0.00689476 } };
  assert.equal(unitOf(dp, true), 'MPa');
  assert.equal(factorOf(dp, false), 1);
  assert.equal(unitOf({ unit: 'V' }, true), 'V');
});

test('numbers are short where they are read and exact where they count', () => {
  assert.equal(short(123.456), '123.5');
  assert.equal(short(-0.0123456), '\u22120.01235');
  assert.equal(short(NaN), '–');
  assert.equal(exact(0.1 + 0.2), '0.30000000000000004');
  assert.equal(duration(2e-4), '200 µs');
  assert.equal(duration(-0.25), '\u2212250 ms');
  assert.equal(frequency(1250), '1.25 kHz');
});

test('the token leaves the address bar', () => {
  const storage = new Storage();
  const place = { hash: '#token=00ff00ff00ff00ff', pathname: '/', search: '' };
  const shown = [];
  assert.equal(takeToken(place, { replaceState: (...args) => shown.push(args[2]) }, storage), '00ff00ff00ff00ff');
  assert.deepEqual(shown, ['/']);
  assert.equal(takeToken({ hash: '' }, null, storage), '00ff00ff00ff00ff');
  assert.equal(tokenIn('http://127.0.0.1:8765/#token=abc123abc'), 'abc123abc');
  assert.equal(tokenIn('what?'), '');
});

test('attempts to connect come soon at first, and never more than 2 s apart', () => {
  const wait = new BackOff();
  assert.deepEqual(
    [1, 2, 3, 4, 5].map(() => wait.next()),
    [250, 500, 1000, 2000, 2000],
  );
  wait.reset();
  assert.equal(wait.next(), 250);
});

// Tests that a fault is active until it ends, and that re-arming and a restart end all.
test('active faults', () => {
  const fault = { kind: 'fault', source: 'plant', code: 'stale_state', t: 1 };
  const other = { kind: 'fault', source: 'pressure_ctrl', code: 'stale_state', t: 2 };
  assert.deepEqual(activeFaults([fault, other, { ...fault, kind: 'fault_end' }]), [other]);
  assert.deepEqual(
    activeFaults([fault, { kind: 'stop', t: 3 }]).map(({ kind }) => kind),
    ['fault', 'stop'],
  );
  assert.deepEqual(activeFaults([fault, other, { kind: 'rearm', t: 4 }]), []);
  assert.deepEqual(activeFaults([fault, { kind: 'restart', t: 0 }, other]), [other]);
});

// Tests that an event that is sent again is kept once, and that those before a restart go, also where the new ones look the same.
test('events are kept once, and not beyond a restart', () => {
  const book = new EventBook();
  const step = (n, t) => ({ run: 0, n, t, kind: 'step', text: 'reference from 0 to 0.3' });
  assert.equal(book.add(step(1, 0.2)), true);
  assert.equal(book.add(step(1, 0.2)), false);
  book.add(step(2, 2.2));
  book.add(step(3, 4.4));
  book.add({ run: 0, n: 1, t: 0, kind: 'restart', text: 'the plant has started again' });
  book.add(step(2, 0.2));
  assert.deepEqual(
    book.of(0).map(({ n, t }) => [n, t]),
    [
      [1, 0],
      [2, 0.2],
    ],
  );
  assert.deepEqual(book.of(7), []);
});
