"""Subcommands of the laboratory: each once, small, with bad input and with impossible folders, and the pages' examples of them."""

from compare_cases import png
from detail_cases import bumps
from file_cases import refuse_folders
from harness import case, scratch
from subcommand_cases import RUNS as OF_PRODUCT
from subcommand_cases import VIEW, check_named, check_whats, refuse_each, run_each
from usage_cases import take_examples

# Command lines by subcommand, each with its allowed exit codes: 77 where a device or the reference is missing.
RUNS = {
    "atlas": [(("--list",), (0,)), (("albedo_by_a_fit", "--quick", "-o", "atlas", "--json", "atlas.json"), (0, 77))],
    "race": [(("builtin:plate", *VIEW, "--techniques", "split_isotropic", "--runs", "1", "--devices", "lavapipe", "--json", "z.json"), (0, 77))],
    "conform": [(("nothing", "pictures"), (4,))],
    "plot": [(("axis", "-o", "axis.svg"), (0,)), (("lobe", "--tilt", "9,4", "-o", "lobe.svg"), (0,)),
             (("side", "-o", "side.svg"), (0,)), (("half-vectors", "-o", "half.svg"), (0,)),
             (("energy", "-o", "energy.svg"), (0,))],
    "train": [(("mip", "--steps", "1", "--only-maps", "maps", "-o", "w.mipnet", "-q"), (0,)),
              (("mip", "--steps", "1", "--only-maps", "maps", "--size", "1x8", "--loss", "l2", "--tone", "log", "--levels", "2", "-o", "x.mipnet", "-q"), (0,))],
}
# The laboratory's runs of the product's subcommands.
PARTS = {"bake": [(("ltc", "--resolution", "3", "--steps", "1", "--samples", "1", "-o", "t.ltc"), (0,)), (("ltc", "--table", "t.ltc"), (0,))]}
# Runs that take seconds however small.
LONG = {"chart": [(("--mip", "--brdf", "beckmann", "--per-set", "1", "-o", "mips"), (0,))],
        "plot": [(("ltc", "-o", "ltc.svg"), (0,)), (("ellipsoid", "-o", "e.html"), (0,))]}


@case("subcommand.each_that_takes_seconds_runs", "input", tier="nightly")
def long(bench):
    for name, runs in LONG.items():
        if bench.sanitized and name == "chart":  # minutes of searches under sanitizers; render has a small search
            continue
        run_each(bench, name, runs, timeout=400.0)


@case("subcommand.each_of_the_laboratory_runs_small", "input", budget=4)
def each(bench):
    check_named(bench, True, RUNS)
    scratch(bench, "maps/waves/a_normal.png", png(64, 64, bumps))
    for name, runs in (RUNS | PARTS).items():
        check_whats(bench, name, runs + LONG.get(name, []) + OF_PRODUCT.get(name, []))
        run_each(bench, name, runs)


@case("subcommand.each_of_the_laboratory_refuses_bad_input", "input")
def bad_input(bench):
    refuse_each(bench, ((("atlas", "nothing"), (2,)), (("train", "mip", "--evaluate", "bad.exr"), (4,))),
                (("race", "bad.glb", *VIEW, "--devices", "lavapipe"),))


@case("usage.examples_of_the_laboratory_are_taken_as_they_are_written")
def every_example(bench):
    take_examples(bench, True, {"atlas": ("-o", "file/a"), "race": ("--json", "file/a")}, 10)


@case("file.folders_of_the_laboratory_that_cannot_be")
def impossible_folders(bench):
    scratch(bench, "maps/x_normal.png", b"no picture")
    refuse_folders(bench, ("chart", "--mip", "--maps", "maps", "-o"), ("atlas", "-o"))
