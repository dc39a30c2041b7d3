"""Laws of steps: along options, through points where a jump might occur, images change no faster than the reference, and no step exceeds
its row. BREACHES holds the violations with their size. Their present size is printed."""

import csv
import io
import os
import pathlib

from chart_cases import needs_embree
from harness import case, check
from law_cases import LIGHT, SIDE, lobes, names_of

MORE, NOISE = 1.5, 2e-4  # a step may exceed the reference's step, or its row's median, by this factor plus this amount

# Options that move through their special points, in steps with little change between images: animated option, other options, number of
# images. An amount follows a failure scene's name (core/lab/failure_scenes.cpp).
PATHS = {
    "anisotropy through 0": ("anisotropy=-0.005:0.005", "builtin:sphere --roughness 0.4", 11),
    "anisotropy to 1": ("anisotropy=0.99:1", "builtin:sphere --roughness 0.4", 11),
    "anisotropy through an eighth": ("anisotropy=0.06:0.07", "builtin:sphere --roughness 0.4", 11),
    "roughness to 0": ("roughness=0.01:0", "builtin:sphere --anisotropy 0.6", 11),
    "roughness to 1": ("roughness=0.99:1", "builtin:sphere --anisotropy 0.6", 11),
    "roughness where counts change": ("roughness=0.4:0.42", "builtin:sphere --anisotropy 0.8", 21),
    "tilt through 0": ("tilt=-0.5,0:0.5,0", "builtin:sphere --roughness 0.4 --anisotropy 0.5", 11),
    "environment through a whole turn": ("env-rotation=359.5:360.5", "builtin:sphere --roughness 0.4 --anisotropy 0.5", 11),
    "sun over the horizon": ("env-rotation=170:190", "builtin:plate --env builtin:sky --roughness 0.3 --anisotropy 0.5", 21),
    "eye across a plane of symmetry": ("eye=-0.005,0.25,0.6:0.005,0.25,0.6", "builtin:sphere --target 0,0,0 --roughness 0.4 --anisotropy 0.8", 11),
    "distance": ("zoom=0.995:1.005", "builtin:sphere --roughness 0.4 --anisotropy 0.5", 11),
}
# Paths that end where lobes change ever faster. No step is typical there, so a row's limit also includes the reference's steps.
ENDS = {"anisotropy to 1", "roughness to 0", "roughness to 0 by lamps"}
# Options of single techniques, unknown to the reference. Their limit is their own row alone.
OWN_PATHS = {
    "axis-k": ("axis-k=0.995:1.005", "builtin:sphere --roughness 0.4 --anisotropy 0.8", 11, "major_axis"),
    "axis-beta": ("axis-beta=2.2:2.4", "builtin:sphere --roughness 0.4 --anisotropy 0.8", 11, "major_axis"),
    "axis-beta to 0": ("axis-beta=0.01:0", "builtin:sphere --roughness 0.4 --anisotropy 0.8", 11, "major_axis"),
}
# Paths for every model of --brdf, by mc.
MODEL_PATHS = ("anisotropy through 0", "roughness to 0", "roughness to 1", "tilt through 0")
SINKING = "builtin:sinking-lamp --env builtin:night --eye 0,-0.3,0.4 --target 0,0,0 --fov 20"  # without the lamp's surface
# Paths for every area light method. A lamp touches the plate's plane with its lower edge and leaves with its upper edge, in steps of 1/200
# of the height.
AREA_PATHS = {
    "anisotropy through 0 by lamps": ("anisotropy=-0.005:0.005", "builtin:lights --roughness 0.4", 11),
    "roughness to 0 by lamps": ("roughness=0.01:0", "builtin:lights --anisotropy 0.6", 11),
    "eye around lamps": ("eye=0,1.2,2.4:0.02,1.2,2.4", "builtin:lights --target 0,0.2,0 --roughness 0.4 --anisotropy 0.6", 11),
    "lamp that touches the horizon": ("amount=0.105:0.095", SINKING, 11),
    "lamp that leaves": ("amount=-0.095:-0.105", SINKING, 11),
}
SHORT = (("lobe_line", "anisotropy through 0"), ("bent_normal", "anisotropy through 0"), ("auto", "anisotropy through an eighth"),
         ("major_axis_adaptive", "roughness where counts change"), ("split_isotropic", "environment through a whole turn"),
         ("filtered_is_ggx", "tilt through 0"))

SPREAD = 1.05  # a breach may grow by this factor; a smaller breach may stay in the table

