"""Area lights: --light, extras.burnish.areaLight of nodes, --limit-lights, --area-lights, and their errors."""

import json
import math
import pathlib
import struct

from direction_cases import SMALL
from gltf_files import data_uri, png, text, triangle
from harness import Skipped, case, check, scratch
from parity_cases import check_equal, parity
from reference_cases import needs_embree

SHIPPED = pathlib.Path(__file__).resolve().parents[2] / "shading/bake/ltc/ggx.ltc"
QUAD = "quad:points=-1,1,-1/1,1,-1/1,1,1/-1,1,1:radiance=3,2,1"
DARK = ("--env", "builtin:night", "--size", "48x32", "--msaa", "1", "--env-size", "16", "--env-samples", "4")


def scene(light, count=1):
    gltf = triangle()
    gltf["nodes"] += [{"extras": {"burnish": {"areaLight": light}}} for _ in range(count)]
    gltf["scenes"] = [{"nodes": list(range(len(gltf["nodes"])))}]
    return text(gltf)


@case("lights.of_files_and_of_the_command_line_are_the_same")
def same(bench):
    quad = {"shape": "quad", "points": [-1, 1, -1, 1, 1, -1, 1, 1, 1, -1, 1, 1], "radiance": [3, 2, 1], "twoSided": True, "solid": True}
    scratch(bench, "lit.gltf", scene(quad))
    scratch(bench, "bare.gltf", text(triangle()))
    view = ("--eye", "0.5,0.5,2", "--target", "0.3,0.3,0")
    lit = bench.figures("lit.gltf", *DARK, *view)["pixel_hash"]
    given = bench.figures("bare.gltf", *DARK, *view, "--light", QUAD + ":two-sided:solid")["pixel_hash"]
    bare = bench.figures("bare.gltf", *DARK, *view)["pixel_hash"]
    off = bench.figures("lit.gltf", *DARK, *view, "--area-lights", "off")["pixel_hash"]
    check(lit == given and len({lit, bare, off}) == 3, f"{lit} {given} {bare} {off}")


HALVES = png(16, 16, color=lambda x, y: (255, 30, 10) if x < 8 else (20, 60, 255))
HUNG = "quad:points=1,-1,1.5/-1,-1,1.5/-1,1,1.5/1,1,1.5:radiance=3,3,3"


@case("lights.textures_of_files_and_of_the_command_line_are_the_same")
def textures(bench):
    scratch(bench, "halves.png", HALVES)
    scratch(bench, "white.png", png(8, 4, color=lambda x, y: (255, 255, 255)))
    quad = {"shape": "quad", "points": [1, -1, 1.5, -1, -1, 1.5, -1, 1, 1.5, 1, 1, 1.5], "radiance": [3, 3, 3], "texture": {"index": 0}}
    gltf = triangle()
    gltf["nodes"].append({"extras": {"burnish": {"areaLight": quad}}})
    gltf["scenes"] = [{"nodes": [0, 1]}]
    gltf["textures"], gltf["images"] = [{"source": 0}], [{"uri": "halves.png"}]
    scratch(bench, "lit.gltf", text(gltf))
    scratch(bench, "bare.gltf", text(triangle()))
    for way in ("ltc", "ltc-clipless", "mc"):
        view = ("--eye", "0.3,0.3,1.2", "--target", "0.3,0.3,0", "--area-lights", way)
        lit = bench.figures("lit.gltf", *DARK, *view)["pixel_hash"]
        given = bench.figures("bare.gltf", *DARK, *view, "--light", HUNG + ":texture=halves.png")["pixel_hash"]
        plain = bench.figures("bare.gltf", *DARK, *view, "--light", HUNG)["pixel_hash"]
        white = bench.figures("bare.gltf", *DARK, *view, "--light", HUNG + ":texture=white.png")["pixel_hash"]
        check(lit == given and lit != plain and plain == white, f"{way}: {lit} {given} {plain} {white}")


