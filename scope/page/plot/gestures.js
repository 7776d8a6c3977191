// Mouse, touch and wheel on the plots: zoom, pan, cursors, the trigger's level. One finger pans in time and
// scrolls the page, two fingers zoom.

const kGrab_px = 8;
const kClick_px = 4;
const kWheelZoom = 1.0016; // a factor for each unit of the wheel

export class Gestures {
  #pointers = new Map();
  #drag = null; // {kind, start_x, last_x, t_start, ...}
  #pinch = null;

  // parts: {host, panes, display, cursors, trigger, signals, box: element that shows the zoom}
  constructor(parts) {
    Object.assign(this, parts);
    const { host } = parts;
    host.addEventListener('pointerdown', (event) => this.#down(event));
    host.addEventListener('pointermove', (event) => this.#move(event));
    host.addEventListener('pointerup', (event) => this.#up(event));
    host.addEventListener('pointercancel', (event) => this.#up(event));
    host.addEventListener('pointerleave', () => this.#hover(null));
    host.addEventListener('wheel', (event) => this.#wheel(event), { passive: false });
    host.addEventListener('dblclick', (event) => {
      if (this.#place(event)) this.display.follow();
    });
  }

  // Where a pointer is: {pane, t, x, y, width} with x, y in the plotting area, or null outside of all.
  #place(event) {
    const index = Number(event.target.closest?.('.pane')?.dataset.pane ?? -1);
    const pane = this.panes.panes[index];
    if (!pane || !event.target.closest('.chart')) return null;
    const box = pane.chart.plot.over.getBoundingClientRect();
    const { t0, t1 } = pane.chart.frame;
    const x = event.clientX - box.left;
    return {
      pane,
      x,
      y: event.clientY - box.top,
      width: box.width,
      t: t0 + (x / box.width) * (t1 - t0),
      per_px: (t1 - t0) / box.width,
      left: box.left,
    };
  }

  #down(event) {
    const place = this.#place(event);
    if (!place || event.button !== 0) return;
    this.#pointers.set(event.pointerId, event.clientX);
    this.host.setPointerCapture(event.pointerId);
    if (this.#pointers.size === 2) {
      this.#startPinch(place);
      return;
    }
    const common = { place, start_x: event.clientX, last_x: event.clientX, moved: false };
    const cursor = this.cursors.near(place.t, kGrab_px * place.per_px);
    const axis = this.#levelAt(place);
    if (axis !== null) this.#drag = { ...common, kind: 'level', axis };
    else if (cursor) this.#drag = { ...common, kind: 'cursor', cursor };
    else this.#drag = { ...common, kind: event.shiftKey ? 'box' : 'pan' };
  }

  #move(event) {
    const place = this.#place(event);
    if (this.#pointers.size === 0) this.#hover(place);
    if (!this.#pointers.has(event.pointerId)) return;
    this.#pointers.set(event.pointerId, event.clientX);
    if (this.#pinch) this.#doPinch();
    else if (this.#drag) this.#doDrag(event);
  }

  #up(event) {
    this.#pointers.delete(event.pointerId);
    const drag = this.#drag;
    if (this.#pointers.size < 2) this.#pinch = null;
    this.#drag = null;
    this.box.hidden = true;
    if (!drag || !drag.moved) return;
    if (drag.kind === 'box') {
      const a = drag.place.t;
      const b = a + (event.clientX - drag.start_x) * drag.place.per_px;
      if (a !== b) this.display.showWindow(Math.min(a, b), Math.max(a, b));
    }
  }

  #doDrag(event) {
    const drag = this.#drag;
    if (Math.abs(event.clientX - drag.start_x) > kClick_px || drag.kind === 'level') drag.moved = true;
    if (!drag.moved) return;
    const { place } = drag;
    const by = (event.clientX - drag.last_x) * place.per_px;
    drag.last_x = event.clientX;
    if (drag.kind === 'pan') this.display.pan(-by);
    else if (drag.kind === 'cursor')
      this.cursors.place(drag.cursor, place.t + (event.clientX - drag.start_x) * place.per_px);
    else if (drag.kind === 'level') this.#dragLevel(event, drag);
    else this.#showBox(event, drag);
  }

  #dragLevel(event, drag) {
    const { chart } = drag.place.pane;
    const box = chart.plot.over.getBoundingClientRect();
    this.signals.emit('level', { value: chart.valueAt(event.clientY - box.top, drag.axis) });
  }

  #showBox(event, { start_x, place }) {
    const frame = this.host.getBoundingClientRect();
    const left = Math.max(place.left, Math.min(start_x, event.clientX)) - frame.left + this.host.scrollLeft;
    this.box.hidden = false;
    this.box.style.left = `${left}px`;
    this.box.style.width = `${Math.abs(event.clientX - start_x)}px`;
  }

  #startPinch(place) {
    this.#drag = null;
    const [one, other] = [...this.#pointers.values()];
    this.#pinch = { apart: Math.max(20, Math.abs(one - other)), middle: (one + other) / 2, place };
  }

  #doPinch() {
    const [one, other] = [...this.#pointers.values()];
    const apart = Math.max(20, Math.abs(one - other));
    const middle = (one + other) / 2;
    const { t0, t1 } = this.display.frame();
    const { left, width } = this.#pinch.place;
    this.display.pan((-(middle - this.#pinch.middle) / width) * (t1 - t0));
    const shown = this.display.frame();
    this.display.zoom(this.#pinch.apart / apart, shown.t0 + ((middle - left) / width) * (shown.t1 - shown.t0));
    this.#pinch.apart = apart;
    this.#pinch.middle = middle;
  }

  #wheel(event) {
    const place = this.#place(event);
    if (!place || event.altKey) return;
    event.preventDefault();
    const sideways = event.shiftKey ? event.deltaY || event.deltaX : event.deltaX;
    if (Math.abs(sideways) > Math.abs(event.shiftKey ? 0 : event.deltaY)) this.display.pan(sideways * place.per_px);
    else this.display.zoom(kWheelZoom ** event.deltaY, place.t);
  }

  // The axis of the trigger's level when the pointer is on its line, else null.
  #levelAt({ pane, y }) {
    const drawn = this.trigger.drawn();
    if (!drawn || drawn.level === null) return null;
    const one = pane.parts.traces.find((candidate) => candidate.kind === 'measured' && candidate.id === drawn.channel);
    if (!one) return null;
    const line = this.trigger.levelShown();
    const box = pane.chart.plot.over.getBoundingClientRect();
    const at = (pane.chart.y(line, one.axis) - pane.chart.plot.bbox.top) / devicePixelRatio;
    return Math.abs(at - y) <= kGrab_px && box.height > 0 ? one.axis : null;
  }

  #hover(place) {
    this.panes.hover = place ? place.t : null;
    const near =
      place &&
      (this.#levelAt(place) !== null
        ? 'ns-resize'
        : this.cursors.near(place.t, kGrab_px * place.per_px)
          ? 'ew-resize'
          : '');
    this.host.style.cursor = near || '';
    this.signals.emit('draw');
  }
}
