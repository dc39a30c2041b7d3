#!/usr/bin/env python3
"""Every reflection model of the program on one sheet: a sphere by Monte Carlo samples and by lamps, beside its reference.

Usage: models_sheet.py --program build/release/burnish -o models.png [--env FILE] [--roughness R] [--anisotropy A] [--tilt X,Y]
                       [--exposure EV] [--side PIXELS] [--samples N] [--reference-samples N] [--work FOLDER]

Columns: the tile renderer's picture (mc), the reference's, HDR-FLIP between them. `lambert`, which is no lobe, is a sphere that
reflects diffusely and nothing else, `ellipsoid_dielectric` one of glass, through whose near side the environment is seen.
Files in the work folder are not made again. Exit code: 0 drawn; 1 a model is further from its reference than --fail-flip; 2 something could not be run.
"""

import argparse
import array
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

FONT = pathlib.Path(__file__).resolve().parent / "stroke_font.jhf"
GAP, LINE = 12, 22  # px: around pictures, of a line of text
DIFFUSE = {"pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.8, 0.8, 1], "metallicFactor": 0},
           "extensions": {"KHR_materials_specular": {"specularFactor": 0}}}
GLASS = {"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.3},
         "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}}
OF_MATERIAL = {"lambert": DIFFUSE, "ellipsoid_dielectric": GLASS}


def run(words):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True)
    if done.returncode:
        print(f"{' '.join(map(str, words))}: {done.stderr.strip()}", file=sys.stderr)
        sys.exit(2)
    return done.stdout


def sphere_file(path, material, rings=48):
    """A glTF sphere."""
    points, triangles = [], []
    for i in range(rings + 1):
        for k in range(2 * rings + 1):
            up, around = math.pi * (i / rings - 0.5), math.pi * k / rings
            points.append((math.cos(up) * math.sin(around), math.sin(up), math.cos(up) * math.cos(around)))
            if i < rings and k < 2 * rings:
                a, b = i * (2 * rings + 1) + k, (i + 1) * (2 * rings + 1) + k
                triangles += [(a, a + 1, b + 1), (a, b + 1, b)]
    data = b"".join(struct.pack("<3f", *p) for p in points)
    indices = b"".join(struct.pack("<3I", *t) for t in triangles)
    path.with_suffix(".bin").write_bytes(data + indices)
    path.write_text(json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "extensionsUsed": list(material["extensions"]), "materials": [material],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 0}, "indices": 1, "material": 0}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3", "min": [-1, -1, -1], "max": [1, 1, 1]},
                      {"bufferView": 1, "componentType": 5125, "count": 3 * len(triangles), "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": len(data)}, {"buffer": 0, "byteOffset": len(data), "byteLength": len(indices)}],
        "buffers": [{"byteLength": len(data) + len(indices), "uri": path.with_suffix(".bin").name}]}))


def read_pfm(path):
    """(width, height, rows from above of linear RGB)"""
    kind, size, _, pixels = pathlib.Path(path).read_bytes().split(b"\n", 3)
    assert kind == b"PF", path
    width, height = map(int, size.split())
    values = array.array("f", pixels)
    return width, height, [values[3 * width * y:3 * width * (y + 1)] for y in reversed(range(height))]


