"""Ashikhmin-Shirley lobes: tables from files, baked environments, the diffuse part, roughness by direction."""

import json
import math
import struct

import gltf_files as files
from compare_cases import pfm, png
from detail_cases import VIEW, bare, hash_of, off_by, scenes, square
from environment_files import small_sky
from harness import case, check
from input_cases import refuse, scratch
from parity_cases import check_equal, parity
from reference_cases import needs_embree

# alpha .4 along the grain and .1 across it
LOBE = ("builtin:sphere", "--floor", "off", "--size", "40x30", "--msaa", "1", "--env", "builtin:studio", "--env-size", "64", "--env-samples", "32",
        "--technique", "as_mc", "--roughness", "0.5", "--f0", "0.9,0.6,0.3")
EXPONENTS = ("--nu", "6.25", "--nv", "100")


def tables(bench, given_of):
    """given_of: by number of samples, the files that must draw the frame's own picture."""
    bench.run("bake", "half-vectors", *EXPONENTS, "-q", "-o", "both/h.exr").expect(7)
    (bench.folder / "both").mkdir()
    for what, more, name in (("half-vectors", (), "both/h.exr"), ("brdf-lut", (), "both/a.exr"), ("brdf-lut", (), "a.pfm"),
                             ("half-vectors", ("--size", "512x256"), "large.exr"), ("half-vectors", (), "h.png"), ("brdf-lut", ("--azimuth", "linear", "--size", "90x60"), "even.exr")):
        bench.run("bake", what, *EXPONENTS, *more, "-q", "-o", name).expect(0)
    bench.run("bake", "half-vectors", "--nu", "100", "--nv", "6.25", "-q", "-o", "across.exr").expect(0)
    for samples, files_given in given_of.items():
        words = (*LOBE, "--anisotropy", "0.6", "--samples", samples)
        own = hash_of(bench, *words)
        for given in files_given:
            found = hash_of(bench, *words, *[word for name in given for word in ("--as-table", name)])
            check(found == own, f"{samples} samples: {given} draw another picture")
        check(hash_of(bench, *words, "--as-tables", "off") != own, "tables make no difference")
    # the document's file formats: their error is reported and small
    words = (*LOBE, "--anisotropy", "0.6", "--samples", "64")
    bench.run("render", *words, "-q", "-o", "own.pfm").expect(0)
    for name, needle, most in (("h.png", "8 bits leave", 3e-3), ("even.exr", "", 1e-5)):
        done = bench.run("render", *words, "--as-table", name, "-o", "t.pfm").expect(0)
        check(needle in done.err, done.describe())
        found = off_by(bench, "own.pfm", "t.pfm")
        check(0 < found["mse"] < most, f"{name}: {found}")
    done = bench.run("render", *LOBE, "--anisotropy", "0.6", "--samples", "65", "--as-table", "h.png", "-o", "t.pfm").expect(0)
    check("256x256 texels do not hold 65 samples" in done.err, done.describe())
    # tables for another lobe, or without a lobe
    for anisotropy, name in (("0.5", "h.png"), ("0", "both/h.exr"), ("0", "a.pfm"), ("0", "h.png")):
        bench.run("render", *LOBE, "--anisotropy", anisotropy, "--as-table", name, "-q", "-o", "no.pfm").expect(4).expect_one_line(name, "nu")
    # by other techniques, where the lobe's albedo compensates the energy loss
    words = (*LOBE, "--technique", "mc", "--samples", "8", "--brdf", "ashikhmin_shirley", "--energy-compensation")
    words = tuple(word for i, word in enumerate(words) if word != "as_mc" and not (word == "--technique" and words[i + 1] == "as_mc"))
    check(hash_of(bench, *words, "--anisotropy", "0.6", "--as-table", "a.pfm") == hash_of(bench, *words, "--anisotropy", "0.6"),
          "the lobe's own table draws another picture")
    bench.run("render", *words, "--anisotropy", "0.5", "--as-table", "a.pfm", "-q", "-o", "no.pfm").expect(4).expect_one_line("a.pfm", "nu")
    scratch(bench, "grey.png", png(8, 8, lambda x, y: (128, 128, 200)))
    scratch(bench, "holes.pfm", pfm(8, 8, lambda x, y: (0, 0, 1) if y == 0 else (float("nan"), 0, 0)))
    for name in ("grey.png", "holes.pfm", "none.exr"):
        bench.run("render", *LOBE, "--anisotropy", "0.6", "--as-table", name, "-q", "-o", "no.pfm").expect(4).expect_one_line(name)
    check(not (bench.folder / "no.pfm").exists(), "a picture in spite of it")
    done = bench.run("render", "builtin:plate", "--size", "8x8", "--env-size", "16", "--env-samples", "4", "--floor", "off", "--as-table", "h.png",
                     "-o", "t.pfm").expect(0)
    check("--as-table has no effect" in done.err, done.describe())
    for value in ("-1", "nan", "1e7", "2000000"):
        bench.run("bake", "half-vectors", "--nu=" + value, "--nv", "1", "-o", "t.exr").expect(2).expect_one_line("--nu")


