#!/usr/bin/env python3
"""Charts a frame's time by the amount that is drawn, and measures how far each chart is from a straight line.

Usage: growth.py --program build/release/bench_frame -o growth.svg [--isa NAME] [--rounds N] [--json figures.json]
       growth.py --from figures.json -o growth.svg [--fail-bend PERCENT]

Runs the rows growth_* of bench_frame, or reads its --json file: workloads that differ in one number. Through the medians of CPU time
a line is laid that makes the greatest relative distance least; `bend` is that distance, in percent. Of threads it is wall time times threads,
and the line is level: threads that divide the work, each on a core, need no more of it together. Their row ends with the machine's cores.
Exit code: 0; 1 a row bends more than --fail-bend; 2 something could not be run or read.
"""

import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
import xml.sax.saxutils

LABELS = {"growth_triangles": "triangles", "growth_pixels": "pixels", "growth_textures": "textures of a material",
          "growth_lights": "lights without end", "growth_far_lights": "lights, of which 4 reach a point", "growth_materials": "materials",
          "growth_layers": "layers back to front", "growth_samples": "samples of major_axis_weighted", "growth_mc_samples": "samples of mc",
          "growth_threads": "threads: wall time x threads"}
COLUMNS, WIDTH, HEIGHT, LEFT, TOP, RIGHT, BOTTOM = 3, 330, 250, 62, 44, 14, 40


class Unusable(Exception):
    pass


def run(options):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "figures.json")
        command = [options.program, "--only", "growth", "--rounds", str(options.rounds), "--json", path]
        done = subprocess.run(command + (["--isa", options.isa] if options.isa else []), stdout=subprocess.PIPE, text=True, check=False)
        if done.returncode != 0:
            raise Unusable(f"{options.program} ended with {done.returncode}")
        with open(path, encoding="utf-8") as file:
            return file.read()


def rows_of(text):
    """(heading, {row: [(number, ms)...]}) of bench_frame's JSON."""
    rows = {}
    try:
        figures = json.loads(text)
        machine, threads = figures["machine"], int(figures["threads"])
        isas = list(dict.fromkeys(w["isa"] for w in figures["workloads"]))
        for w in figures["workloads"]:
            if w["group"].startswith("growth_") and w["isa"] == isas[0]:
                number, by_threads = float(w["along"]), w["group"] == "growth_threads"
                if by_threads and number > machine["cores"]:
                    continue
                ms = w["wall_ms"]["median"] * number if by_threads else w["cpu_ms"]["median"]
                rows.setdefault(w["group"], []).append((number, float(ms)))
        quiet = "" if figures["headline"] else "; the machine was busy"
        heading = f"{machine['processor']}, {isas[0]}, {threads} threads, version {machine['version']}{quiet}"
    except (ValueError, KeyError, IndexError, TypeError) as error:
        raise Unusable(f"not what bench_frame writes: {error!r}") from error
    if not rows:
        raise Unusable("no row growth_* is in it")
    return heading, {row: sorted(points) for row, points in rows.items()}


def level_through(points):
    """As line_through, of slope 0."""
    least, most = min(y for _, y in points), max(y for _, y in points)
    return 2.0 * least * most / (least + most), 0.0, 100.0 * (most - least) / (most + least)


def line_of(row, points):
    return level_through(points) if row == "growth_threads" else line_through(points)


def line_through(points):
    """(at 0, slope, bend in percent) of the line with the least greatest relative distance. One of three points decides it, as among straight
    lines that are as far above two of them as below the third the farthest is the nearest to all."""
    if len(points) == 1:
        return points[0][1], 0.0, 0.0
    best = (0.0, 0.0, math.inf)

    def bend_of(start, slope):
        return max(abs(start + slope * x - y) / y for x, y in points)

    for i, a in enumerate(points):
        for j, b in enumerate(points[i + 1:], i + 1):
            if len(points) == 2:
                slope = (b[1] - a[1]) / (b[0] - a[0])
                return a[1] - slope * a[0], slope, 0.0
            for c in points[j + 1:]:
                # start + slope x = y (1 +- e): a and c on one side, b on the other
                matrix = [[1.0, x, -sign * y] for (x, y), sign in ((a, 1), (b, -1), (c, 1))]
                solved = solve(matrix, [a[1], b[1], c[1]])
                if solved:
                    bend = bend_of(solved[0], solved[1])
                    if bend < best[2]:
                        best = (solved[0], solved[1], bend)
    return best[0], best[1], 100.0 * best[2]


def solve(m, right):
    """Three equations by Cramer's rule; None where they are not independent."""
    def determinant(a):
        return (a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0])
                + a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]))

    whole = determinant(m)
    if whole == 0.0:
        return None
    return [determinant([[right[r] if c == k else m[r][c] for c in range(3)] for r in range(3)]) / whole for k in range(3)]


