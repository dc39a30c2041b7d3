"""What the tests of a build cost: CPU seconds of each, run one after the other, and the sum of each tier. Other work on the machine hardly
changes CPU time, so this is what tiers are judged by.

Usage: costs.py BUILD_FOLDER [CTEST-ARGUMENT...]    for instance: costs.py build/release -L '^quick$'"""

import collections
import json
import os
import subprocess
import sys
import time

TIERS = ("quick", "check", "gate", "slow")


def cost_of(test):
    """(CPU seconds, wall seconds, exit code)"""
    properties = {entry["name"]: entry["value"] for entry in test.get("properties", [])}
    environment = {**os.environ, **dict(entry.split("=", 1) for entry in properties.get("ENVIRONMENT", []))}
    begin = time.monotonic()
    child = subprocess.Popen(test["command"], cwd=properties.get("WORKING_DIRECTORY"), env=environment, stdin=subprocess.DEVNULL,
                             stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    return usage.ru_utime + usage.ru_stime, time.monotonic() - begin, child.returncode


def main():
    listed = subprocess.run(["ctest", "--test-dir", *sys.argv[1:], "--show-only=json-v1"], capture_output=True, check=True, text=True).stdout
    sums = collections.defaultdict(lambda: [0, 0.0])
    for test in json.loads(listed)["tests"]:
        labels = [value for entry in test.get("properties", []) if entry["name"] == "LABELS" for value in entry["value"]]
        tier = next((tier for tier in TIERS if tier in labels), "none")
        cpu, wall, code = cost_of(test)
        sums[tier][0] += 1
        sums[tier][1] += cpu
        print(f"{cpu:8.2f} {wall:8.2f} {tier:6} {code:3} {test['name']}", flush=True)
    for tier in TIERS:
        if tier in sums:
            print(f"{tier}: {sums[tier][0]} tests, {sums[tier][1]:.1f} CPU seconds")


if __name__ == "__main__":
    main()
