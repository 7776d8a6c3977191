// What leaves the page and what comes in: a window as log, table or picture; a window to hydro-diagnose; logs
// dragged in.

import { el, offerFile, setText } from '../dom.js';
import { pngOf, svgOf } from '../plot/picture.js';
import { baseName } from '../settings/run_name.js';
import { section } from './section.js';
import { showDialog } from './dialog.js';

const kPoll_ms = 700;

export class FilesPanel {
  constructor({ scope, display, cursors, panes, api, signals }) {
    Object.assign(this, { scope, display, cursors, panes, api });
    const button = (text, act, title) => el('button', { type: 'button', text, title, onclick: () => this.#guard(act) });
    this.which = el('p', {
      class: 'hint',
      text: 'The window is what the panes show; with both cursors, what lies between them.',
    });
    this.result = el('output', { class: 'result', role: 'status' });
    this.report = el('button', { type: 'button', text: 'Show the report', onclick: () => this.#showReport() });
    this.report.hidden = true;
    this.picker = el('input', {
      type: 'file',
      accept: '.lcmlog,.csv,.mat',
      class: 'unseen',
      tabindex: '-1',
      'aria-label': 'Open a log',
      onchange: () => this.#guard(() => this.#openAll(this.picker.files)),
    });
    this.closer = button('Close this log', () => this.#close());
    this.element = section(
      'files',
      'Window and files',
      false,
      this.which,
      el(
        'div',
        { class: 'row' },
        button('.lcmlog', () => this.#cut('lcmlog')),
        button('CSV', () => this.#cut('csv')),
        button('SVG', () => this.#svg()),
        button('PNG', () => this.#png()),
      ),
      el(
        'div',
        { class: 'row' },
        button('Diagnose', () => this.#diagnose(), 'Give the window to hydro-diagnose: where do rig and model differ?'),
        this.report,
      ),
      el(
        'div',
        { class: 'row' },
        button('Open a log …', () => this.picker.click()),
        this.closer,
        this.picker,
      ),
      this.result,
    );
    this.#acceptFiles();
    signals.on('run', () => {
      this.closer.hidden = scope.live;
    });
  }

  #window() {
    const { a, b } = this.cursors.at;
    if (a !== null && b !== null && a !== b) return { t0: Math.min(a, b), t1: Math.max(a, b) };
    const { t0, t1 } = this.display.frame();
    return { t0: Math.max(t0, this.display.first), t1: Math.min(t1, this.display.last) };
  }

  async #guard(act) {
    this.result.dataset.state = '';
    try {
      await act();
    } catch (error) {
      this.result.dataset.state = 'bad';
      setText(this.result, error.message);
    }
  }

  async #cut(format) {
    const { t0, t1 } = this.#window();
    setText(this.result, 'cutting');
    const { name, blob } = await this.api.cut(this.scope.run.run, t0, t1, format, this.scope.preferences.si);
    offerFile(name, blob);
    setText(this.result, `${name}: ${t0.toFixed(3)} to ${t1.toFixed(3)} s`);
  }

  #name(ending) {
    const { t0, t1 } = this.display.frame();
    return `${baseName(this.scope.run.name)
      .replace(/\.[a-z]+$/, '')
      .replace(/[^\w.-]+/g, '_')}_${t0.toFixed(2)}-${t1.toFixed(2)}.${ending}`;
  }

  async #png() {
    offerFile(this.#name('png'), await pngOf(this.panes.panes, this.panes.colours));
  }
  #svg() {
    const { first, last } = this.display;
    const run = { name: baseName(this.scope.run.name), first, last, events: this.scope.eventsOf() };
    offerFile(this.#name('svg'), svgOf(this.panes.panes, this.panes.colours, run));
  }

  async #diagnose() {
    const { t0, t1 } = this.#window();
    this.report.hidden = true;
    const { job } = await this.api.diagnose(this.scope.run.run, t0, t1);
    setText(this.result, 'hydro-diagnose is at work');
    for (;;) {
      const answer = await this.api.job(job);
      if (answer.state === 'failed') throw new Error(`hydro-diagnose: ${answer.text || 'failed'}`);
      if (answer.state === 'done') {
        this.path = answer.report;
        this.report.hidden = !this.path;
        setText(this.result, answer.sentence || answer.verdict || 'hydro-diagnose is done');
        return;
      }
      setText(this.result, answer.text || 'hydro-diagnose is at work');
      await new Promise((done) => setTimeout(done, kPoll_ms));
    }
  }

  // In a sandbox without this page's origin: the report is made from a log, which anyone may have written.
  #showReport() {
    if (!/^\/api\/reports\/[0-9a-f]+$/.test(this.path)) return;
    showDialog('hydro-diagnose', [
      el('iframe', {
        class: 'report',
        src: this.path,
        sandbox: 'allow-scripts',
        title: 'Report of hydro-diagnose',
        referrerpolicy: 'no-referrer',
      }),
    ]);
  }

  async #openAll(files) {
    for (const file of files) {
      setText(this.result, `opening ${file.name}`);
      const opened = await this.api.openLog(file);
      setText(this.result, `${opened.name ?? file.name} is open${opened.problem ? `, but: ${opened.problem}` : ''}`);
      this.result.dataset.state = opened.problem ? 'bad' : '';
      this.opened = opened.run;
      this.#show(opened.run);
    }
  }

  // The server tells of the new run on the web socket, which may come after the answer.
  #show(number, tries = 50) {
    if (this.scope.runs.some((one) => one.run === number)) this.scope.select(number);
    else if (tries > 0) setTimeout(() => this.#show(number, tries - 1), 50);
  }

  async #close() {
    await this.api.close(this.scope.run.run);
  }

  #acceptFiles() {
    const over = (on) => {
      document.body.dataset.drop = on ? 'yes' : '';
    };
    const files = (event) => event.dataTransfer?.types.includes('Files');
    addEventListener('dragover', (event) => {
      if (files(event)) {
        event.preventDefault();
        over(true);
      }
    });
    addEventListener('dragleave', (event) => {
      if (!event.relatedTarget) over(false);
    });
    addEventListener('drop', (event) => {
      over(false);
      if (!files(event)) return;
      event.preventDefault();
      this.element.open = true;
      this.#guard(() => this.#openAll(event.dataTransfer.files));
    });
  }
}
