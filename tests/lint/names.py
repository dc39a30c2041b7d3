"""Test names follow one grammar: suite.area.claim_in_words, then a subject: .of_what or /of_what. Every test has one tier.

Usage: names.py BUILD_FOLDER CTEST. Prints one line a fault; exit code 1 where there is any."""

import json
import re
import subprocess
import sys

PART = r"[a-z][a-z0-9]*(_[a-z0-9]+)*"
NAME = re.compile(rf"{PART}\.({PART}/)?{PART}\.(?=\w*_){PART}([./]\w+)*")
TIERS = {"quick", "check", "nightly"}


# Text that CMake appends for a parameter's value, or puts in place of its index.
VALUE = re.compile(r"(  # GetParam\(\) = .*|/\d+-byte object <.*)$")


def faults_of(name, labels):
    name = VALUE.sub("", name)
    if not NAME.fullmatch(name):
        yield f"{name}: not suite.area.claim_in_words"
    if len(TIERS & set(labels)) != 1:
        yield f"{name}: in the tiers {sorted(TIERS & set(labels))}, not in one"


def self_test():
    good = ("unit_simd.half.converts_to_the_float", "unit_models.models/energy_laws.albedo_is_at_most_one/ggx", "cli.input.edit_is_refused.mesh_2")
    bad = ("unit_simd.Half.converts_to_the_float", "unit_simd.half.ConvertsToFloat", "lint.layers", "cli.compare.page", "cli.models.renders_it.Lamp.glb/",
           "unit_simd.half.converts__twice")
    return all(not list(faults_of(name, ["quick", "input"])) for name in good) and all(list(faults_of(name, ["check"])) for name in bad)


def main():
    build, ctest = sys.argv[1:]
    if not self_test():
        print("names.py takes wrong names for right ones, or the other way round")
        return 1
    listed = json.loads(subprocess.run([ctest, "--test-dir", build, "--show-only=json-v1"], capture_output=True, check=True).stdout)
    faults, tests = [], 0
    for test in listed["tests"]:
        labels = [value for entry in test.get("properties", []) if entry["name"] == "LABELS" for value in entry["value"]]
        if test["name"].endswith("_NOT_BUILT"):
            continue
        tests += 1
        faults += faults_of(test["name"], labels)
    print(*faults, f"{tests} tests, {len(faults)} faults", sep="\n")
    return 1 if faults or tests < 100 else 0


if __name__ == "__main__":
    sys.exit(main())
