#!/usr/bin/env python3
"""Compares lobe_line's pictures with the reference's: patterns of the error, flicker, instructions. aims.py has the mean error.

Usage: lobe_line.py --program build/release/burnish [--instructions build/release/bench_instructions] [--env FILE|FOLDER]... [--work FOLDER]
                    [--quick] [--json FILE]

  - Patterns: the error less its mean over 5x5 and 17x17 pixels, correlated with itself. At a lag of one and of two pixels: a checker that
    quads leave correlates more at two than at one. Up to 16 pixels: bands are a rise after the first fall. Beside it stand the figures
    of the reference's own noise.
  - Flicker: mean FLIP from frame to frame as the camera moves by a tenth of a degree, less the reference's.
  - Instructions of a frame under valgrind, which do not depend on the machine's other work (--instructions).

A stopped run goes on where --work names the same folder. Exit code: 0 measured; 2 something could not be run.
"""

import argparse
import array
import json
import pathlib
import sys
import tempfile

import key_lights
from key_lights import mean, run

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "instructions"))
import count as instructions  # noqa: E402

TUNED = ("builtin:studio", "workshop_1k.hdr", "blender_studio_1k.exr")  # environments used to choose the constants
UNSEEN = ("low_sun.hdr", "blender_city_1k.exr", "pmndrs_lobby_512.exr")
TECHNIQUES = ("lobe_line", "major_axis_weighted")
LOOKS = (("builtin:studio", 0.4, 0.8), ("builtin:studio", 0.5, -0.9), ("low_sun.hdr", 0.4, 0.8), ("low_sun.hdr", 0.63, 0.8))


def read_pfm(path):
    """(width, height, luminance by row from below)"""
    data = pathlib.Path(path).read_bytes()
    kind, size, _, pixels = data.split(b"\n", 3)
    assert kind == b"PF", path
    width, height = map(int, size.split())
    rgb = array.array("f", pixels)
    return width, height, [0.2126 * rgb[i] + 0.7152 * rgb[i + 1] + 0.0722 * rgb[i + 2] for i in range(0, len(rgb), 3)]


def picture(program, folder, environment, roughness, eta, words, scene="builtin:spheres", size="160x90"):
    name = "_".join([pathlib.Path(environment).stem.replace(":", "_"), str(roughness), str(eta), *words, scene.partition(":")[2], size])
    path = folder / (name.replace("-", "").replace(",", "_").replace("/", "_") + ("m" if eta < 0 else "") + ".pfm")
    if not path.exists():
        run([program, "render", scene, "--env", environment, "--roughness", roughness, f"--anisotropy={eta}", "--size", size, "--msaa", "4",
             "--no-background", "-t", "1", "-q", *words, "-o", path])
    return path


