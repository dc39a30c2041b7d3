"""Hostile files: they cost one line and an exit code, never the machine's memory, another file or the terminal."""

import pathlib
import re
import shutil
import struct
import xml.dom.minidom
import zlib

import gltf_files as files
from environment_files import small_sky
from harness import GIB, SMALL, Skipped, case, check, scratch
from input_cases import accept, refuse

REFERENCE = ("--backend", "reference", "--size", "32x24", "--samples", "64", "--env-size", "16", "--env-samples", "16")
TILE = ("--size", "32x24", "--msaa", "1", "--env-size", "16", "--env-samples", "16")


def scaled(scale=1.0, camera=None, matrix=None):
    """Returns the triangle scaled by `scale`, seen by the file's camera if one is given."""
    positions = struct.pack("<9f", *(scale * x for x in (-1, 0, 0, 1, 0, 0, 0, 1, 0)))
    gltf = files.triangle(positions=positions)
    gltf["accessors"][0].update(min=[-scale, 0, 0], max=[scale, scale, 0])
    if matrix:
        gltf["nodes"][0]["matrix"] = matrix
    if camera:
        gltf["cameras"] = [camera]
        gltf["nodes"].append({"camera": 0, "translation": [0, 0, scale]})
        gltf["scenes"][0]["nodes"].append(1)
    return gltf


def orthographic(half, far=100.0):
    return {"type": "orthographic", "orthographic": {"xmag": half, "ymag": half, "znear": 0.0, "zfar": far}}


def perspective(near, yfov=1.0):
    return {"type": "perspective", "perspective": {"yfov": yfov, "znear": near}}


# Scenes at the limits of floats, each with its view.
DEGENERATE = {
    **{f"scale_{scale:g}": (scaled(scale), ()) for scale in (1e-38, 1e-30, 1e-18, 1e-9, 1e9, 1e12, 1e16, 1e18, 1e20, 1e30, 3e38)},
    **{f"orthographic_{half:g}": (scaled(camera=orthographic(half)), ()) for half in (0.0, -1.0, 1e-30, 1e16, 1e18, 1e30, 3e38)},
    **{f"near_{near:g}": (scaled(camera=perspective(near)), ()) for near in (1e-30, 1e-9, 1e9, 1e18, 3e38)},
    **{f"yfov_{yfov:g}": (scaled(camera=perspective(0.1, yfov)), ()) for yfov in (1e-6, 3.1415)},
    **{f"eye_{far:g}": (scaled(), ("--eye", f"0,0,{far:g}", "--target", "0,0,0")) for far in (1e-30, 1e9, 1e17, 1e18, 1e20, 1e38)},
    **{f"squeezed_{s:g}": (scaled(matrix=[1, 0, 0, 0, 0, s, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]), ()) for s in (0.0, 1e-30, 1e18, 1e30)},
    "a_point": (scaled(0.0), ()),
    "far_away": (scaled(matrix=[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1e18, 0, 0, 1]), ("--eye", "0,0,1", "--target", "0,0,0")),
    "far_orthographic": (scaled(camera=orthographic(1.0, far=3e38)), ()),
}


def run_degenerate(bench, options):
    refused = set()
    for name, (gltf, view) in DEGENERATE.items():
        scratch(bench, name + ".gltf", files.text(gltf))
        done = bench.run("render", name + ".gltf", *options, *view, "-q", "-o", "out.exr")
        check(done.code in (0, 2, 4), f"{name}: {done.describe()}")
        if done.code:
            done.expect_one_line()
            refused.add(name)
        check((bench.folder / "out.exr").exists() == (done.code == 0), f"{name}: picture and exit code do not agree")
        (bench.folder / "out.exr").unlink(missing_ok=True)
    return refused


@case("hostile.degenerate_scenes", "program", "input", budget=12)
def degenerate(bench):
    """Starts the program once for each of many scenes."""
    run_degenerate(bench, TILE)


