"""burnish bake: tables that shading reads."""

import json
import math
import random
import re
import struct
import subprocess
import zlib

from compare_cases import png
from harness import case, check, scratch


@case("bake.processes_that_want_one_environment_bake_it_once")
def once(bench):
    env = bench.environment({"XDG_CACHE_HOME": str(bench.folder / "cache")})
    words = ("render", "builtin:sphere", "--size", "16x16", "--msaa", "1", "--env-size", "256", "--env-samples", "4096", "-q")
    running = [subprocess.Popen([bench.program, *words, "-o", f"{i}.pfm", "--stats", f"{i}.json"], cwd=bench.folder, env=env,
                                stdin=subprocess.DEVNULL) for i in range(3)]
    check(all(process.wait(timeout=120.0) == 0 for process in running), "a process failed")
    found = [json.loads((bench.folder / f"{i}.json").read_text()) for i in range(3)]
    baked = sum(not stats["environment_from_cache"] for stats in found)
    check(baked == 1, f"{baked} of 3 processes baked the environment")
    check(len({stats["pixel_hash"] for stats in found}) == 1, "the pictures differ")


def shown(bench, name):
    """Returns the width, height and rows of (r, g, b), 8 bits, of a PNG by the program."""
    data = (bench.folder / name).read_bytes()
    at, parts, header = 8, b"", None
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        header = body if kind == b"IHDR" else header
        parts += body if kind == b"IDAT" else b""
        at += 12 + length
    width, height, depth, colour = struct.unpack(">IIBB", header[:10])
    channels = {0: 1, 2: 3, 6: 4}[colour]
    check(depth == 8, f"{name}: {depth} bits")
    raw, stride, rows, above = zlib.decompress(parts), width * channels, [], bytes(width * channels)
    for y in range(height):
        way, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride):
            left, corner = (line[x - channels], above[x - channels]) if x >= channels else (0, 0)
            guess = left + above[x] - corner
            nearest = min((left, above[x], corner), key=lambda v: abs(guess - v))
            line[x] = (line[x] + (0, left, above[x], (left + above[x]) // 2, nearest)[way]) & 255
        rows.append([tuple(line[x:x + channels]) for x in range(0, stride, channels)])
        above = bytes(line)
    return width, height, rows


def check_previews(bench, bakers):
    """Rules for all bakers' previews: 8-bit images in a folder, equal bytes every time, named in the report. They do not change the map."""
    for what, (words, names) in bakers.items():
        output = bench.folder / words[-1]
        made = output / "environment.bnenv" if what == "environment" else output
        bench.run("bake", what, *words, "-q").expect(0)
        alone = made.read_bytes()
        said = bench.run("bake", what, *words, "--preview", f"seen/{what}").expect(0)
        first = {path.name: path.read_bytes() for path in (bench.folder / "seen" / what).iterdir()}
        check({f"{name}.png" for name in names} <= set(first), f"{what}: {sorted(first)}")
        check(all(f"seen/{what}/{name}" in said.err for name in first), said.describe())
        check(made.read_bytes() == alone, f"{what}: another file with a preview")
        bench.run("bake", what, *words, "-q", "--preview", f"seen/{what}").expect(0)
        check({path.name: path.read_bytes() for path in (bench.folder / "seen" / what).iterdir()} == first, f"{what}: other pictures the second time")
        scratch(bench, "file", b"")
        bench.run("bake", what, *words, "-q", "--preview", "file").expect(7).expect_one_line("file")


def grooves(turns):
    """Heights with grooves along a direction, `turns` = (repetitions along u, along v) of the first wave; the others are multiples."""
    chance = random.Random(4)
    waves = [(k * turns[0], k * turns[1], 2 * math.pi * chance.random()) for k in range(1, 13)]
    return lambda x, y: 0.5 + 0.03 * sum(math.cos(2 * math.pi * (i * x + j * y) / 96 + phase) for i, j, phase in waves)


def grey(width, height, value):
    rows = [struct.pack(f"<{width}f", *(value(x, y) for x in range(width))) for y in reversed(range(height))]
    return f"Pf\n{width} {height}\n-1.0\n".encode() + b"".join(rows)


@case("bake.lobe_finds_the_direction_of_grooves")
def lobe(bench):
    """The highlight is wide across grooves; a row of the picture lies below the one before, and the bitangent points up."""
    for name, turns, angle in (("across", (1, 0), 0), ("up", (0, 1), 90), ("rising", (1, -1), 45), ("falling", (1, 1), 135)):
        scratch(bench, f"{name}.pfm", grey(96, 96, grooves(turns)))
        done = bench.run("bake", "lobe", f"{name}.pfm", "--height-scale", "0.02", "--brdf", "beckmann", "-o", name, "--preview", "seen").expect(0)
        found = re.search(r"1x1 of beckmann; the median: widths ([\d.e-]+) and ([\d.e-]+) at (\d+) degrees, ([\d.]+) from its slopes", done.err)
        check(found and abs((int(found[3]) - angle + 90) % 180 - 90) <= 1 and float(found[1]) > 2 * float(found[2]), f"{name}: {done.describe()}")
        check({path.name for path in (bench.folder / name).iterdir()} == {"roughness.exr", "rotation.exr", "normal.exr"}, "other files")
    # Maps of several lobes; threads change nothing
    for threads in ("1", "3"):
        bench.run("bake", "lobe", "rising.pfm", "--size", "6x4", "-o", f"t{threads}", "-t", threads, "-q").expect(0)
    check(all((bench.folder / "t1" / f).read_bytes() == (bench.folder / "t3" / f).read_bytes() for f in ("roughness.exr", "rotation.exr", "normal.exr")), "threads")
    maps = [word for option in ("roughness", "rotation", "normal") for word in (f"--{option}-map", f"across/{option}.exr")]
    seen = {w: bench.figures("builtin:sphere", "--size", "32x24", "--msaa", "1", "--env-size", "16", "--env-samples", "16", *w)["pixel_hash"] for w in ((), tuple(maps))}
    check(len(set(seen.values())) == 2, "the maps change nothing")
    scratch(bench, "flat.pfm", grey(32, 32, lambda x, y: 0.5))
    bench.run("bake", "lobe", "flat.pfm", "-o", "flat", "-q").expect(0)
    scratch(bench, "woven.pfm", grey(96, 96, lambda x, y: 0.5 + 0.2 * (math.cos(math.pi * x / 4) if (x // 8 + y // 8) % 2 else math.cos(math.pi * y / 4))))
    check("no single lobe" in bench.run("bake", "lobe", "woven.pfm", "-o", "woven").expect(0).err, "a weave has a lobe")
    for words, needle in ((("flat.pfm", "--size", "3x1", "-o", "x"), "--size"), (("flat.pfm", "-o", "x", "--brdf", "ward"), "ggx_aniso or beckmann"),
                          (("flat.pfm",), "-o"), (("-o", "x"), "PICTURE"), (("flat.pfm", "-o", "x", "--pieces"), "pieces"), (("flat.pfm", "-o", "x", "--height-scale", "nan"), "--height-scale")):
        bench.run("bake", "lobe", *words).expect(2).expect_one_line(needle)
    scratch(bench, "small.pfm", grey(8, 8, lambda x, y: 0.5))
    bench.run("bake", "lobe", "small.pfm", "-o", "x").expect(4).expect_one_line("small.pfm", "16x16")
    bench.run("bake", "lobe", "none.pfm", "-o", "x").expect(4).expect_one_line("none.pfm")
    check(not (bench.folder / "x").exists(), "a folder was left")


# A preview never overwrites inputs or outputs.
@case("bake.previews_of_every_baker_show_what_was_made", "input", tier="nightly")
def previews(bench):
    scratch(bench, "normal.png", png(8, 8, lambda x, y: (128 + 12 * x, 128 - 9 * y, 220)))
    scratch(bench, "heights.png", png(8, 8, lambda x, y: (30 * x, 30 * x, 30 * x)))
    exponents = ("--nu", "9", "--nv", "70")
    bakers = {"quaternion": (("normal.png", "-o", "q.png"), {"normals"}), "direction": (("normal.png", "-o", "d.png"), {"grain"}),
              "tpr": (("--expr", "cos(pi*v)", "sin(pi*v)", "--size", "8x8", "-o", "t.exr"), {"grain"}),
              "half-vectors": ((*exponents, "--size", "16x16", "-o", "h.exr"), {"half_vectors", "density"}),
              "brdf-lut": ((*exponents, "--size", "4x4", "-o", "a.exr"), {"albedo"}),
              "environment": (("builtin:sky", "--env-size", "16", "--env-samples", "4", "-o", "e"), {"radiance_00", "radiance_03", "irradiance", "whole"}),
              "displaced": (("builtin:sphere", "heights.png", "--triangles", "1", "-o", "s.glb"), {"heights", "normals"}),
              "mip": (("builtin:bumps", "--mip-filter", "leadr", "-o", "b.mip"), {"vinyl_lobe_01"})}
    check_previews(bench, bakers)
    # contents: a rotation by angle pi v gives a hue that goes once around; normals equal the map's; heights rise to the right
    width, height, rows = shown(bench, "seen/tpr/grain.png")
    check((width, height) == (256, 256) and all(max(pixel) == 255 and min(pixel) == 0 for row in rows for pixel in row), "hues are not pure")
    reddest = [row[0][0] - max(row[0][1:]) for row in rows]
    check(reddest[0] > 50 and reddest[-1] > 50 and max(reddest[64:192]) < 0, "the hue does not go around")
    check(rows[80][0][1] == 255 and rows[176][0][2] == 255, "hues go the other way around")
    _, _, rows = shown(bench, "seen/quaternion/normals.png")
    check(rows[0][0][0] < rows[0][255][0] and rows[0][0][1] > rows[255][0][1], "normals of the map, turned")
    _, _, rows = shown(bench, "seen/displaced/normals.png")
    check(rows[128][128] == (122, 128, 255), f"{rows[128][128]}: no slope of 30 / 255 a texel of 8, .05 deep, to the right")
    _, _, rows = shown(bench, "seen/environment/irradiance.png")
    check(sum(rows[20][256]) > sum(rows[235][256]) + 30, "the sky is not above")
    # never over inputs or outputs
    scratch(bench, "seen/in/normals.png", png(8, 8, lambda x, y: (128, 128, 255)))
    before = (bench.folder / "seen/in/normals.png").read_bytes()
    bench.run("bake", "quaternion", "seen/in/normals.png", "-o", "no.png", "--preview", "seen/in").expect(2).expect_one_line("--preview")
    bench.run("bake", "quaternion", "normal.png", "-o", "seen/in/normals.png", "--preview", "seen/../seen/in").expect(2).expect_one_line("--preview")
    check((bench.folder / "seen/in/normals.png").read_bytes() == before and not (bench.folder / "no.png").exists(), "written in spite of it")
