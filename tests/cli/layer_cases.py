"""Layers of images, and pixels whose parts are tonemapped before they are averaged."""

import json
import struct
import zlib

import gltf_files as files
from compare_cases import png
from detail_cases import bare, bumps
from harness import Skipped, case, check
from input_cases import scratch

DRAWN = ("--size", "96x64", "--env-size", "32", "--env-samples", "16", "-q")
ALL = "depth,normal,albedo,roughness,tangent,anisotropy,metalness,lod,object-id,material-id"


def exr_channels(path):
    """Returns {channel: rows of floats} of a file by the program: scan lines of floats, sixteen a chunk, ZIP."""
    data = path.read_bytes()
    at, attributes = 8, {}
    while data[at]:
        name, at = data[at : data.index(0, at)].decode(), data.index(0, at) + 1
        at = data.index(0, at) + 1
        size = struct.unpack_from("<i", data, at)[0]
        attributes[name], at = data[at + 4 : at + 4 + size], at + 4 + size
    names, chlist = [], attributes["channels"]
    while chlist[0]:
        end = chlist.index(0)
        check(struct.unpack_from("<i", chlist, end + 1)[0] == 2, "a channel that holds no floats")
        names.append(chlist[:end].decode())
        chlist = chlist[end + 17 :]
    x0, y0, x1, y1 = struct.unpack("<4i", attributes["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    rows = {name: [] for name in names}
    for offset in struct.unpack_from(f"<{(height + 15) // 16}q", data, at + 1):
        first, size = struct.unpack_from("<ii", data, offset)
        lines = min(16, y1 + 1 - first)
        packed = data[offset + 8 : offset + 8 + size]
        if size < 4 * width * len(names) * lines:
            packed = bytearray(zlib.decompress(packed))
            for i in range(1, len(packed)):
                packed[i] = (packed[i - 1] + packed[i] - 128) & 255
            half = (len(packed) + 1) // 2
            plain = bytearray(len(packed))
            plain[0::2], plain[1::2] = packed[:half], packed[half:]
            packed = bytes(plain)
        values = struct.unpack(f"<{width * len(names) * lines}f", packed)
        for line in range(lines):
            for k, name in enumerate(names):
                begin = (line * len(names) + k) * width
                rows[name].append(values[begin : begin + width])
    return rows


def drawn_by(bench, name, backend, *words):
    done = bench.run("render", *words, *DRAWN, "--backend", backend, *(("--device", "lavapipe") if backend == "vulkan" else ()), *name)
    if done.code == 77 and backend == "vulkan":
        raise Skipped(done.err.strip())
    done.expect(0)


@case("layers.have_the_names_that_others_know")
def names(bench):
    bare = ("builtin:bumps", *DRAWN, "--floor", "off")
    bench.run("render", *bare, "--aov", ALL, "-o", "a.exr", "-o", "a.png").expect(0)
    bench.run("render", *bare, "-o", "b.exr", "-o", "b.png").expect(0)
    layered, plain = exr_channels(bench.folder / "a.exr"), exr_channels(bench.folder / "b.exr")
    check(sorted(plain) == ["B", "G", "R"], f"a plain picture has {sorted(plain)}")
    check(sorted(set(layered) - set(plain)) == sorted(["Z", "N.X", "N.Y", "N.Z", "albedo.R", "albedo.G", "albedo.B", "roughness", "tangent.X",
                                                       "tangent.Y", "tangent.Z", "anisotropy", "metalness", "lod", "id", "materialId"]), f"{sorted(layered)}")
    check(all(layered[c] == plain[c] for c in plain), "layers change the colours")
    check((bench.folder / "a.png").read_bytes() == (bench.folder / "b.png").read_bytes(), "layers change the PNG")
    seen = 0
    for y in range(64):
        for x in range(96):
            point = {name: rows[y][x] for name, rows in layered.items()}
            if point["id"] == 0:
                check(point["Z"] == float("inf") and point["N.Z"] == 0 and point["materialId"] == 0, f"nothing at {x},{y}: {point}")
                continue
            seen += 1
            check(0 < point["Z"] < 100 and point["materialId"] >= 1, f"at {x},{y}: {point}")
            for v in ("N", "tangent"):
                length = sum(point[f"{v}.{axis}"] ** 2 for axis in "XYZ")
                check(abs(length - 1) < 1e-4, f"{v} at {x},{y} is {length} long")
            check(abs(sum(point[f"N.{a}"] * point[f"tangent.{a}"] for a in "XYZ")) < 1e-4, f"N and tangent at {x},{y}: {point}")
    check(1000 < seen < 96 * 64, f"{seen} pixels show something")


@case("layers.are_the_same_bytes_by_vulkan", tier="nightly")
def twins(bench):
    """Also compares images whose samples are tonemapped separately, and images whose samples are shared between pixels (auto)."""
    for scene, more in (("builtin:bumps", ()), ("builtin:spheres", ("--env-rotation", "40", "--no-background"))):
        for backend in ("tile", "vulkan"):
            drawn_by(bench, ("--aov", ALL, "--resolve", "display", "-o", f"{backend}.exr", "-o", f"{backend}.png"), backend, scene, *more)
            for name in ("tensor", "normal"):
                drawn_by(bench, ("--show", name, "-o", f"{backend}.{name}.png"), backend, scene, *more)
        for kind in ("exr", "png", "tensor.png", "normal.png"):
            check((bench.folder / f"tile.{kind}").read_bytes() == (bench.folder / f"vulkan.{kind}").read_bytes(), f"{scene}: .{kind} differs")


@case("layers.of_a_row_and_of_a_film")
def rows(bench):
    bench.run("render", "builtin:plate", *DRAWN, "--aov", "depth", "--turntable", "2", "-o", "t%d.exr").expect(0)
    check("Z" in exr_channels(bench.folder / "t1.exr"), "a picture of a row has no layer")


@case("layers.resolve_changes_edges_of_shown_pictures_alone")
def resolve(bench):
    drawn = ("render", "builtin:sphere", *DRAWN, "--env", "builtin:studio", "--exposure", "3", "--stats", "s.json")
    bench.run(*drawn, "--resolve", "linear", "-o", "l.tif", "-o", "l.exr").expect(0)
    bench.run(*drawn, "-o", "d.tif", "-o", "d.exr").expect(0)
    check(json.loads((bench.folder / "s.json").read_text())["resolve"] == "display", "the figures do not say it")
    check((bench.folder / "l.exr").read_bytes() == (bench.folder / "d.exr").read_bytes(), "the EXR changed")
    linear, display = (bench.folder / "l.tif").read_bytes(), (bench.folder / "d.tif").read_bytes()
    differ = sum(a != b for a, b in zip(linear, display))
    check(50 < differ < len(linear) // 5, f"{differ} of {len(linear)} bytes differ")
    bench.run(*drawn, "--resolve", "weighted", "-o", "w.tif", "-o", "w.exr").expect(0)
    check((bench.folder / "l.exr").read_bytes() == (bench.folder / "w.exr").read_bytes(), "the EXR changed")
    weighted = (bench.folder / "w.tif").read_bytes()
    less = [sum(a > b for a, b in zip(linear, weighted)), sum(a < b for a, b in zip(linear, weighted))]
    check(less[0] > 20 and less[0] > 5 * less[1] and weighted != display, f"{less}: weights do not darken bright edges")
    bench.run(*drawn, "--msaa", "1", "--resolve", "linear", "-o", "l.tif").expect(0)
    bench.run(*drawn, "--msaa", "1", "--resolve", "display", "-o", "d.tif").expect(0)
    check((bench.folder / "l.tif").read_bytes() == (bench.folder / "d.tif").read_bytes(), "one sample a pixel has nothing to resolve")


def lone_plane(repeats=1.0, **material):
    """Returns a square of 2 by 2 metres that fills the image of an orthographic camera above it, with maps repeated `repeats` times each
    way."""
    gltf = bare(**material)
    corners = ((-1, -1), (1, -1), (1, 1), (-1, -1), (1, 1), (-1, 1))
    columns = ([c for x, y in corners for c in (x, y, 0)], [0, 0, 1] * 6, [c * repeats for x, y in corners for c in ((x + 1) / 2, (1 - y) / 2)])
    gltf["buffers"] = [{"uri": files.data_uri(b"".join(struct.pack(f"<{len(c)}f", *c) for c in columns)), "byteLength": 4 * sum(map(len, columns))}]
    gltf["bufferViews"], gltf["accessors"], begin = [], [], 0
    for column, kind in zip(columns, ("VEC3", "VEC3", "VEC2")):
        gltf["bufferViews"].append({"buffer": 0, "byteOffset": begin, "byteLength": 4 * len(column)})
        gltf["accessors"].append({"bufferView": len(gltf["accessors"]), "componentType": 5126, "count": 6, "type": kind})
        begin += 4 * len(column)
    gltf["accessors"][0] |= {"min": [-1, -1, 0], "max": [1, 1, 0]}
    gltf["meshes"] = [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "material": 0}]}]
    gltf["cameras"] = [{"type": "orthographic", "orthographic": {"xmag": 1.0, "ymag": 1.0, "znear": 0.1, "zfar": 10.0}}]
    gltf["nodes"] = [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 2]}]
    gltf["scenes"] = [{"nodes": [0, 1]}]
    return gltf