# (technique, model or method; path): the largest step divided by the allowed step, against the reference and against the row's median; 0:
# within the limit.
# - Where eta changes its sign the lobe's axes swap, and with them the sample pattern (noise, which more samples reduce) and line ends.
# - Near roughness 0 the reference's lobe is narrower than all visible detail and its images stay equal, while cube levels continue evenly
# to the finest.
# - At eta 1 lines of samples grow faster than the lobe, whose other width has no lower limit.
# - split_isotropic leaves the untilted GGX lobe for lights and albedo in a step of a thousandth.
# - Transformed cosines leave light from a lamp below the horizon, where it is dark.
BREACHES = {
    ("auto", "anisotropy through 0"): (2.29, 0),
    ("auto", "anisotropy to 1"): (4.56, 2.95),
    ("auto", "anisotropy through an eighth"): (1.40, 0),
    ("auto", "roughness to 0"): (61.24, 0),
    ("auto", "eye across a plane of symmetry"): (1.24, 0),
    ("split_isotropic", "anisotropy through 0"): (0, 4.68),
    ("split_isotropic", "roughness to 0"): (79.72, 0),
    ("split_isotropic", "tilt through 0"): (3.42, 3.75),
    ("split_isotropic", "sun over the horizon"): (1.19, 0),
    ("bent_normal", "anisotropy through 0"): (1.15, 0),
    ("bent_normal", "anisotropy to 1"): (3.97, 3.97),
    ("bent_normal", "anisotropy through an eighth"): (1.18, 0),
    ("bent_normal", "roughness to 0"): (111.57, 1.36),
    ("bent_normal", "eye across a plane of symmetry"): (1.20, 0),
    ("major_axis", "anisotropy through 0"): (0, 1.25),
    ("major_axis", "anisotropy to 1"): (1.45, 1.45),
    ("major_axis", "roughness to 0"): (72.12, 0),
    ("major_axis", "sun over the horizon"): (1.04, 0),
    ("major_axis", "eye across a plane of symmetry"): (1.01, 0),
    ("major_axis_adaptive", "anisotropy to 1"): (1.16, 1.16),
    ("major_axis_adaptive", "roughness to 0"): (74.65, 0),
    ("major_axis_adaptive", "sun over the horizon"): (1.00, 0),
    ("major_axis_weighted", "anisotropy to 1"): (1.26, 1.26),
    ("major_axis_weighted", "roughness to 0"): (62.42, 0),
    ("major_axis_weighted", "eye across a plane of symmetry"): (1.05, 0),
    ("lobe_line", "anisotropy through 0"): (2.74, 2.91),
    ("lobe_line", "anisotropy to 1"): (4.56, 2.95),
    ("lobe_line", "anisotropy through an eighth"): (1.40, 0),
    ("lobe_line", "roughness to 0"): (61.24, 0),
    ("lobe_line", "eye across a plane of symmetry"): (1.24, 0),
    ("filtered_is", "anisotropy to 1"): (1.81, 1.39),
    ("filtered_is", "roughness where counts change"): (1.15, 0),
    ("filtered_is", "sun over the horizon"): (1.08, 0),
    ("filtered_is", "eye across a plane of symmetry"): (1.51, 0),
    ("filtered_is_ggx", "anisotropy through 0"): (11.12, 13.62),
    ("filtered_is_ggx", "anisotropy to 1"): (3.50, 2.68),
    ("filtered_is_ggx", "roughness where counts change"): (1.03, 0),
    ("filtered_is_ggx", "sun over the horizon"): (1.02, 0),
    ("filtered_is_ggx", "eye across a plane of symmetry"): (1.17, 0),
    ("mc", "anisotropy through 0"): (20.68, 12.92),
    ("mc", "anisotropy to 1"): (1.54, 1.29),
    ("mc", "anisotropy through an eighth"): (1.06, 0),
    ("mc", "roughness to 1"): (1.37, 0),
    ("mc", "roughness where counts change"): (1.55, 0),
    ("mc", "environment through a whole turn"): (1.04, 0),
    ("mc", "eye across a plane of symmetry"): (1.35, 0),
    ("as_mc", "anisotropy through 0"): (13.18, 12.95),
    ("as_mc", "anisotropy to 1"): (1.63, 1.63),
    ("as_mc", "eye across a plane of symmetry"): (1.12, 0),
    ("ltc", "anisotropy through 0 by lamps"): (2.09, 0),
    ("ltc", "roughness to 0 by lamps"): (58.33, 0),
    ("ltc", "lamp that leaves"): (108.62, 0),
    ("ltc-clipless", "anisotropy through 0 by lamps"): (2.09, 0),
    ("ltc-clipless", "roughness to 0 by lamps"): (58.27, 0),
    ("ltc-clipless", "lamp that leaves"): (110.82, 0),
    ("mc", "anisotropy through 0 by lamps"): (2.13, 0),
    ("mc", "roughness to 0 by lamps"): (59.32, 0),
    ("mc", "lamp that leaves"): (0, 3.44),
    ("ltc-isotropic", "anisotropy through 0 by lamps"): (2.07, 0),
    ("ltc-isotropic", "roughness to 0 by lamps"): (58.15, 0),
    ("ltc-isotropic", "lamp that leaves"): (169.37, 0),
    ("ggx", "anisotropy through 0"): (289.32, 289.32),
    ("charlie", "anisotropy through 0"): (299.56, 299.56),
    ("ggx_aniso", "anisotropy through 0"): (20.68, 12.92),
    ("ggx_aniso", "roughness to 1"): (1.37, 0),
    ("ggx_aniso_separable", "anisotropy through 0"): (20.67, 12.94),
    ("ggx_aniso_separable", "roughness to 1"): (1.33, 0),
    ("beckmann", "anisotropy through 0"): (14.11, 13.20),
    ("beckmann", "roughness to 0"): (1.22, 1.22),
    ("beckmann", "roughness to 1"): (1.06, 0),
    ("ashikhmin_shirley", "anisotropy through 0"): (12.94, 10.99),
    ("ward", "anisotropy through 0"): (10.25, 10.21),
    ("ward", "roughness to 1"): (1.24, 0),
    ("ward_cheap", "anisotropy through 0"): (10.97, 10.54),
    ("ward_cheap", "roughness to 1"): (1.80, 0),
    ("ellipsoid", "anisotropy through 0"): (1.13, 0),
    ("ellipsoid", "roughness to 1"): (1.27, 0),
    ("ellipsoid_correlated", "anisotropy through 0"): (20.68, 12.92),
    ("ellipsoid_correlated", "roughness to 1"): (1.37, 0),
}
KEPT = pathlib.Path(__file__).parent / "reference_steps.txt"
SAMPLES = 4096  # of the reference, per pixel


