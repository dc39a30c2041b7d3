#!/usr/bin/env python3
"""Which mistakes `burnish conform` names: in pictures by three.js and Babylon.js with one mistake each, and by burnish's own techniques.

Usage: conform.py --program build/release/burnish --engines FOLDER [--work FOLDER] [--only NAME,...] [--modules TECHNIQUE:SAMPLES] [--json FILE]

FOLDER holds node_modules with three, babylonjs and babylonjs-loaders. Each engine draws the scenes of a conformance folder in headless
Chromium, as its page there does, with a piece of code that makes the mistake. Scenes that the engine draws wrongly by itself are left out.
Prints a row for each: the mistake made, the mistakes named. Mistakes that begin with "unknown" are none of burnish's: none may be named. --modules draws with the
exported modules of burnish in three.js and Babylon.js, and prints each scene's distance to the reference before and after, and to the tile
renderer's picture. Exit code: 0 measured; 2 something could not be run.
"""

import argparse
import base64
import functools
import http.server
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests/cli"))
from browser import Browser

OWN_FAULTS = {"three": "no_tangents,mirrored_node,normal_map,area_light,minified", "babylon": "no_tangents,normal_map,area_light,minified"}
# Places in a page's text, and the names that code there can use.
PLACES = {
    "three": {
        "shader": ("const renderer = new", "before"),  # THREE
        "sky": ("  picture.mapping = ", "before"),  # picture
        "model": ("  gltf.scene.updateMatrixWorld(true);\n", "after"),  # gltf
        "camera": ("  camera.updateProjectionMatrix();\n", "before"),  # camera
        "root": ("  const target = ", "before"),  # root
        "picture": ("  return floats;\n", "before"),  # floats, conform
    },
    "babylon": {
        "sky": ("  await new Promise(loaded => texture", "before"),  # texture
        "model": ("  loaded.addAllToScene();\n", "after"),  # loaded
        "picture": ("  return floats;\n", "before"),  # floats, conform
    },
}

EACH = {
    "three": "gltf.scene.traverse(o => {{ if (o.isMesh) {{ const m = o.material; {} }} }});\n",
    "babylon": "for (const m of loaded.materials) {{ {} }}\n",
}
CHUNK = "{{ const c = '{}', text = THREE.ShaderChunk[c]; THREE.ShaderChunk[c] = text.replaceAll({}, {}); if (THREE.ShaderChunk[c] === text) throw 'no ' + c; }}\n"
LINES = ("const w = conform.width, h = conform.height, old = floats.slice();\n"
         "for (let y = 0; y < h; ++y) for (let x = 0; x < w; ++x) for (let c = 0; c < 4; ++c)\n"
         "  floats[4 * (y * w + x) + c] = old[4 * ({}) + c];\n")
VALUES = "for (let i = 0; i < floats.length; ++i) if (i % 4 < 3) {{ const v = floats[i]; floats[i] = {}; }}\n"
SRGB = "v <= 0.0031308 ? 12.92 * v : 1.055 * Math.pow(Math.min(v, 1), 1 / 2.4) - 0.055"
ACES = "Math.min(1, v * (2.51 * v + 0.03) / (v * (2.43 * v + 0.59) + 0.14))"
SKY = ("{{ const d = picture.image.data, w = picture.image.width, h = picture.image.height, old = d.slice(), n = d.length / w / h;\n"
       "for (let y = 0; y < h; ++y) for (let x = 0; x < w; ++x) for (let c = 0; c < n; ++c) d[n * (y * w + x) + c] = old[n * ({}) + c]; }}\n")


def chunk(name, old, new):
    return {"shader": CHUNK.format(name, json.dumps(old), json.dumps(new))}


def three(code):
    return {"model": EACH["three"].format(code)}


def babylon(code):
    return {"model": EACH["babylon"].format(code)}


