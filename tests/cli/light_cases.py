"""Area lights: --light, extras.burnish.areaLight of nodes, --limit-lights, --area-lights; and what is wrong with some."""

from direction_cases import SMALL
from gltf_files import text, triangle
from harness import case, check, scratch
from parity_cases import check_equal, parity

QUAD = "quad:points=-1,1,-1/1,1,-1/1,1,1/-1,1,1:radiance=3,2,1"
DARK = ("--env", "builtin:night", "--size", "48x32", "--msaa", "1", "--env-size", "16", "--env-samples", "4")


def scene(light, count=1):
    gltf = triangle()
    gltf["nodes"] += [{"extras": {"burnish": {"areaLight": light}}} for _ in range(count)]
    gltf["scenes"] = [{"nodes": list(range(len(gltf["nodes"])))}]
    return text(gltf)


@case("lights.of_files_and_of_the_command_line_are_the_same", tier="check")
def same(bench):
    quad = {"shape": "quad", "points": [-1, 1, -1, 1, 1, -1, 1, 1, 1, -1, 1, 1], "radiance": [3, 2, 1], "twoSided": True}
    scratch(bench, "lit.gltf", scene(quad))
    scratch(bench, "bare.gltf", text(triangle()))
    view = ("--eye", "0.5,0.5,2", "--target", "0.3,0.3,0")
    lit = bench.figures("lit.gltf", *DARK, *view)["pixel_hash"]
    given = bench.figures("bare.gltf", *DARK, *view, "--light", QUAD + ":two-sided")["pixel_hash"]
    bare = bench.figures("bare.gltf", *DARK, *view)["pixel_hash"]
    off = bench.figures("lit.gltf", *DARK, *view, "--area-lights", "off")["pixel_hash"]
    check(lit == given and len({lit, bare, off}) == 3, f"{lit} {given} {bare} {off}")


@case("lights.that_are_none_say_one_line", "input", tier="check")
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


@case("lights.more_than_the_limit_are_refused", "input", tier="check")
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


@case("parity.area_lights_are_equal")
def equal(bench):
    for options in (("--technique", "auto,mc", "--msaa", "1,4"), ("--technique", "auto", "--msaa", "1", "--area-lights", "ltc-clipless"),
                    ("--technique", "bent_normal", "--msaa", "1", "--area-lights", "mc", "--light-samples", "5"),
                    ("--technique", "auto", "--msaa", "1", "--tilt", "15,-10", "--energy-compensation", "--fresnel", "dielectric")):
        report = parity(bench, "builtin:lights", "--env", "builtin:night", "--size", "64x48", "--light", QUAD, *options)
        check_equal(report)
