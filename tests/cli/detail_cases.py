"""Surface detail: normal, quaternion and rotation maps by option and by file, shading frames under them, material folders, OBJ files."""

import json
import math
import pathlib
import random
import struct

import gltf_files as files
from compare_cases import pfm, png
from harness import case, check
from input_cases import refuse, scratch
from model_cases import read_pfm
from parity_cases import check_equal, parity
from reference_cases import needs_embree

VIEW = ("--eye", "0.3,0.3,1.2", "--target", "0.3,0.3,0", "--fov", "40", "--size", "40x40", "--msaa", "1", "--env-size", "64", "--env-samples", "32")
METAL = ("--roughness", "0.4", "--anisotropy", "0.8")


def bare(**material):
    """Returns a triangle with texture coordinates and no texture."""
    gltf = files.textured("x.png")
    del gltf["textures"], gltf["images"]
    gltf["materials"] = [{"pbrMetallicRoughness": {"roughnessFactor": 0.5}, "doubleSided": True, **material}]
    return gltf


def bumps(x, y):
    """Returns a normal map texel. The map leans all ways, in smooth waves."""
    nx, ny = 0.5 * math.sin(x * 0.7), 0.5 * math.cos(y * 0.9)
    nz = math.sqrt(1 - nx * nx - ny * ny)
    return tuple(int(127.5 + 127.5 * n) for n in (nx, ny, nz))


def scenes(bench):
    scratch(bench, "bare.gltf", files.text(bare()))
    scratch(bench, "n.png", png(16, 16, bumps))
    return "bare.gltf"


def hash_of(bench, *words):
    found = bench.figures(*words)
    check(found["nan_pixels"] == 0, f"{words}: not all pixels are finite")
    return found["pixel_hash"]


def off_by(bench, a, b):
    """Returns the largest and the mean square difference of two .pfm, as `burnish compare` does, which would load the image library."""
    (*size, one), (*other_size, other) = (read_pfm(bench.folder / name) for name in (a, b))
    check(size == other_size and all(map(math.isfinite, (*one, *other))), f"{a} and {b} are no pictures of one size")
    off = [abs(x - y) for x, y in zip(one, other)]
    return {"max_abs": max(off), "mse": sum(x * x for x in off) / len(off)}


@case("detail.frames_under_a_map_differ_as_they_are_named", tier="nightly")
def frames(bench):
    scene = scenes(bench)
    plain = hash_of(bench, scene, *VIEW, *METAL)
    by = {way: hash_of(bench, scene, *VIEW, *METAL, "--normal-map", "n.png", "--frame-map", way)
          for way in ("gram-schmidt", "quaternion", "normal-only", "off")}
    check(by["off"] == plain, "a map that is off is seen")
    check(len(set(by.values())) == 4, f"two ways give one picture: {by}")
    check(hash_of(bench, scene, *VIEW, *METAL, "--normal-map", "n.png") == by["gram-schmidt"], "gram-schmidt is not the default")
    for way in by:
        check(hash_of(bench, scene, *VIEW, *METAL, "--frame-map", way) == plain, f"{way} changes what has no map")
    # zero length, straight down, and texels that decode to nearly zero
    scratch(bench, "odd.png", png(4, 4, lambda x, y: ((128, 128, 128), (128, 128, 0), (127, 128, 0), (128, 128, 255))[(x + y) % 4]))
    for way in by:
        hash_of(bench, scene, *VIEW, *METAL, "--normal-map", "odd.png", "--frame-map", way)


@case("detail.normal_maps_of_green_down", tier="nightly")
def green_down(bench):
    scene = scenes(bench)
    scratch(bench, "d.png", png(16, 16, lambda x, y: (bumps(x, y)[0], 255 - bumps(x, y)[1], bumps(x, y)[2])))
    up, down = (hash_of(bench, scene, *VIEW, "--normal-map", *words) for words in (("n.png",), ("d.png", "--normal-y", "down")))
    check(up == down, "green down is not green up upside down")
    check(hash_of(bench, scene, *VIEW, "--normal-map", "d.png") != up, "both ways look alike")


