"""Means of our renderers against the means that Cycles drew of the same scenes (cycles_record.py)."""

import json
import math
from pathlib import Path

import cycles_scenes as scenes
from harness import case, check
from outside_scenes import MC, PATH, drawn
from reference_cases import needs_embree

RECORDED = json.loads((Path(__file__).parent.parent / "data" / "cycles_means.json").read_text())["scenes"]
BOUNDS = {"frosted ball of glass": 0.008}  # others: 0.004
ALONE = ("brushed ball", "ball with a roughness texture", "metal ball with a normal map")  # techniques draw no light between things


def expect_mean(bench, name, way, size, samples, bound):
    scene = scenes.SCENES[name]
    (found, error), = drawn(bench, scenes.gltf_of(scene), scene["sky"], way, size, samples)
    right, its_error = RECORDED[name]["mean"], RECORDED[name]["standard_error"]
    chance = [math.hypot(a, b) for a, b in zip(error, its_error)]
    print(f"{name}, {way[1]}: off by", *("%+.3f+-%.3f" % (100.0 * (f / r - 1.0), 100.0 * c / r) for f, r, c in zip(found, right, chance)), "%", flush=True)
    check(all(abs(f - r) <= bound * r + 4.0 * c for f, r, c in zip(found, right, chance)), f"{name}, {way[1]}: {found} for {right}")


def expect_cycles(bench, name):
    needs_embree(bench)
    bound = BOUNDS.get(name, 0.004)
    expect_mean(bench, name, (*PATH, "--bounces", "64"), "32x32", 1024, bound)
    if name in ALONE:
        expect_mean(bench, name, MC, "64x64", 512, bound)


for scene_name in scenes.SCENES:
    case("cycles." + scene_name.replace(" ", "_"), tier="nightly")(lambda bench, name=scene_name: expect_cycles(bench, name))
