"""Lists the cases, or runs one: exit code 0 passed, 1 failed, 77 skipped."""

import argparse
import importlib
import pathlib
import sys

import harness

HERE = pathlib.Path(__file__).resolve().parent
LAB = HERE.parent / "lab/cli" # of subcommands of burnish-lab and of scripts in bench/lab
sys.path.append(str(LAB))
FILES = {path.stem: path for folder in (HERE, LAB) for path in sorted(folder.glob("*_cases.py"))}
MODULES = sorted(FILES)


def load(modules, data):
    """Registers the cases of these modules."""
    for module in map(importlib.import_module, modules):
        if hasattr(module, "add_data_cases"):
            module.add_data_cases(data)


def load_case(name, data):
    """Registers a case, from the modules that write its name, or as much of it as is not made up. To compile them all takes a second."""
    area, _, claim = name.partition(".")
    parts = [f'"{name}"', f'"{claim}"', *([f'"{area}.{claim.rpartition(".")[0]}.'] if "." in claim else [])]
    load([module for module in MODULES if any(part in FILES[module].read_text() for part in parts)], data)
    if name not in harness.CASES:
        load(MODULES, data)


parser = argparse.ArgumentParser()
parser.add_argument("--program", default="")
parser.add_argument("--compare-program", default="")
parser.add_argument("--data", required=True, action="append", type=pathlib.Path, help="test data; of two files of a name the first counts")
parser.add_argument("--work", default="")
parser.add_argument("--sanitized", action="store_true")
parser.add_argument("--list", action="store_true")
parser.add_argument("case", nargs="?")
arguments = parser.parse_args()

if arguments.list:
    load(MODULES, arguments.data)
    for name, (_, labels) in harness.CASES.items():
        print(name, ",".join(labels))
    sys.exit(0)

load_case(arguments.case, arguments.data)
bench = harness.Bench(arguments.program, arguments.compare_program, arguments.data, arguments.work, arguments.sanitized)
bench.open(arguments.case)
try:
    harness.CASES[arguments.case][0](bench)
except harness.Skipped as reason:
    print("skipped:", reason)
    sys.exit(77)
except harness.Failed as reason:
    print("failed:", reason)
    sys.exit(1)
