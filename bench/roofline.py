#!/usr/bin/env python3
"""Measures how close every kernel comes to this machine's limits: a roofline chart, and a table.

Usage: roofline.py --program build/release/bench/micro/bench_micro -o roofline.svg [--json figures.json]
       roofline.py --from figures.json -o roofline.svg

Runs the benchmarks `limit/` and `kernel/` of bench_micro (or reads the JSON that they printed). Limits are measured: multiplications and
additions a second by instruction set, not fused, as kernels may not fuse them; random 16-byte loads a second from memory of the size of the
first, second and third cache. A kernel's operations and bytes a fragment are counted by the same text compiled with counting lanes.
The share of the limit is the larger of two: operations a second over the limit of operations; 16-byte loads a second over the loads of the second
cache, where the levels of the environment lie that rough metal looks at. The rest goes to operations that are not counted: integers,
selections, conversions, shuffles. All of one core and CPU time.
"""

import argparse
import itertools
import json
import math
import re
import subprocess
import sys
import xml.sax.saxutils

COLOURS = ("#5c5c5c", "#0067a8", "#c64f00", "#1f7a3a", "#7a3fa8")  # one for each instruction set, in order
CACHES = {"16": "L1", "512": "L2", "8192": "L3"}
LOAD_BYTES = 16


class Unusable(Exception):
    pass


def run(program):
    command = [program, "--benchmark_filter=^(limit|kernel)/", "--benchmark_format=json", "--benchmark_min_time=0.2", "--benchmark_repetitions=3"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        raise Unusable(f"{program} ended with {done.returncode}: {done.stderr[-500:]}")
    return done.stdout


NANOSECONDS = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}


def figures_of(text):
    """(limits, kernels) of bench_micro's JSON; of repetitions the fastest, which other work on the machine disturbed least."""
    operations, loads, kernels = {}, {}, {}
    try:
        for row in json.loads(text)["benchmarks"]:
            if row.get("run_type", "iteration") != "iteration" or "error_message" in row:
                continue
            part = row["name"].split("/")
            if part[:2] == ["limit", "operations"]:
                operations[part[2]] = max(operations.get(part[2], 0), row["operations"])
            elif part[:2] == ["limit", "random_loads"] and part[3] in CACHES:
                cache = CACHES[part[3]]
                loads[cache] = max(loads.get(cache, 0), row["loads"])
            elif part[0] == "kernel":
                ns = row["cpu_time"] * NANOSECONDS[row["time_unit"]] / row["fragments"]
                key = (part[1], part[2].removeprefix("eta:"), part[3])
                if key not in kernels or ns < kernels[key]["ns"]:
                    kernels[key] = {"ns": ns, "operations": row["operations"], "bytes": row["bytes"]}
    except (ValueError, KeyError, IndexError, TypeError) as error:
        raise Unusable(f"not what bench_micro prints: {error!r}") from error
    if not kernels or "L2" not in loads or any(isa not in operations for _, _, isa in kernels):
        raise Unusable("limits or kernels are missing")
    return {"operations": operations, "loads": loads}, kernels


def share(kernel, isa, limits):
    """Returns (share of the limit of operations, of loads). A share would be 1 if nothing else took time."""
    return (kernel["operations"] / kernel["ns"] * 1e9 / limits["operations"][isa],
            kernel["bytes"] / LOAD_BYTES / kernel["ns"] * 1e9 / limits["loads"]["L2"])


def table(limits, kernels):
    lines = ["limits of one core: " + ", ".join(f"{rate / 1e9:.1f} Gop/s {isa}" for isa, rate in limits["operations"].items()),
             "random 16-byte loads: " + ", ".join(f"{rate / 1e9:.2f} G/s from {cache}" for cache, rate in limits["loads"].items()), "",
             f"{'kernel':<22} {'eta':>4} {'isa':<7} {'ns':>8} {'op':>7} {'bytes':>7} {'op limit':>9} {'load limit':>11}"]
    for (name, eta, isa), kernel in kernels.items():
        operations, loads = share(kernel, isa, limits)
        lines.append(f"{name:<22} {eta:>4} {isa:<7} {kernel['ns']:>8.2f} {kernel['operations']:>7.0f} {kernel['bytes']:>7.0f} {100 * operations:>7.1f} % "
                     f"{100 * loads:>9.1f} %")
    return "\n".join(lines)


HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 620, 70, 740, 50, 560  # edges of the plot; names and columns are on its right
NAMES, COLUMN = 260, 90


