"""Extracted lights of environments: the option, its messages, and degenerate environments."""

import json
import pathlib

from compare_cases import png
from environment_files import even, exr, hdr, rgbe, with_texels
from harness import SMALL, case, check, scratch

ROOT = pathlib.Path(__file__).resolve().parents[2]
NAN, INF = float("nan"), float("inf")


@case("extracted_lights.are_as_many_as_asked_for", "input")
def as_many(bench):
    def found(*words):
        return bench.figures("--env", "builtin:sky", *SMALL, *words)

    auto = found()
    check(len(auto["key_lights"]) == 1, f"{auto['key_lights']}")
    sun = auto["key_lights"][0]
    check(0.015 < sun["angular_radius_rad"] < 0.02 and 0.6 < sun["share"] < 0.8, f"{sun}")
    check(len(sun["direction"]) == len(sun["irradiance"]) == 3, f"{sun}")
    for words, count, same in ((("--key-lights", "auto"), 1, True), (("--key-lights", "8"), 1, True), (("--key-lights", "1"), 1, True),
                               (("--key-lights", "off"), 0, False), (("--key-lights", "0"), 0, False)):
        other = found(*words)
        check(len(other["key_lights"]) == count, f"{words}: {other['key_lights']}")
        check((other["pixel_hash"] == auto["pixel_hash"]) == same, f"{words}: {'other' if same else 'the same'} pixels")
    turned = found("--env-rotation", "90")["key_lights"][0]
    check(abs(turned["direction"][1] - sun["direction"][1]) < 1e-6 and turned["direction"][0] != sun["direction"][0], f"{turned}")


@case("extracted_lights.are_none_in_the_studio")
def none_in_the_studio(bench):
    """The studio's image does not change."""
    hashes = set()
    for words in ((), ("--key-lights", "off")):
        found = bench.figures(*SMALL, *words)
        check(found["key_lights"] == [], f"{found['key_lights']}")
        hashes.add(found["pixel_hash"])
    check(len(hashes) == 1, f"{hashes}")


@case("extracted_lights.are_told")
def are_told(bench):
    told = bench.run("render", "--env", "builtin:sky", *SMALL, "-v").expect(0).err
    check("extracted light" in told and "% of the light" in told, told)
    check("extracted light" not in bench.run("render", *SMALL, "-v").expect(0).err, "the studio's extracted lights are told of")
    text = bench.run("info", "--env", "builtin:sky").expect(0).out
    check("environment  builtin:sky" in text and text.count("extracted light ") == 1, text)
    environment = json.loads(bench.run("info", "--json", "--env", "builtin:sky", "--key-lights", "off").expect(0).out)["environment"]
    check(environment["name"] == "builtin:sky" and environment["key_lights"] == [] and environment["warnings"] == [], f"{environment}")
    check("environment" not in json.loads(bench.run("info", "--json").expect(0).out), "info looks at an environment that was not asked for")
    bench.run("info", "--env", "nothing.exr").expect(4).expect_one_line("nothing.exr")


@case("extracted_lights.option_takes_nothing_else", "input")
def nothing_else(bench):
    for word in ("-1", "9", "1000", "on", "1.5", "", "99999999999999999999"):
        for command in (("render", "-o", "out.png"), ("info",)):
            bench.run(*command, "--key-lights", word).expect(2).expect_one_line("--key-lights")
    check(bench.left_behind() == [], f"{bench.left_behind()}")


@case("extracted_lights.of_poor_environments_do_no_harm", "input")
def poor_environments(bench):
    """Black, uniform, one bright texel, one pixel: images without NaN that keep the light."""
    pictures = {"black": (32, 16, even(0.0)), "even": (32, 16, even(1.0)), "texel": (64, 32, with_texels({(20, 10): 1e6}, 0.0)),
                "bright_texel": (64, 32, with_texels({(20, 10): 1e6}, 0.5)), "dot": (1, 1, even(2.0)), "all_bright": (32, 16, even(1e9))}
    for name, (width, height, value) in pictures.items():
        # a format that costs nothing to read
        path = scratch(bench, name + ".hdr", hdr(width, height, lambda y: b"".join(rgbe(value(x, y)) for x in range(width))))
        for roughness in ("0", "0.05", "0.5"):
            found = bench.figures("builtin:sphere", "--env", path, *SMALL, "--floor", "off", "--roughness", roughness, "--anisotropy", "0.9")
            check(found["nan_pixels"] == 0, f"{name}: {found['nan_pixels']} pixels are not finite")
            check(found["warnings"] == [], f"{name}: {found['warnings']}")


