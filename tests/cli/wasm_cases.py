"""burnish in WebAssembly: the library in node, and pages with the renderer inside in Chromium, with the bits of the program."""

import base64
import functools
import http.server
import json
import os
import pathlib
import shutil
import struct
import subprocess
import threading
import time
import zlib

from browser import Browser
from harness import Skipped, case, check
from serve_cases import hash_of_command

ROOT = pathlib.Path(__file__).resolve().parents[2]
MOST_PACKAGE = 3_000_000  # bytes of the npm package
MOST_PAGE = 5_000_000     # bytes of a page without a model


def package(bench):
    """The folder of the npm package: made by cross.wasm.draws_the_same_pixels, or by the preset wasm."""
    for build in (pathlib.Path(bench.program).parent / "tests/cross/wasm", ROOT / "build/wasm"):
        if (build / "package/burnish_core.wasm").exists():
            return build / "package"
    raise Skipped("no build for WebAssembly: cmake --preset wasm && cmake --build --preset wasm, with the group wasm of apps/packages.txt")


def node(bench, script, *words, code=0):
    if not shutil.which("node"):
        raise Skipped("no node: package nodejs, which emscripten brings")
    (bench.folder / "script.mjs").write_text(f'import * as burnish from "{package(bench)}/burnish.mjs";\n{script}')
    done = subprocess.run(["node", "script.mjs", *map(str, words)], cwd=bench.folder, capture_output=True, text=True, timeout=600)
    check(done.returncode == code, f"node ended with {done.returncode}\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}")
    return done.stdout


def program_hash(bench, *words):
    return json.loads(bench.run("render", *words, "-o", "picture.png", "--stats", "-", "-q").expect(0).out)["pixel_hash"]


DRAW = """
import { readFile, readdir } from "node:fs/promises";
import path from "node:path";
const library = await burnish.load();
for (const [scene, open, draw] of JSON.parse(process.argv[2])) {
    const source = scene.startsWith("builtin:") ? scene : { name: path.basename(scene), bytes: await readFile(scene) };
    const files = {};
    if (scene.endsWith(".gltf"))
        for (const name of await readdir(path.dirname(scene)))
            files[name] = await readFile(path.join(path.dirname(scene), name));
    if (open.environment && !open.environment.startsWith("builtin:"))
        open.environment = { name: "light.hdr", bytes: await readFile(open.environment) };
    const opened = library.open(source, { files, ...open });
    const picture = opened.render(draw);
    console.log(JSON.stringify({ hash: picture.hash, warnings: opened.warnings, length: picture.pixels.length, rgba: [...picture.rgba8().slice(0, 4)] }));
    picture.close();
    opened.close();
}
"""


@case("wasm.node_draws_the_bits_of_the_program", "of_wasm", tier="nightly", budget=120)
def draws_the_bits(bench):
    models = bench.data_file("models")
    scenes = [("builtin:plate", {}, {}), ("builtin:teapot", {"floor": "stage"}, {"technique": "bent_normal", "msaa": 4}), ("builtin:lights", {"key_lights": 2}, {}),
              ("builtin:bumps", {"mip_filter": "kappa"}, {}), ("builtin:glass", {}, {"glass": "body"}), ("builtin:shaderballs", {}, {"technique": "mc", "samples": 4}),
              (models / "AnisotropyStrengthTest.glb", {}, {"layers": "depth"}), (models / "ClearCoatTest.glb", {}, {"area_lights": "off"}),
              (models / "AnisotropyBarnLampSmall.glb", {"environment": str(bench.data_file("env/workshop_1k.hdr"))}, {"orbit": "40,20"})]
    small = {"env_size": 32, "env_samples": 32}
    size = {"width": 160, "height": 90}
    lines = node(bench, DRAW, json.dumps([(str(scene), {**small, **opening}, {**size, **draw}) for scene, opening, draw in scenes])).splitlines()
    check(len(lines) == len(scenes), str(lines))
    for (scene, opening, draw), line in zip(scenes, lines):
        found = json.loads(line)
        words = [scene, "--size", "160x90"]
        for name, value in {"floor": "off", **small, **opening, **{name: value for name, value in draw.items() if name != "layers"}}.items():
            words += ["--env" if name == "environment" else "--" + name.replace("_", "-"), value]
        if "msaa" not in draw:
            words += ["--msaa", "8"]
        jpeg = any("JPEG" in warning for warning in found["warnings"])
        check(jpeg == (str(scene).endswith(("ClearCoatTest.glb", "BarnLampSmall.glb"))), f"{scene}: {found['warnings']}")
        check(jpeg or found["hash"] == program_hash(bench, *words), f"{scene}: node draws {found['hash']}")
        check(found["length"] == 160 * 90 * 3 and found["rgba"][3] == 255, f"{scene}: {found}")


