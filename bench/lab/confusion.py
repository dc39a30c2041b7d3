#!/usr/bin/env python3
"""A table of which mistakes `burnish conform` takes for which.

Usage: confusion.py --program build/release/burnish [--work FOLDER] [--mistakes NAME,...]

Draws the scenes of a conformance folder with one mistake at a time, and lets `conform` judge the pictures. Prints a table in Markdown: a row
for each mistake that was made, a column for each one that was found. A cell is the share of the wrong pictures whose nearest mistake is the
column's, in percent; the last column lists the mistakes that the report names. With --work, finished rows are read again. Exit code: 0 measured; 2 something
could not be run.
"""

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

MISTAKES = ("anisotropy_ignored", "rotation_clockwise", "rotation_in_degrees", "axes_swapped", "handedness_ignored", "bend_factor", "no_bend", "no_specular_image",
            "strength_squared_twice", "alpha_is_roughness", "direction_map_srgb", "directions_averaged", "directions_unnormalised", "normal_map_ignored", "geometric_normals", "no_fresnel",
            "no_energy_share", "sky_mirrored_x", "sky_mirrored_y", "sky_mirrored_z", "exposure", "tonemapped_neutral", "upside_down", "field_of_view")


def run(program, *words, codes=(0,)):
    done = subprocess.run([program, *map(str, words)], capture_output=True, text=True)
    if done.returncode not in codes:
        raise SystemExit(f"confusion.py: {' '.join(map(str, words))}: {done.stderr.strip()}")
    return done.stdout


def row_of(program, folder, work, mistake):
    """Returns {found mistake: share of the wrong pictures}, and the names that the report gives."""
    kept = work / f"{mistake}.json"
    if not kept.exists():
        pictures = work / mistake
        run(program, "conform", folder, pictures, "--draw", "--mistake", mistake, "--quiet")
        kept.write_text(run(program, "conform", folder, pictures, "--json", "-", "--quiet", codes=(0, 1)))
    result = json.loads(kept.read_text())
    wrong = [s for s in result["scenes"] if s["outcome"] == "wrong"]
    shares = {}
    for scene in wrong:
        shares[scene["nearest"]] = shares.get(scene["nearest"], 0) + 100 / len(wrong)
    return shares, len(wrong), [m["name"] for m in result["mistakes"]]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("--mistakes", default=",".join(MISTAKES))
    given = parser.parse_args()
    temporary = tempfile.TemporaryDirectory()
    work = given.work or pathlib.Path(temporary.name)
    work.mkdir(exist_ok=True)
    folder = work / "folder"
    if not (folder / "conform.json").exists():
        run(given.program, "conform", "--write", folder, "--quiet")
    names = given.mistakes.split(",")
    print("| made | wrong pictures |" + "".join(f" {i + 1} |" for i in range(len(names))) + " another | named |")
    print("|" + " --- |" * (len(names) + 4))
    for i, name in enumerate(names):
        shares, wrong, named = row_of(given.program, folder, work, name)
        cells = [f" {shares.get(n, 0):.0f} |" if shares.get(n, 0) else "  |" for n in names]
        other = sum(share for n, share in shares.items() if n not in names)
        print(f"| {i + 1} `{name}` | {wrong} |" + "".join(cells) + (f" {other:.0f} |" if other else "  |") + f" {', '.join(named) or '-'} |", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