@case("lights.textures_that_are_none_say_one_line", "input")
def wrong_textures(bench):
    scratch(bench, "halves.png", HALVES)
    at = "/nodes/1/extras/burnish/areaLight"
    quad = {"shape": "quad", "points": [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0], "radiance": [1, 1, 1]}
    ball = {"shape": "sphere", "points": [0, 0, 0], "radius": 1, "radiance": [1, 1, 1]}
    for light, place, needle in (({**quad, "texture": 0}, at + "/texture", "object"), ({**quad, "texture": {}}, at + "/texture", "index"),
                                 ({**quad, "texture": {"index": 7}}, at + "/texture/index", "textures"),
                                 ({**quad, "texture": {"index": "0"}}, at + "/texture/index", ""),
                                 ({**ball, "texture": {"index": 0}}, at, "sphere has no texture"),
                                 ({**quad, "points": [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 2, 0], "texture": {"index": 0}}, at, "parallelogram")):
        gltf = triangle()
        gltf["nodes"].append({"extras": {"burnish": {"areaLight": light}}})
        gltf["scenes"] = [{"nodes": [0, 1]}]
        gltf["textures"], gltf["images"] = [{"source": 0}], [{"uri": "halves.png"}]
        scratch(bench, "bad.gltf", text(gltf))
        bench.run("render", "bad.gltf", *SMALL, "-o", "a.png").expect(4).expect_one_line(place, needle)
    bench.run("render", *SMALL, "--light", HUNG + ":texture=none.png", "-o", "a.png").expect(4).expect_one_line("none.png")
    scratch(bench, "bad.png", b"no picture")
    bench.run("render", *SMALL, "--light", HUNG + ":texture=bad.png", "-o", "a.png").expect(4).expect_one_line("bad.png")
    bench.run("render", *SMALL, "--light", HUNG + ":texture=", "-o", "a.png").expect(2).expect_one_line("--light", "no file")
    ball = "sphere:points=0,0,0:radius=1:radiance=1,1,1:texture=halves.png"
    bench.run("render", *SMALL, "--light", ball, "-o", "a.png").expect(2).expect_one_line("--light", "sphere has no texture")
    check("a.png" not in bench.left_behind(), "a picture was written")


