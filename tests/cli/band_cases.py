"""Pictures in bands of rows: the bytes of whole pictures, in the memory of a band."""

import json
import re

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


@case("band.pictures_have_the_bytes_of_whole_ones", budget=20)
def same(bench):
    """By a technique that shares samples, with lights and their shadows, blended and masked surfaces, layers, and without a background."""
    check_same(bench, "teapot", "builtin:teapot", *SMALL, "--msaa", "4")
    check_same(bench, "spheres", "builtin:spheres", *SMALL, "--no-background", "--technique", "mc", "--samples", "4", aov=("--aov", "depth,normal"), rows=16)
    check_same(bench, "lights", "builtin:lights", *SMALL, "--msaa", "4", "--shadows", "on", "--shadow-samples", "16", rows=64)
    check_same(bench, "masked", bench.data_file("reports/blend_twelve_sheets.gltf"), *SMALL, "--msaa", "2", "--exposure", "1")


@case("band.samples_are_shared_across_cells", budget=10)
def shared(bench):
    """Pixels read their neighbours beyond their cell, so an even picture shows no line at the cells' borders."""
    look = ("--env-size", "32", "--env-samples", "64", "--no-cache", "-q", "--msaa", "1", "--eye", "0,0,3", "--target", "0,0,0", "--fov", "0.2")
    for size, ending in (("33000x16", "wide.exr"), ("16x33000", "high.exr")):
        done = bench.run("render", "builtin:plate", *look, "--size", size, "-o", ending).expect(0)
        check(done.err == "", done.err)


@case("band.merged_pieces_are_the_picture", budget=20)
def pieces(bench):
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
    # A damaged piece is refused
    piece = next(path for path in (bench.folder / "w").iterdir() if listed[0][:16] in path.name)
    content = bytearray(piece.read_bytes())
    content[len(content) // 2] ^= 1
    piece.write_bytes(content)
    bench.run("merge", "w").expect(5).expect_one_line("is damaged", listed[0][:16])


@case("band.refuses_what_needs_the_whole_picture", tier="quick")
def refused(bench):
    run = lambda *words: bench.run("render", "builtin:teapot", *words)
    for words, names in ((("--frames", "2"), ("--frames",)), (("--risks", "-"), ("--risks",)), (("--budget", "0.05"), ("--budget",)),
                         (("--show", "lod", "-o", "a.png"), ("--show",)), (("--backend", "reference"), ("--backend", "tile")),
                         (("--backend", "vulkan"), ("--backend", "tile")), (("--floor", "mirror"), ("--floor",)),
                         (("-o", "a.hdr"), ("a.hdr", ".exr")), (("--turntable", "4", "-o", "a_%d.png"), ("--turntable",))):
        run("--size", "64x64", "--band-rows", "16", *words).expect(2).expect_one_line("--band-rows", *names)
    run("--band-rows", "20").expect(2).expect_one_line("--band-rows", "16")
    run("--band-rows", "0").expect(2).expect_one_line("--band-rows")
    run("--size", "20000x20", "--band-rows", "16").expect(2).expect_one_line("--band-rows", "256")
    run("--size", "65537x20").expect(2).expect_one_line("--size", "65536")
    run("--size", "20000x20", "-o", "a.jpg").expect(2).expect_one_line("--size", "a.jpg", ".png")
    run("--size", "20000x20", "--backend", "reference").expect(2).expect_one_line("--size", "16384")
    bench.run("parity", "builtin:teapot", "--size", "20000x20").expect(2).expect_one_line("--size", "16384")
    # Surfaces that let light through show what is behind them
    bench.run("render", "builtin:glass", "--size", "64x64", "--band-rows", "16", "-q").expect(2).expect_one_line("--size", "whole picture", "--glass interface")


@case("band.large_pictures_are_drawn_in_cells", tier="nightly")
def large(bench):
    """A picture of three cells has the light of a small one, and the same bits for any number of threads and rows."""
    words = ("builtin:teapot", "--env-size", "32", "--env-samples", "64", "--msaa", "1", "--technique", "bent_normal", "-q", "--fov", "3")
    first = hash_of(bench, *words, "--size", "40000x900", "-o", "a.exr", "-o", "a.png")
    check(first == hash_of(bench, *words, "--size", "40000x900", "--threads", "1", "--band-rows", "512"), "threads and rows")
    peak = bench.run("render", *words, "--size", "40000x900", "-o", "b.png", timeout=300).expect(0).peak_bytes
    check(peak < 700 << 20, f"{peak >> 20} MiB")
    # Tiles are read back
    bench.run("compare", "a.exr", "a.exr", "--metric", "max", "--limit-image-side", "65536").expect(0)
