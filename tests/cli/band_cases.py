"""Pictures in bands of rows: the bytes of whole pictures, in the memory of a band."""

import json
import re
import struct
import zlib

from harness import case, check

SMALL = ("--size", "200x150", "--env-size", "32", "--env-samples", "64", "--no-cache", "-q")


def same_bytes(bench, a, b):
    check((bench.folder / a).read_bytes() == (bench.folder / b).read_bytes(), f"{a} and {b} differ")


def hash_of(bench, *words):
    return json.loads(bench.run("render", *words, "--stats", "-", timeout=300).expect(0).out)["pixel_hash"]


def check_same(bench, name, *words, rows=48, aov=()):
    """Draws a picture at once and in bands. Compares files and hashes."""
    outputs = lambda kind: ("-o", f"{name}_{kind}.png", "-o", f"{name}_{kind}.exr")
    whole = hash_of(bench, *words, *aov, *outputs("whole"))
    bands = hash_of(bench, *words, *aov, *outputs("bands"), "--band-rows", str(rows))
    check(whole == bands, f"{name}: {whole} and {bands}")
    for ending in ("png", "exr"):
        same_bytes(bench, f"{name}_whole.{ending}", f"{name}_bands.{ending}")


@case("band.pictures_have_the_bytes_of_whole_ones", budget=19)
def same(bench):
    """By a technique that shares samples, with lights and their shadows, blended and masked surfaces, layers, and without a background.
    Draws each whole and in bands."""
    check_same(bench, "teapot", "builtin:teapot", *SMALL, "--msaa", "4")
    check_same(bench, "spheres", "builtin:spheres", *SMALL, "--no-background", "--technique", "mc", "--samples", "4", aov=("--aov", "depth,normal"), rows=16)
    check_same(bench, "lights", "builtin:lights", *SMALL, "--msaa", "4", "--shadows", "on", "--shadow-samples", "16", rows=64)
    check_same(bench, "masked", bench.data_file("reports/blend_twelve_sheets.gltf"), *SMALL, "--msaa", "2", "--exposure", "1")


def places(width, height, at):
    """Indices of the values in a column of a wide picture, or in a row of a high one."""
    pixels = range(at, width * height, width) if width > height else range(at * width, (at + 1) * width)
    return [3 * pixel + c for pixel in pixels for c in range(3)]


def rgb_of(file):
    """Returns width, height and RGB bytes of a .png that the program wrote: one filter, Paeth's, and no interlace."""
    data = file.read_bytes()
    width, height = struct.unpack(">II", data[16:24])
    at, packed = 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        packed += data[at + 8:at + 8 + size] if kind == b"IDAT" else b""
        at += size + 12
    raw, row = zlib.decompress(packed), 3 * width
    before, out = bytearray(row), bytearray()
    for y in range(height):
        line = bytearray(raw[y * (row + 1) + 1:(y + 1) * (row + 1)])
        kind = raw[y * (row + 1)]
        check(kind in (0, 4), f"filter {kind}")
        for x in range(row if kind else 0):
            a, b, c = (line[x - 3] if x > 2 else 0), before[x], (before[x - 3] if x > 2 else 0)
            p = a + b - c
            pa, pb, pc = abs(p - a), abs(p - b), abs(p - c)
            line[x] = line[x] + (a if pa <= pb and pa <= pc else b if pb <= pc else c) & 255
        before = line
        out += line
    return width, height, out


@case("band.no_line_shows_where_cells_meet", budget=7)
def shared(bench):
    """At the cells' borders the picture changes no more than elsewhere, by a technique that shares samples."""
    look = ("--env-size", "32", "--env-samples", "64", "--no-cache", "-q", "--msaa", "1", "--technique", "lobe_line", "--eye", "0,0.2,0.6",
            "--target", "0,0,0", "--tonemap", "none")
    for size, name, stride, angle in (("33000x16", "wide.png", 3, "0.1"), ("16x33000", "high.png", 3 * 16, "90")):
        bench.run("render", "builtin:plate", *look, "--size", size, "--fov", angle, "-o", name).expect(0)
        width, height, pixels = rgb_of(bench.folder / name)
        check(f"{width}x{height}" == size and len(set(pixels)) > 20, f"{name}: {len(set(pixels))} values")
        # The mean change from one column, or row, to the next
        change = lambda at: sum(abs(pixels[i] - pixels[i - stride]) for i in places(width, height, at)) / 48
        usual = sorted(change(at) for at in range(15000, 18000, 7) if at != 16384)
        check(change(16384) <= usual[-1] and change(32768) <= usual[-1] + 0.5, f"{name}: {change(16384)}, {change(32768)}, usually {usual[0]} to {usual[-1]}")