def png(width, height, depth, colour, rows, *chunks):
    """A PNG file of rows of bytes."""
    def chunk(kind, content):
        return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))
    head = struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + b"".join(chunk(*one) for one in chunks) + chunk(b"IDAT", zlib.compress(b"".join(b"\0" + row for row in rows))) + chunk(b"IEND", b"")


def masked(image):
    """A glTF text: a square whose base colour is an image, cut out by its alpha."""
    square = struct.pack("<30f", *(-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, -1, 0, 1, 1, 0, -1, 1, 0), *(0, 1, 1, 1, 1, 0, 0, 1, 1, 0, 0, 0))
    return json.dumps({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "scene": 0, "nodes": [{"mesh": 0}], "images": [image], "textures": [{"source": 0}],
                       "buffers": [{"uri": "data:application/octet-stream;base64," + base64.b64encode(square).decode(), "byteLength": 120}],
                       "bufferViews": [{"buffer": 0, "byteLength": 72}, {"buffer": 0, "byteOffset": 72, "byteLength": 48}],
                       "accessors": [{"bufferView": 0, "componentType": 5126, "count": 6, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]},
                                     {"bufferView": 1, "componentType": 5126, "count": 6, "type": "VEC2"}],
                       "materials": [{"alphaMode": "MASK", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
                       "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": 0}]}]})


@case("wasm.a_browser_draws_the_pixels_of_the_program", "of_wasm", tier="nightly", budget=120)
def browser_hashes(bench):
    """All pictures of tests/cross, in headless Chromium."""
    build = package(bench).parent / "tests/cross/burnish_page_hashes.js"
    native = pathlib.Path(bench.program).parent / "tests/cross/burnish_hashes"
    if not build.exists() or not native.exists():
        raise Skipped("no burnish_page_hashes: cmake --preset wasm && cmake --build --preset wasm --target burnish_page_hashes")
    own = subprocess.run([native, "scalar"], capture_output=True, text=True, timeout=300, check=True).stdout.splitlines()
    (bench.folder / "page.html").write_text(f"""<!doctype html><script>{build.read_text()}</script><script>
window.lines = [];
burnishHashes({{ arguments: ["wasm"], print: line => lines.push(line), onExit: code => document.body.dataset.code = code }});
</script>""")
    with Browser(bench.folder) as browser:
        browser.open(bench.folder / "page.html")
        browser.until("document.body && document.body.dataset.code !== undefined", 240)
        lines = json.loads(browser.value("JSON.stringify(lines)"))
        check(browser.value("document.body.dataset.code") == "0" and not browser.faults, f"{browser.faults}")
    check(len(own) >= 40 and lines == own, f"{[(a, b) for a, b in zip(lines, own) if a != b][:5]} of {len(lines)} and {len(own)}")


