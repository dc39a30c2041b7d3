"""A case of the program in quick or check that takes more than 10 CPU seconds gives the reason in its docstring. Cases of the laboratory take less
than 13.

Usage: budgets.py SOURCE TEST_DATA. Prints one line a fault; exit code 1 where there is any."""

import importlib
import pathlib
import sys

LONG, OF_LAB = 10, 13  # CPU seconds


def faults_of(cases):
    """Yields the faults of {name: (function, labels)}."""
    for name, (function, labels) in cases.items():
        budget = max((float(label.partition("_")[2]) for label in labels if label.startswith("budget_")), default=0)
        if "nightly" in labels or budget <= LONG:
            continue
        if not (function.__doc__ or "").strip():
            yield f"{name}: {budget:g} seconds, and no docstring that gives the reason"
        if budget >= OF_LAB and "/lab/cli/" in function.__code__.co_filename:
            yield f"{name}: {budget:g} seconds in the laboratory, where nightly begins at {OF_LAB}"


def self_test():
    def told():
        """Compiles much."""

    cases = {"a.b": (told, ("check", "budget_11")), "a.c": (lambda: 0, ("nightly", "budget_90")), "a.d": (lambda: 0, ("quick",)),
             "a.e": (lambda: 0, ("check", "budget_11"))}
    return [fault.partition(":")[0] for fault in faults_of(cases)] == ["a.e"]


def main():
    source, data = map(pathlib.Path, sys.argv[1:])
    if not self_test():
        print("budgets.py does not see a budget without a reason")
        return 1
    folders = [source / "tests/cli", source / "tests/lab/cli"]
    sys.path[:0] = map(str, folders)
    harness = importlib.import_module("harness")
    for path in sorted(path for folder in folders for path in folder.glob("*_cases.py")):
        module = importlib.import_module(path.stem)
        if hasattr(module, "add_data_cases"):
            module.add_data_cases([data])
    faults = list(faults_of(harness.CASES))
    print(*faults, f"{len(harness.CASES)} cases, {len(faults)} faults", sep="\n")
    return 1 if faults or len(harness.CASES) < 100 else 0


if __name__ == "__main__":
    sys.exit(main())
