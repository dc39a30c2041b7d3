#!/usr/bin/env python3
"""Measures the worth of each choice in training nets of mipmaps, at equal CPU time.

Usage: mip_ablations.py --program build/release/burnish [--seconds N] [--brdf NAME] [--only NAMES] [--material FOLDER] [--work FOLDER]
                        [--json FILE]

Each row is a net that `burnish train mip` makes in --seconds of CPU time (60): the time a step takes is measured first, and the steps that
fit are trained, on one thread. A row's command makes the same bytes again. Nets are judged by `--evaluate --validation`: new materials of
trained families, none of those that reports are made of. Columns: FLIP, L1 and MSE times 1000, their change against plain means, how far
the mean radiance of a level is from the reference's (mean of |found / reference - 1|), and how anisotropic level 3 of round ridges is, the mean of
its lobes' greater width over the lesser, as a share of the search `teacher`'s. `--only "two lobes"` is a second table: grain that
crosses below a texel, by the best lobe a texel that a search finds and by the best two, of half the light each.
--material adds three rows that are judged on one material alone: of the first net, of one that is trained on nothing else, and of the first
net trained on from there.

Exit code: 0; 2 something could not be run.
"""

import json
import math
import pathlib
import struct
import sys

from mips import code_of_slope, write_png

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
from workbench import Program, arguments, in_folder  # noqa: E402

# name, training options, the question it answers
ROWS = (
    ("cov", (), "the layout that ships, 2x32/2x64"),
    ("paper", ("--layout", "paper"), "the published layout at the same size"),
    ("single level", ("--size", "2x64"), "H_A alone, 2x2 texels, at every level"),
    ("1 occurrence", ("--levels", "2"), "the loss sees H_B once"),
    ("paper 1 occurrence", ("--layout", "paper", "--levels", "2"), ""),
    ("loss l2", ("--loss", "l2"), ""),
    ("loss charbonnier", ("--loss", "charbonnier"), ""),
    ("tone log", ("--tone", "log"), "log(1 + x) in place of a display's curve"),
    ("narrower", ("--size", "2x16/2x32"), ""),
    ("wider", ("--size", "2x64/2x128"), ""),
    ("shallower", ("--size", "1x32/1x64"), ""),
    ("deeper", ("--size", "3x32/3x64"), ""),
    ("8x8 at once", ("--footprint", "8"), "H_B sees sixty-four texels, too"),
    ("light .1", ("--light", "0.1"), "mean radiance of a level beside what is shown"),
    ("light 1", ("--light", "1"), ""),
    ("mirrored 1", ("--mirrored", "1"), "directions near highlights alone"),
    ("large", ("--size", "2x64/2x128"), "what the next one learns from: three times the seconds"),
    ("distilled", ("--taught-by", "large.mipnet"), "2x32/2x64, which sees what the large one makes, not level 0"),
)
LONGER = {"large": 3}  # factor on --seconds


class Bench(Program):
    def __init__(self, options, work):
        super().__init__(options, work)
        self.options = options

    def train(self, name, words):
        """The name of its file, and the steps that it took."""
        words = ("train", "mip", "--brdf", self.options.brdf, *words, "--threads", "1", "-q")
        spent = [self.timed(*words, "--steps", steps, "-o", "trial.mipnet") for steps in (10, 40)]
        each = (spent[1] - spent[0]) / 30
        steps = max(20, int((LONGER.get(name, 1) * self.options.seconds - (spent[0] - 10 * each)) / each / 10) * 10)
        file = name.replace(" ", "_") + ".mipnet"
        return file, steps, self.timed(*words, "--steps", steps, "-o", file)

    def judged(self, file, *words):
        """Rows of every material."""
        self.run("train", "mip", "--evaluate", file, *words, "--json", "judged.json", "-q")
        return json.loads((self.work / "judged.json").read_text())["rows"]


def mean_of(rows, name):
    """Of a filter's rows; light: how far the mean radiance of a level is from the reference's."""
    rows = [row for row in rows if row["filter"] == name]
    mean = {metric: sum(row["mean"][metric] for row in rows) / len(rows) for metric in ("flip", "l1", "mse")}
    off = [abs(level["light"] - 1) for row in rows for level in row["levels"]]
    return {**mean, "light": sum(off) / len(off)}


def anisotropy(path, level):
    """Mean over a level's texels of the greater width over the lesser, of a file of `burnish bake mip` with one material."""
    data = path.read_bytes()
    width, height, levels = struct.unpack_from("<3I", data, 16 + 20)
    at = 16 + 48
    for l in range(1, level):
        at += 20 * max(1, width >> l) * max(1, height >> l)
    count = max(1, width >> level) * max(1, height >> level)
    total = 0.0
    for _, _, a, b, c in struct.iter_unpack("<5f", data[at:at + 20 * count]):
        mean, spread = (a + b) / 2, math.hypot((a - b) / 2, c)
        total += (mean + spread) ** 2 / (a * b - c * c)
    return total / count


