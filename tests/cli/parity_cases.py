"""The Vulkan renderer against the tile renderer, bit by bit; `burnish parity` detects planted defects."""

import collections
import json
import pathlib
import re
import shutil
import subprocess
import xml.etree.ElementTree as tree

from harness import Skipped, case, check

ROOT = pathlib.Path(__file__).resolve().parents[2]
COARSE = ("--env-size", "64", "--env-samples", "32")  # a bake of a second
STAGES = ["clip positions", "visibility", "depth", "interpolants", "material inputs", "shaded colour", "resolved colour"]
OF_IDS = [*STAGES, "layers"]  # of --pipeline ids
MODELS = (ROOT / "shading/models.def").read_text()
TECHNIQUES = re.findall(r"^BN_TECHNIQUE\((\w+)", MODELS, re.MULTILINE)  # without auto
# Techniques whose pixels share samples. auto shares them on brushed metal. A fragment of a forward pipeline sees no neighbour's samples.
SHARING = re.findall(r"^BN_SHARING\((\w+)", MODELS, re.MULTILINE)
ALONE = [name for name in TECHNIQUES if name not in SHARING]


def parity(bench, *arguments, also=(), code=0, timeout=540.0, device="lavapipe", optimised=False):
    """Runs the command and returns its JSON; skips without the device or Vulkan. also: option lists of more looks, for which a driver
    compiles nothing again. optimised: with lavapipe's optimisation, which takes longer than the tests' images repay."""
    looks = [word for look in also for word in ("--also", " ".join(map(str, look)))]
    done = bench.run("parity", *arguments, *looks, "--device", device, *COARSE, "--json", "parity.json", timeout=timeout,
                     env={} if optimised else {"GALLIVM_PERF": "nopt"})
    if done.code == 77 and code != 77:
        raise Skipped(done.err.strip())
    done.expect(code)
    if code == 0:
        check("clip positions" in done.out and "clip positions" not in done.err, f"figures belong on stdout\n{done.describe()}")
    return json.loads((bench.folder / "parity.json").read_text())


def check_equal(report):
    check(report["passed"], "the report does not say that it passed")
    for row in report["rows"]:
        name = f"{row['scene']} {row['technique']} {row['msaa']}x"
        check([stage["name"] for stage in row["stages"]] == OF_IDS, f"{name}: other stages")
        check(row["visibility_differ"] == 0 and row["first_difference"] is None, f"{name}: {row}")
        check(row["ray_wrong"] == 0, f"{name}: rays meet other triangles: {row}")
        check(row["samples"] == report["width"] * report["height"] * row["msaa"], f"{name}: wrong number of samples")
        for stage in row["stages"][:3] + row["stages"][-3:]:
            check(stage["values"] > 0, f"{name}: nothing was compared in {stage['name']}")
        for stage in row["stages"] if row["scene"].startswith("builtin:") else ():
            check(stage["values"] > 0, f"{name}: nothing was compared in {stage['name']}")


def check_every_technique(rows, count):
    found = collections.Counter(row["technique"] for row in rows)
    check(found == dict.fromkeys(["auto", *TECHNIQUES], count), f"not {count} rows of each technique: {dict(found)}")


def packages_are_there():
    """Returns True if the packages of apps/packages.txt for these tests are installed."""
    drivers = pathlib.Path("/usr/share/vulkan/icd.d")
    return shutil.which("glslc") and drivers.is_dir() and any(drivers.glob("lvp_icd*.json"))


@case("parity.a_device_is_there", tier="nightly")
def a_device_is_there(bench):
    """With the packages, no test may be skipped for lack of a device."""
    if not packages_are_there():
        raise Skipped("no glslc or no driver of Mesa's: groups build and test of apps/packages.txt")
    info = json.loads(bench.run("info", "--json").expect(0).out)
    check("vulkan" in info["backends"], "built without Vulkan")
    check(any("llvmpipe" in name for name in info["vulkan_devices"]), f"no llvmpipe among {info['vulkan_devices']}")
    bench.run("parity", "builtin:teapot", "--technique", "bent_normal", "--size", "48x32", "--msaa", "1", "--device", "lavapipe", *COARSE).expect(0)


