#!/usr/bin/env python3
"""Counts the instructions of small frames and holds them against the committed budgets: AVX2 under valgrind, AVX-512 step by step.

Usage: count.py --program build/release/bench_instructions [--bless]

Instructions of the AVX2 code on one thread do not depend on the processor or on other programs, so a change of 3 % is a change of the
program. Budgets hold for the compiler, the C library and the valgrind that they were blessed with; on others the test is skipped (exit
code 77). Valgrind knows no AVX-512: where the processor has it, smaller frames are counted by its trap flag. Exit code 1: a workload takes more than 3 % more, or the file has other workloads. --bless writes the file anew.
"""

import argparse
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

BUDGETS = pathlib.Path(__file__).with_name("budgets.json")
TOLERANCE = 0.03
SKIPPED = 77


class Skip(Exception):
    pass


def made_with(program):
    valgrind = shutil.which("valgrind")
    if not valgrind:
        raise Skip("no valgrind on this machine")
    made = json.loads(subprocess.run([program, "--made-with"], check=True, capture_output=True, text=True).stdout)
    made["valgrind"] = subprocess.run([valgrind, "--version"], check=True, capture_output=True, text=True).stdout.strip()
    return made


def count(program, *workloads):
    """{workload: instructions} of one frame each; without names, of those that have budgets."""
    with tempfile.TemporaryDirectory() as folder:
        command = ["valgrind", "--tool=callgrind", "--instr-atstart=no", "--callgrind-out-file=" + folder + "/out", program, *workloads]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode == SKIPPED:
            raise Skip(done.stderr.strip().splitlines()[-1])
        if done.returncode != 0:
            sys.exit(f"{' '.join(command)} ended with {done.returncode}\n{done.stderr[-4000:]}")
        counts = {}
        for file in pathlib.Path(folder).glob("out*"):
            lines = file.read_text(errors="replace").splitlines()
            trigger = [line.rpartition(" ")[2] for line in lines if line.startswith("desc: Trigger: Client Request: ")]
            totals = [int(line.split()[1]) for line in lines if line.startswith("totals: ")]
            if trigger:
                counts[trigger[0]] = totals[0]
    return counts


def count_steps(program):
    """{workload: instructions} by AVX-512, None where they cannot be counted."""
    done = subprocess.run([program, "--steps"], capture_output=True, text=True)
    if done.returncode == SKIPPED:
        return None
    if done.returncode != 0:
        sys.exit(f"{program} --steps ended with {done.returncode}\n{done.stderr[-4000:]}")
    return json.loads(done.stdout)


def judge(what, counts, budgets):
    """Prints a line a workload; the number of faults."""
    faults = 0
    print(f"{what:<24} {'budget':>13} {'now':>13} {'change':>8}")
    for name in sorted(budgets.keys() | counts.keys()):
        if name not in counts or name not in budgets:
            faults += 1
            print(f"{name:<24} {'is not measured' if name not in counts else 'has no budget'}")
            continue
        change = counts[name] / budgets[name] - 1
        verdict = "too much" if change > TOLERANCE else "less: bless it, so that it stays" if change < -TOLERANCE else ""
        faults += change > TOLERANCE
        print(f"{name:<24} {budgets[name]:>13} {counts[name]:>13} {100 * change:>+7.2f}% {verdict}".rstrip())
    return faults


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--bless", action="store_true")
    options = parser.parse_args(arguments)
    program = str(pathlib.Path(options.program).resolve())
    try:
        made = made_with(program)
        golden = json.loads(BUDGETS.read_text()) if BUDGETS.exists() else {"made_with": {}, "instructions": {}}
        if not options.bless and made != golden["made_with"]:
            raise Skip(f"budgets hold for {golden['made_with']}, this is {made}")
        counts, steps = count(program), count_steps(program)
    except Skip as reason:
        print("skipped:", reason)
        return SKIPPED
    if not counts:
        sys.exit("valgrind counted nothing")
    faults = judge("AVX2", counts, golden["instructions"])
    if steps is None:
        print("AVX-512: not counted on this machine")
        steps = golden.get("instructions_avx512", {})
    else:
        faults += judge("AVX-512", steps, golden.get("instructions_avx512", {}))
    if options.bless:
        new = {"made_with": made, "instructions": dict(sorted(counts.items())), "instructions_avx512": dict(sorted(steps.items()))}
        BUDGETS.write_text(json.dumps(new, indent=1) + "\n")
        print(f"wrote {BUDGETS}")
        return 0
    if faults:
        print(f"{faults} faults. Where that is meant: {sys.executable} {pathlib.Path(__file__)} --program {options.program} --bless, and commit the file")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