@case("lights.that_are_none_say_one_line", "input")
def wrong(bench):
    for light, place, needle in (
            ({"shape": "quad", "points": [0, 0, 0, 1, 0, 0, 2, 0, 0, 3, 0, 0], "radiance": [1, 1, 1]}, "/nodes/1/extras/burnish/areaLight", "on a line"),
            ({"shape": "quad", "points": [0, 0, 0, 1, 0, 0, 1, 1, 0], "radiance": [1, 1, 1]}, "/nodes/1/extras/burnish/areaLight", "4 points"),
            ({"shape": "polygon", "points": [0, 0, 0, 2, 0, 0, 2, 2, 0, 1.5, 0.5, 0], "radiance": [1, 1, 1]}, "/nodes/1/extras/burnish/areaLight", "concave"),
            ({"shape": "polygon", "points": [0, 0, 0, 2, 0, 0, 2, 2, 1, 0, 2, 0], "radiance": [1, 1, 1]}, "/nodes/1/extras/burnish/areaLight", "plane"),
            ({"shape": "sphere", "points": [0, 0, 0], "radiance": [1, 1, 1]}, "/nodes/1/extras/burnish/areaLight", "radius"),
            ({"shape": "sphere", "points": [0, 0, 0], "radius": -1, "radiance": [1, 1, 1]}, "/nodes/1/extras/burnish/areaLight/radius", "at least 0"),
            ({"shape": "sphere", "points": [0, 0, 0], "radius": 1, "radiance": [1, -1, 1]}, "/nodes/1/extras/burnish/areaLight/radiance/1", "at least 0"),
            ({"shape": "sphere", "points": [0, 0], "radius": 1, "radiance": [1, 1, 1]}, "/nodes/1/extras/burnish/areaLight/points", "three numbers"),
            ({"shape": "sphere", "points": "0 0 0", "radius": 1, "radiance": [1, 1, 1]}, "/nodes/1/extras/burnish/areaLight/points", "array"),
            ({"shape": "ball", "points": [0, 0, 0], "radius": 1}, "/nodes/1/extras/burnish/areaLight/shape", "sphere"),
            ({"points": [0, 0, 0], "radius": 1}, "/nodes/1/extras/burnish/areaLight", "shape"),
            ({"shape": "sphere", "points": [0, 0, 0], "radius": 1, "twoSided": 1}, "/nodes/1/extras/burnish/areaLight/twoSided", "true or false"),
            ({"shape": "sphere", "points": [0, 0, 0], "radius": 1, "solid": "yes"}, "/nodes/1/extras/burnish/areaLight/solid", "true or false"),
            (7, "/nodes/1/extras/burnish/areaLight", "object")):
        scratch(bench, "bad.gltf", scene(light))
        bench.run("render", "bad.gltf", *SMALL, "-o", "a.png").expect(4).expect_one_line(place, needle)
    for light, needle in (("quad:points=0,0,0/1,0,0/2,0,0/3,0,0:radiance=1,1,1", "on a line"), ("quad:points=0,0,0/1,0,0:radiance=1,1,1", "4 points"),
                          ("cube:points=0,0,0:radiance=1,1,1", "sphere"), ("sphere:points=0,0,0:radius=-1:radiance=1,1,1", "radius"),
                          ("sphere:points=0,nan,0:radius=1:radiance=1,1,1", "nan"), ("sphere:points=0,0,0:radius=1:radiance=1,-1,1", "radiance"),
                          ("sphere:points=0,0,0:radius=1", "radiance=R,G,B"), ("sphere:points=0,0,0:radius=nan:radiance=1,1,1", "nan"),
                          ("sphere:points=0,0,0:radius=1:radius=2:radiance=1,1,1", "twice"), ("sphere:point=0,0,0:radius=1:radiance=1,1,1", "did you mean 'points'"),
                          ("line:points=0,0,0/0,0,0:radius=1:radiance=1,1,1", "one point"), ("", "empty"), ("quad:points=", "three numbers")):
        bench.run("render", "builtin:plate", *SMALL, "--light", light, "-o", "a.png").expect(2).expect_one_line("--light", needle)
    check("a.png" not in bench.left_behind(), "a picture was written")


def xxh64(data):
    """xxHash64 with seed 0, the hash at the end of tables."""
    p, mask = (0x9E3779B185EBCA87, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9, 0x85EBCA77C2B2AE63, 0x27D4EB2F165667C5), (1 << 64) - 1
    turn = lambda x, n: (x << n | x >> (64 - n)) & mask
    mix = lambda acc, lane: turn((acc + lane * p[1]) & mask, 31) * p[0] & mask
    v, at = [(p[0] + p[1]) & mask, p[1], 0, -p[0] & mask], 0
    while at + 32 <= len(data):
        v = [mix(acc, lane) for acc, lane in zip(v, struct.unpack_from("<4Q", data, at))]
        at += 32
    h = sum(turn(acc, n) for acc, n in zip(v, (1, 7, 12, 18))) & mask
    for acc in v:
        h = ((h ^ mix(0, acc)) * p[0] + p[3]) & mask
    h = (h + len(data)) & mask
    while at + 8 <= len(data):
        h = (turn(h ^ mix(0, struct.unpack_from("<Q", data, at)[0]), 27) * p[0] + p[3]) & mask
        at += 8
    check(at == len(data), "a table is not of whole words")
    for shift, factor in ((33, p[1]), (29, p[2]), (32, 1)):
        h = (h ^ h >> shift) * factor & mask
    return h


def sealed(data):
    return data[:-8] + struct.pack("<Q", xxh64(data[:-8]))