@case("band.merged_pieces_are_the_picture", budget=20)
def pieces(bench):
    """Draws one picture whole, in two shares, and for its timeline."""
    words = ("builtin:teapot", *SMALL, "--msaa", "4", "--band-rows", "32", "-o", "a.exr", "-o", "a.png")
    bench.run("render", *words).expect(0)
    for ending in ("exr", "png"):
        (bench.folder / f"a.{ending}").rename(bench.folder / f"one.{ending}")
    listed = bench.run("render", *words, "--pieces").expect(0).out.splitlines()
    check(len(listed) == 5 and all(re.match(r"^[0-9a-f]{16} ", line) for line in listed), f"{listed}")
    bench.run("render", *words, "--shard", "2/3", "--work", "w").expect(0)
    bench.run("render", *words, "--merge", "--work", "w").expect(5)
    bench.run("render", *words, "--take", "--work", "w", "--threads", "1").expect(0)
    bench.run("merge", "w").expect(0)
    for ending in ("exr", "png"):
        same_bytes(bench, f"one.{ending}", f"a.{ending}")
    # The timeline of a picture in bands
    bench.run("render", *words, "--trace", "a.trace").expect(0)
    check(b'"band"' in (bench.folder / "a.trace").read_bytes(), "no bands in the timeline")
    # A damaged piece is refused
    piece = next(path for path in (bench.folder / "w").iterdir() if listed[0][:16] in path.name)
    content = bytearray(piece.read_bytes())
    content[len(content) // 2] ^= 1
    piece.write_bytes(content)
    bench.run("merge", "w").expect(5).expect_one_line("is damaged", listed[0][:16])


@case("band.refuses_what_needs_the_whole_picture", tier="quick")
def refused(bench):
    run = lambda *words: bench.run("render", "builtin:teapot", *words)
    run("--size", "64x64", "--band-rows", "16", "--frames", "1", "--show", "light", "-q").expect(0)
    for words, names in ((("--frames", "2"), ("--frames",)), (("--risks", "-"), ("--risks",)), (("--budget", "0.05"), ("--budget",)),
                         (("--show", "lod", "-o", "a.png"), ("--show",)), (("--backend", "reference"), ("--backend", "tile")),
                         (("--backend", "vulkan"), ("--backend", "tile")), (("--floor", "mirror"), ("--floor",)),
                         (("-o", "a.hdr"), ("a.hdr", ".exr")), (("--turntable", "4", "-o", "a_%d.png"), ("--turntable",))):
        run("--size", "64x64", "--band-rows", "16", *words).expect(2).expect_one_line("--band-rows", *names)
    run("--band-rows", "20").expect(2).expect_one_line("--band-rows", "16")
    run("--band-rows", "0").expect(2).expect_one_line("--band-rows")
    for rows in ("16", "768"):
        run("--size", "20x20000", "--band-rows", rows).expect(2).expect_one_line("--band-rows", "64, 128, 256")
    run("--size", "16384x16384", "--msaa", "2", "--band-rows", "16384").expect(2).expect_one_line("--band-rows", "samples", "at most")
    run("--size", "65536x65536", "--aov", "depth,normal,albedo", "-o", "a.exr", "--band-rows", "1024").expect(2).expect_one_line("--band-rows", "MiB")
    run("--size", "64x64", "--band-rows", "16", "--pieces", "--stats", "a.json").expect(2).expect_one_line("--stats")
    run("--size", "65537x20").expect(2).expect_one_line("--size", "65536")
    run("--size", "20000x20", "-o", "a.jpg").expect(2).expect_one_line("--size", "a.jpg", ".png")
    run("--size", "20000x20", "--backend", "reference").expect(2).expect_one_line("--size", "16384")
    bench.run("parity", "builtin:teapot", "--size", "20000x20").expect(2).expect_one_line("--size", "16384")
    # Surfaces that let light through show the picture behind them
    bench.run("render", "builtin:glass", "--size", "64x64", "--band-rows", "64", "-q").expect(0)
    bench.run("render", "builtin:glass", "--size", "64x64", "--band-rows", "16", "-q").expect(2).expect_one_line("--band-rows: cannot be combined with", "whole picture", "--glass interface")
    listed = bench.run("render", "builtin:glass", "--size", "64x64", "--band-rows", "16", "--pieces", "-q").expect(2)
    listed.expect_one_line("--band-rows: cannot be combined with")
    large = bench.run("render", "builtin:glass", "--size", "16x20000", "-q").expect(2)
    large.expect_one_line("--size: of 16x20000 is drawn in bands, and cannot be combined with", "--glass interface")


@case("band.large_pictures_are_drawn_in_cells", tier="nightly")
def large(bench):
    """A picture of three cells has the same bits for any number of threads and rows, in the memory of a band. Its tiles are read."""
    words = ("builtin:teapot", "--env-size", "32", "--env-samples", "64", "--msaa", "1", "--technique", "bent_normal", "-q", "--fov", "3")
    first = hash_of(bench, *words, "--size", "40000x900", "-o", "a.exr", "-o", "a.png")
    check(first == hash_of(bench, *words, "--size", "40000x900", "--threads", "1", "--band-rows", "512"), "threads and rows")
    peak = bench.run("render", *words, "--size", "40000x900", "-o", "b.png", timeout=300).expect(0).peak_bytes
    check(peak < 700 << 20, f"{peak >> 20} MiB")
    bench.run("compare", "a.exr", "a.exr", "--metric", "max", "--limit-image-side", "65536").expect(0)
