"""Mip filters in the laboratory: nets that it trains, and charts of filters by level."""

import json

from compare_cases import png
from detail_cases import bumps, hash_of
from harness import case, check, scratch
from mip_cases import SMALL, material, named


@case("mip.nets_are_read_and_wrong_ones_are_refused")
def nets(bench):
    material(bench, "set", (33, 17, bumps))
    (bench.folder / "maps/waves").mkdir(parents=True)
    scratch(bench, "maps/waves/a_normal.png", png(64, 64, bumps))
    maps = ("builtin:sphere", *SMALL, "--material", "set")
    words = (*maps, "--mip-filter", "mipnet", "--fallback", "off")
    own = hash_of(bench, *words)
    by = {brdf: hash_of(bench, *words, "--brdf", brdf) for brdf in ("ggx_aniso", "beckmann", "ashikhmin_shirley", "ward")}
    nets = {}
    for brdf in ("ggx_aniso", "beckmann", "ashikhmin_shirley"):
        bench.run("train", "mip", "--brdf", brdf, "--steps", "2", "--only-maps", "maps", "-q", "-o", brdf + ".mipnet").expect(0)
        nets[brdf] = (bench.folder / (brdf + ".mipnet")).read_bytes()
    other = hash_of(bench, *words, "--mip-net", "ggx_aniso.mipnet")
    check(other != own, "weights are not looked at")
    check(hash_of(bench, *words, "--mip-net", "beckmann.mipnet", "--brdf", "beckmann") != by["beckmann"], "of another model neither")
    hash_of(bench, *words, "--mip-net", "beckmann.mipnet", "--brdf", "ward")
    bench.run("bake", "mip", "set", "--mip-filter", "mipnet", "--mip-net", "ggx_aniso.mipnet", "--fallback", "off", "-q", "-o", "a.mip").expect(0)
    check(hash_of(bench, *maps, "--mip-pyramid", "a.mip") == other, "bake mip makes others of them")
    bench.run("render", *words, "--mip-pyramid", "a.mip", "-o", "x.pfm").expect(4).expect_one_line("hash")
    good = nets["ggx_aniso"]

    def altered(at, value):
        return good[:at] + value.to_bytes(4, "little") + good[at + 4:]

    for name, data, needle in (("version", altered(8, 7), "version 7"), ("lobe", altered(12, 9), "lobe 9"), ("width", altered(28, 33), "numbers"),
                               ("units", altered(28, 0), "units"), ("crc", altered(2000, 1), "damaged"), ("short", good[:-1], "bytes"), ("none", b"", "empty")):
        scratch(bench, name, data)
        bench.run("render", *words, "--mip-net", name, "-o", "x.pfm").expect(4).expect_one_line(needle)
        bench.run("bake", "mip", "set", "--mip-filter", "mipnet", "--mip-net", name, "-o", "x.mip").expect(4).expect_one_line(needle)
    bench.run("render", *words, "--mip-net", "beckmann.mipnet", "-o", "x.pfm").expect(4).expect_one_line("beckmann")
    bench.run("render", *words, "--mip-net", "gone", "-o", "x.pfm").expect(4).expect_one_line("gone")
    check("x.mip" not in bench.left_behind() and "x.pfm" not in bench.left_behind(), "what failed has left something")
    done = bench.run("render", *maps, "--mip-filter", "kappa", "--mip-net", "beckmann.mipnet", "--fallback", "off", "-o", "a.pfm").expect(0)
    check(all(f"{option} has no effect with --mip-filter kappa" in done.err for option in ("--mip-net", "--fallback")), done.describe())