@case("wasm.png_files_of_all_kinds_give_the_program_s_texels", "of_wasm", tier="nightly", budget=60)
def all_png(bench):
    steps = [[(40 * x + 10 * y) % 256 for x in range(6)] for y in range(5)]
    wide = [[(9000 * x + 3000 * y) % 65536 for x in range(6)] for y in range(5)]
    images = {
        "grey": png(6, 5, 8, 0, [bytes(row) for row in steps]),
        "grey_cut": png(6, 5, 8, 0, [bytes(row) for row in steps], (b"tRNS", struct.pack(">H", 40))),
        "grey_wide_cut": png(6, 5, 16, 0, [struct.pack(">6H", *row) for row in wide], (b"tRNS", struct.pack(">H", 9000))),
        "grey_2_bits": png(8, 2, 2, 0, [b"\x1b\x1b", b"\xe4\xe4"], (b"tRNS", struct.pack(">H", 2))),
        "grey_alpha": png(3, 5, 8, 4, [bytes(row) for row in steps]),
        "colour_cut": png(2, 5, 8, 2, [bytes(row) for row in steps], (b"tRNS", struct.pack(">3H", 0, 40, 80))),
        "colour_wide_cut": png(2, 5, 16, 2, [struct.pack(">6H", *row) for row in wide], (b"tRNS", struct.pack(">3H", 0, 9000, 18000))),
        "palette": png(6, 5, 8, 3, [bytes(x % 3 for x in row) for row in steps], (b"PLTE", bytes((255, 0, 0, 0, 200, 0, 9, 9, 250))), (b"tRNS", bytes((255, 0, 90)))),
        "palette_4_bits": png(4, 2, 4, 3, [b"\x01\x21", b"\x12\x10"], (b"PLTE", bytes((255, 0, 0, 0, 200, 0, 9, 9, 250))))}
    scenes = []
    for name, content in images.items():
        (bench.folder / f"{name}.png").write_bytes(content)
        (bench.folder / f"{name}.gltf").write_text(masked({"uri": f"{name}.png"}))
        scenes.append((str(bench.folder / f"{name}.gltf"), {"env_size": 16, "env_samples": 16}, {"width": 48, "height": 48}))
    hashes = [json.loads(line)["hash"] for line in node(bench, DRAW, json.dumps(scenes)).splitlines()]
    for name, found in zip(images, hashes):
        check(found == program_hash(bench, f"{name}.gltf", "--env-size", "16", "--env-samples", "16", "--size", "48x48", "--msaa", "8"), f"{name}: node draws {found}")
    check(len(set(hashes)) == len(images), "two images look alike")


@case("wasm.failures_are_exceptions_with_the_program_s_codes", "of_wasm", tier="nightly", budget=60)
def failures(bench):
    script = """
const library = await burnish.load(), scene = library.open("builtin:sphere", { env_size: 16, env_samples: 16 });
const picture = scene.render({ width: 8, height: 8 });
const calls = {
    size: () => scene.render({ width: 0 }), name: () => scene.render({ nonsense: 1 }), model: () => library.open(new Uint8Array([1, 2, 3, 4])),
    builtin: () => library.open("builtin:none"), path: () => library.open("gone.glb"), outside: () => library.open("builtin:sphere", { files: { "../x": new Uint8Array(1) } }),
    light: () => library.open("builtin:sphere", { environment: new Uint8Array(9) }), material: () => scene.setMaterial("gone", {}), sizes: () => library.compare(picture, scene.render({ width: 9, height: 8 })),
    stopped: () => library.open("builtin:teapot", { env_size: 512, progress: () => true }), kind: () => library.open(7), matrix: () => scene.setNode(0, new Float32Array(100000)), pixels: () => library.compare(picture, { ...picture, pixels: new Float32Array(3) }),
    empty: () => scene.setEnvironment({}), thrown: () => library.open("builtin:teapot", { env_size: 256, progress: () => { throw new burnish.BurnishError("mine", 99); } }), large: () => scene.render({ width: 16384, height: 16384, msaa: 16 }),
};
for (const [name, call] of Object.entries(calls))
    try { call(); console.log(name, 0); } catch (error) { console.log(name, error instanceof burnish.BurnishError ? error.code : error); }
for (const [name, wasm] of [["gone", new URL("gone.wasm", import.meta.url)], ["broken", new Uint8Array([0, 97, 115, 109, 9])]])
    console.log(name, await burnish.load({ wasm }).then(() => 0, (error) => (error instanceof burnish.BurnishError ? error.code : error)));
const copy = scene.render({ width: 8, height: 8, roughness: 0.9 }), { flip_mean } = library.compare(picture, picture);
console.log("equal", flip_mean === 0 && library.compare(picture, copy).flip_mean > 0.01 ? 0 : 1);
console.log("after", scene.render({ width: 8, height: 8 }).hash === picture.hash ? 0 : 1);
"""
    found = dict(line.split(" ", 1) for line in node(bench, script).splitlines())
    wanted = {"size": "2", "name": "2", "model": "4", "builtin": "4", "path": "4", "outside": "4", "light": "4", "material": "2", "sizes": "3", "stopped": "130",
              "kind": "2", "matrix": "2", "pixels": "3", "empty": "2", "thrown": "99", "large": "2", "gone": "4", "broken": "4", "equal": "0", "after": "0"}
    check(found == wanted, str({name: (found.get(name), code) for name, code in wanted.items() if found.get(name) != code}))