def unit_of(slope, row):
    ns = slope * 1e6
    return f"{ns:.3g} ns" if row in ("growth_triangles", "growth_pixels") else f"{slope:.3g} ms"


def table(rows):
    lines = [f"{'row':<34} {'at 0':>9} {'each more':>11} {'bend':>7}"]
    for row, points in rows.items():
        start, slope, bend = line_of(row, points)
        lines.append(f"{LABELS.get(row, row):<34} {start:>6.2f} ms {unit_of(slope, row):>11} {bend:>5.1f} %")
    return "\n".join(lines)


def chart(heading, rows):
    """Returns the SVG text: a panel a row, both axes linear and from 0, the line and the measured times."""
    height = HEIGHT * -(-len(rows) // COLUMNS) + 50
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {COLUMNS * WIDTH} {height}" width="{COLUMNS * WIDTH}" height="{height}" '
           'role="img" aria-label="Time of a frame by what is drawn">',
           "<style>svg { background: #fff; font: 12px system-ui, 'DejaVu Sans', sans-serif; } text { fill: #1c1c1c; } .soft { fill: #5f5f5f; } "
           ".grid { stroke: #e3e3e3; } .head { font-weight: 600; font-size: 14px; }</style>"]

    def text(x, y, words, **attributes):
        more = "".join(f' {key.rstrip("_").replace("_", "-")}="{value}"' for key, value in attributes.items())
        out.append(f'<text x="{x:.1f}" y="{y:.1f}"{more}>{xml.sax.saxutils.escape(words)}</text>')

    text(LEFT, 22, "CPU time of a frame, ms, by what is drawn", class_="head")
    text(LEFT, 40, heading, class_="soft")
    for place, (row, points) in enumerate(rows.items()):
        x0, y0 = WIDTH * (place % COLUMNS), 50 + HEIGHT * (place // COLUMNS)
        left, right, top, bottom = x0 + LEFT, x0 + WIDTH - RIGHT, y0 + TOP, y0 + HEIGHT - BOTTOM
        start, slope, bend = line_of(row, points)
        most_x = points[-1][0]
        most_y = 1.08 * max(start + slope * most_x, *(y for _, y in points))
        for part in (0.0, 0.5, 1.0):
            y = bottom + (top - bottom) * part
            out.append(f'<line x1="{left}" x2="{right}" y1="{y:.1f}" y2="{y:.1f}" class="grid"/>')
            text(left - 6, y + 4, f"{most_y * part:,.{1 if most_y < 100.0 else 0}f}", text_anchor="end", class_="soft")
            text(left + (right - left) * part, bottom + 17, f"{most_x * part:,.{1 if most_x * part % 1.0 else 0}f}", text_anchor="end" if part == 1.0 else "middle", class_="soft")
        text(left, top - 22, LABELS.get(row, row))
        text(left, top - 7, f"{start:.2f} ms + {unit_of(slope, row)} each, bend {bend:.1f} %", class_="soft")

        def at(x, y):
            return f"{left + (right - left) * x / most_x:.1f},{bottom + (top - bottom) * y / most_y:.1f}"

        out.append(f'<polyline class="line" points="{at(0, start)} {at(most_x, start + slope * most_x)}" stroke="#c64f00" fill="none"/>')
        for x, y in points:
            cx, cy = at(x, y).split(",")
            out.append(f'<circle class="measured" cx="{cx}" cy="{cy}" r="4" fill="#0067a8"/>')
    out.append("</svg>")
    return "\n".join(out) + "\n"


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--program", metavar="BENCH_FRAME")
    source.add_argument("--from", dest="file", metavar="JSON")
    parser.add_argument("-o", "--output", required=True, metavar="SVG")
    parser.add_argument("--isa", help="instruction set; the best one without")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--json", metavar="FILE", help="keep what was measured")
    parser.add_argument("--fail-bend", type=float, metavar="PERCENT")
    options = parser.parse_args(arguments)
    try:
        if options.file:
            with open(options.file, encoding="utf-8") as file:
                text = file.read()
        else:
            text = run(options)
        heading, rows = rows_of(text)
        if options.json:
            with open(options.json, "w", encoding="utf-8") as file:
                file.write(text)
        with open(options.output, "w", encoding="utf-8") as file:
            file.write(chart(heading, rows))
    except (Unusable, OSError) as error:
        print(f"growth: {error}", file=sys.stderr)
        return 2
    print(table(rows))
    bent = [row for row, points in rows.items() if options.fail_bend is not None and line_of(row, points)[2] > options.fail_bend]
    if bent:
        print(f"growth: no straight line: {', '.join(bent)}", file=sys.stderr)
    return 1 if bent else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
