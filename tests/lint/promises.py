"""Each promise of apps/promises.md names tests, and each of these tests exists.

Usage: promises.py SOURCE BUILD_FOLDER CTEST RUN_CASE_COMMAND... (which lists the program's cases). Names may hold *. Prints one line a
fault; exit code 1 where there is any."""

import fnmatch
import json
import pathlib
import re
import subprocess
import sys

HEADING = "## The promises"


def rows_of(text):
    """Yields (promise, test names) from the tables below the heading, without their heads."""
    section = text.split(HEADING + "\n", 1)[1].split("\n## ", 1)[0]
    for line in section.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if line.startswith("|") and cells[-1] not in ("held by", "---"):
            yield cells[0], re.findall(r"`([^`]+)`", cells[-1])


def faults_of(rows, tests):
    for promise, names in rows:
        if not names:
            yield f"no test: {promise}"
        for name in names:
            if not fnmatch.filter(tests, name):
                yield f"{name}: no such test, which shall hold: {promise}"


def self_test():
    text = f"{HEADING}\n\n| files | held by |\n| --- | --- |\n| One. | `a.b.c`, `a.d.*` |\n| Two. | nothing |\n\n## Other\n| x | `y` |\n"
    found = list(faults_of(rows_of(text), ["a.d.e"]))
    return len(found) == 2 and found[0].startswith("a.b.c:") and found[1] == "no test: Two."


def main():
    source, build, ctest, *list_cases = sys.argv[1:]
    if not self_test():
        print("promises.py does not see what is missing")
        return 1
    listed = json.loads(subprocess.run([ctest, "--test-dir", build, "--show-only=json-v1"], capture_output=True, check=True).stdout)
    tests = [re.sub(r"  # GetParam\(\).*", "", test["name"]) for test in listed["tests"]]
    # Some tests need a second build, and appear in its list alone.
    tests += ["cli." + line.split()[0] for line in subprocess.run(list_cases, capture_output=True, text=True, check=True).stdout.splitlines()]
    rows = list(rows_of(pathlib.Path(source, "apps/promises.md").read_text()))
    faults = list(faults_of(rows, tests))
    print(*faults, f"{len(rows)} promises, {len(faults)} faults", sep="\n")
    return 1 if faults or len(rows) < 20 else 0


if __name__ == "__main__":
    sys.exit(main())
