#!/usr/bin/env python3
"""Mip filters as tables: means of `burnish chart --mip` by set, the gap to the search that each closes, and the MIPNet paper's Table 1 rebuilt.

Usage: mip_table.py --program build/release/burnish [--textures FOLDER] [--brdf NAMES] [--report FOLDER] [--work FOLDER] [--json FILE]

--report takes the figures of a chart that was made before, in place of making one. Cells are FLIP, L1 and MSE times 1000, in bold the least
but for the search's; then percents of L1's way from plain means to the search; then changes to plain means, as published and here, with
mean radiance of levels off by |found / reference - 1|, in the mean and at most. The CPU seconds that the chart took come last.

Exit code: 0; 2 something could not be run.
"""

import json
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
from workbench import Program, arguments, in_folder  # noqa: E402

METRICS = ("flip", "l1", "mse")
# Gauthier et al. 2022, Table 1: changes against plain means in percent (FLIP, L1, MSE) over the hundred hardest
# materials
PUBLISHED = {("ggx_aniso", "ssgt"): (9.4, 15.0, 7.3), ("ggx_aniso", "mipnet"): (-3.7, -4.0, -20.2), ("beckmann", "leadr"): (105.0, 141.5, 204.4),
             ("beckmann", "mipnet"): (-4.2, -6.4, -27.9), ("ashikhmin_shirley", "mipnet"): (-2.9, -4.4, -17.3)}


def means(rows):
    """By filter: means of the metrics times 1000, and how far mean radiance is off."""
    of = {}
    for name in dict.fromkeys(row["mip_filter"] for row in rows):
        own = [row for row in rows if row["mip_filter"] == name]
        of[name] = {m: 1e3 * sum(v) / len(v) for m in METRICS for v in [[row[m] for row in own if row[m] is not None]]}
        light = [abs(row["light"] - 1) for row in own]
        of[name] |= {"light": sum(light) / len(light), "worst": max(light)}
    return of


def sets_of(rows):
    """Name and rows, of each model."""
    for brdf in dict.fromkeys(row["brdf"] for row in rows):
        of = [row for row in rows if row["brdf"] == brdf]
        for name in dict.fromkeys(row["set"] for row in of):
            own = [row for row in of if row["set"] == name]
            yield brdf, name, own
            yield brdf, name + ", hardest quarter", [row for row in own if row["hardest"]]


def print_tables(rows):
    filters = list(dict.fromkeys(row["mip_filter"] for row in rows))
    print("| model, set | " + " | ".join(filters) + " |\n|" + " --- |" * (len(filters) + 1))
    found = {(brdf, name): means(own) for brdf, name, own in sets_of(rows)}
    for (brdf, name), of in found.items():
        least = {m: min(of[f][m] for f in filters if f != "teacher") for m in METRICS}
        cell = lambda f: " ".join(("**{:.{}f}**" if f != "teacher" and of[f][m] == least[m] else "{:.{}f}").format(of[f][m], 1 if m == "flip" else 2)
                                  for m in METRICS)
        print(f"| {brdf}, {name} | " + " | ".join(cell(f) for f in filters) + " |")
    others = [f for f in filters if f not in ("baseline", "teacher")]
    print("\n| model, set | " + " | ".join(others) + " |\n|" + " --- |" * (len(others) + 1))
    for (brdf, name), of in found.items():
        gap = of["baseline"]["l1"] - of["teacher"]["l1"]
        print(f"| {brdf}, {name} | " + " | ".join(f"{100 * (of['baseline']['l1'] - of[f]['l1']) / gap:.0f}" for f in others) + " |")
    print("\n| model | method | paper | held-out | its hardest quarter | real | radiance off, held-out | real |\n|" + " --- |" * 8)
    for (brdf, name), published in PUBLISHED.items():
        cells = ["{:+.1f} {:+.1f} {:+.1f} %".format(*published)]
        for part in ("held-out", "held-out, hardest quarter", "real"):
            of = found.get((brdf, part))
            cells.append(" ".join(f"{100 * (of[name][m] / of['baseline'][m] - 1):+.1f}" for m in METRICS) + " %" if of else "")
        for part in ("held-out", "real"):
            of = found.get((brdf, part))
            cells.append(f"{of[name]['light']:.3f}, {of[name]['worst']:.2f}" if of else "")
        if any(cells[1:]):
            print(f"| {brdf} | {name} | " + " | ".join(cells) + " |")


def measure(options, work):
    report, seconds = pathlib.Path(options.report).resolve() if options.report else work / "report", 0.0
    if not options.report:
        words = ["--maps", pathlib.Path(options.textures).resolve()] if options.textures else []
        brdfs = options.brdf.split(",") if options.brdf else ["ggx_aniso", "beckmann", "ashikhmin_shirley"]
        rows = []
        for brdf in brdfs:
            seconds += Program(options, work).timed("chart", "--mip", *words, "--brdf", brdf, "-q", "-o", report)
            rows += json.loads((report / "mip.json").read_text())
    else:
        rows = json.loads((report / "mip.json").read_text())
    print_tables(rows)
    if seconds:
        print(f"\n{len({(row['set'], row['material']) for row in rows})} materials, {seconds:.0f} CPU seconds")
    if options.json:
        pathlib.Path(options.json).write_text(json.dumps(rows, indent=1) + "\n")
    return 0


def main():
    parser = arguments(__doc__)
    parser.add_argument("--textures")
    parser.add_argument("--brdf", default="")
    parser.add_argument("--report")
    return in_folder(parser.parse_args(), measure)


if __name__ == "__main__":
    sys.exit(main())
