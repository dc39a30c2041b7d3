// The worker of a page with the renderer inside. burnish_core.mjs stands above this text, without its export.
(() => {
  'use strict';
  let core = null;
  const text = string => {
    const size = core.lengthBytesUTF8(string) + 1, at = core._malloc(size);
    if (!at) throw new RangeError('out of memory');
    core.stringToUTF8(string, at, size);
    return at;
  };
  const with_text = (strings, work) => {
    const at = strings.map(string => (string === undefined ? 0 : text(string)));
    try { return work(...at); } finally { at.forEach(core._free); }
  };

  async function begin({ module, files, target }) {
    core = await new Promise((resolve, reject) => {
      const instantiateWasm = (imports, done) => { WebAssembly.instantiate(module, imports).then(instance => done(instance, module)).catch(reject); return {}; };
      Module({ instantiateWasm, printErr: line => console.warn(line) }).then(resolve, reject);
    });
    for (const [name, bytes] of Object.entries(files)) {
      const path = '/' + name;
      core.FS.mkdirTree(path.slice(0, path.lastIndexOf('/')) || '/');
      core.FS.writeFile(path, new Uint8Array(bytes));
    }
    const error = core.UTF8ToString(with_text([target], core._burnish_page_open));
    if (error) throw new Error(error);
    return {};
  }

  // Joins bands: pixels of all of them, one after the other.
  function join(body, pixels) {
    const size = pixels.reduce((sum, part) => sum + part.byteLength, 0), at = core._malloc(size);
    if (!at) throw new RangeError('out of memory');
    let end = at >>> 0;
    for (const part of pixels) core.HEAPU8.set(new Uint8Array(part), end), end += part.byteLength;
    try { return with_text([body], text => core._burnish_page_join(text, at, size)); } finally { core._free(at); }
  }

  function answer({ path, body, pixels }) {
    const since = performance.now(), status = pixels ? join(body, pixels) : with_text([path, body], core._burnish_page_ask), at = core._burnish_page_body() >>> 0, size = core._burnish_page_size() >>> 0;
    return { status, info: core.UTF8ToString(core._burnish_page_info()), body: core.HEAPU8.slice(at, at + size).buffer, type: 'image/bmp', ms: performance.now() - since };
  }

  let lost = false;  // after a trap, what the module holds can no longer be trusted
  onmessage = async ({ data }) => {
    try {
      if (lost) throw new Error('The renderer ended. Load the page again.');
      const out = data.module ? await begin(data) : answer(data);
      postMessage({ id: data.id, ...out }, out.body ? [out.body] : []);
    } catch (fault) {
      const text = String((fault && fault.message) || fault), large = fault instanceof RangeError || /memory access|OOM|out of memory/.test(text);
      lost ||= !data.module;
      postMessage({ id: data.id, error: large ? 'The scene is too large for the memory of a page. Load the page again.' : text });
    }
  };
})();