def moved(bench, path, words, name):
    """Draws a row of images NAME%02d.pfm."""
    along, own, count = path
    scene, *own = own.split()
    words = (*LIGHT, *own, *words, *SIDE)
    if along.startswith("amount="):
        first, last = map(float, along.removeprefix("amount=").split(":"))
        for i in range(count):
            bench.run("render", f"{scene}={first + (last - first) * i / (count - 1):.6f}", *words, "-o", f"{name}{i:02d}.pfm").expect(0)
    else:
        bench.run("render", scene, *words, "--animate", along, "--steps", str(count), "-o", f"{name}%02d.pfm").expect(0)
    for left in range(count, 100):  # from a longer row
        (bench.folder / f"{name}{left:02d}.pfm").unlink(missing_ok=True)


def steps_of(bench, path, words):
    """Returns the mean HDR-FLIP between neighbours."""
    moved(bench, path, words, "s")
    rows = list(csv.DictReader(io.StringIO(bench.run("compare", "--sequence", "s%02d.pfm", "s%02d.pfm", "-q", "--csv", "-").expect(0).out)))[1:]
    return [float(row["change"]) for row in rows]


def reference_steps(bench, path, lobe):
    return steps_of(bench, path, (*(("--brdf", lobe) if lobe else ()), "--backend", "reference", "--samples", str(SAMPLES)))


def without_swaps(s):
    """Replaces each step by the median of three neighbours. Where eta changes its sign the reference's sample axes swap, and one step is
    noise. More samples reduce this noise (see the notebook)."""
    return [s[0], *(sorted(s[i - 1:i + 2])[1] for i in range(1, len(s) - 1)), s[-1]]


def kept_steps():
    """Returns {(path, lobe): the reference's steps}."""
    rows = [[part.strip() for part in line.split("|")] for line in KEPT.read_text().splitlines()]
    return {(path, lobe): without_swaps(list(map(float, steps.split()))) for path, lobe, steps in rows}


