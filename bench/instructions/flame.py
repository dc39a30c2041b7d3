#!/usr/bin/env python3
"""Draws a frame's instructions by function and inlined function: a flame chart, alone or above an older program's chart.

Usage: flame.py --program build/flame/bench_instructions [--before PROGRAM] [--unit N] [--table 20] -o flame.svg WORKLOAD

WORKLOAD and --unit are mix.py's. Needs a program with tables of lines, which change no instruction:
    cmake --preset release -B build/flame -DCMAKE_CXX_FLAGS=-g1 && cmake --build build/flame --target bench_instructions
Below the frame stand the functions that are called, below each the functions inlined into it, as wide as their instructions. Operations of
lanes (core/simd, intrinsics) count for the function that asks for them. A colour is a folder. Two programs are drawn to one scale. --table
prints the functions that take most by themselves.
Exit code: 0; 2 where a program tells no lines; 77 without valgrind or addr2line.
"""

import argparse
import collections
import pathlib
import re
import shutil
import subprocess
import sys
import xml.sax.saxutils

import mix

WIDTH, ROW, NARROWEST = 1400, 18, 0.7  # pixels; NARROWEST: narrowest drawn box
LETTER = 6.1                           # pixels, a letter's width in this font size
COLOURS = {"raster/tile": "#9ec5e8", "raster": "#c4d7ea", "shading/techniques": "#f2b77c", "shading/surface": "#f6d58a", "shading/lights": "#f4a79d",
           "shading/kernels": "#a9d6a0", "shading": "#d6cfae", "core": "#cfcfcf", "": "#e4e4e4"}
LANES = "core/simd"


def folder_of(path):
    """Returns the file's folder in the repository ("shading/surface"), or "" for a file outside the repository."""
    found = re.search(r"/?(?:^|/)((?:core|raster|shading|apps|bench)/(?:[a-z_0-9]+/)*)[^/]+$", path)
    return found.group(1).rstrip("/") if found else ""


def colour_of(folder):
    while folder not in COLOURS:
        folder = folder.rpartition("/")[0]
    return COLOURS[folder]


def stacks_of(program, addresses):
    """Returns {address: ((function, folder), ...)}, from the called function to the function inlined last, without operations of lanes."""
    asked = "\n".join(f"0x{a:x}" for a in addresses)
    out = subprocess.run(("addr2line", "-a", "-i", "-f", "-C", "-e", program), input=asked, check=True, capture_output=True, text=True).stdout
    found, lines = {}, []

    def keep(block):
        frames = [(mix.short(block[i]), folder_of(block[i + 1].rpartition(":")[0])) for i in range(1, len(block) - 1, 2)]
        frames.reverse()
        found[int(block[0], 16)] = tuple(f for i, f in enumerate(frames) if i == 0 or (f[1] and not f[1].startswith(LANES)))

    for line in out.splitlines():
        if re.fullmatch(r"0x[0-9a-f]+", line) and lines:
            keep(lines)
            lines = []
        lines.append(line)
    if lines:
        keep(lines)
    return found


class Node:
    def __init__(self, folder=""):
        self.folder, self.count, self.own, self.parts = folder, 0, 0, {}


def tree_of(counts, stacks):
    root = Node()
    for address, count in counts.items():
        node = root
        node.count += count
        for name, folder in stacks.get(address) or (("libraries", ""),):
            node = node.parts.setdefault(name, Node(folder))
            node.count += count
        node.own += count
    return root


def depth_of(node, scale):
    return 1 + max((depth_of(p, scale) for p in node.parts.values() if p.count * scale >= NARROWEST), default=0)


def drawn(node, name, x, y, scale, unit, total, out):
    width = node.count * scale
    if width < NARROWEST:
        return
    label = f"{name} {node.count / unit:.0f}"
    title = f"{label}: {100 * node.count / total:.1f} %, {100 * node.own / total:.1f} % by itself" + (f"; {node.folder}" if node.folder else "")
    out.append(f'<g><title>{xml.sax.saxutils.escape(title)}</title><rect x="{x:.1f}" y="{y}" width="{width:.1f}" height="{ROW - 1}" '
               f'fill="{colour_of(node.folder)}" stroke="#fff" stroke-width="0.5"/>')
    letters = int((width - 6) / LETTER)
    if letters >= 4:
        shown = label if len(label) <= letters else name[: letters - 1] + "…"
        out.append(f'<text x="{x + 3:.1f}" y="{y + 13}">{xml.sax.saxutils.escape(shown)}</text>')
    out.append("</g>")
    for part, inside in sorted(node.parts.items(), key=lambda item: -item[1].count):
        drawn(inside, part, x, y + ROW, scale, unit, total, out)
        x += inside.count * scale


def picture_of(trees, unit):
    """trees: [(title, tree)], from above."""
    scale = WIDTH / max(t.count for _, t in trees)
    out, y = [], 24
    for title, tree in trees:
        out.append(f'<text x="3" y="{y + 12}" font-weight="bold">{xml.sax.saxutils.escape(title)}</text>')
        drawn(tree, "frame", 0, y + ROW, scale, unit, tree.count, out)
        y += ROW * (depth_of(tree, scale) + 2)
    x = 3
    for folder, colour in COLOURS.items():
        out.append(f'<rect x="{x}" y="4" width="12" height="12" fill="{colour}"/><text x="{x + 16}" y="14">{folder or "libraries"}</text>')
        x += 30 + int(LETTER * len(folder or "libraries"))
    head = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {y}" font-family="monospace" font-size="10">'
    return "\n".join((head, f'<rect width="{WIDTH}" height="{y}" fill="#fff"/>', *out, "</svg>\n"))


def table_of(tree, unit, rows):
    own, whole = collections.Counter(), collections.Counter()

    def visit(node, above):
        for name, part in node.parts.items():
            own[name] += part.own
            if name not in above:  # counts recursive functions once
                whole[name] += part.count
            visit(part, above | {name})

    visit(tree, frozenset())
    for name, count in own.most_common(rows):
        print(f"  {count / unit:>12.1f}  {100 * count / tree.count:>5.1f} %  with what is inlined {whole[name] / unit:>10.1f}  {name}")


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--before", help="an older program, drawn above")
    parser.add_argument("--unit", type=float, default=1.0)
    parser.add_argument("--table", type=int, default=0, help="print so many functions")
    parser.add_argument("-o", dest="output", required=True, type=pathlib.Path)
    parser.add_argument("workload", metavar="WORKLOAD")
    options = parser.parse_args(arguments)
    for tool in ("valgrind", "addr2line"):
        if not shutil.which(tool):
            print(f"skipped: no {tool} on this machine")
            return 77
    trees = []
    for title, given in (("before", options.before), ("now" if options.before else "", options.program)):
        if not given:
            continue
        program = str(pathlib.Path(given).resolve())
        counts = mix.measure(program, options.workload)
        stacks = stacks_of(program, list(counts))
        if not any(len(s) > 1 for s in stacks.values()):
            print(f"{given} tells no lines: see --help for how to build one that does", file=sys.stderr)
            return 2
        tree = tree_of(counts, stacks)
        title = f"{title} {options.workload}: {tree.count / options.unit:.0f} instructions".strip()
        print(title)
        if options.table:
            table_of(tree, options.unit, options.table)
        trees.append((title, tree))
    options.output.write_text(picture_of(trees, options.unit))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
