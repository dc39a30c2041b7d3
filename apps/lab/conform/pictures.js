// Parts that the pages of all engines share: the list of scenes, and the pictures as one file.

const folder = new URL('..', import.meta.url);

// Returns conform.json.
export async function read_conform() {
  const answer = await fetch(new URL('conform.json', folder));
  if (!answer.ok)
    throw new Error(`conform.json: ${answer.status}`);
  return answer.json();
}

// Returns the address of a file of the folder.
export function address(file) {
  return new URL(file, folder).href;
}

// Returns a picture as PFM. floats: red, green, blue and alpha a pixel, linear, from the lowest row on, as WebGL reads them.
export function pfm_of(width, height, floats) {
  const head = new TextEncoder().encode(`PF\n${width} ${height}\n-1.0\n`);
  const body = new Float32Array(width * height * 3);
  for (let i = 0; i < width * height; ++i)
    for (let c = 0; c < 3; ++c)
      body[3 * i + c] = floats[4 * i + c];
  const out = new Uint8Array(head.length + body.byteLength);
  out.set(head);
  out.set(new Uint8Array(body.buffer), head.length);
  return out;
}

// Returns a tar file. files: pairs of name and bytes.
function tar_of(files) {
  const parts = [];
  for (const [name, bytes] of files) {
    const head = new Uint8Array(512), put = (text, at) => head.set(new TextEncoder().encode(text), at);
    put(name, 0);
    put('0000644\0' + '0000000\0' + '0000000\0' + bytes.length.toString(8).padStart(11, '0') + '\0' + '00000000000\0' + '        0', 100);
    put('ustar\0' + '00', 257);
    put(head.reduce((sum, byte) => sum + byte, 0).toString(8).padStart(6, '0') + '\0 ', 148);
    parts.push(head, bytes, new Uint8Array((512 - bytes.length % 512) % 512));
  }
  parts.push(new Uint8Array(1024));
  return new Blob(parts, { type: 'application/x-tar' });
}

// Draws all scenes with draw(scene, conform), which returns floats as pfm_of() takes them, or null where the engine cannot draw the
// scene. Offers the pictures as a file. Shows progress and faults in the page's element #state.
export async function draw_all(draw) {
  const state = document.getElementById('state'), files = [], left_out = [], faults = [];
  let conform;
  try {
    conform = await read_conform();
  } catch (error) {
    state.textContent = String(error);
    return;
  }
  for (const scene of conform.scenes) {
    state.textContent = `drawing ${scene.name} ...`;
    try {
      const floats = await draw(scene, conform);
      if (floats) {
        files.push([scene.name + '.pfm', pfm_of(conform.width, conform.height, floats)]);
        continue;
      }
    } catch (error) {
      faults.push(`${scene.name}: ${error}`);
    }
    left_out.push(scene.name);
  }
  const link = document.createElement('a');
  link.href = URL.createObjectURL(tar_of(files));
  link.download = 'pictures.tar';
  link.textContent = 'pictures.tar';
  state.textContent = `${files.length} scenes drawn${left_out.length ? `; judge them --without ${left_out.join(',')}` : ''}: `;
  state.append(link, ...faults.map(text => Object.assign(document.createElement('p'), { textContent: text })));
  globalThis.drawn_pictures = files; // for programs that drive this page
}