@case("parity.render_gives_the_same_hash", tier="nightly")
def render_gives_the_same_hash(bench):
    """Compares render without parity's records."""
    def pixel_hash(*options):
        done = bench.run("render", *options, *COARSE, "-o", "a.exr", "--stats", "s.json", "-q")
        if done.code == 77:
            raise Skipped(done.err.strip())
        done.expect(0)
        stats = json.loads((bench.folder / "s.json").read_text())
        return stats["pixel_hash"], stats["backend"]

    seen = set()
    for scene, technique, msaa in (("builtin:teapot", "major_axis", "1"), ("builtin:spheres", "mc", "4"), ("builtin:plate", "bent_normal", "8")):
        words = (scene, "--technique", technique, "--msaa", msaa, "--size", "96x64")
        device, backend = pixel_hash(*words, "--backend", "vulkan", "--device", "lavapipe")
        tile, _ = pixel_hash(*words)
        check(backend == "vulkan" and device == tile, f"{scene} {technique} {msaa}x: {device} and {tile}")
        seen.add(tile)
    check(len(seen) == 3, "all pictures are the same one")


@case("parity.every_technique_is_equal", tier="nightly")
def every_technique(bench):
    report = parity(bench, "--suite", "default", "--size", "96x64", "--msaa", "1,4", "--junit", "parity.xml", "--html", "parity.html", optimised=True)
    check_equal(report)
    check_every_technique(report["rows"], 5 * 2)
    suite = tree.parse(bench.folder / "parity.xml").getroot()
    check(suite.get("failures") == "0" and int(suite.get("tests")) == len(report["rows"]) + 1, "the JUnit report counts otherwise")
    check("<table>" in (bench.folder / "parity.html").read_text(), "no table in the page")


# Two techniques in one frame; samples shared across edges of triangles, surfaces and images with odd sides.
@case("parity.automatic_technique_is_equal", tier="nightly")
def automatic_technique(bench):
    report = parity(bench, "builtin:spheres", "builtin:plate", "--size", "95x63", "--technique",
                    "auto,lobe_line", "--msaa", "1,4")
    check_equal(report)
    check(len(report["rows"]) == 2 * 2 * 2, "rows are missing")


@case("parity.a_small_picture_is_equal", budget=90)
def small_picture(bench):
    """Takes long, since a device of the CPU compiles every shader. No cheaper test compares a device with the tile renderer."""
    report = parity(bench, "builtin:plate", "--size", "32x24", "--env-size", "16", "--env-samples", "16", "--msaa", "4", "--technique", "auto")
    check_equal(report)


# Extracted lights: discs and needles, tilted lobes, mirrors, shared samples.
@case("parity.shadowed_pictures_are_equal", tier="nightly")
def shadowed_pictures(bench):
    """Area lights and lamps: the device draws the picture without them, and rays darken it."""
    for words in (("builtin:lights", "--shadows", "on"), ("builtin:teapot", "--env", "builtin:sky", "--shadows", "on", "--shadow-samples", "32")):
        report = parity(bench, *words, "--technique", "bent_normal", "--msaa", "1,4", "--size", "48x36")
        shadowed = [row["stages"].pop() for row in report["rows"]]
        check_equal(report)
        check(len(shadowed) == 2, f"{report}")
        for stage in shadowed:
            check(stage["name"] == "shadowed colour" and stage["values"] == 48 * 36 * 3 and stage["words_differ"] == 0, f"{stage}")


@case("parity.light_of_suns_is_equal", tier="nightly")
def light_of_suns(bench):
    check_equal(parity(bench, "builtin:spheres", bench.data_file("models/Lights.glb"), "--env", "builtin:sky", "--size", "64x48", "--msaa", "1",
                       "--samples", "16", "--technique", "all",
                       also=(("--technique", "auto,mc", "--roughness", "0.15", "--anisotropy", "0.9"),
                             ("--technique", "auto,split_isotropic", "--roughness", "0.02"),
                             ("--technique", "auto,bent_normal", "--tilt", "20,-10", "--roughness", "0.5"))))


@case("parity.models_are_equal", tier="nightly")
def models(bench):
    report = parity(bench, "--models", bench.data_file("models"), "--size", "96x64", "--technique", "major_axis,filtered_is_ggx", "--msaa", "1,4")
    check_equal(report)
    check(len(report["rows"]) >= 2 * 2 * 10, "too few models")


@case("parity.emulated_samples_are_equal", tier="nightly")
def emulated_samples(bench):
    places = ("builtin:spheres", "builtin:plate", "builtin:teapot", bench.data_file("models/Lights.glb"))
    report = parity(bench, *places, "--size", "64x48", "--technique", "bent_normal,mc", "--msaa", "2,8,16")
    check_equal(report)
    check(len(report["rows"]) == 4 * 2 * 3, "rows are missing")
    check(all(row["samples_emulated"] for row in report["rows"]), "lavapipe takes 1 and 4 samples only")


