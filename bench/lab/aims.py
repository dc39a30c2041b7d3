#!/usr/bin/env python3
"""Measures the light of environments against its aims: one table of HDR-FLIP to the reference.

Usage: aims.py --program build/release/burnish [--instructions build/release/bench_instructions] [--before PROGRAM] [--env FILE|FOLDER]...
               [--work FOLDER] [--short|--quick] [--json FILE]

Mean HDR-FLIP of `burnish chart` over six environments, half of which no constant was ever chosen on, roughness, eta and two scenes, with
and without extracted lights:

  - lobe_line with as many samples as take no more time than major_axis_weighted with 16: by the instructions of frames of all eta, which
    do not depend on the machine's other work (--instructions), else by the CPU time of the frames, drawn in turn on one thread: the median
    over all places of its ratio.
  - major_axis_weighted as it was: of PROGRAM (--before: an older burnish), else with the overlap that it had (--axis-beta), which flatters
    it, since levels narrower across the grain and the lobe's own albedo stay. Without extracted lights, which there were none of then.
  - bent_normal and split_isotropic, and where they do better.
  - Extracted lights: places that they make worse, and the mean with them over the mean without where there are some and roughness is at most 0.65.
  - The floor: mean FLIP that the references' own noise alone makes.

References are cached beside environments: a second run does not make them again. A stopped run goes on where --work names
the same folder. Exit code: 0 measured, whether aims are met or not; 2 something could not be run.
"""

import argparse
import json
import pathlib
import statistics
import sys
import tempfile

import key_lights
import lobe_line
from lobe_line import instructions
from key_lights import mean, run

OTHERS = ("bent_normal", "split_isotropic")
BEFORE_BETA = "7.37"  # 2.3 / (0.48 * 0.65): makes major_axis_weighted spread along its grain as it did with the old factor 2.3
FULL = {"roughness": "0.2,0.35,0.5,0.65,0.8", "anisotropy": "-0.9,-0.5,-0.2,0.2,0.5,0.8,0.95", "size": "64x36", "samples": "512", "runs": "3"}
SHORT = {"roughness": "0.35,0.65", "anisotropy": "-0.9,0.8", "size": "64x36", "samples": "256", "runs": "1"}
QUICK = {"roughness": "0.5", "anisotropy": "-0.9,0.8", "size": "64x36", "samples": "256", "runs": "3"}
COUNTS = (16, 14, 12, 10)  # candidate sample counts for lobe_line; one is chosen


def places_of(report, value="flip_mean"):
    """{technique, or technique:samples: {(scene, environment, roughness, eta): value}}"""
    found = {}
    for r in report["rows"]:
        s = r["settings"]
        name = r["technique"] + (f":{s['samples']}" if s["samples"] else "")
        found.setdefault(name, {})[(r["scene"], r["env"], s["roughness"], s["anisotropy"])] = r[value]
    return found


def most_within(ratios):
    """The most samples that take no more time, the least where none does."""
    within = [n for n, ratio in ratios.items() if ratio <= 1.0]
    return max(within) if within else min(ratios)


def ratios_of_time(cpu):
    """{samples: time of lobe_line over the time of major_axis_weighted with 16}; cpu: places_of() milliseconds."""
    whole = cpu["major_axis_weighted:16"]
    return {n: statistics.median(t / max(whole[p], 1e-9) for p, t in cpu[f"lobe_line:{n}"].items()) for n in COUNTS if f"lobe_line:{n}" in cpu}


def ratios_of_instructions(program, etas):
    names = [f"lobe_line:{n}" for n in COUNTS] + ["major_axis_weighted:16"]
    found = instructions.count(str(program), *(f"{name}:0.5:{eta}" for name in names for eta in etas))
    sums = {name: sum(found[f"{name}:0.5:{eta}"] for eta in etas) for name in names}
    return {n: sums[f"lobe_line:{n}"] / sums["major_axis_weighted:16"] for n in COUNTS}


def verdict(name, reached, aim, met):
    print(f"{name:<76} {reached:>9}   aim {aim:<8} {'met' if met else 'missed'}")
    return {"aim": name, "reached": reached, "asked": aim, "met": met}


def judge(on, off, before, line, lights):
    """Prints a line an aim; on, off: places_of() with and without extracted lights, before: places; line: lobe_line's name; lights: by environment."""
    mine = on[line]
    of_before, of_bent = (mean(list(mine.values())) / max(mean([rows[p] for p in mine]), 1e-9) for rows in (before, on["bent_normal"]))
    results = [verdict("lobe_line to major_axis_weighted as it was, equal time", f"{of_before:.3f}", "0.55", of_before <= 0.55),
               verdict("lobe_line to bent_normal, both with extracted lights", f"{of_bent:.3f}", "0.35", of_bent <= 0.35)]
    bare = mean(list(mine.values())) / max(mean([off["bent_normal"][p] for p in mine]), 1e-9)
    results.append(verdict("lobe_line to bent_normal without extracted lights", f"{bare:.3f}", "0.35", bare <= 0.35))
    for other in OTHERS:
        lost = sorted(((mine[p] - on[other][p], p) for p in mine if mine[p] >= on[other][p]), reverse=True)
        share = 1.0 - len(lost) / len(mine)
        results.append(verdict(f"lobe_line better than {other}, of {len(mine)} places", f"{100 * share:.1f} %", "98 %", share >= 0.98))
        for gap, (scene, env, roughness, eta) in lost:
            print(f"    not at {pathlib.Path(env).name} {scene} roughness {roughness:.2f} eta {eta:+.2f} by {gap:.4f}")
    worse = sorted(((mine[p] - off[line][p], p) for p in mine if mine[p] > off[line][p] + key_lights.WORSE), reverse=True)
    results.append(verdict(f"places that extracted lights make worse by more than {key_lights.WORSE}, of {len(mine)}", str(len(worse)), "0", not worse))
    for gap, (scene, env, roughness, eta) in worse:
        print(f"    worse at {pathlib.Path(env).name} {scene} roughness {roughness:.2f} eta {eta:+.2f} by {gap:.4f}")
    sharp = [p for p in mine if lights[p[1]] and p[2] <= key_lights.SHARP + 1e-6]
    if sharp:
        ratio = mean([mine[p] for p in sharp]) / max(mean([off[line][p] for p in sharp]), 1e-9)
        results.append(verdict(f"extracted lights on to off, {len(sharp)} places that have some, roughness <= {key_lights.SHARP}", f"{ratio:.3f}", "0.5", ratio <= 0.5))
    return results


