"""Runs tests of a build and prints the CPU seconds of each, and the sum of each tier. Other work on the machine hardly changes CPU time.

Usage: costs.py BUILD_FOLDER [--jobs N] [CTEST-ARGUMENT...]    for instance: costs.py build/release --jobs 2 -L '^quick$'
--jobs N: tests at a time (1). Exits with 1 if a test fails, or if a test in the tiers quick and check exceeds its budget: BUDGETS, or its label
budget_SECONDS. The last line counts the tests; a test over its budget counts as failed."""

import collections
import concurrent.futures
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time

TIERS = ("quick", "check", "nightly")
BUDGETS = {"quick": 15.0, "check": 15.0}  # CPU seconds
CASE_BUDGET = 2.0  # for a test of the program from outside
SKIPPED = 77
TIMEOUT = 1500.0  # wall seconds, ctest's own default


def labels_of(test):
    return [value for entry in test.get("properties", []) if entry["name"] == "LABELS" for value in entry["value"]]


def budget_of(name, tier, labels):
    own = [float(label.partition("_")[2]) for label in labels if label.startswith("budget_")]
    usual = BUDGETS.get(tier, float("inf"))
    if name.startswith("cli."):
        usual = min(usual, CASE_BUDGET) if tier in BUDGETS else usual
    return max(own, default=usual)


def run(test):
    """Runs a test. Returns its CPU seconds, wall seconds, exit code and output."""
    properties = {entry["name"]: entry["value"] for entry in test.get("properties", [])}
    environment = {**os.environ, **dict(entry.split("=", 1) for entry in properties.get("ENVIRONMENT", []))}
    begin = time.monotonic()
    with tempfile.TemporaryFile("w+", errors="replace") as output:
        # A job in the background ignores Ctrl-C, and so would its children
        child = subprocess.Popen(test["command"], cwd=properties.get("WORKING_DIRECTORY"), env=environment, stdin=subprocess.DEVNULL,
                                 stdout=output, stderr=subprocess.STDOUT, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        late = threading.Timer(float(properties.get("TIMEOUT", TIMEOUT)), child.kill)
        late.start()
        _, status, usage = os.wait4(child.pid, 0)
        late.cancel()
        child.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        text = output.read()
        wanted = properties.get("PASS_REGULAR_EXPRESSION")  # decides in place of the exit code
        code = int(not any(re.search(each, text, re.DOTALL) for each in wanted)) if wanted else child.returncode
        if code == 0 and any(re.search(each, text) for each in properties.get("SKIP_REGULAR_EXPRESSION", [])):
            code = SKIPPED
        return usage.ru_utime + usage.ru_stime, time.monotonic() - begin, code, text


def main():
    words = sys.argv[1:]
    jobs = 1
    if "--jobs" in words:
        at = words.index("--jobs")
        jobs = int(words[at + 1])
        del words[at : at + 2]
    listed = subprocess.run(["ctest", "--test-dir", *words, "--show-only=json-v1"], capture_output=True, check=True, text=True).stdout
    tests = json.loads(listed)["tests"]
    sums = collections.defaultdict(lambda: [0, 0.0])
    failed, over, skipped = [], [], 0
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for test, (cpu, wall, code, output) in zip(tests, pool.map(run, tests)):
            labels = labels_of(test)
            tier = next((tier for tier in TIERS if tier in labels), "none")
            sums[tier][0] += 1
            sums[tier][1] += cpu
            print(f"{cpu:8.2f} {wall:8.2f} {tier:7} {code:3} {test['name']}", flush=True)
            skipped += code == SKIPPED
            if code not in (0, SKIPPED):
                failed.append((test["name"], output))
            budget = budget_of(test["name"], tier, labels)
            if cpu > budget:
                over.append((test["name"], f"{cpu:.1f} s, budget {budget:.1f}"))
    for tier in TIERS:
        if tier in sums:
            print(f"{tier}: {sums[tier][0]} tests, {sums[tier][1]:.1f} CPU seconds")
    for name, output in failed:
        print(f"failed: {name}\n    " + "\n    ".join(output[-3000:].splitlines()))
    for name, figures in over:
        print(f"over budget: {name}: {figures}")
    bad = len({name for name, _ in [*failed, *over]})
    print(f"{len(tests) - bad - skipped} passed, {bad} failed, {skipped} skipped")
    sys.exit(bool(bad) or not tests)


if __name__ == "__main__":
    main()
