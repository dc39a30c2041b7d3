#!/usr/bin/env python3
"""Compares bakes and images of two builds of burnish_hashes, by every instruction set of the second: all bits must be equal.

Usage: pixels.py HASHES OTHER-HASHES                             another compiler's
       pixels.py HASHES --machine aarch64|wasm SOURCE-FOLDER BUILD-FOLDER
                                                                 built here for another machine, run by qemu or node
Exits with 77 where there is no cross compiler or nothing that runs its programs.
"""

import pathlib
import shutil
import subprocess
import sys

# Compiler, the runner of its programs, the program's file, its instruction sets, flags (images do not depend on optimisation), targets.
MACHINES = {
    "aarch64": ("aarch64-linux-gnu-g++", ("qemu-aarch64", "-L", "/usr/aarch64-linux-gnu"), "burnish_hashes", {"scalar", "portable8"},
                ("-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG",), ("burnish_hashes",)),
    # The package too: cli/wasm_cases.py tries it.
    "wasm": ("emcc", ("node", "--no-experimental-fetch"), "burnish_hashes.js", {"wasm"}, (), ("burnish_hashes", "burnish_page_hashes", "burnish_package")),
}
FEWEST = 40  # minimum of different hashes, since black images would also be equal


def skip(reason):
    print("skipped:", reason)
    sys.exit(77)


def run(command, **options):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))} ended with {done.returncode}\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")
    return done.stdout


def build(machine, source, folder):
    """Builds burnish_hashes for another machine. Returns the command that runs it."""
    compiler, runner, program, isas, flags, targets = MACHINES[machine]
    for tool in (compiler, runner[0]):
        if not shutil.which(tool):
            skip(f"no {tool} on this machine")
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    run(["cmake", "--preset", machine, "-B", folder, *flags, *launcher], cwd=source)
    run(["cmake", "--build", folder, "--target", *targets])
    return [*runner, folder / "tests" / "cross" / program], isas


def hashes(command, isa):
    """Returns {name: hash}."""
    lines = run([*command, isa]).splitlines()
    return {line.partition(" ")[2]: line.partition(" ")[0] for line in lines}


def main():
    program, *words = sys.argv[1:]
    if words[0] == "--machine":
        other, expected = build(words[1], *map(pathlib.Path, words[2:]))
    else:
        other, expected = words, {"scalar"}
    isas = run(other).split()
    if not expected <= set(isas):
        sys.exit(f"instruction sets of {other[-1]}: {isas}")
    here = hashes([program], run([program]).split()[-1])
    if len(set(here.values())) < FEWEST:
        sys.exit(f"only {len(set(here.values()))} different hashes")
    differ = 0
    for isa in isas:
        there = hashes(other, isa)
        for what in sorted(here.keys() | there.keys()):
            if there.get(what) != here.get(what):
                differ += 1
                print(f"{what}: {there.get(what)} by {isa} of {other[-1]}, {here.get(what)} by {program}")
    print(f"{len(here)} hashes by {', '.join(isas)}: {differ} differ")
    sys.exit(differ != 0)


if __name__ == "__main__":
    main()