@case("lights.tables_take_the_place_of_the_program_s_own")
def own(bench):
    round_table = SHIPPED.parent / "ggx_round.ltc"
    hashes = {}
    for way in ("ltc", "ltc-isotropic"):
        words = ("builtin:lights", *DARK, "--area-lights", way)
        hashes[way] = bench.figures(*words)["pixel_hash"]
        for table in (SHIPPED, round_table):
            check(bench.figures(*words, "--ltc-table", table)["pixel_hash"] == hashes[way], f"{way} by {table.name} is another picture")
    check(hashes["ltc"] != hashes["ltc-isotropic"], "round lobes look as all lobes do")
    data = SHIPPED.read_bytes()
    entries = [list(entry) for entry in struct.iter_unpack("<11f", data[32:-8])]
    for entry in entries:
        entry[9] *= 0.8  # the albedo
    (bench.folder / "dark.ltc").write_bytes(sealed(data[:32] + b"".join(struct.pack("<11f", *entry) for entry in entries) + data[-8:]))
    for way in ("ltc", "ltc-isotropic"):
        other = bench.figures("builtin:lights", *DARK, "--area-lights", way, "--ltc-table", "dark.ltc")["pixel_hash"]
        check((other == hashes[way]) == (way == "ltc-isotropic"), f"{way} by a table of other lobes")