@case("hostile.degenerate_scenes_by_the_reference", "program", "input", budget=11)
def degenerate_reference(bench):
    """Starts the program once for each of many scenes."""
    if "reference" not in bench.run("info").expect(0).out:
        raise Skipped("built without Embree")
    refused = run_degenerate(bench, REFERENCE)
    for name in ("scale_1e+18", "orthographic_1e+30", "eye_1e+20", "eye_1e+38"):
        check(name in refused, f"{name} was not refused, and rays go no further than 1e17")
    for name in ("scale_1e-30", "scale_1e-18", "scale_1e-09"):
        check(name in refused, f"{name} was not refused, and rays miss what is small")
    for name in ("scale_1e+12", "scale_1e-06", "eye_1e+09"):
        check(name not in refused, f"{name} was refused")
    bench.run("render", "scale_1e+18.gltf", *REFERENCE).expect(4).expect_one_line("1e+12", "scale the scene down")
    bench.run("render", "scale_1e-09.gltf", *REFERENCE).expect(4).expect_one_line("scale the scene up")


@case("hostile.zeros_of_any_count_cost_no_memory", "program", "input")
def many_zeros(bench):
    """Draws a triangle of three among four thousand million positions, which the file leaves out: all are zero."""
    gltf = files.triangle(indices=struct.pack("<3I", 0, 1, 3_999_999_999))
    positions, indices = gltf["accessors"]
    positions.pop("bufferView"), positions.update(count=4_000_000_000, min=[0, 0, 0], max=[0, 0, 0])
    indices.update(componentType=5125)
    gltf["bufferViews"][1]["byteLength"], gltf["buffers"][0]["byteLength"] = 12, 48
    scratch(bench, "zeros.gltf", files.text(gltf))
    done = bench.run("render", "zeros.gltf", *TILE, "-q", "-o", "zeros.exr").expect(0)
    check(done.peak_bytes < GIB // 2, f"took {done.peak_bytes >> 20} MiB")


@case("hostile.tiny_scenes_are_drawn_as_large_ones_or_refused", "program", "input", budget=5)
def tiny(bench):
    """Draws triangles of a metre and less, by views that scale with them: framed, by --eye, by a camera of the file."""
    def draw(scale, name):
        camera = {"type": "perspective", "perspective": {"yfov": 1.0, "znear": 1e-3 * scale}}
        for way, gltf, view in (("framed", scaled(scale), ()), ("camera", scaled(scale, camera=camera), ()),
                                ("eye", scaled(scale), ("--eye", f"0,{0.5 * scale:g},{2 * scale:g}", "--target", f"0,{0.5 * scale:g},0"))):
            if way == "camera":
                gltf["nodes"][-1]["translation"] = [0, 0.5 * scale, 2 * scale]
            scratch(bench, f"{name}.gltf", files.text(gltf))
            bench.run("render", f"{name}.gltf", *TILE, "--no-background", *view, "-q", "-o", f"{name}_{way}.exr").expect(0)
            yield way
    ways = list(draw(1.0, "metre"))
    check(len(ways) == 3, f"{ways}")
    for scale in (1e-6, 1e-14):
        for way in list(draw(scale, "small")):
            bench.run("compare", f"metre_{way}.exr", f"small_{way}.exr", "--metric", "flip-hdr", "--fail-flip", "0.002").expect(0)
    scratch(bench, "atom.gltf", files.text(scaled(1e-20)))
    bench.run("render", "atom.gltf", *TILE, "-q", "-o", "atom.exr").expect(4).expect_one_line("/nodes", "scale the scene up")


@case("hostile.what_an_environment_needed_is_said", budget=4)
def repaired_environment(bench):
    pixels = [1.0] * (8 * 4 * 3)
    pixels[5], pixels[7], pixels[8], pixels[20] = float("nan"), -1.0, -2.0, float("inf")
    scratch(bench, "bad.pfm", b"PF\n8 4\n-1.0\n" + struct.pack(f"<{len(pixels)}f", *pixels))
    for _ in range(2):  # baked, then from the cache
        done = bench.run("render", *SMALL, "--env", "bad.pfm", "--stats", "s.json").expect(0)
        for words in ("1 NaN", "2 negative", "1 infinite"):
            lines = [line for line in done.err.splitlines() if words in line]
            check(len(lines) == 1 and lines[0].startswith("burnish: warning: "), f"'{words}' is not said once\n{done.describe()}")
    found = bench.figures(*SMALL, "--env", "bad.pfm", "-q")
    check(len(found["warnings"]) == 3, f"--stats has {found.get('warnings')}")
    scratch(bench, "file", b"")
    env = {"XDG_CACHE_HOME": str(bench.folder / "file")}
    words = ("builtin:sphere", "--size", "64x48", "--msaa", "1", *small_sky(bench))
    done = bench.run("render", *words, env=env).expect(0)
    check(done.err.count("is not cached") == 1, f"an unwritable cache is not said\n{done.describe()}")
    check(len(bench.figures(*words, env=env)["warnings"]) == 1, "an unwritable cache is not in --stats")
    check(bench.figures(*SMALL)["warnings"] == [], "warnings without a reason")
    for command in (("profile", "--frames", "1"), ("chart", "--techniques", "split_isotropic", "--runs", "1", "--reference-samples", "64",
                                                   "--error-size", "32x24", "-o", "report")):
        done = bench.run(*command, *SMALL, "--env", "bad.pfm").expect(0)
        check("1 NaN" in done.err, f"{command[0]} does not say it\n{done.describe()}")


@case("hostile.what_maps_and_bakes_needed_is_said")
def repaired_maps(bench):
    """Covers float images with invalid values, and scenes, for every reader."""
    pixels = [0.5] * (8 * 8 * 3)
    pixels[5], pixels[30], pixels[31] = float("nan"), float("inf"), float("nan")
    scratch(bench, "bad.pfm", b"PF\n8 8\n-1.0\n" + struct.pack(f"<{len(pixels)}f", *pixels))
    gltf = files.textured("wood.png")
    gltf["nodes"][0]["rotation"] = [0, 0, 0, 2]
    scratch(bench, "bad.gltf", files.text(gltf))
    scratch(bench, "wood.png", files.png(4, 4))
    (bench.folder / "worn").mkdir()
    for name in ("wood_albedo.pfm", "wood_roughness.pfm"):
        shutil.copy(bench.folder / "bad.pfm", bench.folder / "worn" / name)
    bad = "bad.pfm: 2 "
    for words, said in ((("render", "builtin:plate", *TILE, "--height-map", "bad.pfm"), (bad,)), (("render", "builtin:plate", *TILE, "--direction-map", "bad.pfm"), (bad,)),
                        (("render", "builtin:plate", *TILE, "--material", "worn"), ("wood_albedo.pfm: 2 ", "wood_roughness.pfm: 2 ")),
                        (("bake", "direction", "bad.pfm", "--from", "hue", "-o", "d.png"), (bad,)),
                        (("bake", "environment", "bad.pfm", "--env-size", "16", "-o", "baked"), ("2 NaN", "1 infinite")),
                        (("bake", "displaced", "bad.gltf", "bad.pfm", "--triangles", "1", "-o", "s.glb"), (bad, "/nodes/0/rotation")),
                        (("bake", "tpr", "--straighten", "bad.gltf", "--direction", "1,0,0", "-o", "t.exr"), ("/nodes/0/rotation",))):
        done = bench.run(*words).expect(0)
        warnings = [line for line in done.err.splitlines() if line.startswith("burnish: warning: ")]
        for text in said:
            check(len([line for line in warnings if text in line]) == 1, f"'{text}' is not said once\n{done.describe()}")


def many_buffers(names, length):
    gltf = files.triangle()
    gltf["buffers"] += [{"byteLength": length, "uri": name} for name in names]
    return files.text(gltf)


@case("hostile.a_file_is_read_once_under_all_its_names", "input")
def many_names(bench):
    size = 24 << 20
    with open(bench.folder / "big.bin", "wb") as big:
        big.truncate(size)
    (bench.folder / "link.bin").symlink_to("big.bin")
    names = ["./" * i + "big.bin" for i in range(30)] + ["link.bin", "big%2Ebin"]
    scene = scratch(bench, "scene.gltf", many_buffers(names, size))
    done = accept(bench, scene)
    if not bench.sanitized:
        check(done.peak_bytes < GIB // 2, f"took {done.peak_bytes >> 20} MiB")
    refuse(bench, scene, "--limit-input-bytes", "16M", needles=["--limit-input-bytes"])
    for i in range(3):
        shutil.copy(bench.folder / "big.bin", bench.folder / f"copy{i}.bin")
    scene = scratch(bench, "copies.gltf", many_buffers([f"copy{i}.bin" for i in range(3)], size))
    refuse(bench, scene, "--limit-input-bytes", "64M", needles=["/buffers/3/uri", "--limit-input-bytes"])
    accept(bench, scene, "--limit-input-bytes", "80M")


@case("hostile.links_do_not_lead_out_of_the_folder", "input")
def links(bench):
    scratch(bench, "out.bin", files.POSITIONS + files.INDICES)
    scratch(bench, "wood.png", files.png(4, 4))
    scene = bench.folder / "scene"
    scratch(bench, "scene/inside.bin", files.POSITIONS + files.INDICES)
    (scene / "sub").mkdir()
    (scene / "link.bin").symlink_to("../out.bin")
    (scene / "up").symlink_to("..")
    (scene / "root").symlink_to("/")
    (scene / "good.bin").symlink_to("inside.bin")
    (scene / "sub" / "back.bin").symlink_to("../inside.bin")
    (scene / "wood.png").symlink_to("../wood.png")
    gltf = files.triangle()
    for name in ("link.bin", "up/out.bin", "root" + str(bench.folder / "out.bin")):
        gltf["buffers"][0]["uri"] = name
        path = scratch(bench, "scene/scene.gltf", files.text(gltf))
        refuse(bench, path, needles=["/buffers/0/uri", "--allow-outside-uris"])
        accept(bench, path, "--allow-outside-uris")
    for name in ("good.bin", "sub/back.bin"):
        gltf["buffers"][0]["uri"] = name
        accept(bench, scratch(bench, "scene/scene.gltf", files.text(gltf)))
    refuse(bench, scratch(bench, "scene/textured.gltf", files.text(files.textured("wood.png"))), needles=["/images/0/uri"])
    (bench.folder / "alias").symlink_to("scene")
    accept(bench, "alias/scene.gltf")


def riff(chunk):
    return b"RIFF" + struct.pack("<I", 4 + len(chunk)) + b"WEBP" + chunk


def tiff(width, height, compression, samples=4, bits=8, extra=(), order="<"):
    entries = {256: (4, width), 257: (4, height), 258: (3, bits), 259: (3, compression), 262: (3, 2), 273: (4, 8), 277: (3, samples),
               278: (4, height), 279: (4, 16), **dict(extra)}
    body = b""
    for tag, (kind, value) in sorted(entries.items()):
        body += struct.pack(order + "HHI", tag, kind, 1) + (struct.pack(order + "I", value) if kind == 4 else struct.pack(order + "HH", value, 0))
    return ((b"II" if order == "<" else b"MM") + struct.pack(order + "HI", 42, 8) + struct.pack(order + "H", len(entries)) + body +
            bytes(4) + bytes(16))


def bmp(width, height, bits, method):
    return (b"BM" + struct.pack("<IHHI", 118, 0, 0, 54) +
            struct.pack("<IiiHHIIiiII", 40, width, height, 1, bits, method, 64, 0, 0, 0, 0) + bytes(64))


SIDE = 8000
BOMBS = {
    "lzw.tif": tiff(SIDE, SIDE, 5),
    "none.tif": tiff(SIDE, SIDE, 1),
    "deflate_mm.tif": tiff(SIDE, SIDE, 8, order=">"),
    "float.tif": tiff(SIDE, SIDE, 8, bits=32),
    "tiles.tif": tiff(16, 16, 8, extra={322: (4, 16384), 323: (4, 16384)}.items()),
    "plain.bmp": bmp(SIDE, SIDE, 24, 0),
    "runs.bmp": bmp(SIDE, -SIDE, 8, 1),
    "lossless.webp": riff(b"VP8L" + struct.pack("<IBI", 5, 0x2F, (SIDE - 1) | (SIDE - 1) << 14) + bytes(9)),
    "canvas.webp": riff(b"VP8X" + struct.pack("<II", 10, 0) + struct.pack("<I", SIDE - 1)[:3] + struct.pack("<I", SIDE - 1)[:3]),
    "grey.jpg": b"\xff\xd8\xff\xc2\x00\x0b\x08" + struct.pack(">HH", SIDE, SIDE) + b"\x01\x01\x11\x00" +
                b"\xff\xda\x00\x08\x01\x01\x00\x00\x00\x00\xff\xd9",
    "bits.png": files.png(SIDE, SIDE, rows=1),
}


@case("hostile.headers_that_ask_for_memory", "input")
def header_bombs(bench):
    scratch(bench, "small.png", files.png(4, 4))
    for name, data in BOMBS.items():
        scratch(bench, name, data)
        for words in (("compare", name, "small.png"), ("render", *TILE, "builtin:plate", "--env", name)):
            done = bench.run(*words).expect(4).expect_one_line(name)
            check("cannot hold" in done.err or "too large" in done.err, f"another reason\n{done.describe()}")
            if not bench.sanitized:
                check(done.peak_bytes < 200 << 20, f"{name} took {done.peak_bytes >> 20} MiB\n{done.describe()}")


@case("hostile.offsets_that_lead_out_of_the_file", "input", budget=5)
def offsets(bench):
    """An OpenEXR image whose lines lie before its first byte, or far behind the last. OpenEXR adds offsets unchecked: -1 and 4 give 3."""
    whole = (pathlib.Path(__file__).parent.parent / "fuzz/corpus/exr/lines_before_the_file.exr").read_bytes()
    at = whole.index(b"\xff" * 8 + b"\xff" * 8)
    for offset in (-1, -4, -8, -4096, -(1 << 40), -(1 << 63), (1 << 63) - 1, len(whole) + 1):
        scratch(bench, "bad.exr", whole[:at] + struct.pack("<q", offset) + whole[at + 8:])
        done = refuse(bench, "builtin:sphere", env="bad.exr")
        place = re.search(r"byte (\d+)", done.err)
        check(place and int(place.group(1)) <= len(whole), f"no place in the file\n{done.describe()}")


@case("hostile.headers_that_scale_by_nothing", "input", budget=4)
def scales(bench):
    """Images whose samples are divided by 0, or multiplied by 0 or by NaN."""
    pixels = struct.pack("<48f", *[0.5] * 48)
    for scale in (b"0", b"-0.0", b"nan", b"-inf", b"1e400", b"1e-400", b"x", b"1x", b"1" * 100):
        scratch(bench, "bad.pfm", b"PF\n4 4\n" + scale + b"\n" + pixels)
        refuse(bench, "builtin:sphere", env="bad.pfm", needles=["byte 7", "scale"])
    for kind, most in ((b"P5", b"0"), (b"P6", b"65536"), (b"P2", b"-1"), (b"P3", b"")):
        scratch(bench, "bad.ppm", kind + b"\n4 4\n" + most + b"\n")
        with open(bench.folder / "bad.ppm", "ab") as file:
            file.write(bytes(48))
        refuse(bench, "builtin:sphere", env="bad.ppm", needles=["largest value"])
    for scale in (b"2.5", b"-1e-3", b"#\n\t-1"):
        accept(bench, "builtin:sphere", "--floor", "off", "--env", scratch(bench, "good.pfm", b"PF\n4 4\n" + scale + b"\n" + pixels))
    accept(bench, "builtin:sphere", "--floor", "off", "--env", scratch(bench, "good.pgm", b"P5 #\n4 4 # sides\n1\n" + bytes(16)))


@case("hostile.an_environment_has_a_limit_of_pixels", "input")
def environment_pixels(bench):
    width, height = 16384, 8192
    row = b"\0" + bytes(width)
    squeeze = zlib.compressobj(9)
    data = b"".join(squeeze.compress(row) for _ in range(height)) + squeeze.flush()

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    scratch(bench, "vast.png", b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)) +
            chunk(b"IDAT", data) + chunk(b"IEND", b""))
    refuse(bench, "builtin:plate", env="vast.png", needles=["--limit-env-pixels"])
    scratch(bench, "small.png", files.png(40, 20))
    small = ("render", *TILE, "builtin:plate", "--env", "small.png")
    bench.run(*small, "--limit-env-pixels", "799").expect(4).expect_one_line("small.png", "--limit-env-pixels")
    bench.run(*small, "--limit-env-pixels", "800").expect(0)


