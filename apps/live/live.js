// The renderer inside a page: a worker that answers what the page of `burnish serve` asks of its server. A page of that kind finds it as
// window.burnish_live; other pages open one in a dialog.
(() => {
  'use strict';
  const data = JSON.parse(document.getElementById('burnish-page').textContent);
  const names = { page: Object.keys(data.rows)[0] };  // of the row that is shown

  const kTooOld = 'This browser is too old to draw: the picture is the one that the page was made with.';
  const kPatience = 3000;  // milliseconds: a picture under way for longer ends once nobody waits for it

  async function bytes_of(element) {
    const text = atob(element.textContent.trim()), packed = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) packed[i] = text.charCodeAt(i);
    element.remove();
    return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'))).arrayBuffer();
  }

  let opening = 0;  // dialogs that were closed so far
  let lost = null, begun = null, unpacked = null, running = null, asked = 0, lead = null;

  // A worker with a renderer of its own. ask(message) returns a promise of its answer.
  class Renderer {
    constructor(on_end) {
      this.waiting = new Map(), this.next = 0, this.on_end = on_end;
      this.worker = new Worker(URL.createObjectURL(new Blob([document.getElementById('burnish-worker').textContent], { type: 'text/javascript' })));
      this.worker.onmessage = ({ data: answer }) => {
        const wait = this.waiting.get(answer.id);
        this.waiting.delete(answer.id);
        if (!wait) return;
        if (answer.error) wait.reject(new Error(answer.error)); else wait.resolve(answer);
      };
      this.worker.onerror = event => { event.preventDefault(); this.end(new Error('The renderer ended: ' + (event.message || 'the page may not start it') + '. Load the page again.')); };
    }
    ask(message, transferred = []) {
      return new Promise((resolve, reject) => { this.waiting.set(++this.next, { resolve, reject }); this.worker.postMessage({ id: this.next, ...message }, transferred); });
    }
    end(error) {
      this.worker.terminate();
      this.on_end(error);
      for (const { reject } of this.waiting.values()) reject(error);
      this.waiting.clear();
    }
  }

  async function unpack() {
    if (typeof WebAssembly !== 'object' || typeof DecompressionStream !== 'function') throw new Error(kTooOld);
    const files = {};
    for (const element of document.querySelectorAll('script.burnish-file')) files[element.dataset.name] = await bytes_of(element);
    const wasm = await bytes_of(document.getElementById('burnish-wasm'));
    const module = await WebAssembly.compile(wasm).catch(fault => { throw fault instanceof WebAssembly.CompileError ? new Error(kTooOld) : fault; });
    return { files, module, target: data.target };
  }

  // Small phones keep the picture that the page was made with until their reader asks for more.
  const small = (navigator.deviceMemory || 8) <= 1 || (matchMedia('(pointer: coarse)').matches && Math.min(screen.width, screen.height) <= 480);
  let wanted = !small;
  function until_wanted() {
    return wanted || new Promise(resolve => {
      const button = Object.assign(document.createElement('button'), { id: 'burnish-begin', textContent: 'Draw here' });
      button.style.cssText = 'position: fixed; z-index: 9; left: 50%; bottom: 1em; transform: translateX(-50%); padding: .6em 1.2em; font: inherit';
      button.addEventListener('click', () => { wanted = true; button.remove(); resolve(); });
      document.body.append(button);
    });
  }

  // Holds the page's load event until its first whole picture: programs that photograph pages wait for that event.
  const hold = document.createElement('iframe');
  function hold_load() {
    if (document.readyState === 'complete') return;
    hold.hidden = true;
    document.body.append(hold);
    hold.contentDocument.open();
  }

  async function begin() {
    await until_wanted();
    hold_load();
    unpacked ||= unpack();
    const contents = await unpacked;
    lead = new Renderer(error => { if (error.name !== 'AbortError') lost = error; });
    await lead.ask(contents);
  }

  // Ends a picture that nobody waits for any more and that goes on: with its workers, which keep nothing.
  function end_forgotten() {
    if (!running || !running.signal || !running.signal.aborted || performance.now() - running.since < kPatience) return;
    running = null;
    for (const renderer of [lead, ...starting, ...helpers]) renderer.end(new DOMException('', 'AbortError'));
    begun = null;
  }

  // --- Several workers draw bands of one picture. Bits do not depend on the bands.

  const kMostWorkers = 4, kMostShared = 1 << 22;     // kMostShared: pixels, whose floats the workers exchange
  const kMostBytes = 1 << 30, kWorkerBytes = 100e6;  // of all workers; of one without the scene
  const starting = new Set(), helpers = new Set(), wholes = new Set();  // wholes: keys of pictures that have no bands
  let in_bands = 0, ends = [0, 1];  // in_bands: pictures so far; ends: shares of the height where bands begin and end

  const key_of = ({ scene, options }) => JSON.stringify([scene, Object.entries(options || {}).filter(([name]) => !['--eye', '--target', '--fov', '--orbit', '--zoom'].includes(name))]);
  const pixels_of = body => body.width * body.height / (body.reduction || 1) ** 2;
  const may_share = body => pixels_of(body) <= kMostShared && !wholes.has(key_of(body));
  const ask_part = (renderer, picture, from, to) => renderer.ask({ path: '/part', body: JSON.stringify({ picture, from, to }) });

  // Starts the helpers after a first picture that has bands. They prepare that picture's scene.
  async function hire(body) {
    const mine = lead, { files } = await unpacked, bytes = Object.values(files).reduce((sum, file) => sum + file.byteLength, 0);
    const most = Math.min(kMostWorkers, navigator.hardwareConcurrency || 1, Math.floor(kMostBytes / (kWorkerBytes + 4 * bytes)));
    if (1 + starting.size + helpers.size >= most || !may_share(body)) return;
    const first = await ask_part(mine, body, 0, 0.1);  // a band without rows is never refused
    if (first.status === 409) wholes.add(key_of(body));
    while (first.status === 200 && mine === lead && 1 + starting.size + helpers.size < most) start_helper(body);
  }

  async function start_helper(body) {
    const helper = new Renderer(() => { starting.delete(helper), helpers.delete(helper); });
    starting.add(helper);
    try {
      await helper.ask(await unpacked);
      await ask_part(helper, body, 0, 0.01);
      if (starting.delete(helper)) helpers.add(helper);
    } catch (fault) { helper.end(fault); }  // a page of fewer workers
  }

  // Moves the ends of bands so that each would have taken equally long.
  function balance(took) {
    const all = took.reduce((sum, ms) => sum + ms, 0), each = all / took.length, moved = [0];
    let sum = 0, band = 0;
    for (let k = 1; k < took.length; ++k) {
      while (band < took.length - 1 && sum + took[band] < k * each) sum += took[band++];
      moved.push(ends[band] + (ends[band + 1] - ends[band]) * (k * each - sum) / Math.max(took[band], 1e-3));
    }
    ends = [...moved.map((end, k) => 0.5 * (end + ends[k])), 1];
  }

  // Returns the answer of /draw, or nothing where the picture has no bands, or a helper ended. mine: the lead, which must stay the same.
  async function draw_in_bands(mine, body) {
    const workers = [mine, ...helpers], since = performance.now();
    if (ends.length !== workers.length + 1) ends = Array.from({ length: workers.length + 1 }, (_, k) => k / workers.length);
    const used = ends;
    const parts = await Promise.all(workers.map((worker, k) => ask_part(worker, body, used[k], used[k + 1]).catch(fault => {
      if (worker === mine || fault.name === 'AbortError') throw fault;
      worker.end(fault);
      return {};
    })));
    if (parts.some(part => part.status === 409)) wholes.add(key_of(body));
    if (parts.some(part => part.status !== 200)) return null;
    const pixels = parts.map(part => part.body), bands = parts.map(part => JSON.parse(part.info));
    const joined = await mine.ask({ path: '/join', body: JSON.stringify({ picture: body, bands, ms: performance.now() - since }), pixels }, pixels);
    if (joined.status !== 200) return null;
    ++in_bands;
    if (body.reduction === 1) balance(parts.map(part => part.ms));
    return joined;
  }

  async function answer_to(path, body) {
    const mine = lead;
    if (path === '/draw' && helpers.size && may_share(body) && (await mine.ask({ path: '/kept', body: JSON.stringify(body) })).status !== 200) {
      const joined = await draw_in_bands(mine, body);
      if (joined) return joined;
    }
    if (mine !== lead) throw new DOMException('', 'AbortError');
    const answer = await mine.ask({ path, body: body && JSON.stringify(body) });
    if (path === '/draw' && answer.status === 200 && body.reduction === 1) hire(body).catch(() => {});
    return answer;
  }

  const ready = () => begun ||= begin().catch(fault => { begun = null, hold.remove(); throw fault; });

  // One question is with the workers; of the others, those that are still wanted wait.
  let last = Promise.resolve();
  function ask(path, body, signal) {
    asked = performance.now();
    end_forgotten();
    const own = opening;
    setTimeout(end_forgotten, kPatience);
    const mine = last.catch(() => {}).then(async () => {
      await ready();
      if (lost) throw lost;
      if ((signal && signal.aborted) || own !== opening) throw new DOMException('', 'AbortError');
      running = { signal, since: performance.now() };
      try {
        return await answer_to(path, body);
      } finally {
        running = null;
        if (path === '/draw' && body.reduction === 1) setTimeout(() => hold.remove());
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
    names.page = key, wanted = true;
    const dialog = document.createElement('dialog'), close = document.createElement('button'), frame = document.createElement('iframe');
    dialog.className = 'burnish-live';
    dialog.setAttribute('aria-label', 'The picture, drawn here');
    dialog.style.cssText = 'width: 98vw; height: 98vh; max-width: none; max-height: none; padding: 0; border: 0; display: grid; grid-template-rows: auto 1fr';
    close.textContent = 'Close', close.style.cssText = 'justify-self: end; margin: 2px';
    close.addEventListener('click', () => dialog.close());
    dialog.addEventListener('close', () => {
      dialog.remove();
      ++opening;  // nobody waits for its pictures
      if (running) running.signal = { aborted: true };
      setTimeout(end_forgotten, kPatience);
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

  window.burnish_live = { ask, prove, button, get page() { return data.rows[names.page]; }, get workers() { return 1 + helpers.size; }, get in_bands() { return in_bands; } };
})();
