#!/usr/bin/env python3
"""Compares the marks of `burnish render --risks` with wrong pixels, and times them: bench/lab/risks.py PROGRAM [--set] [--keep DIR] [--time N]

Pairs of scenes and environments that the constants of apps/risks/risks.cpp were not chosen by; with --set those that they were. Of every pair:
the share of shaded pixels that is marked, the share of pixels with FLIP above .15 that is among them (recall), the share of marked ones with
FLIP above .05 (precision). The reference has the same lobe and 1024 samples a pixel.

--time N: in place of that CPU time, user and system, of N runs with --risks and N without, by turns, one thread, and of the frame itself: the
difference of runs of one frame and of five, a fourth.
"""

import argparse
import array
import json
import pathlib
import re
import resource
import statistics
import subprocess
import sys
import tempfile
import zlib

SIZE = "240x160"
DATA = pathlib.Path(__file__).resolve().parents[3] / "shared/data"
FAR, NEAR = 0.15, 0.05

# scene, environment, words
SET = (
    ("builtin:sphere", "builtin:studio", "--technique bent_normal --roughness 0.4 --anisotropy 0.6"),
    ("builtin:sphere", "builtin:studio", "--technique bent_normal --roughness 0.2 --anisotropy 0.3"),
    ("builtin:sphere", "builtin:studio", "--technique split_isotropic --roughness 0.4 --anisotropy 0.8"),
    ("builtin:sphere", "builtin:sky", "--technique split_isotropic --roughness 0.3 --anisotropy 0.5"),
    ("builtin:sphere", "builtin:studio", "--technique major_axis --roughness 0.4 --anisotropy 0.8"),
    ("builtin:plate", "builtin:studio", "--technique major_axis --roughness 0.5 --anisotropy 0.9"),
    ("builtin:sphere", "builtin:studio", "--technique major_axis_weighted --samples 8 --roughness 0.35 --anisotropy 0.9"),
    ("builtin:sphere", "builtin:studio", "--technique lobe_line --roughness 0.4 --anisotropy 0.9"),
    ("builtin:sphere", "builtin:studio", "--technique filtered_is --samples 25 --roughness 0.5 --anisotropy 0.5"),
    ("builtin:sphere", "builtin:sky", "--technique mc --samples 64 --roughness 0.4 --anisotropy 0.5"),
    ("builtin:plate", "builtin:studio", "--technique split_isotropic --roughness 0.5 --anisotropy 0"),
    ("builtin:sphere", "builtin:studio", "--technique lobe_line --roughness 0.5 --anisotropy 0.6 --tilt 40,0"),
)
JUDGED = (
    ("builtin:teapot", "blender_city_1k.exr", "--technique bent_normal"),
    ("builtin:teapot", "workshop_1k.hdr", "--technique split_isotropic"),
    ("builtin:teapot", "blender_studio_1k.exr", "--technique major_axis"),
    ("builtin:teapot", "builtin:night", "--technique lobe_line"),
    ("builtin:spheres", "blender_night_1k.exr", "--technique bent_normal"),
    ("builtin:spheres", "pmndrs_lobby_512.exr", "--technique split_isotropic"),
    ("builtin:spheres", "workshop_1k.hdr", "--technique major_axis"),
    ("builtin:spheres", "blender_city_1k.exr", "--technique major_axis_weighted --samples 6"),
    ("builtin:spheres", "pmndrs_lobby_512.exr", "--technique auto"),
    ("builtin:spheres", "blender_studio_1k.exr", "--technique filtered_is"),
    ("builtin:spheres", "workshop_1k.hdr", "--technique mc --samples 16"),
    ("builtin:plate", "pmndrs_lobby_512.exr", "--technique bent_normal"),
    ("builtin:plate", "blender_city_1k.exr", "--technique split_isotropic --roughness 0.3"),
    ("builtin:teapot", "pmndrs_lobby_512.exr", "--technique lobe_line --tilt 30,10 --roughness 0.4"),
    ("builtin:teapot", "blender_city_1k.exr", "--technique major_axis_adaptive --samples 7 --roughness 0.5 --anisotropy 0.8"),
    ("models/AnisotropyBarnLamp.glb", "workshop_1k.hdr", "--technique bent_normal"),
    ("models/AnisotropyBarnLamp.glb", "blender_studio_1k.exr", "--technique split_isotropic"),
    ("models/AnisotropyStrengthTest.glb", "pmndrs_lobby_512.exr", "--technique bent_normal"),
    ("models/AnisotropyStrengthTest.glb", "blender_city_1k.exr", "--technique major_axis"),
    ("models/FlightHelmet/FlightHelmet.gltf", "workshop_1k.hdr", "--technique split_isotropic"),
)


def floats(path):
    """A grey PFM's rows, top first."""
    data = path.read_bytes()
    head = re.match(rb"(P[fF])\s+(\d+)\s+(\d+)\s+(\S+)\s", data)
    kind, width, height, scale = head.groups()
    values = array.array("f", data[head.end():])
    assert kind == b"Pf" and float(scale) < 0
    w = int(width)
    return [list(values[w * y : w * (y + 1)]) for y in reversed(range(int(height)))]


