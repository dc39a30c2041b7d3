#!/usr/bin/env python3
"""Figures of the MIPNet paper (Gauthier et al. 2022) with this program's filters: pictures, FLIP's maps to the reference, levels in false colour.

Usage: mip_figures.py --program build/release/burnish -o FOLDER [--figure N,N,...] [--textures FOLDER] [--size WxH] [--samples N]
                      [--seconds N] [--work FOLDER] [--json FILE]

1: the balls of builtin:shaderballs; 4, 5, 6: materials (--textures, a folder each; a normal map alone is a metal) under Ashikhmin and Shirley's, GGX's and Beckmann's
normals; 8: ridges that become anisotropy, maps of level 2 beside their pictures; 9: the second net seen once and four times in training
(--seconds of CPU time each, 20). FOLDER/figure_N.png is a row a material with a row of FLIP's maps below it, columns as printed; a line a
picture: mean FLIP, the tone curve's picture at 67 pixels a degree. The reference reads all texels, with 2 N samples.
Pictures are drawn small, so that balls show middle levels, and shown three times as large.

Exit code: 0; 2 something could not be run.
"""

import json
import pathlib
import sys

from mip_ablations import Bench, make_ridges
from parallax import read_png, write_png

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
from workbench import arguments, in_folder  # noqa: E402

TIMES = 3
# brdf, filters that stand between the figure and the reference, number of materials
BY_MODEL = {4: ("ashikhmin_shirley", ("baseline", "mipnet"), 5), 5: ("ggx_aniso", ("baseline", "ssgt", "mipnet"), 6),
            6: ("beckmann", ("baseline", "leadr", "mipnet"), 6)}


def picture(path, times=1):
    """Rows of three channels, each pixel so many times each way."""
    rows, channels = read_png(path)
    if channels == 4:
        rows = [b"".join(bytes(row[i:i + 3]) for i in range(0, len(row), 4)) for row in rows]
    if times > 1:
        rows = [b"".join(bytes(row[i:i + 3]) * times for i in range(0, len(row), 3)) for row in rows for _ in range(times)]
    return [bytes(row) for row in rows]


def beside(parts, gap=4):
    """Pictures in a row, on white, those that are lower at the top."""
    height = max(map(len, parts))
    filled = [part + [b"\xff" * len(part[0])] * (height - len(part)) for part in parts]
    return [(b"\xff\xff\xff" * gap).join(part[y] for part in filled) for y in range(height)]


def below(rows, gap=4):
    width = max(len(part[0]) for part in rows)
    white = b"\xff" * width
    return [line + b"\xff" * (width - len(line)) for part in rows for line in (*part, *[white[:len(part[0])]] * gap)]