EVIL = "evil\x1b[31m\x07\x9b\u202e<b>&name"


@case("hostile.names_are_escaped", "program", "input", tier="nightly")
def names(bench):
    gltf = files.triangle()
    gltf["materials"] = [{"name": EVIL}]
    gltf["meshes"][0]["primitives"][0]["material"] = 0
    gltf["nodes"].append({"name": EVIL, "camera": 0})
    gltf["cameras"] = [{"name": EVIL, **orthographic(1.0)}]
    gltf["scenes"][0]["nodes"].append(1)
    scratch(bench, "scene.gltf", files.text(gltf))
    path = bench.folder / "sc\udcff\x1bene.gltf"  # not UTF-8
    path.write_text(files.text(gltf))
    scratch(bench, "evil\x9b\u202e\x1b.gltf", files.text(gltf))
    pages = ["p.svg"] + (["r/report.html"] if "reference" in bench.run("info").expect(0).out else [])
    runs = (("profile", str(path), *SMALL, "--frames", "1", "--svg", "p.svg", "--json", "-"), ("render", str(path), *SMALL, "-v"),
            ("render", "evil\x9b\u202e\x1b.gltf", *SMALL, "--stats", "-"),
            ("render", str(path), *SMALL, "--camera", "none\x1b"), ("render", "no\x1bsuch\udcfe.gltf", *SMALL),
            ("chart", str(path), *SMALL, "--techniques", "split_isotropic", "--runs", "1", "--reference-samples", "64",
             "--error-size", "32x24", "-o", "r"),
            ("parity", str(path), *TILE, "--technique", "mc", "--msaa", "1", "--device", "lavapipe", "--junit", "p.xml", "--html", "p.html", "--csv", "-"))
    for words in runs:
        done = bench.run(*words)
        check(done.code in (0, 2, 4) or (words[0] in ("parity", "chart") and done.code == 77), done.describe())
        if words[0] == "parity" and done.code == 0:
            pages += ["p.xml", "p.html"]
        for text in (done.out, done.err):
            check(all(c >= " " or c == "\n" for c in text) and "\x7f" not in text and "\x9b" not in text and "\u202e" not in text and "\ufffd" not in text,
                  f"a control character comes through\n{done.describe()!r}")
    for name in pages:
        text = (bench.folder / name).read_text(encoding="utf-8")  # fails on invalid UTF-8
        check("\x1b" not in text and "<b>&name" not in text, f"{name} holds the name as it is")
        if name.endswith((".svg", ".xml")):
            xml.dom.minidom.parse(str(bench.folder / name))
    print("looked at", pages)


