"""Mip filters of normals and lobes: --mip-filter, --mip-kappa, --mip-pyramid, `burnish bake mip`."""

import json
import math
import pathlib
import random

import gltf_files as files
from compare_cases import png
from detail_cases import bare, bumps, hash_of, off_by
from harness import case, check
from input_cases import scratch
from parity_cases import check_equal, parity
from reference_cases import needs_embree

SMALL = ("--size", "64x48", "--msaa", "1", "--env-size", "64", "--env-samples", "32", "--samples", "4", "--technique", "mc")
LOBES = ("baseline", "covariance", "leadr", "ssgt", "kappa", "mipnet")
VIEW = ("--eye", "0.3,0.3,1.2", "--target", "0.3,0.3,0", "--fov", "40", "--size", "40x40", "--msaa", "1", "--env-size", "64", "--env-samples", "32")


def named(bench):
    return [line.split()[0] for line in bench.run("list", "mip-filters").expect(0).out.splitlines()]


def grain(side, steep, seed=7):
    """A picture of normals by chance, about as the bell curve has them."""
    chance = random.Random(seed)

    def texel(x, y):
        sx, sy = (steep * sum(chance.uniform(-1, 1) for _ in range(3)) for _ in range(2))
        length = math.sqrt(1 + sx * sx + sy * sy)
        return tuple(int(127.5 + 127.5 * n / length + 0.5) for n in (-sx, -sy, 1))

    return png(2 * side, side, texel)


@case("mip.each_filter_has_pictures_of_its_own", tier="check")
def pictures(bench):
    names = named(bench)
    check(names[:2] == ["box", "lean"] and set(LOBES) <= set(names), f"{names}")
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
    for name in names:  # overrides leave the lobes of the maps aside, what normals differ by stays
        hash_of(bench, "builtin:bumps", *SMALL, "--mip-filter", name, "--roughness", "0.3", "--anisotropy", "0.5")
    done = bench.run("render", "builtin:bumps", *SMALL, "--mip-filter", "ssgt", "--mip-kappa", "1", "-o", "a.pfm").expect(0)
    check("--mip-kappa has no effect with --mip-filter ssgt" in done.err, done.describe())
    bench.run("render", "--mip-filter", "bow", "-o", "a.png").expect(2).expect_one_line("--mip-filter")


@case("mip.filtered_materials_give_the_same_words_on_devices")
def devices(bench):
    for name in LOBES:
        check_equal(parity(bench, "builtin:bumps", "--size", "48x36", "--msaa", "1", "--technique", "auto", "--mip-filter", name))
    check_equal(parity(bench, "builtin:bumps", "--size", "48x36", "--msaa", "1", "--technique", "mc", "--samples", "4", "--mip-filter", "kappa",
                       "--roughness", "0.3"))


@case("mip.a_tilted_map_turns_no_lobe", tier="check")
def tilted(bench):
    """One normal everywhere: no filter widens anything, and lobes lie as --frame-map quaternion has them."""
    scratch(bench, "bare.gltf", files.text(bare(extensions={"KHR_materials_anisotropy": {"anisotropyStrength": 0.7, "anisotropyRotation": 0.4}})))
    scratch(bench, "n.png", png(64, 64, lambda x, y: (200, 170, 228)))
    words = ("bare.gltf", *VIEW, "--normal-map", "n.png", "-q")
    bench.run("render", *words, "--frame-map", "quaternion", "-o", "box.pfm").expect(0)
    bench.run("render", *words, "-o", "other.pfm").expect(0)
    turned = off_by(bench, "box.pfm", "other.pfm")["max_abs"]
    for name in LOBES:
        bench.run("render", *words, "--mip-filter", name, "-o", "a.pfm").expect(0)
        off = off_by(bench, "box.pfm", "a.pfm")["max_abs"]
        check(off < 0.05 * turned, f"{name} turns a lobe: {off}, another frame {turned}")


@case("mip.lobes_keep_what_a_level_loses")
def keeps(bench):
    needs_embree(bench)
    scratch(bench, "fine.png", grain(256, 0.15))
    words = ("builtin:sphere", "--size", "24x24", "--env-size", "64", "--env-samples", "64", "--key-lights", "off", "--no-background",
             "--normal-map", "fine.png", "-q")
    bench.run("render", *words, "--frame-map", "quaternion", "--backend", "reference", "--reference-textures", "full", "--samples", "2048", "-o",
              "truth.pfm").expect(0)
    off = {}
    for name in ("box", *LOBES):
        for taps in ("1", "16"):
            bench.run("render", *words, "--mip-filter", name, "--frame-map", "quaternion", "--texture-anisotropy", taps, "--technique", "mc",
                      "--samples", "1024", "--msaa", "4", "-o", "t.pfm").expect(0)
            off[name, taps] = off_by(bench, "truth.pfm", "t.pfm")["mse"]
    for taps in ("1", "16"):
        for name, share in (("leadr", 1.0), ("ssgt", 0.5), ("kappa", 0.5)):  # leadr's widths are Beckmann's
            check(off[name, taps] < share * off["box", taps], f"{off}")


