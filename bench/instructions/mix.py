#!/usr/bin/env python3
"""Counts a frame's instructions: by function, and each function's by kind.

Usage: mix.py --program build/release/bench_instructions [--top 6] [--unit N] [--hot FUNCTION] WORKLOAD...

A workload is a name of count.py's, or NAME@WIDTHxHEIGHT in another size: bent_normal@1920x1080. Runs it under valgrind and reads the counts
beside the program's disassembly. Figures are of one frame, in instructions; with --unit in instructions per N of them, so --unit 259200 gives
the instructions of eight pixels of 1920x1080. "stack" are those that read or write the stack, whatever else they do: above a tenth, a function has more
at hand than registers. --hot prints the instructions of functions whose name holds FUNCTION, with how often each ran.
"""

import argparse
import collections
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

KINDS = (  # the first match counts
    ("divide, root", r"v?(div|sqrt)[ps][sd]"),
    ("multiply", r"v?(mul[ps][sd]|pmul)"),
    ("add", r"v?((add|sub)[ps][sd]|padd|psub)"),
    ("convert", r"v?(cvt|round|rndscale)"),
    ("shuffle", r"v?(perm|shuf|unpck|insert|extract|pinsr|pextr|pshuf|broadcast|pbroadcast|compress|pcompress|expand|pexpand|palign|valign)"),
    ("compare, select", r"v?(cmp[a-z_]*[ps][sd]|pcmp|max|min|pmax|pmin|blend|pblend|ptest|testps|movmsk|pmovmsk)|k[a-z]+[bwdq]$"),
    ("bits", r"v?(and|or|xor|pand|por|pxor|psll|psrl|psra|pdep|pext|popcnt)"),
    ("gather", r"v?(gather|pgather|pscatter)"),
    ("move", r"v?mov(aps|ups|dqa|dqu|dqa32|dqu32|dqu64|dqa64|ss|sd|d|q|hlps|lhps)$"),
    ("branch, call", r"j|call|ret|endbr"),
    ("scalar", r"."),
)


def counts_of(file):
    """{address: times that the instruction there ran}; callgrind writes addresses as differences."""
    counts, address, of_callee = collections.Counter(), 0, False
    line_of_counts = re.compile(r"(0x[0-9a-f]+|[+-]\d+|\*) (?:\d+|[+-]\d+|\*) (\d+)$")
    for line in file:
        if line.startswith("calls="):
            of_callee = True
            continue
        found = line_of_counts.match(line.strip())
        if not found:
            continue
        place, count = found.groups()
        address = int(place, 16) if place.startswith("0x") else address if place == "*" else address + int(place)
        if not of_callee:
            counts[address] += int(count)
        of_callee = False
    return counts


def disassembly(program):
    """{address: (function, text)}"""
    out = subprocess.run(("objdump", "-d", "--no-show-raw-insn", "-C", program), check=True, capture_output=True, text=True).stdout
    found, function = {}, ""
    for line in out.splitlines():
        if head := re.match(r"[0-9a-f]+ <(.*)>:$", line):
            function = head.group(1)
        elif at := re.match(r"\s+([0-9a-f]+):\t(.*)$", line):
            found[int(at.group(1), 16)] = function, at.group(2)
    return found


def short(function):
    name = re.sub(r"\((?!anonymous).*", "", function.replace("burnish::", "").replace("(anonymous namespace)::", "").replace("void ", ""))
    return name.replace("bn_", "")[:74]


def kind_of(text):
    operation = text.split()[0]
    return next(kind for kind, pattern in KINDS if re.match(pattern, operation))


def measure(program, workload):
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(("valgrind", "--tool=callgrind", "--dump-instr=yes", "--instr-atstart=no", f"--callgrind-out-file={folder}/out", program, workload),
                              capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(done.stderr[-2000:])
        for path in sorted(pathlib.Path(folder).glob("out.*")):
            with open(path, encoding="utf-8", errors="replace") as file:
                return counts_of(file)
    sys.exit("valgrind counted nothing")


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--top", type=int, default=6)
    parser.add_argument("--unit", type=float, default=1.0)
    parser.add_argument("--hot", default="")
    parser.add_argument("workloads", nargs="+", metavar="WORKLOAD")
    options = parser.parse_args(arguments)
    for tool in ("valgrind", "objdump"):
        if not shutil.which(tool):
            print(f"skipped: no {tool} on this machine")
            return 77
    program = str(pathlib.Path(options.program).resolve())
    known = disassembly(program)
    for workload in options.workloads:
        counts = measure(program, workload)
        functions = collections.defaultdict(collections.Counter)
        for address, count in counts.items():
            function, text = known.get(address, ("libraries", "nop"))
            functions[function][kind_of(text)] += count
            functions[function]["all"] += count
            if re.search(r"\(%[re]?[sb]p", text):
                functions[function]["stack"] += count
        total = sum(counts.values())
        print(f"{workload}: {total / options.unit:.0f}" + (f" per {options.unit:g} of the frame's {total}" if options.unit != 1.0 else " instructions"))
        for function, kinds in sorted(functions.items(), key=lambda item: -item[1]["all"])[: options.top]:
            all_of_it = kinds.pop("all")
            print(f"  {all_of_it / options.unit:>12.0f}  {100 * all_of_it / total:>5.1f} %  {short(function)}")
            parts = sorted(kinds.items(), key=lambda item: -item[1])
            print("      " + ", ".join(f"{kind} {100 * count / all_of_it:.0f} %" for kind, count in parts if count * 100 > all_of_it))
        if options.hot:
            for address in sorted(known):
                function, text = known[address]
                if options.hot in function and counts[address]:
                    print(f"{counts[address] / options.unit:>14.2f}  {address:x}  {text}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