@case("hostile.names_of_materials_make_names_of_files", "input")
def file_names(bench):
    """For `bake mip --preview`: names lie below the folder, are unique, and are never too long."""
    scratch(bench, "wood.png", files.png(4, 4, color=lambda x, y: (120 + 4 * x, 120 + 4 * y, 240)))
    names = ("../../up", "/tmp/down", "a/b", "a_b", "A\0b", "..", "", "x" * 300, "x" * 300, "\u00e9" * 300, EVIL)
    gltf = files.textured("wood.png")
    gltf["materials"] = [{"name": name, "normalTexture": {"index": 0}, "pbrMetallicRoughness": {"roughnessFactor": 0.3 + 0.05 * i}}
                         for i, name in enumerate(names)]
    primitive = gltf["meshes"][0]["primitives"][0]
    gltf["meshes"][0]["primitives"] = [{**primitive, "material": i} for i in range(len(names))]
    scratch(bench, "scene.gltf", files.text(gltf))
    bench.run("bake", "mip", "scene.gltf", "--mip-filter", "ssgt", "-o", "b.mip", "--preview", "levels", "-q").expect(0)
    found = [path.name for path in (bench.folder / "levels").iterdir()]
    check(len(found) == 2 * 2 * len(names), f"{len(found)} pictures: {sorted(found)}")  # normals and lobes of two levels
    check({path.name for path in bench.folder.iterdir() if path.name[0] != "."} == {"b.mip", "levels", "scene.gltf", "wood.png"}, "written elsewhere")