class Sheet:
    def __init__(self, width, height):
        self.width, self.height, self.rows = width, height, [bytearray(b"\xff" * (3 * width)) for _ in range(height)]
        self.glyphs = []
        for line in FONT.read_text().splitlines():
            if len(line) >= 10 and not line.startswith("#"):
                self.glyphs.append((ord(line[8]) - 82, ord(line[9]) - 82, line[10:]))

    def picture(self, left, top, path, scale):
        width, height, rows = read_pfm(path)
        for y in range(height):
            encoded = bytearray(3 * width)
            for i, v in enumerate(rows[y]):
                v = min(max(v * scale, 0.0), 1.0)
                encoded[i] = round(255 * (12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055))
            self.rows[top + y][3 * left:3 * (left + width)] = encoded

    def text(self, left, base, words, size=0.5):
        for letter in words:
            begin, end, strokes = self.glyphs[ord(letter) - 32]
            before = None
            for pair in (strokes[i:i + 2] for i in range(0, len(strokes) - 1, 2)):
                place = None if pair[0] == " " else (left + size * (ord(pair[0]) - 82 - begin), base + size * (ord(pair[1]) - 82 - 9))
                if before and place:
                    steps = 1 + int(2 * max(abs(place[0] - before[0]), abs(place[1] - before[1])))
                    for s in range(steps + 1):
                        x, y = (round(before[k] + (place[k] - before[k]) * s / steps) for k in range(2))
                        if 0 <= x < self.width and 0 <= y < self.height:
                            self.rows[y][3 * x:3 * x + 3] = b"\x20\x20\x20"
                before = place
            left += size * (end - begin)

    def write(self, path):
        def chunk(kind, data):
            return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

        header = struct.pack(">IIBBBBB", self.width, self.height, 8, 2, 0, 0, 0)
        data = zlib.compress(b"".join(b"\0" + row for row in self.rows))
        pathlib.Path(path).write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", data) + chunk(b"IEND", b""))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--env", default="builtin:studio")
    parser.add_argument("--roughness", default="0.5")
    parser.add_argument("--anisotropy", default="0.7")
    parser.add_argument("--tilt", default="15,0", help="of the models that can be tilted")
    parser.add_argument("--exposure", type=float, default=-1.0)
    parser.add_argument("--side", type=int, default=160)
    parser.add_argument("--samples", default="1024")
    parser.add_argument("--reference-samples", default="1024")
    parser.add_argument("--fail-flip", type=float, default=1.0)
    parser.add_argument("--work", type=pathlib.Path)
    given = parser.parse_args()
    work = given.work or pathlib.Path(tempfile.mkdtemp())
    work.mkdir(exist_ok=True)
    models = [line.split()[0:2] for line in run([given.program, "list", "models"]).splitlines() if line.strip()]
    columns = 2
    cell_width, cell_height = 2 * given.side + 3 * GAP, given.side + LINE + GAP
    rows = -(-len(models) // columns)
    sheet = Sheet(columns * cell_width, rows * cell_height + GAP)
    worst = 0.0
    for i, (name, option) in enumerate(models):
        left, top = i % columns * cell_width + GAP, i // columns * cell_height + LINE
        scene, words = "builtin:sphere", ["--brdf", name]
        if name == "ellipsoid":
            words.append(f"--tilt={given.tilt}")
        if name in OF_MATERIAL:
            scene, words = work / f"{name}.gltf", []
            sphere_file(scene, OF_MATERIAL[name])
        elif not option.startswith("--brdf"):
            sheet.text(left, top - 6, f"{name}: on no surface")
            continue
        base = [given.program, "render", scene, *words, "--env", given.env, "--size", f"{given.side}x{given.side}", "--no-background", "-q"]
        if name not in OF_MATERIAL:
            base += ["--roughness", given.roughness, f"--anisotropy={given.anisotropy}"]
        test, reference = work / f"{name}.pfm", work / f"{name}_reference.pfm"
        if not test.exists():
            run([*base, "--technique", "mc", "--samples", given.samples, "-o", test])
        if not reference.exists():
            run([*base, "--backend", "reference", "--samples", given.reference_samples, "-o", reference])
        flip = json.loads(run([given.program, "compare", reference, test, "--metric", "flip-hdr", "--json", "-"]))["flip_mean"]
        worst = max(worst, flip)
        sheet.text(left, top - 6, f"{name}  FLIP {flip:.3f}")
        sheet.picture(left, top, test, 2 ** given.exposure)
        sheet.picture(left + given.side + GAP, top, reference, 2 ** given.exposure)
        print(f"{name:22} {flip:.4f}")
    sheet.write(given.output)
    return 1 if worst > given.fail_flip else 0


if __name__ == "__main__":
    sys.exit(main())
