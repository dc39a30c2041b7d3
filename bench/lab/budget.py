#!/usr/bin/env python3
"""How well `burnish render --budget` keeps its word: predicted against measured errors, and instructions against fixed settings.

Usage: budget.py --program build/release/burnish [--cases N] [--models FOLDER] [--environments FOLDER] [--work FOLDER] [--markdown FILE]

Draws seeded cases: a scene, its materials as they are or with one roughness and anisotropy, an environment, a view. Scenes and environments
of the first two thirds never come back in the last third. A case's reference is mc with many samples, by the same renderer, so that techniques
alone are judged; the reference's noise is measured and taken out, and cases with a noise above half the budget are left out. Per budget:

  - broken: share of pictures above the budget, and the worst picture's error over the budget;
  - factor: 98 % of the errors of the first two thirds lie below their prediction times the factor (split conformal prediction; Papadopoulos
    et al. 2002, "Inductive Confidence Machines for Regression"). The program multiplies its predictions by kPlanSafety;
  - tails: the same two for the 99th percentile, by --budget-p99;
  - instructions: of the plan, over the cheapest setting that holds the budget for all materials of the case; over the cheapest single
    setting that holds the budget in 98 % of all cases; over the default technique.

What is stopped goes on where --work names the same folder. Exit code: 0 measured; 2 something could not be run.
"""

import argparse
import json
import pathlib
import random
import re
import subprocess
import sys
import tempfile

SIZE = "480x270"
BUDGETS = (0.1, 0.03, 0.01)
TAILS = (0.5, 0.3, 0.2)  # of the 99th percentile
REFERENCE, NOISY = 4096, 1024  # samples of mc
EXACT_LIGHTS = {"builtin:lights": ("--area-lights", "mc", "--light-samples", 1024)}  # of the reference
BUILTINS = ("teapot", "spheres", "sphere", "plate", "bumps", "lacquer", "shaderballs", "lights")
UNSEEN_BUILTINS = ("bumps", "shaderballs")
FIXED = [("split_isotropic", 1), ("bent_normal", 1), ("major_axis_weighted", 4), *(("lobe_line", n) for n in (5, 9, 17, 36, 64)),
         *(("mc", n) for n in (512, 1024))]


class Failed(Exception):
    pass


def case_of(index, count, models, environments):
    """Options of a case. The last third takes scenes and environments that no other case takes."""
    chance = random.Random(index)
    unseen = index >= 2 * count // 3
    scenes = [f"builtin:{name}" for name in BUILTINS if (name in UNSEEN_BUILTINS) == unseen]
    scenes += [str(m) for i, m in enumerate(models) if (i % 3 == 2) == unseen]
    skies = [e for i, e in enumerate(["builtin:studio", "builtin:sky", *map(str, environments)]) if (i % 3 == 2) == unseen]
    scene, options = chance.choice(scenes), []
    if chance.random() < 0.6:
        options += ["--roughness", f"{chance.uniform(0.1, 0.7):.2f}", f"--anisotropy={chance.uniform(-0.95, 0.95):.2f}"]
    options += ["--orbit", f"{chance.uniform(-180, 180):.0f},{chance.uniform(5, 60):.0f}", "--env", chance.choice(skies),
                "--env-rotation", f"{chance.uniform(0, 360):.0f}"]
    return [scene, *options, "--size", SIZE, "--msaa", "1", "--floor", chance.choice(["off", "stage"])]


class Bench:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def run(self, *words):
        done = subprocess.run([self.program, *map(str, words)], capture_output=True, text=True, timeout=1800)
        if done.returncode != 0:
            raise Failed(f"{' '.join(map(str, words))}: {done.stderr.strip()}")
        return done.stdout

    def picture(self, name, case, *words):
        path = self.folder / name
        if not path.exists():
            self.run("render", *case, *words, "-q", "-o", path)
        return path

    def flips(self, reference, test):
        """The mean, and the 99th percentile."""
        found = re.search(r"flip-hdr +mean ([\d.]+), p99 ([\d.]+)", self.run("compare", reference, test, "--metric", "flip-hdr"))
        return float(found[1]), float(found[2])

    def measure(self, index, case):
        """{"plans": {budget: ...}, "fixed": [[error, instructions]...], "usual": instructions}"""
        kept = self.folder / f"{index}.json"
        if kept.exists():
            return json.loads(kept.read_text())
        lights = EXACT_LIGHTS.get(case[0], ())
        reference = self.picture("reference.pfm", case, "--technique", "mc", "--samples", REFERENCE, *lights)
        noisy = self.picture("noisy.pfm", case, "--technique", "mc", "--samples", NOISY, "--seed", 9, *lights)
        noises = [flip * (NOISY / REFERENCE) ** 0.5 for flip in self.flips(reference, noisy)]  # of the reference

        def errors(path):
            return [max(0.0, flip**2 - noise**2) ** 0.5 for flip, noise in zip(self.flips(reference, path), noises)]

        def plan_by(option, budget):
            plan_file, test = self.folder / "plan.json", self.folder / "test.pfm"
            try:
                self.run("render", *case, "-q", option, budget, "--plan-out", plan_file, "-o", test)
            except Failed as failed:
                if "no setting reaches" not in str(failed):
                    raise
                return None
            plan = json.loads(plan_file.read_text())
            return {**plan, "errors": errors(test)} if plan["materials"] else None

        row = {"case": case, "noise": noises[0], "noise_p99": noises[1], "plans": {}, "tails": {}, "fixed": []}
        for budget in BUDGETS:
            if plan := plan_by("--budget", budget):
                row["plans"][str(budget)] = {"predicted": plan["predicted_flip"], "error": plan["errors"][0], "instructions": plan["instructions"]}
                row["usual"], row["materials"] = plan["usual_instructions"], plan["materials"]
        for budget in TAILS:
            if plan := plan_by("--budget-p99", budget):
                row["tails"][str(budget)] = {"predicted": plan["predicted_p99"], "error": plan["errors"][1], "instructions": plan["instructions"]}
        for technique, samples in FIXED if row["plans"] else ():
            path = self.folder / "fixed.pfm"
            self.run("render", *case, "-q", "--technique", technique, "--samples", samples, "-o", path)
            cost = sum(s["instructions"] for m in row["materials"] for s in m.get("settings", ())
                       if (s["technique"], s["samples"]) == (technique, samples))
            row["fixed"].append([errors(path)[0], cost])
        row.pop("materials", None)
        for name in ("reference.pfm", "noisy.pfm"):
            (self.folder / name).unlink()
        kept.write_text(json.dumps(row))
        return row


