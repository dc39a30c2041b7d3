#!/usr/bin/env python3
"""as_mc: how many samples a lobe needs by its exponent, and how large its tables have to be.

Usage: phong.py --program build/release/burnish [--env FILE] [--size WxH] [--work FOLDER] [--json FILE] [--no-tables]

  - Samples: mean HDR-FLIP of builtin:sphere by 1, 2, 4 ... 256 samples against 8192, for exponents 10, 70, 400, 20000.
  - Tables of albedo (`burnish bake brdf-lut`) of nu 70 and nv 400: the largest difference to quadrature in double at 300 places, read as
    between texels, and the FLIP by which a picture with 64 samples moves where it takes the table.
  - Tables of half vectors (`burnish bake half-vectors`): the largest angle, in degrees, between a sample of 64 and its texel, and FLIP.

Exit code: 0 of 64 samples shinier lobes are nearer to the reference; 1 they are not; 2 something could not be run.
"""

import argparse
import array
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

EXPONENTS = (10, 70, 400, 20000)
SAMPLES = (1, 2, 4, 8, 16, 32, 64, 128, 256)
NU, NV = 70, 400
ALBEDO_SIDES = (512, 128, 32, 16, 8)
HALF_SIDES = (512, 256, 128, 64, 32)


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode not in (0, 1):
        print(f"{' '.join(map(str, words))}: {done.stderr.strip()}", file=sys.stderr)
        sys.exit(2)
    return done.stdout


def read_pfm(path):
    kind, size, _, pixels = path.read_bytes().split(b"\n", 3)
    width, height = map(int, size.split())
    values = array.array("f", pixels)
    channels = len(values) // (width * height)
    return width, height, [values[channels * width * y:channels * width * (y + 1)] for y in reversed(range(height))]  # top row first


def half_vector(nu, nv, x, y):
    """Ashikhmin and Shirley's equations 9 and 10, for all four quadrants at once."""
    a, b = math.sqrt(nv + 1) * math.cos(2 * math.pi * x), math.sqrt(nu + 1) * math.sin(2 * math.pi * x)
    length = math.hypot(a, b)
    c, s = a / length, b / length
    z = (1 - y) ** (1 / (nu * c * c + nv * s * s + 1))
    q = math.sqrt(max(0.0, 1 - z * z))
    return c * q, s * q, z


def albedo(nu, nv, root_eye, root_along, points=6765, before=4181):
    """(s, b) of f0 s + b at an eye, by a lattice of Fibonacci, in double."""
    z = max(root_eye * root_eye, 1e-4)
    along = root_along * root_along
    v = (math.sqrt(1 - z * z) * along, math.sqrt(1 - z * z) * math.sqrt(1 - along * along), z)
    s = b = 0.0
    for i in range(points):
        h = half_vector(nu, nv, (i * before % points + 0.5) / points, (i + 0.5) / points)
        v_h = sum(p * q for p, q in zip(v, h))
        out = 2 * v_h * h[2] - z
        if out > 0:
            weight, fresnel = out / max(z, out), (1 - min(v_h, 1.0)) ** 5
            s, b = s + weight * (1 - fresnel), b + weight * fresnel
    return s / points, b / points


def between(table, x, y):
    """(red, green) at a place in [0,1]^2 whose corners are the outermost texels."""
    width, height, rows = table
    px, py = x * (width - 1), y * (height - 1)
    i, j = min(int(px), width - 2), min(int(py), height - 2)
    fx, fy = px - i, py - j
    return [(rows[j][3 * i + c] * (1 - fx) + rows[j][3 * i + 3 + c] * fx) * (1 - fy)
            + (rows[j + 1][3 * i + c] * (1 - fx) + rows[j + 1][3 * i + 3 + c] * fx) * fy for c in range(2)]


def point(i, n, part):
    """Point i of n of one of four sets, as the program takes them: a row of equal area across the disc, the golden ratio along it, held
    by a table of 256 texels a side or the next power of two that holds all of them."""
    side = 256
    while side < 4 * n:
        side *= 2
    at = 4 * i + part
    area, low, high = math.pi * (at + 0.5) / (4 * n), 0.0, math.pi
    for _ in range(24):
        angle = 0.5 * (low + high)
        low, high = (angle, high) if angle - 0.5 * math.sin(2 * angle) < area else (low, angle)
    x, y = -math.cos(low), (2 * ((0.5 + at * 0.3819660112501051) % 1) - 1) * math.sin(low)
    column = math.floor(math.atan2(y, x) / (2 * math.pi) % 1 * side + 0.5)
    return column % side / side, min(math.floor((x * x + y * y) * side + 0.5), side - 1) / side