@case("mip.a_map_of_roughness_is_filtered_without_normals", tier="check")
def roughness(bench):
    gltf = bare(pbrMetallicRoughness={"metallicRoughnessTexture": {"index": 0}})
    gltf["textures"], gltf["images"] = [{"source": 0}], [{"uri": "r.png"}]
    scratch(bench, "rough.gltf", files.text(gltf))
    scratch(bench, "r.png", png(256, 256, lambda x, y: (0, 40 if (x + y) % 2 else 220, 255)))
    by = {name: hash_of(bench, "rough.gltf", *VIEW, "--mip-filter", name) for name in ("box", "lean", "baseline", "covariance", "kappa")}
    check(by["lean"] == by["box"] and by["kappa"] == by["covariance"], f"{by}")
    check(len({by["box"], by["baseline"], by["covariance"]}) == 3, f"{by}")
    # the root of mean squares of alpha: .0246 and .7441 make .5264, alpha_lin .7256
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


@case("mip.a_pyramid_that_was_baked_gives_the_same_pixels", tier="check")
def baked(bench):
    material(bench, "set", (33, 17, bumps))
    material(bench, "other", (33, 17, lambda x, y: bumps(x + 1, y)))
    for name in LOBES:
        bench.run("bake", "mip", "set", "--mip-filter", name, "-q", "-o", name + ".mip").expect(0)
    bench.run("bake", "mip", "set", "--mip-filter", "kappa", "--threads", "3", "-q", "-o", "again.mip").expect(0)
    check((bench.folder / "again.mip").read_bytes() == (bench.folder / "kappa.mip").read_bytes(), "threads change the bytes")
    words = ("builtin:sphere", *SMALL, "--material", "set")
    for name in LOBES:
        made = hash_of(bench, *words, "--mip-filter", name)
        check(hash_of(bench, *words, "--mip-filter", name, "--mip-pyramid", name + ".mip") == made, f"{name}: other pixels")
        check(hash_of(bench, *words, "--mip-pyramid", name + ".mip") == made, f"{name}: a file does not say its filter")
    bench.run("bake", "mip", "set", "--brdf", "beckmann", "-q", "-o", "wide.mip").expect(0)
    check(hash_of(bench, *words, "--mip-pyramid", "wide.mip") == hash_of(bench, *words, "--mip-filter", "kappa", "--mip-kappa", "1.8"),
          "kappa does not go by the model")
    bench.run("bake", "mip", "builtin:bumps", "--mip-filter", "leadr", "-o", "bumps.mip", "--preview", "seen").expect(0)
    check(hash_of(bench, "builtin:bumps", *SMALL, "--mip-pyramid", "bumps.mip") == hash_of(bench, "builtin:bumps", *SMALL, "--mip-filter", "leadr"),
          "a scene of several materials")
    bench.run("bake", "mip", "builtin:bumps", "--mip-filter", "mipnet", "-o", "mixed.mip").expect(0)
    mixed = hash_of(bench, "builtin:bumps", *SMALL, "--mip-filter", "mipnet")
    for more in ((), ("--mip-filter", "mipnet")):
        check(hash_of(bench, "builtin:bumps", *SMALL, *more, "--mip-pyramid", "mixed.mip") == mixed, "a scene whose materials have filters of their own")
    seen = sorted(path.name for path in (bench.folder / "seen").iterdir())
    check("hammered_copper_normal_01.png" in seen and "vinyl_lobe_10.png" in seen, f"{seen}")
    # what does not fit
    good = (bench.folder / "kappa.mip").read_bytes()
    scratch(bench, "short.mip", good[:-9])
    scratch(bench, "damaged.mip", good[:100] + b"\1" + good[101:])
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


