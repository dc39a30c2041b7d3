#!/usr/bin/env python3
"""Holds apps/plan/costs.def to counted instructions: each setting on two brushed spheres, each method for area lights under one quad and
under four. They are at most 3 % dearer than the table says.

Usage: plan_costs.py --program build/release/bench_instructions [--scale FACTOR]

The eye is near a sphere's centre, so that every pixel sees its lobe from above. --scale multiplies the table's costs, to see the check fail.
A table that is too cheap lets plans exceed their budgets. One that is too dear is a note: plans then spend less than they may.
Settings with more than 512 samples, and methods with more than 64 on each light, are left out: their costs are lines through the others.
Exit code 1: a cost is too cheap; 77: skipped, as
count.py is.
"""

import argparse
import math
import pathlib
import re
import sys

import count

DARK = "area-lights:ltc:1:0"  # the same picture without quads
ROOT = pathlib.Path(__file__).resolve().parents[2]
PIXELS = 160 * 90
LOBES = ((0.5, 0.8), (0.3, 0.5))  # roughness, eta
THIRD = 0.33333334  # in floats: a third of 9 samples is more than 3
MOST_SAMPLES = 512
MOST_LIGHT_SAMPLES = 64
QUADS = (1, 4)


def settings():
    """[(technique, samples, count, fixed, sample)]"""
    text = (ROOT / "apps/plan/costs.def").read_text()
    rows = re.findall(r"^BN_PLAN_SETTING\((\w+), (\d+), (\w+), ([\d.]+), ([\d.]+)\)", text, re.M)
    return [(technique, int(samples), kind, float(fixed), float(sample)) for technique, samples, kind, fixed, sample in rows]


def area_methods():
    """[(method as FrameDesc::area_way names it, samples, fixed, quad, sample)]"""
    text = (ROOT / "apps/plan/costs.def").read_text()
    rows = re.findall(r"^BN_PLAN_AREA_LIGHTS\((\w+), (\d+), ([\d.]+), ([\d.]+), ([\d.]+)\)", text, re.M)
    return [(way.replace("_", "-"), int(samples), float(fixed), float(quad), float(sample)) for way, samples, fixed, quad, sample in rows]


def line_samples(samples, eta):
    """Samples of lobe_line on a lobe seen from above, as line_samples() of apps/plan/cost.cpp."""
    shared = float(re.search(r"#define kLineSamplesShared ([\d.]+)", (ROOT / "shading/techniques/lobe_line.k.h").read_text())[1])
    ratio = (1 - eta) / (1 + eta)
    every = samples - (samples % 2 == 0)
    most = max(every * min(max(1 / (18 * ratio), THIRD), 2 / 3), min(every, 3))
    wanted = min(1 + shared * math.sqrt(1 / ratio**2 - 1), most)
    return 1 + 2 * math.ceil((wanted - 1) / 2)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--scale", type=float, default=1.0)
    options = parser.parse_args()
    rows = [row for row in settings() if row[1] <= MOST_SAMPLES]
    place = lambda row, lobe: f"{row[0]}:{row[1]}:{lobe[0]}:{lobe[1]}"
    methods = [row for row in area_methods() if row[1] <= MOST_LIGHT_SAMPLES]
    lit = lambda row, quads: f"area-lights:{row[0]}:{row[1]}:{quads}"
    try:
        count.made_with(options.program)  # skips without valgrind
        counts = count.count(options.program, *(place(row, lobe) for row in rows for lobe in LOBES))
        under = count.count(options.program, DARK, *(lit(row, quads) for row in methods for quads in QUADS))
    except count.Skip as reason:
        print("skipped:", reason)
        return count.SKIPPED
    faults = 0

    def hold(name, wanted, counted):
        nonlocal faults
        off = options.scale * wanted / counted - 1
        verdict = " is too cheap" if off < -count.TOLERANCE else " is dearer than counted: lower it" if off > count.TOLERANCE else ""
        faults += off < -count.TOLERANCE
        print(f"{name:<32} {counted:>9.1f} {options.scale * wanted:>9.1f} {100 * off:>+7.2f}%{verdict}")

    for row in rows:
        for lobe in LOBES:
            technique, samples, kind, fixed, sample = row
            hold(place(row, lobe), fixed + sample * (samples if kind == "all" else line_samples(samples, lobe[1])), counts[place(row, lobe)] / PIXELS)
    for row in methods:
        for quads in QUADS:
            way, samples, fixed, quad, sample = row
            hold(lit(row, quads), fixed + (quad + sample * samples) * quads, (under[lit(row, quads)] - under[DARK]) / PIXELS)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
