"""Mip filters of normals and lobes: --mip-filter, --mip-kappa, --mip-pyramid, `burnish bake mip`."""

import json
import math
import pathlib
import random
import re
import signal
import struct
import subprocess
import time

import gltf_files as files
from compare_cases import png
from detail_cases import bare, bumps, hash_of, off_by
from environment_files import small_sky
from harness import case, check
from input_cases import scratch
from layer_cases import exr_channels, lone_plane
from model_cases import read_pfm
from parity_cases import check_equal, parity
from reference_cases import needs_embree

SMALL = ("--size", "64x48", "--msaa", "1", "--env-size", "64", "--env-samples", "32", "--samples", "4", "--technique", "mc", "--floor", "off")
LOBES = ("baseline", "covariance", "leadr", "ssgt", "kappa", "mipnet")
SEARCHED = (*LOBES, "teacher")  # for small maps: teacher takes half a minute for a million texels
VIEW = ("--eye", "0.3,0.3,1.2", "--target", "0.3,0.3,0", "--fov", "40", "--size", "40x40", "--msaa", "1", "--env-size", "64", "--env-samples", "32")


def named(bench):
    return [line.split()[0] for line in bench.run("list", "mip-filters").expect(0).out.splitlines()]


def grain(side, steep, seed=7):
    """Returns an image of random normals, approximately normally distributed."""
    chance = random.Random(seed)

    def texel(x, y):
        sx, sy = (steep * sum(chance.uniform(-1, 1) for _ in range(3)) for _ in range(2))
        length = math.sqrt(1 + sx * sx + sy * sy)
        return tuple(int(127.5 + 127.5 * n / length + 0.5) for n in (-sx, -sy, 1))

    return png(2 * side, side, texel)


@case("mip.each_filter_has_pictures_of_its_own", tier="nightly")
def pictures(bench):
    names = named(bench)
    check(names[:2] == ["box", "lean"] and set(SEARCHED) <= set(names), f"{names}")
    names.remove("teacher")
    by = {name: hash_of(bench, "builtin:bumps", *SMALL, "--mip-filter", name) for name in names}
    check(len(set(by.values())) == len(names), f"two filters draw one picture: {by}")
    check(hash_of(bench, "builtin:bumps", *SMALL) == by["box"], "box is not the default")
    for words in (("--threads", "3"), ("--isa", "scalar"), ("--frame-map", "normal-only")):
        check(hash_of(bench, "builtin:bumps", *SMALL, "--mip-filter", "kappa", *words)
              == (by["kappa"] if words[0] != "--frame-map" else hash_of(bench, "builtin:bumps", *SMALL, "--mip-filter", "kappa", "--frame-map", "quaternion")),
              f"{words} change a picture")
    for name, words in (("off", ("--frame-map", "off")), ("kappa", ("--mip-filter", "kappa")), ("both", ("--mip-filter", "kappa", "--frame-map", "off"))):
        bench.run("render", "builtin:bumps", *SMALL, *words, "-q", "-o", name + ".pfm").expect(0)
    check(off_by(bench, "off.pfm", "both.pfm")["mse"] < 0.05 * off_by(bench, "kappa.pfm", "both.pfm")["mse"], "normal maps that are off are filtered")
    wide, narrow = (hash_of(bench, "builtin:bumps", *SMALL, "--mip-filter", "kappa", "--mip-kappa", kappa) for kappa in ("2", "0"))
    check(len({wide, narrow, by["kappa"]}) == 3, "kappa is not looked at")
    check(hash_of(bench, "builtin:bumps", *SMALL, "--mip-filter", "kappa", "--mip-kappa", "0.7") == by["kappa"], "kappa 0.7 is not the default")
    for name in names:  # overrides replace the maps' lobes and keep the spread of normals
        hash_of(bench, "builtin:bumps", *SMALL, "--mip-filter", name, "--roughness", "0.3", "--anisotropy", "0.5")
    done = bench.run("render", "builtin:bumps", *SMALL, "--mip-filter", "ssgt", "--mip-kappa", "1", "-o", "a.pfm").expect(0)
    check("--mip-kappa has no effect with --mip-filter ssgt" in done.err, done.describe())
    bench.run("render", "--mip-filter", "bow", "-o", "a.png").expect(2).expect_one_line("--mip-filter")


@case("mip.filtered_materials_give_the_same_words_on_devices", tier="nightly")
def devices(bench):
    looks = [("--mip-filter", name) for name in LOBES[1:]] + [("--mip-filter", "kappa", "--mip-gain", "on"), ("--couple", "albedo", "--color-kernel", "kaiser"), ("--technique", "mc", "--samples", "4", "--mip-filter", "kappa", "--roughness", "0.3")]
    check_equal(parity(bench, "builtin:bumps", "--size", "48x36", "--msaa", "1", "--technique", "auto", "--mip-filter", LOBES[0], also=looks))