def options_agree(bench, *sets):
    lights = bench.data_file("models/Lights.glb")
    report = parity(bench, lights, "builtin:plate", "--size", "48x32", "--msaa", "1", also=sets)
    check_equal(report)
    check_every_technique(report["rows"], 2 * (1 + len(sets)))


# Tests each option once.
@case("parity.options_of_shading_are_equal", tier="nightly")
def options_of_shading(bench):
    options_agree(bench, ("--masking", "separable", "--tilt", "20,-10"), ("--anisotropy", "0.7", "--roughness", "0.3", "--dfg", "fit"),
                  ("--energy-compensation", "--tilt", "20,-10", "--anisotropy", "0.5", "--roughness", "0.8", "--horizon", "off", "--texture-anisotropy", "4"))


@case("parity.options_of_shading_are_equal_in_more_sets", tier="nightly")
def more_options_of_shading(bench):
    options_agree(bench, ("--tilt", "20,-10"), ("--masking", "separable", "--energy-compensation"),
                  ("--horizon", "off", "--energy-compensation", "--texture-anisotropy", "4"),
                  ("--energy-compensation", "--anisotropy", "0.8", "--roughness", "0.8"),
                  ("--energy-compensation", "--tilt", "20,-10", "--anisotropy", "0.5", "--roughness", "0.8"))


@case("parity.everything_is_equal", tier="nightly")
def everything(bench):
    check_equal(parity(bench, "--suite", "default", timeout=1100.0))
    for folder in bench.data:
        if (folder / "models").exists():
            check_equal(parity(bench, "--models", folder / "models", timeout=1100.0))


CAUSES = {"equal", "visibility", "interpolants", "material inputs", "shaded colour", "resolved colour", "rounding"}


def check_looks_the_same(report):
    """Mean FLIP is within its promise, and a stage explains every differing pixel."""
    for row in report["rows"]:
        name = f"{row['scene']} {row['technique']} {row['msaa']}x {row['sampler']}"
        check(row["error"] is None and 0 < row["flip_mean"] < 0.002, f"{name}: {row['error']}, mean FLIP {row['flip_mean']}")
        check([stage["name"] for stage in row["stages"]] == STAGES, f"{name}: other stages")
        for stage in row["stages"][1:3] + row["stages"][-2:]:
            check(stage["values"] > 0, f"{name}: nothing was compared in {stage['name']}")
        causes = {c["stage"]: c for c in row["causes"]}
        check(set(causes) <= CAUSES, f"{name}: {causes}")
        explained = sum(c["pixels"] for stage, c in causes.items() if stage != "equal")
        check(explained == row["pixels_differ"] > 0, f"{name}: {explained} of {row['pixels_differ']} pixels are explained")
        check(abs(sum(c["flip"] for c in causes.values()) - row["flip_mean"]) < 1e-6, f"{name}: shares of FLIP do not add up")
        # both renderers shade equal places, except in partly hidden pixels
        elsewhere = sum(causes[stage]["pixels"] for stage in ("visibility", "interpolants") if stage in causes)
        check(elsewhere <= 0.01 * sum(c["pixels"] for c in causes.values()), f"{name}: {causes}")


@case("parity.forward_looks_the_same", tier="nightly")
def forward_looks_the_same(bench):
    report = parity(bench, "builtin:teapot", "builtin:spheres", "builtin:plate", "--size", "96x64", "--technique", "split_isotropic,major_axis",
                    "--msaa", "1,4", "--pipeline", "forward", "--sampler", "native", "--html", "parity.html")
    check(len(report["rows"]) == 3 * 2 * 2, f"{len(report['rows'])} rows")
    check_looks_the_same(report)
    check("pixels differ first by" in (bench.folder / "parity.html").read_text(), "the page does not say why pixels differ")


@case("parity.forward_of_every_technique_looks_the_same", tier="nightly")
def forward_of_every_technique(bench):
    for more in (("--sampler", "native", "--technique", ",".join(ALONE)), ("--sampler", "exact", "--technique", "split_isotropic")):
        check_looks_the_same(parity(bench, "--suite", "default", "--msaa", "1,4", "--pipeline", "forward", *more, timeout=590.0))


