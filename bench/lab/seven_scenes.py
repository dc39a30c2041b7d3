#!/usr/bin/env python3
"""Distances of engines to the reference on seven bare shapes, as they are and with burnish's exported modules.

Usage: seven_scenes.py --program build/release/burnish --engines FOLDER --environments A,B,C,D [--work FOLDER] [--technique lobe_line:64]
                       [--energy-compensation] [--json FILE]

FOLDER holds node_modules with three, babylonjs and babylonjs-loaders. A to D are .hdr files. Each engine draws 256 x 192 pixels in headless
Chromium by the page of a conformance folder. Prints the mean HDR-FLIP over each object to a reference with 1024 samples a pixel.
--energy-compensation gives the reference, the tile renderer and the modules multiple scattering, as both engines have it. Exit code: 0 measured; 2 something could not be run.
"""

import argparse
import base64
import filecmp
import json
import math
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests/cli"))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from browser import Browser
from conform import Server, draw

WIDTH, HEIGHT, YFOV = 256, 192, 0.6 # as the pages expect
EYE = (0.0, 0.9, 4.2)
# shape, roughness, anisotropy strength, environment
SCENES = (("sphere", 0.3, 0.6, "A"), ("sphere", 0.2, 0.3, "B"), ("sphere", 0.5, 0.9, "C"), ("torus", 0.3, 0.6, "C"), ("torus", 0.5, 0.6, "D"),
          ("plate", 0.2, 0.3, "A"), ("torus", 0.7, 0.8, "B"))


def sphere(u, v):
    """Returns position, normal and tangent at texture coordinates."""
    turn, height = 2 * math.pi * u, math.pi * v
    p = (-math.cos(turn) * math.sin(height), math.cos(height), math.sin(turn) * math.sin(height))
    return p, p, (math.sin(turn), 0.0, math.cos(turn))


def torus(u, v):
    """A ring that leans towards the camera, wide radius .75, narrow .3; tangents run around the ring."""
    turn, tube, lean = 2 * math.pi * u, -2 * math.pi * v, math.radians(35)
    lift = lambda p: (p[0], p[1] * math.cos(lean) + p[2] * math.sin(lean), p[2] * math.cos(lean) - p[1] * math.sin(lean))
    around = (math.cos(turn), math.sin(turn), 0.0)
    normal = tuple(math.cos(tube) * a + b for a, b in zip(around, (0.0, 0.0, math.sin(tube))))
    place = tuple(0.75 * a + 0.3 * n for a, n in zip(around, normal))
    return lift(place), lift(normal), lift((-math.sin(turn), math.cos(turn), 0.0))


def plate(u, v):
    """A square that leans back by 60 degrees."""
    lean = math.radians(60)
    up = (0.0, math.cos(lean), -math.sin(lean))
    place = tuple((2 * u - 1) * a + (1 - 2 * v) * b for a, b in zip((1.0, 0.0, 0.0), up))
    return place, (0.0, math.sin(lean), math.cos(lean)), (1.0, 0.0, 0.0)


SHAPES = {"sphere": (sphere, 96, 64), "torus": (torus, 128, 64), "plate": (plate, 8, 8)}


def write_scene(path, shape, roughness, strength):
    point, across, down = SHAPES[shape]
    columns = {"POSITION": [], "NORMAL": [], "TANGENT": [], "TEXCOORD_0": []}
    indices = []
    for j in range(down + 1):
        for i in range(across + 1):
            place, normal, tangent = point(i / across, j / down)
            columns["POSITION"] += place
            columns["NORMAL"] += normal
            columns["TANGENT"] += (*tangent, 1.0)
            columns["TEXCOORD_0"] += (i / across, j / down)
    for j in range(down):
        for a in range(j * (across + 1), j * (across + 1) + across):
            b, c, d = a + 1, a + across + 1, a + across + 2
            indices += ([a, c, b] if shape != "sphere" or j else []) + ([b, c, d] if shape != "sphere" or j < down - 1 else [])
    # Triangles run counterclockwise as seen from outside
    p = [columns["POSITION"][3 * k:3 * k + 3] for k in indices[-3:]]
    e, f = ([q[k] - p[0][k] for k in range(3)] for q in p[1:])
    face = (e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0])
    if sum(a * b for a, b in zip(face, columns["NORMAL"][3 * indices[-1]:][:3])) < 0:
        indices = [k for t in range(0, len(indices), 3) for k in (indices[t], indices[t + 2], indices[t + 1])]
    count, data, views, accessors = len(columns["TEXCOORD_0"]) // 2, b"", [], []
    for name, values in (*columns.items(), ("indices", indices)):
        part = struct.pack(f"<{len(values)}{'I' if name == 'indices' else 'f'}", *values)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(part)})
        width = 1 if name == "indices" else len(values) // count
        accessors.append({"bufferView": len(views) - 1, "componentType": 5125 if width == 1 else 5126, "count": len(values) // width,
                          "type": {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}[width],
                          **({"min": [min(values[k::3]) for k in range(3)], "max": [max(values[k::3]) for k in range(3)]} if name == "POSITION" else {})})
        data += part
    tilt = math.atan2(EYE[1], EYE[2])
    camera = [1, 0, 0, 0, 0, math.cos(tilt), -math.sin(tilt), 0, 0, math.sin(tilt), math.cos(tilt), 0, *EYE, 1]
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}], "nodes": [{"mesh": 0}, {"matrix": camera, "camera": 0}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": YFOV, "aspectRatio": WIDTH / HEIGHT, "znear": 0.1, "zfar": 100}}],
        "meshes": [{"primitives": [{"attributes": {name: k for k, name in enumerate(columns)}, "indices": 4, "material": 0}]}],
        "materials": [{"doubleSided": shape == "plate", "pbrMetallicRoughness": {"baseColorFactor": [0.97, 0.96, 0.91, 1], "metallicFactor": 1, "roughnessFactor": roughness},
                       "extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": strength}}}],
        "extensionsUsed": ["KHR_materials_anisotropy"], "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]}))


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"{' '.join(map(str, words))}: {done.stderr.strip()}")
    return done.stdout