@case("detail.quaternion_maps_are_normal_maps", tier="nightly")
def quaternions(bench):
    scene = scenes(bench)
    bench.run("render", scene, *VIEW, *METAL, "--normal-map", "n.png", "-q", "-o", "n.pfm").expect(0)
    scratch(bench, "level.png", png(2, 2, lambda x, y: (128, 128, 255)))
    bench.run("render", scene, *VIEW, *METAL, "-q", "-o", "plain.pfm").expect(0)
    for name, most in (("q.exr", 0.03), ("q.pfm", 0.03), ("q.png", 0.3)):
        bench.run("bake", "quaternion", "n.png", "-o", name).expect(0)
        first = (bench.folder / name).read_bytes()
        bench.run("bake", "quaternion", "n.png", "-o", name).expect(0)
        check((bench.folder / name).read_bytes() == first, f"{name}: other bytes the second time")
        bench.run("render", scene, *VIEW, *METAL, "--quaternion-map", name, "-q", "-o", "q_.pfm").expect(0)
        found = off_by(bench, "n.pfm", "q_.pfm")
        check(found["max_abs"] <= most, f"{name}: {found}")
    # by file, as by option
    gltf = bare(extras={"burnish": {"quaternionTexture": {"index": 0}}})
    gltf["textures"], gltf["images"] = [{"source": 0}], [{"uri": "q.exr"}]
    scratch(bench, "own.gltf", files.text(gltf))
    check(hash_of(bench, "own.gltf", *VIEW, *METAL) == hash_of(bench, scene, *VIEW, *METAL, "--quaternion-map", "q.exr"), "another picture by file")
    # invalid texels become level normals, and are counted
    scratch(bench, "nan.pfm", pfm(4, 4, lambda x, y: (float("nan"), 0, 0) if x == 1 else (0, 0, 0) if x == 2 else (1, 0, 0)))
    done = bench.run("render", scene, *VIEW, *METAL, "--quaternion-map", "nan.pfm", "-o", "r.pfm").expect(0)
    check("8 texels" in done.err, done.describe())
    check(off_by(bench, "plain.pfm", "r.pfm")["max_abs"] < 0.02, "repaired texels are not level")
    scratch(bench, "nan.pfm", pfm(4, 4, lambda x, y: (float("nan"), 0.5, 1) if x == 1 else (0.5, 0.5, 0.5) if x == 2 else (0.5, 0.5, 1)))
    done = bench.run("render", scene, *VIEW, *METAL, "--normal-map", "nan.pfm", "-o", "r.pfm").expect(0)
    check("8 texels of normals" in done.err, done.describe())
    check(off_by(bench, "plain.pfm", "r.pfm")["max_abs"] < 1e-6, "repaired normals are not level")


@case("detail.rotations_are_one_whatever_says_them", tier="nightly")
def rotations(bench):
    scene = scenes(bench)
    expressions = ("cos(pi*v)", "sin(pi*v)")
    found = set()
    for encoding in ("vector", "double-angle", "direction"):
        bench.run("bake", "tpr", "--expr", *expressions, "--size", "8x16", "--encoding", encoding, "-o", encoding + ".exr").expect(0)
        found.add(hash_of(bench, scene, *VIEW, *METAL, "--rotation-map", encoding + ".exr", "--rotation-encoding", encoding))
        gltf = bare(extras={"burnish": {"rotationTexture": {"index": 0, "encoding": encoding.replace("-a", "A")}}})
        gltf["textures"], gltf["images"] = [{"source": 0}], [{"uri": encoding + ".exr"}]
        scratch(bench, "own.gltf", files.text(gltf))
        found.add(hash_of(bench, "own.gltf", *VIEW, *METAL))
    check(len(found) == 1, f"encodings give {len(found)} pictures")
    check(hash_of(bench, scene, *VIEW, *METAL) not in found, "the rotation is not seen")
    check(hash_of(bench, scene, *VIEW, *METAL, "--rotation-map", "vector.exr", "--rotation-encoding", "double-angle") not in found,
          "encodings are not told apart")
    # a rotation of 30 degrees after one of 20 gives 50
    for name, degrees in (("a", 20), ("b", 50)):
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        bench.run("bake", "tpr", "--expr", f"{c!r}", "--expr", f"{s!r}", "--size", "2x2", "-o", name + ".pfm").expect(0)
    gltf = bare(extensions={"KHR_materials_anisotropy": {"anisotropyStrength": 0.8, "anisotropyRotation": math.radians(30)}})
    gltf["extensionsUsed"] = ["KHR_materials_anisotropy"]
    scratch(bench, "turned.gltf", files.text(gltf))
    gltf["materials"][0]["extensions"]["KHR_materials_anisotropy"]["anisotropyRotation"] = 0
    scratch(bench, "straight.gltf", files.text(gltf))
    bench.run("render", "turned.gltf", *VIEW, "--rotation-map", "a.pfm", "-q", "-o", "ab.pfm").expect(0)
    bench.run("render", "straight.gltf", *VIEW, "--rotation-map", "b.pfm", "-q", "-o", "b_.pfm").expect(0)
    check(off_by(bench, "ab.pfm", "b_.pfm")["max_abs"] < 0.01, "rotations do not add up")