@case("mip.a_tilted_map_turns_no_lobe")
def tilted(bench):
    """With one normal everywhere no filter widens a lobe, and lobes lie as in --frame-map quaternion."""
    scratch(bench, "bare.gltf", files.text(bare(extensions={"KHR_materials_anisotropy": {"anisotropyStrength": 0.7, "anisotropyRotation": 0.4}})))
    scratch(bench, "n.png", png(64, 64, lambda x, y: (200, 170, 228)))
    words = ("bare.gltf", *VIEW, "--normal-map", "n.png", "-q")
    bench.run("render", *words, "--frame-map", "quaternion", "-o", "box.pfm").expect(0)
    bench.run("render", *words, "-o", "other.pfm").expect(0)
    turned = off_by(bench, "box.pfm", "other.pfm")["max_abs"]
    for name in SEARCHED:
        bench.run("render", *words, "--mip-filter", name, "-o", "a.pfm").expect(0)
        off = off_by(bench, "box.pfm", "a.pfm")["max_abs"]
        check(off < 0.05 * turned, f"{name} turns a lobe: {off}, another frame {turned}")


@case("mip.lobes_keep_what_a_level_loses", budget=4)
def keeps(bench):
    needs_embree(bench)
    scratch(bench, "fine.png", grain(256, 0.15))
    words = ("builtin:sphere", "--size", "24x24", "--env-size", "64", "--env-samples", "64", "--key-lights", "off", "--no-background",
             "--normal-map", "fine.png", "-q")
    bench.run("render", *words, "--frame-map", "quaternion", "--backend", "reference", "--reference-textures", "full", "--samples", "2048", "-o",
              "reference.pfm").expect(0)
    off = {}
    for name in ("box", *LOBES):
        for taps in ("1", "16"):
            bench.run("render", *words, "--mip-filter", name, "--frame-map", "quaternion", "--texture-anisotropy", taps, "--technique", "mc",
                      "--samples", "1024", "--msaa", "4", "-o", "t.pfm").expect(0)
            off[name, taps] = off_by(bench, "reference.pfm", "t.pfm")["mse"]
    for taps in ("1", "16"):
        for name, share in (("leadr", 1.0), ("ssgt", 0.5), ("kappa", 0.5)):  # leadr's widths are Beckmann's
            check(off[name, taps] < share * off["box", taps], f"{off}")


@case("mip.a_map_of_roughness_is_filtered_without_normals")
def roughness(bench):
    gltf = bare(pbrMetallicRoughness={"metallicRoughnessTexture": {"index": 0}})
    gltf["textures"], gltf["images"] = [{"source": 0}], [{"uri": "r.png"}]
    scratch(bench, "rough.gltf", files.text(gltf))
    scratch(bench, "r.png", png(256, 256, lambda x, y: (0, 40 if (x + y) % 2 else 220, 255)))
    by = {name: hash_of(bench, "rough.gltf", *VIEW, "--mip-filter", name) for name in ("box", "lean", "baseline", "covariance", "kappa")}
    check(by["lean"] == by["box"] and by["kappa"] == by["covariance"], f"{by}")
    check(len({by["box"], by["baseline"], by["covariance"]}) == 3, f"{by}")
    # root mean square of alpha: .0246 and .7441 give .5264, roughness .7256
    words = ("rough.gltf", *VIEW, "--technique", "mc", "--samples", "64", "-q")
    bench.run("render", *words, "--mip-filter", "covariance", "-o", "a.pfm").expect(0)
    bench.run("render", *words, "--roughness", "0.7256", "-o", "b.pfm").expect(0)
    check(off_by(bench, "a.pfm", "b.pfm")["max_abs"] < 5e-3, f"{off_by(bench, 'a.pfm', 'b.pfm')}")


def material(bench, name, normal):
    folder = pathlib.Path(bench.folder) / name
    folder.mkdir()
    (folder / "x_normal.png").write_bytes(png(*normal))
    (folder / "x_roughness.png").write_bytes(png(16, 16, lambda x, y: (40 + 12 * x,), channels=1))
    return name


@case("mip.a_pyramid_that_was_baked_sets_the_filter")
def filter_of_file(bench):
    material(bench, "set", (16, 16, bumps))
    material(bench, "other", (16, 16, lambda x, y: bumps(x + 1, y)))
    bench.run("bake", "mip", "set", "--mip-filter", "leadr", "-q", "-o", "leadr.mip").expect(0)
    words = ("render", "builtin:sphere", *SMALL, "--material", "set", "--mip-pyramid", "leadr.mip", "-o", "a.pfm")
    bench.run(*words, "--mip-filter", "box").expect(4).expect_one_line("leadr.mip", "leadr", "--mip-filter is box")
    for option, value in (("--mip-kappa", "3"), ("--mip-gain", "on"), ("--fallback", "off")):
        done = bench.run(*words, option, value).expect(0)
        check(f"{option} has no effect with --mip-pyramid" in done.err and "box" not in done.err, done.describe())
    # a material without name goes by its number
    scratch(bench, "bare.gltf", files.text(bare()))
    bench.run("render", "bare.gltf", *VIEW, "--material", "other", "--mip-pyramid", "leadr.mip", "-o", "a.pfm").expect(4).expect_one_line(
        "material 0", "hash")