def distance(program, reference, picture, coverage):
    return json.loads(run(program, "compare", reference, picture, "--metric", "flip-hdr", "--json", "-", "--quiet"))["flip_mean"] / coverage


def covered(path):
    """Returns the share of pixels that are not black."""
    data = path.read_bytes().split(b"\n", 3)[3]
    floats = struct.unpack(f"<{len(data) // 4}f", data)
    return sum(any(floats[k:k + 3]) for k in range(0, len(floats), 3)) / (len(floats) // 3)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    parser.add_argument("--engines", type=pathlib.Path, required=True)
    parser.add_argument("--environments", required=True)
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("--technique", default="lobe_line:64", metavar="NAME:SAMPLES")
    parser.add_argument("--energy-compensation", action="store_true")
    parser.add_argument("--json")
    given = parser.parse_args()
    technique, samples = given.technique.split(":")
    files = dict(zip("ABCD", given.environments.split(","), strict=True))
    temporary = tempfile.TemporaryDirectory()
    work = given.work or pathlib.Path(temporary.name)
    work.mkdir(parents=True, exist_ok=True)
    run(given.program, "conform", "--write", work / "kit", "--quiet")
    rows = []
    for letter, environment in files.items():
        folder = work / letter
        (folder / "scenes").mkdir(parents=True, exist_ok=True)
        shutil.copytree(work / "kit/pages", folder / "pages", dirs_exist_ok=True)
        if given.energy_compensation:
            for page in (folder / "pages").glob("*.html"):
                page.write_text(re.sub(r"improve\((?=gltf|BABYLON)([^;]*)\);", r"improve(\1, { multipleScattering: true });", page.read_text()))
        if not (folder / "environment.hdr").exists() or not filecmp.cmp(environment, folder / "environment.hdr", shallow=False):
            for old in folder.glob("*-reference*.pfm"):
                old.unlink()
            shutil.copy(environment, folder / "environment.hdr")
        if not (folder / "node_modules").exists():
            (folder / "node_modules").symlink_to((given.engines / "node_modules").resolve())
        scenes = [(f"{shape}_{roughness}_{strength}", shape, roughness, strength) for shape, roughness, strength, place in SCENES if place == letter]
        for name, *parts in scenes:
            write_scene(folder / f"scenes/{name}.gltf", *parts)
        (folder / "conform.json").write_text(json.dumps({
            "burnish_conform": 2, "width": WIDTH, "height": HEIGHT, "exposure_ev": 0, "environment": "environment.hdr",
            "scenes": [{"name": name, "about": "", "file": f"scenes/{name}.gltf", "environment": True, "area_light": None} for name, *_ in scenes]}))
        server = Server(folder)
        for engine in ("three", "babylon"):
            server.pages[f"/pages/burnish_{engine}.js"] = run(given.program, "export", engine, "--technique", technique, "--samples", samples, "-o", "-", "--quiet")
            for way, query in (("as_it_is", ""), ("module", f"?module=burnish_{engine}.js")):
                with tempfile.TemporaryDirectory() as profile, Browser(profile, webgl=True) as browser:
                    draw(browser, server.address(f"/pages/{engine}.html{query}"), folder / f"{engine}-{way}")
        for name, shape, roughness, strength in scenes:
            view = (folder / f"scenes/{name}.gltf", "--env", folder / "environment.hdr", "--no-background", "--size", f"{WIDTH}x{HEIGHT}", "--quiet",
                    *(("--energy-compensation",) if given.energy_compensation else ()))
            reference = folder / f"{name}-reference{'-compensated' if given.energy_compensation else ''}.pfm"
            if not reference.exists():
                run(given.program, "render", *view, "--backend", "reference", "--samples", "1024", "-o", reference)
            run(given.program, "render", *view, "--msaa", "8", "--technique", technique, "--samples", samples, "-o", folder / f"{name}-tile.pfm")
            share = covered(reference)
            row = {"shape": shape, "roughness": roughness, "strength": strength, "environment": letter, "tile": distance(given.program, reference, folder / f"{name}-tile.pfm", share)}
            for engine in ("three", "babylon"):
                for way in ("as_it_is", "module"):
                    row[f"{engine}_{way}"] = distance(given.program, reference, folder / f"{engine}-{way}/{name}.pfm", share)
            rows.append(row)
    columns = ("three_as_it_is", "three_module", "babylon_as_it_is", "babylon_module", "tile")
    print(f"{'':26}" + "".join(f"{name:>18}" for name in columns))
    for row in rows:
        print(f"{row['shape']} r {row['roughness']} s {row['strength']}, {row['environment']:10}" + "".join(f"{row[name]:18.3f}" for name in columns))
    print(f"{'mean':26}" + "".join(f"{sum(row[name] for row in rows) / len(rows):18.3f}" for name in columns))
    if given.json:
        pathlib.Path(given.json).write_text(json.dumps(rows, indent=1) + "\n")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (RuntimeError, OSError, ValueError) as error:
        print(f"seven_scenes.py: {error}", file=sys.stderr)
        sys.exit(2)
