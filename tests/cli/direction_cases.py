"""burnish bake direction, and direction maps on scenes: --direction-map."""

import math
import struct
import zlib

from compare_cases import png
from gltf_files import text, textured
from harness import case, check, scratch

SMALL = ("--size", "48x48", "--msaa", "1", "--env-size", "16", "--env-samples", "4", "--texture-anisotropy", "1")


def pixels(data):
    """Returns (width, height, rows of bytes) of an 8-bit RGB image whose filters are none, sub, up, average or Paeth."""
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, bits, colour = struct.unpack(">IIBB", data[at + 8:at + 18])
            check((bits, colour) == (8, 2), "not 8-bit RGB")
        if kind == b"IDAT":
            packed += data[at + 8:at + 8 + size]
        at += 12 + size
    raw, before, rows = zlib.decompress(packed), bytes(3 * width), []
    for y in range(height):
        kind, row = raw[y * (3 * width + 1)], bytearray(raw[y * (3 * width + 1) + 1:(y + 1) * (3 * width + 1)])
        for i in range(3 * width):
            a, b, c = row[i - 3] if i >= 3 else 0, before[i], before[i - 3] if i >= 3 else 0
            nearest = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            row[i] = (row[i] + (0, a, b, (a + b) // 2, nearest)[kind]) & 255
        rows.append(bytes(row))
        before = rows[-1]
    return width, height, rows


def angles(bench, colours, *words):
    """Returns the degrees of highlights baked from a row of colours, and the blue channel."""
    scratch(bench, "p.png", png(len(colours), 1, lambda x, y: colours[x]))
    bench.run("bake", "direction", "p.png", *words, "-o", "d.png").expect(0)
    width, height, (row,) = pixels((bench.folder / "d.png").read_bytes())
    check((width, height) == (len(colours), 1), "another size")
    found = [row[3 * i:3 * i + 3] for i in range(width)]
    check(all(abs(math.hypot(r - 127.5, g - 127.5) - 127.5) < 1 for r, g, _ in found), f"no unit directions: {found}")
    return [math.degrees(math.atan2(g - 127.5, r - 127.5)) for r, g, _ in found], [b for _, _, b in found]


@case("bake.directions_are_half_the_hue")
def hues(bench):
    colours = [(255, 0, 0), (255, 255, 0), (0, 255, 0), (0, 255, 255), (0, 0, 255), (255, 0, 255), (90, 90, 90), (200, 100, 150)]
    found, blue = angles(bench, colours, "--strokes", "highlights")
    check(all(abs(a - b) < 0.5 for a, b in zip(found, (0, 30, 60, 90, 120, 150, 0, 165))), f"{found}")
    check(set(blue) == {255}, f"{blue}")
    check(set(angles(bench, colours, "--strength", "0.4")[1]) == {102}, "another strength")


@case("bake.directions_follow_luminance")
def luminances(bench):
    found, _ = angles(bench, [(0, 0, 0), (51, 51, 51), (128, 128, 128), (0, 255, 0), (0, 0, 255)], "--from", "luminance", "--strokes", "highlights")
    code = lambda y: 1.055 * y**(1 / 2.4) - 0.055
    check(all(abs(a - b) < 0.6 for a, b in zip(found, (0, 36, 180 * 128 / 255, 180 * code(0.7152), 180 * code(0.0722)))), f"{found}")


@case("bake.highlights_run_across_the_strokes_of_a_picture", budget=4)
def strokes(bench):
    """Red is a stroke along the tangent, cyan one across it."""
    colours = [(255, 0, 0), (255, 255, 0), (0, 255, 255)]
    for words, expected in (((), (90, 120, 180)), (("--strokes", "grooves"), (90, 120, 180)), (("--strokes", "highlights"), (0, 30, 90))):
        found, _ = angles(bench, colours, *words)
        apart = [abs((a - b + 90) % 180 - 90) for a, b in zip(found, expected)]
        check(max(apart) < 0.5, f"{words}: {found}")
        said = bench.run("bake", "direction", "p.png", *words, "-o", "d.png").expect(0).err
        check(f"taken as {words[1] if words else 'grooves'}" in said, said)
    for encoding in ("vector", "double-angle", "direction"):
        maps = {}
        for name, words in (("grooves", ("--strokes", "grooves")), ("highlights", ()), ("turned", ())):
            expressions = ("cos(2*v)", "sin(2*v)") if name != "turned" else ("-sin(2*v)", "cos(2*v)")
            bench.run("bake", "tpr", "--expr", *expressions, *words, "--encoding", encoding, "--size", "8x8", "-q", "-o", "m.exr").expect(0)
            maps[name] = (bench.folder / "m.exr").read_bytes()
        check(maps["grooves"] == maps["turned"] != maps["highlights"], f"{encoding}: grooves are not the highlights turned by a quarter")
    bench.run("bake", "quaternion", "p.png", "--strokes", "grooves", "-o", "q.png").expect(2).expect_one_line("--strokes")


@case("bake.maps_of_strokes_are_drawn_as_grooves_or_highlights", budget=4)
def drawn_strokes(bench):
    """Grooves along a direction look as highlights across it."""
    for name, expressions in (("along", ("cos(2*v)", "sin(2*v)")), ("across", ("-sin(2*v)", "cos(2*v)"))):
        bench.run("bake", "tpr", "--expr", *expressions, "--size", "32x32", "-q", "-o", name + ".png").expect(0)
    words = ("render", "builtin:sphere", *SMALL, "--roughness", "0.3", "--anisotropy", "0.9", "-q")
    for name, more in (("a", ("--rotation-map", "along.png", "--strokes", "grooves")), ("b", ("--rotation-map", "across.png")),
                       ("c", ("--rotation-map", "along.png"))):
        bench.run(*words, *more, "-o", name + ".pfm").expect(0)
    bench.run("compare", "a.pfm", "b.pfm", "--fail-flip", "0.002").expect(0)
    bench.run("compare", "a.pfm", "c.pfm", "--fail-flip", "0.02").expect(1)
    # a folder's picture turns once, also where another one replaces it
    (bench.folder / "own").mkdir()
    (bench.folder / "own" / "x_rotation.png").write_bytes((bench.folder / "along.png").read_bytes())
    for more in ((), ("--rotation-map", "along.png")):
        for turned in ("grooves", "highlights"):
            bench.run(*words, "--material", "own", *more, "--strokes", turned, "-o", turned + ".pfm").expect(0)
        bench.run("compare", "grooves.pfm", "highlights.pfm", "--fail-flip", "0.005").expect(1)
    # maps that hold highlights by their format, two maps, and no map at all
    scratch(bench, "d.png", png(2, 2, lambda x, y: (255, 128, 255)))
    (bench.folder / "bare").mkdir()
    scratch(bench, "bare/x_normal.png", png(2, 2, lambda x, y: (128, 128, 255)))
    bench.run(*words, "--rotation-map", "along.png", "--direction-map", "d.png", "-o", "e.png").expect(2).expect_one_line("d.png")
    for more, needle in ((("--rotation-map", "d.png", "--rotation-encoding", "direction"), "d.png"), (("--direction-map", "d.png"), "d.png"),
                         (("--material", "own", "--rotation-encoding", "direction"), "x_rotation.png"),
                         (("--material", "own", "--direction-map", "d.png"), "d.png"), (("--material", "bare"), "no map"), ((), "no map")):
        done = bench.run(*words, *more, "--strokes", "grooves", "-o", "e.png").expect(2)
        done.expect_one_line("--strokes")
        check(needle in done.err, done.describe())


def scene(with_map):
    gltf = textured("d.png")
    gltf["materials"] = [{"pbrMetallicRoughness": {"roughnessFactor": 0.4}, "doubleSided": True}]
    if with_map:
        gltf["materials"][0]["extensions"] = {"KHR_materials_anisotropy": {"anisotropyStrength": 1, "anisotropyTexture": {"index": 0}}}
        gltf["extensionsUsed"] = ["KHR_materials_anisotropy"]
    else:
        del gltf["textures"], gltf["images"]
    return text(gltf).encode()


@case("bake.a_map_of_directions_is_the_file_s_own", tier="nightly")
def as_in_the_file(bench):
    rainbow = lambda x, y: tuple(int(127.5 + 127.5 * math.cos(2 * math.pi * (x / 16 - k / 3))) for k in range(3))
    scratch(bench, "p.png", png(16, 16, rainbow))
    bench.run("bake", "direction", "p.png", "--strength", "0.8", "-o", "d.png").expect(0)
    scratch(bench, "own.gltf", scene(True))
    scratch(bench, "bare.gltf", scene(False))
    for words in ((), ("--anisotropy", "0.9", "--roughness", "0.3"), ("--technique", "bent_normal")):
        own = bench.figures("own.gltf", *SMALL, *words)["pixel_hash"]
        mapped = bench.figures("bare.gltf", *SMALL, *words, "--direction-map", "d.png")["pixel_hash"]
        bare = bench.figures("bare.gltf", *SMALL, *words)["pixel_hash"]
        check(own == mapped != bare, f"{words}: {own}, {mapped} by the option, {bare} without")


@case("bake.wrong_maps_of_directions_say_one_line")
def wrong(bench):
    scratch(bench, "p.png", png(2, 2, lambda x, y: (1, 2, 3)))
    scratch(bench, "g.png", png(2, 2, lambda x, y: (9,), channels=1))
    scratch(bench, "x.png", b"\x89PNG\r\n\x1a\n, not")
    gltf = textured("d.png")
    del gltf["textures"], gltf["images"], gltf["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"]
    gltf["materials"] = [{}]
    scratch(bench, "bare.gltf", text(gltf).encode())
    there = bench.left_behind()
    for words, code, needles in (
            (("bake", "direction", "-o", "d.png"), 2, ("PICTURE",)), (("bake", "direction", "p.png"), 2, ("-o",)),
            (("bake", "direction", "p.png", "-o", "d.jpg"), 2, ("-o", ".png")),
            (("bake", "direction", "p.png", "--from", "value", "-o", "d.png"), 2, ("--from", "value")),
            (("bake", "direction", "p.png", "--strength", "2", "-o", "d.png"), 2, ("--strength", "2")),
            (("bake", "direction", "x.png", "-o", "d.png"), 4, ("x.png",)), (("bake", "direction", "no.png", "-o", "d.png"), 4, ("no.png",)),
            (("bake", "direction", "p.png", "-o", "p.png"), (2, 7), ("p.png",)), (("bake", "direction", "p.png", "-o", "no/d.png"), 7, ("no/d.png",)),
            (("render", "builtin:plate", *SMALL, "--direction-map", "x.png", "-o", "a.png"), 4, ("x.png",)),
            (("render", "builtin:plate", *SMALL, "--direction-map", "g.png", "-o", "a.png"), 4, ("g.png", "red")),
            (("render", "builtin:plate", *SMALL, "--direction-map", "p.png", "-o", "p.png"), (2, 7), ("p.png",)),
            (("render", "builtin:plate", *SMALL, "--direction-map", "p.png", "--limit-texture-bytes", "5", "-o", "a.png"), 4, ("p.png",)),
            (("render", "bare.gltf", *SMALL, "--direction-map", "p.png", "-o", "a.png"), 4, ("p.png", "texture coordinates"))):
        done = bench.run(*words)
        check(done.code in (code if isinstance(code, tuple) else (code,)), f"exit code\n{done.describe()}")
        done.expect_one_line(*needles)
        check(bench.left_behind() == there, f"left {bench.left_behind()}\n{done.describe()}")