@case("wasm.a_worker_draws_tells_and_ends", "of_wasm", tier="nightly", budget=60)
def remote(bench):
    script = f"""
const {{ connect }} = await import("{package(bench)}/remote.mjs");
const library = await connect();
let told = 0;
const scene = await library.open("builtin:teapot", {{ env_size: 256, floor: "stage", progress: (work, done) => {{ told += typeof work === "string" && done <= 1; }} }});
const picture = await scene.render({{ width: 32, height: 18, display: {{ exposure: 1 }}, layers: "depth,normal" }});
await scene.setMaterial(0, {{ roughness: 0.9 }}).then(() => console.log("changed"), (error) => console.log(error.code));
console.log(told > 0, picture.hash, picture.rgba.length, picture.layers.normal.channels, scene.materials.length, library.techniques().length > 5);
await scene.close();
console.log(await scene.render().catch((error) => error.code));
const other = await library.open("builtin:sphere", {{ env_size: 16, env_samples: 16 }});
const late = other.render({{ width: 2048, height: 1024, msaa: 16 }}).catch((error) => error.code);
await library.end();
console.log(await late, await scene.render().catch((error) => error.code));
"""
    lines = node(bench, script).splitlines()
    same = program_hash(bench, "builtin:teapot", "--env-size", "256", "--floor", "stage", "--size", "32x18", "--msaa", "8")
    check(lines[1].split() == ["true", same, str(32 * 18 * 4), "3", lines[1].split()[4], "true"] and int(lines[1].split()[4]) > 1 and lines[2:] == ["2", "130 130"], str(lines))


@case("wasm.the_library_draws_in_a_browser", "of_wasm", tier="nightly", budget=60)
def library_in_browser(bench):
    """As modules from a host: in the page's thread, and in a worker."""
    shutil.copytree(package(bench), bench.folder / "burnish")
    (bench.folder / "page.html").write_text("""<!doctype html><script type="module">
import { load } from "./burnish/burnish.mjs";
import { connect } from "./burnish/remote.mjs";
const opening = { env_size: 32, env_samples: 32 }, drawing = { width: 64, height: 40, technique: "bent_normal", msaa: 4 };
try {
  const scene = (await load()).open("builtin:plate", opening), remote = await connect(), other = await remote.open("builtin:plate", opening);
  window.hashes = [scene.render(drawing).hash, (await other.render(drawing)).hash];
  await remote.end();
} catch (fault) { window.hashes = [String(fault)]; }
</script>""")

    class Quiet(http.server.SimpleHTTPRequestHandler):
        extensions_map = {".html": "text/html", ".mjs": "text/javascript", ".wasm": "application/wasm"}

        def log_message(self, *_):
            pass

    same = program_hash(bench, "builtin:plate", "--floor", "off", "--env-size", "32", "--env-samples", "32", "--size", "64x40", "--technique", "bent_normal", "--msaa", "4")
    with Browser(bench.folder) as browser, http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=bench.folder)) as host:
        threading.Thread(target=host.serve_forever, daemon=True).start()
        browser.visit(f"http://127.0.0.1:{host.server_address[1]}/page.html")
        browser.until("!!window.hashes", 60)
        check(browser.value("hashes") == [same, same], f"{browser.value('hashes')}, the program {same}; {browser.faults}")
        host.shutdown()