@case("mip.a_pyramid_that_was_baked_gives_the_same_pixels", tier="nightly")
def baked(bench):
    material(bench, "set", (33, 17, bumps))
    material(bench, "other", (33, 17, lambda x, y: bumps(x + 1, y)))
    for name in SEARCHED:
        bench.run("bake", "mip", "set", "--mip-filter", name, "-q", "-o", name + ".mip").expect(0)
    bench.run("bake", "mip", "set", "--mip-filter", "kappa", "--threads", "3", "-q", "-o", "again.mip").expect(0)
    bench.run("bake", "mip", "set", "--mip-filter", "teacher", "--threads", "3", "-q", "-o", "searched.mip", env={"BN_FORCE_ISA": "scalar"}).expect(0)
    check((bench.folder / "searched.mip").read_bytes() == (bench.folder / "teacher.mip").read_bytes(), "threads or lanes change a search")
    check((bench.folder / "again.mip").read_bytes() == (bench.folder / "kappa.mip").read_bytes(), "threads change the bytes")
    words = ("builtin:sphere", *SMALL, "--material", "set")
    for name in SEARCHED:
        made = hash_of(bench, *words, "--mip-filter", name)
        check(hash_of(bench, *words, "--mip-filter", name, "--mip-pyramid", name + ".mip") == made, f"{name}: other pixels")
        check(hash_of(bench, *words, "--mip-pyramid", name + ".mip") == made, f"{name}: a file does not say its filter")
    bench.run("bake", "mip", "set", "--brdf", "beckmann", "-q", "-o", "wide.mip").expect(0)
    check((bench.folder / "wide.mip").read_bytes() == (bench.folder / "kappa.mip").read_bytes(), "the usual kappa goes by the model of lobes")
    for name, more in (("lit.mip", ()), ("other_lit.mip", ("--brdf", "beckmann")), ("lit3.mip", ("--threads", "3"))):
        bench.run("bake", "mip", "set", "--mip-gain", "on", *more, "-q", "-o", name).expect(0)
    check((bench.folder / "lit.mip").read_bytes() == (bench.folder / "lit3.mip").read_bytes() != (bench.folder / "other_lit.mip").read_bytes(),
          "gains do not go by the model of lobes, or by threads")
    gained = hash_of(bench, *words, "--mip-filter", "kappa", "--mip-gain", "on")
    check(gained == hash_of(bench, *words, "--mip-pyramid", "lit.mip") == hash_of(bench, *words, "--mip-filter", "kappa", "--mip-gain", "on", "--isa", "scalar"),
          "a file does not keep its gains")
    check(hash_of(bench, *words, "--mip-filter", "kappa", "--mip-pyramid", "lit.mip") == hash_of(bench, *words, "--mip-filter", "kappa") != gained,
          "gains are not off by themselves")
    for file, more in (("kappa.mip", ()), ("lit.mip", ("--brdf", "beckmann"))): # without gains, and with gains of other lobes
        bench.run("render", *words, "--mip-filter", "kappa", "--mip-gain", "on", "--mip-pyramid", file, *more, "-o", "m.pfm").expect(4)
    done = bench.run("render", *words, "--mip-pyramid", "kappa.mip", "--mip-gain", "on", "-o", "m.pfm").expect(0)
    check("--mip-gain has no effect with --mip-pyramid" in done.err, done.describe())
    done = bench.run("bake", "mip", "set", "--mip-filter", "baseline", "--mip-gain", "on", "-o", "b.mip").expect(0)
    check("--mip-gain has no effect with --mip-filter baseline" in done.err, done.describe())
    bench.run("bake", "mip", "set", "--format", "png-levels", "-o", "both", "--preview", "both").expect(2)
    beckmann = (*words, "--brdf", "beckmann", "--mip-filter", "kappa")
    check(hash_of(bench, *beckmann) == hash_of(bench, *beckmann, "--mip-kappa", "0.7") == hash_of(bench, *beckmann, "--mip-pyramid", "wide.mip"),
          "kappa 0.7 is not Beckmann's default")
    bench.run("bake", "mip", "builtin:bumps", "--mip-filter", "leadr", "-o", "bumps.mip", "--preview", "seen").expect(0)
    check(hash_of(bench, "builtin:bumps", *SMALL, "--mip-pyramid", "bumps.mip") == hash_of(bench, "builtin:bumps", *SMALL, "--mip-filter", "leadr"),
          "a scene of several materials")
    bench.run("bake", "mip", "builtin:bumps", "--mip-filter", "mipnet", "-o", "mixed.mip").expect(0)
    mixed = hash_of(bench, "builtin:bumps", *SMALL, "--mip-filter", "mipnet")
    for more in ((), ("--mip-filter", "mipnet")):
        check(hash_of(bench, "builtin:bumps", *SMALL, *more, "--mip-pyramid", "mixed.mip") == mixed, "a scene whose materials have filters of their own")
    seen = sorted(path.name for path in (bench.folder / "seen").iterdir())
    check("hammered_copper_normal_01.png" in seen and "vinyl_lobe_10.png" in seen, f"{seen}")
    # files that do not fit
    good = (bench.folder / "kappa.mip").read_bytes()
    scratch(bench, "short.mip", good[:-9])
    scratch(bench, "damaged.mip", good[:100] + bytes([good[100] ^ 1]) + good[101:])
    scratch(bench, "no.mip", b"bnmip01")
    for scene, file, needle in ((words, "no.mip", "no.mip"), (words, "short.mip", "damaged"), (words, "damaged.mip", "damaged"), (words, "gone.mip", "gone.mip"),
                                (("builtin:sphere", *SMALL, "--material", "other"), "kappa.mip", "hash"),
                                (("builtin:sphere", *SMALL), "kappa.mip", "no maps"),
                                ((*words, "--mip-filter", "mipnet", "--brdf", "beckmann"), "mipnet.mip", "hash"),
                                ((*words, "--mip-filter", "ssgt"), "kappa.mip", "hash"), ((*words, "--mip-kappa", "1", "--mip-filter", "kappa"), "kappa.mip", "hash")):
        bench.run("render", *scene, "--mip-pyramid", file, "-o", "x.pfm").expect(4).expect_one_line(needle)
    for arguments, code, needle in ((("set", "--mip-filter", "box"), 2, "--mip-filter"), ((), 2, "PICTURE"), (("builtin:sphere",), 4, "no maps"),
                                    (("gone",), 4, "gone")):
        bench.run("bake", "mip", *arguments, "-o", "x.mip").expect(code).expect_one_line(needle)
    bench.run("bake", "mip", "set", "-o", "no/x.mip").expect(7).expect_one_line("no/x.mip")
    check("x.mip" not in bench.left_behind() and "x.pfm" not in bench.left_behind(), "what failed has left something")


