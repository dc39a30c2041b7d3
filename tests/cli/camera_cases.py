"""Camera directions: automatic framing, --orbit, --zoom, --fov, --target, and their report by -v. The subject is an unlit cube with one
colour a face."""

import math
import re
import struct

import gltf_files
from harness import case, check, scratch

# Axis, sign and colour of a face. Floats hold the colours exactly.
FACES = {"right": (0, 1, (1, 0, 0)), "left": (0, -1, (0, 1, 1)), "top": (1, 1, (0, 1, 0)), "bottom": (1, -1, (1, 0, 1)),
         "front": (2, 1, (0, 0, 1)), "back": (2, -1, (1, 1, 0))}
TINY = ("--size", "96x96", "--msaa", "1", "--env-size", "16", "--env-samples", "1", "--no-background", "-o", "a.pfm")


def cube(half=0.5, camera=None):
    """Returns a glTF of the cube around the origin; `camera`: position of a camera that looks along -Z."""
    positions, primitives, materials = b"", [], []
    for i, (axis, sign, colour) in enumerate(FACES.values()):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        for u, v in ((-1, -1), (1, -1), (1, 1), (-1, -1), (1, 1), (-1, 1)):
            p = [0.0] * 3
            p[axis], p[a], p[b] = half * sign, half * u * sign, half * v
            positions += struct.pack("<3f", *p)
        primitives.append({"attributes": {"POSITION": i}, "material": i})
        materials.append({"pbrMetallicRoughness": {"baseColorFactor": [*colour, 1]}, "extensions": {"KHR_materials_unlit": {}}})
    gltf = {
        "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_unlit"], "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}], "meshes": [{"primitives": primitives}], "materials": materials,
        "accessors": [{"bufferView": 0, "byteOffset": 72 * i, "componentType": 5126, "count": 6, "type": "VEC3"} for i in range(6)],
        "bufferViews": [{"buffer": 0, "byteLength": len(positions)}],
        "buffers": [{"byteLength": len(positions), "uri": gltf_files.data_uri(positions)}]}
    if camera:
        gltf["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.8, "znear": 0.01}}]
        gltf["nodes"].append({"camera": 0, "translation": camera})
        gltf["scenes"][0]["nodes"].append(1)
    return gltf_files.text(gltf)


def seen(bench, *words):
    """Returns {face: pixel places (x right, y down)} from an image of cube.gltf."""
    bench.run("render", "cube.gltf", *TINY, *words).expect(0)
    data = (bench.folder / "a.pfm").read_bytes()
    kind, size, _, rows = data.split(b"\n", 3)
    width, height = map(int, size.split())
    check(kind == b"PF" and len(rows) == 12 * width * height, "no picture")
    names = {colour: name for name, (_, _, colour) in FACES.items()}
    found = {}
    for i, pixel in enumerate(struct.iter_unpack("<3f", rows)):
        if name := names.get(tuple(map(round, pixel))):
            found.setdefault(name, []).append((i % width, height - 1 - i // width))  # rows go upwards
    return found


def area(found):
    return sum(map(len, found.values()))


def middle(places):
    xs, ys = zip(*places)
    return (min(xs) + max(xs) + 1) / 2, (min(ys) + max(ys) + 1) / 2


@case("camera.a_scene_without_one_is_framed_from_three_quarters")
def three_quarters(bench):
    scratch(bench, "cube.gltf", cube())
    found = seen(bench)
    check(set(found) == {"front", "right", "top"}, f"{sorted(found)} are seen")
    check(min(map(len, found.values())) > 0.1 * area(found), f"{ {k: len(v) for k, v in found.items()} }")
    places = sum(found.values(), [])
    for axis in (0, 1):
        low, high = min(p[axis] for p in places), max(p[axis] for p in places)
        check(low >= 1 and high <= 94, f"the cube reaches from {low} to {high}")
    check(max(max(p) for p in places) - min(min(p) for p in places) > 75, "the picture is empty")


@case("camera.orbit_zoom_fov_and_target_do_what_they_say", tier="nightly")
def options(bench):
    scratch(bench, "cube.gltf", cube())
    for orbit, face in (("0,0", "front"), ("90,0", "right"), ("-90,0", "left"), ("180,0", "back"), ("0,90", "top"), ("0,-90", "bottom")):
        check(set(seen(bench, "--orbit", orbit)) == {face}, f"--orbit {orbit} does not show the {face} alone")
    far, near = area(seen(bench, "--orbit", "0,0", "--zoom", "0.5")), area(seen(bench, "--orbit", "0,0", "--zoom", "0.25"))
    check(abs(far / near - 4) < 0.4, f"--zoom 0.5 shows {far} pixels, 0.25 {near}")
    wide, narrow = seen(bench, "--orbit", "0,0", "--fov", "90"), seen(bench, "--orbit", "0,0", "--fov", "10")
    check(abs(area(wide) / area(narrow) - 1) < 0.05, "with --fov the framing goes nearer or farther")
    x, y = middle(seen(bench, "--orbit", "0,0", "--target", "0.5,0.5,0.5")["front"])
    check(x < 40 and y > 56, f"--target is to the right of and above the cube, which is at {x},{y}")
    scratch(bench, "cube.gltf", cube(camera=[0, 0, 4]))
    plain, tele = area(seen(bench)), area(seen(bench, "--fov", "20"))
    check(tele > 4 * plain, f"--fov changes a camera of the scene: {plain}, {tele}")
    check(abs(area(seen(bench, "--zoom", "2")) / plain - 4) < 0.4, "--zoom of a camera of the scene")
    check(middle(seen(bench, "--target", "0.5,0,0")["front"])[0] < 44, "--target turns a camera of the scene")
    check(set(seen(bench, "--orbit", "90,0")) == {"right"}, "--orbit does without the camera of the scene")


@case("camera.verbose_prints_bounds_and_options_that_give_the_view_again")
def verbose(bench):
    for camera in (None, [0.3, 0.2, 4]):
        scratch(bench, "cube.gltf", cube(camera=camera))
        done = bench.run("render", "cube.gltf", *TINY, "-v", "-o", "b.pfm").expect(0)
        check("bounds      -0.5,-0.5,-0.5 to 0.5,0.5,0.5 m" in done.err, done.describe())
        words = re.search(r"^camera .*: (--eye \S+ --target \S+ --fov \S+)$", done.err, re.M)
        check(words, done.describe())
        bench.run("render", "cube.gltf", *TINY, *words.group(1).split()).expect(0)
        bench.run("compare", "b.pfm", "a.pfm", "--fail-fraction", "0.002").expect(0)


# Options, and their single warning.
NO_EFFECT = (
    (("--technique", "split_isotropic", "--anisotropy", "0.5"), "--anisotropy has no effect with --technique split_isotropic"),
    (("--technique", "major_axis", "--seed", "3"), "--seed has no effect with --technique major_axis"),
    (("--technique", "mc", "--samples", "1", "--axis-k", "2"), "--axis-k has no effect with --technique mc"),
    (("--axis-beta", "2"), "--axis-beta has no effect with --technique auto"),
    (("--backend", "reference", "--samples", "64", "--technique", "mc"), "--technique has no effect with --backend reference"),
    (("--backend", "reference", "--samples", "64", "--axis-k", "2"), "--axis-k has no effect with --backend reference"),
    (("--exposure", "1"), "--exposure has no effect with -o a.pfm"),
)
EFFECT = (("--technique", "mc", "--samples", "1", "--seed", "3"), ("--technique", "major_axis_weighted", "--axis-k", "2"),
          ("--anisotropy", "0.5"), ("--exposure", "1", "-o", "a.png"), ("--backend", "reference", "--samples", "64", "--seed", "3"))


@case("usage.an_option_without_effect_is_one_warning_that_names_both", tier="nightly")
def no_effect(bench):
    small = ("builtin:plate", "--size", "16x16", "--env-size", "16", "--env-samples", "1", "-o", "a.pfm")
    for words, warning in NO_EFFECT:
        done = bench.run("render", *small, *words).expect(0)
        lines = [line for line in done.err.splitlines() if "warning" in line]
        check(lines == [f"burnish: warning: {warning}"], done.describe())
    for words in EFFECT:
        done = bench.run("render", *small, *words).expect(0)
        check("no effect" not in done.err, done.describe())


# Options of lights, and their single warning.
NO_EFFECT_ON_LIGHT = (
    (("--light-samples", "4"), "--light-samples has no effect with --area-lights ltc"),
    (("--light-samples", "4", "--area-lights", "off"), "--light-samples has no effect with --area-lights off"),
    (("--light-samples", "4", "--area-lights", "mc"), None),
    (("--backend", "reference", "--samples", "64", "--area-lights", "mc"), "--area-lights has no effect with --backend reference"),
    (("--backend", "reference", "--samples", "64", "--area-lights", "off"), None),
    (("--backend", "reference", "--samples", "64", "--light-samples", "4"), "--light-samples has no effect with --backend reference"),
)


@case("usage.an_option_of_lights_without_effect_is_one_warning_that_names_both")
def no_effect_on_light(bench):
    bench.run("bake", "environment", "builtin:sky", "--env-size", "16", "--env-samples", "4", "-q", "-o", "e").expect(0)
    baked = [(("--env", name, option, value), f"{option} has no effect with --env {name}, whose bake has its own")
             for name in ("e", "e/environment.bnenv") for option, value in (("--env-size", "32"), ("--env-samples", "8"), ("--key-lights", "2"))]
    embree = "reference" in bench.run("info").expect(0).out
    for words, warning in (*NO_EFFECT_ON_LIGHT, *baked):
        if not embree and "reference" in words:
            continue
        small = () if "--env" in words else ("--env-size", "16", "--env-samples", "1")
        done = bench.run("render", "builtin:plate", "--size", "16x16", *small, *words, "-o", "a.pfm").expect(0)
        lines = [line for line in done.err.splitlines() if "warning" in line]
        check(lines == ([f"burnish: warning: {warning}"] if warning else []), done.describe())


@case("usage.the_exposure_of_an_environment_has_one_range_in_every_subcommand")
def exposure_range(bench):
    for words in (("render", "builtin:plate"), ("profile", "builtin:plate"), ("info", "--env", "builtin:sky")):
        for value in ("32.5", "120"):
            bench.run(*words, "--env-exposure", value).expect(2).expect_one_line("--env-exposure", "from -32 to 32")


@case("camera.an_environment_that_is_turned_is_a_world_that_is_turned_the_other_way", tier="nightly")
def turned_environment(bench):
    """For each renderer: under an environment at 40 degrees a camera at azimuth 30 sees the view of azimuth -10 on the turned scene."""
    gltf = gltf_files.triangle()
    gltf["materials"] = [{"pbrMetallicRoughness": {"metallicFactor": 1.0, "roughnessFactor": 0.3}}]
    gltf["meshes"][0]["primitives"][0]["material"] = 0
    gltf["extensionsUsed"] = ["KHR_lights_punctual"]
    gltf["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 40.0}]}}
    scene = gltf["scenes"][0]["nodes"]
    panel = {"areaLight": {"shape": "sphere", "points": [0, 0, 0], "radius": 0.3, "radiance": [9, 5, 2]}}
    gltf["nodes"] += [{"translation": [1.0, 2.0, 0.5], "extensions": {"KHR_lights_punctual": {"light": 0}}},
                      {"translation": [-1.5, 1.0, 1.0], "extras": {"burnish": panel}}, {"children": [*scene, 1, 2]}]
    gltf["scenes"][0]["nodes"] = [3]
    scratch(bench, "rests.gltf", gltf_files.text(gltf))
    gltf["nodes"][3]["rotation"] = [0.0, -math.sin(math.radians(20.0)), 0.0, math.cos(math.radians(20.0))]
    scratch(bench, "walks.gltf", gltf_files.text(gltf))
    small = ("--env", "builtin:sky", "--size", "64x64", "--env-size", "64", "--env-samples", "16", "-q")
    runs = {"turned": ("rests.gltf", "--orbit", "30,20", "--env-rotation", "40"), "walked": ("walks.gltf", "--orbit", "-10,20"),
            "plain": ("rests.gltf", "--orbit", "30,20")}
    device = bench.run("render", *small, "--backend", "vulkan", "--device", "lavapipe", *runs["turned"], "-o", "device.pfm", timeout=300.0)
    drawn = 0
    for backend in (("tile",), ("reference", "--samples", "256")):
        codes = {bench.run("render", *small, "--backend", *backend, *words, "-o", name + ".pfm").code for name, words in runs.items()}
        check(codes in ({0}, {77}), f"{backend}: exit codes {codes}")
        if codes == {0}:
            drawn += 1
            bench.run("compare", "walked.pfm", "turned.pfm", "--metric", "flip-hdr", "--fail-flip", "0.001").expect(0)
            bench.run("compare", "plain.pfm", "turned.pfm", "--metric", "flip-hdr", "--fail-flip", "0.01").expect(1)
        if backend == ("tile",) and device.code != 77:
            drawn += 1
            device.expect(0)
            check((bench.folder / "device.pfm").read_bytes() == (bench.folder / "turned.pfm").read_bytes(), "the device's is another picture")
    print(f"{drawn} renderers")
    check(drawn > 0, "no renderer")