def quantile(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, int(share * len(values)))] if values else float("nan")


def table(rows):
    """Lines of Markdown."""
    fit, test = rows[:2 * len(rows) // 3], rows[2 * len(rows) // 3:]
    ratios = lambda part: [p["error"] / p["predicted"] for row in part for p in row["plans"].values() if p["error"] > 2 * row["noise"]]
    lines = [f"{len(rows)} cases, {len(test)} of them with scenes and environments never seen before. Of the seen ones, 98 % of the errors lie",
             f"below {quantile(ratios(fit), 0.98):.2f} of their prediction; of the unseen ones, {quantile(ratios(test), 0.98):.2f}. The median is "
             f"{quantile(ratios(rows), 0.5):.2f}.", "",
             "| budget | pictures | above it | worst over budget | cost over the cheapest fixed setting of a case: median (sum) | over the best single setting | "
             "over the default: median (sum) |", "| --- | --- | --- | --- | --- | --- | --- |"]
    tails = [[(p["error"] / float(budget), p["error"] / p["predicted"]) for row in rows for b, p in row["tails"].items()
              if b == budget and row["noise_p99"] < 0.5 * float(budget)] for budget in map(str, TAILS)]
    lines[2:2] = ["", "| 99th percentile | pictures | above it | worst over budget | 98 % below their prediction times | median |",
                  "| --- | --- | --- | --- | --- | --- |",
                  *(f"| {budget} | {len(t)} | {sum(over > 1 for over, _ in t)} | {max(over for over, _ in t):.2f} | "
                    f"{quantile([r for _, r in t], 0.98):.2f} | {quantile([r for _, r in t], 0.5):.2f} |" for budget, t in zip(TAILS, tails) if t)]
    for budget in map(str, BUDGETS):
        drawn = [row for row in rows if budget in row["plans"] and row["noise"] < 0.5 * float(budget)]
        if not drawn:
            continue
        planned = {id(row): row["plans"][budget] for row in drawn}
        over = [planned[id(row)]["error"] / float(budget) for row in drawn]
        holds = [[i for i, (error, _) in enumerate(row["fixed"]) if error <= float(budget)] for row in drawn]
        both = [(planned[id(row)]["instructions"], min(row["fixed"][i][1] for i in good)) for row, good in zip(drawn, holds) if good]
        singles = [sum(row["fixed"][i][1] for row in drawn) for i in range(len(FIXED))
                   if sum(i in good for good in holds) >= 0.98 * len(drawn)]
        share = lambda a, b: f"{a / b:.2f}" if b else "-"
        middle = lambda values: f"{quantile(values, 0.5):.2f}"
        total = sum(p["instructions"] for p in planned.values())
        lines.append(f"| {budget} | {len(drawn)} | {sum(o > 1 for o in over)} | {max(over):.2f} | "
                     f"{middle([a / b for a, b in both])} ({share(sum(a for a, _ in both), sum(b for _, b in both))}) | "
                     f"{share(total, min(singles)) if singles else 'none holds it'} | "
                     f"{middle([planned[id(row)]['instructions'] / row['usual'] for row in drawn])} ({share(total, sum(row['usual'] for row in drawn))}) |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--cases", type=int, default=300)
    parser.add_argument("--models", type=pathlib.Path)
    parser.add_argument("--environments", type=pathlib.Path)
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("--markdown", type=pathlib.Path)
    options = parser.parse_args()
    models = sorted(options.models.glob("*.glb")) if options.models else []
    environments = sorted(p for p in options.environments.iterdir() if p.suffix in (".hdr", ".exr")) if options.environments else []
    with tempfile.TemporaryDirectory() as scratch:
        bench = Bench(options.program, options.work or pathlib.Path(scratch))
        bench.folder.mkdir(parents=True, exist_ok=True)
        rows = []
        for index in range(options.cases):
            case = case_of(index, options.cases, models, environments)
            try:
                rows.append(bench.measure(index, case))
            except Failed as failed:
                print(f"case {index}: {failed}", file=sys.stderr)
                return 2
            print(f"{index + 1} of {options.cases}: {' '.join(case)}: "
                  + ", ".join(f"{b}: {p['error']:.4f} of {p['predicted']:.4f}" for b, p in rows[-1]["plans"].items())
                  + "; p99 " + ", ".join(f"{b}: {p['error']:.3f} of {p['predicted']:.3f}" for b, p in rows[-1]["tails"].items()), file=sys.stderr)
    lines = table(rows)
    print("\n".join(lines))
    if options.markdown:
        options.markdown.write_text("\n".join(lines) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