PICTURES = {
    "upside_down": {"picture": LINES.format("(h - 1 - y) * w + x")},
    "mirrored": {"picture": LINES.format("y * w + w - 1 - x")},
    "encoded": {"picture": VALUES.format(SRGB)},
    "tonemapped_aces_fit": {"picture": VALUES.format(ACES)},
    "exposure": {"picture": VALUES.format("v * 2.5")},
}
# The mistake that should be named, and the code that makes it. A name may have alternatives, by |, that look the same.
THREE = {
    "none": {},
    "anisotropy_ignored": three("m.anisotropy = 0;"),
    "rotation_clockwise": {"shader": chunk("lights_physical_fragment", "tbn[ 1 ] * anisotropyV.y", "tbn[ 1 ] * - anisotropyV.y")["shader"]
                           + chunk("lights_physical_fragment", "- tbn[ 0 ] * anisotropyV.y", "+ tbn[ 0 ] * anisotropyV.y")["shader"]},
    "rotation_negated": three("m.anisotropyRotation *= -1;"),
    "rotation_in_degrees": three("m.anisotropyRotation *= Math.PI / 180;"),
    "rotation_ignored": three("m.anisotropyRotation = 0;"),
    "axes_swapped": chunk("lights_physical_fragment", "material.anisotropyT = tbn[ 0 ]",
                          "anisotropyV = vec2( - anisotropyV.y, anisotropyV.x ); material.anisotropyT = tbn[ 0 ]"),
    "bend_across": chunk("lights_fragment_maps", "material.roughness, material.anisotropyB,", "material.roughness, material.anisotropyT,"),
    "bend_factor": chunk("envmap_physical_pars_fragment", "pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) )",
                         "exp2( exp2( 1.0 - anisotropy * ( 1.0 - roughness ) ) )"),
    "no_bend": chunk("envmap_physical_pars_fragment", "pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) )", "1.0"),
    "no_specular_image": chunk("lights_fragment_maps", "radiance += iblRadiance;", "radiance += 0.0 * iblRadiance;"),
    "handedness_ignored": chunk("normal_vertex", "tangent.w", "1.0"),
    "tangents_ignored|geometric_normals": three("m.flatShading = true;"),
    "strength_squared_twice": three("m.anisotropy *= m.anisotropy;"),
    "strength_not_squared": three("m.anisotropy = Math.sqrt(m.anisotropy);"),
    "alpha_is_roughness": three("m.roughness = Math.sqrt(m.roughness);"),
    "direction_map_ignored": three("m.anisotropyMap = null;"),
    "direction_map_srgb": three("if (m.anisotropyMap) m.anisotropyMap.colorSpace = THREE.SRGBColorSpace;"),
    "direction_green_down": chunk("lights_physical_fragment", "texture2D( anisotropyMap, vAnisotropyMapUv ).rgb",
                                  "( vec3( 0.0, 1.0, 0.0 ) + vec3( 1.0, - 1.0, 1.0 ) * texture2D( anisotropyMap, vAnisotropyMapUv ).rgb )"),
    "map_strength_ignored": chunk("lights_physical_fragment", " * anisotropyPolar.b;", ";"),
    "first_coordinates": three("if (m.anisotropyMap) m.anisotropyMap.channel = 0;"),
    "transform_ignored": three("if (m.anisotropyMap) { m.anisotropyMap.matrixAutoUpdate = false; m.anisotropyMap.matrix.identity(); }"),
    "coat_ignored": three("m.clearcoat = 0;"),
    "backs_culled": three("m.side = THREE.FrontSide;"),
    "lamps_ignored": {"model": "gltf.scene.traverse(o => { if (o.isLight) o.intensity = 0; });\n"},
    "unknown: directions turned by 45 degrees": three("m.anisotropyRotation += Math.PI / 4;"),
    "unknown: half the roughness": three("m.roughness *= 0.5;"),
    "unknown: blue light": {"sky": "{ const d = picture.image.data, n = d.length / picture.image.width / picture.image.height; for (let i = 0; i < d.length; i += n) d[i] *= 0.3; }\n"},
    "unknown: light from grazing angles twice": chunk("lights_fragment_maps", "radiance += iblRadiance;",
                                                      "radiance += iblRadiance * ( 1.0 + pow2( 1.0 - saturate( dot( geometryNormal, geometryViewDir ) ) ) );"),
    "exposure|metals half as bright": three("m.color.multiplyScalar(0.5);"),
    "unknown: squared light": {"sky": "{ const d = picture.image.data; for (let i = 0; i < d.length; ++i) if (i % 4 < 3) d[i] = Math.min(d[i] * d[i], 60000); }\n"},
    "sky_mirrored_x": {"sky": SKY.format("y * w + (w + w / 2 - 1 - x) % w")},
    "sky_mirrored_y": {"sky": SKY.format("(h - 1 - y) * w + x")},
    "sky_mirrored_z": {"sky": SKY.format("y * w + w - 1 - x")},
    "sky_turned_quarter": {"sky": SKY.format("y * w + (x + w / 4) % w")},
    "sky_turned_half": {"sky": SKY.format("y * w + (x + w / 2) % w")},
    "field_of_view": {"camera": "camera.fov = 2 * Math.atan(Math.tan(camera.fov * Math.PI / 360) / camera.aspect) * 180 / Math.PI;\n"},
    **PICTURES,
}
BABYLON = {
    "none": {},
    "anisotropy_ignored": babylon("m.anisotropy.isEnabled = false;"),
    "rotation_negated": babylon("m.anisotropy.angle = -m.anisotropy.angle;"),
    "rotation_in_degrees": babylon("m.anisotropy.angle *= Math.PI / 180;"),
    "strength_squared_twice": babylon("m.anisotropy.intensity *= m.anisotropy.intensity;"),
    "strength_not_squared": babylon("m.anisotropy.intensity = Math.sqrt(m.anisotropy.intensity);"),
    "alpha_is_roughness": babylon("m.roughness = Math.sqrt(m.roughness);"),
    "direction_map_ignored": babylon("m.anisotropy.texture = null;"),
    "coat_ignored": babylon("m.clearCoat.isEnabled = false;"),
    "backs_culled": babylon("m.backFaceCulling = true;"),
    "geometric_normals": {"model": "for (const m of loaded.meshes) if (m.getTotalVertices()) m.convertToFlatShadedMesh();\n"},
    "lamps_ignored": {"model": "for (const l of loaded.lights) l.intensity = 0;\n"},
    "unknown: directions turned by 45 degrees": babylon("m.anisotropy.angle += Math.PI / 4;"),
    "unknown: half the roughness": babylon("m.roughness *= 0.5;"),
    "exposure|metals half as bright": babylon("m.albedoColor.scaleInPlace(0.5);"),
    "sky_turned_quarter|sky_turned_back": {"sky": "texture.rotationY += Math.PI / 2;\n"},
    "sky_turned_half": {"sky": "texture.rotationY += Math.PI;\n"},
    **PICTURES,
}
OWN = ("gltf", "gltf_compensated", "hdrp", "lobe_line", "filtered_is_ggx", "mc", "major_axis_weighted")


