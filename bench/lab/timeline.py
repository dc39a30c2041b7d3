#!/usr/bin/env python3
"""Draws a timeline of a command: each thread's work from its start to its exit, along time.

Usage: timeline.py -o CHART.svg [--title TEXT] [--rate HZ] COMMAND...
for instance: timeline.py -o helmet.svg build/release/burnish render FlightHelmet.gltf --size 1920x1080 --msaa 4 -o helmet.png

Samples call stacks by perf (Linux), which needs no rights where kernel.perf_event_paranoid is at most 2. --rate: samples a second of each thread (4000).
A row is a depth of the stack, callers above. Gaps are waits. Exit code: 0; 1 the command failed; 2 perf is missing or took no samples.
"""

import argparse
import html
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

WIDTH, ROW, TOP, DEPTH, LEAST = 1200, 15, 52, 15, 2.0  # pixels, but for DEPTH: rows; boxes narrower than LEAST are left out
# Colours of frames by the first pattern that their names or their callers' names match
KINDS = (
    ("dynamic linker", "#b9a3d9", r"^_?_?dl_|^_dl|^dlopen|OpenImageIO"),
    ("decoding files", "#e8b06a", r"png|inflate|jpeg|webp|deflate|crc32|adler|read_image|decode_image"),
    ("textures and tables", "#86b886", r"pyramid|mip_|bake_|paint|environment|filtered_"),
    ("frame", "#7aa7d6", r"bn_(avx2|avx512|scalar)|TileRenderer|tile|Bins|merge_parts"),
    ("kernel", "#c9c9c9", r"^kernel"),
    ("rest", "#e6d9b8", r""),
)
# Frames that only pass on a call
PASSED_ON = re.compile(r"^(std::|tbb::|__libc_start|_start|start_thread|__clone|clone3|\[unknown\]|__invoke|operator$|parallel_for)|_Function_handler|guarded")


def qualified(name):
    """Returns a function's name without its type, parameters and template arguments."""
    name = name.replace(" (inlined)", "").replace("(anonymous namespace)::", "")
    while re.search(r"<[^<>]*>", name):
        name = re.sub(r"<[^<>]*>", "", name)
    name = re.sub(r"\(.*", "", name)
    return name.split(" ")[-1] or "?"


def samples_of(text):
    """Yields (thread, seconds, names from the caller to the callee)."""
    for block in text.split("\n\n"):
        lines = block.strip("\n").split("\n")
        head = re.match(r"\s*(\d+)\s+([\d.]+):", lines[0])
        if not head:
            continue
        names = []
        for line in lines[1:]:
            address, _, symbol = line.strip().partition(" ")
            name = "kernel" if address.startswith("ffffffff") and symbol != "[unknown]" else qualified(symbol)
            if not PASSED_ON.search(name) and (not names or names[-1] != name):
                names.append(name)
        yield int(head.group(1)), float(head.group(2)), [name.replace("burnish::", "") for name in names[::-1]]


def boxes_of(samples, period):
    """Returns (depth, begin, end, name, callers) of samples in time order: equal stacks that follow each other are one box."""
    boxes, opened = [], []  # opened: [begin, name] by depth
    last = None

    def close(depth, end):
        while len(opened) > depth:
            begin, name = opened.pop()
            boxes.append((len(opened), begin, end, name, [n for _, n in opened]))

    for time, names in samples:
        if last is not None and time - last > 2.5 * period:
            close(0, last + period)
        same = 0
        while same < min(len(names), len(opened)) and opened[same][1] == names[same]:
            same += 1
        close(same, time)
        opened.extend([time, name] for name in names[same:])
        last = time
    close(0, (last or 0.0) + period)
    return boxes


def kind_of(name, callers):
    for label, colour, pattern in KINDS:
        if any(re.search(pattern, n) for n in [name, *callers[::-1]]):
            return label, colour
    return KINDS[-1][:2]


