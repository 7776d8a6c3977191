// What buttons and keys do: one place for both.

import { byId, el, setText } from './dom.js';
import { showDialog } from './panels/dialog.js';

// parts: everything that main makes; returns the actions by name.
export function makeActions(parts) {
  const { scope, display, panes, cursors, trigger, player, link } = parts;
  const actions = {
    stop: () => parts.stop.press(),
    toggle: () => {
      if (!scope.run) return;
      if (!scope.live) player.toggle();
      else if (display.mode === 'follow') display.pause();
      else {
        if (display.mode === 'trigger') trigger.stop();
        display.follow();
      }
    },
    follow: () => {
      if (scope.live) display.follow();
    },
    fit: () => {
      display.fit();
      panes.refit();
    },
    step: (steps) => display.step(steps),
    arrow: (key, event) => {
      const sign = key === 'ArrowLeft' ? -1 : 1;
      const { t0, t1 } = display.frame();
      const sample = 1 / (scope.run?.rate_hz || 1000);
      if (event.shiftKey) cursors.move(sign * (event.altKey ? sample : (t1 - t0) / 200));
      else display.pan(sign * (event.altKey ? sample : (t1 - t0) / 10));
    },
    ends: (key) => {
      if (scope.live && key === 'End') {
        display.follow();
        return;
      }
      const { t0, t1 } = display.frame();
      const start = key === 'Home' ? display.first : display.last - (t1 - t0);
      display.showWindow(start, start + (t1 - t0));
    },
    cursors: () => cursors.toggle(),
    cursor: (key) => {
      const name = key.toLowerCase();
      const { t0, t1 } = display.frame();
      if (panes.hover !== null) cursors.place(name, panes.hover);
      else if (cursors.at[name] === null) cursors.place(name, (t0 + t1) / 2);
      else cursors.choose(name);
    },
    // words: the user's note, '' for a number in place of it.
    mark: (words) => {
      if (!scope.run) return;
      const t =
        panes.hover ?? (display.mode === 'follow' ? display.last : (display.frame().t0 + display.frame().t1) / 2);
      const marks = scope.eventsOf().filter((event) => event.kind === 'mark').length;
      link.send({
        op: 'mark',
        run: scope.run.run,
        t,
        text: typeof words === 'string' && words.length > 1 ? words : `mark ${marks + 1}`,
      });
    },
    trigger: () => {
      if (scope.live) {
        if (trigger.on) trigger.stop();
        else trigger.start();
      }
    },
    arm: () => {
      if (trigger.on && trigger.settings.mode === 'single') trigger.arm();
    },
    level: (key) => {
      const { settings } = trigger;
      if (settings.on === 'level')
        trigger.change({
          level: Number(
            (settings.level + (key === ']' ? 1 : -1) * Math.max(Math.abs(settings.level) / 20, 1e-6)).toPrecision(6),
          ),
        });
    },
    ghost: () => parts.ghost.toggle(!scope.ghost),
    sample: (key) => player.step(key === '.' ? 1 : -1),
    say: () => setText(byId('said'), panes.said()),
    units: () => scope.prefer({ si: !scope.preferences.si }),
    theme: () => parts.toolbar.nextTheme(),
    help: () => showHelp(parts.keys, scope.hello?.program),
  };
  return actions;
}

function showHelp(keys, program) {
  const rows = keys.flatMap(({ name, what }) => [el('dt', {}, el('kbd', { text: name })), el('dd', { text: what })]);
  showDialog('Keys and gestures', [
    el('dl', { class: 'keys' }, ...rows),
    el('p', {
      text: 'Wheel: zoom about the pointer; with Shift: pan. Drag: pan; with Shift: zoom to what was dragged over. Two fingers: zoom. Double press: follow the newest again. Drag a cursor or the trigger’s level. Drag a channel’s name to another pane; press it to hide the curve.',
    }),
    el('p', { class: 'hint', text: program ?? '' }),
  ]);
}