@case("parity.forward_says_where_samples_that_are_shared_are_missed", tier="nightly")
def forward_without_neighbours(bench):
    report = parity(bench, "builtin:plate", "--size", "96x64", "--technique", ",".join(SHARING), "--msaa", "1", "--pipeline", "forward", code=1)
    for row in report["rows"]:
        flip = {cause["stage"]: cause["flip"] for cause in row["causes"]}
        check(max(flip, key=flip.get) == "shaded colour" and 0.002 < row["flip_mean"] < 0.1, f"{row['technique']}: {flip}")
    # The difference is noise that vanishes with many samples, if the technique can take many.
    parity(bench, "builtin:plate", "--size", "48x32", "--technique", "as_mc", "--samples", "16384", "--msaa", "1", "--pipeline", "forward",
           "--sampler", "native")


@case("parity.goes_on_after_a_row_that_fails", tier="nightly")
def goes_on_after_a_row_that_fails(bench):
    (bench.folder / "broken.glb").write_text("glTF, not")
    files = ("--junit", "parity.xml", "--html", "parity.html")
    report = parity(bench, "broken.glb", "builtin:teapot", "--size", "32x24", "--technique", "bent_normal", "--msaa", "1", *files, code=4)
    check([bool(row["error"]) for row in report["rows"]] == [True, False], f"{report['rows']}")
    check(not report["passed"] and report["rows"][1]["first_difference"] is None, "the other row")
    check(tree.parse(bench.folder / "parity.xml").getroot().get("failures") == "1", "the JUnit report counts otherwise")
    check("broken.glb" in (bench.folder / "parity.html").read_text(), "no row in the page")
    report = parity(bench, "builtin:teapot", "--size", "32x24", "--technique", "bent_normal", "--msaa", "8,1", "--pipeline", "forward", code=77)
    check([bool(row["error"]) for row in report["rows"]] == [True, False], f"{report['rows']}")


def never_written_over(bench, *commands):
    """Each command refuses the model models/a.gltf as its report, and the model stays."""
    (bench.folder / "models").mkdir()
    for name in ("a.gltf", "b.gltf"):
        (bench.folder / "models" / name).write_text("{}")
    for command in commands:
        done = bench.run(*command, "--json", "models/a.gltf")
        if done.code == 77:
            raise Skipped(done.err.strip())
        done.expect(2).expect_one_line("models/a.gltf")
    check((bench.folder / "models/a.gltf").read_text() == "{}", "the model was written over")


@case("parity.writes_over_no_model")
def writes_over_no_model(bench):
    never_written_over(bench, ("parity", "--models", "models"), ("parity", "models/a.gltf"))


@case("parity.wide_pictures_are_equal", tier="nightly")
def wide_pictures(bench):
    """Images larger than a single device buffer are drawn in bands; 16384 pixels are the largest width."""
    def pixel_hash(*options):
        done = bench.run("render", "builtin:teapot", "--technique", "bent_normal", *options, *COARSE, "-o", "a.exr", "--stats", "s.json", "-q", timeout=240.0)
        if done.code == 77:
            raise Skipped(done.err.strip())
        done.expect(0)
        return json.loads((bench.folder / "s.json").read_text())["pixel_hash"]

    picture = ("--size", "16384x300", "--msaa", "8")
    tile, device = pixel_hash(*picture), pixel_hash(*picture, "--backend", "vulkan", "--device", "lavapipe")
    check(tile == device, f"{tile} and {device}")


VALIDATED = ("builtin:plate", "--size", "32x24", "--validate")


def forward_is_valid(bench, technique, i):
    for sampler, msaa in (("exact", "14"[i % 2]), ("native", "41"[i % 2])):
        bench.run("render", *VALIDATED, "--backend", "vulkan", "--device", "lavapipe", "--pipeline", "forward", "--sampler", sampler, "--msaa", msaa,
                  "--technique", technique, *COARSE, "-o", "a.pfm", "-q").expect(0)


@case("parity.validation_layer_is_silent", tier="nightly")
def validation_layer_is_silent(bench):
    """Every technique, every sample count, the passes that record stages, and one technique by each pipeline and sampler."""
    techniques = set()
    for extra in (("--msaa", "1,4"), ("--msaa", "2,8,16", "--technique", "mc"),
                  ("--msaa", "4", "--technique", "bent_normal", "--pipeline", "forward", "--sampler", "native")):
        report = parity(bench, *VALIDATED, *extra)
        check(report["rows"] and all(row["error"] is None for row in report["rows"]), f"{report['rows']}")
        techniques |= {row["technique"] for row in report["rows"]}
    check(techniques == {"auto", *TECHNIQUES}, f"techniques: {techniques}")
    forward_is_valid(bench, "lobe_line", 1)


