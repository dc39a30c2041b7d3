"""Laws of steps: along options, through the points where there might be a jump, pictures change no faster than the reference does, and no step
stands out of its row. What breaks either stands in BREACHES, with how far, and is printed; one that no longer does has to leave it."""

import csv
import io
import os
import pathlib

from chart_cases import needs_embree
from harness import case, check
from law_cases import LIGHT, SIDE, lobes, names_of

MORE, NOISE = 1.5, 2e-4  # a step may be so many times as large as the reference's, or as the median of its row, and so much more

# Options through their special points, in steps so small that pictures differ by little: what goes, words besides, the pictures. An amount is
# what follows a trial's name (core/scene/builtin/trials.cpp).
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
# What ends where lobes change ever faster: no step of it is usual, and those of the reference are beside it in its own row, too.
ENDS = {"anisotropy to 1", "roughness to 0", "roughness to 0 by lamps"}
# Of some techniques alone, which the reference knows nothing of: only their own row is beside them.
OWN_PATHS = {
    "axis-k": ("axis-k=0.995:1.005", "builtin:sphere --roughness 0.4 --anisotropy 0.8", 11, "major_axis"),
    "axis-beta": ("axis-beta=2.2:2.4", "builtin:sphere --roughness 0.4 --anisotropy 0.8", 11, "major_axis"),
    "axis-beta to 0": ("axis-beta=0.01:0", "builtin:sphere --roughness 0.4 --anisotropy 0.8", 11, "major_axis"),
}
# Of every model that --brdf takes, by mc.
MODEL_PATHS = ("anisotropy through 0", "roughness to 0", "roughness to 1", "tilt through 0")
SINKING = "builtin:sinking-lamp --env builtin:night --eye 0,-0.3,0.4 --target 0,0,0 --fov 20"  # without the lamp itself
# Of every way of area lights. A lamp touches the plate's plane with its lower edge, and leaves with its upper one, in steps of a two-hundredth of its height.
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

SPREAD = 1.05  # a breach may be so many times as far, or as little: pictures are the same bits everywhere
BREACHES = {}
KEPT = pathlib.Path(__file__).parent / "reference_steps.txt"
SAMPLES = 4096  # of the reference, a pixel


def moved(bench, path, words, name):
    """A row of pictures NAME%02d.pfm."""
    along, own, count = path
    scene, *own = own.split()
    words = (*LIGHT, *own, *words, *SIDE)
    if along.startswith("amount="):
        first, last = map(float, along.removeprefix("amount=").split(":"))
        for i in range(count):
            bench.run("render", f"{scene}={first + (last - first) * i / (count - 1):.6f}", *words, "-o", f"{name}{i:02d}.pfm").expect(0)
    else:
        bench.run("render", scene, *words, "--animate", along, "--steps", str(count), "-o", f"{name}%02d.pfm").expect(0)
    for left in range(count, 100):  # of a longer row
        (bench.folder / f"{name}{left:02d}.pfm").unlink(missing_ok=True)


def steps_of(bench, path, words):
    """Mean HDR-FLIP between neighbours."""
    moved(bench, path, words, "s")
    rows = list(csv.DictReader(io.StringIO(bench.run("compare", "--sequence", "s%02d.pfm", "s%02d.pfm", "-q", "--csv", "-").expect(0).out)))[1:]
    return [float(row["change"]) for row in rows]


def reference_steps(bench, path, lobe):
    return steps_of(bench, path, (*(("--brdf", lobe) if lobe else ()), "--backend", "reference", "--samples", str(SAMPLES)))


def kept_steps():
    """{(path, lobe): the reference's steps}. Where eta changes its sign the axes of its samples swap, and one step is their noise, which more samples
    lessen (.0157 by 256 a pixel, .0063 by 4096, .0040 by 16384, beside .0017): of three neighbours the median counts."""
    kept = {}
    for line in KEPT.read_text().splitlines():
        path, lobe, steps = (part.strip() for part in line.split("|"))
        s = list(map(float, steps.split()))
        kept[path, lobe] = [s[0], *(sorted(s[i - 1:i + 2])[1] for i in range(1, len(s) - 1)), s[-1]]
    return kept


def excess(bench, key, path, words, reference):
    """The largest step over what is allowed beside the reference's at its place, and beside its own row's median: above 1 is a breach."""
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
            if not (k / SPREAD <= f <= k * SPREAD if k else f <= 1):
                broken.append(f"{key}: {f:.2f} times what is allowed by {what}, not {k or 1}")
    check(not broken, "; ".join(broken))


def lobe_of(technique, path):
    return "ashikhmin_shirley" if technique == "as_mc" and not path.startswith("tilt") else ""  # which has no tilt


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


@case("laws.no_technique_jumps_in_some_places", tier="gate")
def some_jumps(bench):
    held(bench, by_technique(bench, SHORT))


@case("laws.no_technique_jumps_anywhere", tier="slow")
def technique_jumps(bench):
    held(bench, by_technique(bench))


@case("laws.no_model_jumps_anywhere", tier="slow")
def model_jumps(bench):
    held(bench, by_model(bench))


@case("laws.no_way_of_area_lights_jumps_anywhere", tier="slow")
def area_jumps(bench):
    held(bench, by_way(bench, AREA_PATHS))


@case("laws.lamps_go_through_the_horizon_without_a_jump", tier="gate")
def sinking_lamps(bench):
    held(bench, by_way(bench, [path for path in AREA_PATHS if "lamp that" in path]))


@case("laws.steps_of_the_reference_are_those_that_are_kept", tier="slow")
def reference_is_kept(bench):
    """BN_BLESS=1 keeps what is found."""
    needs_embree(bench)
    rows = {(key[1], lobe): path for key, (path, _, lobe) in {**by_technique(bench), **by_model(bench), **by_way(bench, AREA_PATHS)}.items()
            if key[1] not in OWN_PATHS}
    if os.environ.get("BN_BLESS"):
        lines = []
        for (path, lobe), what in rows.items():
            lines.append(f"{path} | {lobe} | {' '.join(f'{s:.6f}' for s in reference_steps(bench, what, lobe))}\n")
            print(lines[-1], end="", flush=True)
        KEPT.write_text("".join(lines))
        return
    kept, other = kept_steps(), []
    check(sorted(kept) == sorted(rows), "rows are missing, or too many")
    for (path, lobe), what in rows.items():
        found = reference_steps(bench, what, lobe)
        usual = sorted(found)[len(found) // 2], sorted(kept[path, lobe])[len(found) // 2]
        print(f"{path}, {lobe or 'as is usual'}: {usual[0]:.6f}, kept {usual[1]:.6f}", flush=True)
        if abs(usual[0] - usual[1]) > 0.02 * usual[1] + 2e-5:
            other.append(f"{path} {lobe}: {usual}")
    check(not other, f"{other}")
