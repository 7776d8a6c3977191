// The buttons above the plots: follow or pause, fit, time base, cursors, panes, units, colours.

import { byId, setText } from '../dom.js';
import { withPane } from '../settings/layout.js';
import { baseName } from '../settings/run_name.js';
import { modelUnits } from '../settings/units.js';
import { duration, runTime } from '../settings/numbers.js';
import { kDivisions } from '../plot/time_window.js';

const kKinds = { live: ' (live)', past: ' (before the restart)' };
const kThemes = { auto: 'light', light: 'dark', dark: 'auto' };
const kThemeNames = { auto: 'Auto', light: 'Light', dark: 'Dark' };

export class Toolbar {
  constructor(parts, actions) {
    Object.assign(this, parts);
    const press = {
      toggle: actions.toggle,
      fit: actions.fit,
      shorter: () => actions.step(-1),
      longer: () => actions.step(1),
      cursors: actions.cursors,
      mark: actions.mark,
      units: actions.units,
      theme: actions.theme,
      help: actions.help,
    };
    for (const [id, act] of Object.entries(press)) byId(id).addEventListener('click', act);
    byId('add-pane').addEventListener('click', () => this.scope.setLayout(withPane(this.scope.layout)));
    byId('reset').addEventListener('click', () => this.scope.resetLayout());
    byId('run').addEventListener('change', (event) => this.scope.select(Number(event.target.value)));
    for (const name of ['view', 'preferences', 'playing', 'trigger']) this.signals.on(name, () => this.#show());
    this.signals.on('runs', () => this.#runs());
    this.signals.on('run', () => this.#runs());
    this.signals.on('cursors', () => byId('cursors').setAttribute('aria-pressed', String(this.cursors.shown)));
    applyTheme(this.scope.preferences.theme);
    this.#show();
  }

  nextTheme() {
    const theme = kThemes[this.scope.preferences.theme];
    applyTheme(theme);
    this.scope.prefer({ theme });
  }

  #show() {
    const { display, scope, player } = this;
    const moving = display.mode === 'follow' && (scope.live || player.playing);
    const words =
      scope.live || !scope.run
        ? [display.mode === 'follow', 'Pause', display.mode === 'trigger' ? 'Leave trigger' : 'Follow']
        : [player.playing, 'Pause', 'Play'];
    const toggle = byId('toggle');
    setText(toggle, words[0] ? words[1] : words[2]);
    toggle.dataset.moving = String(moving);
    const span = display.mode === 'follow' ? display.span : display.window.t1 - display.window.t0;
    setText(byId('base'), `${duration(Number((span / kDivisions).toPrecision(3)))}/div`);
    setText(
      byId('clock'),
      `${runTime(display.mode === 'follow' || scope.live ? (scope.live ? display.last : (display.head ?? display.last)) : Math.min(display.window.t1, display.last), 100)} s`,
    );
    setChoice(byId('units'), 'Units', scope.preferences.si ? 'SI' : modelUnits(scope.run));
    setChoice(byId('theme'), 'Colours', kThemeNames[scope.preferences.theme]);
  }

  #runs() {
    const { runs, run } = this.scope;
    const select = byId('run');
    const options = runs.map((one) =>
      Object.assign(document.createElement('option'), {
        value: String(one.run),
        textContent: `${baseName(one.name)}${kKinds[one.kind] ?? ''}`,
        selected: one.run === run?.run,
      }),
    );
    select.replaceChildren(...options);
    select.disabled = runs.length < 2;
    document.title = run ? `${baseName(run.name)} · hydro-scope` : 'hydro-scope';
  }
}

// A button that says which of its choices is in force; what it chooses is in its name only, as the bar is narrow.
function setChoice(button, name, chosen) {
  setText(button, chosen);
  button.setAttribute('aria-label', `${name}: ${chosen}`);
}

function applyTheme(theme) {
  document.documentElement.dataset.theme = theme;
}
