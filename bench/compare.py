#!/usr/bin/env python3
"""Compares two runs of the benchmarks: ratios of times with their spread, new to old.

Usage: compare.py OLD.json NEW.json [--threshold PERCENT]

Reads files of bench_frame --json or of bench_micro --benchmark_format=json; both files must be of one kind. A line a
workload: medians, their ratio, and the interval in which the ratio lies with about 95 % confidence, from the rounds of both runs (a single
value is its own interval). A change counts as slower or faster where the ratio is more than PERCENT (3) away from 1 and the interval does
not hold 1; where only the ratio is, the line says unsure. Where the pictures differ it says other pixels.

Exit code: 0 nothing is slower; 1 something is slower, or was measured before and no more; 2 the files cannot be compared.
"""

import argparse
import json
import math
import sys


UNITS = ("ns_fragment", "ns_triangle", "ns_vertex", "ns_pixel")  # bench_micro counters that say more than the time of a whole round


class Unreadable(Exception):
    pass


def load(path):
    """Returns {name: [time of each round]}, {name: hash of the picture}, {fact of the machine: value} and the load average."""
    pixels = {}
    try:
        with open(path, encoding="utf-8") as file:
            data = json.load(file)
        if "workloads" in data:
            times = {f"{row['name']} {row['isa']}": row["cpu_ms_rounds"] for row in data["workloads"]}
            pixels = {f"{row['name']} {row['isa']}": row.get("pixels") for row in data["workloads"]}
            machine = {**{key: data["machine"].get(key) for key in ("processor", "compiler", "build_type")}, "threads": data.get("threads")}
            load_average = data["machine"].get("load_average", -1)
        else:
            times, machine = {}, {"cpus": data["context"]["num_cpus"], "mhz": data["context"].get("mhz_per_cpu")}
            load_average = (data["context"].get("load_avg") or [-1])[0]
            for row in data["benchmarks"]:
                if row.get("run_type", "iteration") == "iteration" and "error_message" not in row:
                    counted = [row[unit] for unit in UNITS if unit in row]
                    times.setdefault(row["name"], []).append(counted[0] if counted else row["cpu_time"])
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise Unreadable(f"{path}: not the figures of a benchmark: {error}") from error
    for name, values in times.items():
        if not values or not all(isinstance(value, (int, float)) and value > 0 for value in values):
            raise Unreadable(f"{path}: {name}: times must be above 0")
    if not times:
        raise Unreadable(f"{path}: no workloads")
    return times, pixels, machine, load_average


def median(values):
    ordered = sorted(values)
    half = len(ordered) // 2
    return ordered[half] if len(ordered) % 2 else (ordered[half - 1] + ordered[half]) / 2


def median_interval(values, confidence=0.95):
    """The narrowest pair of order statistics that holds the median with this confidence (binomial); all values where there are few."""
    ordered, n = sorted(values), len(values)
    below = 0.0  # chance that fewer than `cut` values lie below the median
    cut = 0
    while cut < (n - 1) // 2:
        below += math.comb(n, cut) * 0.5**n
        if 1 - 2 * below < confidence:
            break
        cut += 1
    cut = max(cut - 1, 0)
    return ordered[cut], ordered[n - 1 - cut]


def judge(old, new, threshold):
    """(ratio, least, most, verdict) of two lists of times."""
    ratio = median(new) / median(old)
    (old_low, old_high), (new_low, new_high) = median_interval(old), median_interval(new)
    least, most = new_low / old_high, new_high / old_low
    if ratio > 1 + threshold:
        return ratio, least, most, "slower" if least > 1 else "unsure"
    if ratio < 1 / (1 + threshold):
        return ratio, least, most, "faster" if most < 1 else "unsure"
    return ratio, least, most, ""


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--threshold", type=float, default=3.0, metavar="PERCENT")
    options = parser.parse_args(arguments)
    try:
        (old, old_pixels, old_machine, old_load), (new, new_pixels, new_machine, new_load) = load(options.old), load(options.new)
    except Unreadable as error:
        print(f"compare: {error}", file=sys.stderr)
        return 2
    for key in old_machine:
        if old_machine[key] != new_machine.get(key):
            print(f"warning: {key} differs: {old_machine[key]}, now {new_machine.get(key)}")
    for name, value in (("old", old_load), ("new", new_load)):
        if value > 0.5:
            print(f"warning: the {name} run began at a load average of {value:.2f}")
    both = [name for name in old if name in new]
    if not both:
        print("compare: no workload is in both files", file=sys.stderr)
        return 2
    width = max(len(name) for name in (*old, *new))
    print(f"{'workload':<{width}}  {'old':>10}  {'new':>10}  {'ratio':>7}  interval")
    counts = {"slower": 0, "faster": 0, "unsure": 0, "gone": 0}
    for name in old:
        if name not in new:
            counts["gone"] += 1
            print(f"{name:<{width}}  {median(old[name]):>10.4g}  {'gone':>10}")
            continue
        ratio, least, most, verdict = judge(old[name], new[name], options.threshold / 100)
        if verdict:
            counts[verdict] += 1
        if old_pixels.get(name) and new_pixels.get(name) and old_pixels[name] != new_pixels[name]:
            verdict += " other pixels"
        print(f"{name:<{width}}  {median(old[name]):>10.4g}  {median(new[name]):>10.4g}  {ratio:>7.3f}  {least:.3f} to {most:.3f}  {verdict}".rstrip())
    for name in new:
        if name not in old:
            print(f"{name:<{width}}  {'':>10}  {median(new[name]):>10.4g}  {'':>7}  not measured before")
    mean = math.exp(sum(math.log(median(new[name]) / median(old[name])) for name in both) / len(both))
    print(f"{len(both)} compared, geometric mean {mean:.3f}: " + ", ".join(f"{count} {what}" for what, count in counts.items()))
    return 1 if counts["slower"] or counts["gone"] else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
