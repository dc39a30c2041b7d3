#!/usr/bin/env python3
"""Writes the tables of measured speed into bench/README.md, between two markers.

Usage: speed_page.py --frames FILE.json --races FILE.json [FILE.json ...]    takes new figures, writes speed.json and the page
       speed_page.py                                                         writes the page from speed.json again
       speed_page.py --check                                                 compares the page with speed.json

--frames: the file of bench_frame --isa avx2,avx512 --json. --races: files of `burnish race --shaders lean --json`, one or more for each
instruction set (BN_FORCE_ISA). All files must come from one processor. speed.json keeps the figures that the page shows, and the commit.
Exit code: 0; 1 the page differs from speed.json (--check); 2 a file cannot be read, or figures come from two processors.
"""

import argparse
import json
import math
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
BEGIN, END = "<!-- speed: written by bench/speed_page.py -->", "<!-- end of speed -->"
ISA_NAMES = {"avx2": "AVX2", "avx512": "AVX-512", "scalar": "scalar"}


class Unusable(Exception):
    pass


def read(path):
    try:
        return json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise Unusable(f"{path}: {error}") from error


def commit():
    """Returns the commit's short name; `+` marks changed files other than those written here."""
    def git(*words):
        return subprocess.run(["git", "-C", str(HERE), *words], capture_output=True, text=True, check=False).stdout
    changed = [line for line in git("status", "--porcelain", "-uno").splitlines() if not line.endswith(("bench/README.md", "bench/speed.json"))]
    return git("rev-parse", "--short=8", "HEAD").strip() + ("+" if changed else "")


def frames_of(data):
    """Returns the rows of bench_frame that the page shows: headline figures, without growth."""
    keep = ("what", "isa", "unit", "aim", "bound", "met")
    return [{**{key: row[key] for key in keep}, "measured": float(f"{row['measured']['median']:.4g}")} for row in data["rows"]]


def races_of(data):
    """Returns a race's rows: the device's CPU time over the tile renderer's, and the HDR-FLIP between both pictures."""
    keep = ("scene", "device", "technique", "msaa", "error")
    rows = []
    for row in data["rows"]:
        if row["shader"] != "lean":
            continue
        measured = {} if row["error"] else {"ratio": float(f"{row['ratio']:.4g}"), "flip": float(f"{row['flip_mean']:.2g}"),
                                            "same_picture": row["same_picture"]}
        rows.append({**{key: row[key] for key in keep}, "scene": pathlib.PurePath(row["scene"]).name, "isa": data["machine"]["isa"], **measured})
    return rows


def collect(frames_path, race_paths):
    """Returns speed.json's content. Errors: Unusable."""
    try:
        frames = read(frames_path)
        races = [read(path) for path in race_paths]
        machine = frames["machine"]
        processors = {machine["processor"], *(race["machine"]["processor"] for race in races)}
        if len(processors) > 1:
            raise Unusable("figures of several processors: " + ", ".join(sorted(processors)))
        return {
            "commit": commit(),
            "machine": {"processor": machine["processor"], "compiler": machine["compiler"], "threads": frames["threads"],
                        "rounds": frames["rounds"], "quiet": frames["headline"],
                        "load": [round(machine["load_average"], 2), round(frames["load_average_end"], 2)]},
            "frames": frames_of(frames),
            "race_size": [races[0]["width"], races[0]["height"]] if races else None,
            "race_notes": sorted({re.sub(r"^\S*/", "", note) for race in races for note in race["notes"]}),  # without folders
            "races": [row for race in races for row in races_of(race)],
        }
    except (KeyError, TypeError) as error:
        raise Unusable(f"not the figures of bench_frame or of a race: {error!r}") from error


def geometric_mean(values):
    return math.exp(sum(math.log(value) for value in values) / len(values))


def table(head, rows):
    return ["| " + " | ".join(head) + " |", "|" + " --- |" * len(head), *("| " + " | ".join(row) + " |" for row in rows)]


