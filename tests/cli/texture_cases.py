"""bake environment --format: cubes, tables and lights for engines, read by readers of this file's own."""

import functools
import http.server
import json
import math
import os
import pathlib
import re
import shutil
import struct
import subprocess
import threading

from browser import Browser
from harness import Skipped, case, check, scratch

BAKE = ("bake", "environment", "builtin:sky", "--env-size", "32", "--env-samples", "16", "-q")
CUBES = ("specular", "box", "irradiance", "whole")
CHANNELS = {97: (4, "e"), 83: (2, "e"), 109: (4, "f"), 103: (2, "f")}  # of VkFormat
DXGI = {10: (4, "e"), 34: (2, "e"), 2: (4, "f"), 16: (2, "f")}


def ktx2(path):
    """Returns the levels of a KTX2 file: [(side, faces)], a face being rows of texels."""
    data = path.read_bytes()
    check(data[:12] == b"\xabKTX 20\xbb\r\n\x1a\n", f"{path}: {data[:12]}")
    form, size, width, height, depth, layers, faces, levels, packed = struct.unpack_from("<9I", data, 12)
    channels, kind = CHANNELS[form]
    texel = channels * struct.calcsize(kind)
    check(size == struct.calcsize(kind) and depth == layers == packed == 0 and faces in (1, 6), f"{path}: header")
    at, length, pairs_at, pairs = struct.unpack_from("<4I", data, 48)
    check(struct.unpack_from("<2I2H4B4B8B", data, at) == (length, 0, 2, length - 4, 1, 1, 1, 0, 0, 0, 0, 0, texel) + 7 * (0,), f"{path}: descriptor")
    samples = [struct.unpack_from("<H2B4B2I", data, at + 28 + 16 * c) for c in range(channels)]
    check(samples == [(8 * size * c, 8 * size - 1, 0xC0 | (c if c < 3 else 15), 0, 0, 0, 0, 0xBF800000, 0x3F800000) for c in range(channels)], f"{path}: {samples}")
    check(b"KTXorientation\0rd\0" in data[pairs_at:pairs_at + pairs], f"{path}: no orientation")
    index = [struct.unpack_from("<3Q", data, 80 + 24 * level) for level in range(levels)]
    check(index[0][0] + index[0][1] == len(data) and [entry[0] for entry in index] == sorted((entry[0] for entry in index), reverse=True), f"{path}: order")
    out = []
    for level, (begin, count, plain) in enumerate(index):
        sides = max(width >> level, 1), max(height >> level, 1)
        check(begin % texel == 0 and count == plain == texel * sides[0] * sides[1] * faces, f"{path}: level {level}")
        out.append(struct.unpack_from(f"<{count // struct.calcsize(kind)}{kind}", data, begin))
    return (width, faces, channels), out


def dds(path):
    """Returns the same of a DDS file."""
    data = path.read_bytes()
    check(data[:4] == b"DDS " and struct.unpack_from("<I", data, 4) == (124,) and data[84:88] == b"DX10", f"{path}: header")
    height, width, pitch = struct.unpack_from("<3I", data, 12)
    levels, (form, dimension, cube, size) = struct.unpack_from("<I", data, 28)[0], struct.unpack_from("<4I", data, 128)
    channels, kind = DXGI[form]
    faces = 6 if cube == 4 else 1
    check(dimension == 3 and size == 1 and pitch == width * channels * struct.calcsize(kind) and (struct.unpack_from("<I", data, 112)[0] == (0xFE00 if faces == 6 else 0)), f"{path}: DX10")
    out, at = [() for _ in range(levels)], 148
    for _ in range(faces):
        for level in range(levels):
            count = channels * max(width >> level, 1) * max(height >> level, 1)
            out[level] += struct.unpack_from(f"<{count}{kind}", data, at)
            at += count * struct.calcsize(kind)
    check(at == len(data), f"{path}: {len(data)} bytes, not {at}")
    return (width, faces, channels), out


def direction_of(face, s, t):
    """Returns the direction of a place on a face, as Vulkan and OpenGL have it. s: to the right, t: downwards, -1 to 1."""
    v = ((1, -t, -s), (-1, -t, s), (s, 1, t), (s, -1, -t), (s, -t, 1), (-s, -t, -1))[face]
    length = math.sqrt(sum(c * c for c in v))
    return [c / length for c in v]


