// The renderer inside a page: a worker that answers what the page of `burnish serve` asks of its server. A page of that kind finds it as
// window.burnish_live; other pages open one in a dialog.
(() => {
  'use strict';
  const data = JSON.parse(document.getElementById('burnish-page').textContent);
  const names = { page: Object.keys(data.rows)[0] };  // of the row that is shown

  const kTooOld = 'This browser is too old to draw: the picture is the one that the page was made with.';
  const kPatience = 3000;  // milliseconds that a picture may go on which nobody waits for

  async function bytes_of(element) {
    const text = atob(element.textContent.trim()), packed = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) packed[i] = text.charCodeAt(i);
    element.remove();
    return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'))).arrayBuffer();
  }

  const waiting = new Map();
  let next = 0, worker = null, lost = null, begun = null, kept = null, running = null, asked = 0;
  const post = message => new Promise((resolve, reject) => { waiting.set(++next, { resolve, reject }); worker.postMessage({ id: next, ...message }); });
  const reject_all = error => { for (const { reject } of waiting.values()) reject(error); waiting.clear(); };
  const lose = text => { lost = new Error(text); reject_all(lost); };

  async function unpack() {
    if (typeof WebAssembly !== 'object' || typeof DecompressionStream !== 'function') throw new Error(kTooOld);
    const files = {};
    for (const element of document.querySelectorAll('script.burnish-file')) files[element.dataset.name] = await bytes_of(element);
    return { files, wasm: await bytes_of(document.getElementById('burnish-wasm')), target: data.target };
  }

  async function begin() {
    kept ||= unpack();
    const contents = await kept;
    worker = new Worker(URL.createObjectURL(new Blob([document.getElementById('burnish-worker').textContent], { type: 'text/javascript' })));
    worker.onmessage = ({ data: answer }) => {
      const wait = waiting.get(answer.id);
      waiting.delete(answer.id);
      if (!wait) return;
      if (answer.error) wait.reject(new Error(/CompileError/.test(answer.error) ? kTooOld : answer.error)); else wait.resolve(answer);
    };
    worker.onerror = event => { event.preventDefault(); lose('The renderer ended: ' + (event.message || 'the page may not start it') + '. Load the page again.'); };
    await post(contents);
  }

  // Ends a picture that nobody waits for any more and that goes on: with its worker, which keeps nothing.
  function end_forgotten() {
    if (!running || !running.signal || !running.signal.aborted || performance.now() - running.since < kPatience) return;
    running = null;
    worker.terminate();
    reject_all(new DOMException('', 'AbortError'));
    begun = begin();
  }

  // One question is with the worker; of the others, those that are still wanted wait.
  let last = Promise.resolve();
  function ask(path, body, signal) {
    begun ||= begin();
    asked = performance.now();
    end_forgotten();
    setTimeout(end_forgotten, kPatience);
    const mine = last.catch(() => {}).then(async () => {
      await begun;
      if (lost) throw lost;
      if (signal && signal.aborted) throw new DOMException('', 'AbortError');
      running = { signal, since: performance.now() };
      try {
        return await post({ path, body: body && JSON.stringify(body) });
      } finally {
        running = null;
      }
    });
    last = mine;
    const escaped = text => text.replace(/[^\x20-\x7e]/g, c => '\\u' + c.charCodeAt(0).toString(16).padStart(4, '0'));
    return mine.then(({ status, info, body: content, type }) => ({
      ok: status === 200, status, statusText: '', headers: new Headers(info ? { 'X-Burnish': escaped(info) } : {}),
      json: async () => JSON.parse(new TextDecoder().decode(content)), blob: async () => new Blob([content], { type }),
    }));
  }

  // Draws once more what was drawn when the page was made, and compares the bits. element: of the page that shows the picture.
  async function prove(element) {
    const { scene, environment, options, width, height, hash, command } = data.rows[names.page], body = element.ownerDocument.body;
    while (!body.dataset.done || performance.now() - asked < 1000) { // the reader's pictures first
      await new Promise(resolve => setTimeout(resolve, 100));
      if (!element.isConnected || !element.ownerDocument.defaultView) return;
    }
    try {
      const answer = await ask('/draw', { scene, environment, options, width, height, reduction: 1 });
      if (!answer.ok) throw new Error((await answer.json()).error);
      const info = JSON.parse(answer.headers.get('X-Burnish'));
      const same = info.hash === hash;
      element.className = same ? 'good' : 'bad';
      element.textContent = same ? `\u2713 the bits of the machine that made this page: ${hash}` : `\u2717 this browser draws ${info.hash}, the machine that made this page ${hash}`;
      element.title = command;
      body.dataset.proof = same ? 'same' : 'other';
    } catch (fault) {
      element.className = 'bad', element.textContent = fault.message;
    }
  }

  let studio = null;
  // Opens the page of `burnish serve` over this one, with a row's scene and options.
  async function open(key) {
    names.page = key;
    const dialog = document.createElement('dialog'), close = document.createElement('button'), frame = document.createElement('iframe');
    dialog.className = 'burnish-live';
    dialog.setAttribute('aria-label', 'The picture, drawn here');
    dialog.style.cssText = 'width: 98vw; height: 98vh; max-width: none; max-height: none; padding: 0; border: 0; display: grid; grid-template-rows: auto 1fr';
    close.textContent = 'Close', close.style.cssText = 'justify-self: end; margin: 2px';
    close.addEventListener('click', () => dialog.close());
    dialog.addEventListener('close', () => {
      dialog.remove();
      if (running) running.signal = { aborted: true };  // nobody waits for its picture
    });
    frame.style.cssText = 'width: 100%; height: 100%; border: 0';
    frame.title = 'The picture, drawn here';
    dialog.append(close, frame);
    document.body.append(dialog);
    dialog.showModal();
    try {
      if (typeof DecompressionStream !== 'function') throw new Error(kTooOld);
      studio ||= bytes_of(document.getElementById('burnish-studio')).then(bytes => new TextDecoder().decode(bytes));
      frame.srcdoc = await studio;
    } catch (fault) {
      frame.replaceWith(Object.assign(document.createElement('p'), { textContent: fault.message }));
    }
  }

  // A button that opens a row; none for a row that the page cannot draw.
  function button(key) {
    if (!Object.hasOwn(data.rows, key)) return '';
    const made = document.createElement('button');
    made.type = 'button', made.className = 'burnish-open', made.textContent = 'Live', made.title = data.rows[key].command;
    made.addEventListener('click', () => open(key));
    return made;
  }

  window.burnish_live = { ask, prove, button, get page() { return data.rows[names.page]; } };
})();
