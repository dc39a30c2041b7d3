#!/usr/bin/env python3
"""The table of speed as ratios to an older commit, the two programs in turn.

Usage: against.py COMMIT|FOLDER --program build/release/bench_frame [--isa avx2,avx512] [--turns 5] [--threads 2] [--only NAME] [--json FILE]

Builds bench_frame of the commit in a folder of its own below the build folder, with the newest scenes and workloads since then that it builds
with, or takes the build folder that is given. Then each workload is drawn by the one and by the other, turn by turn: the ratio of a turn is
the ratio of the medians of its rounds, and the figure of the table the median over all turns, with the least and the most beside it. CPU times of
all threads. A ratio of a busy machine still holds, within its spread; milliseconds do not. Where the pictures differ it says so.

Exit code: 0; 1 where some workload has become slower by more than 3 % in every turn; 2 where nothing could be compared.
"""

import argparse
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
# Aims: (workload, description, ratio).
TABLE = (
    ("bent_normal_eta05", "bent_normal, all pixels covered", 0.66),
    ("split_isotropic", "split_isotropic, all pixels covered", 0.59),
    ("major_axis_16_eta05", "major_axis, 16 samples, eta 0.5", 0.85),
    ("major_axis_16_eta08", "major_axis, 16 samples, eta 0.8", 0.85),
    ("adaptive_eta05", "major_axis_adaptive, eta 0.5", 0.85),
    ("adaptive_eta08", "major_axis_adaptive, eta 0.8", 0.85),
    ("weighted_16_eta05", "major_axis_weighted, 16 samples, eta 0.5", 0.85),
    ("textures_1", "one texture", 0.6),
    ("textures_5", "five textures", 0.6),
    ("floor_3", "grazing floor, three textures", 0.6),
    ("trivial_1x", "constant colour, 1x", 0.9),
    ("trivial_8x", "constant colour, 8x", 0.6),
    ("triangles_1m_1x", "a million triangles of 2 pixels, 1x", 0.7),
    ("triangles_1m_4x", "a million triangles of 2 pixels, 4x", 0.55),
    ("teapot_1x", "teapot, 1x", None),
    ("teapot_8x", "teapot, 8x", 0.75),
    ("foliage_50k", "50,000 leaves cut out by alpha", 0.45),
    ("slivers_10k", "10,000 diagonal slivers", 0.45),
    ("lights_4", "4 lights", None),
    ("lights_50", "50 lights of which 4 reach a point", None),
    ("materials_1000", "1000 materials in turn", None),
    ("two_threads_crowd_8x", "980,000 triangles in four tiles, 8x", None),
)
OVERLAID = ("bench/scenes/CMakeLists.txt", "bench/scenes/scenes.cpp", "bench/scenes/scenes.h", "bench/scenes/stress.cpp", "bench/scenes/stress.h",
            "bench/frame/workloads.cpp", "bench/frame/workloads.h")
OBJECTS = ("bench/scenes/CMakeFiles/burnish_bench.dir/stress.cpp.o", "bench/scenes/CMakeFiles/burnish_bench.dir/scenes.cpp.o",
           "bench/frame/CMakeFiles/bench_frame.dir/workloads.cpp.o")


def run(*command, **options):
    return subprocess.run(command, check=True, text=True, **options)


def git(*arguments):
    return run("git", "-C", str(ROOT), *arguments, capture_output=True).stdout.strip()


def overlay(tree, commit):
    """The workloads of a commit, or of this folder, in an older tree, which may know headers by other names. False where it has none."""
    for name in OVERLAID:
        (tree / name).parent.mkdir(parents=True, exist_ok=True)
        if commit is None:
            shutil.copyfile(ROOT / name, tree / name)
            continue
        shown = subprocess.run(("git", "-C", str(ROOT), "show", f"{commit}:{name}"), text=True, capture_output=True, check=False)
        if shown.returncode != 0:
            return False
        (tree / name).write_text(shown.stdout)
    frame = tree / "bench/frame/CMakeLists.txt"
    frame.write_text("".join(line for line in frame.read_text().splitlines(True) if not line.startswith("add_dependencies(bench_frame burnish)")))
    if not (tree / "core/scene/builtin/surface.h").exists():
        for name in ("scenes.cpp", "stress.cpp"):
            path = tree / "bench/scenes" / name
            path.write_text(path.read_text().replace("core/scene/builtin/surface.h", "core/scene/builtin_surface.h"))
    return True


def sources_of_workloads(commit):
    """Where workloads for a commit may come from, in order: this folder, the commits since then that changed them, the commit itself."""
    yield None, "this folder's scenes and workloads"
    for since in git("log", "--format=%h", f"{commit}..HEAD", "--", *OVERLAID).split():
        yield since, f"the scenes and workloads of {since}"
    yield commit, "its own scenes and workloads"