@case("mip.levels_that_take_long_are_kept_by_content")
def kept(bench):
    material(bench, "set", (32, 16, bumps))
    material(bench, "other", (32, 16, lambda x, y: bumps(x + 1, y)))
    cache = bench.folder / "cache"
    env = {"XDG_CACHE_HOME": str(cache)}
    lit = ("--size", "64x48", "--msaa", "1", "--samples", "4", "--technique", "mc", *small_sky(bench))

    def drawn(folder, *words):
        found = bench.figures("builtin:sphere", *lit, "--material", folder, *words, env=env)
        return found["pixel_hash"], {path: path.read_bytes() for path in (cache / "burnish").glob("levels-*.mip")}

    plain, none = drawn("set", "--mip-filter", "teacher", "--no-cache")
    check(not none, f"--no-cache keeps {none}")
    first, one = drawn("set", "--mip-filter", "teacher")
    (name, whole), = one.items()
    name.touch()
    again, same = drawn("set", "--mip-filter", "teacher")
    check(first == plain == again and same == one, "what is kept draws another picture")
    for data in (whole[:-40], whole[:200] + b"\1" + whole[201:], b""):  # damaged files are replaced
        name.write_bytes(data)
        check(drawn("set", "--mip-filter", "teacher") == (first, one), "a damaged file stays")
    for folder, words in (("set", ("--mip-kappa", "1")), ("set", ("--brdf", "beckmann")), ("other", ()), ("set", ("--mip-filter", "mipnet", "--fallback", "off"))):
        before = one
        look = (*(() if "--mip-filter" in words else ("--mip-filter", "teacher")), *words)
        found, one = drawn(folder, *look)
        check(len(one) == len(before) + 1, f"{folder} {look}: {sorted(one)}")
        check(drawn(folder, *look, "--no-cache")[0] == found, f"{folder} {look}: what is kept draws another picture")
    check(drawn("set", "--mip-filter", "kappa")[1] == one, "levels that are made at once are kept")
    swapped = sorted(one)[:2]  # a file with other contents under this name
    one_bytes, two_bytes = (path.read_bytes() for path in swapped)
    swapped[0].write_bytes(two_bytes), swapped[1].write_bytes(one_bytes)
    check(drawn("set", "--mip-filter", "teacher")[0] == first, "levels of other maps are taken")