@case("wasm.the_package_is_small_and_whole", "of_wasm", tier="nightly", budget=30)
def small_package(bench):
    if not shutil.which("npm"):
        raise Skipped("no npm: package npm")
    folder = package(bench)
    done = subprocess.run(["npm", "pack", "--json", "--offline", "--pack-destination", bench.folder, folder], capture_output=True, text=True, cwd=bench.folder)
    check(done.returncode == 0, done.stderr)
    packed = json.loads(done.stdout)[0]
    check(packed["size"] <= MOST_PACKAGE, f"the package has {packed['size']} bytes")
    names = {file["path"] for file in packed["files"]}
    wanted = {"LICENSE", "README.md", "package.json", "burnish.mjs", "burnish.d.mts", "burnish_core.mjs", "burnish_core.wasm", "remote.mjs", "remote.d.mts", "worker.mjs"}
    check(names == wanted, str(names ^ wanted))
    (bench.folder / "user").mkdir()
    installed = bench.folder / "user/node_modules/burnish"
    installed.mkdir(parents=True)
    subprocess.run(["tar", "xzf", bench.folder / packed["filename"], "-C", installed, "--strip-components=1"], check=True)
    (bench.folder / "user/use.mjs").write_text('import { load } from "burnish";\nimport { connect } from "burnish/remote";\n'
                                               'console.log((await load()).version, typeof connect);\n')
    used = subprocess.run(["node", "use.mjs"], cwd=bench.folder / "user", capture_output=True, text=True)
    version = bench.run("--version").expect(0).out.split()[1]
    check(used.stdout.split() == [version, "function"], used.stdout + used.stderr)


def export_page(bench, name, *words, code=0):
    return bench.run("export", "page", *words, "--renderer", package(bench), "-o", name).expect(code)


def parts_of(text):
    """Returns the page's description, and {name: bytes} of its files."""
    page = json.loads(text.split('id="burnish-page">', 1)[1].split("</script>", 1)[0])
    files = {}
    for part in text.split('class="burnish-file" data-name="')[1:]:
        name, rest = part.split('">', 1)
        files[name] = zlib.decompress(base64.b64decode(rest.split("</script>", 1)[0]))
    return page, files


PROOF = "document.body.dataset.proof"
SHOWN = "JSON.stringify([document.body.dataset.hash, document.getElementById('command').textContent])"


def shown(bench, browser, mode="A"):
    """Waits for the page's picture. Checks that the command beside it draws the same bits."""
    browser.until(f"document.body.dataset.done === '{mode}'", 120)
    hash_, command = json.loads(browser.value(SHOWN))
    check("--msaa 1" not in command, f"a coarse picture remains: {command}")
    check(hash_ == hash_of_command(bench, command), f"the page draws {hash_} for {command}")
    return hash_


CORES = min(4, os.cpu_count())


def helped(browser):
    """Waits until all workers of the page draw."""
    browser.until(f"burnish_live.workers === {CORES}", 120)