@case("extracted_lights.environments_are_repaired_and_said_so", "input", budget=8)
def repaired(bench):
    """A warning is one line, also in --stats, from the bake and from the cache."""
    for name, value, words in (("nan", NAN, "1 NaN values"), ("inf", INF, "1 infinite values"), ("1e30", 1e30, "1 values of the environment above 1e+12"),
                               ("3e38", 3e38, "1 values of the environment above 1e+12"), ("negative", -2.0, "1 negative values")):
        # grey, so that each texel is one value in one channel
        path = scratch(bench, name + ".exr", exr(64, 32, lambda x, y, v=value: (v if (x, y) == (9, 9) else 0.5, 0.5, 0.75)))
        pixels = set()
        for words_of_run in ((), (), *((("--no-cache",),) if name == "nan" else ())):
            done = bench.run("render", "builtin:sphere", "--env", path, *SMALL, "--floor", "off", "--stats", "s.json", *words_of_run).expect(0)
            lines = [line for line in done.err.splitlines() if "warning" in line]
            check(len(lines) == 1 and words in lines[0], f"{name}\n{done.describe()}")
            stats = json.loads((bench.folder / "s.json").read_text())
            check(len(stats["warnings"]) == 1 and words in stats["warnings"][0] and stats["nan_pixels"] == 0, f"{name}: {stats['warnings']}")
            pixels.add(stats["pixel_hash"])
        check(len(pixels) == 1, f"{name}: {pixels}")
    every = scratch(bench, "all_nan.exr", exr(16, 8, even(NAN)))
    found = bench.figures("builtin:sphere", "--env", every, *SMALL, "--floor", "off")
    check(found["nan_pixels"] == 0 and len(found["warnings"]) == 1, f"{found['warnings']}")


@case("extracted_lights.an_environment_of_8_bits_is_said_to_be_one", "input")
def low_dynamic_range(bench):
    path = scratch(bench, "day.png", png(64, 32, lambda x, y: (200, 220, 255) if y < 16 else (60, 50, 40)))
    for words in ((), ("--no-cache",)):
        done = bench.run("render", "--env", path, *SMALL, "--stats", "s.json", *words).expect(0)
        lines = [line for line in done.err.splitlines() if "warning" in line]
        check(len(lines) == 1 and "no high dynamic range" in lines[0], done.describe())
        stats = json.loads((bench.folder / "s.json").read_text())
        check(len(stats["warnings"]) == 1 and "no high dynamic range" in stats["warnings"][0] and stats["nan_pixels"] == 0, f"{stats['warnings']}")


@case("extracted_lights.cache_that_cannot_be_written_is_a_warning")
def unwritable_cache(bench):
    scratch(bench, "file", b"no folder")
    done = bench.run("render", "--env", "builtin:sky", *SMALL, "--stats", "s.json", env={"XDG_CACHE_HOME": str(bench.folder / "file")}).expect(0)
    lines = [line for line in done.err.splitlines() if "warning" in line]
    check(len(lines) == 1 and "not cached" in lines[0], done.describe())
    check(len(json.loads((bench.folder / "s.json").read_text())["warnings"]) == 1, "not in --stats")


@case("extracted_lights.render_the_same_on_every_road", budget=8)
def same_on_every_road(bench):
    available = json.loads(bench.run("info", "--json").expect(0).out)["isa_available"]
    for words in (("--technique", "auto"), ("--technique", "mc", "--samples", "4"), ("--technique", "bent_normal", "--tilt", "10,-5")):
        hashes = {}
        roads = [("--isa", isa) for isa in available] + [("--threads", "1"), ("--threads", "3"), ("--tile-size", "32")]
        for road in roads + ([("--no-cache",)] if "auto" in words else []):  # a bake and rays to the floor, the same for each technique
            found = bench.figures("builtin:spheres", "--env", "builtin:sky", *SMALL, *words, *road)
            hashes.setdefault(found["pixel_hash"], []).append(road)
        check(len(hashes) == 1, f"{words}: {hashes}")