@case("hostile.a_damaged_module_is_not_opened", "program")
def damaged_module(bench):
    module = pathlib.Path(bench.program).parent / "burnish_openimageio.so"
    if not module.exists():
        raise Skipped("the module does not lie beside the program")
    program = bench.folder / "burnish"
    shutil.copy(bench.program, program)
    whole = module.read_bytes()
    flipped = bytearray(whole)
    flipped[len(whole) // 3] ^= 1
    for data in (whole[:4096], whole[:-(len(whole) // 2)], whole[:20], b"", bytes(flipped), b"\x7fELF" + bytes(len(whole))):
        (bench.folder / module.name).write_bytes(data)
        done = bench.run("render", *SMALL, "-q", "-o", "out.exr", program=str(program)).expect(77)
        done.expect_one_line("out.exr", "image library")
        check(not (bench.folder / "out.exr").exists(), "a picture was written")
    (bench.folder / module.name).write_bytes(whole)
    bench.run("render", *SMALL, "-q", "-o", "out.exr", program=str(program)).expect(0)


@case("hostile.a_scene_out_of_the_range_of_floats", "input")
def huge_vertex(bench):
    scene = scratch(bench, "huge.gltf", files.text(scaled(3e38)))
    refuse(bench, scene, needles=["/nodes", "farther than 1e+12 m"])