@case("phong.tables_from_files_are_those_that_frames_make", "input", budget=13)
def some_tables(bench):
    """Bakes tables of many texels for three lobes."""
    tables(bench, {"16": (("both",),), "60": (("large.exr", "a.pfm"),), "64": (("across.exr",),)})


@case("phong.tables_from_files_are_those_that_frames_make_at_any_count", tier="nightly")
def all_tables(bench):
    each = (("both/h.exr",), ("both/a.exr",), ("a.pfm",), ("both",), ("large.exr", "a.pfm"), ("across.exr",))
    tables(bench, dict.fromkeys(("16", "60", "64"), each))
    for name in ("both/h.exr", "a.pfm"):
        bench.run("render", *LOBE, "--anisotropy", "0.5", "--as-table", name, "-q", "-o", "no.pfm").expect(4).expect_one_line(name, "nu")


@case("phong.tables_from_files_give_the_same_words_on_devices", tier="nightly")
def devices(bench):
    bench.run("bake", "half-vectors", *EXPONENTS, "-q", "-o", "h.exr").expect(0)
    bench.run("bake", "brdf-lut", *EXPONENTS, "-q", "-o", "a.exr").expect(0)
    words = ("builtin:sphere", "--size", "48x32", "--msaa", "1", "--env", "builtin:sky", "--roughness", "0.5", "--anisotropy", "0.6")
    check_equal(parity(bench, *words, "--technique", "as_mc", "--samples", "16", "--as-table", "h.exr", "--as-table", "a.exr",
                       also=[("--technique", "bent_normal", "--diffuse", "ashikhmin-shirley")]))


@case("phong.baked_environments_are_read_back", "input", budget=3)
def environments(bench):
    words = ("builtin:sphere", "--size", "40x30", "--msaa", "1", "--floor", "off")
    bake = ("--env-size", "64", "--env-samples", "32")
    small_sky(bench)
    for name, source in (("sky", "builtin:sky"), ("file", "sky.hdr")):
        bench.run("bake", "environment", source, *bake, "-q", "-o", name).expect(0)
        first = (bench.folder / name / "environment.bnenv").read_bytes()
        if name == "file":
            bench.run("bake", "environment", source, *bake, "-q", "-o", name).expect(0)
            check((bench.folder / name / "environment.bnenv").read_bytes() == first, "other bytes the second time")
        for turn in ((), ("--env-rotation", "40", "--env-exposure", "1")):
            own = hash_of(bench, *words, *bake, *turn, "--env", source)
            for path in (name, f"{name}/environment.bnenv"):
                check(hash_of(bench, *words, *turn, "--env", path) == own, f"{path} {turn} lights otherwise")
    data = (bench.folder / "sky/environment.bnenv").read_bytes()
    for name, text in (("short.bnenv", data[:300]), ("cut.bnenv", data[:-2]), ("bent.bnenv", data[:9000] + bytes([data[9000] ^ 1]) + data[9001:]),
                       ("head.bnenv", data[:12] + b"\1" + data[13:]), ("other.bnenv", b"x" + data[1:]), ("empty.bnenv", b"")):
        scratch(bench, name, text)
        bench.run("render", *words, "--env", name, "-o", "no.pfm").expect(4).expect_one_line(name)
    (bench.folder / "hollow").mkdir()
    bench.run("render", *words, "--env", "hollow", "-o", "no.pfm").expect(4).expect_one_line("hollow")
    for given, code, needle in ((("environment", "-o", "e"), 2, "PICTURE"), (("environment", "builtin:sky"), 2, "-o"),
                                (("environment", "none.hdr", "-o", "e"), 4, "none.hdr"), (("tpr", "--expr", "1", "0", "--env-size", "64", "-o", "t.exr"), 2, "--env-size")):
        bench.run("bake", *given).expect(code).expect_one_line(needle)


def pixels(bench, name):
    data = (bench.folder / name).read_bytes()
    size = data.split(b"\n", 2)[1].split()
    count = 3 * int(size[0]) * int(size[1])
    return struct.unpack(f"<{count}f", data[-4 * count:])


