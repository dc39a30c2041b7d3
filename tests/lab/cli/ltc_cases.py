"""burnish bake ltc: tables of transformed cosines, and render's errors about wrong tables."""

import hashlib
import json
import signal
import struct
import subprocess
import time
import xml.dom.minidom

from bake_cases import check_previews
from direction_cases import SMALL as VIEW
from harness import case, check, scratch
from light_cases import DARK, SHIPPED, sealed
from output_cases import same_in_locales

SMALL = ("bake", "ltc", "--resolution", "3", "--steps", "2", "--samples", "2")


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


@case("bake.what_is_wrong_beside_other_bakers_says_one_line", "input")
def wrong_beside_others(bench):
    """Tables and maps refuse each other's inputs and options."""
    for words, needles in ((("direction", "p.png", "--steps", "2", "-o", "d.png"), ("--steps", "ltc")), (("ltc", "p.png", "-o", "t.ltc"), ("PICTURE",)),
                           (("ltc", "--from", "hue", "-o", "t.ltc"), ("--from", "direction")), (("ltc", "--size", "4x4", "-o", "t.exr"), ("--size",)),
                           ((), ("WHAT is required: ltc, direction, quaternion, tpr, displaced, lobe, half-vectors, brdf-lut, environment or mip",))):
        done = bench.run("bake", *words).expect(2).expect_one_line(*needles)
        check(done.out == "" and not bench.left_behind(), f"left {bench.left_behind()}\n{done.describe()}")


@case("bake.previews_of_tables_show_what_was_made", "input", tier="nightly")
def previews(bench):
    check_previews(bench, {"ltc": (("--resolution", "3", "--steps", "0", "-o", "t.ltc"), {"m00", "m22", "nD", "fD"})})


@case("bake.locales_change_no_byte")
def locales(bench):
    same_in_locales(bench, (("bake", "ltc", "--resolution", "3", "--steps", "1", "--samples", "2", "-q", "-o", "t.ltc"),), 1)


@case("lights.tables_that_are_none_say_one_line", "input")
def tables(bench):
    data = SHIPPED.read_bytes()
    check(sealed(data) == data, "the shipped table does not end with its hash")
    at = 32 + 4 * 11 * (((3 * 8 + 2) * 11 + 5) * 8 + 1)  # entry [theta 3][phi 2][alpha 5][lambda 1]
    place, (turned,) = "[theta 3][phi 2][alpha 5][lambda 1]", struct.unpack_from("<f", data, at + 16)
    put = lambda offset, value: sealed(data[:offset] + struct.pack("<f", value) + data[offset + 4:])
    bench.run("bake", "ltc", "--resolution", "4", "--steps", "0", "-o", "four.ltc", "-q").expect(0)
    files = {"magic": (b"x" + data[1:], "not a table"), "short": (data[:-100], "bytes, which must be"), "empty": (b"", "empty.ltc"),
             "nan": (put(at + 20, float("nan")), place), "flat": (put(at + 16, -turned), f"{place}: has no positive determinant"),
             "other": (data[:8] + b"\1\0\0\0" + data[12:], "version 1")}
    for name, (text_of, needle) in files.items():
        (bench.folder / f"{name}.ltc").write_bytes(text_of)
        bench.run("render", "builtin:lights", *VIEW, "--ltc-table", f"{name}.ltc", "-o", "a.png").expect(4).expect_one_line(f"{name}.ltc", needle)
    flags, = struct.unpack_from("<I", data, 16)
    (bench.folder / "ward.ltc").write_bytes(sealed(data[:16] + struct.pack("<I", flags | 3 << 12) + data[20:]))
    of_ward = ("builtin:lights", *DARK, "--ltc-table", "ward.ltc", "--technique", "mc")
    for brdf in ((), ("--brdf", "beckmann")):
        bench.run("render", *of_ward, *brdf, "-o", "a.png").expect(4).expect_one_line("ward.ltc", "of ward lobes")
    bench.run("render", *of_ward, "--brdf", "ward", "-o", "ward.png").expect(0)
    bench.run("render", *VIEW, "--ltc-table", "four.ltc", "-o", "a.png").expect(4).expect_one_line("four.ltc", "has 4 nodes", "tables of 8")
    bench.run("render", *VIEW, "--ltc-table", "none.ltc", "-o", "a.png").expect(4).expect_one_line("none.ltc")
    check("a.png" not in bench.left_behind(), "a picture was written")


@case("lights.tables_of_nodes_fitted_alone_draw_another_picture", tier="nightly")
def nodes(bench):
    bench.run("bake", "ltc", "--resolution", "8", "--steps", "0", "-o", "nodes.ltc", "-q", timeout=600).expect(0)
    for way in ("ltc", "ltc-isotropic"):
        words = ("builtin:lights", *DARK, "--area-lights", way)
        own_hash, other = (bench.figures(*words, *more)["pixel_hash"] for more in ((), ("--ltc-table", "nodes.ltc")))
        check((other == own_hash) == (way == "ltc-isotropic"), f"{way} by a table of nodes fitted alone")
