"""Compiles each source of the product alone, though builds join the sources of a folder: a source includes the headers that it uses.

Usage: sources.py BUILD_FOLDER [SOURCE...]    SOURCE: only these, as paths from the root
Exit code 1: a source does not compile. Lane code is never joined, and left out."""

import concurrent.futures
import json
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
ROOMS = ("core", "shading", "raster", "apps")


def commands(build):
    """Returns {source: words} of a configuration that joins no files. Generated headers are the build's."""
    with tempfile.TemporaryDirectory(prefix="burnish-sources-") as folder:
        subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DBN_JOIN_FILES=OFF", "-DBN_BUILD_TESTS=OFF", "-DBN_BUILD_BENCH=OFF",
                        "-DBN_ISA_SET=scalar"], check=True, stdout=subprocess.DEVNULL)
        rows = json.loads(pathlib.Path(folder, "compile_commands.json").read_text())
        found = {}
        for row in rows:
            source = pathlib.Path(row["file"])
            if source.is_relative_to(ROOT) and source.relative_to(ROOT).parts[0] in ROOMS and "-DBN_ISA=" not in row["command"]:
                words = shlex.split(row["command"].replace(folder, str(build)))
                at = words.index("-o")
                found[str(source.relative_to(ROOT))] = words[:at] + words[at + 2:] + ["-fsyntax-only", "-O0", "-U_FORTIFY_SOURCE"]
        return found


def fault_of(words):
    done = subprocess.run(words, cwd=ROOT, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    return done.stderr if done.returncode else ""


def main(build, *wanted):
    chosen = {source: words for source, words in commands(pathlib.Path(build).resolve()).items() if not wanted or source in wanted}
    if len(chosen) < (len(wanted) or 300):
        sys.exit(f"{len(chosen)} sources are too few")
    with concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        faults = [fault for fault in pool.map(fault_of, chosen.values()) if fault]
    print("\n".join(faults) + f"{len(faults)} of {len(chosen)} sources do not compile alone")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