def frame_table(frames):
    isas = list(dict.fromkeys(row["isa"] for row in frames))
    lines = []
    for what in dict.fromkeys(row["what"] for row in frames):
        own = {row["isa"]: row for row in frames if row["what"] == what}
        first = next(iter(own.values()))
        bound = {"at least": ">=", "at most": "<="}[first["bound"]]
        aim = "" if first["aim"] is None else f"{bound} {first['aim']:.3g} {first['unit']}"
        cells = []
        for isa in isas:
            row = own.get(isa)
            missed = row and row["met"] is False
            cells.append("" if row is None else f"{row['measured']:.3g} {row['unit']}" + (" (missed)" if missed else ""))
        lines.append([what, aim, *cells])
    return table(["work", "aim", *(ISA_NAMES.get(isa, isa) for isa in isas)], lines)


def race_cell(rows):
    """Returns the geometric mean and the least ratio over techniques, or why none is there."""
    ratios = [row["ratio"] for row in rows if row.get("same_picture")]
    others = [row for row in rows if not row.get("same_picture")]
    text = f"{geometric_mean(ratios):.1f} (least {min(ratios):.1f})" if ratios else "-"
    return text + (f", {len(others)} not counted" if others else "")


def race_table(races):
    columns = [(msaa, isa) for msaa in sorted({row["msaa"] for row in races}) for isa in dict.fromkeys(row["isa"] for row in races)]
    places = list(dict.fromkeys((row["scene"], row["device"]) for row in races))
    devices = list(dict.fromkeys(device for _, device in places))

    def line(name, chosen):
        return [name, *(race_cell([row for row in chosen if (row["msaa"], row["isa"]) == column]) for column in columns)]

    lines = []
    for device in devices:
        own = [row for row in races if row["device"] == device]
        lines += [line(scene, [row for row in own if row["scene"] == scene]) for scene, of in places if of == device]
        lines.append(line(f"**all, {device.split(' (')[0]}**", own))
    return table(["scene", *(f"{msaa}x, {ISA_NAMES.get(isa, isa)}" for msaa, isa in columns)], lines)


def block(speed):
    """Returns the lines between the markers."""
    machine = speed["machine"]
    quiet = "quiet" if machine["quiet"] else "busy: compare ratios only"
    lines = [f"Commit {speed['commit']}, {machine['processor']}, {machine['threads']} threads, {machine['compiler']}, {machine['rounds']} rounds, "
             f"load average {machine['load'][0]} to {machine['load'][1]} ({quiet}). Times are CPU time unless the row says wall time.", "",
             *frame_table(speed["frames"])]
    if speed["races"]:
        width, height = speed["race_size"]
        techniques = ", ".join(dict.fromkeys(row["technique"] for row in speed["races"]))
        lines += ["", f"A race at {width}x{height}: CPU time of the device with its lean shader over the tile renderer's, as geometric mean and "
                  f"least over {techniques}. Rows whose pictures differ, or that the lean shader cannot draw, are not counted.", "",
                  *race_table(speed["races"])]
        if speed["race_notes"]:
            lines += ["", *(f"- {note}." for note in speed["race_notes"])]
    return lines


def with_block(page, speed):
    """Returns the page's text with new tables. Errors: Unusable."""
    before, begin, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not begin or not end:
        raise Unusable("the page lacks its markers")
    return before + begin + "\n\n" + "\n".join(block(speed)) + "\n\n" + end + after


def main(words):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frames", metavar="FILE")
    parser.add_argument("--races", nargs="+", default=[], metavar="FILE")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--folder", type=pathlib.Path, default=HERE, help="the folder with README.md and speed.json")
    options = parser.parse_args(words)
    if options.check and options.frames or options.races and not options.frames:
        parser.error("--check takes no new figures, and --races wants --frames")
    page, figures = options.folder / "README.md", options.folder / "speed.json"
    try:
        speed = collect(options.frames, options.races) if options.frames else read(figures)
        text = page.read_text(encoding="utf-8")
        new = with_block(text, speed)
    except (Unusable, OSError) as error:
        print(f"speed_page: {error}", file=sys.stderr)
        return 2
    if options.check:
        if new != text:
            print("speed_page: the page differs from speed.json; run bench/speed_page.py", file=sys.stderr)
        return int(new != text)
    if options.frames:
        figures.write_text(json.dumps(speed, indent=1) + "\n", encoding="utf-8")
    page.write_text(new, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
