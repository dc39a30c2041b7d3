"""Wide brushed lobes under a strong horizon: the line of prefiltered lobes against the reference."""

import json

import environment_files
from harness import case, check, scratch
from reference_cases import needs_embree

SIZE = ("--size", "48x48", "--no-background", "-q")
# Widths .52 and .25, as from roughness .5 and anisotropy strength .6 in a file.
WIDE = ("--roughness", "0.62", "--anisotropy", "0.35")


def half_white(x, y):
    return (1.0, 1.0, 1.0) if y < 16 else (0.03, 0.03, 0.03)


@case("wide_lobes.look_as_the_reference_under_a_horizon")
def horizon(bench):
    needs_embree(bench)
    scratch(bench, "half.exr", environment_files.exr(64, 32, half_white))
    words = ("builtin:sphere", "--env", "half.exr", "--env-size", "128", "--env-samples", "64", *WIDE, *SIZE)
    bench.run("render", *words, "--backend", "reference", "--samples", "256", "-o", "reference.pfm").expect(0)
    bench.run("render", *words, "--msaa", "4", "-o", "auto.pfm").expect(0)
    found = json.loads(bench.run("compare", "reference.pfm", "auto.pfm", "--metric", "flip-hdr", "--json", "-", "-q").expect(0).out)
    # The limit lies below the error of samples fixed at each round lobe's mirror direction.
    check(found["flip_mean"] < 0.054, f"FLIP to the reference is {found['flip_mean']}")