class Figures(Bench):
    def __init__(self, options, work, folder):
        super().__init__(options, work)
        self.folder, self.figures = folder, []

    def drawn(self, figure, name, words, looks):
        """The reference and each look of a scene; then FLIP's maps, and the levels that the last look reads."""
        o = self.options
        common = ("render", *words, "--frame-map", "quaternion", "--fov", 22, "--size", o.size, "--env-size", 128, "-q")
        self.run(*common, "--backend", "reference", "--reference-textures", "full", "--samples", 2 * o.samples, "-o", "reference.png")
        reference, pictures, maps = picture(self.work / "reference.png", TIMES), [], []
        for look, more in looks:
            self.run(*common, *more, "--technique", "mc", "--samples", o.samples, "--msaa", 8, "-o", "look.png")
            found = json.loads(self.run("compare", "reference.png", "look.png", "--metric", "flip", "--error-map", "map.png", "--json", "-"))
            pictures.append(picture(self.work / "look.png", TIMES))
            maps.append(picture(self.work / "map.png", TIMES))
            self.figures.append({"figure": figure, "scene": name, "look": look, "flip": found["flip_mean"]})
        self.run(*common, *looks[-1][1], "--technique", "mc", "--samples", 1, "--show", "lod", "-o", "lod.png")
        print(f"figure {figure}, {name}: " + ", ".join(f"{row['look']} {row['flip']:.4f}" for row in self.figures[-len(looks):]), flush=True)
        return [beside([*pictures, reference]), beside([*maps, picture(self.work / "lod.png", TIMES)])]

    def write(self, figure, rows, columns):
        path = self.folder / f"figure_{figure}.png"
        write_png(path, below(rows), 3)
        print(f"{path}: {columns}; below them FLIP of each, at the end the level that is read", flush=True)

    def balls(self):
        looks = [(name, ("--mip-filter", name)) for name in ("baseline", "mipnet")]
        rows = [row for camera in ("near", "mid") for row in self.drawn(1, camera, ("builtin:shaderballs", "--camera", camera), looks)]
        self.write(1, rows, "baseline, mipnet, the reference")

    def material(self, folder):
        """The folder, or, where the names in it are none that the program knows, its normal map as a metal of roughness .35."""
        if list(folder.glob("*_normal.*")):
            return folder
        normal, metal = next(folder.glob("*nor*")), self.work / folder.name
        metal.mkdir(exist_ok=True)
        (metal / ("x_normal" + normal.suffix)).write_bytes(normal.read_bytes())
        for name, code in (("metallic", 255), ("roughness", 89)):
            write_png(metal / f"x_{name}.png", [bytes((code,) * 3)], 3)
        return metal

    def materials(self, figure):
        brdf, names, count = BY_MODEL[figure]
        looks = [(name, ("--mip-filter", name, "--fallback", "off")[:4 if name == "mipnet" else 2]) for name in names]
        folders = [f for f in sorted(pathlib.Path(self.options.textures).resolve().iterdir()) if f.is_dir() and list(f.glob("*nor*"))]
        rows = []
        for folder in [folders[i * len(folders) // count] for i in range(min(count, len(folders)))]:
            words = ("builtin:shaderballs", "--camera", "near", "--material", self.material(folder), "--brdf", brdf)
            rows += self.drawn(figure, folder.name, words, looks)
        self.write(figure, rows, ", ".join(names) + ", the reference")

    def transfer(self):
        make_ridges(self.work, 512)
        self.run("bake", "mip", "ridges", "--mip-filter", "mipnet", "--fallback", "off", "-q", "-o", "ridges.mip", "--preview", "maps")
        level = lambda part: picture(next((self.work / "maps").glob(f"*_{part}_02.png")), 2)
        maps = beside([[row[:768] for row in picture(self.work / "ridges/normal.png")[:256]], level("normal"), level("lobe")])
        looks = [("baseline", ("--mip-filter", "baseline")), ("mipnet", ("--mip-filter", "mipnet", "--fallback", "off"))]
        self.write(8, [maps, *self.drawn(8, "ridges", ("builtin:shaderballs", "--camera", "near", "--material", "ridges"), looks)],
                   "above: normals of level 0, normals and lobes of level 2; baseline, mipnet, the reference")

    def occurrences(self):
        make_ridges(self.work, 512)
        looks = []
        for name, levels in (("one", 2), ("four", 5)):
            file, steps, _ = self.train(name, ("--layout", "paper", "--levels", levels))
            looks.append((f"{name} ({steps} steps)", ("--mip-filter", "mipnet", "--fallback", "off", "--mip-net", file)))
        self.write(9, self.drawn(9, "ridges", ("builtin:shaderballs", "--camera", "near", "--material", "ridges"), looks),
                   "the second net seen once, four times, the reference")


def measure(options, work):
    folder = pathlib.Path(options.output).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    figures = Figures(options, work, folder)
    for figure in map(int, options.figure.split(",")):
        if figure in BY_MODEL and not options.textures:
            print(f"figure {figure} is of --textures")
            return 2
        {1: figures.balls, 8: figures.transfer, 9: figures.occurrences}.get(figure, lambda f=figure: figures.materials(f))()
    if options.json:
        pathlib.Path(options.json).write_text(json.dumps(figures.figures, indent=1) + "\n")
    return 0


def main():
    parser = arguments(__doc__)
    parser.add_argument("-o", "--output", required=True)
    parser.add_argument("--figure", default="1,4,5,6,8,9")
    parser.add_argument("--textures")
    parser.add_argument("--size", default="108x72")
    parser.add_argument("--samples", type=int, default=256)
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--brdf", default="ggx_aniso")
    return in_folder(parser.parse_args(), measure)


if __name__ == "__main__":
    sys.exit(main())