@case("wasm.glass_is_drawn_by_one_worker", "of_wasm", tier="nightly", budget=150)
def glass_as_a_whole(bench):
    """And a small phone waits until its reader asks."""
    export_page(bench, "glass.html", "builtin:glass", "--env-size", "32")
    with Browser(bench.folder) as browser:
        browser.send("Emulation.setTouchEmulationEnabled", enabled=True)
        browser.size(400, 700)
        browser.open(bench.folder / "glass.html")
        browser.until("!!document.getElementById('burnish-begin')")
        check(browser.value("document.getElementById('a').naturalWidth") > 0, "the picture that the page was made with is gone")
        browser.screenshot(bench.folder / "phone.png", whole=False)
        browser.value("document.getElementById('burnish-begin').click()")
        browser.until(PROOF, 120)
        check(browser.value(PROOF) == "same", browser.value("document.getElementById('proof').textContent"))
        first = shown(bench, browser)
        browser.value("document.getElementById('view').focus()")
        browser.value("document.body.dataset.done = ''")
        browser.press("ArrowLeft")
        browser.until("document.body.dataset.done === 'A' && !document.getElementById('command').textContent.includes('--msaa 1')", 120)
        check(shown(bench, browser) != first and browser.value("burnish_live.in_bands") == 0, "glass has bands")
        time.sleep(3)
        check(browser.value("burnish_live.workers") == 1, "workers start for glass")
        check(not browser.faults, str(browser.faults))


@case("wasm.pictures_that_nobody_waits_for_end_with_their_workers", "of_wasm", tier="nightly", budget=150)
def ended(bench):
    export_page(bench, "page.html", "builtin:teapot", "--technique", "mc", "--samples", "64", "--env-size", "32", "--floor", "off")
    text = (bench.folder / "page.html").read_text()
    hasty = {"const kPatience = 3000;": "const kPatience = 20;", "(_, k) => k / workers.length": "(_, k) => k ? 0.04 + 0.96 * (k - 1) / (workers.length - 1) : 0",
             "if (body.reduction === 1) balance": "if (false) balance"}  # the first worker waits for the others
    for before, after in hasty.items():
        check(text.count(before) == 1, f"the page has not one '{before}'")
        text = text.replace(before, after)
    (bench.folder / "hasty.html").write_text(text)
    with Browser(bench.folder) as browser:
        browser.size(900, 600)
        browser.open(bench.folder / "hasty.html")
        browser.until(PROOF, 120)
        helped(browser)
        set_roughness = "(() => { const o = document.querySelector('[data-name=\"--roughness\"] input'); o.value = '%s'; o.dispatchEvent(new Event('change')); })()"
        for turn in range(12):  # each picture is forgotten a moment after it began
            browser.value(set_roughness % (0.2 + 0.05 * turn))
            time.sleep(0.5 if turn == 0 else 0.1 + 0.03 * turn)
        browser.value("document.body.dataset.done = ''")
        shown(bench, browser)
        check(not browser.faults and not browser.value("document.getElementById('message').textContent"), str(browser.faults))
        helped(browser)