def colours(path):
    """Rows of pixels of an 8-bit RGB .png as the program writes them."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        size, kind = int.from_bytes(data[at : at + 4], "big"), data[at + 4 : at + 8]
        body = data[at + 8 : at + 8 + size]
        if kind == b"IHDR":
            width = int.from_bytes(body[:4], "big")
        packed += body if kind == b"IDAT" else b""
        at += 12 + size
    raw, rows, before = zlib.decompress(packed), [], bytearray(3 * width)
    for start in range(0, len(raw), 3 * width + 1):
        filtered, line = raw[start], bytearray(raw[start + 1 : start + 1 + 3 * width])
        for i in range(3 * width):
            a, b, c = line[i - 3] if i > 2 else 0, before[i], before[i - 3] if i > 2 else 0
            near = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            line[i] = (line[i] + (0, a, b, (a + b) // 2, near)[filtered]) & 255
        rows.append([tuple(line[3 * x : 3 * x + 3]) for x in range(width)])
        before = line
    return rows


def judge(program, folder, pair, samples):
    scene, env, words = pair
    scene, env = (text if text.startswith("builtin:") else str(DATA / below / text) for text, below in ((scene, ""), (env, "env")))
    common = [program, "render", scene, "--env", env, "--size", SIZE, "--no-background", "-q", *words.split()]
    run = lambda *more: subprocess.run(more, check=True, capture_output=True, text=True).stdout
    if not (folder / "reference.exr").exists():
        drop = {"--technique": 2, "--samples": 2}
        kept, skip = [], 0
        for word in common:
            skip = drop.get(word, skip)
            if not skip:
                kept.append(word)
            skip = max(0, skip - 1)
        run(*kept, "--backend", "reference", "--samples", str(samples), "-o", str(folder / "reference.pfm"))
        run(*common, "-o", str(folder / "test.pfm"), "-o", str(folder / "test.png"))
        for kind in ("pfm", "png"):
            run(program, "compare", str(folder / "reference.pfm"), str(folder / "test.pfm"), "-q", "--error-map", str(folder / f"flip.{kind}"))
        (folder / "reference.exr").touch()
    words = run(*[w for w in common if w != "-q"], "--risks", str(folder / "risks.png"))
    flip, marks = floats(folder / "flip.pfm"), colours(folder / "risks.png")
    n = dict.fromkeys(("shaded", "marked", "far", "far_marked", "near_marked"), 0)
    for row, seen in zip(flip, marks):
        for e, (r, g, b) in zip(row, seen):
            shaded, marked = r + g + b > 0, not (r == g == b)
            n["shaded"] += shaded
            n["marked"] += marked
            n["far"] += shaded and e > FAR
            n["far_marked"] += marked and e > FAR
            n["near_marked"] += marked and e > NEAR
    return n, words


TIMED = "builtin:spheres --size 1280x720 --msaa 8 --threads 1 -q"


def cpu_ms(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return 1e3 * (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def take_times(program, count):
    """Medians of differences between neighbours, and the middle half of them."""
    ways = {"plain": (), "risks": ("--risks", "-"), "five": ("--frames", "5")}
    common = [program, "render", *TIMED.split()]
    subprocess.run([*common, *ways["risks"]], check=True, capture_output=True) # bakes
    rounds = [{name: cpu_ms([*common, *words]) for name, words in ways.items()} for _ in range(count)]
    cost, frame = ([(r[a] - r["plain"]) / n for r in rounds] for a, n in (("risks", 1), ("five", 4)))
    low, high = statistics.quantiles(cost, n=4)[::2] if count > 1 else 2 * cost
    print(f"{TIMED}: frame {statistics.median(frame):.1f} ms, --risks {statistics.median(cost):.1f} ({low:.1f} to {high:.1f}), "
          f"{100 * statistics.median(cost) / statistics.median(frame):.1f} % of it; {count} rounds")


def rounds_of(text):
    count = int(text)
    if count < 1:
        raise argparse.ArgumentTypeError("one round at least")
    return count


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--set", action="store_true", help="the pairs that constants were chosen by")
    parser.add_argument("--keep", help="folder of the pictures; references are found there again")
    parser.add_argument("--samples", type=int, default=1024)
    parser.add_argument("--time", type=rounds_of, metavar="N", help="rounds; quartiles want four")
    args = parser.parse_args()
    if args.time:
        return take_times(args.program, args.time)
    share = lambda a, b: f"{100 * a / b:3.0f} %" if b else "  -  "
    total = {}
    with tempfile.TemporaryDirectory() as scratch:
        for i, pair in enumerate(SET if args.set else JUDGED):
            folder = pathlib.Path(args.keep or scratch) / f"{'set' if args.set else 'judged'}{i:02d}"
            folder.mkdir(parents=True, exist_ok=True)
            n, words = judge(args.program, folder, pair, args.samples)
            for k, v in n.items():
                total[k] = total.get(k, 0) + v
            print(f"| {pathlib.Path(pair[0]).stem} | {pathlib.Path(pair[1]).stem} | {pair[2]} | {share(n['marked'], n['shaded'])} |"
                  f" {share(n['far'], n['shaded'])} | {share(n['far_marked'], n['far'])} | {share(n['near_marked'], n['marked'])} |", flush=True)
            (folder / "risks.txt").write_text(words)
    n = total
    print(f"| all | | | {share(n['marked'], n['shaded'])} | {share(n['far'], n['shaded'])} | {share(n['far_marked'], n['far'])} |"
          f" {share(n['near_marked'], n['marked'])} |")


if __name__ == "__main__":
    sys.exit(main())