@case("mip.nets_are_read_and_wrong_ones_are_refused", tier="check")
def nets(bench):
    words = ("builtin:bumps", *SMALL, "--mip-filter", "mipnet")
    own = hash_of(bench, *words)
    by = {brdf: hash_of(bench, *words, "--fallback", "off", "--brdf", brdf) for brdf in ("ggx_aniso", "beckmann", "ashikhmin_shirley", "ward")}
    nets = {}
    for brdf in ("ggx_aniso", "beckmann", "ashikhmin_shirley"):
        bench.run("train", "mip", "--brdf", brdf, "--steps", "2", "-q", "-o", brdf + ".mipnet").expect(0)
        nets[brdf] = (bench.folder / (brdf + ".mipnet")).read_bytes()
    other = hash_of(bench, *words, "--mip-net", "ggx_aniso.mipnet")
    check(other != own, "weights are not looked at")
    check(hash_of(bench, *words, "--mip-net", "beckmann.mipnet", "--fallback", "off", "--brdf", "beckmann") != by["beckmann"], "of another model neither")
    hash_of(bench, *words, "--mip-net", "beckmann.mipnet", "--brdf", "ward")
    bench.run("bake", "mip", "builtin:bumps", "--mip-filter", "mipnet", "--mip-net", "ggx_aniso.mipnet", "-q", "-o", "a.mip").expect(0)
    check(hash_of(bench, "builtin:bumps", *SMALL, "--mip-pyramid", "a.mip") == other, "bake mip makes others of them")
    bench.run("render", *words, "--mip-pyramid", "a.mip", "-o", "x.pfm").expect(4).expect_one_line("hash")
    good = nets["ggx_aniso"]

    def altered(at, value):
        return good[:at] + value.to_bytes(4, "little") + good[at + 4:]

    for name, data, needle in (("version", altered(8, 7), "version 7"), ("lobe", altered(12, 9), "lobe 9"), ("width", altered(28, 33), "numbers"),
                               ("units", altered(28, 0), "units"), ("crc", altered(2000, 1), "damaged"), ("short", good[:-1], "bytes"), ("none", b"", "empty")):
        scratch(bench, name, data)
        bench.run("render", *words, "--mip-net", name, "-o", "x.pfm").expect(4).expect_one_line(needle)
        bench.run("bake", "mip", "builtin:bumps", "--mip-filter", "mipnet", "--mip-net", name, "-o", "x.mip").expect(4).expect_one_line(needle)
    bench.run("render", *words, "--mip-net", "beckmann.mipnet", "-o", "x.pfm").expect(4).expect_one_line("beckmann")
    bench.run("render", *words, "--mip-net", "gone", "-o", "x.pfm").expect(4).expect_one_line("gone")
    check("x.mip" not in bench.left_behind() and "x.pfm" not in bench.left_behind(), "what failed has left something")
    done = bench.run("render", "builtin:bumps", *SMALL, "--mip-filter", "kappa", "--mip-net", "beckmann.mipnet", "--fallback", "off", "-o", "a.pfm").expect(0)
    check(all(f"{option} has no effect with --mip-filter kappa" in done.err for option in ("--mip-net", "--fallback")), done.describe())


@case("mip.materials_that_a_net_is_bad_for_keep_closed_forms", tier="check")
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


@case("mip.maps_that_lie_otherwise_are_left_to_box", tier="check")
def otherwise(bench):
    gltf = bare(normalTexture={"index": 0}, extensions={"KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyTexture": {"index": 1}}})
    gltf["materials"][0]["name"] = "odd"
    gltf["textures"], gltf["images"] = [{"source": 0}, {"source": 1, "sampler": 0}], [{"uri": "n.png"}, {"uri": "d.png"}]
    gltf["samplers"], gltf["extensionsUsed"] = [{"wrapS": 33071, "wrapT": 10497}], ["KHR_materials_anisotropy"]
    scratch(bench, "odd.gltf", files.text(gltf))
    scratch(bench, "n.png", png(64, 64, bumps))
    scratch(bench, "d.png", png(8, 8, lambda x, y: (255, 128, 255)))
    done = bench.run("render", "odd.gltf", *VIEW, "--mip-filter", "kappa", "-o", "a.pfm").expect(0)
    check(done.err.count("is filtered as by --mip-filter box") == 1 and "'odd'" in done.err and "sampler" in done.err, done.describe())
    check(hash_of(bench, "odd.gltf", *VIEW, "--mip-filter", "kappa") == hash_of(bench, "odd.gltf", *VIEW), "it is filtered all the same")


@case("mip.charts_sweep_filters", tier="check")
def sweeps(bench):
    needs_embree(bench)
    bench.run("chart", "builtin:bumps", "--size", "32x24", "--env-size", "64", "--env-samples", "32", "--techniques", "mc", "--reference-samples", "8",
              "--runs", "1", "--sweep", "mip-filter=box,kappa", "-o", "report").expect(0)