@case("mip.materials_that_a_net_is_bad_for_keep_closed_forms")
def fallbacks(bench):
    words = ("builtin:bumps", *SMALL, "--mip-filter", "mipnet")
    done = bench.run("render", *words, "--stats", "a.json", "-o", "auto.pfm").expect(0)
    told = [line for line in done.err.splitlines() if "the net's L1 is" in line]
    check(len(told) == 1 and "'turned steel'" in told[0] and "--mip-filter baseline" in told[0], done.describe())
    warnings = json.loads((bench.folder / "a.json").read_text())["warnings"]
    check(any("'turned steel'" in warning for warning in warnings), f"{warnings}")
    quiet = bench.run("render", *words, "--fallback", "off", "-o", "off.pfm").expect(0)
    check("the net's L1" not in quiet.err, quiet.describe())
    check(off_by(bench, "auto.pfm", "off.pfm")["mse"] > 0, "what is kept draws the same picture")


def tiles_of(exr):
    """Returns an OpenEXR file's tile side and level mode (1: mip levels, rounded down)."""
    at = exr.index(b"tiles\0tiledesc\0") + len(b"tiles\0tiledesc\0") + 4
    width, height, mode = struct.unpack("<IIB", exr[at:at + 9])
    return width, height, mode


@case("mip.levels_go_to_other_programs_as_textures", "input")
def textures(bench):
    material(bench, "set", (33, 17, bumps))
    (bench.folder / "set/x_basecolor.png").write_bytes(png(8, 8, lambda x, y: (250, 120 + 8 * x, 40)))
    words = ("bake", "mip", "set", "--mip-filter", "kappa")
    off = {}
    for name in ("png-levels", "exr-mip"):
        done = bench.run(*words, "--format", name, "-o", name).expect(0)
        found = re.fullmatch(r"(\w+): L1 ([.0-9]+) at texels, ([.0-9]+) between them; most at level \d, \d+x\d+: [.0-9]+\n", done.out)
        check(found, done.describe())
        stem, off[name] = found[1], [float(found[i]) for i in (2, 3)]
    check(off["exr-mip"][0] < 0.2 * off["png-levels"][0] < 0.02, f"halves are off as codes are: {off}")
    check(off["exr-mip"][1] > 2 * off["exr-mip"][0], f"nothing is lost between texels: {off}")
    parts = {"normal": 6, "metallic_roughness": 6, "base_color": 4, "anisotropy": 6}
    there = sorted(path.name for path in (bench.folder / "png-levels").iterdir())
    check(there == sorted(f"{stem}_{part}_{level:02}.png" for part, levels in parts.items() for level in range(levels)), f"{there}")
    there = sorted(path.name for path in (bench.folder / "exr-mip").iterdir())
    check(there == sorted(f"{stem}_{part}.exr" for part in parts), f"{there}")
    for name in there:
        check(tiles_of((bench.folder / "exr-mip" / name).read_bytes()) == (64, 64, 1), f"{name} has no mip levels")
    # level 0 equals the maps, read back by the program
    seen = ("builtin:sphere", *SMALL, "--roughness", "0.4")
    bench.run("render", *seen, "--normal-map", "set/x_normal.png", "-q", "-o", "maps.pfm").expect(0)
    bench.run("render", *seen, "-q", "-o", "level.pfm").expect(0)
    without = off_by(bench, "maps.pfm", "level.pfm")["mse"]
    for name in (f"png-levels/{stem}_normal_00.png", f"exr-mip/{stem}_normal.exr"):
        bench.run("render", *seen, "--normal-map", name, "-q", "-o", "back.pfm").expect(0)
        check(off_by(bench, "maps.pfm", "back.pfm")["mse"] < 0.02 * without, f"{name} is another map: {off_by(bench, 'maps.pfm', 'back.pfm')}, {without}")
    bench.run(*words, "--format", "png-levels", "--threads", "1", "-q", "-o", "again").expect(0)
    for path in (bench.folder / "again").iterdir():
        check(path.read_bytes() == (bench.folder / "png-levels" / path.name).read_bytes(), f"threads change {path.name}")
    # after a full disk the output is missing or unchanged
    full = bench.run(*words, "--format", "exr-mip", "-q", "-o", "full", file_size=600).expect(7)
    check(full.err.startswith("burnish: ") and not (bench.folder / "full").exists(), full.describe())
    before = {path.name: path.read_bytes() for path in (bench.folder / "exr-mip").iterdir()}
    bench.run(*words, "--mip-kappa", "2", "--format", "exr-mip", "-q", "-o", "exr-mip", file_size=600).expect(7)
    check(before == {path.name: path.read_bytes() for path in (bench.folder / "exr-mip").iterdir()}, "files that were there are not as they were")
    (bench.folder / "file").write_bytes(b"x")
    bench.run(*words, "--format", "png-levels", "-q", "-o", "file").expect(7).expect_one_line("file")
    bench.run(*words, "--format", "tga", "-o", "x").expect(2).expect_one_line("--format")


