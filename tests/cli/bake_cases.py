"""burnish bake: tables that shading reads."""

import hashlib
import json
import pathlib
import signal
import struct
import subprocess
import time
import xml.dom.minidom
import zlib

from compare_cases import png
from harness import case, check, scratch

SMALL = ("bake", "ltc", "--resolution", "3", "--steps", "2", "--samples", "2")
SHIPPED = pathlib.Path(__file__).resolve().parents[2] / "shading/bake/ltc/ggx.ltc"


@case("bake.threads_make_no_difference", tier="nightly")
def threads(bench):
    for n in ("1", "2", "3"):
        bench.run(*SMALL, "--threads", n, "-o", f"t{n}.ltc", "-q").expect(0)
    hashes = {hashlib.sha256((bench.folder / f"t{n}.ltc").read_bytes()).hexdigest() for n in (1, 2, 3)}
    check(len(hashes) == 1, "tables by 1, 2 and 3 threads differ")
    check(bench.left_behind() == ["t1.ltc", "t2.ltc", "t3.ltc"], f"left {bench.left_behind()}")


@case("bake.killed_goes_on_to_the_same_bytes", tier="nightly")
def killed(bench):
    words = ("bake", "ltc", "--resolution", "4", "--steps", "6", "--samples", "4")
    bench.run(*words, "-o", "straight.ltc", "-q").expect(0)
    part = bench.folder / "t.ltc.part"
    for sent, code in ((signal.SIGKILL, -signal.SIGKILL), (signal.SIGTERM, 128 + signal.SIGTERM)):
        child = subprocess.Popen([bench.program, *words, "-o", "t.ltc", "-q"], cwd=bench.folder, env=bench.environment({}))
        before = part.read_bytes() if part.exists() else None
        while child.poll() is None and (not part.exists() or part.read_bytes() == before):
            time.sleep(0.005)
        child.send_signal(sent)
        check(child.wait() in (code, 0), f"it ended with {child.returncode}")
    check((bench.folder / "t.ltc").exists() or part.exists(), "nothing was kept")
    bench.run(*words, "-o", "t.ltc", "-q").expect(0)
    check((bench.folder / "t.ltc").read_bytes() == (bench.folder / "straight.ltc").read_bytes(), "the table after kills is another one")
    check(bench.left_behind() == ["straight.ltc", "t.ltc"], f"left {bench.left_behind()}")


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


@case("bake.a_report_that_cannot_be_written_is_told_at_once")
def report_path(bench):
    scratch(bench, "file", b"x")
    for folder in ("file", "file/in", "x" * 300):
        done = bench.run("bake", "ltc", "--resolution", "16", "--steps", "100", "-o", "t.ltc", "--report", folder, timeout=20)
        check(done.code == 7, done.describe())


@case("bake.a_report_holds_figures_and_a_drawing", tier="nightly")
def report(bench):
    said = bench.run("bake", "ltc", "--table", SHIPPED, "--report", "quality", timeout=600).expect(0)
    check("det <= 0" in said.out and "theta > 70" in said.out, said.describe())
    found = json.loads((bench.folder / "quality/quality.json").read_text())
    check(found["table"]["size"] == 8 and found["lookups"]["broken"] == 0, f"{found['table']}, {found['lookups']}")
    parts = {part["lobes"]: part for part in found["parts"]}
    for name, most in (("all", 0.132), ("others", 0.142)):
        check(parts[name]["l1"]["mean"] <= most, f"mean L1 of {name}: {parts[name]['l1']}")
        check(parts[name]["best_l1"]["mean"] <= parts[name]["l1"]["mean"], "a table beats what fits each lobe alone")
    check(parts["all"]["light_relative"]["mean"] <= 0.069 and parts["all"]["light_absolute"]["mean"] <= 0.0067, f"{parts['all']}")
    check(len(found["l1_of_cells"]) == 7 * 7 * 10 * 7, "a cell is missing")
    for name in ("quality", "resolutions"):
        xml.dom.minidom.parse(str(bench.folder / f"quality/{name}.svg"))
    published = {part["lobes"]: part["published"] for part in found["parts"] if "published" in part}
    check(len(published) == 5 and "published" in said.out, f"published figures of {sorted(published)}")
    for name, part in published.items():
        check(parts[name]["l1"]["mean"] < part["l1"]["mean"], f"{name}: the published table is nearer")
    l1 = {row["table"]: row["l1"]["mean"] for row in found["resolutions"]["rows"]}
    check(list(l1) == ["this table", "8 nodes", "12 nodes", "16 nodes", "64 nodes", "exact"], f"{list(l1)}")
    check(l1["16 nodes"] < l1["12 nodes"] < l1["8 nodes"] < 1.1 * l1["exact"] and abs(l1["64 nodes"] - l1["exact"]) < 1e-3, f"{l1}")
    check(l1["exact"] < l1["this table"] < l1["8 nodes"], f"{l1}")
    by = {row["lobes"]: row for row in found["sampling"]}
    grazing, area = by["theta > 70"]["even_light"], by["all"]["deviation"]
    check(grazing["cosine"]["mean"] > 1.5 * grazing["visible_normals"]["mean"], f"{grazing}")
    check(area["area"]["mean"] > area["visible_normals"]["mean"] > 0.5, f"{area}")


