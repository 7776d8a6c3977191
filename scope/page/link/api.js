// What the page asks over HTTP: files, reports, whether the token is right. The token goes in a header, never
// in an address that a report or a log could see.

export class Api {
  constructor(token) {
    this.token = token;
  }

  // Why the server will not have this page: a sentence, or '' when it would, or cannot be reached.
  async refusal() {
    try {
      const answer = await this.#fetch('/api/status', { signal: AbortSignal.timeout(5000) });
      if (answer.status === 401) {
        return this.token
          ? 'The token is not (or no longer) right: hydro-scope makes a new one at each start. Open the address that it printed, or paste it here.'
          : 'A token is needed: open the address that hydro-scope printed, with #token=..., or paste it here.';
      }
      if (answer.status === 403) return `hydro-scope refuses this address: ${await errorOf(answer)}`;
      return '';
    } catch {
      return '';
    }
  }

  // The window as a file: {name, blob}. format: "lcmlog" or "csv".
  async cut(run, t0, t1, format, si) {
    const answer = await this.#post('/api/cut', { run, t0, t1, format, si });
    const name =
      /filename="?([^";]+)"?/.exec(answer.headers.get('Content-Disposition') ?? '')?.[1] ?? `window.${format}`;
    return { name, blob: await answer.blob() };
  }

  // Opens a log or table that was dragged in; {run, name}.
  async openLog(file) {
    const answer = await this.#fetch(`/api/open?name=${encodeURIComponent(file.name)}`, { method: 'POST', body: file });
    if (!answer.ok) throw new Error(await errorOf(answer));
    return answer.json();
  }

  async close(run) {
    return (await this.#post('/api/close', { run })).json();
  }

  async diagnose(run, t0, t1) {
    return (await this.#post('/api/diagnose', { run, t0, t1 })).json();
  }

  async job(job) {
    const answer = await this.#fetch(`/api/jobs/${encodeURIComponent(job)}`);
    if (!answer.ok) throw new Error(await errorOf(answer));
    return answer.json();
  }

  async #post(path, body) {
    const answer = await this.#fetch(path, {
      method: 'POST',
      body: JSON.stringify(body),
      headers: { 'Content-Type': 'application/json' },
    });
    if (!answer.ok) throw new Error(await errorOf(answer));
    return answer;
  }

  #fetch(path, options = {}) {
    return fetch(path, {
      ...options,
      cache: 'no-store',
      headers: { ...options.headers, Authorization: `Bearer ${this.token}` },
    });
  }
}

async function errorOf(answer) {
  try {
    return (await answer.json()).error ?? `answer ${answer.status}`;
  } catch {
    return `answer ${answer.status}`;
  }
}