class Server:
    """Serves a folder on 127.0.0.1, with pages of its own."""

    def __init__(self, folder):
        pages = self.pages = {}

        class Handler(http.server.SimpleHTTPRequestHandler):
            def log_message(self, *_):
                pass

            def do_GET(self):
                text = pages.get(self.path.split("?")[0])
                if text is None:
                    return super().do_GET()
                self.send_response(200)
                self.send_header("Content-Type", "text/javascript" if self.path.endswith(".js") else "text/html")
                self.end_headers()
                self.wfile.write(text.encode())

        self.server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Handler, directory=str(folder)))
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def address(self, path):
        return f"http://127.0.0.1:{self.server.server_port}{path}"


def page_with(text, engine, code):
    """Returns a page's text with code in its places."""
    for place, piece in code.items():
        mark, side = PLACES[engine][place]
        if text.count(mark) != 1:
            raise SystemExit(f"conform.py: the page of {engine} has no single '{mark.strip()}'")
        text = text.replace(mark, mark + piece if side == "after" else piece + mark)
    return text


def draw(browser, address, to):
    """Saves the pictures of a page."""
    browser.faults.clear()
    browser.send("Page.navigate", url="about:blank")
    browser.send("Page.navigate", url=address)
    begin = time.monotonic()
    while not browser.value("!!globalThis.drawn_pictures"):
        if time.monotonic() - begin > 300 or any("rror" in fault and "NAME_NOT_RESOLVED" not in fault for fault in browser.faults):
            state = browser.value("document.getElementById('state')?.textContent")
            raise RuntimeError(f"{state} {browser.faults}")
        time.sleep(0.3)
    to.mkdir(parents=True, exist_ok=True)
    for k in range(browser.value("drawn_pictures.length")):
        name, text = browser.value("(() => { const [name, b] = drawn_pictures[%d]; let s = ''; for (let i = 0; i < b.length; i += 32768) "
                                   "s += String.fromCharCode(...b.subarray(i, i + 32768)); return [name, btoa(s)]; })()" % k)
        (to / name).write_bytes(base64.b64decode(text))


def judge(program, folder, pictures, without):
    """Returns the names of the mistakes found, and the results."""
    command = [program, "conform", str(folder), str(pictures), "--quiet", "--json", "-"] + (["--without", without] if without else [])
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode not in (0, 1):
        raise RuntimeError(run.stderr.strip())
    result = json.loads(run.stdout)
    return [m["name"] for m in result["mistakes"]], result


def picture_of(folder, scene):
    return next(file for file in folder.glob(f"{scene}.*") if "variance" not in file.name)