@case("mip.a_folder_of_one_map_is_filtered", tier="nightly")
def one_map(bench):
    for name, texel, channels in (("x_normal", bumps, 3), ("x_roughness", lambda x, y: (40 + 12 * x,), 1), ("x_rotation", lambda x, y: (255, 128, 128), 3)):
        folder = bench.folder / name
        folder.mkdir()
        (folder / (name + ".png")).write_bytes(png(16, 8, texel, channels=channels))
        for filter_name in LOBES:
            bench.run("bake", "mip", name, "--mip-filter", filter_name, "-q", "-o", "a.mip").expect(0)
            words = ("builtin:sphere", *SMALL, "--material", name, "--mip-filter", filter_name)
            check(hash_of(bench, *words) == hash_of(bench, *words, "--mip-pyramid", "a.mip"), f"{name} by {filter_name}")
    (bench.folder / "colours").mkdir()
    (bench.folder / "colours/x_basecolor.png").write_bytes(png(4, 4, bumps))
    bench.run("bake", "mip", "colours", "-o", "b.mip").expect(4).expect_one_line("no maps")


@case("mip.maps_that_lie_otherwise_are_left_to_box")
def otherwise(bench):
    gltf = bare(normalTexture={"index": 0}, extensions={"KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyTexture": {"index": 1}}})
    gltf["materials"][0]["name"] = "odd"
    gltf["textures"], gltf["images"] = [{"source": 0}, {"source": 1, "sampler": 0}], [{"uri": "n.png"}, {"uri": "d.png"}]
    gltf["samplers"], gltf["extensionsUsed"] = [{"wrapS": 33071, "wrapT": 10497}], ["KHR_materials_anisotropy"]
    scratch(bench, "odd.gltf", files.text(gltf))
    scratch(bench, "n.png", png(64, 64, bumps))
    scratch(bench, "d.png", png(8, 8, lambda x, y: (255, 128, 255)))
    done = bench.run("render", "odd.gltf", *VIEW, "--mip-filter", "kappa", "-o", "a.pfm").expect(0)
    said = "material 'odd' is filtered as by --mip-filter box: its map of anisotropy has a sampler that goes on otherwise at the border than its map of normals"
    check(done.err.count("filtered as by") == 1 and said in done.err, done.describe())
    check(hash_of(bench, "odd.gltf", *VIEW, "--mip-filter", "kappa") == hash_of(bench, "odd.gltf", *VIEW), "it is filtered all the same")
    direction = gltf["materials"][0]["extensions"]["KHR_materials_anisotropy"]["anisotropyTexture"]
    gltf["textures"][1].pop("sampler")
    for words, said in (({"texCoord": 1}, "has another set of texture coordinates than its map of normals"),
                        ({"extensions": {"KHR_texture_transform": {"scale": [2, 2]}}}, "has another transform than its map of normals"), ({}, "")):
        gltf["materials"][0]["extensions"]["KHR_materials_anisotropy"]["anisotropyTexture"] = {**direction, **words}
        scratch(bench, "odd.gltf", files.text(gltf))
        done = bench.run("render", "odd.gltf", *VIEW, "--mip-filter", "kappa", "-o", "a.pfm").expect(0)
        check((said and said in done.err) or (not said and "filtered as by" not in done.err), done.describe())


@case("mip.normals_of_levels_are_as_fine_as_floats")
def fine_normals(bench):
    """A plane from above with one pixel a texel of level 1: the frames' normals equal the pyramid file's."""
    scratch(bench, "p.gltf", files.text(lone_plane()))
    (bench.folder / "set").mkdir()
    (bench.folder / "set/n_normal.png").write_bytes(png(128, 128, bumps))
    words = ("p.gltf", "--material", "set", "--size", "64x64", "--msaa", "1", "--env-size", "32", "--env-samples", "16", "-q")
    for name in ("baseline", "kappa"):
        bench.run("bake", "mip", "set", "--mip-filter", name, "-q", "-o", "a.mip").expect(0)
        bench.run("render", *words, "--mip-filter", name, "--aov", "normal", "-o", "a.exr").expect(0)
        held, seen = (bench.folder / "a.mip").read_bytes()[24 + 56 + 4 * 7:], exr_channels(bench.folder / "a.exr")
        off = 0.0
        for i, (nx, ny, *_) in enumerate(struct.iter_unpack("<5f", held[:20 * 64 * 64])):
            off = max(off, abs(seen["N.X"][i // 64][i % 64] - nx), abs(seen["N.Y"][i // 64][i % 64] - ny))
        check(off < 4e-6, f"{name}: {off}")  # with a single half 4.9e-4


DARK = ("--env-exposure", "-32", "--env-size", "32", "--env-samples", "16", "--no-background", "-q")


def suns(gltf, count, anywhere=False):
    """Adds directional lights from above, cosine-weighted, or evenly down to 84 degrees."""
    gltf["extensionsUsed"] = ["KHR_lights_punctual"]
    gltf["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": 3.0}]}}
    for i in range(count):
        share, turn = (i + 0.5) / count * 0.9, 2.399963 * i + 0.7
        lean = math.acos(1 - share) if anywhere else math.asin(math.sqrt(share))
        half = 0.5 * lean
        gltf["nodes"].append({"rotation": [math.sin(half) * math.cos(turn), math.sin(half) * math.sin(turn), 0.0, math.cos(half)],
                              "extensions": {"KHR_lights_punctual": {"light": 0}}})
    gltf["scenes"] = [{"nodes": list(range(len(gltf["nodes"])))}]