# A driver compiles each anew.
@case("parity.validation_layer_is_silent_by_every_technique", tier="nightly")
def validation_by_every_technique(bench):
    report = parity(bench, *VALIDATED, "--msaa", "1")
    for i, technique in enumerate(sorted({row["technique"] for row in report["rows"]})):
        forward_is_valid(bench, technique, i)


# Looks differ, and each is compared with itself.
@case("parity.looks_are_drawn_each", tier="nightly")
def looks(bench):
    report = parity(bench, "builtin:plate", "--size", "32x24", "--msaa", "1", "--technique", "bent_normal", "--roughness", "0.3",
                    also=(("--roughness", "0.7"), ("--technique", "major_axis", "--msaa", "1,4")))
    check_equal(report)
    check([(row["also"], row["technique"], row["msaa"]) for row in report["rows"]] ==
          [("", "bent_normal", 1), ("--roughness 0.7", "bent_normal", 1)] + [("--technique major_axis --msaa 1,4", "major_axis", n) for n in (1, 4)],
          f"{report['rows']}")
    alone = parity(bench, "builtin:plate", "--size", "32x24", "--msaa", "1", "--technique", "bent_normal", "--roughness", "0.7")
    hashes = [row["pixel_hash"] for row in report["rows"]]
    check(len(set(hashes)) == 4 and hashes[1] == alone["rows"][0]["pixel_hash"], f"{hashes}, {alone['rows']}")


@case("parity.unknown_device_is_said")
def unknown_device(bench):
    done = bench.run("parity", "builtin:teapot", "--device", "abacus", "--size", "16x16", "--msaa", "1", *COARSE)
    done.expect(77).expect_one_line()


@case("parity.wrong_options_say_one_line_and_exit_2")
def wrong_options(bench):
    for arguments, needle in ((("--suite", "none"), "--suite"), (("--technique", "none"), "--technique"), (("--msaa", "3"), "--msaa"),
                              (("--also", "--env builtin:sky"), "--also"), (("--also", "--tilt"), "--also"), (("--also", " "), "--also"),
                              (("--also", "--size=8x8"), "--also"), (("--also", "--technique mc --masking none"), "--masking"),
                              (("--also", "--technique bent_normal --brdf beckmann"), "--technique"),
                              (("--also", " ".join(["--light sphere:points=0,1,0:radius=0.1:radiance=9,9,9"] * 257)), "257 are given"),
                              (("--pipeline", "backward"), "--pipeline"), (("--sampler", "native"), "--sampler"), (("--msaa", "1,"), "--msaa")):
        done = bench.run("parity", *arguments)
        if done.code == 77:
            raise Skipped(done.err.strip())
        done.expect(2).expect_one_line(needle)
    bench.run("render", "--device", "lavapipe").expect(2).expect_one_line("--device")


# Defects that `parity` must catch. Columns: edits (shading file, old text, new text), samples a pixel, stages that may differ first, and
# the single shader with the defect, if not all.
MIRROR = "2 * (frame.center_x >> 8) - 1 - "
DEFECTS = {
    # drawn mirrored and read mirrored: samples on left edges fall to the other triangle, and nothing else changes
    "top_left_rule": ([("stages/visibility.vert", "vec4(x, y, ", "vec4(-x, y, "),
                       ("stages/visibility.frag", "px = int(gl_FragCoord.x)", f"px = {MIRROR}int(gl_FragCoord.x)"),
                       ("stages/gather.comp", "ivec2(pixel % frame.width", f"ivec2({MIRROR}pixel % frame.width")], "1", {"visibility"}),
    "one_ulp_in_a_kernel_constant": ([("surface/lobe.k.h", "0.70710678118654752", "0.7071068406")], "1", {"shaded colour"}),
    "one_ulp_in_the_vertex_kernel": ([("kernels/vertex.k.h", "lit(1.0) / select(in_front", "lit(0.99999994) / select(in_front")], "1", {"clip positions"}),
    "swapped_sample_positions": ([("stages/gather.comp", "copy_sample(pixel, at, s, s)", "copy_sample(pixel, at, s, s < 2 ? 1 - s : s)")], "4",
                                 {"visibility"}),
    "another_depth": ([("kernels/depth_plane.k.h", "real z = pixel + step;", "real z = (pixel + step) * lit(0.99999994);")], "1", {"depth"}),
    "no_contraction_missing": ([("lang/glsl.h", "#define real precise float", "#define real float"),
                                ("lang/glsl.h", "#define real2 precise vec2", "#define real2 vec2"),
                                ("lang/glsl.h", "#define real3 precise vec3", "#define real3 vec3"),
                                ("lang/glsl.h", "#define real4 precise vec4", "#define real4 vec4")], "1",
                               {"interpolants", "material inputs", "shaded colour"}, "shade"),
    "another_layer": ([("surface/layers.t.h", "r.normal = axes.n;", "r.normal = axes.b;")], "4", {"layers"}, "shade"),
}