def chart(limits, kernels):
    """The SVG text: operations a byte against operations a second, both logarithmic, one colour an instruction set."""
    intensity = {key: kernel["operations"] / kernel["bytes"] for key, kernel in kernels.items()}
    rate = {key: kernel["operations"] / kernel["ns"] for key, kernel in kernels.items()}  # Gop/s
    ceilings = {isa: value / 1e9 for isa, value in limits["operations"].items() if any(key[2] == isa for key in kernels)}
    colours = dict(zip(ceilings, itertools.cycle(COLOURS)))
    width = RIGHT + NAMES - COLUMN // 2 + COLUMN * len(ceilings) + 25
    x_low, x_high = min(0.5, min(intensity.values()) / 1.5), max(16.0, max(intensity.values()) * 1.5)
    y_low, y_high = min(rate.values()) / 1.6, max(*ceilings.values(), *rate.values()) * 1.6

    def x_of(value):
        return LEFT + (RIGHT - LEFT) * math.log(value / x_low) / math.log(x_high / x_low)

    def y_of(value):
        return BOTTOM - (BOTTOM - TOP) * math.log(value / y_low) / math.log(y_high / y_low)

    out = []

    def element(name, text=None, **attributes):
        shown = "".join(f' {key.rstrip("_").replace("_", "-")}="{value:.1f}"' if isinstance(value, float) else
                        f' {key.rstrip("_").replace("_", "-")}={xml.sax.saxutils.quoteattr(str(value))}' for key, value in attributes.items())
        out.append(f"<{name}{shown}/>" if text is None else f"<{name}{shown}>{xml.sax.saxutils.escape(text)}</{name}>")

    out.append(f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {HEIGHT}" width="{width}" height="{HEIGHT}" role="img" '
               'aria-label="Roofline of the kernels">')
    out.append("<style>svg { background: #fff; font: 12px system-ui, 'DejaVu Sans', sans-serif; } text { fill: #1c1c1c; } .soft { fill: #5f5f5f; } "
               ".grid { stroke: #e3e3e3; } .head { font-weight: 600; font-size: 14px; }</style>")
    element("text", "Kernels against the limits of one core, measured", x=LEFT, y=25, class_="head")
    for tick in [2.0**k for k in range(-1, 8)]:
        if x_low <= tick <= x_high:
            element("line", x1=x_of(tick), x2=x_of(tick), y1=TOP, y2=BOTTOM, class_="grid")
            element("text", f"{tick:g}", x=x_of(tick), y=BOTTOM + 18, text_anchor="middle", class_="soft")
    for tick in [2.0**k for k in range(-4, 12)]:
        if y_low <= tick <= y_high:
            element("line", x1=LEFT, x2=RIGHT, y1=y_of(tick), y2=y_of(tick), class_="grid")
            element("text", f"{tick:g}", x=LEFT - 8, y=y_of(tick) + 4, text_anchor="end", class_="soft")
    element("text", "operations a byte fetched", x=(LEFT + RIGHT) / 2, y=BOTTOM + 40, text_anchor="middle")
    element("text", "Gop/s", x=LEFT - 40, y=TOP - 12)
    label = -math.inf
    for isa, ceiling in sorted(ceilings.items(), key=lambda item: -item[1]):
        element("line", x1=LEFT, x2=RIGHT, y1=y_of(ceiling), y2=y_of(ceiling), stroke=colours[isa], stroke_width=2, class_="ceiling")
        above = y_of(ceiling) - 6
        label = above if above - label >= 16 else label + 22  # nearly equal ceilings put their names below each other
        element("text", f"{isa}: {ceiling:.0f} Gop/s, not fused", x=RIGHT - 4, y=label, text_anchor="end",
                style=f"fill: {colours[isa]}")
    for cache, loads in limits["loads"].items():
        slope = loads * LOAD_BYTES / 1e9
        first, last = max(x_low, y_low / slope), min(x_high, y_high / slope)
        if first >= last:
            continue
        element("line", x1=x_of(first), x2=x_of(last), y1=y_of(slope * first), y2=y_of(slope * last), stroke="#5f5f5f", stroke_dasharray="5 4",
                class_="slope")
        at = first * (last / first) ** (0.06 if first > x_low else 0.03)
        element("text", f"{cache}: {loads / 1e9:.2f} G loads/s", x=x_of(at) + 10, y=y_of(slope * at) + 16, class_="soft")
    places = list(dict.fromkeys((name, eta) for name, eta, _ in kernels))
    numbers = {name: number for number, name in enumerate(dict.fromkeys(name for name, _ in places), 1)}
    for name, number in numbers.items():  # at the longest lobe; the points of one kernel lie close together
        for isa, colour in colours.items():
            key = (name, max(eta for other, eta in places if other == name), isa)
            if key in kernels:
                element("circle", cx=x_of(intensity[key]), cy=y_of(rate[key]), r=9, fill=colour, class_="kernel")
                element("text", str(number), x=x_of(intensity[key]), y=y_of(rate[key]) + 4, text_anchor="middle", style="fill: #fff; font-size: 10px")
    x = RIGHT + 20
    element("text", "share of the limit of operations, of loads", x=x, y=TOP)
    columns = {isa: RIGHT + NAMES + COLUMN * i for i, isa in enumerate(ceilings)}
    for isa, at in columns.items():
        element("text", isa, x=at, y=TOP + 24, text_anchor="middle", style=f"fill: {colours[isa]}")
    for line, (name, eta) in enumerate(places, 1):
        y = TOP + 24 + 22 * line
        element("text", f"{numbers[name]}  {name}, eta {eta}", x=x, y=y)
        for isa, at in columns.items():
            if (name, eta, isa) in kernels:
                operations, loads = share(kernels[name, eta, isa], isa, limits)
                element("text", f"{100 * operations:.0f} %, {100 * loads:.0f} %", x=at, y=y, text_anchor="middle")
    out.append("</svg>")
    return "\n".join(out) + "\n"


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--program", metavar="BENCH_MICRO")
    source.add_argument("--from", dest="file", metavar="JSON")
    parser.add_argument("-o", "--output", required=True, metavar="SVG")
    parser.add_argument("--json", metavar="FILE", help="keep what was measured")
    options = parser.parse_args(arguments)
    try:
        if options.file:
            with open(options.file, encoding="utf-8") as file:
                text = file.read()
        else:
            text = run(options.program)
        limits, kernels = figures_of(text)
    except (Unusable, OSError) as error:
        print(f"roofline: {error}", file=sys.stderr)
        return 2
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            file.write(text)
    with open(options.output, "w", encoding="utf-8") as file:
        file.write(chart(limits, kernels))
    print(table(limits, kernels))
    load = re.search(r'"load_avg": \[([\d.]+)', text)
    if load and float(load[1]) > 0.5:
        print(f"warning: measured at a load average of {float(load[1]):.2f}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