@case("mip.the_mean_of_texels_is_what_the_reference_sees")
def protocols(bench):
    """A plane from above under a sun: level 0 lit at one to one, averaged as radiance, against rays that read the full texture."""
    needs_embree(bench)
    gltf = lone_plane(normalTexture={"index": 0}, pbrMetallicRoughness={"roughnessFactor": 0.4, "metallicFactor": 1, "baseColorFactor": [0.9, 0.7, 0.5, 1]})
    suns(gltf, 1)
    gltf["textures"], gltf["images"], gltf["samplers"] = [{"source": 0, "sampler": 0}], [{"uri": "n.png"}], [{"magFilter": 9728, "minFilter": 9728}]
    scratch(bench, "p.gltf", files.text(gltf))
    scratch(bench, "n.png", grain(128, 0.1))
    dark = ("p.gltf", *DARK)
    bench.run("render", *dark, "--size", "256x256", "--msaa", "1", "-o", "texels.pfm").expect(0)
    bench.run("render", *dark, "--size", "16x16", "--backend", "reference", "--reference-textures", "full", "--samples", "4096", "--variance", "var.pfm", "-o",
              "reference.pfm").expect(0)
    _, _, texels = read_pfm(bench.folder / "texels.pfm")
    _, _, reference = read_pfm(bench.folder / "reference.pfm")
    _, _, variance = read_pfm(bench.folder / "var.pfm")
    beyond = 0
    for y in range(16):
        for x in range(16):
            mean = sum(texels[3 * ((16 * y + j) * 256 + 16 * x + i)] for j in range(16) for i in range(16)) / 256
            at = 3 * (16 * y + x)
            beyond += abs(mean - reference[at]) > 3 * math.sqrt(variance[at])
    check(min(reference) > 0.001 and beyond <= 3, f"{beyond} of 256 pixels are beyond 3 sigma")  # .7 are expected