@case("wasm.a_page_draws_from_disk_with_the_program_s_bits", "of_wasm", tier="nightly", budget=150)
def page_from_disk(bench):
    export_page(bench, "page.html", "builtin:teapot", "--technique", "bent_normal", "--env-size", "64")
    check((bench.folder / "page.html").stat().st_size <= MOST_PAGE, "the page is large")
    with Browser(bench.folder) as browser:
        browser.size(700, 500)
        browser.open(bench.folder / "page.html")
        browser.until(PROOF, 120)
        check(browser.value(PROOF) == "same", browser.value("document.getElementById('proof').textContent"))
        first = shown(bench, browser)
        helped(browser)
        # By keyboard alone
        browser.value("document.getElementById('view').focus()")
        for key in ("ArrowLeft", "ArrowUp", "+"):
            browser.value("document.body.dataset.done = ''")
            browser.press(key, text=key if key == "+" else None)
            browser.until("document.body.dataset.done === 'A'", 120)
        check(shown(bench, browser) != first, "the view did not turn")
        check(browser.value("burnish_live.in_bands") >= (3 if CORES > 1 else 0), "one worker draws")
        # Two settings, and their difference
        browser.value("document.querySelector('[data-edit=B]').click()")
        browser.value("(() => { const list = document.querySelector('[data-name=\"--technique\"] select'); list.value = 'split_isotropic'; list.dispatchEvent(new Event('change')); })()")
        browser.value("document.querySelector('[data-show=error]').click()")
        browser.until("document.body.dataset.done === 'error'", 120)
        flip = float(browser.value("document.getElementById('figures').textContent").split("mean ")[1].split(",")[0])
        check(0.001 < flip < 0.9, f"FLIP of two techniques: {flip}")
        check(browser.value("document.querySelector('[data-show=reference]').hidden"), "a page has no reference")
        browser.screenshot(bench.folder / "error.png")
        # Dragging shows pictures on the way, and the whole one at rest
        browser.value("document.querySelector('[data-show=A]').click()")
        browser.until("document.body.dataset.done === 'A'", 120)
        browser.value("(() => { window.shown_pictures = 0; new MutationObserver(() => ++window.shown_pictures).observe(document.getElementById('a'), { attributes: true, attributeFilter: ['src'] }); })()")
        browser.mouse("mousePressed", 200, 200, button="left", clickCount=1)
        for step in range(90):
            browser.mouse("mouseMoved", 200 + step, 200, button="left", buttons=1)
            time.sleep(1 / 60)
        pictures = browser.value("window.shown_pictures")
        browser.mouse("mouseReleased", 290, 200, button="left", clickCount=1)
        check(pictures >= 10, f"{pictures} pictures while turning")
        browser.until("document.body.dataset.done === 'A' && !document.getElementById('busy').textContent && !document.getElementById('command').textContent.includes('--msaa 1')", 120)
        # A narrow and a dark page
        browser.scheme("dark")
        browser.size(400, 800)
        browser.value("document.querySelector('[data-show=A]').click()")
        browser.until("document.body.dataset.done === 'A'", 120)
        check(browser.value("document.documentElement.scrollWidth <= innerWidth"), "the page is wider than the window")
        browser.screenshot(bench.folder / "narrow.png")
        # The mark of a picture under way moves nothing: another size of the view would draw it again, for ever
        for width in range(380, 1300, 20):
            browser.size(width, 800)
            still = browser.value("(() => { const box = () => JSON.stringify(document.getElementById('view').getBoundingClientRect()), busy = document.getElementById('busy'); "
                                  "busy.textContent = ''; const before = box(); busy.textContent = '\\u2026'; return before === box(); })()")
            check(still, f"{width} pixels wide, the view has another size while a picture is drawn")
        check(not browser.faults, str(browser.faults))
        # From a host, too
        class Quiet(http.server.SimpleHTTPRequestHandler):
            def log_message(self, *_):
                pass

        with http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=bench.folder)) as host:
            threading.Thread(target=host.serve_forever, daemon=True).start()
            address = f"http://127.0.0.1:{host.server_address[1]}/page.html"
            browser.visit(address)
            browser.until(PROOF, 120)
            check(browser.value(PROOF) == "same", browser.value("document.getElementById('proof').textContent"))
            host.shutdown()
        outside = [other for other in browser.requests if other != address and not other.startswith(("file:", "blob:", "data:"))]
        check(not outside, f"the page asks for {outside}")