def square(turned):
    """Returns an OBJ file: a square in the xy plane whose texture is turned by `turned` degrees."""
    c, s = 0.5 * math.cos(math.radians(turned)), 0.5 * math.sin(math.radians(turned))
    corners = [(x, y) for x, y in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))]
    lines = [f"v {0.3 + 0.6 * x} {0.3 + 0.6 * y} 0" for x, y in corners]
    lines += [f"vt {0.5 + c * x + s * y} {0.5 - s * x + c * y}" for x, y in corners]
    return "\n".join(lines + ["f 1/1 2/2 3/3 4/4", ""]).encode()


# For any orientation of the texture coordinates, the grain has the requested direction. The filter blurs a border of one texel.
@case("detail.straightened_grain_lies_in_one_direction", tier="nightly")
def straightened(bench):
    drawn = {}
    for turned in (0, 30, 200):
        scratch(bench, f"{turned}.obj", square(turned))
        bench.run("bake", "tpr", "--straighten", f"{turned}.obj", "--direction", "0.8,0.6,0", "--size", "32x32", "-o", f"{turned}.exr", "-q").expect(0)
        for name, words in (("with", ("--rotation-map", f"{turned}.exr")), ("without", ())):
            bench.run("render", f"{turned}.obj", *VIEW, *METAL, "--f0", "1,1,1", *words, "-q", "-o", f"{name}{turned}.pfm").expect(0)
            drawn[name, turned] = f"{name}{turned}.pfm"
    for turned in (30, 200):
        apart = off_by(bench, drawn["with", 0], drawn["with", turned])["mse"]
        check(apart < 1e-4, f"{turned} degrees: {apart}")
    bench.run("render", "30.obj", *VIEW, *METAL, "--f0", "1,1,1", "--rotation-map", "0.exr", "-q", "-o", "other.pfm").expect(0)
    check(off_by(bench, "other.pfm", drawn["with", 30])["mse"] > 1e-3, "the square's own map is not what turns it")
    check(off_by(bench, drawn["without", 0], drawn["without", 30])["mse"] > 1e-3, "the grain does not lie with the texture")


EYE = (1.2, 0.9, 3.0)


