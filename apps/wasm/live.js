// The renderer inside a page: a worker that answers what the page of `burnish serve` asks of its server.
(() => {
  'use strict';
  const page = JSON.parse(document.getElementById('burnish-page').textContent);

  async function bytes_of(element) {
    const packed = Uint8Array.from(atob(element.textContent.trim()), c => c.charCodeAt(0));
    element.remove();
    return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'))).arrayBuffer();
  }

  let next = 0;
  const waiting = new Map();
  const post = (message, transfer) => new Promise((resolve, reject) => { waiting.set(++next, { resolve, reject }); worker.postMessage({ id: next, ...message }, transfer); });
  const source = document.getElementById('burnish-worker').textContent;
  let worker, lost = null;
  const lose = text => { lost = new Error(text); for (const { reject } of waiting.values()) reject(lost); waiting.clear(); };

  const begun = (async () => {
    if (typeof WebAssembly !== 'object' || typeof DecompressionStream !== 'function')
      throw new Error('This browser is too old to draw: the picture is the one that the page was made with.');
    const files = {}, transfer = [];
    for (const element of document.querySelectorAll('script.burnish-file')) {
      files[element.dataset.name] = await bytes_of(element);
      transfer.push(files[element.dataset.name]);
    }
    const wasm = await bytes_of(document.getElementById('burnish-wasm'));
    transfer.push(wasm);
    worker = new Worker(URL.createObjectURL(new Blob([source], { type: 'text/javascript' })));
    worker.onmessage = ({ data }) => {
      const wait = waiting.get(data.id);
      waiting.delete(data.id);
      if (!wait) return;
      if (data.error) wait.reject(new Error(data.error)); else wait.resolve(data);
    };
    worker.onerror = event => { event.preventDefault(); lose('The renderer ended: ' + (event.message || 'no memory') + '. Load the page again.'); };
    await post({ wasm, files, target: page.target }, transfer);
  })();
  begun.catch(() => {});

  // One question is with the worker; of the others, those that are still wanted wait.
  let last = begun;
  const ask = (path, body, signal) => {
    const mine = last.catch(() => {}).then(async () => {
      await begun;
      if (lost) throw lost;
      if (signal && signal.aborted) throw new DOMException('', 'AbortError');
      return post({ path, body: body && JSON.stringify({ ...body }) });
    });
    last = mine;
    return mine.then(({ status, info, body: content, type }) => ({
      ok: status === 200, status, statusText: '', headers: new Headers(info ? { 'X-Burnish': info.replace(/[^\x20-\x7e]/g, c => '\\u' + c.charCodeAt(0).toString(16).padStart(4, '0')) } : {}),
      json: async () => JSON.parse(new TextDecoder().decode(content)), blob: async () => new Blob([content], { type }),
    }));
  };

  // Draws once more what was drawn when the page was made, and compares the bits.
  const prove = async element => {
    if (!page.made) return;
    while (!document.body.dataset.done) await new Promise(resolve => setTimeout(resolve, 100)); // the reader's picture first
    try {
      const { hash } = JSON.parse((await ask('/draw', page.made.request)).headers.get('X-Burnish'));
      const same = hash === page.made.hash;
      element.className = same ? 'good' : 'bad';
      element.textContent = same ? `\u2713 the bits of the machine that made this page: ${hash}` : `\u2717 this browser draws ${hash}, the machine that made this page ${page.made.hash}`;
      element.title = page.made.command;
      document.body.dataset.proof = same ? 'same' : 'other';
    } catch (fault) {
      element.className = 'bad', element.textContent = fault.message;
    }
  };
  window.burnish_live = { ask, prove, page };
})();