def table(on, off, before, noise, line, lights, environments):
    """A line an environment, then those that constants were chosen on, the others, and all."""
    unseen = [e for e in environments if pathlib.Path(e).name in lobe_line.UNSEEN]
    groups = [(pathlib.Path(e).name, [e]) for e in environments]
    groups += [("chosen on", [e for e in environments if e not in unseen]), ("never chosen on", unseen), ("all", environments)]
    columns = (line, "major_axis_weighted:16", *OTHERS)
    print(f"{'mean HDR-FLIP, extracted lights on (off)':<24}  lights" + "".join(f"  {c:>22}" for c in columns) + "  weighted as it was   on/off   worse   floor")
    for name, members in groups:
        inside = [p for p in on[line] if p[1] in members]
        if not inside:
            continue
        has = any(lights[e] for e in members)
        sharp = [p for p in inside if p[2] <= key_lights.SHARP + 1e-6 and lights[p[1]]]
        ratio = mean([on[line][p] for p in sharp]) / max(mean([off[line][p] for p in sharp]), 1e-9) if has else 1.0
        worse = sum(on[line][p] > off[line][p] + key_lights.WORSE for p in inside)
        print(f"{name:<34}  {sum(lights[e] for e in members):>6}" +
              "".join(f"  {mean([on[c][p] for p in inside]):>13.4f} ({mean([off[c][p] for p in inside]):.4f})" for c in columns) +
              f"  {mean([before[p] for p in inside]):>18.4f}  {ratio:>7.2f}  {worse:>6}  {mean([noise[p] for p in inside]):>6.4f}")


def main():
    parser = argparse.ArgumentParser(description="The light of environments: what is aimed at, and what is reached")
    parser.add_argument("--program", required=True, type=pathlib.Path)
    parser.add_argument("--before", type=pathlib.Path, help="an older burnish, for its major_axis_weighted")
    parser.add_argument("--env", action="append", default=[], help="environments or folders, instead of six")
    parser.add_argument("--work", type=pathlib.Path, help="folder for skies and reports; a temporary one")
    parser.add_argument("--instructions", type=pathlib.Path, help="bench_instructions")
    parser.add_argument("--short", action="store_true", help="48 places")
    parser.add_argument("--quick", action="store_true", help="four places")
    parser.add_argument("--json", type=pathlib.Path)
    given = parser.parse_args()
    program, size = given.program.resolve(), QUICK if given.quick else SHORT if given.short else FULL
    with tempfile.TemporaryDirectory() as temporary:
        folder = given.work or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        environments = lobe_line.six(folder, given.quick, given.env)
        scenes = ["builtin:spheres"] if given.quick else ["builtin:spheres", "builtin:teapot"]
        lights = {e: len(json.loads(run([program, "info", "--json", "--env", e]))["environment"]["key_lights"]) for e in environments}
        ratios = ratios_of_instructions(given.instructions.resolve(), size["anisotropy"].split(",")) if given.instructions else {}
        techniques = ",".join(("lobe_line", "major_axis_weighted", *OTHERS))
        counts = ",".join(map(str, sorted({16, most_within(ratios)} if ratios else COUNTS)))
        reports = {k: key_lights.charted(program, folder / f"aims_{k}", scenes, environments, techniques, size, k, counts) for k in ("auto", "off")}
        older, more = (given.before.resolve(), ()) if given.before else (program, ("--axis-beta", BEFORE_BETA))
        was = places_of(key_lights.charted(older, folder / "aims_before", scenes, environments, "major_axis_weighted", size, "off", more=more))
    on, off, before = places_of(reports["auto"]), places_of(reports["off"]), was["major_axis_weighted:16"]
    noise = {(r["scene"], r["env"], r["roughness"], r["anisotropy"]): r["flip_noise"] for r in reports["auto"]["references"]}
    kind = "instructions" if ratios else "CPU time"
    ratios = ratios or ratios_of_time(places_of(reports["off"], "cpu_ms_median"))
    samples = most_within(ratios)
    line = f"lobe_line:{samples}"
    print(f"{kind} of lobe_line's frames to major_axis_weighted's with 16 samples: " + ", ".join(f"{r:.2f} with {n}" for n, r in ratios.items()))
    table(on, off, before, noise, line, lights, environments)
    results = judge(on, off, before, line, lights)
    if given.json:
        rows = [{"scene": p[0], "env": p[1], "roughness": p[2], "anisotropy": p[3], "key_lights": lights[p[1]], "noise": noise[p], "before": before[p],
                 "auto": {t: v[p] for t, v in on.items()}, "off": {t: v[p] for t, v in off.items()}} for p in on[line]]
        given.json.write_text(json.dumps({"samples": samples, "time": ratios, "aims": results, "places": rows}, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