def patched_sphere(islands):
    """Returns an OBJ file: a sphere of six patches, without the part farthest from the eye. Its texture has six islands, each turned
    differently, or one piece, projected from the eye with equal areas (Lambert's azimuthal projection)."""
    n, lines, faces, kept = 24, [], [], []
    length = math.hypot(*EYE)
    e = [c / length for c in EYE]
    flat = math.hypot(e[0], e[2])
    right, up = (e[2] / flat, 0, -e[0] / flat), (-e[0] * e[1] / flat, flat, -e[2] * e[1] / flat)
    for patch, (c, s) in enumerate(((1, 0), (0, 1), (-1, 0), (0, -1), (0.8, 0.6), (-0.6, 0.8))):
        sign = 1 - 2 * (patch % 2)
        for row in range(n + 1):
            for column in range(n + 1):
                a, b = (math.tan(math.pi / 2 * (k / n - 0.5)) for k in (column, row))
                at = {0: (sign, a, sign * b), 1: (sign * b, sign, a), 2: (a, sign * b, sign)}[patch // 2]
                at = [k / math.hypot(*at) for k in at]
                seen, x, y = (sum(p * q for p, q in zip(at, axis)) for axis in (e, right, up))
                kept.append(seen > -0.9)
                u, v = (0.35 * (2 * k / n - 1) for k in (column, row))
                far = 0.5 / math.sqrt(2 * max(1 + seen, 1e-3))
                uv = ((patch % 3 + 0.5 + c * u - s * v) / 3, (patch // 3 + 0.5 + s * u + c * v) / 2) if islands else (0.5 + far * x, 0.5 - far * y)
                place = " ".join(f"{k:.7f}" for k in at)
                lines += [f"v {place}", f"vt {uv[0]:.7f} {uv[1]:.7f}", f"vn {place}"]
        first = patch * (n + 1) ** 2
        for k in (first + row * (n + 1) + column for row in range(n) for column in range(n)):
            corners = (k, k + 1, k + n + 2, k + n + 1)
            if all(kept[corner] for corner in corners):
                faces.append("f " + " ".join(f"{corner + 1}/{corner + 1}/{corner + 1}" for corner in corners))
    return "\n".join(lines + faces) + "\n"


# This technique's samples are symmetric along the grain, which has no sign. The islands turn by arbitrary angles.
@case("detail.a_sphere_of_six_islands_looks_as_one_of_one_piece", tier="nightly")
def islands(bench):
    words = ("--eye", ",".join(map(str, EYE)), "--target", "0,0,0", "--fov", "40", "--size", "160x160", "--msaa", "4", "--roughness", "0.4", "--anisotropy", "0.8",
             "--f0", "1,1,1", "--technique", "major_axis_weighted", "--texture-anisotropy", "16", "-q")
    for name, cut in (("whole", False), ("cut", True)):
        scratch(bench, name + ".obj", patched_sphere(cut))
        bench.run("bake", "tpr", "--straighten", name + ".obj", "--direction", "0.3,1,0.2", "--size", "256x256", "-q", "-o", name + ".exr").expect(0)
        bench.run("render", name + ".obj", *words, "--rotation-map", name + ".exr", "-o", name + ".pfm").expect(0)
        bench.run("render", name + ".obj", *words, "-o", name + "_as_it_lies.pfm").expect(0)

    def flip(a, b):
        return json.loads(bench.run("compare", a, b, "--metric", "flip", "--json", "-").expect(0).out)["flip_mean"]

    straight = flip("whole.pfm", "cut.pfm")
    check(straight < 0.003, f"cut and straightened: {straight}")
    check(flip("whole_as_it_lies.pfm", "cut_as_it_lies.pfm") > 0.1, "islands do not turn the grain")


# Rotation first, then bump: the frame turned by a normal map carries the rotated grain.
@case("detail.rotations_and_bumps_give_the_same_words_on_devices", tier="nightly")
def devices(bench):
    scene = scenes(bench)
    bench.run("bake", "tpr", "--expr", "cos(pi*v)", "sin(pi*v)", "--size", "8x16", "-o", "r.exr").expect(0)
    common = (scene, "--size", "48x32", "--msaa", "1", "--env", "builtin:sky", "--normal-map", "n.png")
    check_equal(parity(bench, *common, also=(("--frame-map", "quaternion", "--rotation-map", "r.exr", "--mip-filter", "lean"),
                                             ("--frame-map", "normal-only", "--technique", "mc", "--samples", "9"))))


@case("detail.lean_keeps_what_a_mip_level_loses", tier="nightly")
def lean(bench):
    needs_embree(bench)
    chance = random.Random(7)

    def grain(x, y):
        """Returns a texel with random slopes, approximately normally distributed."""
        sx, sy = (0.15 * sum(chance.uniform(-1, 1) for _ in range(3)) for _ in range(2))
        length = math.sqrt(1 + sx * sx + sy * sy)
        return tuple(int(127.5 + 127.5 * n / length + 0.5) for n in (-sx, -sy, 1))

    scratch(bench, "fine.png", png(512, 256, grain))
    words = ("builtin:sphere", "--size", "24x24", "--env-size", "64", "--env-samples", "64", "--key-lights", "off", "--no-background",
             "--roughness", "0.25", "--anisotropy", "0", "--normal-map", "fine.png", "-q")
    bench.run("render", *words, "--backend", "reference", "--reference-textures", "full", "--samples", "2048", "-o", "reference.pfm").expect(0)
    off = {}
    for way in ("box", "lean"):
        for taps in ("1", "16"):
            bench.run("render", *words, "--mip-filter", way, "--texture-anisotropy", taps, "--technique", "mc", "--samples", "1024", "--msaa", "4",
                      "-o", "t.pfm").expect(0)
            off[way, taps] = off_by(bench, "reference.pfm", "t.pfm")["mse"]
    for taps in ("1", "16"):
        check(off["lean", taps] < 0.4 * off["box", taps], f"{off}")


@case("detail.reflectance_of_all_materials")
def reflectance(bench):
    metal = bare(pbrMetallicRoughness={"roughnessFactor": 0.3, "baseColorFactor": [0.5, 0.6, 0.7, 1]})
    scratch(bench, "metal.gltf", files.text(metal))
    bench.run("render", "metal.gltf", *VIEW, "-q", "-o", "a.pfm").expect(0)
    bench.run("render", "metal.gltf", *VIEW, "--f0", "0.5,0.6,0.7", "-q", "-o", "b.pfm").expect(0)
    check(off_by(bench, "a.pfm", "b.pfm")["max_abs"] < 1e-3, "a metal of its own reflectance looks otherwise")
    for bad in ("1,2", "0.5,0.5,1.5", "-0.1,0,0", "red", "nan,0,0"):
        bench.run("render", "metal.gltf", "--f0=" + bad, "-o", "a.png").expect(2).expect_one_line("--f0")


@case("detail.material_folders_are_read_by_name", tier="nightly")
def folders(bench):
    scene = scenes(bench)
    folder = pathlib.Path(bench.folder) / "set"
    folder.mkdir()
    grey = lambda value, side: png(side, side, lambda x, y: (value,), channels=1)
    for name, data in (("brass_basecolor.png", png(8, 8, lambda x, y: (200, 150, 90))), ("brass_Metallic.png", grey(255, 2)),
                       ("brass-roughness.png", png(4, 4, lambda x, y: (20000,), channels=1, bits=16)), ("normal.png", png(16, 16, bumps)),
                       ("brass_ao.png", grey(200, 3))):
        (folder / name).write_bytes(data)
    by_folder = hash_of(bench, scene, *VIEW, "--material", "set")
    gltf = bare(pbrMetallicRoughness={"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1}}, normalTexture={"index": 2},
                occlusionTexture={"index": 3})
    del gltf["materials"][0]["doubleSided"]
    scratch(bench, "mr.png", png(4, 4, lambda x, y: (65535, 20000, 65535), bits=16))
    scratch(bench, "ao.png", png(3, 3, lambda x, y: (200, 200, 200)))
    scratch(bench, "b.png", png(8, 8, lambda x, y: (200, 150, 90)))
    gltf["textures"] = [{"source": i} for i in range(4)]
    gltf["images"] = [{"uri": uri} for uri in ("b.png", "mr.png", "n.png", "ao.png")]
    scratch(bench, "own.gltf", files.text(gltf))
    check(hash_of(bench, "own.gltf", *VIEW) == by_folder, "a folder is not the file's own material")
    (folder / "brass-roughness.png").write_bytes(grey(78, 4))  # all 8 bits, like the combined texture
    scratch(bench, "mr.png", png(4, 4, lambda x, y: (65535, 257 * 78, 65535), bits=16))
    check(hash_of(bench, "own.gltf", *VIEW) == hash_of(bench, scene, *VIEW, "--material", "set") != by_folder, "8 bits say something else")
    (folder / "brass_glow.png").write_bytes(grey(1, 1))
    done = bench.run("render", scene, *VIEW, "--material", "set", "-o", "a.pfm").expect(0)
    check(done.err.count("warning") == 1 and "brass_glow.png" in done.err, done.describe())
    (folder / "other_albedo.png").write_bytes(grey(1, 1))
    bench.run("render", scene, *VIEW, "--material", "set", "-o", "a.png").expect(2).expect_one_line("--material", "basecolor", "albedo")
    empty = pathlib.Path(bench.folder) / "empty"
    empty.mkdir()
    for words, needle in ((("--material", "empty"), "empty"), (("--material", "nowhere"), "nowhere"), (("--normal-map", "no.png"), "no.png")):
        bench.run("render", scene, *VIEW, *words, "-o", "a.png").expect(4).expect_one_line(needle)
    gltf = files.triangle()
    scratch(bench, "flat.gltf", files.text(gltf))
    for option in ("--normal-map", "--quaternion-map", "--rotation-map"):
        bench.run("render", "flat.gltf", *VIEW, option, "n.png", "-o", "a.png").expect(4).expect_one_line("n.png", "texture coordinates")


@case("detail.an_encoding_without_its_map_is_refused", "input")
def no_map(bench):
    scene = scratch(bench, "bare.gltf", files.text(bare()))
    (pathlib.Path(bench.folder) / "set").mkdir()
    scratch(bench, "set/x_normal.png", png(2, 2, lambda x, y: (128, 128, 255)))
    for words in (("--normal-y", "down"), ("--rotation-encoding", "direction"), ("--rotation-encoding", "double-angle", "--material", "set"),
                  ("--roughness-encoding", "anisotropy"), ("--roughness-encoding", "anisotropy", "--material", "set")):
        bench.run("render", scene, *VIEW, *words, "-o", "a.pfm").expect(2).expect_one_line(words[0], "no ")
    for words in (("--normal-y", "up"), ("--normal-y", "down", "--material", "set")):
        bench.run("render", scene, *VIEW, *words, "-q", "-o", "a.pfm").expect(0)


@case("detail.a_map_with_too_few_channels_is_called_by_its_kind", "input")
def grey_maps(bench):
    scene = scratch(bench, "bare.gltf", files.text(bare()))
    scratch(bench, "grey.png", png(2, 2, lambda x, y: (128,), channels=1))
    for option, kind in (("--normal-map", "normal map"), ("--quaternion-map", "quaternion map"), ("--direction-map", "map of directions"),
                         ("--rotation-map", "map of rotations"), ("--roughness-map", "roughness map")):
        bench.run("render", scene, *VIEW, option, "grey.png", "-o", "a.pfm").expect(4).expect_one_line("grey.png", kind)


@case("detail.faults_of_maps_are_named_by_their_place", "input")
def faults(bench):
    at = "/materials/0/extras/burnish/"
    for key, info, place in (("quaternionTexture", 3, "quaternionTexture"), ("quaternionTexture", {"index": 9}, "quaternionTexture/index"),
                             ("rotationTexture", {}, "rotationTexture"), ("rotationTexture", {"index": 0, "encoding": "hue"}, "rotationTexture/encoding"),
                             ("rotationTexture", {"index": 0, "encoding": 2}, "rotationTexture/encoding"), ("lean", 1, "lean")):
        gltf = bare(extras={"burnish": {key: info}})
        gltf["textures"], gltf["images"] = [{"source": 0}], [{"uri": "n.png"}]
        refuse(bench, scratch(bench, "bad.gltf", files.text(gltf)), needles=(at + place,))


@case("detail.expressions_say_where_they_are_wrong", "input")
def expressions(bench):
    there = bench.left_behind()
    for expr, needles in ((("cos(pi*v", "1"), ("--expr", "column 9")), (("1+*u", "1"), ("column 3",)), (("sin(w)", "1"), ("column 5", "w")),
                          (("1/(u-0.75)", "v"), ("texel 1,0", "u 0.75", "v 0.5")), (("0", "u-u"), ("texel 0,0",)), (("1",), ("--expr", "two")),
                          (("", "1"), ("--expr",)), (("1" + "+1" * 600, "1"), ("--expr", "1000")), (("1,2", "1"), ("--expr",)),
                          (("u=2", "1"), ("column 2",)), (("((((" * 100, "1"), ("--expr", "column"))):
        given = [word for text in expr for word in ("--expr", text)]
        bench.run("bake", "tpr", *given, "--size", "2x1", "-o", "t.exr").expect(2).expect_one_line(*needles)
        check(bench.left_behind() == there, "something is left behind")
    for words, code, needles in ((("quaternion", "-o", "q.png"), 2, ("PICTURE",)), (("quaternion", "no.png", "-o", "q.png"), 4, ("no.png",)),
                                 (("tpr", "--expr", "1", "0", "-o", "q.jpg"), 2, ("-o",)), (("tpr", "--expr", "1", "0"), 2, ("-o",)),
                                 (("quaternion", "n.png", "--expr", "1", "-o", "q.png"), 2, ("--expr", "tpr"))):
        bench.run("bake", *words).expect(code).expect_one_line(*needles)


QUAD = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"


@case("detail.obj_files_are_read", "input", tier="nightly")
def obj(bench):
    scratch(bench, "n.png", png(16, 16, bumps))
    texts = {"triangles": QUAD + "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n", "quad": QUAD + "f 1/1 2/2 3/3 4/4\n", "back": QUAD + "f -4/-4 -3/-3 -2/-2 -1/-1\n",
             "groups": QUAD + "g a\nf 1/1 2/2 3/3\no b\nf 1/1 3/3 4/4\n", "normals": "vn 0 0 2\n" + QUAD + "f 1/1/1 2/2/1 3/3/1 4/4/1\r\n"}
    found = {}
    for name, text in texts.items():
        scratch(bench, name + ".obj", text)
        found[name] = hash_of(bench, name + ".obj", *VIEW, "--normal-map", "n.png")
    check(len(set(found.values())) == 1, f"one square looks {len(set(found.values()))} ways: {found}")
    scratch(bench, "turned.obj", QUAD.replace("vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1", "vt 1 0\nvt 1 1\nvt 0 1\nvt 0 0") + "f 1/1 2/2 3/3 4/4\n")
    check(hash_of(bench, "turned.obj", *VIEW, "--normal-map", "n.png") not in found.values(), "texture coordinates do not count")
    # a polygon with a notch, where a fan would fill the outside
    scratch(bench, "notch.obj", "v 0 0 0\nv 1 0 0\nv 0.2 0.2 0\nv 0 1 0\nf 2 3 4 1\n")
    scratch(bench, "cut.obj", "v 0 0 0\nv 1 0 0\nv 0.2 0.2 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n")
    a, b = (bench.figures(name, *VIEW, "--no-background")["pixel_hash"] for name in ("notch.obj", "cut.obj"))
    check(a == b, "a polygon with a notch is filled")
    done = bench.run("render", scratch(bench, "m.obj", "mtllib x.mtl\n" + QUAD + "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n"), *VIEW, "-o", "a.pfm").expect(0)
    check(done.err.count("warning") == 3 and "library x.mtl is not found" in done.err, done.describe())
    for text, needle in ((QUAD + "f 1 2 9\n", "face 1"), (QUAD + "f 1 2 3\nf 1 2 -9\n", "face 2"), (QUAD + "f 1/9 2/2 3/3\n", "texture coordinates"),
                         (QUAD + "f 1//1 2//1 3//1\n", "normals"), ("v 1e999 0 0\n" + QUAD + "f 1 2 3\n", "position 1"), (QUAD, "no faces"), ("", ""),
                         (QUAD + "f 1 2\n", "face 1"), (QUAD + "f 2000000000 1 2\n", "face 1"), (QUAD + "f 0 1 2\n", "face 1"),
                         (QUAD + "f 99999999999999999999 1 2\n", "face 1"), (QUAD + "f " + "1 2 3 " * 400 + "\n", "1200"), (QUAD + "f a b c\n", "face 1")):
        refuse(bench, scratch(bench, "bad.obj", text), needles=(needle,))
    bench.run("render", "no.obj", "-o", "a.png").expect(4).expect_one_line("no.obj")
    bench.run("render", "quad.obj", "--limit-accessor-bytes", "100", "-o", "a.png").expect(4).expect_one_line("--limit-accessor-bytes")


# Equal lobes and Fresnel factors, sampled in two ways. With few samples the filter replaces further ones.
@case("detail.as_mc_is_monte_carlo_of_its_lobe", tier="nightly")
def phong(bench):
    words = ("builtin:spheres", "--size", "48x36", "--msaa", "1", "--env-size", "64", "--env-samples", "64", "--key-lights", "off", "--no-background",
             "-q", "--technique")
    bench.run("render", *words, "mc", "--brdf", "ashikhmin_shirley", "--samples", "4096", "-o", "reference.pfm").expect(0)
    for samples, most in (("2048", 1e-4), ("64", 1e-2), ("16", 3e-2)):  # neighbours share samples, and see little alike in so small an image
        bench.run("render", *words, "as_mc", "--samples", samples, "-o", "t.pfm").expect(0)
        found = off_by(bench, "reference.pfm", "t.pfm")
        check(found["mse"] < most, f"{samples} samples: {found}")
    bench.run("render", *words, "as_mc", "--brdf", "ashikhmin_shirley", "-o", "t.pfm").expect(2).expect_one_line("as_mc", "ggx_aniso")


def smooth(x, y):
    """Returns a texel of a smooth environment with 64 x 32 texels."""
    t, p = math.pi * (y + 0.5) / 32, 2 * math.pi * (x + 0.5) / 64
    a, b, c = math.cos(t), math.sin(t) * math.cos(p), math.sin(t) * math.sin(p)
    return (1 + 0.5 * a + 0.4 * b * c, 1 + 0.6 * a - 0.3 * b, 1.2 + 0.5 * c * a)


# Every pixel sees one place of a plane, which compares the lobe alone. Over a pixel's area the reference takes a mean, and techniques shade
# one place of each triangle. On curved objects a z-test finds this difference for every lobe.
@case("detail.phong_lobes_meet_the_reference", tier="nightly")
def phong_reference(bench):
    needs_embree(bench)
    scratch(bench, "smooth.pfm", pfm(64, 32, smooth))
    scratch(bench, "q.obj", square(0))

    def mean(*words):
        bench.run("render", "q.obj", "--size", "32x24", "--msaa", "1", "--fov", "0.1", "--env", "smooth.pfm", "--env-size", "64", "--env-samples", "32",
                  "--key-lights", "off", "--no-background", "--roughness", "0.6", *words, "-q", "-o", "m.pfm").expect(0)
        data = (bench.folder / "m.pfm").read_bytes()
        values = struct.unpack("<%df" % (32 * 24 * 3), data[-32 * 24 * 12:])
        return [sum(values[c::3]) / (32 * 24) for c in range(3)]

    off = {}
    for degrees, eta in ((20, "-0.5"), (60, "0.5"), (80, "0.5"), (84, "-0.5")):
        a = math.radians(degrees)
        words = ("--eye", f"{0.3 + 3 * math.sin(a)},0.3,{3 * math.cos(a)}", "--target", "0.3,0.3,0", "--anisotropy", eta, "--f0", "0.9,0.6,0.3")
        reference = mean(*words, "--backend", "reference", "--brdf", "ashikhmin_shirley", "--samples", "1024")
        for name, given in (("mc", ("--technique", "mc", "--brdf", "ashikhmin_shirley", "--samples", "512")),
                            ("1024", ("--technique", "as_mc", "--samples", "1024")), ("16", ("--technique", "as_mc", "--samples", "16")),
                            ("turned", ("--technique", "as_mc", "--samples", "16", "--seed", "5")),
                            ("no table", ("--technique", "as_mc", "--samples", "16", "--as-tables", "off"))):
            found = mean(*words, *given)
            off.setdefault(name, []).append(max(abs(x / t - 1) for x, t in zip(found, reference)))
    check(max(off["mc"]) < 0.002, f"mc: {off}")
    check(max(off["1024"]) < 0.005, f"as_mc: {off}")
    check(max(off["16"]) < 0.01 and max(off["no table"]) > 2 * max(off["16"]), f"as_mc of 16 samples: {off}")
    check(max(off["turned"]) < 0.01 and off["turned"] != off["16"], f"as_mc, turned: {off}")


# One sample equals a mirror, dimmed by the lobe's albedo, which compensation restores.
@case("detail.one_sample_of_as_mc_is_a_mirror", tier="nightly")
def one_sample(bench):
    words = ("builtin:teapot", "--size", "48x36", "--msaa", "1", "--env-size", "64", "--env-samples", "32", "--key-lights", "off", "--no-background", "-q",
             "--f0", "1,1,1", "--anisotropy", "0.5", "--technique", "as_mc")
    bench.run("render", *words, "--roughness", "0.4", "--samples", "1", "--energy-compensation", "-o", "one.pfm").expect(0)
    bench.run("render", *words, "--roughness", "0", "--samples", "64", "-o", "mirror.pfm").expect(0)
    bench.run("render", *words, "--roughness", "0.4", "--samples", "16", "--energy-compensation", "-o", "more.pfm").expect(0)
    found = off_by(bench, "mirror.pfm", "one.pfm")
    check(found["mse"] < 1e-5, f"{found}")
    check(off_by(bench, "mirror.pfm", "more.pfm")["mse"] > 1e-3, "16 samples are a mirror, too")


@case("detail.tables_of_phong_lobes_are_written", "input")
def phong_tables(bench):
    bench.run("bake", "brdf-lut", "--nu", "100", "--nv", "10", "--size", "9x9", "--azimuth", "linear", "-q", "-o", "a.pfm").expect(0)
    values = struct.unpack("<243f", (bench.folder / "a.pfm").read_bytes()[-972:])
    rows = [[values[3 * (9 * y + x):3 * (9 * y + x) + 2] for x in range(9)] for y in reversed(range(9))]  # the file begins with the bottom row
    # from the normal there is no azimuth, and a symmetric lobe has equal albedo at both ends
    check(max(abs(sum(rows[8][x]) - sum(rows[8][0])) for x in range(9)) < 2e-3, f"{rows[8]}")
    check(all(0 < s + b <= 1.002 for row in rows for s, b in row), "an albedo above 1")
    bench.run("bake", "brdf-lut", "--nu", "10", "--nv", "100", "--size", "9x9", "--azimuth", "linear", "-q", "-o", "b.pfm").expect(0)
    other = struct.unpack("<243f", (bench.folder / "b.pfm").read_bytes()[-972:])
    turned = [[other[3 * (9 * y + x):3 * (9 * y + x) + 2] for x in reversed(range(9))] for y in reversed(range(9))]
    check(max(abs(p - q) for a, b in zip(rows, turned) for c, d in zip(a, b) for p, q in zip(c, d)) < 4e-3, "axes are not turned")
    bench.run("bake", "half-vectors", "--nu", "20000", "--nv", "70", "--size", "64x64", "-o", "h.exr").expect(0)
    done = bench.run("bake", "half-vectors", "--nu", "20000", "--nv", "70", "--size", "64x64", "-o", "h.png").expect(0)
    check("8 bits leave" in done.err, done.describe())
    there = bench.left_behind()
    for words, needle in ((("brdf-lut", "--nu", "1"), "--nv"), (("half-vectors", "--nv", "1"), "--nu"), (("brdf-lut", "--nu=-1", "--nv", "1"), "--nu"),
                          (("brdf-lut", "--nu", "nan", "--nv", "1"), "--nu"), (("brdf-lut", "--nu", "1", "--nv", "1e8"), "--nv"),
                          (("quaternion", "n.png", "--nu", "1"), "--nu")):
        bench.run("bake", *words, "-o", "t.exr").expect(2).expect_one_line(needle)
    bench.run("bake", "brdf-lut", "--nu", "1", "--nv", "1", "-o", "t.png").expect(2).expect_one_line("-o", ".exr")
    check(bench.left_behind() == there, "something is left behind")


@case("detail.a_scene_alone_is_drawn")
def alone(bench):
    scratch(bench, "q.obj", square(0))
    bench.run("q.obj", *VIEW, "-q", "-o", "a.pfm").expect(0)
    bench.run("render", "q.obj", *VIEW, "-q", "-o", "b.pfm").expect(0)
    check((bench.folder / "a.pfm").read_bytes() == (bench.folder / "b.pfm").read_bytes(), "not as render draws it")
    bench.run("q.stl", "-o", "a.png").expect(2).expect_one_line("no subcommand")