def chart(threads, begin, end, title):
    """Returns an SVG file. threads: boxes by thread, in order."""
    scale = (WIDTH - 20) / (end - begin)
    rows = [min(DEPTH, 1 + max((box[0] for box in boxes), default=0)) for boxes in threads]
    height = TOP + sum(ROW * n + 22 for n in rows)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" font-family="sans-serif" font-size="10">',
           f'<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>', f'<text x="10" y="16" font-size="13">{html.escape(title)}</text>']
    x = 10.0
    for label, colour, _ in KINDS:
        out.append(f'<rect x="{x:.0f}" y="24" width="10" height="10" fill="{colour}"/><text x="{x + 14:.0f}" y="33">{label}</text>')
        x += 26 + 6 * len(label)
    step = next(s for s in (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 1e9) if (end - begin) / s <= 16)
    for k in range(int((end - begin) / step) + 1):
        at = 10 + k * step * scale
        out.append(f'<path d="M{at:.1f} 40V{height}" stroke="#dddddd"/><text x="{at + 2:.1f}" y="48" fill="#666666">{1000 * k * step:.0f} ms</text>')
    y = TOP
    for number, boxes in enumerate(threads):
        out.append(f'<text x="10" y="{y + 11}" fill="#666666">thread {number + 1}</text>')
        y += 16
        for depth, first, last, name, callers in boxes:
            wide = (last - first) * scale
            if depth >= DEPTH or wide < LEAST:
                continue
            at = 10 + (first - begin) * scale
            whole = f"{name}: {1000 * (last - first):.1f} ms"
            out.append(f'<g><title>{html.escape(whole)}</title><rect x="{at:.1f}" y="{y + ROW * depth}" width="{wide:.1f}" height="{ROW - 1}" '
                       f'fill="{kind_of(name, callers)[1]}"/>')
            letters = int((wide - 4) / 5.6)
            if letters >= 3:
                out.append(f'<text x="{at + 2:.1f}" y="{y + ROW * depth + 11}">{html.escape(name[:letters])}</text>')
            out.append("</g>")
        y += ROW * rows[number] + 6
    return "\n".join(out) + "\n</svg>\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", dest="out", required=True, type=pathlib.Path)
    parser.add_argument("--title")
    parser.add_argument("--rate", type=int, default=4000)
    parser.add_argument("command", nargs=argparse.REMAINDER)
    options = parser.parse_args()
    if not options.command or not shutil.which("perf"):
        print("timeline.py: " + ("perf is not installed" if options.command else "no command"), file=sys.stderr)
        return 2
    with tempfile.TemporaryDirectory() as folder:
        data = folder + "/perf.data"
        done = subprocess.run(["perf", "record", "-q", "-F", str(options.rate), "-e", "cpu-clock", "--call-graph", "dwarf,16384", "-o", data, "--",
                               *options.command], check=False)
        if not pathlib.Path(data).exists() or not pathlib.Path(data).stat().st_size:
            print("timeline.py: perf took no samples", file=sys.stderr)
            return 2
        if done.returncode:
            return 1
        text = subprocess.run(["perf", "script", "-i", data, "-F", "tid,time,ip,sym"], capture_output=True, text=True, check=False).stdout
    threads = {}
    for thread, time, names in samples_of(text):
        threads.setdefault(thread, []).append((time, names))
    if not threads:
        print("timeline.py: perf took no samples", file=sys.stderr)
        return 2
    period = 1.0 / options.rate
    begin = min(s[0][0] for s in threads.values()) - period
    end = max(s[-1][0] for s in threads.values()) + period
    ordered = sorted(threads.values(), key=lambda s: s[0][0])
    title = options.title or " ".join(pathlib.PurePath(word).name if "/" in word else word for word in options.command)
    options.out.write_text(chart([boxes_of(s, period) for s in ordered], begin, end, f"{title}: {1000 * (end - begin):.0f} ms"), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
