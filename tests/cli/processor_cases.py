"""Processors for which the program is not compiled, emulated by qemu."""

import json
import pathlib
import platform
import shutil
import sys

from harness import Skipped, case, check

OLD, ENOUGH = "core2duo-v1", "Nehalem-v1"


def emulator():
    qemu = shutil.which("qemu-x86_64")
    if platform.machine() != "x86_64" or not qemu:
        raise Skipped("no qemu-x86_64 on this machine")
    return qemu


@case("processor.below_x86_64_v2_is_told_what_lacks")
def too_old(bench):
    qemu = emulator()
    for arguments in (("info",), ("render", "--help"), ()):
        told = bench.run("-cpu", OLD, bench.program, *arguments, program=qemu).expect(77)
        told.expect_one_line("x86-64-v2", "Core(TM)2", "SSE4.2", "POPCNT")
        check("SSSE3" not in told.err and not told.out, f"this processor has SSSE3\n{told.describe()}")
    facts = json.loads(bench.run("-cpu", ENOUGH, bench.program, "info", "--json", program=qemu).expect(0).out)
    check(facts["isa"] == "scalar", f"a processor of x86-64-v2 runs {facts['isa']}")


@case("processor.library_is_refused_below_x86_64_v2")
def library_refused(bench):
    """The dynamic loader refuses with a message and without a crash."""
    qemu, python = emulator(), sys.executable
    library = next(pathlib.Path(bench.program).parent.glob("raster/session/libburnish.so.*.*.*"), None)
    if not library or not python:
        raise Skipped("no libburnish.so or no python3")
    load = ("-c", f"import ctypes; ctypes.CDLL({str(library)!r})")
    bench.run("-cpu", ENOUGH, python, *load, program=qemu).expect(0)
    refused = bench.run("-cpu", OLD, python, *load, program=qemu).expect(1)
    check("CPU ISA level is lower than required" in refused.err, f"refused for another reason\n{refused.describe()}")