def ball(columns, rows):
    """Returns a dielectric sphere with texture coordinates and normals."""
    lines, faces = [], []
    for j in range(rows + 1):
        for i in range(columns + 1):
            a, b = 2 * math.pi * i / columns, math.pi * j / rows
            place = f"{math.cos(a) * math.sin(b):.7f} {math.cos(b):.7f} {math.sin(a) * math.sin(b):.7f}"
            lines += [f"v {place}", f"vt {i / columns:.7f} {1 - j / rows:.7f}", f"vn {place}"]
    for j in range(rows):
        for i in range(columns):
            at = j * (columns + 1) + i + 1
            corners = [at, at + 1, at + columns + 2, at + columns + 1]
            faces.append("f " + " ".join(f"{k}/{k}/{k}" for k in corners))
    return "\n".join(lines + faces) + "\n"


# Under radiance 1 from everywhere a white surface reflects the sum of both parts: at most 1, and at grazing angles less than Lambert. With
# compensation it reflects 1, by an albedo table or, where roughness varies, by 89 samples.
@case("phong.diffuse_part_and_lobe_give_back_what_they_get", tier="nightly")
def furnace(bench):
    scratch(bench, "even.pfm", pfm(8, 4, lambda x, y: (1, 1, 1)))
    scratch(bench, "ball.obj", ball(48, 24))
    scratch(bench, "w.pfm", pfm(2, 2, lambda x, y: (0.375, 0.125, 0)))
    words = ("ball.obj", "--size", "32x32", "--msaa", "1", "--env", "even.pfm", "--env-size", "16", "--env-samples", "4", "--no-background",
             "--technique", "mc", "--samples", "256", "--brdf", "ashikhmin_shirley", "-q")
    lobe = ("--roughness", "0.5", "--anisotropy", "0.5")
    shown = {}
    for f0 in ("0.04,0.04,0.04", "0.5,0.5,0.5"):
        for way in ("lambert", "ashikhmin-shirley"):
            for more in ((), ("--energy-compensation",)):
                bench.run("render", *words, *lobe, "--f0", f0, "--diffuse", way, *more, "-o", "t.pfm").expect(0)
                shown[f0, way, more] = [value for value in pixels(bench, "t.pfm")[::3] if value > 0]
        plain, whole = (shown[f0, "ashikhmin-shirley", more] for more in ((), ("--energy-compensation",)))
        check(len(plain) > 500 and max(plain) <= 1.002, f"f0 {f0}: {max(plain)}")
        check(min(plain) < 0.9, f"f0 {f0}: nothing is lost: {min(plain)}")
        bench.run("render", *words, "--f0", f0, "--diffuse", "ashikhmin-shirley", "--energy-compensation", "--roughness-map", "w.pfm", "-o", "t.pfm").expect(0)
        mapped = [value for value in pixels(bench, "t.pfm")[::3] if value > 0]
        print(f"f0 {f0}: {min(plain)} to {max(plain)}, compensated {min(whole)} to {max(whole)}, of a map {min(mapped)} to {max(mapped)}")
        check(0.98 <= min(mapped) and max(mapped) <= 1.02, f"f0 {f0}: compensated by samples {min(mapped)} to {max(mapped)}")
        check(0.99 <= min(whole) and max(whole) <= 1.01 and min(whole) > min(plain) + 0.02, f"f0 {f0}: compensated {min(whole)} to {max(whole)}")
    check(min(shown["0.04,0.04,0.04", "lambert", ()]) > min(shown["0.04,0.04,0.04", "ashikhmin-shirley", ()]) + 0.05, "both diffuse parts are one")


# A plane at one angle under smooth light: the tile renderer's means equal the reference's.
@case("phong.the_diffuse_part_meets_the_reference", tier="nightly")
def diffuse_reference(bench):
    needs_embree(bench)
    scratch(bench, "smooth.pfm", pfm(64, 32, lambda x, y: [1 + 0.8 * math.cos(math.pi * (y + 0.5) / 32)] * 3))
    scratch(bench, "q.obj", square(0))
    for degrees in (20, 60, 80):
        a = math.radians(degrees)
        words = ("q.obj", "--size", "16x12", "--msaa", "1", "--fov", "0.1", "--env", "smooth.pfm", "--env-size", "64", "--env-samples", "32", "--no-background",
                 "--eye", f"{0.3 + 3 * math.sin(a)},0.3,{3 * math.cos(a)}", "--target", "0.3,0.3,0", "--roughness", "0.6", "--diffuse", "ashikhmin-shirley",
                 "--brdf", "ashikhmin_shirley", "-q")
        means = []
        for more in (("--backend", "reference", "--samples", "4096"), ("--technique", "mc", "--samples", "1024")):
            bench.run("render", *words, *more, "-o", "m.pfm").expect(0)
            found = pixels(bench, "m.pfm")
            means.append(sum(found) / len(found))
        check(abs(means[1] / means[0] - 1) < 0.01, f"{degrees} degrees: reference {means[0]}, tile renderer {means[1]}")


