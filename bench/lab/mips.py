#!/usr/bin/env python3
"""Compares distant maps under each mip filter with pictures of all their texels.

Usage: mips.py --program build/release/burnish [--work FOLDER] [--brdf NAMES] [--filters NAMES] [--kappa NUMBERS] [--taps N] [--samples N]
               [--textures FOLDER] [--quick] [--json FILE]

Scenes with maps of normals, roughness and directions are drawn so small that many texels lie in a pixel, by `--technique mc`, and compared
with the reference that reads the maps at full detail (--reference-textures full) under the same frames (--frame-map quaternion). A line a
scene, size and model: mean HDR-FLIP, mean absolute difference (L1) and mean squared difference (MSE) by filter, the last two over all
pixels; at the end the geometric means over all lines as shares of the first filter's. A filter whose name ends in -gain is drawn with
gains of levels. --kappa adds filter kappa at these numbers; --textures adds
the materials whose maps of normals and roughness lie in a folder each below that one.

Exit code: 0; 2 something could not be run.
"""

import array
import json
import math
import pathlib
import random
import struct
import sys
import zlib

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
from workbench import Program, arguments, in_folder  # noqa: E402

SIDE = 512  # texels of generated maps


def read_pfm(path):
    kind, _, scale, rest = path.read_bytes().split(b"\n", 3)
    assert kind == b"PF" and float(scale) < 0, path
    values = array.array("f")
    values.frombytes(rest)
    return values


def write_png(path, texel, width, height):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + bytes(c for x in range(width) for c in texel(x, y)) for y in range(height))
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b""))


def code_of_slope(sx, sy):
    length = math.sqrt(1 + sx * sx + sy * sy)
    return tuple(int(127.5 + 127.5 * n / length + 0.5) for n in (-sx, -sy, 1))


def make_maps(work):
    """Grain by chance, ridges along u, and roughness in checks and by chance."""
    chance = random.Random(7)
    write_png(work / "grain.png", lambda x, y: code_of_slope(*(0.15 * sum(chance.uniform(-1, 1) for _ in range(3)) for _ in range(2))), 2 * SIDE, SIDE)
    write_png(work / "ridges.png", lambda x, y: code_of_slope(0.05 * math.sin(x * 0.39), 0.45 * math.sin(y * 0.786)), 2 * SIDE, SIDE)
    folder = work / "worn"
    folder.mkdir(exist_ok=True)
    write_png(folder / "roughness.png", lambda x, y: (int(40 + 150 * ((x // 3 + y // 3) % 2) + chance.uniform(0, 40)),) * 3, 2 * SIDE, SIDE)
    write_png(folder / "metallic.png", lambda x, y: (255,) * 3, 1, 1)
    write_png(folder / "basecolor.png", lambda x, y: (240, 190, 120), 1, 1)


def scenes(options, work):
    """Name, words, sizes."""
    near_far = ("160x120", "80x60", "40x30")
    found = [("bumps", ("builtin:bumps",), near_far)]
    for roughness in (0.15, 0.35):
        found.append((f"grain {roughness}", ("builtin:sphere", "--material", "grain" + str(roughness)), ("48x48", "24x24")))
        folder = work / ("grain" + str(roughness))
        folder.mkdir(exist_ok=True)
        (folder / "normal.png").write_bytes((work / "grain.png").read_bytes())
        write_png(folder / "roughness.png", lambda x, y: (int(255 * roughness + 0.5),) * 3, 1, 1)
        write_png(folder / "metallic.png", lambda x, y: (255,) * 3, 1, 1)
    ridged = work / "ridged"
    ridged.mkdir(exist_ok=True)
    (ridged / "normal.png").write_bytes((work / "ridges.png").read_bytes())
    write_png(ridged / "roughness.png", lambda x, y: (70,) * 3, 1, 1)
    write_png(ridged / "metallic.png", lambda x, y: (255,) * 3, 1, 1)
    found += [("ridges", ("builtin:sphere", "--material", "ridged"), ("48x48", "24x24")),
              ("worn", ("builtin:sphere", "--material", "worn"), ("48x48", "24x24"))]
    if options.textures:
        for folder in sorted(pathlib.Path(options.textures).resolve().iterdir()):
            names = [p.name for p in folder.glob("*")]
            if any("_normal." in n for n in names) and any("_roughness." in n for n in names):
                found.append((folder.name, ("builtin:sphere", "--material", str(folder)), ("48x48", "24x24")))
    return found[:2] if options.quick else found


def difference(reference, test):
    """L1 and MSE of two pictures' channels."""
    off = [abs(a - b) for a, b in zip(reference, test)]
    return sum(off) / len(off), sum(d * d for d in off) / len(off)


def measure(options, work):
    run = Program(options, work).run
    make_maps(work)
    ways = {name: ("--mip-filter", name.removesuffix("-gain"), *(("--mip-gain", "on") if name.endswith("-gain") else ()))
            for name in options.filters.split(",")}
    for kappa in filter(None, options.kappa.split(",")):
        ways["kappa " + kappa] = ("--mip-filter", "kappa", "--mip-kappa", kappa)
    rows = []
    print("| scene | size | model | metric | " + " | ".join(ways) + " |")
    print("| --- | --- | --- | --- |" + " --- |" * len(ways))
    for name, words, sizes in scenes(options, work):
        for size in sizes:
            for brdf in options.brdf.split(","):
                common = (*words, "--size", size, "--brdf", brdf, "--no-background", "--env-size", "128", "--frame-map", "quaternion", "-q")
                reference = f"reference {name} {size} {brdf}.pfm"
                if not (work / reference).exists():
                    run("render", *common, "--backend", "reference", "--reference-textures", "full", "--samples", 8 * options.samples, "-o", reference)
                shown = read_pfm(work / reference)
                row = {}
                for way, given in ways.items():
                    run("render", *common, *given, "--texture-anisotropy", options.taps, "--technique", "mc", "--samples", options.samples, "--msaa", 16,
                        "-o", "test.pfm")
                    figures = json.loads(run("compare", reference, "test.pfm", "--metric", "flip-hdr", "--json", "-"))
                    l1, mse = difference(shown, read_pfm(work / "test.pfm"))
                    row[way] = {"flip": figures["flip_mean"], "l1": l1, "mse": mse}
                rows.append({"scene": name, "size": size, "brdf": brdf, "filters": row})
                for metric in ("flip", "l1", "mse"):
                    print(f"| {name} | {size} | {brdf} | {metric} | " + " | ".join(f"{row[way][metric]:.5f}" for way in ways) + " |", flush=True)
    for metric in ("flip", "l1", "mse"):
        first = next(iter(ways))
        shares = [math.exp(sum(math.log(r["filters"][way][metric] / r["filters"][first][metric]) for r in rows) / len(rows)) for way in ways]
        print(f"| all, of {first}'s | | | {metric} | " + " | ".join(f"{share:.3f}" for share in shares) + " |")
    if options.json:
        pathlib.Path(options.json).write_text(json.dumps(rows, indent=1) + "\n")
    return 0


def main():
    parser = arguments(__doc__)
    parser.add_argument("--brdf", default="ggx_aniso")
    parser.add_argument("--filters", default="box,lean,baseline,covariance,leadr,ssgt,kappa")
    parser.add_argument("--kappa", default="")
    parser.add_argument("--taps", default="16")
    parser.add_argument("--samples", type=int, default=256)
    parser.add_argument("--textures")
    parser.add_argument("--quick", action="store_true")
    return in_folder(parser.parse_args(), measure)


if __name__ == "__main__":
    sys.exit(main())