@case("mip.charts_of_filters_have_rows_by_level", tier="nightly")
def rows_by_level(bench):
    (bench.folder / "maps").mkdir()
    material(bench, "maps/set", (64, 64, bumps))
    words = ("chart", "--mip", "--maps", "maps", "--per-set", "2", "--brdf", "ggx_aniso")
    done = bench.run(*words, "-o", "one").expect(0)
    rows = json.loads((bench.folder / "one/mip.json").read_text())
    fields = {"set", "family", "material", "brdf", "mip_filter", "level", "hardest", "flip", "l1", "mse", "light", "ms", "gap"}
    check(all(set(row) == fields for row in rows), f"{rows[0]}")
    sets = {row["set"]: {r["material"] for r in rows if r["set"] == row["set"]} for row in rows}
    check({name: len(of) for name, of in sets.items()} == {"new seeds": 2, "held-out": 2, "trained": 2, "real": 1}, f"{sets}")
    names = named(bench)
    check(len(rows) == 7 * len(names) * 5 and {row["mip_filter"] for row in rows} == set(names), f"{len(rows)} rows")
    check(all((row["flip"] is None) == ({"real": 64, "trained": 128}.get(row["set"], 256) >> row["level"] < 16) for row in rows), "FLIP of other levels")
    mean = {name: sum(row["mse"] for row in rows if row["mip_filter"] == name) for name in names}
    check(mean["kappa"] < 0.8 * mean["baseline"] and abs(mean["box"] / mean["baseline"] - 1) < 0.1, f"{mean}")
    l1 = {name: sum(row["l1"] for row in rows if row["mip_filter"] == name) for name in names}
    check(min(l1, key=l1.get) == "teacher" and l1["teacher"] < 0.9 * l1["baseline"], f"{l1}")
    gaps = {name: [row["gap"] for row in rows if row["mip_filter"] == name and row["gap"] is not None] for name in names}
    check(set(gaps["baseline"]) == {0} and set(gaps["teacher"]) == {1}, f"{gaps}")
    check(sum(row["hardest"] for row in rows) == 4 * len(names) * 5, "the hardest quarter is none")
    check(all(name in done.out for name in (*names, "held-out, hardest quarter")) and (bench.folder / "one/mip.txt").read_text() == done.out, done.describe())
    bench.run(*words, "--mip-gain", "on", "-q", "-o", "gains").expect(0)
    gained = json.loads((bench.folder / "gains/mip.json").read_text())
    off, on = ({name: [abs(row["light"] - 1) for row in of if row["mip_filter"] == name] for name in names} for of in (rows, gained))
    print("light off by with gains, mean and most:", {name: (round(sum(by) / len(by), 4), round(max(by), 3)) for name, by in on.items()})
    check(sum(off["mipnet"]) < 0.85 * sum(off["box"]) and on["leadr"] == off["leadr"], f"{off}")
    for name in ("ssgt", "kappa", "mipnet", "teacher"):
        check(sum(on[name]) < 0.03 * len(on[name]) < sum(off[name]) and max(on[name]) < 0.1 < max(off[name]), f"{name} {on[name]} {off[name]}")
    csv = (bench.folder / "one/mip.csv").read_text().splitlines()
    check(len(csv) == len(rows) + 1 and csv[0].split(",")[:3] == ["set", "family", "material"], csv[0])
    bench.run(*words, "--threads", "1", "-q", "-o", "two").expect(0)
    again = json.loads((bench.folder / "two/mip.json").read_text())
    check([{**row, "ms": 0} for row in rows] == [{**row, "ms": 0} for row in again], "threads change figures")
    for arguments, code, needle in (((*words, "--size", "9x9"), 2, "--size"), (("chart", "--maps", "maps"), 2, "--maps"),
                                    (("chart", "--mip", "--brdf", "ward"), 2, "--brdf"), (("chart", "--mip", "--maps", "gone"), 4, "gone")):
        bench.run(*arguments, "-o", "x").expect(code).expect_one_line(needle)


@case("mip.charts_of_crossed_grain_know_two_lobes", tier="nightly")
def crossed(bench):
    words = ("chart", "--mip", "--two-lobes", "--brdf", "ggx_aniso", "-q")
    bench.run(*words, "-o", "one").expect(0)
    rows = json.loads((bench.folder / "one/mip.json").read_text())
    check({row["set"] for row in rows} == {"crossed"} and len({row["material"] for row in rows}) == 4, f"{rows[0]}")
    l1 = {name: sum(row["l1"] for row in rows if row["mip_filter"] == name) for name in ("teacher", "two lobes")}
    check(l1["two lobes"] < 0.75 * l1["teacher"], f"{l1}")
    bench.run("chart", "--two-lobes", "-o", "x").expect(2).expect_one_line("--two-lobes")