@case("mip.levels_reflect_as_much_as_their_texels")
def gains(bench):
    """Matte bumps of many texels, seen from above, under lamps from everywhere above. Compares image means with and without level gains
    with the reference's. They are slightly brushed: groups of normals replace the levels of other materials."""
    needs_embree(bench)
    chance = random.Random(5)
    lean = [[(chance.gauss(0, 0.5), chance.gauss(0, 0.5)) for _ in range(16)] for _ in range(16)]

    def bump(x, y):
        sx, sy = lean[y // 8][x // 8]
        length = math.sqrt(1 + sx * sx + sy * sy)
        return tuple(int(127.5 + 127.5 * n / length + 0.5) for n in (-sx, -sy, 1))

    scratch(bench, "n.png", png(128, 128, bump))
    gltf = lone_plane(8, normalTexture={"index": 0}, pbrMetallicRoughness={"roughnessFactor": 0.6, "metallicFactor": 0, "baseColorFactor": [0.9, 0.6, 0.4, 1]},
                      extensions={"KHR_materials_anisotropy": {"anisotropyStrength": 0.2}})
    suns(gltf, 60, anywhere=True)
    gltf["textures"], gltf["images"] = [{"source": 0}], [{"uri": "n.png"}]
    scratch(bench, "p.gltf", files.text(gltf))
    words = ("p.gltf", *DARK, "--size", "8x8", "--frame-map", "quaternion")

    def mean(*more):
        bench.run("render", *words, *more, "-o", "m.pfm").expect(0)
        return sum(read_pfm(bench.folder / "m.pfm")[2])

    reference = mean("--backend", "reference", "--reference-textures", "full", "--samples", "4096")
    off = {(name, gain): mean("--mip-filter", name, "--mip-gain", gain) / reference - 1 for name in ("kappa", "ssgt", "mipnet") for gain in ("on", "off")}
    print({" ".join(of): round(by, 3) for of, by in off.items()})
    for name in ("kappa", "ssgt", "mipnet"):
        check(abs(off[name, "on"]) < 0.03 < 0.06 < abs(off[name, "off"]), f"{off}")
    done = bench.run("render", "p.gltf", *DARK[:-1], "--size", "16x16", "--mip-gain", "on", "-o", "m.pfm").expect(0)
    check("--mip-gain has no effect with --mip-filter box" in done.err, done.describe())


@case("mip.coupled_colours_halve_the_error_of_colour")
def coupled(bench):
    """Two colours on metal ridges, flat and steep ones, seen from above under many lamps: the mean colour, red over blue."""
    needs_embree(bench)
    gltf = lone_plane(8, normalTexture={"index": 0}, pbrMetallicRoughness={"roughnessFactor": 0.55, "metallicFactor": 1, "baseColorTexture": {"index": 1}})
    gltf["textures"], gltf["images"] = [{"source": 0}, {"source": 1}], [{"uri": "n.png"}, {"uri": "c.png"}]
    suns(gltf, 40)
    scratch(bench, "foil.gltf", files.text(gltf))
    steep = {0: (128, 128, 255), 1: (230, 128, 204), 2: (26, 128, 204)}
    scratch(bench, "n.png", png(64, 64, lambda x, y: steep[0 if x % 8 < 4 else 1 if x % 8 < 6 else 2]))
    scratch(bench, "c.png", png(64, 64, lambda x, y: (250, 120, 40) if x % 8 < 4 else (40, 120, 250)))
    words = ("foil.gltf", *DARK, "--size", "16x16", "--frame-map", "quaternion")

    def ratio(name, *more):
        bench.run("render", *words, *more, "-o", name).expect(0)
        _, _, values = read_pfm(bench.folder / name)
        return sum(values[0::3]) / sum(values[2::3])

    reference = ratio("t.pfm", "--backend", "reference", "--reference-textures", "full", "--samples", "1024")
    by = {name: ratio("a.pfm", "--mip-filter", "kappa", "--couple", name) for name in ("none", "albedo")}
    check(abs(by["albedo"] - reference) < 0.5 * abs(by["none"] - reference), f"{reference} {by}")
    check(hash_of(bench, "foil.gltf", *DARK[:-1], "--size", "128x128", "--color-kernel", "kaiser") != hash_of(bench, "foil.gltf", *DARK[:-1], "--size", "128x128"), "--color-kernel is not looked at")
    # colours with other texture coordinates, and frames without normals
    gltf = lone_plane(normalTexture={"index": 0}, pbrMetallicRoughness={"baseColorTexture": {"index": 0, "texCoord": 1}})
    gltf["materials"][0]["name"] = "askew"
    gltf["textures"], gltf["images"] = [{"source": 0}], [{"uri": "n.png"}]
    scratch(bench, "askew.gltf", files.text(gltf))
    scratch(bench, "n.png", png(64, 64, bumps))
    done = bench.run("render", "askew.gltf", *SMALL, "--couple", "albedo", "--frame-map", "off", "-o", "b.pfm").expect(0)
    check("material 'askew' has base colours that lie otherwise than its normals" in done.err and "--couple has no effect with --frame-map off" in done.err,
          done.describe())


@case("mip.shaderballs_judge_filters_near_and_far", tier="nightly")
def shaderballs(bench):
    needs_embree(bench)
    for camera in ("near", "mid", "far", "grazing"):
        words = ("builtin:shaderballs", "--camera", camera, "--size", "64x48", "--msaa", "4", "--env-size", "64", "--env-samples", "32")
        by = {name: hash_of(bench, *words, "--mip-filter", name) for name in ("box", "kappa", "mipnet")}
        check(len(set(by.values())) == 3, f"{camera}: filters draw one picture: {by}")
    words = ("builtin:shaderballs", "--camera", "mid", "--size", "64x48", "--no-background", "--frame-map", "quaternion", "--env-size", "64", "--env-samples",
             "64", "-q")
    bench.run("render", *words, "--backend", "reference", "--reference-textures", "full", "--samples", "512", "-o", "reference.pfm").expect(0)
    off = {}
    for name in ("box", "kappa", "mipnet"):
        bench.run("render", *words, "--mip-filter", name, "--technique", "mc", "--samples", "128", "--msaa", "8", "-o", "t.pfm").expect(0)
        off[name] = off_by(bench, "reference.pfm", "t.pfm")["mse"]
    check(max(off["kappa"], off["mipnet"]) < off["box"], f"{off}")


@case("mip.charts_sweep_filters", tier="nightly")
def sweeps(bench):
    needs_embree(bench)
    bench.run("chart", "builtin:bumps", "--size", "32x24", "--env-size", "64", "--env-samples", "32", "--techniques", "mc", "--reference-samples", "8",
              "--runs", "1", "--sweep", "mip-filter=box,kappa", "-o", "report").expect(0)


@case("mip.killed_bakes_leave_nothing_and_are_made_again")
def killed(bench):
    material(bench, "set", (256, 128, bumps))
    words = ("bake", "mip", "set", "--mip-filter", "teacher", "-q", "-o")
    bench.run(*words, "straight.mip").expect(0)
    cut = 0
    for after in (0.05, 0.15, 0.3):
        child = subprocess.Popen([bench.program, *words, "again.mip"], cwd=bench.folder, env=bench.environment({}))
        time.sleep(after)
        child.kill()
        if child.wait() != -signal.SIGKILL:
            break
        cut += 1
        left = [name for name in bench.left_behind() if name.startswith("again.mip")]
        check(not left, f"killed after {after} s it left {left}")
    check(cut > 0, "it was never killed in time")
    bench.run(*words, "again.mip").expect(0)
    check((bench.folder / "again.mip").read_bytes() == (bench.folder / "straight.mip").read_bytes(), "what was killed makes other bytes")
