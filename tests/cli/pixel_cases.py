"""The promise: pixels depend on version, scene and options alone."""

import json
import os

from harness import SMALL, Skipped, case, check, data_files

BUILTINS = ("builtin:teapot", "builtin:spheres", "builtin:plate")


def hash_of(bench, *arguments, **options):
    found = bench.figures(*SMALL, *arguments, **options)
    check(found["nan_pixels"] == 0, f"{found['nan_pixels']} pixels are not finite: {arguments}")
    return found["pixel_hash"]


def add_scene_cases():
    for scene in BUILTINS:

        def run(bench, scene=scene):
            available = json.loads(bench.run("info", "--json").expect(0).out)["isa_available"]
            for msaa in ("1", "8"):
                expected = hash_of(bench, scene, "--msaa", msaa)
                for threads, *road in (("1",), ("2", "--tile-size", "32"), ("8", "--tile-size", "64"), *(("3", "--isa", isa) for isa in available)):
                    found = hash_of(bench, scene, "--msaa", msaa, "--threads", threads, *road)
                    check(found == expected, f"--threads {threads} {road} gives {found}, not {expected}")
            found = hash_of(bench, scene, "--msaa", "1", env={"BN_FORCE_ISA": "scalar"})
            check(found == hash_of(bench, scene, "--msaa", "1"), f"BN_FORCE_ISA=scalar gives {found}")

        case("pixels.same_on_every_road." + scene.split(":")[1], budget=6)(run)


add_scene_cases()


@case("pixels.forced_isa_is_used")
def forced_isa(bench):
    found = bench.figures(*SMALL, env={"BN_FORCE_ISA": "scalar"})
    check(found["isa"] == "scalar", f"BN_FORCE_ISA=scalar ran {found['isa']}")


@case("pixels.absent_isa_is_said")
def absent_isa(bench):
    available = json.loads(bench.run("info", "--json").expect(0).out)["isa_available"]
    absent = [isa for isa in ("avx2", "avx512") if isa not in available]
    if not absent:
        raise Skipped("this machine runs every instruction set")
    for isa in absent:
        bench.run("render", *SMALL, "--isa", isa).expect(77).expect_one_line(isa)


@case("pixels.options_that_shall_change_them_do")
def options_matter(bench):
    """A hash that never changes would pass every other case."""
    roads = {
        "plain": (),
        "roughness": ("--roughness", "0.9"),
        "msaa": ("--msaa", "1"),
        "size": ("--size", "160x121"),
        "camera": ("--eye", "2,2,9"),
        "field of view": ("--eye", "2,2,9", "--fov", "20"),
        "environment": ("--env", "builtin:sky"),
        "rotation": ("--env-rotation", "90"),
        "brightness": ("--env-exposure", "1"),
        "background": ("--no-background",),
        "scene": ("builtin:spheres",),
    }
    seen = {}
    for name, arguments in roads.items():
        seen.setdefault(hash_of(bench, *arguments), []).append(name)
    same = [names for names in seen.values() if len(names) > 1]
    check(not same, f"the same pixels for {same}")


@case("pixels.tonemapping_leaves_radiance_alone")
def tonemap_is_for_display(bench):
    expected = hash_of(bench, "-o", "plain.png", "-o", "plain.exr")
    check(hash_of(bench, "-o", "bright.png", "-o", "bright.exr", "--exposure", "2", "--tonemap", "aces") == expected,
          "the hash depends on display options")
    read = lambda name: (bench.folder / name).read_bytes()
    check(read("plain.exr") == read("bright.exr"), "the EXR depends on display options")
    check(read("plain.png") != read("bright.png"), "the PNG does not depend on display options")


@case("pixels.odd_sizes_are_drawn", "input")
def odd_sizes(bench):
    for size in ("1x1", "17x3", "65x1", "33x129", "2048x2"):
        for msaa in ("1", "16"):
            found = bench.figures("--size", size, "--msaa", msaa, *SMALL[4:])
            check(f"{found['width']}x{found['height']}" == size and found["nan_pixels"] == 0, f"{found}")


@case("pixels.frames_repeat_themselves")
def frames_repeat(bench):
    check(hash_of(bench, "--frames", "4") == hash_of(bench), "later frames differ")


@case("pixels.small_pictures_are_drawn", "input")
def small_pictures(bench):
    """For the sanitizers: every built-in scene and environment once."""
    for scene in BUILTINS:
        hash_of(bench, scene)
    hash_of(bench, "--env", "builtin:sky")


@case("pixels.other_build_gives_the_same", "compilers")
def other_build(bench):
    if not os.path.exists(bench.compare_program):
        raise Skipped(f"no program at {bench.compare_program}")
    scenes = [*BUILTINS, *data_files(bench.data, "models", (".glb", ".gltf")).values()]
    builds = {}
    for program in (bench.program, bench.compare_program):
        facts = json.loads(bench.run("info", "--json", program=program).expect(0).out)
        builds[program] = facts["compiler"]
    check(len(set(builds.values())) == 2, f"these are not two compilers: {builds}")
    for scene in scenes:
        for isa in ((), ("--isa", "scalar")):
            # --no-cache: compares the bake as well.
            hashes = {program: hash_of(bench, scene, "--no-cache", *isa, program=program) for program in builds}
            check(len(set(hashes.values())) == 1, f"{scene} {isa}: {[(builds[p], h) for p, h in hashes.items()]}")
    print(f"{len(scenes)} scenes, equal pixels from {' and '.join(builds.values())}")


@case("pixels.brushing_sets_in_without_a_step", budget=3)
def brushing_sets_in(bench):
    """Brushed surfaces share their samples and others do not. The transition must not show."""
    rows = (("builtin:spheres", "1", ("0.15", "0.4", "0.7")), ("builtin:spheres", "8", ("0.4",)), ("builtin:plate", "1", ("0.15", "0.4", "0.7")))
    places = [(scene, msaa, roughness) for scene, msaa, widths in rows for roughness in widths]
    for i, (scene, msaa, roughness) in enumerate(places):
        words = (scene, "--size", "160x90", "--env-size", "64", "--env-samples", "64", "--floor", "off", "--msaa", msaa, "--roughness", roughness, "-q")
        bench.run("render", *words, "--anisotropy", "0", "-o", f"none{i}.pfm").expect(0)
        bench.run("render", *words, "--anisotropy", "0.00001", "-o", f"least{i}.pfm").expect(0)
    report = json.loads(bench.run("compare", "--sequence", "none%d.pfm", "least%d.pfm", "--metric", "flip-hdr", "--json", "-", "-q").expect(0).out)
    check(len(report["by_frame"]) == len(places), f"{report}")
    for (scene, msaa, roughness), frame in zip(places, report["by_frame"]):
        found = frame["flip_mean"]
        print(f"{scene}, roughness {roughness}, {msaa}x: {found:.5f}")
        check(found <= 0.002, f"{scene}, roughness {roughness}, {msaa}x: FLIP {found}")