def close(a, b, step):
    return all(abs(x - y) <= step * max(abs(x), 1e-4) for x, y in zip(a, b))


@case("bake.textures_for_engines_hold_the_same_light", budget=15)
def textures(bench):
    """Bakes once a kind of texture, and reads all texels in Python."""
    alone = bench.run(*BAKE, "-o", "plain").expect(0)
    plain = {path.name: path.read_bytes() for path in (bench.folder / "plain").iterdir()}
    check(list(plain) == ["environment.bnenv"], alone.describe())
    for words, folder in ((("ktx2",), "k"), (("ktx2", "--texels", "float"), "kf"), (("dds",), "d"), (("dds", "--texels", "float"), "df"), (("exr",), "e")):
        bench.run(*BAKE, "--textures", *words, "-o", folder).expect(0)
        check((bench.folder / folder / "environment.bnenv").read_bytes() == plain["environment.bnenv"], f"{folder}: another bake")
    for name in (*CUBES, "dfg", "lobe_albedo", "ltc"):
        halves, floats = ktx2(bench.folder / f"k/{name}.ktx2"), ktx2(bench.folder / f"kf/{name}.ktx2")
        check(halves == dds(bench.folder / f"d/{name}.dds") and floats == dds(bench.folder / f"df/{name}.dds"), f"{name}: formats differ")
        check(halves[0] == floats[0] == {"irradiance": (32, 6, 4), "dfg": (64, 1, 2), "lobe_albedo": (200, 1, 2), "ltc": (192, 1, 4)}.get(name, (32, 6, 4)), f"{name}: {halves[0]}")
        check(all(close(a, b, 2 ** -11) for a, b in zip(floats[1], halves[1])), f"{name}: halves are not those of the floats")
        check(len(halves[1]) == {"specular": 5, "box": 6, "irradiance": 1, "whole": 1, "dfg": 1, "lobe_albedo": 1, "ltc": 1}[name], f"{name}: {len(halves[1])} levels")
    of_four = {name: b"chlist\0" in head and b"\0A\0" in head[head.index(b"chlist"):][:40] for name in ("ltc", "dfg")
               for head in [(bench.folder / f"e/{name}.exr").read_bytes()[:400]]}
    check(of_four == {"ltc": True, "dfg": False}, f"channels of pictures: {of_four}")
    # The table: all is reflected by a mirror that is seen from straight above
    scale, bias = ktx2(bench.folder / "kf/dfg.ktx2")[1][0][2 * 63:2 * 64]
    check(abs(scale - 1) < 1e-3 and abs(bias) < 1e-3, f"{scale} {bias}")
    # The brightest texel is the sun, where the extracted light is
    whole = ktx2(bench.folder / "kf/whole.ktx2")[1][0]
    at = max(range(len(whole) // 4), key=lambda i: whole[4 * i])
    face, row, column = at // 1024, at // 32 % 32, at % 32
    light = json.loads((bench.folder / "k/key_lights.json").read_text())[0]
    seen = direction_of(face, (2 * column + 1) / 32 - 1, (2 * row + 1) / 32 - 1)
    check(sum(a * b for a, b in zip(seen, light["direction"])) > 0.998, f"{seen} {light}")
    specular = ktx2(bench.folder / "kf/specular.ktx2")[1][0]
    check(max(specular[::4]) < 0.5 * max(whole[::4]), "the sun is in the prefiltered levels")
    # Blue above, ground below
    up, down = (sum(specular[4 * 1024 * face + 4 * 528 + 2:4 * 1024 * face + 4 * 528 + 3]) for face in (2, 3))
    check(up > 2 * down, f"{up} above, {down} below")
    # Faces as pictures
    pictures = sorted(path.name for path in (bench.folder / "e").glob("specular_*.exr"))
    check(len(pictures) == 6 * 5 and pictures[:2] == ["specular_00_nx.exr", "specular_00_ny.exr"], f"{pictures}")
    for level, name in ((0, "specular_00"), (2, "specular_02")):
        texels, side = ktx2(bench.folder / "kf/specular.ktx2")[1][level], 32 >> level
        for face, end in enumerate(("px", "nx", "py", "ny", "pz", "nz")):
            pixels = [texels[4 * (side * side * face + i):4 * (side * side * face + i) + 3] for i in range(side * side)]
            rows = [pixels[side * y:side * y + side] for y in reversed(range(side))]
            scratch(bench, "face.pfm", f"PF\n{side} {side}\n-1.0\n".encode() + struct.pack(f"<{3 * side * side}f", *[v for row in rows for p in row for v in p]))
            bench.run("compare", f"e/{name}_{end}.exr", "face.pfm", "--fail-flip", "1e-9", "-q").expect(0)
    # A smaller bake leaves no levels of a larger one behind
    small = ["16" if word == "32" else word for word in BAKE]
    bench.run(*small, "--textures", "exr", "-o", "e").expect(0)
    names = {path.name for path in (bench.folder / "e").glob("*.exr")}
    bench.run(*small, "--textures", "exr", "-o", "fresh").expect(0)
    check(names == {path.name for path in (bench.folder / "fresh").glob("*.exr")}, f"{names}")
    # A bake without extracted lights leaves no texture of theirs behind
    bench.run(*BAKE, "--key-lights", "off", "--textures", "ktx2", "-o", "k").expect(0)
    check(not (bench.folder / "k/whole.ktx2").exists(), "whole.ktx2 of an earlier bake")


@case("bake.key_lights_compile_as_glsl", budget=4)
def lights(bench):
    for name, words, count in (("sun", (), 1), ("none", ("--key-lights", "off"), 0)):
        bench.run(*BAKE, *words, "--textures", "ktx2", "-o", name).expect(0)
        text = (bench.folder / name / "key_lights.glsl").read_text()
        check(f"burnish_key_light_count = {count};" in text and len(json.loads((bench.folder / name / "key_lights.json").read_text())) == count, text)
        check((bench.folder / name / "whole.ktx2").exists() == (count > 0), f"{name}: whole")
        if shutil.which("glslc"):
            scratch(bench, "lights.frag", ("#version 450\n" + text + "layout(location = 0) out vec4 c;\nvoid main() { c = vec4(burnish_key_lights[0].irradiance, burnish_key_light_count); }\n").encode())
            for block in ((), ("-DBURNISH_KEY_LIGHTS_BLOCK", "-DBURNISH_KEY_LIGHTS_LAYOUT=std140, binding = 3")):
                done = subprocess.run(["glslc", *block, bench.folder / "lights.frag", "-o", bench.folder / "lights.spv"], capture_output=True, text=True)
                check(done.returncode == 0, done.stderr)
            if shutil.which("spirv-dis"):
                text = subprocess.run(["spirv-dis", bench.folder / "lights.spv"], capture_output=True, text=True).stdout
                offsets = [int(n) for n in re.findall(r"OpMemberDecorate %burnish_key_light \d Offset (\d+)", text)]
                check(offsets == [0, 16, 32, 48, 60] and "ArrayStride 64" in text, f"{offsets}: another layout than the file's")
        data = (bench.folder / name / "key_lights.bin").read_bytes()
        check(len(data) == 16 + 8 * 64 and struct.unpack_from("<i", data)[0] == count, "the block")
        for i, light in enumerate(json.loads((bench.folder / name / "key_lights.json").read_text())):
            row = struct.unpack_from("<16f", data, 16 + 64 * i)
            check(all(abs(a - b) < 1e-6 * max(1, abs(b)) for a, b in zip(row[0:3] + row[4:7], light["direction"] + light["irradiance"])), f"{row} {light}")


@case("bake.textures_say_what_half_floats_lose", budget=5)
def beyond(bench):
    scratch(bench, "sun.pfm", b"PF\n8 4\n-1.0\n" + struct.pack("<96f", *[3e6 if i == 40 else 0.5 for i in range(96)]))
    words = ("bake", "environment", "sun.pfm", "--env-size", "16", "--env-samples", "4", "--key-lights", "off", "--textures", "ktx2")
    said = bench.run(*words, "-o", "half").expect(0)
    check("beyond half floats" in said.err and "specular" in said.err, said.describe())
    kept = bench.run(*words, "--texels", "float", "-o", "float").expect(0)
    check("half floats" not in kept.err, kept.describe())
    check(max(ktx2(bench.folder / "half/specular.ktx2")[1][0]) == 65504 and max(ktx2(bench.folder / "float/specular.ktx2")[1][0]) > 1e5, "clamped values")
    bench.run(*BAKE, "--texels", "float", "-o", "x").expect(2).expect_one_line("--texels")
    bench.run(*BAKE, "--textures", "png", "-o", "x").expect(2).expect_one_line("--textures")
    for wrong, needle in (((*BAKE, "--format", "png-levels"), "environment"), ((*BAKE, "--format", "dds", "--textures", "dds"), "--textures"),
                          (("bake", "mip", "builtin:bumps", "--format", "ktx2"), "png-levels"), (("bake", "direction", "sun.pfm", "--format", "exr"), "mip")):
        bench.run(*wrong, "-o", "x").expect(2).expect_one_line("--", needle)
    for option in ("--format", "--textures"):
        bench.run(*BAKE, option, "ktx2", "-o", option[2:]).expect(0)
    check({p.name: p.read_bytes() for p in (bench.folder / "format").iterdir()} == {p.name: p.read_bytes() for p in (bench.folder / "textures").iterdir()}, "both names do not write the same")
    check((bench.folder / "format/ltc.ktx2").exists(), "no textures")
    bench.run("bake", "quaternion", "sun.pfm", "--textures", "dds", "-o", "x.png").expect(2).expect_one_line("--textures")
    (bench.folder / "half/dfg.ktx2").unlink()
    (bench.folder / "half/dfg.ktx2").mkdir()
    bench.run(*words, "-q", "-o", "half").expect(7).expect_one_line("dfg.ktx2")


READERS = """<!doctype html><script type="importmap">{ "imports": { "three": "./node_modules/three/build/three.module.js" } }</script>
<script type="module">
import * as THREE from 'three';
import { read } from './node_modules/three/examples/jsm/libs/ktx-parse.module.js';
import { KTX2Loader } from './node_modules/three/examples/jsm/loaders/KTX2Loader.js';
const renderer = new THREE.WebGLRenderer(), target = new THREE.WebGLRenderTarget(1, 1, { type: THREE.FloatType });
// Returns a texel of a texture, as the card reads it: at x, y, or in a direction of a cube.
const drawn = (texture, at) => {
  const kind = texture.isCubeTexture ? 'samplerCube' : 'sampler2D', read = texture.isCubeTexture ? 'textureLod(map, at, 0.0)' : 'texelFetch(map, ivec2(at.xy), 0)';
  const material = new THREE.RawShaderMaterial({ glslVersion: THREE.GLSL3, uniforms: { map: { value: texture }, at: { value: new THREE.Vector3(...at) } },
    vertexShader: 'in vec3 position; void main() { gl_Position = vec4(position, 1.0); }',
    fragmentShader: `precision highp float; precision highp ${kind}; uniform ${kind} map; uniform vec3 at; out vec4 to; void main() { to = ${read}; }` });
  const scene = new THREE.Scene(), value = new Float32Array(4);
  scene.add(new THREE.Mesh(new THREE.PlaneGeometry(2, 2), material));
  renderer.setRenderTarget(target), renderer.render(scene, new THREE.Camera()), renderer.readRenderTargetPixels(target, 0, 0, 1, 1, value);
  return [...value];
};
// Returns a level's numbers.
const numbers = (level, form) => [97, 83].includes(form) ? Float32Array.from(new Uint16Array(level.slice().buffer), THREE.DataUtils.fromHalfFloat) : new Float32Array(level.slice().buffer);
const out = {};
try {
  for (const name of NAMES) {
    const buffer = await (await fetch(`tables/${name}.ktx2`)).arrayBuffer(), file = read(new Uint8Array(buffer));
    const sum = level => numbers(level, file.vkFormat).reduce((a, v) => a + v, 0);
    out[name] = { form: file.vkFormat, width: file.pixelWidth, faces: file.faceCount, sums: file.levels.map(l => sum(l.levelData)) };
    if (file.faceCount === 1) {
      const texture = await new Promise((done, failed) => { const loader = new KTX2Loader(); loader.workerConfig = {}; loader.parse(buffer, done, failed); });
      const data = texture.image.data, width = texture.image.width, height = texture.image.height, x = width >> 1, y = height >> 2, n = data.length / width / height;
      const all = numbers(new Uint8Array(data.buffer, data.byteOffset, data.byteLength), file.vkFormat);
      out[name].loaded = [width, height, texture.type, all.reduce((a, v) => a + v, 0)];
      out[name].texel = [...all.slice((y * width + x) * n, (y * width + x + 1) * n)], out[name].drawn = drawn(texture, [x, y, 0]).slice(0, n);
    } else { // three.js' loader takes uncompressed cubes for flat pictures, so their faces go to a cube by hand
      const side = file.pixelWidth, bytes = file.levels[0].levelData, each = bytes.length / 6, half = file.vkFormat === 97, type = half ? THREE.HalfFloatType : THREE.FloatType;
      const faces = [0, 1, 2, 3, 4, 5].map(k => { const part = bytes.slice(k * each, (k + 1) * each).buffer;
        return new THREE.DataTexture(half ? new Uint16Array(part) : new Float32Array(part), side, side, THREE.RGBAFormat, type); });
      const cube = new THREE.CubeTexture(faces);
      Object.assign(cube, { format: THREE.RGBAFormat, type, minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter, generateMipmaps: false, needsUpdate: true });
      const x = side >> 1, y = side >> 2, u = 2 * (x + 0.5) / side - 1, v = 2 * (y + 0.5) / side - 1; // on +X, then on -Z
      const of = k => [...numbers(bytes.slice(k * each, (k + 1) * each), file.vkFormat).slice(4 * (y * side + x), 4 * (y * side + x) + 4)];
      out[name].texel = [...of(0), ...of(5)], out[name].drawn = [...drawn(cube, [1, -v, -u]), ...drawn(cube, [-u, -v, -1])];
    }
  }
  window.answer = JSON.stringify(out);
} catch (e) { window.answer = JSON.stringify({ failed: String(e.stack || e) }); }
</script>
"""


def read_by_engines(bench, texels):
    bench.run(*BAKE, "--format", "ktx2", "--texels", texels, "-o", "tables").expect(0)
    names = sorted(path.stem for path in (bench.folder / "tables").glob("*.ktx2"))
    check({"specular", "box", "whole", "irradiance", "dfg", "lobe_albedo", "ltc"} <= set(names), f"{names}")
    (bench.folder / "read.html").write_text(READERS.replace("NAMES", json.dumps(names)))

    class Quiet(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_):
            pass

    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=bench.folder)) as host:
        threading.Thread(target=host.serve_forever, daemon=True).start()
        with Browser(bench.folder / "browser", webgl=True) as browser:
            browser.visit(f"http://127.0.0.1:{host.server_port}/read.html")
            browser.until("!!window.answer")
            answer = json.loads(browser.value("window.answer"))
        host.shutdown()
    check("failed" not in answer, f"{answer}")
    for name, read in answer.items():
        (width, faces, channels), levels = ktx2(bench.folder / f"tables/{name}.ktx2")
        check((read["width"], read["faces"], len(read["sums"])) == (width, faces, len(levels)) and CHANNELS[read["form"]][0] == channels, f"{name}: {read}")
        near = lambda a, b: abs(a - b) <= 1e-3 * max(1.0, abs(b))  # sums in another order and in floats
        check(all(near(a, sum(b)) for a, b in zip(read["sums"], levels)), f"{name}: {read['sums']} and {[sum(level) for level in levels]}")
        check(read["texel"] == read["drawn"] and (faces == 6 or (read["loaded"][0] == width and read["loaded"][2] == (1016 if texels == "half" else 1015) and near(read["loaded"][3], sum(levels[0])))), f"{name}: {read}")


@case("bake.ktx2_files_are_read_by_the_readers_of_engines", tier="nightly")
def other_readers(bench):
    """In Chromium: ktx-parse reads each file; three.js' loader reads the flat ones. Texels as a card reads them, sizes, faces, levels, sums of texels."""
    engines = os.environ.get("BURNISH_ENGINES", "")
    if not engines:
        raise Skipped("no engines: BURNISH_ENGINES is to name a folder with node_modules that holds three")
    (bench.folder / "node_modules").symlink_to(pathlib.Path(engines).resolve() / "node_modules")
    for texels in ("half", "float"):
        read_by_engines(bench, texels)