def distances(program, folder, pictures, references=None):
    """Returns each scene's mean FLIP to its reference, or to the pictures of another folder."""
    found = {}
    for scene in (s["name"] for s in json.loads((folder / "conform.json").read_text())["scenes"]):
        run = subprocess.run([program, "compare", picture_of(references or folder / "reference", scene), picture_of(pictures, scene), "--metric", "flip-hdr", "--json", "-", "--quiet"],
                             capture_output=True, text=True)
        if run.returncode:
            raise RuntimeError(run.stderr.strip())
        found[scene] = json.loads(run.stdout)["flip_mean"]
    return found


def improve(program, folder, work, engine, technique, samples, server):
    """Prints each scene's distance to the reference: the engine as it is, and with the exported module."""
    server.pages["/pages/burnish.js"] = subprocess.run([program, "export", engine, "--technique", technique, "--samples", str(samples), "-o", "-", "--quiet"],
                                                       check=True, capture_output=True, text=True).stdout
    found = {}
    for name, query in (("as_it_is", ""), ("module", "?module=burnish.js")):
        pictures = work / f"{engine}-{name}"
        with tempfile.TemporaryDirectory() as profile, Browser(profile, webgl=True) as browser:
            draw(browser, server.address(f"/pages/{engine}.html{query}"), pictures)
        found[name] = distances(program, folder, pictures)
    tile = work / f"tile-{technique}"
    if not tile.exists():
        subprocess.run([program, "conform", folder, tile, "--draw", "--technique", technique, "--quiet"], check=True)
    found["module_to_tile"] = distances(program, folder, work / f"{engine}-module", tile)
    for scene, before in found["as_it_is"].items():
        print(f"{engine:8} {scene:22} {before:.3f} {found['module'][scene]:.3f}   to the tile renderer {found['module_to_tile'][scene]:.3f}", flush=True)
    means = {name: sum(scenes.values()) / len(scenes) for name, scenes in found.items()}
    print(f"{engine:8} {'mean':22} {means['as_it_is']:.3f} {means['module']:.3f}", flush=True)
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    parser.add_argument("--engines", type=pathlib.Path)
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("--only", default="three,babylon,burnish")
    parser.add_argument("--modules", metavar="TECHNIQUE:SAMPLES", help="draw with the exported modules instead, and print distances to the reference")
    parser.add_argument("--json")
    given = parser.parse_args()
    temporary = tempfile.TemporaryDirectory()
    work = given.work or pathlib.Path(temporary.name)
    folder = work / "folder"
    if subprocess.run([given.program, "conform", "--write", folder, "--quiet"]).returncode:
        return 2
    rows = []

    def tell(engine, made, named, result):
        wrong = sum(s["outcome"] != "right" for s in result["scenes"])
        if made == "none":
            good = not named and not wrong
        elif made.startswith("unknown"):
            good = bool(wrong) and not named
        else:
            good = bool(named) and named[0] in made.split("|")
        rows.append({"engine": engine, "made": made, "named": named, "wrong": wrong, "good": good})
        print(f"{'ok ' if good else 'NO '} {engine:8} {made:26} {wrong:2} wrong: {', '.join(named) or '-'}", flush=True)

    if "burnish" in given.only.split(",") and not given.modules:
        for way in OWN:
            pictures = work / f"burnish-{way}"
            subprocess.run([given.program, "conform", folder, pictures, "--draw", "--technique", way, "--quiet"], check=True)
            tell("burnish", "none", *judge(given.program, folder, pictures, ""))
    if given.engines:
        link = folder / "node_modules"
        if not link.exists():
            link.symlink_to((given.engines / "node_modules").resolve())
        server = Server(folder)
        for engine, faults in (("three", THREE), ("babylon", BABYLON)):
            if engine not in given.only.split(","):
                continue
            if given.modules:
                technique, samples = given.modules.split(":")
                rows.append({"engine": engine, "flip_to_truth": improve(given.program, folder, work, engine, technique, samples, server)})
                continue
            text = (folder / "pages" / f"{engine}.html").read_text()
            for made, code in faults.items():
                name = re.sub(r"\W+", "_", made.split("|")[0])
                pictures = work / f"{engine}-{name}"
                with tempfile.TemporaryDirectory() as profile, Browser(profile, webgl=True) as browser:
                    path = f"/pages/{engine}-{name}.html"
                    server.pages[path] = page_with(text, engine, code)
                    try:
                        if not (pictures / "rotation_0.pfm").exists():
                            draw(browser, server.address(path), pictures)
                    except RuntimeError as error:
                        print(f"--- {engine} {made}: {error}", flush=True)
                        continue
                tell(engine, made, *judge(given.program, folder, pictures, OWN_FAULTS[engine]))
    if not given.modules:
        print(f"{sum(row['good'] for row in rows)} of {len(rows)} as made")
    if given.json:
        pathlib.Path(given.json).write_text(json.dumps(rows, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