@case("phong.roughness_by_direction_is_roughness_and_anisotropy", "input", budget=5)
def directional(bench):
    scene = scenes(bench)
    bench.run("render", scene, *VIEW, "--f0", "1,1,1", "--roughness", "0.5", "--anisotropy", "0.6", "-q", "-o", "own.pfm").expect(0)
    bench.run("render", scene, *VIEW, "--f0", "1,1,1", "--roughness", "0.5", "--anisotropy", "-0.6", "-q", "-o", "across.pfm").expect(0)
    scratch(bench, "w.png", png(4, 4, lambda x, y: (26214, 6554, 0), bits=16))
    scratch(bench, "turned.png", png(4, 4, lambda x, y: (6554, 26214, 0), bits=16))
    scratch(bench, "w.pfm", pfm(4, 4, lambda x, y: (0.4, 0.1, 0)))
    scratch(bench, "a.pfm", pfm(4, 4, lambda x, y: (0.5, 0.6, 0)))
    scratch(bench, "n_.pfm", pfm(4, 4, lambda x, y: (0.5, -0.6, 0)))
    for name, words, own in (("w.png", (), "own"), ("w.pfm", (), "own"), ("a.pfm", ("--roughness-encoding", "anisotropy"), "own"),
                             ("turned.png", (), "across"), ("n_.pfm", ("--roughness-encoding", "anisotropy"), "across")):
        bench.run("render", scene, *VIEW, "--f0", "1,1,1", "--roughness-map", name, *words, "-q", "-o", "t.pfm").expect(0)
        check(off_by(bench, own + ".pfm", "t.pfm")["mse"] < 1e-5, f"{name} {words} is not {own}")
        check(off_by(bench, ("own" if own == "across" else "across") + ".pfm", "t.pfm")["mse"] > 1e-4, f"{name}: both directions look alike")
    # along the direction of a rotation map
    bench.run("bake", "tpr", "--expr", "0", "1", "--size", "2x2", "-o", "quarter.exr").expect(0)
    bench.run("render", scene, *VIEW, "--f0", "1,1,1", "--roughness-map", "w.png", "--rotation-map", "quarter.exr", "-q", "-o", "t.pfm").expect(0)
    check(off_by(bench, "across.pfm", "t.pfm")["mse"] < 1e-5, "a rotation does not turn it")
    # by file, with the metalness of the material's texture
    gltf = bare(pbrMetallicRoughness={"metallicRoughnessTexture": {"index": 1}},
                extras={"burnish": {"directionalRoughnessTexture": {"index": 0, "encoding": "widths"}}})
    gltf["textures"], gltf["images"] = [{"source": 0}, {"source": 1}], [{"uri": "w.png"}, {"uri": "metal.png"}]
    scratch(bench, "metal.png", png(2, 2, lambda x, y: (0, 255, 0)))
    scratch(bench, "own.gltf", files.text(gltf))
    gltf["images"][0]["uri"] = "a16.png"
    gltf["materials"][0]["extras"]["burnish"]["directionalRoughnessTexture"]["encoding"] = "anisotropy"
    scratch(bench, "a16.png", png(4, 4, lambda x, y: (32768, 52428, 0), bits=16))
    scratch(bench, "other.gltf", files.text(gltf))
    bench.run("render", "own.gltf", *VIEW, "-q", "-o", "a_.pfm").expect(0)
    bench.run("render", "other.gltf", *VIEW, "-q", "-o", "b_.pfm").expect(0)
    check(off_by(bench, "a_.pfm", "b_.pfm")["mse"] < 1e-6, "encodings are not told apart by the file")
    scratch(bench, "plain.gltf", files.text(bare(pbrMetallicRoughness={"metallicFactor": 0})))
    bench.run("render", "plain.gltf", *VIEW, "--roughness", "0.5", "--anisotropy", "0.6", "-q", "-o", "c_.pfm").expect(0)
    check(off_by(bench, "a_.pfm", "c_.pfm")["mse"] < 1e-5, "metalness of the texture is lost")
    at = "/materials/0/extras/burnish/directionalRoughnessTexture"
    for info, place in ((3, ""), ({}, ""), ({"index": 9}, "/index"), ({"index": 0, "encoding": "alpha"}, "/encoding"), ({"index": 0, "encoding": 1}, "/encoding")):
        gltf = bare(extras={"burnish": {"directionalRoughnessTexture": info}})
        gltf["textures"], gltf["images"] = [{"source": 0}], [{"uri": "w.png"}]
        refuse(bench, scratch(bench, "bad.gltf", files.text(gltf)), needles=(at + place,))
    scratch(bench, "nan.pfm", pfm(2, 2, lambda x, y: (float("nan"), 0.5, 0)))
    done = bench.run("render", scene, *VIEW, "--roughness-map", "nan.pfm", "-o", "t.pfm").expect(0)
    check("4 texels" in done.err, done.describe())
