// Puts the page together: makes each part, and tells it of the others that it needs.

import { makeActions } from './actions.js';
import { byId } from './dom.js';
import { keyTable, listen } from './keys.js';
import { Api } from './link/api.js';
import { Connection } from './link/connection.js';
import { takeToken } from './link/token.js';
import { CursorPanel } from './panels/cursor_panel.js';
import { EventsPanel } from './panels/events_panel.js';
import { FaultNotice } from './panels/fault_notice.js';
import { FilesPanel } from './panels/files_panel.js';
import { GhostPanel } from './panels/ghost_panel.js';
import { LinkPanel } from './panels/link_panel.js';
import { LoopsPanel } from './panels/loops_panel.js';
import { Notice } from './panels/notice.js';
import { ReferenceForm } from './panels/reference_form.js';
import { StopPanel } from './panels/stop_panel.js';
import { Toolbar } from './panels/toolbar.js';
import { Transport } from './panels/transport.js';
import { TriggerPanel } from './panels/trigger_panel.js';
import { TuningPanel } from './panels/tuning_panel.js';
import { CursorTool } from './plot/cursor_tool.js';
import { Display } from './plot/display.js';
import { Gestures } from './plot/gestures.js';
import { OverlayRun } from './plot/overlay.js';
import { Panes } from './plot/panes.js';
import { Player } from './plot/player.js';
import { Trigger } from './plot/trigger.js';
import { Scope } from './scope.js';
import { Signals } from './signals.js';

const signals = new Signals();
const api = new Api(takeToken(location, history, sessionStorage));
const link = new Connection(signals, api);
const scope = new Scope(link, api, signals, localStorage);
const display = new Display(scope, signals);
const overlay = new OverlayRun(scope, signals);
const cursors = new CursorTool(scope, display, signals);
const trigger = new Trigger(scope, display, signals);
const player = new Player(scope, display, signals);
const panes = new Panes({ scope, display, overlay, cursors, trigger, signals, host: byId('panes') });
const notice = new Notice();

const parts = { signals, api, link, scope, display, overlay, cursors, trigger, player, panes, notice };
const actions = makeActions(parts);
parts.keys = keyTable(actions);
parts.stop = new StopPanel(scope, signals, notice);
parts.ghost = new GhostPanel(scope, display, overlay, signals);
parts.toolbar = new Toolbar(parts, actions);

new FaultNotice(scope, signals, notice);
new LinkPanel(scope, link, api, signals, notice);
new Gestures({ host: byId('panes'), panes, display, cursors, trigger, signals, box: byId('box') });
new Transport({ host: byId('transport'), scope, display, player, signals });
byId('side').append(
  ...[
    new TriggerPanel(scope, trigger, display, signals),
    new CursorPanel(scope, cursors, signals),
    new EventsPanel(scope, display, signals),
    parts.ghost,
    new TuningPanel(scope, signals),
    new ReferenceForm(scope, signals),
    new FilesPanel(parts),
    new LoopsPanel(signals),
  ].map((panel) => panel.element),
);

listen(parts.keys);
signals.on('mark', actions.mark);
// The address is opened again with a fresh token in it: the server was restarted, and its new line was
// pressed.
addEventListener('hashchange', () => {
  const token = takeToken(location, history, sessionStorage);
  if (token !== api.token) location.reload();
});
// For tests and for those who look: what the page knows, and how many frames it has drawn.
globalThis.hydroScope = parts;
link.open();
