#!/usr/bin/env python3
"""cross.aarch64: what is built by a cross compiler and run by qemu bakes and draws the same bits as here.

Usage: pixels.py SOURCE-FOLDER BUILD-FOLDER HASHES    HASHES: burnish_hashes of this machine
Exit code 77 where there is no cross compiler or no qemu.
"""

import pathlib
import shutil
import subprocess
import sys

EMULATOR = ("qemu-aarch64", "-L", "/usr/aarch64-linux-gnu")
COMPILER = "aarch64-linux-gnu-g++"
FEWEST = 40  # different hashes: pictures that are all black would be equal, too


def skip(reason):
    print("skipped:", reason)
    sys.exit(77)


def run(command, **options):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))} ended with {done.returncode}\n{done.stdout[-4000:]}\n{done.stderr[-4000:]}")
    return done.stdout


def build(source, folder):
    """burnish_hashes for aarch64, quickly: what it draws is the same however it is optimised."""
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    run(["cmake", "--preset", "aarch64", "-B", folder, "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG", *launcher], cwd=source)
    run(["cmake", "--build", folder, "--target", "burnish_hashes"])
    return folder / "tests" / "cross" / "burnish_hashes"


def hashes(command, isa):
    """{what: hash}"""
    lines = run([*command, isa]).splitlines()
    return {line.partition(" ")[2]: line.partition(" ")[0] for line in lines}


def main():
    source, folder, program = map(pathlib.Path, sys.argv[1:])
    for tool in (COMPILER, EMULATOR[0]):
        if not shutil.which(tool):
            skip(f"no {tool} on this machine")
    other = [*EMULATOR, build(source, folder)]
    isas = run(other).split()
    if "scalar" not in isas or len(isas) < 2:
        sys.exit(f"instruction sets of aarch64: {isas}")
    here = hashes([program], run([program]).split()[-1])
    if len(set(here.values())) < FEWEST:
        sys.exit(f"only {len(set(here.values()))} different hashes")
    differ = 0
    for isa in isas:
        there = hashes(other, isa)
        for what in sorted(here.keys() | there.keys()):
            if there.get(what) != here.get(what):
                differ += 1
                print(f"{what}: {there.get(what)} by {isa} of aarch64, {here.get(what)} here")
    print(f"{len(here)} hashes by {', '.join(isas)} of aarch64: {differ} differ from those of this machine")
    sys.exit(differ != 0)


if __name__ == "__main__":
    main()
