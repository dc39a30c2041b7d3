"""Parallax occlusion mapping: heights by option, file and folder, against equal heights as triangles, on devices, and bad input."""

import math
import pathlib

import gltf_files as files
from compare_cases import pfm, png
from detail_cases import METAL, VIEW, bare, bumps, hash_of, off_by, square
from harness import case, check
from input_cases import refuse, scratch
from parity_cases import check_equal, parity

OBLIQUE = ("--eye", "0.85,0.3,0.5", "--target", "0.36,0.3,0", "--fov", "16", "--size", "96x72", "--env-size", "64",
           "--env-samples", "64")


def domes(x, y):
    """Returns a texel of four round stones along each side of 64 texels; red."""
    u, v = (x + 0.5) / 16 % 1 - 0.5, (y + 0.5) / 16 % 1 - 0.5
    return (int(255 * math.sqrt(max(0.0, 1.0 - (u * u + v * v) / 0.23)) + 0.5),)


def wall(bench):
    scratch(bench, "h.png", png(64, 64, domes, channels=1))
    scratch(bench, "wall.obj", square(0))
    folder = pathlib.Path(bench.folder) / "stones"
    folder.mkdir(exist_ok=True)
    (folder / "albedo.png").write_bytes(png(64, 64, lambda x, y: (40 + domes(x, y)[0] // 2, 60, 200 - domes(x, y)[0] // 2)))
    return "wall.obj", "--material", "stones"


# Rays find the stones at the triangles' places: much closer than the flat wall, and not with heights taken for depths.
@case("parallax.shows_what_triangles_show", tier="nightly")
def reference(bench):
    flat = wall(bench)
    bench.run("bake", "displaced", "wall.obj", "h.png", "--height-scale", "0.06", "--triangles", "130000", "-q", "-o", "wall.glb").expect(0)
    scratch(bench, "even.pfm", pfm(4, 2, lambda x, y: (1, 1, 1)))  # normals make no difference under uniform light
    words = (*OBLIQUE, "--env", "even.pfm", "--msaa", "4", "--roughness", "1", "--f0", "0,0,0", "--no-background", "-q")
    bench.run("render", "wall.glb", *words, "--material", "stones", "-o", "reference.pfm").expect(0)
    off = {}
    for name, given in (("flat", ()), ("parallax", ("--height-map", "h.png", "--height-scale", "1.2")),
                        ("less", ("--height-map", "h.png", "--height-scale", "0.4"))):
        bench.run("render", *flat, *words, *given, "-o", name + ".pfm").expect(0)
        off[name] = off_by(bench, "reference.pfm", name + ".pfm")["mse"]
    check(off["parallax"] < 0.35 * off["flat"] and off["parallax"] < off["less"] < off["flat"], f"{off}")


@case("parallax.heights_are_one_whatever_says_them", tier="nightly")
def heights(bench):
    flat = wall(bench)
    view = (*VIEW, "--eye", "0.9,0.3,0.8")
    plain = hash_of(bench, *flat, *view)
    by_option = hash_of(bench, *flat, *view, "--height-map", "h.png")
    folder = pathlib.Path(bench.folder) / "stones"
    (folder / "stone_height.png").write_bytes(png(64, 64, domes, channels=1))
    check(hash_of(bench, *flat, *view) == by_option != plain, "a folder's heights are not the option's")
    (folder / "stone_height.png").unlink()
    (folder / "depth.png").write_bytes(png(64, 64, lambda x, y: (255 - domes(x, y)[0],), channels=1))
    check(hash_of(bench, *flat, *view) == by_option, "depths are not heights from above")
    bench.run("render", *flat, *view, "--height-scale", "0", "-q", "-o", "level.pfm").expect(0)
    bench.run("render", *flat, *view, "-q", "-o", "deep.pfm").expect(0)
    (folder / "depth.png").unlink()
    bench.run("render", *flat, *view, "-q", "-o", "plain.pfm").expect(0)
    bench.run("compare", "plain.pfm", "level.pfm", "--metric", "flip-hdr", "--fail-flip", "0.001").expect(0)
    bench.run("compare", "plain.pfm", "deep.pfm", "--metric", "flip-hdr", "--fail-flip", "0.001").expect(1)
    scratch(bench, "h16.png", png(64, 64, lambda x, y: (257 * domes(x, y)[0],), channels=1, bits=16))
    scratch(bench, "h.pfm", pfm(64, 64, lambda x, y: (domes(x, y)[0] / 255,) * 3))
    for name in ("h16.png", "h.pfm"):
        check(hash_of(bench, *flat, *view, "--height-map", name) == by_option, f"{name} looks otherwise")
    # by the file, with and without a normal map
    for normal in ({}, {"normalTexture": {"index": 1}}):
        gltf = bare(extras={"burnish": {"heightTexture": {"index": 0, "scale": 0.1}}}, **normal)
        gltf["textures"], gltf["images"] = [{"source": 0}, {"source": 1}], [{"uri": "h.png"}, {"uri": "n.png"}]
        if not normal:
            del gltf["textures"][1], gltf["images"][1]
        scratch(bench, "n.png", png(16, 16, bumps))
        scratch(bench, "own.gltf", files.text(gltf))
        gltf["materials"][0].pop("extras")
        if normal:
            del gltf["textures"][0], gltf["images"][0]
            gltf["textures"][0]["source"] = 0
            gltf["materials"][0]["normalTexture"]["index"] = 0
        else:
            del gltf["textures"], gltf["images"]
        scratch(bench, "without.gltf", files.text(gltf))
        own = hash_of(bench, "own.gltf", *view, *METAL)
        check(own == hash_of(bench, "without.gltf", *view, *METAL, "--height-map", "h.png", "--height-scale", "2"), f"{normal}: the file's look otherwise")
        check(own != hash_of(bench, "without.gltf", *view, *METAL), f"{normal}: heights are not seen")


@case("parallax.gives_the_same_words_on_devices", tier="nightly")
def devices(bench):
    flat = wall(bench)
    words = (*flat, *OBLIQUE[:4], "--size", "48x36", "--height-map", "h.png", "--env", "builtin:sky")
    check_equal(parity(bench, *words, "--msaa", "1,4", "--technique", "bent_normal",
                       also=[("--msaa", "1", "--technique", "all", "--pom-metric", "uv", "--texture-anisotropy", "4")]))


@case("parallax.bad_input_is_named", "input")
def bad(bench):
    flat = wall(bench)
    for value in ("-1", "nan", "inf", "x", "1001"):
        bench.run("render", *flat, "--height-map", "h.png", "--height-scale=" + value, "-o", "a.png").expect(2).expect_one_line("--height-scale")
    bench.run("render", *flat, "--height-scale", "2", "-q", "-o", "a.png").expect(2).expect_one_line("--height-scale", "height map")
    bench.run("render", *flat, "--height-map", "h.png", "--pom-metric", "metres", "-o", "a.png").expect(2).expect_one_line("--pom-metric")
    bench.run("render", *flat, "--height-map", "no.png", "-o", "a.png").expect(4).expect_one_line("no.png")
    scratch(bench, "flat.gltf", files.text(files.triangle()))
    bench.run("render", "flat.gltf", *VIEW, "--height-map", "h.png", "-o", "a.png").expect(4).expect_one_line("h.png", "texture coordinates")
    flattened = bare()
    flattened["nodes"][0]["scale"] = [0, 0, 0]
    scratch(bench, "point.gltf", files.text(flattened))
    bench.run("bake", "displaced", "point.gltf", "h.png", "-o", "a.glb").expect(4).expect_one_line("point.gltf", "no triangle")
    at = "/materials/0/extras/burnish/heightTexture"
    for info, place in ((3, ""), ({}, ""), ({"index": 9}, "/index"), ({"index": 0, "scale": -1}, "/scale"), ({"index": 0, "scale": "deep"}, "/scale")):
        gltf = bare(extras={"burnish": {"heightTexture": info}})
        gltf["textures"], gltf["images"] = [{"source": 0}], [{"uri": "h.png"}]
        refuse(bench, scratch(bench, "bad.gltf", files.text(gltf)), needles=(at + place,))
    gltf = bare(extras={"burnish": {"heightTexture": {"index": 0}}}, normalTexture={"index": 0, "texCoord": 1})
    gltf["textures"], gltf["images"] = [{"source": 0}], [{"uri": "h.png"}]
    done = bench.run("render", scratch(bench, "apart.gltf", files.text(gltf)), *VIEW, "-o", "a.pfm").expect(0)
    check("lie otherwise" in done.err, done.describe())
    there = bench.left_behind()
    for words, code, needles in ((("wall.obj",), 2, ("HEIGHTS",)), ((), 2, ("PICTURE",)), (("no.obj", "h.png"), 4, ("no.obj",)), (("wall.obj", "no.png"), 4, ("no.png",)),
                                 (("flat.gltf", "h.png"), 4, ("texture coordinates",)), (("wall.obj", "h.png", "--height-scale=-1"), 2, ("--height-scale",)),
                                 (("wall.obj", "h.png", "--triangles", "0"), 2, ("--triangles",))):
        bench.run("bake", "displaced", *words, "-o", "w.glb").expect(code).expect_one_line(*needles)
    bench.run("bake", "displaced", "wall.obj", "h.png", "-o", "w.png").expect(2).expect_one_line("-o", ".glb")
    bench.run("bake", "quaternion", "h.png", "h.png", "-o", "q.png").expect(2).expect_one_line("HEIGHTS")
    check(bench.left_behind() == there, "something is left behind")