def less_its_mean(field, inside, width, height, half):
    """Returns a field (0 outside of the surface) less its mean over the window around each pixel."""
    def sums(values):
        table = [[0.0] * (width + 1)]
        for y in range(height):
            row, total = [0.0], 0.0
            for x in range(width):
                total += values[y * width + x]
                row.append(table[-1][x + 1] + total)
            table.append(row)
        return table

    def window(table, x, y):
        x0, x1, y0, y1 = max(x - half, 0), min(x + half + 1, width), max(y - half, 0), min(y + half + 1, height)
        return table[y1][x1] - table[y0][x1] - table[y1][x0] + table[y0][x0]

    light, pixels = sums(field), sums(inside)
    return [field[i] - window(light, i % width, i // width) / window(pixels, i % width, i // width) if inside[i] else 0.0
            for i in range(width * height)]


def correlation(field, inside, width, height, lag):
    """With itself, shifted along rows and along columns; the mean of both."""
    products = squares = 0.0
    for dx, dy in ((lag, 0), (0, lag)):
        for y in range(height - dy):
            for x in range(width - dx):
                i, j = y * width + x, (y + dy) * width + x + dx
                if inside[i] and inside[j]:
                    products += field[i] * field[j]
                    squares += 0.5 * (field[i] ** 2 + field[j] ** 2)
    return products / max(squares, 1e-30)


def pattern(reference, test, width, height):
    """{rms, one, two, rise} of the relative error."""
    dim = 0.1 * mean([v for v in reference if v > 0.0])
    inside = [1.0 if v > 0.0 else 0.0 for v in reference]
    error = [(b - a) / (a + dim) if i else 0.0 for a, b, i in zip(reference, test, inside)]
    fine = less_its_mean(error, inside, width, height, 2)
    coarse = less_its_mean(error, inside, width, height, 8)
    lags = [correlation(coarse, inside, width, height, lag) for lag in range(1, 17)]
    rise = max(lags[k] - min(lags[: k + 1]) for k in range(len(lags)))
    return {"rms": mean([e * e for e, i in zip(fine, inside) if i]) ** 0.5, "one": correlation(fine, inside, width, height, 1),
            "two": correlation(fine, inside, width, height, 2), "rise": rise}


def patterns(program, folder, environments, samples):
    print("\npatterns of the error (rms of what is finer than 5 pixels; correlation at 1 and 2 pixels; rise of it up to 16)")
    rows = []
    for wanted, roughness, eta in LOOKS:
        environment = next((e for e in environments if e.endswith(wanted)), None)
        if not environment:
            continue
        pictures = {"reference": picture(program, folder, environment, roughness, eta, ("--backend", "reference", "--samples", samples)),
                    "noise": picture(program, folder, environment, roughness, eta, ("--backend", "reference", "--samples", samples, "--seed", "7"))}
        for technique in TECHNIQUES:
            pictures[technique] = picture(program, folder, environment, roughness, eta, ("--technique", technique, "--samples", "16"))
        width, height, reference = read_pfm(pictures.pop("reference"))
        for name, path in pictures.items():
            p = pattern(reference, read_pfm(path)[2], width, height)
            print(f"{pathlib.Path(environment).name} roughness {roughness} eta {eta:+} {name:<20} rms {p['rms']:.4f}  "
                  f"one {p['one']:+.3f}  two {p['two']:+.3f}  rise {p['rise']:.3f}")
            rows.append({"env": wanted, "roughness": roughness, "anisotropy": eta, "name": name, **p})
    return rows


def flicker(program, folder, environments, samples, frames):
    print("\nflicker: mean FLIP from frame to frame, a tenth of a degree apart")
    rows = []
    for wanted, roughness, eta in LOOKS:
        environment = next((e for e in environments if e.endswith(wanted)), None)
        if not environment:
            continue
        found = {}
        for name, words in (("reference", ("--backend", "reference", "--samples", samples)), *((t, ("--technique", t, "--samples", "16")) for t in TECHNIQUES)):
            files = [picture(program, folder, environment, roughness, eta, (*words, "--orbit", f"{35 + 0.1 * k:.1f},28"), size="96x54") for k in range(frames)]
            found[name] = mean([json.loads(run([program, "compare", a, b, "--metric", "flip-hdr", "--json", "-", "-q", "-t", "1"]))["flip_mean"]
                                for a, b in zip(files, files[1:])])
        print(f"{pathlib.Path(environment).name} roughness {roughness} eta {eta:+}  " +
              "  ".join(f"{name} {value:.4f}" for name, value in found.items()))
        rows.append({"env": wanted, "roughness": roughness, "anisotropy": eta, **found})
    return rows


def count_instructions(program, etas):
    print("\ninstructions of a frame, millions, roughness 0.5, and their ratio to major_axis_weighted with 16 samples")
    names = [(t, n) for t, n in (("lobe_line", 16), ("lobe_line", 14), ("lobe_line", 12), ("major_axis_weighted", 16), ("bent_normal", 1), ("split_isotropic", 1))]
    counts = instructions.count(str(program), *(f"{t}:{n}:0.5:{eta}" for eta in etas for t, n in names))
    for t, n in names:
        row = [counts[f"{t}:{n}:0.5:{eta}"] for eta in etas]
        base = [counts[f"major_axis_weighted:16:0.5:{eta}"] for eta in etas]
        print(f"{t:<20} {n:>2}  " + "  ".join(f"{eta}: {c / 1e6:.2f} ({c / b:.2f})" for eta, c, b in zip(etas, row, base)) +
              f"  all {sum(row) / sum(base):.2f}")
    return counts


def six(folder, quick, given=()):
    """The environments of the tables: three that constants were chosen on and three that none was, or those given."""
    sky = folder / "low_sun.hdr"
    if not sky.exists():
        key_lights.write_sky(sky, key_lights.low_sun, 512 if quick else 1024)
    if given:
        return key_lights.environments_of(given)
    known = {pathlib.Path(e).name: e for e in (*key_lights.environments_of([]), str(sky))}
    known["builtin:studio"] = "builtin:studio"
    return [known[e] for e in (*TUNED, *UNSEEN) if e in known and (not quick or known[e] in ("builtin:studio", str(sky)))]


def main():
    parser = argparse.ArgumentParser(description="lobe_line against the reference: patterns, flicker, instructions")
    parser.add_argument("--program", required=True, type=pathlib.Path)
    parser.add_argument("--instructions", type=pathlib.Path, help="bench_instructions")
    parser.add_argument("--env", action="append", default=[], help="environments or folders, instead of six")
    parser.add_argument("--work", type=pathlib.Path, help="folder for skies and pictures; a temporary one")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--json", type=pathlib.Path)
    given = parser.parse_args()
    program = given.program.resolve()
    with tempfile.TemporaryDirectory() as temporary:
        folder = given.work or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        environments = six(folder, given.quick, given.env)
        samples, frames = ("64", 2) if given.quick else ("1024", 5)
        result = {"patterns": patterns(program, folder, environments, samples), "flicker": flicker(program, folder, environments, samples, frames)}
        if given.instructions:
            result["instructions"] = count_instructions(given.instructions.resolve(), ("0.8",) if given.quick else ("-0.9", "-0.5", "0.5", "0.8", "0.95"))
    if given.json:
        given.json.write_text(json.dumps(result, indent=1))
    return 0


if __name__ == "__main__":
    sys.exit(main())
