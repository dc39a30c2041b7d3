#!/usr/bin/env python3
"""Draws the artefacts of tables of transformed cosines that are fitted and held as others do it: a page of pictures and FLIP.

Usage: area_artefacts.py --program build/release/burnish -o FOLDER [--size WxH] [--resolution N]

A brushed ball under strips, by the program's own table and by one for each artefact of KT, Heitz, Dupuy, Narayanan 2022, figure 3, beside
samples of the lights. Tables that lie in FOLDER are not made again. FOLDER/index.html shows the pictures and FLIP's maps; printed is a line a
table: mean and greatest FLIP, and the greatest step between neighbouring pixels of the ball, in radiance over the samples' step.

Exit code: 0 the program's own table is the nearest; 1 it is not; 2 something could not be run.
"""

import argparse
import array
import html
import json
import pathlib
import subprocess
import sys

TABLES = (("own", "the program's own table", None),
          ("entry", "broken entries: third power of the difference", ("--fit", "l3", "--interpolate", "matrix")),
          ("interpolation", "ill-defined interpolation: matrices not aligned", ("--no-align", "--interpolate", "matrix")),
          ("symmetry", "broken symmetry: every node by itself", ("--no-symmetry", "--interpolate", "matrix")),
          ("inversion", "early inversion: inverse matrices interpolated", ("--interpolate", "inverse")))
SCENE = ("builtin:sphere", "--env", "builtin:night", "--env-exposure", "-20", "--env-size", "16", "--env-samples", "4", "--roughness", "0.55",
         "--anisotropy", "0.85", "--f0", "1,1,1", "--msaa", "4", "--technique", "mc", "--samples", "1", "--no-background",
         "--light", "quad:points=-1.6,1.2,2.2/-1.2,1.2,2.2/-1.2,-1.2,2.2/-1.6,-1.2,2.2:radiance=6,6,6:two-sided",
         "--light", "quad:points=0.3,2.0,-1/0.7,2.0,-1/0.7,2.0,1.5/0.3,2.0,1.5:radiance=6,5,4:two-sided")


def run(program, *words):
    done = subprocess.run([str(w) for w in (program, *words)], capture_output=True, text=True)
    if done.returncode:
        print(f"{' '.join(map(str, words))}: {done.stderr.strip()}", file=sys.stderr)
        sys.exit(2)
    return done.stdout


def greatest_step(path, other):
    """Returns the greatest step between neighbours along rows and columns, in the green that the picture has more than `other`."""
    def read(p):
        kind, size, scale, rest = p.read_bytes().split(b"\n", 3)
        values = array.array("f")
        values.frombytes(rest)
        return list(map(int, size.split())), values
    (width, height), a = read(path)
    _, b = read(other)
    d = [a[3 * i + 1] - b[3 * i + 1] for i in range(width * height)]
    most = 0.0
    for y in range(height):
        for x in range(width):
            i = y * width + x
            if x + 1 < width:
                most = max(most, abs(d[i + 1] - d[i]))
            if y + 1 < height:
                most = max(most, abs(d[i + width] - d[i]))
    return most


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("-o", "--output", required=True, type=pathlib.Path)
    parser.add_argument("--size", default="240x240")
    parser.add_argument("--resolution", default="8")
    a = parser.parse_args()
    a.output.mkdir(parents=True, exist_ok=True)
    words = ("render", *SCENE, "--size", a.size, "-q")
    draw = lambda name, *more: [run(a.program, *words, *more, "-o", a.output / f"{name}.{kind}") for kind in ("png", "pfm")]
    draw("samples", "--area-lights", "mc", "--light-samples", "1024")
    rows, found = [], {}
    for name, text, options in TABLES:
        table = a.output / f"{name}.ltc"
        if options and not table.exists():
            run(a.program, "bake", "ltc", "--resolution", a.resolution, *options, "-o", table, "-q")
        draw(name, *(("--ltc-table", table) if options else ()))
        said = json.loads(run(a.program, "compare", a.output / "samples.png", a.output / f"{name}.png", "--error-map", a.output / f"{name}.flip.png",
                              "--json", "-", "-q"))
        flip = {key: said[f'flip_{key}'] for key in ('mean', 'max')}
        found[name] = flip["mean"]
        step = greatest_step(a.output / f"{name}.pfm", a.output / "samples.pfm")
        line = f"FLIP {flip['mean']:.4f}, at most {flip['max']:.3f}; greatest step {step:.3f}"
        print(f"{name:14} {line}")
        rows.append(f"<tr><td><img src='{name}.png'></td><td><img src='{name}.flip.png'></td><td><b>{html.escape(text)}</b><br>"
                    f"<code>{html.escape(' '.join(options or ()))}</code><br>{line}</td></tr>")
    (a.output / "index.html").write_text("<!doctype html><meta charset=utf-8><title>Tables of transformed cosines</title><style>body{font:15px "
                                         "sans-serif;background:#fff}td{padding:6px;vertical-align:top}</style><h1>Tables of transformed cosines"
                                         "</h1><p>A brushed ball under two strips; the lights by 1024 samples:<p><img src='samples.png'><table>"
                                         + "".join(rows) + "</table>\n")
    sys.exit(0 if min(found, key=found.get) == "own" else 1)


if __name__ == "__main__":
    main()
