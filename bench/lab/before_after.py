#!/usr/bin/env python3
"""Default pictures of two programs beside their references: a page to look at, and a table of errors, patterns and time.

Usage: before_after.py --before PROGRAM --program build/release/burnish -o FOLDER [--models FOLDER] [--environment FILE] [--size 960x540]
                       [--samples N]

Draws built-in scenes, and the glTF models of the folder, with default options. Scenes changed between programs, so each picture is compared
with a reference by its own program (light without bounces, as techniques have it), and with the newer program's `compare`. FOLDER gets
index.html, with every picture at full size and the worst place of the newer one enlarged four times, and table.md. Files that exist are not made
again. Times are medians of five frames on all cores, and need a quiet machine. Exit code: 0 made; 2 something could not be run.
"""

import argparse
import array
import json
import pathlib
import subprocess
import sys

BUILTINS = ("teapot", "spheres", "sphere", "plate", "lights", "glass", "bumps", "lacquer", "shaderballs")
MODELS = ("FlightHelmet/FlightHelmet.gltf", "AnisotropyBarnLamp.glb", "AnisotropyStrengthTest.glb", "ClearCoatTest.glb", "chess-board.glb",
          "NormalTangentTest.glb")
FRAMES = 5
ZOOM, WINDOW = 4, 120  # times, pixels of the picture


def run(*words, may_fail=False):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    if done.returncode and not may_fail:
        print(f"{' '.join(map(str, words))}: {done.stderr.strip()}", file=sys.stderr)
        sys.exit(2)
    return done


def draw(program, folder, name, words, samples):
    """Draws a program's picture and reference. Returns the frame's milliseconds, or None where the program cannot draw the scene."""
    stats = folder / f"{name}.json"
    if not stats.exists():
        done = run(program, "render", *words, "-q", "-o", folder / f"{name}.png", "-o", folder / f"{name}.pfm", "--frames", FRAMES, "--stats", stats, may_fail=True)
        if done.returncode:
            print(f"{name}: {done.stderr.strip()}", file=sys.stderr)
            stats.unlink(missing_ok=True)
            return None
    reference = folder / f"{name}_reference.pfm"
    if not reference.exists():
        run(program, "render", *words, "-q", "--backend", "reference", "--samples", samples, "-o", folder / f"{name}_reference.png", "-o", reference,
            "--variance", folder / f"{name}_variance.pfm")
    figures = json.loads(stats.read_text())
    return figures["ms_median"]


def errors(program, folder, name):
    """Mean FLIP, its 99th percentile, and the pattern figure in percent. Also writes the error map."""
    path = folder / f"{name}_errors.json"
    if not path.exists():
        run(program, "compare", folder / f"{name}_reference.pfm", folder / f"{name}.pfm", "--error-map", folder / f"{name}_error.png", "--json", path, "-q",
            "--variance", folder / f"{name}_variance.pfm", "--metric", "flip-hdr,pattern", may_fail=True)  # the z-test rejects pixels
    found = json.loads(path.read_text())
    pattern = found.get("pattern_rms")
    return found["flip_mean"], found["flip_p99"], None if pattern is None else 100 * pattern


def worst_place(program, folder, name, size):
    """The corner of the window with the largest error, from the error map as floats."""
    width, height = map(int, size.split("x"))
    path = folder / f"{name}_error.pfm"
    run(program, "compare", folder / f"{name}_reference.pfm", folder / f"{name}.pfm", "--error-map", path, "-q")
    kind, shape, _, pixels = path.read_bytes().split(b"\n", 3)
    values, channels = array.array("f", pixels), 3 if kind == b"PF" else 1
    sums = {}
    for y in range(0, height, 4):
        for x in range(0, width, 4):
            at = (min(x // 60, (width - WINDOW) // 60), min(y // 60, (height - WINDOW) // 60))
            sums[at] = sums.get(at, 0) + values[channels * ((height - 1 - y) * width + x)]
    at = max(sums, key=sums.get)
    return 60 * at[0], 60 * at[1]


def page_of(rows, size):
    out = ["<!DOCTYPE html><meta charset=utf-8><title>Before and after</title><style>body{background:#222;color:#ddd;font:14px sans-serif}"
           "img{image-rendering:pixelated}.zoom{display:inline-block;overflow:hidden;position:relative;margin:2px}.zoom img{position:absolute}</style>"]
    width, height = map(int, size.split("x"))
    for name, present, place in rows:
        out.append(f"<h2>{name}</h2>")
        out += [f'<img src="{file}" width="{width}" height="{height}" title="{file}">' for file in present]
        x, y = place
        out.append("<br>" + "".join(
            f'<span class="zoom" style="width:{ZOOM * WINDOW}px;height:{ZOOM * WINDOW}px"><img src="{file}" '
            f'style="left:{-ZOOM * x}px;top:{-ZOOM * y}px;width:{ZOOM * width}px;height:{ZOOM * height}px"></span>' for file in present))
    return "\n".join(out)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--before", required=True)
    parser.add_argument("--program", required=True)
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--models", type=pathlib.Path)
    parser.add_argument("--environment", help="of models; else the built-in studio")
    parser.add_argument("--size", default="960x540")
    parser.add_argument("--samples", default="256")
    given = parser.parse_args()
    given.output.mkdir(parents=True, exist_ok=True)
    scenes = {name: [f"builtin:{name}"] for name in BUILTINS}
    if given.models:
        light = ["--env", given.environment] if given.environment else []
        scenes.update({pathlib.Path(file).stem: [given.models / file, *light] for file in MODELS if (given.models / file).exists()})
    lines = ["| scene | FLIP | p99 | pattern, % | ms a frame |", "| --- | --- | --- | --- | --- |"]
    rows = []
    show = lambda value, digits: "-" if value is None else f"{value:.{digits}f}"
    for scene, words in scenes.items():
        cells, present = [], []
        for when, program in (("before", given.before), ("after", given.program)):
            name = f"{scene}_{when}"
            ms = draw(program, given.output, name, [*words, "--size", given.size], given.samples)
            cells.append((None, None, None, None) if ms is None else (*errors(given.program, given.output, name), ms))
            present += [] if ms is None else [f"{name}.png"]
        present += [f"{scene}_after_reference.png", f"{scene}_after_error.png"]
        rows.append((scene, present, worst_place(given.program, given.output, f"{scene}_after", given.size)))
        lines.append(f"| {scene} | " + " | ".join(f"{show(cells[0][i], d)} to {show(cells[1][i], d)}" for i, d in ((0, 4), (1, 3), (2, 1), (3, 0))) + " |")
        print(lines[-1], flush=True)
        (given.output / "index.html").write_text(page_of(rows, given.size))
        (given.output / "table.md").write_text("\n".join(lines) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