def ball_over_plane(ball):
    """Returns a diffuse floor of 4 x 4 m, and a ball of radius 0.4 m above it."""
    floor = [(-2, 0, -2), (-2, 0, 2), (2, 0, 2), (2, 0, -2)]
    at = [(math.pi * j / 24, math.pi * i / 24) for j in range(25) for i in range(49)]
    round_ = [(0.4 * math.sin(t) * math.cos(p), 0.6 + 0.4 * math.cos(t), -0.4 * math.sin(t) * math.sin(p)) for t, p in at]
    corners = [49 * j + i for j in range(24) for i in range(48)]
    faces = [k for a in corners for k in (a, a + 49, a + 50, a, a + 50, a + 1)]
    points, indices = (floor + round_, [0, 1, 2, 0, 2, 3] + [4 + k for k in faces]) if ball else (floor, [0, 1, 2, 0, 2, 3])
    positions = b"".join(struct.pack("<3f", *p) for p in points)
    index_bytes = struct.pack(f"<{len(indices)}H", *indices)
    gltf = triangle(positions, index_bytes)
    gltf["buffers"] = [{"byteLength": len(positions + index_bytes), "uri": data_uri(positions + index_bytes)}]
    low, high = ([f(p[k] for p in points) for k in range(3)] for f in (min, max))
    gltf["accessors"][0].update(count=len(points), min=low, max=high)
    gltf["accessors"][1]["count"] = len(indices)
    gltf["bufferViews"][0]["byteLength"] = len(positions)
    gltf["bufferViews"][1].update(byteOffset=len(positions), byteLength=2 * len(indices))
    gltf["materials"] = [{"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 1}}]
    gltf["meshes"][0]["primitives"][0]["material"] = 0
    return text(gltf)


FLOOR = ("--env", "builtin:night", "--env-size", "16", "--env-samples", "4", "--env-exposure", "-20", "--f0", "0,0,0", "--eye", "0,1.6,3.2",
         "--target", "0,0.3,0", "--light", "quad:points=-1.6,2.2,-0.6/-0.6,2.2,-0.6/-0.6,2.2,0.6/-1.6,2.2,0.6:radiance=8,8,8")
SHADOWS = ("--shadows", "ratio")


@case("lights.shadows_by_a_ratio_are_the_reference_s")
def shadows(bench):
    needs_embree(bench)
    scratch(bench, "floor.gltf", ball_over_plane(False))
    scratch(bench, "ball.gltf", ball_over_plane(True))
    small = (*FLOOR, "--size", "60x45", "--msaa", "4")
    open_, same = (bench.figures("floor.gltf", *small, *more)["pixel_hash"] for more in ((), SHADOWS))
    check(open_ == same, "a floor with nothing over it has shadows")
    before = ("--light", "quad:points=-1.2,1.2,-0.6/-0.2,1.2,-0.6/-0.2,1.2,0.6/-1.2,1.2,0.6:radiance=1,2,3")
    open_, same = (bench.figures("floor.gltf", *small, *before, *more)["pixel_hash"] for more in ((), SHADOWS))
    check(open_ == same, "a light shades another")
    solid = bench.figures("floor.gltf", *small, before[0], before[1] + ":solid", *SHADOWS)["pixel_hash"]
    check(solid != same, "a solid light shades nothing")
    one, three, none = (bench.figures("ball.gltf", *small, *more)["pixel_hash"]
                        for more in ((*SHADOWS, "--threads", "1"), (*SHADOWS, "--threads", "3", "--tile-size", "32"), ()))
    check(one == three and one != none, f"{one} {three} {none}")
    size = (*FLOOR, "--size", "160x120")
    bench.run("render", "ball.gltf", *size, "--backend", "reference", "--reference-mode", "shadowed", "--samples", "512", "-o", "reference.png",
              timeout=300).expect(0)
    bench.run("render", "ball.gltf", *size, "-o", "open.png").expect(0)
    for samples, most in (("16", "0.012"), ("64", "0.01")):  # by default 16
        bench.run("render", "ball.gltf", *size, *SHADOWS, "--shadow-samples", samples, "-o", "ratio.png").expect(0)
        bench.run("compare", "reference.png", "ratio.png", "--fail-flip", most).expect(0)
    bench.run("compare", "reference.png", "open.png", "--fail-flip", "0.03").expect(1)


@case("lights.shadows_of_lamps_are_the_reference_s", budget=4)
def all_shadows(bench):
    """--shadows on: a lamp over a ball on a floor, against the reference's shadowed mode. The sun of the built-in sky casts a shadow, too."""
    needs_embree(bench)
    gltf = json.loads(ball_over_plane(True))
    gltf.update(extensionsUsed=["KHR_lights_punctual"], extensions={"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 30}]}})
    gltf["nodes"].append({"translation": [1.0, 2.0, 0.5], "extensions": {"KHR_lights_punctual": {"light": 0}}})
    gltf["scenes"] = [{"nodes": list(range(len(gltf["nodes"])))}]
    scratch(bench, "lamp.gltf", json.dumps(gltf))
    lamp = ("lamp.gltf", *FLOOR[:FLOOR.index("--light")], "--size", "160x120")
    bench.run("render", *lamp, "--backend", "reference", "--reference-mode", "shadowed", "--samples", "256", "-o", "reference.png", timeout=300).expect(0)
    bench.run("render", *lamp, "--shadows", "on", "-o", "on.png").expect(0)
    bench.run("render", *lamp, "--shadows", "ratio", "-o", "ratio.png").expect(0)
    bench.run("render", *lamp, "-o", "open.png").expect(0)
    bench.run("compare", "reference.png", "on.png", "--fail-flip", "0.01").expect(0)
    bench.run("compare", "reference.png", "open.png", "--fail-flip", "0.03").expect(1)
    check((bench.folder / "ratio.png").read_bytes() == (bench.folder / "open.png").read_bytes(), "a ratio for area lights shades lamps")
    # An area light lies between the lamp and the floor. Light passes through it unless it is solid
    quad = ("--light", "quad:points=0.6,1.4,0.1/0.6,1.4,0.7/1.2,1.4,0.7/1.2,1.4,0.1:radiance=0.001,0.001,0.001")
    for words, name in ((quad, "open"), ((quad[0], quad[1] + ":solid"), "solid")):
        bench.run("render", *lamp, *words, "--shadows", "on", "--area-lights", "off", "-o", name + ".png").expect(0)
    bench.run("compare", "on.png", "open.png", "--fail-flip", "0.01").expect(0)  # the light's surface itself is seen
    bench.run("compare", "on.png", "solid.png", "--fail-flip", "0.02").expect(1)
    # The sun is an extracted light of this sky; its shadow depends on no thread and no lanes
    sunny = ("ball.gltf", "--env", "builtin:sky", *FLOOR[FLOOR.index("--f0"):FLOOR.index("--light")], "--size", "160x120")
    scratch(bench, "ball.gltf", ball_over_plane(True))
    hashes = [bench.figures(*sunny, *more)["pixel_hash"] for more in ((), ("--shadows", "on"), ("--shadows", "on", "--threads", "1", "--isa", "scalar"))]
    check(hashes[0] != hashes[1] and hashes[1] == hashes[2], f"{hashes}")


@case("lights.shadows_reach_the_parts_of_pixels")
def shaded_parts(bench):
    """--resolve display shades each part of a pixel, so an edge in a shadow is as dark as its sides."""
    scratch(bench, "ball.gltf", ball_over_plane(True))
    small = ("ball.gltf", *FLOOR, "--size", "60x45", "--msaa", "4", *SHADOWS)
    for resolve in ("linear", "display"):
        bench.run("render", *small, "--resolve", resolve, "-o", resolve + ".png").expect(0)
    bench.run("compare", "linear.png", "display.png", "--fail-flip", "0.02").expect(0)
    bench.run("render", *small[:-2], "--resolve", "display", "-o", "open.png").expect(0)
    bench.run("compare", "open.png", "display.png", "--fail-flip", "0.02").expect(1)


@case("lights.shadows_and_floors_are_the_same_on_a_device", tier="nightly")
def on_device(bench):
    words = ("builtin:teapot", "--env", "builtin:sky", "--size", "48x36", "--msaa", "1", "--technique", "bent_normal", "--shadows", "on", "--floor", "mirror")
    done = bench.run("render", *words, "--backend", "vulkan", "--device", "lavapipe", "--stats", "-", timeout=300.0)
    if done.code == 77:
        raise Skipped(done.err.strip())
    check(json.loads(done.expect(0).out)["pixel_hash"] == bench.figures(*words)["pixel_hash"], "the device draws another picture")


@case("lights.floor_lies_below_scenes_that_ask_for_it")
def floors(bench):
    teapot = ("builtin:teapot", "--env", "builtin:studio", "--size", "64x48", "--msaa", "1", "--technique", "bent_normal")
    by = {floor: bench.figures(*teapot, *(("--floor", floor) if floor else ()))["pixel_hash"] for floor in ("", "off", "shadow", "stage")}
    check(by[""] == by["stage"] and len(set(by.values())) == 3, f"{by}")
    check(bench.figures(*teapot, "--no-background")["pixel_hash"] == bench.figures(*teapot, "--no-background", "--floor", "off")["pixel_hash"],
          "a picture without background has a stage")
    check(bench.figures(*teapot, "--threads", "3", "--isa", "scalar")["pixel_hash"] == by["stage"], "threads or lanes change the floor")
    scratch(bench, "ball.gltf", ball_over_plane(True))
    ball = ("ball.gltf", "--size", "64x48", "--msaa", "1")
    bare, off, shadow = (bench.figures(*ball, *more)["pixel_hash"] for more in ((), ("--floor", "off"), ("--floor", "shadow")))
    check(bare == off and bare != shadow, "a file has a floor that nobody asked for")
    for words, named in ((("--floor", "mirror", "--backend", "reference"), "--reference-mode"),
                         (("--floor", "mirror", "--backend", "vulkan", "--pipeline", "forward"), "--pipeline")):
        done = bench.run("render", *teapot, *words, "-o", "a.png")
        if done.code != 77:  # no Embree or no device
            done.expect(2).expect_one_line("--floor", named)
    # A diffuse law that falls to 0 at grazing angles would turn a backdrop black
    law = (*teapot, "--diffuse", "ashikhmin-shirley")
    check(bench.figures(*law)["pixel_hash"] == bench.figures(*law, "--floor", "shadow")["pixel_hash"], "the backdrop is black")
    check("backdrop" in bench.run("render", *law, "--floor", "stage", "-o", "dark.png").expect(0).err, "a dark backdrop is no warning")
    check("backdrop" not in bench.run("render", *law, "-o", "light.png").expect(0).err, "a warning without reason")
    bench.run("chart", "builtin:plate", "--sweep", "floor=off,stage", "-o", "page").expect(2).expect_one_line("floor")
    bench.run("render", *teapot, "--floor", "grass", "-o", "a.png").expect(2).expect_one_line("--floor", "stage")


@case("lights.shadows_that_cannot_be_say_one_line", "input")
def no_shadows(bench):
    needs_embree(bench)
    bench.run("render", *SMALL, *SHADOWS, "--backend", "reference", "-o", "a.png").expect(2).expect_one_line("--shadows", "shadowed")
    bench.run("render", *SMALL, "--shadow-samples", "9", "-o", "a.png").expect(2).expect_one_line("--shadow-samples", "--shadows")
    bench.run("parity", "builtin:plate", *SHADOWS, "--pipeline", "forward").expect(2).expect_one_line("--shadows", "--pipeline ids")
    bench.run("parity", "builtin:plate", "--shadow-samples", "9").expect(2).expect_one_line("--shadow-samples", "--shadows")
    run = bench.run("render", *SMALL, *SHADOWS, "-o", "b.png").expect(0)
    check("--shadows has no effect" in run.err, run.describe())
    check("a.png" not in bench.left_behind(), "a picture was written")


@case("lights.more_than_the_limit_are_refused", "input")
def many(bench):
    ball = {"shape": "sphere", "points": [0, 0, 3], "radius": 0.1, "radiance": [1, 1, 1]}
    scratch(bench, "many.gltf", scene(ball, 257))
    scratch(bench, "most.gltf", scene(ball, 256))
    bench.run("render", "many.gltf", *SMALL, "-o", "a.png").expect(4).expect_one_line("/nodes/257/extras/burnish/areaLight", "--limit-lights")
    bench.run("render", "many.gltf", *SMALL, "--limit-lights", "257", "-o", "a.png").expect(0)
    bench.run("render", "most.gltf", *SMALL, "-o", "a.png").expect(0)
    bench.run("render", "most.gltf", *SMALL, "--light", QUAD, "-o", "a.png").expect(4).expect_one_line("--limit-lights")
    bench.run("render", *SMALL, "--light", QUAD, "--light", QUAD, "--limit-lights", "1", "-o", "a.png").expect(2).expect_one_line("--light", "--limit-lights")
    bench.run("render", *SMALL, "--limit-lights", "0", "-o", "a.png").expect(0)


def lights_agree(bench, *sets):
    scratch(bench, "halves.png", HALVES)
    for options in sets:
        lights = ("--light", QUAD, "--light", QUAD + ":two-sided:texture=halves.png")
        check_equal(parity(bench, "builtin:lights", "--env", "builtin:night", "--size", "64x48", *lights, *options))


# A driver compiles each set for a minute.
@case("parity.area_lights_are_equal", tier="nightly")
def equal(bench):
    lights_agree(bench, ("--technique", "auto", "--msaa", "1", "--tilt", "15,-10", "--energy-compensation", "--fresnel", "dielectric"),
                 ("--technique", "bent_normal", "--msaa", "1", "--area-lights", "mc", "--light-samples", "5"))


@case("parity.area_lights_are_equal_in_more_sets", tier="nightly")
def equal_in_more_sets(bench):
    lights_agree(bench, ("--technique", "auto,mc", "--msaa", "1,4"), ("--technique", "auto", "--msaa", "1", "--area-lights", "ltc-clipless"),
                 ("--technique", "auto", "--msaa", "1", "--area-lights", "ltc-isotropic", "--tilt", "25,10"),
                 ("--technique", "auto", "--msaa", "1", "--area-lights", "ltc-clipless", "--tilt", "-25,10", "--roughness", "0.9"))