def excess(bench, key, path, words, reference):
    """Returns the largest step divided by the allowed step, against the reference and against the row's median. Above 1 is a breach."""
    steps = steps_of(bench, path, words)
    usual = sorted(steps)[len(steps) // 2]
    beside = reference if key[1] in ENDS else [0.0] * len(steps)
    return (max(s / (MORE * r + NOISE) for s, r in zip(steps, reference, strict=True)) if reference else 0.0,
            max(s / (MORE * max(usual, r) + NOISE) for s, r in zip(steps, beside, strict=True)))


def held(bench, asked):
    """asked: {(name, path's name): (path, words, lobe of the reference)}."""
    broken, kept = [], kept_steps()
    check(kept.keys() >= {(path, lobe) for (_, path), (_, _, lobe) in asked.items() if path not in OWN_PATHS}, "rows of the reference are missing")
    for key, (path, words, lobe) in asked.items():
        found, known = excess(bench, key, path, words, kept.get((key[1], lobe))), BREACHES.get(key, (0, 0))
        if max(found) > 1 or any(known):
            print(f"    {key}: ({found[0]:.2f}, {found[1]:.2f}),  # {known}", flush=True)
        for what, f, k in zip(("the reference's steps", "its own"), found, known):
            if f > max(1, k * SPREAD):
                broken.append(f"{key}: {f:.2f} times what is allowed by {what}, not {k or 1}")
    check(not broken, "; ".join(broken))


def lobe_of(technique, path):
    return "ashikhmin_shirley" if technique == "as_mc" and not path.startswith("tilt") else ""  # tilt does not exist there


def by_technique(bench, some=None):
    asked = {}
    for name in names_of(bench, "techniques"):
        own = {path: what for path, (*what, reader) in OWN_PATHS.items() if name.startswith(reader)}
        for path, what in {**PATHS, **own}.items():
            asked[name, path] = what, ("--technique", name), lobe_of(name, path)
    return {key: asked[key] for key in some} if some else asked


def by_model(bench):
    tilts = {"ggx_aniso", "ellipsoid", "ellipsoid_correlated"}
    return {(name, path): (PATHS[path], ("--technique", "mc", "--brdf", name), name) for name in lobes(bench) for path in MODEL_PATHS
            if name in tilts or not path.startswith("tilt")}


def by_way(bench, paths):
    return {(name, path): (AREA_PATHS[path], ("--area-lights", name, *(("--light-samples", "256") if "lamp that" in path and name == "mc" else ())), "")
            for name in names_of(bench, "area-lights") if name != "off" for path in paths}


@case("laws.no_technique_jumps_in_some_places")
def some_jumps(bench):
    held(bench, by_technique(bench, SHORT))


@case("laws.no_technique_jumps_anywhere", tier="nightly")
def technique_jumps(bench):
    held(bench, by_technique(bench))


@case("laws.no_model_jumps_anywhere", tier="nightly")
def model_jumps(bench):
    held(bench, by_model(bench))


@case("laws.no_way_of_area_lights_jumps_anywhere", tier="nightly")
def area_jumps(bench):
    held(bench, by_way(bench, AREA_PATHS))


@case("laws.lamps_go_through_the_horizon_without_a_jump", budget=11)
def sinking_lamps(bench):
    """Draws a row of pictures for each lamp and way of area lights."""
    held(bench, by_way(bench, [path for path in AREA_PATHS if "lamp that" in path]))


@case("laws.steps_of_the_reference_are_those_that_are_kept", tier="nightly")
def reference_is_kept(bench):
    """Steps may become smaller. BN_BLESS=1 keeps the steps found, BN_BLESS=missing the steps of rows that are missing."""
    needs_embree(bench)
    rows = {(key[1], lobe): path for key, (path, _, lobe) in {**by_technique(bench), **by_model(bench), **by_way(bench, AREA_PATHS)}.items()
            if key[1] not in OWN_PATHS}
    if os.environ.get("BN_BLESS"):
        known = KEPT.read_text().splitlines(keepends=True) if os.environ["BN_BLESS"] == "missing" else []
        lines = []
        for (path, lobe), what in rows.items():
            start = f"{path} | {lobe} | "
            own = [line for line in known if line.startswith(start)]
            lines.append(own[0] if own else start + " ".join(f"{s:.6f}" for s in reference_steps(bench, what, lobe)) + "\n")
            print(lines[-1], end="", flush=True)
        KEPT.write_text("".join(lines))
        return
    kept, other = kept_steps(), []
    check(sorted(kept) == sorted(rows), "rows are missing, or too many")
    for (path, lobe), what in rows.items():
        found = without_swaps(reference_steps(bench, what, lobe))
        usual = sorted(found)[len(found) // 2], sorted(kept[path, lobe])[len(found) // 2]
        print(f"{path}, {lobe or 'as is usual'}: {usual[0]:.6f}, kept {usual[1]:.6f}", flush=True)
        if usual[0] > 1.02 * usual[1] + 2e-5:
            other.append(f"{path} {lobe}: {usual}")
    check(not other, f"{other}")
