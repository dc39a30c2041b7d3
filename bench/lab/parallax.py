#!/usr/bin/env python3
"""Parallax against the same heights as triangles: FLIP by depth, angle and metric.

Usage: parallax.py --program build/release/burnish [--work FOLDER] [--size WxH] [--stretch F] [--triangles N] [--quick] [--json FILE]
       parallax.py --program build/release/burnish --sheet FILE.png

A cobbled wall, 1 m wide and --stretch times as high, is drawn as a flat square with heights and normals in maps, by --pom-metric uv and
surface and without parallax, and as `burnish bake displaced` makes it, of 1 M triangles. A line a depth (lengths of texture coordinates)
and angle (degrees off the wall's normal): mean FLIP of each over the pixels that both cover whole, and the share of the picture's
covered pixels that were masked for being part of a silhouette of one of them.

--sheet draws builtin:bumps' wall with 0, .33, .67 and 1 times four times its own depth, in place of all that.

Exit code: 0 parallax is nearer than the flat wall everywhere; 1 it is not; 2 something could not be run.
"""

import argparse
import array
import json
import math
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import zlib

SIDE = 512    # texels
STONES = 7    # along u


def read_pfm(path):
    data = path.read_bytes()
    kind, size, scale, rest = data.split(b"\n", 3)
    values = array.array("f")
    values.frombytes(rest)
    if float(scale) > 0:
        values.byteswap()
    return values, 3 if kind == b"PF" else 1


def write_pfm(path, rows, channels):
    """rows: from the top, flat lists."""
    width = len(rows[0]) // channels
    out = array.array("f")
    for row in reversed(rows):
        out.extend(row)
    path.write_bytes(b"%s\n%d %d\n-1.0\n" % (b"PF" if channels == 3 else b"Pf", width, len(rows)) + out.tobytes())


def cobbles():
    """Heights [0,1], by rows: round stones about jittered points, that wrap."""
    chance = random.Random(5)
    points = [[(i + 0.2 + 0.6 * chance.random(), j + 0.2 + 0.6 * chance.random()) for i in range(STONES)] for j in range(STONES)]
    rows = []
    for y in range(SIDE):
        v, row = (y + 0.5) * STONES / SIDE, []
        for x in range(SIDE):
            u = (x + 0.5) * STONES / SIDE
            nearest = 9.0
            for j in range(int(v) - 1, int(v) + 2):
                for i in range(int(u) - 1, int(u) + 2):
                    px, py = points[j % STONES][i % STONES]
                    nearest = min(nearest, (u - px - i + i % STONES) ** 2 + (v - py - j + j % STONES) ** 2)
            row.append(max(0.0, 1.0 - nearest / 0.36) ** 0.5)
        rows.append(row)
    return rows


def normals(heights, depth, stretch):
    """Of a wall that is `stretch` times as high as wide."""
    rows = []
    for y in range(SIDE):
        row = []
        for x in range(SIDE):
            along = 0.5 * SIDE * depth * math.sqrt(stretch) * (heights[y][(x + 1) % SIDE] - heights[y][x - 1])
            down = 0.5 * SIDE * depth / math.sqrt(stretch) * (heights[(y + 1) % SIDE][x] - heights[y - 1][x])
            length = math.sqrt(along * along + down * down + 1.0)
            row += [0.5 - 0.5 * along / length, 0.5 + 0.5 * down / length, 0.5 + 0.5 / length]
        rows.append(row)
    return rows


def read_png(path):
    """Rows of 8 bits, and how many channels: 3 or 4."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at : at + 8])
        if kind == b"IHDR":
            width, height, bits, colour = struct.unpack(">IIBB", data[at + 8 : at + 18])
            assert bits == 8 and colour in (2, 6), path
        if kind == b"IDAT":
            packed += data[at + 8 : at + 8 + size]
        at += 12 + size
    n = 3 if colour == 2 else 4
    raw, stride, before, rows = zlib.decompress(packed), n * width, bytes(n * width), []
    for y in range(height):
        way, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        for i in range(stride):
            a, b, c = line[i - n] if i >= n else 0, before[i], before[i - n] if i >= n else 0
            paeth = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            line[i] = line[i] + (0, a, b, (a + b) // 2, paeth)[way] & 255
        rows.append(line)
        before = line
    return rows, n


def alpha_of(path):
    """Returns each pixel's coverage, 0 to 255, by rows."""
    rows, channels = read_png(path)
    assert channels == 4, path
    return [alpha for row in rows for alpha in row[3::4]]


def write_png(path, rows, channels):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", len(rows[0]) // channels, len(rows), 8, 2 if channels == 3 else 6, 0, 0, 0)
    body = zlib.compress(b"".join(b"\0" + bytes(row) for row in rows), 9)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", body) + chunk(b"IEND", b""))