def texels_of(path):
    """Returns rows of (red, green, blue), [0,255], of an 8-bit PNG without interlacing."""
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        if kind == b"IHDR":
            width, height, bits, colour = struct.unpack_from(">IIBB", data, at + 8)
            check((bits, colour) == (8, 2), f"{path} is no RGB of 8 bits")
        packed, at = packed + (data[at + 8 : at + 8 + size] if kind == b"IDAT" else b""), at + 12 + size
    raw, rows, before = zlib.decompress(packed), [], bytearray(3 * width)
    for y in range(height):
        kind, row = raw[y * (3 * width + 1)], bytearray(raw[y * (3 * width + 1) + 1 : (y + 1) * (3 * width + 1)])
        for i in range(3 * width):
            a, b, c = (row[i - 3] if i >= 3 else 0), before[i], (before[i - 3] if i >= 3 else 0)
            p = a + b - c
            paeth = a if abs(p - a) <= abs(p - b) and abs(p - a) <= abs(p - c) else b if abs(p - b) <= abs(p - c) else c
            row[i] = (row[i] + (0, a, b, (a + b) // 2, paeth)[kind]) & 255
        rows.append([tuple(row[3 * x : 3 * x + 3]) for x in range(width)])
        before = row
    return rows


@case("layers.are_shown_in_false_colour")
def shown(bench):
    scratch(bench, "n.png", png(64, 64, bumps))
    drawn = ("--size", "64x64", "--env-size", "32", "--env-samples", "16", "--msaa", "1", "-q")
    looks = {}
    for repeats in (1, 2, 4, 8):  # levels 0, 1, 2, 3, at texel centres
        scratch(bench, "p.gltf", files.text(lone_plane(repeats)))
        bench.run("render", "p.gltf", "--normal-map", "n.png", *drawn, "--show", "lod", "--aov", "lod", "-o", "p.png", "-o", "p.tif").expect(2).expect_one_line("--aov")
        bench.run("render", "p.gltf", "--normal-map", "n.png", *drawn, "--show", "lod", "-o", "p.png").expect(0)
        bench.run("render", "p.gltf", "--normal-map", "n.png", *drawn, "--aov", "lod", "-o", "p.exr").expect(0)
        levels = {round(level, 3) for row in exr_channels(bench.folder / "p.exr")["lod"] for level in row}
        check(levels == {{1: 0, 2: 1, 4: 2, 8: 3}[repeats]}, f"{repeats} times: levels {levels}")
        looks[repeats] = {texel for row in texels_of(bench.folder / "p.png") for texel in row}
        check(len(looks[repeats]) == 1, f"one level has {len(looks[repeats])} colours")
    check(len(set.union(*looks.values())) == 4, f"levels have the same colours: {looks}")
    # normals equal the map's; a lobe with grain along x is wide to the right, turned by 90 degrees upwards, by 45 degrees both ways
    scratch(bench, "flat.png", png(4, 4, lambda x, y: (128 + 76, 128, 128 + 101)))
    bench.run("render", "p.gltf", "--normal-map", "flat.png", *drawn, "--show", "normal", "-o", "n.out.png").expect(0)
    found = texels_of(bench.folder / "n.out.png")[32][32]
    check(all(abs(a - b) <= 2 for a, b in zip(found, (204, 128, 229))), f"a normal is shown as {found}")
    axes = {}
    for name, turn in (("right", 0.0), ("up", 1.5707963), ("between", 0.78539816)):
        scratch(bench, "g.gltf", files.text(lone_plane(pbrMetallicRoughness={"roughnessFactor": 0.3}, extensions={
            "KHR_materials_anisotropy": {"anisotropyStrength": 0.8, "anisotropyRotation": turn}})))
        bench.run("render", "g.gltf", *drawn, "--show", "tensor", "-o", "g.png").expect(0)
        axes[name] = texels_of(bench.folder / "g.png")[32][32]
    check(axes["right"][0] > 1.5 * axes["right"][1] and axes["up"][1] > 1.5 * axes["up"][0], f"{axes}")
    check(axes["right"][:2] == axes["up"][1::-1] and abs(axes["right"][2] - 128) <= 1 and axes["between"][2] > 200, f"{axes}")
    check(abs(axes["between"][0] - axes["between"][1]) <= 1, f"{axes}")
    # the image's hash covers its light
    light, false = (bench.figures("g.gltf", *drawn, *words)["pixel_hash"] for words in ((), ("--show", "tensor", "-o", "h.png")))
    check(light == false, "--show changes the hash")
    done = bench.run("render", "g.gltf", *drawn[:-1], "--show", "normal", "--exposure", "1", "-o", "w.png").expect(0)
    check("--exposure has no effect with --show" in done.err, done.describe())
    for code, needle, words in ((2, "nothing in g.gltf has a texture", ("--show", "lod", "-o", "x.png")), (2, "8 bits", ("--show", "normal", "-o", "x.exr")),
                                (2, "8 bits", ("--show", "normal", "-o", "x.apng", "--turntable", "2")), (2, "--show", ("--show", "level", "-o", "x.png")),
                                (2, "the reference has no layers", ("--show", "normal", "--backend", "reference", "-o", "x.png")),
                                (2, "needs --pipeline ids", ("--show", "normal", "--backend", "vulkan", "--pipeline", "forward", "-o", "x.png"))):
        bench.run("render", "g.gltf", *drawn, *words).expect(code).expect_one_line(needle)
    check(not [name for name in bench.left_behind() if name.startswith("x.")], f"{bench.left_behind()}")


@case("layers.that_cannot_be_are_refused")
def refused(bench):
    def no(code, needle, *words):
        bench.run("render", "builtin:plate", *DRAWN, *words).expect(code).expect_one_line(needle)
        check(bench.left_behind() == [], f"{words}: files were left")

    no(2, "did you mean 'normal'?", "--aov", "depth,normals", "-o", "a.exr")
    no(2, "'depth' is given twice", "--aov", "depth,normal,depth", "-o", "a.exr")
    no(2, "no other format has layers", "--aov", "depth", "-o", "a.png", "-o", "a.pfm")
    no(2, "no other format has layers", "--aov", "depth")
    no(2, "empty entry", "--aov", "depth,", "-o", "a.exr")
    no(2, "the reference has no layers", "--aov", "depth", "--backend", "reference", "-o", "a.exr")
    no(2, "needs --pipeline ids", "--aov", "depth", "--backend", "vulkan", "--pipeline", "forward", "-o", "a.exr")


@case("layers.specular_antialiasing_brings_normal_maps_nearer_to_the_reference", tier="nightly")
def specular_aa(bench):
    """Compares a still image with the reference; Vulkan draws the same image."""
    view = ("builtin:bumps", "--horizon", "off", "--size", "120x68", "--env-size", "128", "--env-samples", "64", "-q")
    done = bench.run("render", *view, "--backend", "reference", "--reference-textures", "full", "--samples", "256", "-o", "reference.exr")
    if done.code == 77:
        raise Skipped(done.err.strip())
    done.expect(0)
    for msaa in ("1", "8"):
        flip = []
        for more in ((), ("--specular-aa",)):
            bench.run("render", *view, "--msaa", msaa, *more, "-o", "a.exr").expect(0)
            flip.append(json.loads(bench.run("compare", "reference.exr", "a.exr", "--metric", "flip-hdr", "--json", "-").expect(0).out)["flip_mean"])
        check(flip[1] < 0.98 * flip[0], f"{msaa} samples a pixel: mean FLIP {flip}")
    pictures = []
    for backend in ("tile", "vulkan"):
        drawn_by(bench, ("--specular-aa", "-o", f"{backend}.exr"), backend, "builtin:bumps", "--msaa", "4")
        pictures.append((bench.folder / f"{backend}.exr").read_bytes())
    check(pictures[0] == pictures[1], "Vulkan draws another picture")