# Defects of area lights, in the stage that lights.
LTC_TABLE = "lights/ltc_table.k.h"
AREA_DEFECTS = {"a_mirror_that_is_not_undone": (LTC_TABLE, "return vec3_of(p.sign_x * x, p.sign_y * y, v.z);", "return vec3_of(x, p.sign_y * y, v.z);"),
                "a_quadrant_that_is_not_mirrored": (LTC_TABLE, "p.sign_y = select(eye.y < lit(0.0), lit(-1.0), lit(1.0));", "p.sign_y = lit(1.0);"),
                "equal_widths_exchanged": (LTC_TABLE, "p.swapped = wide_y > wide_x;", "p.swapped = wide_y >= wide_x;")}


def compile_stages(source, folder, only=None):
    """Compiles every shader of stages.txt, or one of them, from the shading text below `source`."""
    compile_listed("raster/vulkan/stages.txt", source, "shading/stages", folder, only)


def compile_listed(stages, source, texts, folder, only=None):
    for line in (ROOT / stages).read_text().splitlines():
        if not re.match("[a-z]", line):
            continue
        name, file, *defines = line.split()
        if only not in (None, name):
            continue
        subprocess.run(["glslc", "-w", "--target-env=vulkan1.3", f"-I{source}", *defines, source / texts / file, "-o", folder / f"{name}.spv"],
                       check=True)


def compare_changed(bench, replacements, msaa, code, only=None, size="128x96", drawn=("builtin:teapot", "builtin:plate", "--technique", "major_axis")):
    if not shutil.which("glslc"):
        raise Skipped("no glslc here")
    source, shaders = bench.folder / "source", bench.folder / "shaders"
    shutil.copytree(ROOT / "shading", source / "shading", ignore=shutil.ignore_patterns("bake"))
    (source / "core/scene").mkdir(parents=True)
    for table in (ROOT / "core/scene").glob("*.def"): # tables that define the records
        shutil.copy(table, source / "core/scene")
    shaders.mkdir()
    for file, old, new in replacements:
        path = source / "shading" / file
        text = path.read_text()
        check(old in text, f"{file} does not hold '{old}' any more")
        path.write_text(text.replace(old, new))
    compile_stages(ROOT, shaders)
    compile_stages(source, shaders, only)
    return parity(bench, *drawn, "--size", size, "--msaa", msaa, "--shaders", shaders, code=code)


@case("parity.sees_nothing_where_nothing_is", tier="nightly")
def sees_nothing_where_nothing_is(bench):
    check_equal(compare_changed(bench, [], "1,4", 0))


def add_defect(name, replacements, msaa, stages, only=None):
    @case(f"parity.sees_a_defect.{name}", tier="nightly")
    def sees(bench):
        # few samples lie on an edge, so small images may have none
        report = compare_changed(bench, replacements, msaa, 1, only, "320x240" if name == "top_left_rule" else "128x96")
        first = [row["first_difference"] for row in report["rows"]]
        first = min((f for f in first if f), key=OF_IDS.index, default=None)
        check(first in stages, f"expected the first difference in {stages}, found it in {first}")


for defect, what in DEFECTS.items():
    add_defect(defect, *what)


def add_area_defect(name, replacement):
    @case(f"parity.sees_a_defect_of_area_lights.{name}", tier="nightly")
    def sees(bench):
        report = compare_changed(bench, [replacement], "1", 1, "shade", "64x48",
                                 ("builtin:lights", "--env", "builtin:night", "--technique", "bent_normal"))
        check({row["first_difference"] for row in report["rows"]} == {"shaded colour"}, f"{report['rows']}")


for defect, what in AREA_DEFECTS.items():
    add_area_defect(defect, what)