@case("wasm.a_page_brings_a_model_with_its_files", "of_wasm", tier="nightly", budget=150)
def page_of_a_model(bench):
    light = bench.data_file("env/workshop_1k.hdr")
    # An environment beside a built-in scene, as floats where it is an OpenEXR file
    for light_file in (light, bench.data_file("env/blender_studio_1k.exr")):
        export_page(bench, "ball.html", "builtin:sphere", "--env", light_file, "--env-size", "32", "--light", "sphere:points=0,1,1:radius=0.2:radiance=9,9,9",
                    "--light", "sphere:points=1,1,0:radius=0.2:radiance=9,2,2", "--roughness", "0.123456789")
        with Browser(bench.folder) as browser:
            browser.open(bench.folder / "ball.html")
            browser.until(PROOF, 120)
            check(browser.value(PROOF) == "same", browser.value("document.getElementById('proof').textContent"))
    for model in ("models/AnisotropyBarnLampSmall.glb", "models/FlightHelmetParts/FlightHelmetParts.gltf"):
        path = bench.data_file(model)
        export_page(bench, "model.html", path, "--env", light, "--env-size", "64")
        page, files = parts_of((bench.folder / "model.html").read_text())
        check(files[page["target"]] == path.read_bytes() and files["workshop_1k.hdr"] == light.read_bytes(), str(list(files)))
        shutil.copy(light, bench.folder)
        (bench.folder / path.name).unlink(missing_ok=True)
        for name, content in files.items():
            (bench.folder / name).parent.mkdir(parents=True, exist_ok=True)
            (bench.folder / name).write_bytes(content)
        with Browser(bench.folder) as browser:
            browser.size(600, 400)
            browser.open(bench.folder / "model.html")
            browser.until(PROOF, 120)
            check(browser.value(PROOF) == "same", browser.value("document.getElementById('proof').textContent"))
            shown(bench, browser)
            check("JPEG" not in browser.value("document.getElementById('message').textContent"), "a JPEG image was decoded anew")
            check(not browser.faults, str(browser.faults))


@case("wasm.a_page_says_what_fails", "of_wasm", tier="nightly", budget=150)
def page_says(bench):
    export_page(bench, "page.html", bench.data_file("models/AnisotropyStrengthTest.glb"), "--env-size", "16")
    text = (bench.folder / "page.html").read_text()
    model = text.split('data-name="AnisotropyStrengthTest.glb">', 1)[1].split("</script>", 1)[0]
    broken = base64.b64encode(zlib.compress(zlib.decompress(base64.b64decode(model))[:1000])).decode()
    (bench.folder / "broken.html").write_text(text.replace(model, broken))
    (bench.folder / "other.html").write_text(text.replace('"hash":"', '"hash":"f', 1))
    worker = text.split('id="burnish-worker">', 1)[1].split("</script>", 1)[0]
    (bench.folder / "ends.html").write_text(text.replace(worker, "throw new Error('no worker');"))
    check(worker.count("core = await") == 1, "the worker begins in another way")
    (bench.folder / "large.html").write_text(text.replace(worker, worker.replace("core = await", "throw new RangeError('out of memory'); core = await")))
    (bench.folder / "later.html").write_text(text.replace(worker, worker.replace("const instantiateWasm =", "return reject(new RangeError('out of memory')); const instantiateWasm =")))
    message = "document.getElementById('message').textContent"
    with Browser(bench.folder) as browser:
        for name, words in (("broken", "AnisotropyStrengthTest.glb"), ("ends", "The renderer ended"), ("large", "too large for the memory of a page"), ("later", "too large for the memory of a page")):
            browser.open(bench.folder / f"{name}.html")
            browser.until(message, 60)
            check(words in browser.value(message), f"{name}: {browser.value(message)}")
            check(browser.value("document.getElementById('a').naturalWidth") == 640, f"{name}: the picture that the page was made with is gone")
        browser.open(bench.folder / "other.html")
        browser.until(PROOF, 120)
        check(browser.value(PROOF) == "other", "other bits are not seen")
        browser.send("Page.addScriptToEvaluateOnNewDocument", source="delete window.WebAssembly")
        browser.open(bench.folder / "page.html")
        browser.until(message, 60)
        check("too old" in browser.value(message), browser.value(message))
        browser.screenshot(bench.folder / "old.png")