def made(folder, target):
    return subprocess.run(("cmake", "--build", str(folder), "--target", target), stdout=sys.stderr, check=False).returncode == 0


def build(commit, folder):
    """bench_frame of the commit; made once."""
    known = git("rev-parse", "--short", commit)
    tree = folder / known
    program = tree / "build/bench_frame"
    if program.exists():
        return program
    configure = ("cmake", "-S", str(tree), "-B", str(tree / "build"), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release")
    for source, what in sources_of_workloads(known):
        tree.mkdir(parents=True, exist_ok=True)
        archive = subprocess.Popen(("git", "-C", str(ROOT), "archive", known), stdout=subprocess.PIPE)
        run("tar", "-x", "-C", str(tree), stdin=archive.stdout)
        if source != known and not overlay(tree, source):
            continue
        run(*configure, stdout=subprocess.DEVNULL)
        first = OBJECTS if source != known else ()  # builds the objects that may fail before everything else
        if all(made(tree / "build", target) for target in (*first, "bench_frame")):
            print(f"{known}: takes {what}", file=sys.stderr)
            return program
    sys.exit(f"{known} does not build: {tree}")


def measure(program, token, isa, threads, rounds):
    """{workload: (median CPU ms of its rounds, hash of the picture or None)}"""
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "out.json")
        done = subprocess.run((str(program), "--only", token, "--isa", isa, "--threads", str(threads), "--rounds", str(rounds), "--quick", "--json", out),
                              capture_output=True, text=True)
        if done.returncode != 0:
            return {}
        with open(out, encoding="utf-8") as file:
            rows = json.load(file)["workloads"]
    return {row["name"]: (statistics.median(row["cpu_ms_rounds"]), row.get("pixels")) for row in rows}


def compare(old, new, name, isa, options):
    """Ratios of the turns, median milliseconds of both, whether pictures differ; None where one of them has no such workload."""
    ratios, before, after, differ = [], [], [], False
    for turn in range(options.turns):
        pair = {}
        for program in (old, new) if turn % 2 == 0 else (new, old):
            pair[program] = measure(program, name, isa, options.threads, options.rounds).get(name)
            if pair[program] is None:
                return None
        before.append(pair[old][0]), after.append(pair[new][0])
        ratios.append(pair[new][0] / pair[old][0])
        differ = differ or (None not in (pair[old][1], pair[new][1]) and pair[old][1] != pair[new][1])
    return ratios, statistics.median(before), statistics.median(after), differ


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", metavar="COMMIT|FOLDER")
    parser.add_argument("--program", required=True)
    parser.add_argument("--isa", default="avx2,avx512")
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--only", default="")
    parser.add_argument("--build-only", action="store_true")
    parser.add_argument("--json")
    options = parser.parse_args(arguments)
    new = pathlib.Path(options.program).resolve()
    folder = pathlib.Path(options.old)
    old = folder / "bench_frame" if (folder / "bench_frame").exists() else build(options.old, new.parent / "against")
    if options.build_only:
        return 0
    print(f"{options.turns} turns of {options.rounds} rounds, {options.threads} threads, load average {os.getloadavg()[0]:.2f}; before: {options.old}")
    rows = []
    for isa in options.isa.split(","):
        print(f"\n| {isa:<46} | {'aim':>5} | {'ratio':>6} | {'of all turns':<14} | {'before':>9} | {'now':>9} |\n| {'-' * 46} | {'-' * 4}: | {'-' * 5}: | {'-' * 14} | {'-' * 8}: | {'-' * 8}: |")
        for name, what, aim in TABLE:
            if options.only not in name:
                continue
            found = compare(old, new, name, isa, options)
            if found is None:
                print(f"| {what:<46} | not in both")
                continue
            ratios, before, after, differ = found
            ratio = statistics.median(ratios)
            verdict = "" if aim is None else " met" if ratio <= aim else " missed"
            spread = f"{min(ratios):.3f} to {max(ratios):.3f}"
            print(f"| {what:<46} | {aim or '':>5} | {ratio:>6.3f} | {spread:<14} | {before:>6.2f} ms | {after:>6.2f} ms |{verdict}{' other pixels' if differ else ''}", flush=True)
            rows.append({"name": name, "isa": isa, "aim": aim, "ratio": ratio, "ratios": ratios, "before_ms": before, "now_ms": after, "other_pixels": differ})
    if options.json:
        pathlib.Path(options.json).write_text(json.dumps({"before": options.old, "load_average": os.getloadavg()[0], "rows": rows}, indent=1) + "\n")
    if not rows:
        return 2
    return 1 if any(min(row["ratios"]) > 1.03 for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