class Pictures:
    def __init__(self, given, work):
        self.given, self.work = given, work
        self.words = ["builtin:sphere", "--env", given.env, "--size", given.size, "--msaa", "1", "--key-lights", "off", "--no-background", "-q",
                      "--technique", "as_mc"]

    def draw(self, name, *words):
        run(self.given.program, "render", *self.words, *words, "-o", self.work / name)

    def flip(self, reference, name):
        text = run(self.given.program, "compare", self.work / reference, self.work / name, "--metric", "flip", "--json", "-", "-q")
        return json.loads(text)["flip_mean"]


def by_samples(pictures):
    rows = {}
    for exponent in EXPONENTS:
        lobe = ("--roughness", f"{exponent ** -0.25:.6g}", "--anisotropy", "0")
        pictures.draw("reference.pfm", *lobe, "--samples", "8192", "--as-tables", "off")
        rows[exponent] = []
        for samples in SAMPLES:
            pictures.draw("t.pfm", *lobe, "--samples", samples)
            rows[exponent].append(pictures.flip("reference.pfm", "t.pfm"))
        print(f"| {exponent} | " + " | ".join(f"{value:.4f}" for value in rows[exponent]) + " |", flush=True)
    return rows


def by_tables(pictures):
    program, work = pictures.given.program, pictures.work
    a, b = NU ** -0.5, NV ** -0.5  # alpha (1 +- eta)
    lobe = ("--roughness", f"{math.sqrt((a + b) / 2):.7g}", "--anisotropy", f"{(a - b) / (a + b):.7g}", "--samples", "64")
    pictures.draw("own.pfm", *lobe)
    chance = random.Random(3)
    places = [(chance.random(), chance.random()) for _ in range(300)]
    reference = [albedo(NU, NV, y, x) for x, y in places]
    found = {}
    exponents = ("--nu", NU, "--nv", NV)
    for side in ALBEDO_SIDES:
        run(program, "bake", "brdf-lut", *exponents, "--size", f"{side}x{side}", "-q", "-o", work / "a.pfm")
        table = read_pfm(work / "a.pfm")
        worst = max(abs(p - q) for place, value in zip(places, reference) for p, q in zip(between(table, *place), value))
        pictures.draw("t.pfm", *lobe, "--as-table", work / "a.pfm")
        found["albedo", side] = (worst, pictures.flip("own.pfm", "t.pfm"))
        print(f"| albedo | {side} | {worst:.5f} | {found['albedo', side][1]:.5f} |", flush=True)
    for side in HALF_SIDES:
        worst = 0.0
        for i in range(64):
            for part in range(4):
                x, y = point(i, 64, part)
                own, held = half_vector(NU, NV, x, y), half_vector(NU, NV, int(x * side) / side, int(y * side) / side)
                worst = max(worst, math.degrees(math.acos(min(1.0, sum(p * q for p, q in zip(own, held))))))
        run(program, "bake", "half-vectors", *exponents, "--size", f"{side}x{side}", "-q", "-o", work / "h.exr")
        pictures.draw("t.pfm", *lobe, "--as-table", work / "h.exr")
        found["half vectors", side] = (worst, pictures.flip("own.pfm", "t.pfm"))
        print(f"| half vectors | {side} | {worst:.3f} | {found['half vectors', side][1]:.5f} |", flush=True)
    return found


def main():
    parser = argparse.ArgumentParser(description="as_mc by samples and by tables")
    parser.add_argument("--program", required=True)
    parser.add_argument("--env", default="builtin:studio")
    parser.add_argument("--size", default="240x135")
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("--json", type=pathlib.Path)
    parser.add_argument("--no-tables", action="store_true")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as made:
        work = given.work or pathlib.Path(made)
        work.mkdir(parents=True, exist_ok=True)
        pictures = Pictures(given, work)
        print("| n | " + " | ".join(map(str, SAMPLES)) + " |\n| --- |" + " --- |" * len(SAMPLES))
        samples = by_samples(pictures)
        tables = {}
        if not given.no_tables:
            print("\n| table | texels a side | off by | FLIP |\n| --- | --- | --- | --- |")
            tables = by_tables(pictures)
    if given.json:
        given.json.write_text(json.dumps({"samples": samples, "tables": [[*key, *value] for key, value in tables.items()]}, indent=1))
    at = SAMPLES.index(64)
    falls = all(samples[shiny][at] < samples[dull][at] for dull, shiny in zip(EXPONENTS, EXPONENTS[1:]))
    return 0 if falls else 1


if __name__ == "__main__":
    sys.exit(main())