def draw_sheet(run, work, sheet):
    """builtin:bumps' wall at four height scales, side by side."""
    rows = None
    for scale in (0, 0.33, 0.67, 1):
        run("render", "builtin:bumps", "--eye", "1.1,-0.3,0.85", "--target", "0.52,-0.54,0.02", "--fov", 40, "--size", "320x280", "--msaa", 16, "--env",
            "builtin:sky", "--height-scale", 4 * scale, "-q", "-o", "part.png")
        part, channels = read_png(work / "part.png")
        rows = part if rows is None else [a + b for a, b in zip(rows, part)]
    write_png(sheet, rows, channels)


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--program", required=True)
    arguments.add_argument("--work")
    arguments.add_argument("--size", default="480x360")
    arguments.add_argument("--stretch", type=float, default=1.0)
    arguments.add_argument("--triangles", type=int, default=1000000)
    arguments.add_argument("--quick", action="store_true")
    arguments.add_argument("--json")
    arguments.add_argument("--sheet")
    options = arguments.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        work = pathlib.Path(options.work or scratch)
        work.mkdir(parents=True, exist_ok=True)
        return measure(options, work)


def measure(options, work):
    def run(*words):
        done = subprocess.run([options.program, *map(str, words)], cwd=work, capture_output=True, text=True)
        if done.returncode != 0:
            print(done.stderr, file=sys.stderr)
            sys.exit(2)

    if options.sheet:
        draw_sheet(run, work, pathlib.Path(options.sheet))
        return 0
    heights = cobbles()
    write_pfm(work / "heights.pfm", heights, 1)
    albedo = [[c for h in row for c in (0.25 + 0.35 * h, 0.22 + 0.3 * h, 0.2 + 0.25 * h)] for row in heights]
    write_pfm(work / "albedo.pfm", albedo, 3)
    high = options.stretch
    (work / "wall.obj").write_text(f"v 0 0 0\nv 1 0 0\nv 1 {high} 0\nv 0 {high} 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n")
    folders = {"plain": work / "plain", "mapped": work / "mapped"}
    for folder in folders.values():
        folder.mkdir(exist_ok=True)
        (folder / "albedo.pfm").write_bytes((work / "albedo.pfm").read_bytes())
    depths, angles = ((0.05,), (45,)) if options.quick else ((0.033, 0.067, 0.1), (20, 45, 70))
    rows, worse = [], False
    print("depth angle  flat   uv     surface  masked")
    for depth in depths:
        write_pfm(work / "mapped" / "normal.pfm", normals(heights, depth, high), 3)
        run("bake", "displaced", "wall.obj", "heights.pfm", "--height-scale", depth, "--triangles", options.triangles, "-q", "-o", "wall.glb")
        for angle in angles:
            a = math.radians(angle)
            eye = f"{0.5 + 1.6 * math.sin(a)},{0.5 * high},{1.6 * math.cos(a)}"
            view = ("--size", options.size, "--eye", eye, "--target", f"0.5,{0.5 * high},0", "--fov", 38, "--env", "builtin:sky", "--msaa", 16,
                    "--no-background", "--roughness", 0.5, "--texture-anisotropy", 16, "-q")
            name = f"{depth}_{angle}_"
            run("render", "wall.glb", *view, "--material", "plain", "-o", name + "reference.pfm", "-o", name + "reference.png")
            flat = ("wall.obj", "--material", "mapped")
            for way, words in (("flat", ()), ("uv", ("--pom-metric", "uv")), ("surface", ("--pom-metric", "surface"))):
                given = () if way == "flat" else ("--height-map", "heights.pfm", "--height-scale", depth / 0.05)
                run("render", *flat, *given, *words, *view, "-o", name + way + ".pfm", "-o", name + way + ".png")
            covered = [alpha_of(work / (name + way + ".png")) for way in ("reference", "flat")]
            row = {"depth": depth, "angle": angle}
            kept = [i for i in range(len(covered[0])) if covered[0][i] == covered[1][i] == 255]
            some = sum(1 for i in range(len(covered[0])) if covered[0][i] or covered[1][i])
            row["masked"] = 1.0 - len(kept) / some
            for way in ("flat", "uv", "surface"):
                run("compare", name + "reference.pfm", name + way + ".pfm", "--metric", "flip-hdr", "--error-map", "map.pfm", "-q")
                errors, channels = read_pfm(work / "map.pfm")
                row[way] = sum(errors[channels * i] for i in kept) / len(kept)
            worse = worse or row["surface"] >= row["flat"]
            rows.append(row)
            print("{depth:<5} {angle:<5}  {flat:.4f} {uv:.4f} {surface:.4f}   {masked:.1%}".format(**row), flush=True)
    if options.json:
        pathlib.Path(options.json).write_text(json.dumps(rows, indent=1) + "\n")
    return 1 if worse else 0


if __name__ == "__main__":
    sys.exit(main())