def make_ridges(work, side=128):
    """Waves across u under a round lobe: anisotropy that is in no map, and that one level does not show, since a wave is eight texels long."""
    folder = work / "ridges"
    folder.mkdir(exist_ok=True)
    write_png(folder / "normal.png", lambda x, y: code_of_slope(0.5 * math.sin(2 * math.pi * (x + 0.5) / 8), 0), side, side)
    write_png(folder / "roughness.png", lambda x, y: (90,) * 3, 1, 1)
    write_png(folder / "metallic.png", lambda x, y: (255,) * 3, 1, 1)


def line_of(name, steps, took, mean, base, ratio, note):
    change = " ".join(f"{100 * (mean[m] / base[m] - 1):+.1f}" for m in ("flip", "l1", "mse"))
    figures = f"{1e3 * mean['flip']:.1f} | {1e3 * mean['l1']:.2f} | {1e3 * mean['mse']:.2f} | {change} % | {mean['light']:.3f}"
    print(f"| {name} | {steps} | {took:.0f} s | {figures} | {ratio} | {note} |", flush=True)


def two_lobes(rows):
    """L1 of crossed grain, times 1000, by the best lobe of a texel and by the best two."""
    print("\n| crossed grain | baseline | mipnet | one lobe | two | |\n| --- | --- | --- | --- | --- | --- |")
    for material in sorted({row["material"] for row in rows}):
        l1 = {row["mip_filter"]: 0 for row in rows}
        for row in rows:
            if row["material"] == material:
                l1[row["mip_filter"]] += row["l1"] / 5
        of = [l1[name] for name in ("baseline", "mipnet", "teacher", "two lobes")]
        print(f"| {material} | " + " | ".join(f"{1e3 * x:.2f}" for x in of) + f" | {100 * (of[3] / of[2] - 1):+.0f} % |", flush=True)
    return rows


def measure(options, work):
    bench, kept = Bench(options, work), []
    make_ridges(work)
    ridges = ("bake", "mip", "ridges", "--brdf", options.brdf, "-q", "-o", "ridges.mip", "--mip-filter")
    bench.run(*ridges, "teacher")
    reference = anisotropy(work / "ridges.mip", 3)
    print("| net | steps | CPU | FLIP | L1 | MSE | to plain means | light | anisotropy | |")
    print("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |")
    wanted = [name for name in options.only.split(",") if name]
    for name, words, note in ROWS:
        if wanted and name not in wanted:
            continue
        file, steps, took = bench.train(name, words)
        bench.run(*ridges, "mipnet", "--fallback", "off", "--mip-net", file)
        ratio = anisotropy(work / "ridges.mip", 3) / reference
        rows = bench.judged(file, "--validation")
        mean, base = mean_of(rows, "mipnet"), mean_of(rows, "baseline")
        line_of(name, steps, took, mean, base, f"{ratio:.2f}", note)
        kept.append({"net": name, "steps": steps, "cpu_s": took, "options": words, "mean": mean, "baseline": base, "anisotropy": ratio})
    if not wanted or "two lobes" in wanted:
        bench.run("chart", "--mip", "--two-lobes", "--brdf", options.brdf, "-q", "-o", "crossed")
        kept += two_lobes(json.loads((work / "crossed/mip.json").read_text()))
    if options.material:
        one = pathlib.Path(options.material).resolve()
        only = work / "only"
        only.mkdir(exist_ok=True)
        if not (only / one.name).exists():
            (only / one.name).symlink_to(one)
        first = work / "cov.mipnet"
        if not first.exists():
            bench.train("cov", ())
        for name, words, note in ((f"cov on {one.name}", None, "never trained on it"), (f"overfitted to {one.name}", ("--only-maps", "only"), ""),
                                  (f"pretrained, then {one.name}", ("--only-maps", "only", "--from", "cov.mipnet"), "fine-tuned")):
            file, steps, took = bench.train(name, words) if words else ("cov.mipnet", 0, 0)
            rows = [row for row in bench.judged(file, "--maps", "only") if row["set"] == "real"]
            mean, base = mean_of(rows, "mipnet"), mean_of(rows, "baseline")
            line_of(name, steps or "", took, mean, base, "", note)
            kept.append({"net": name, "steps": steps, "cpu_s": took, "options": words, "mean": mean, "baseline": base})
    if options.json:
        pathlib.Path(options.json).write_text(json.dumps(kept, indent=1) + "\n")
    return 0


def main():
    parser = arguments(__doc__)
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--brdf", default="ggx_aniso")
    parser.add_argument("--only", default="")
    parser.add_argument("--material")
    return in_folder(parser.parse_args(), measure)


if __name__ == "__main__":
    sys.exit(main())