# Bake options, and the fields that the table's report must have.
OTHERS = (("inverse", ("--interpolate", "inverse"), {"held": "inverse", "alpha_nodes": "even", "most_alpha": 1.0}),
          ("matrix", ("--interpolate", "matrix"), {"held": "matrix", "basis": "tangent"}),
          ("l3", ("--fit", "l3", "--no-symmetry"), {"fit": "l3", "symmetric": False, "aligned": True, "held": "over alpha"}),
          ("sw", ("--fit", "sw", "--no-align"), {"fit": "sw", "aligned": False}),
          ("beckmann", ("--brdf", "beckmann", "--steps", "1"), {"brdf": "beckmann", "fit": "l1"}),
          ("own", (), {"brdf": "ggx_aniso", "fit": "l1", "aligned": True, "symmetric": True, "basis": "mirror", "held": "over alpha"}))


def check_others(bench, tables):
    for name, options, found in tables:
        bench.run("bake", "ltc", "--resolution", "3", "-q", *options, "-o", f"{name}.ltc", timeout=600).expect(0)
        bench.run("bake", "ltc", "--table", f"{name}.ltc", "--report", name, "-q", timeout=600).expect(0)
        table = json.loads((bench.folder / name / "quality.json").read_text())["table"]
        check({key: table[key] for key in found} == found, f"{name}: {table}")
        if "--interpolate" in options:
            size = (bench.folder / f"{name}.ltc").stat().st_size
            check(size == 32 + 81 * 44 + 8, f"{name}: {size} bytes")


@case("bake.a_table_as_others_make_it_says_so", tier="nightly")
def one_other(bench):
    check_others(bench, OTHERS[:1])


@case("bake.tables_as_others_make_them_say_so", tier="nightly")
def others(bench):
    check_others(bench, OTHERS[1:])


@case("bake.the_shipped_table_is_what_the_command_makes", tier="nightly")
def shipped(bench):
    for table, options in (("ggx.ltc", ()), ("ggx_round.ltc", ("--isotropic", "--half"))):
        bench.run("bake", "ltc", *options, "-o", table, "-q", timeout=3600).expect(0)
        check((bench.folder / table).read_bytes() == (SHIPPED.parent / table).read_bytes(), f"the shipped {table} is another one")


@case("bake.what_is_wrong_says_one_line", "input")
def wrong(bench):
    data = SHIPPED.read_bytes()
    files = {"magic.ltc": b"x" + data[1:], "short.ltc": data[:-100], "damaged.ltc": data[:5000] + b"\1\2\3\4" + data[5004:], "empty.ltc": b""}
    for name, text in files.items():
        (bench.folder / name).write_bytes(text)
    (bench.folder / "t.ltc.part").write_bytes(b"no checkpoint")
    for words, code, needle in (
            (("--table", "magic.ltc"), 4, "not a table"), (("--table", "short.ltc"), 4, "bytes, which must be"),
            (("--table", "damaged.ltc"), 4, "damaged"), (("--table", "empty.ltc"), 4, "empty.ltc"), (("--table", "none.ltc"), 4, "none.ltc"),
            (("--table", SHIPPED, "--resolution", "12"), 4, "12 are asked for"), (("-o", "t.ltc"), 4, "t.ltc.part"), ((), 2, "-o"),
            (("-o", "u.ltc", "--table", SHIPPED), 2, "-o"), (("--table", SHIPPED, "--steps", "3"), 2, "--steps"),
            (("-o", "u.ltc", "--resolution", "17"), 2, "--isotropic"), (("-o", "u.ltc", "--isotropic", "--steps", "3"), 2, "--steps"),
            (("--table", SHIPPED, "--isotropic"), 2, "--isotropic"), (("-o", "u.ltc", "--fit", "l3", "--steps", "2"), 2, "--steps"),
            (("-o", "u.ltc", "--fit", "l2"), 2, "--fit"), (("-o", "u.ltc", "--brdf", "phong"), 2, "phong"),
            (("-o", "u.ltc", "--brdf", "ellipsoid"), 2, "can be fitted"), (("--table", SHIPPED, "--brdf", "ward"), 2, "is made already"), (("-o", "u.ltc", "--lobes", "2"), 2, "--lobes"), (("-o", "u.ltc", "--lobes", "3"), 2, "--lobes"), (("-o", "u.ltc", "--isotropic", "--no-align"), 2, "--no-align"),
            (("--table", SHIPPED, "--interpolate", "inverse"), 2, "--interpolate"), (("-o", "no/t.ltc"), 7, "no/t.ltc"), (("-o", "-"), 2, "-o"), (("-o", "u.ltc", "--resolution", "2"), 2, "--resolution")):
        bench.run("bake", "ltc", *words).expect(code).expect_one_line(needle)
    bench.run("bake", "lct", "-o", "u.ltc").expect(2).expect_one_line("lct")
    check(bench.left_behind() == sorted([*files, "t.ltc.part"]), f"left {bench.left_behind()}")


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


# Rules for all bakers' previews: 8-bit images in a folder, equal bytes every time, named in the report. A preview never overwrites inputs
# or outputs, and does not change the map.
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
              "ltc": (("--resolution", "3", "--steps", "0", "-o", "t.ltc"), {"m00", "m22", "nD", "fD"}),
              "mip": (("builtin:bumps", "--mip-filter", "leadr", "-o", "b.mip"), {"vinyl_lobe_01"})}
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
