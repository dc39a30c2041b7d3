"""burnish chart: measurements, outputs, stops and restarts, and the expected errors of techniques."""

import csv
import json
import os
import re
import signal
import subprocess
import sys
import time
import xml.dom.minidom

from animation_cases import turning
from harness import Skipped, case, check, scratch

TINY = ("--size", "64x36", "--msaa", "4", "--env-size", "64", "--env-samples", "32", "--reference-samples", "64", "--runs", "2")
FEW = (*TINY, "--techniques", "bent_normal,major_axis", "--sweep", "samples=1,4")
REFERENCE = ("--backend", "reference", "--samples", "64", "--reference-textures", "full")  # as charts render the reference
FIELDS = {"scene", "env", "technique", "settings", "ms_median", "ms_p95", "flip_mean", "flip_p99", "rel_mse", "max_abs", "pattern_rms", "quad_ratio_x", "quad_ratio_y", "nan_pixels", "pareto"}


def needs_embree(bench):
    if "reference" not in bench.run("info").expect(0).out:
        raise Skipped("built without Embree")


def rows_of(bench, folder):
    report = json.loads((bench.folder / folder / "report.json").read_text())
    return report["rows"]


def errors_of(rows):
    return [(row["technique"], row["settings"]["samples"], row["flip_mean"], row["rel_mse"]) for row in rows]


@case("chart.a_busy_machine_is_said", tier="nightly")
def busy(bench):
    needs_embree(bench)
    words = ("chart", "builtin:plate", *TINY, "--size", "640x360", "--error-size", "64x36", "--runs", "20", "--techniques", "mc", "--sweep", "samples=16",
             "-t", "1", "-o", "r")
    others = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(max(1, os.cpu_count() or 1))]
    try:
        done = bench.run(*words).expect(0)
    finally:
        for other in others:
            other.kill()
            other.wait()
    load = json.loads((bench.folder / "r/report.json").read_text())["machine"]["other_load"]
    check(load is not None and 0.2 < load <= 1, f"others took {load} of the machine")
    check(done.err.count("other programs took") == 1, done.describe())
    check("Other programs took" in (bench.folder / "r/report.html").read_text(), "the page does not say that the machine was busy")


@case("chart.of_budgets_has_planned_rows", budget=20)
def budgets(bench):
    """A plan's row stands beside rows of techniques, and the page says which setting is the fastest within each error. Each plan draws
    trial pictures."""
    needs_embree(bench)
    words = ("chart", "builtin:teapot", "--size", "320x180", "--error-size", "128x72", "--msaa", "2", "--env-size", "64", "--env-samples", "32", "--reference-samples", "64",
             "--techniques", "bent_normal,mc", "--sweep", "samples=16")
    done = bench.run(*words, "--runs", "1", "--budget", "0.2,0.08,1e-4", "-o", "r").expect(0)
    check("budget 0.0001 has no row" in done.err, done.describe())
    rows = rows_of(bench, "r")
    fastest = min((row for row in rows if row["flip_mean"] <= 0.2), key=lambda row: row["ms_median"])
    name = f"planned, budget {fastest['settings']['budget']:g}" if fastest["technique"] == "planned" else fastest["technique"]
    check(re.search(rf"wanted +error 0.2: {name}(, \d+ samples)?, [\d.e+]+ ms, FLIP", done.err), f"{name} is not named\n{done.describe()}")
    check([(row["technique"], row["settings"]["budget"]) for row in rows] == [("bent_normal", None), ("mc", None), ("planned", 0.2), ("planned", 0.08)], rows)
    check(0 < rows[3]["flip_mean"] < rows[2]["flip_mean"] <= 0.2, rows)
    page = (bench.folder / "r/report.html").read_text()
    check("The fastest setting of this chart within a mean error" in page and "error 0.0001: none of these settings" in page and "budget 0.08" in page, "the page")
    # Rows come from the checkpoint, and another plan is another row
    again = bench.run(*words, "--runs", "1", "--budget", "0.2,0.08", "-o", "r").expect(0)
    check([row["flip_mean"] for row in rows_of(bench, "r")] == [row["flip_mean"] for row in rows] and "reference " not in again.err, again.describe())
    for more, needle in ((("--budget", "0"), "no technique is exact"), (("--budget", "2"), "--budget"), (("--budget", "0.1,x"), "--budget"),
                         (("--budget", "0.1", "--metric", "flip"), "--metric flip"), (("--budget", "0.1", "--pieces"), "pieces"),
                         (("--budget", "0.1", "--brdf", "beckmann"), "--brdf"), (("--budget", "0.1", "--sweep", "brdf=beckmann,ggx_aniso"), "--brdf")):
        bench.run(*words, *more, "-o", "n").expect(2).expect_one_line(needle)


@case("chart.rows_and_files_hold_every_setting", "input", tier="nightly")
def rows(bench):
    needs_embree(bench)
    done = bench.run("chart", "builtin:spheres", "--env", "builtin:studio", "--env", "builtin:sky", *FEW, "--sweep", "roughness=0.2,0.4", "-o", "r").expect(0)
    check("report.html" in done.err and done.out == "", done.describe())
    lines = [line for line in done.err.splitlines() if str(bench.folder) not in line and "warning" not in line]
    check(max(map(len, lines)) <= 100 and "12 rows: 3 settings of 2 techniques at 4 places, 2 runs each" in done.err, done.describe())
    table = list(csv.DictReader((bench.folder / "r/report.csv").open(newline="")))
    check(len(table) == 12 and {"technique", "settings.samples", "settings.axis_k", "ms_median", "flip_mean"} <= set(table[0]), f"{table[0]}")
    report = json.loads((bench.folder / "r/report.json").read_text())
    found = report["rows"]
    check(len(found) == 2 * 2 * 3 and set(report["machine"]) >= {"processor", "isa", "threads", "version"}, f"{report}")
    for row in found:
        check(FIELDS <= set(row), f"{row}")
        check(0 < row["ms_median"] <= row["ms_p95"] and row["cpu_ms_median"] >= 0, f"{row}")
        check(0 < row["flip_mean"] < row["flip_p99"] <= 1 and row["rel_mse"] > 0 and row["max_abs"] > 0 and row["nan_pixels"] == 0, f"{row}")
        check(row["settings"]["samples"] in ((None,) if row["technique"] == "bent_normal" else (1, 4)), f"{row}")
        check(row["settings"]["width"] == 64 and row["settings"]["msaa"] == 4, f"{row}")
    places = {}
    for row in found:
        places.setdefault((row["env"], row["settings"]["roughness"]), []).append(row)
    check(len(places) == 4, f"{places.keys()}")
    for members in places.values():
        for row in members:
            beaten = any(other["ms_median"] <= row["ms_median"] and other["flip_mean"] <= row["flip_mean"] and other is not row for other in members)
            check(row["pareto"] == (not beaten), f"{row['technique']}: {members}")
    names = os.listdir(bench.folder / "r")
    check({"report.html", "report.json", "rows.json", "pictures", "time-flip-1.svg", "samples-flip-4.svg", "heat-major_axis-2.svg",
           "heat-major_axis-difference-1.svg"} <= set(names), f"{names}")
    for name in names:
        if name.endswith(".svg"):
            xml.dom.minidom.parse(str(bench.folder / "r" / name))
    # Two things that render says too: the same errors come of the same pictures.
    bench.run("render", "builtin:spheres", *TINY[:8], "--floor", "off", "--roughness", "0.2", "--technique", "bent_normal", "-o", "t.exr", "-q").expect(0)
    bench.run("render", "builtin:spheres", *TINY[:8], "--floor", "off", "--roughness", "0.2", "--backend", "reference", "--samples", "64", "-o", "ref.exr", "-q").expect(0)
    other = json.loads(bench.run("compare", "ref.exr", "t.exr", "--json", "-", "-q").expect(0).out)
    mine = next(row for row in found if row["technique"] == "bent_normal" and row["env"] == "builtin:studio")
    for name in ("flip_mean", "flip_p99", "rel_mse", "max_abs"):
        check(abs(mine[name] - other[name]) < 1e-6 * max(1, abs(other[name])), f"{name}: {mine[name]} and by compare {other[name]}")


@case("chart.patterns_are_what_compare_says_of_them", tier="nightly")
def chart_patterns(bench):
    needs_embree(bench)
    words = ("builtin:sphere", "--env", "builtin:studio", "--size", "120x90", "--msaa", "4", "--env-size", "64", "--env-samples", "32")
    bench.run("chart", *words, "--techniques", "lobe_line", "--sweep", "samples=4,36", "--sweep", "roughness=0.4", "--sweep", "anisotropy=0.8", "--reference-samples", "512", "--runs", "1", "-o", "r").expect(0)
    mine = {row["settings"]["samples"]: row for row in rows_of(bench, "r")}
    words = ("render", *words, "--floor", "off", "--roughness", "0.4", "--anisotropy", "0.8", "--no-background", "-q", "-o")
    bench.run(*words, "ref.exr", "--backend", "reference", "--samples", "512", "--variance", "v.exr").expect(0)
    for samples in (4, 36):
        bench.run(*words, "t.exr", "--technique", "lobe_line", "--samples", samples).expect(0)
        out = bench.run("compare", "ref.exr", "t.exr", "--variance", "v.exr", "--metric", "pattern", "--json", "-", "-q").expect(1).out
        other, row = json.loads(out), mine[samples]
        for name in ("pattern_rms", "quad_ratio_x", "quad_ratio_y"):
            check(abs(row[name] - other[name]) < 0.02 * other[name], f"{samples}, {name}: {row[name]}, by compare {other[name]}")
    check(mine[4]["pattern_rms"] > 1.5 * mine[36]["pattern_rms"], f"{mine}")


@case("chart.flip_of_shown_pictures_is_what_compare_says_of_them", tier="nightly")
def display_flip(bench):
    needs_embree(bench)
    shown = ("--exposure", "-1")
    bench.run("chart", "builtin:plate", "--env", "builtin:studio", *TINY, "--techniques", "bent_normal", "--metric", "flip", *shown, "-o", "r").expect(0)
    report = json.loads((bench.folder / "r/report.json").read_text())
    check(report["metric"] == "flip" and "as they are shown" in (bench.folder / "r/report.html").read_text(), "the report does not say which FLIP")
    same = ("builtin:plate", *TINY[:8], "--floor", "off", *shown)
    bench.run("render", *same, "--technique", "bent_normal", "-o", "t.png", "-q").expect(0)
    bench.run("render", *same, *REFERENCE, "-o", "ref.png", "-q").expect(0)
    other = json.loads(bench.run("compare", "ref.png", "t.png", "--json", "-", "-q").expect(0).out)["flip_mean"]
    check(abs(report["rows"][0]["flip_mean"] - other) < 1e-6, f"{report['rows'][0]['flip_mean']} and by compare {other}")


@case("chart.sweeps_any_option_of_pictures", tier="nightly")
def sweeps_any_option(bench):
    needs_embree(bench)
    words = ("chart", "builtin:plate", "--env", "builtin:studio", *FEW, "--sweep", "axis-k=1,2.5", "--sweep", "env-rotation=0,90", "--sweep", "tilt=0,0:15,0")
    bench.run(*words, "-o", "r").expect(0)
    report = json.loads((bench.folder / "r/report.json").read_text())
    errors = {}
    for row in report["rows"]:
        s = row["settings"]
        errors.setdefault(row["technique"], {})[s["axis_k"], s["env_rotation"], s["tilt"], s["samples"]] = row["flip_mean"]
    check(len(errors["bent_normal"]) == 8 and len(errors["major_axis"]) == 16, f"{errors}")
    for (k, rotation, tilt, samples), flip in errors["bent_normal"].items():
        check(flip == errors["bent_normal"][1, rotation, tilt, samples], "bent_normal has no k, and differs by it")
        check((rotation, tilt) == (0, "0,0") or flip != errors["bent_normal"][k, 0, "0,0", samples], f"{rotation}, {tilt} change nothing")
    check(errors["major_axis"][1, 0, "0,0", 4] != errors["major_axis"][2.5, 0, "0,0", 4], "k changes nothing")
    for name in ("axis-k-flip-1.svg", "env-rotation-flip-1.svg"):
        check((bench.folder / "r" / name).exists(), f"no {name}")
    check(not (bench.folder / "r/tilt-flip-1.svg").exists(), "a chart over vectors")
    # A row's image equals an image by render with equal options.
    same = ("builtin:plate", *TINY[:8], "--floor", "off", "--env-rotation", "90", "--tilt", "15,0")
    bench.run("render", *same, "--technique", "major_axis", "--samples", "4", "--axis-k", "2.5", "-o", "t.exr", "-q").expect(0)
    bench.run("render", *same, *REFERENCE, "-o", "ref.exr", "-q").expect(0)
    other = json.loads(bench.run("compare", "ref.exr", "t.exr", "--json", "-", "-q").expect(0).out)["flip_mean"]
    mine = errors["major_axis"][2.5, 90, "15,0", 4]
    check(abs(mine - other) < 1e-6, f"{mine} and by compare {other}")


@case("chart.sweeps_what_a_scene_is_read_by", tier="nightly")
def sweeps_scenes(bench):
    """Time and materials: each row is the image of its scene, and has its own reference."""
    needs_embree(bench)
    scratch(bench, "turning.gltf", turning())
    seen = ("turning.gltf", "--eye", "0,0,3", "--target", "0,0,0", "--msaa", "4", "--env-size", "64", "--env-samples", "32")
    bench.run("chart", *seen, "--size", "64x36", "--reference-samples", "64", "--runs", "1", "--techniques", "bent_normal", "--sweep", "samples=1",
              "--sweep", "time=0,1", "--sweep", "f0=0.04,0.04,0.04:1,0,0", "-o", "r").expect(0)
    rows = rows_of(bench, "r")
    check(len({(row["flip_mean"], row["rel_mse"]) for row in rows}) == len(rows) == 4, f"rows are alike: {rows}")
    of_last = next(row for row in rows if (row["settings"]["time"], row["settings"]["f0"]) == (1, "1,0,0"))
    same = (*seen, "--size", "64x36", "--time", "1", "--f0", "1,0,0", "-q")
    bench.run("render", *same, "--technique", "bent_normal", "-o", "t.exr").expect(0)
    bench.run("render", *same, *REFERENCE, "-o", "ref.exr").expect(0)
    other = json.loads(bench.run("compare", "ref.exr", "t.exr", "--json", "-", "-q").expect(0).out)["flip_mean"]
    check(abs(of_last["flip_mean"] - other) < 1e-6, f"{of_last['flip_mean']} and by compare {other}")


@case("chart.wrong_options_say_one_line_and_exit_2")
def wrong(bench):
    for words, needle in (
        (("--techniques", "bent_normal,fast"), "fast"),
        (("--techniques", ""), "--techniques"),
        (("--sweep", "samples"), "samples=1,4,16"),
        (("--sweep", "samples=0"), "--sweep"),
        (("--sweep", "hue=1"), "hue"),
        (("--sweep", "axis_k=1"), "did you mean 'axis-k'"),
        (("--sweep", "axis-k=1,x"), "x"),
        (("--sweep", "axis-k=99"), "--axis-k"),
        (("--sweep", "threads=1,2"), "threads"),
        (("--sweep", "technique=mc"), "technique"),
        (("--sweep", "size=8x8"), "size"),
        (("--sweep", "axis-k=1", "--axis-k", "2"), "--axis-k"),
        (("--sweep", "roughness=2"), "--sweep"),
        (("--sweep", "samples=1", "--sweep", "samples=2"), "twice"),
        (tuple(word for name in "abcdef" for word in ("--sweep", name + "=" + ",".join(map(str, range(64))))), "68719476736 places"),
        (("--runs", "-1"), "--runs"),
        (("--reference-samples", "0"), "--reference-samples"),
        (("--size", "0x4"), "--size"),
        (("--error-size", "0x4"), "--error-size"),
        (("--error-size", "480x480"), "480x270"),
        (("--error-size", "480"), "--error-size"),
        (("--msaa", "3"), "--msaa"),
        (("--env", "builtin:moon"), "builtin:moon"),
        (("builtin:cube",), "builtin:cube"),
    ):
        bench.run("chart", *words, "-o", "r").expect(2).expect_one_line(needle)
    bench.run("chart").expect(2).expect_one_line("--output")
    check(bench.left_behind() == [], f"left behind: {bench.left_behind()}")


@case("chart.errors_are_of_the_error_size", tier="nightly")
def error_size(bench):
    """Times are measured at --size, errors at --error-size. Errors equal the errors of a run where both sizes are --error-size."""
    needs_embree(bench)
    small, large = FEW, ("--size", "1024x576", "--error-size", "64x36", *FEW[2:])
    bench.run("chart", *small, "-o", "small").expect(0)
    bench.run("chart", *large, "-o", "large").expect(0)
    check(errors_of(rows_of(bench, "small")) == errors_of(rows_of(bench, "large")), "errors depend on the size that is timed")
    for row, same in zip(rows_of(bench, "large"), rows_of(bench, "small")):
        s = row["settings"]
        check((s["width"], s["height"], s["error_width"], s["error_height"]) == (1024, 576, 64, 36), f"{s}")
        check(row["cpu_ms_median"] > 4 * same["cpu_ms_median"], f"{row['cpu_ms_median']} ms for 256 times the pixels of {same['cpu_ms_median']} ms")
    page = (bench.folder / "large/report.html").read_text()
    check("1024 x 576" in page and "64 x 36" in page, "the page does not say both sizes")
    bench.run("chart", "--size", "1000x700", "--error-size", "0x0", *FEW[2:], "-o", "r").expect(2).expect_one_line("--error-size")


@case("chart.noise_of_the_references_falls_with_their_samples", tier="nightly")
def noise(bench):
    """Every place reports its reference's noise. More samples lower the noise."""
    needs_embree(bench)
    told = []
    for samples in ("64", "256", "4096"):
        bench.run("chart", *TINY[:8], "--reference-samples", samples, "--runs", "1", "--techniques", "bent_normal", "--sweep", "roughness=0.2,0.4",
                  "-o", "r" + samples, "--no-cache").expect(0)
        references = json.loads((bench.folder / ("r" + samples) / "report.json").read_text())["references"]
        check([round(reference["roughness"], 3) for reference in references] == [0.2, 0.4], f"{references}")
        check(all(reference["samples"] == int(samples) and reference["scene"] and reference["env"] for reference in references), f"{references}")
        told.append([(reference["relative_error"], reference["flip_noise"]) for reference in references])
    check(told[0] == [(None, None)] * 2, f"of one pass: {told[0]}")
    for few, many in zip(told[1], told[2]):
        check(3 < few[0] / many[0] < 8, f"relative errors {few[0]} and {many[0]}: 16 times the samples, a quarter of the error, with Student's t")
        check(1.5 < few[1] / many[1] < 6 and many[1] < 0.05, f"FLIP of the noise {few[1]} and {many[1]}")


@case("chart.bad_input_and_output_say_one_line")
def bad_files(bench):
    needs_embree(bench)
    bench.run("chart", "no.glb", *FEW, "-o", "r").expect(4).expect_one_line("no.glb")
    bench.run("chart", "builtin:spheres", "no.glb", *FEW, "-o", "r").expect(4).expect_one_line("no.glb")
    bench.run("chart", "--env", "no.hdr", *FEW, "-o", "r").expect(4).expect_one_line("no.hdr")
    scratch(bench, "file", "x")
    bench.run("chart", *FEW, "-o", "file").expect(7).expect_one_line("file")
    bench.run("chart", *FEW, "-o", "/proc/no/such").expect(7).expect_one_line("/proc/no/such")


@case("chart.a_finished_one_measures_nothing_again", tier="nightly")
def again(bench):
    needs_embree(bench)
    words = ("chart", *FEW, "-o", "r")
    bench.run(*words).expect(0)
    first = (bench.folder / "r/report.json").read_text()
    bench.run(*words).expect(0)
    check((bench.folder / "r/report.json").read_text() == first, "times were measured again")
    # Another view gives another row; earlier rows stay.
    bench.run("chart", *FEW, "--no-background", "-o", "r").expect(0)
    check(errors_of(rows_of(bench, "r")) != errors_of(json.loads(first)["rows"]), "rows of another picture were taken")
    kept = json.loads((bench.folder / "r/rows.json").read_text())["rows"]
    check(len(kept) == 6, f"{len(kept)} rows kept")
    # Removed images return, with the earlier times.
    for name in os.listdir(bench.folder / "r/pictures"):
        (bench.folder / "r/pictures" / name).unlink()
    bench.run(*words).expect(0)
    check((bench.folder / "r/report.json").read_text() == first, "removed pictures changed the rows")
    # A file with other contents is reported and replaced.
    scratch(bench, "r/rows.json", "a letter")
    done = bench.run(*words).expect(0)
    check("warning" in done.err and "rows.json" in done.err, done.describe())
    check(errors_of(rows_of(bench, "r")) == errors_of(json.loads(first)["rows"]), "errors are not those of before")


def start(bench, *words, env=None):
    return subprocess.Popen([bench.program, "chart", *words], cwd=bench.folder, env={**bench.environment({}), **(env or {})},
                            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)


def wait_until(child, done, what):
    begin = time.monotonic()
    while not done():
        check(child.poll() is None and time.monotonic() - begin < 200, what)
        time.sleep(0.02)


@case("chart.goes_on_after_being_killed", tier="nightly")
def killed(bench):
    """The first runs take minutes on any machine. Each of three charts is interrupted once it has kept some result."""
    needs_embree(bench)
    words = ("--size", "320x180", *TINY[2:-2], "--techniques", "bent_normal,major_axis", "--sweep", "samples=1,16", "-o", "r")
    kept = bench.folder / "r/rows.json"
    rows = lambda: json.loads(kept.read_text())["rows"] if kept.exists() else {}
    runs_kept = lambda: sum(len(row["ms"]) for row in rows().values())
    before = {}
    for number in (signal.SIGKILL, signal.SIGTERM, signal.SIGINT):
        least = runs_kept() + 6
        child = start(bench, *words, "--runs", "10000")
        wait_until(child, lambda: runs_kept() >= least, "nothing was kept while it ran")
        child.send_signal(number)
        _, said = child.communicate(timeout=60)
        check(child.returncode == (-number if number == signal.SIGKILL else 128 + number), f"exit code {child.returncode}: {said!r}")
        check(number == signal.SIGKILL or b"stopped" in said, f"{said!r}")
        check(not any((bench.folder / "r" / name).exists() for name in ("report.json", "report.html")), "a report of half a chart")
        for key, row in before.items():
            check(rows()[key]["ms"][:len(row["ms"])] == row["ms"], "what was kept was measured again")
        before = rows()
    runs = max(len(row["ms"]) for row in before.values()) + 2
    bench.run("chart", *words, "--runs", str(runs)).expect(0)
    after = rows()
    for key, row in before.items():
        check(after[key]["ms"][:len(row["ms"])] == row["ms"] and after[key]["flip_mean"] == row["flip_mean"], "what was kept was measured again")
    check(all(len(row["ms"]) == runs for row in after.values()) and len(rows_of(bench, "r")) == 3, "runs are missing")


@case("chart.nothing_stale_is_left", tier="nightly")
def stale(bench):
    """The folder holds the last report. Earlier charts and images are removed; a reader's files and earlier times stay."""
    needs_embree(bench)
    bench.run("chart", *FEW, "--sweep", "roughness=0.2,0.4", "-o", "r").expect(0)
    own = ("notes.svg", "time-flip-old.svg", "pictures/me.jpg", "pictures/0123456789abcdef.jpg")
    for name in own:
        scratch(bench, "r/" + name, "mine")
    before = set(os.listdir(bench.folder / "r/pictures"))
    bench.run("chart", *FEW, "-o", "r").expect(0)
    found = {str(path.relative_to(bench.folder / "r")) for path in (bench.folder / "r").rglob("*") if path.is_file()}
    check(found >= set(own), f"{set(own) - found} were removed")
    charts = {f"{name}-1.svg" for name in ("time-flip", "samples-flip", "samples-time")}
    pictures = {name for name in found if name.startswith("pictures/")} - set(own)
    check(found == charts | pictures | set(own) | {"report.html", "report.json", "report.csv", "rows.json"}, f"{found}")
    check(len(pictures) == 2 * 3 + 1 and not {name.split("/")[1] for name in pictures} & before, f"{pictures}")
    check(len(json.loads((bench.folder / "r/rows.json").read_text())["rows"]) == 9, "times of before were dropped")


def cpu_seconds(pid):
    with open(f"/proc/{pid}/stat", encoding="ascii") as file:
        fields = file.read().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def reference_samples(done):
    """Returns (all samples, samples cached before) for a chart's single reference."""
    line = next(line for line in done.err.splitlines() if line.startswith("reference"))
    found = re.search(r": (\d+) samples?(?: \((\d+) cached\))?", line)
    return int(found[1]), int(found[2] or 0)


@case("chart.a_stopped_reference_goes_on", tier="nightly")
def stopped_reference(bench):
    needs_embree(bench)
    cache = bench.folder / "own_cache"
    env = {"XDG_CACHE_HOME": str(cache)}
    words = lambda samples, folder: ("--size", "160x90", *TINY[2:8], "--reference-samples", str(samples), "--runs", "1", "--techniques", "bent_normal", "-o", folder)
    child = start(bench, *words(10**7, "r"), env=env)  # hours
    said = child.stderr.readline()
    while said and not said.startswith(b"chart"):  # the line before the reference begins
        said = child.stderr.readline()
    begin = cpu_seconds(child.pid)
    wait_until(child, lambda: cpu_seconds(child.pid) > begin + 4.0, "the reference does not work")
    child.send_signal(signal.SIGTERM)
    _, said = child.communicate(timeout=60)
    check(child.returncode == 143, f"exit code {child.returncode}: {said!r}")
    parts = [name for name in os.listdir(cache / "burnish") if name.startswith("reference-")]
    check(len(parts) == 1, f"{parts}")
    first = reference_samples(bench.run("chart", *words(64, "r"), env=env).expect(0))
    check(first[1] > 0, f"{first}: nothing was kept")
    # Another folder finds the reference. A damaged reference is rendered again.
    second = reference_samples(bench.run("chart", *words(64, "r2"), env=env).expect(0))
    check(second == (first[0], first[0]), f"{first}, then {second}")
    (cache / "burnish" / parts[0]).write_bytes(b"a letter")
    done = bench.run("chart", *words(128, "r3"), env=env).expect(0)
    check("made anew" in done.err and reference_samples(done) == (128, 0), done.describe())


@case("chart.references_of_before_go_when_the_cache_is_full", tier="nightly")
def cache_limit(bench):
    needs_embree(bench)
    env = {"XDG_CACHE_HOME": str(bench.folder / "own_cache")}
    few = (*TINY[:-2], "--runs", "1", "--techniques", "bent_normal", "-o", "r")
    names = lambda: sorted(set(os.listdir(bench.folder / "own_cache/burnish")) - {"locks"})
    bench.run("chart", *few, "--sweep", "roughness=0.2,0.4", env=env).expect(0)
    check([name.split("-")[0] for name in names()] == ["environment", "reference", "reference"], f"{names()}")
    told = json.loads(bench.run("info", "--json", env=env).expect(0).out)["cache"]
    check(told["folder"] == str(bench.folder / "own_cache/burnish") and told["files"] == 3 and told["limit_bytes"] == 2 << 30, f"{told}")
    check(told["bytes"] == sum((bench.folder / "own_cache/burnish" / name).stat().st_size for name in names()), f"{told}")
    check("3 files" in bench.run("info", env=env).expect(0).out, "info does not tell of the cache")
    before = set(names())
    bench.run("chart", *few, "--sweep", "roughness=0.6", env={**env, "BURNISH_CACHE_BYTES": "1K"}).expect(0)
    check(len(names()) == 1 and names()[0].startswith("reference-") and not set(names()) & before, f"{before}, then {names()}")


STUDIO, WORKSHOP = "builtin:studio", "workshop_1k.hdr"

# Cases (environment, roughness, anisotropy) where the first claim below may fail: major_axis had a larger FLIP than bent_normal.
CLAIM_FAILS = {(STUDIO, 0.5, -0.5), (WORKSHOP, 0.5, -0.5)}


def grid_of(bench, scene, techniques, samples, roughness, anisotropy, *words):
    """Returns FLIP by (environment, roughness, anisotropy), then by technique, under a built-in and a photographed environment."""
    text = lambda values: ",".join(map(str, values))
    bench.run("chart", scene, "--env", STUDIO, "--env", bench.data_file("env/" + WORKSHOP), "--size", "160x90", "--msaa", "4", "--reference-samples", "1024",
              "--runs", "1", "--no-background", "--techniques", text(techniques), "--sweep", f"samples={samples}", "--sweep", f"roughness={text(roughness)}",
              "--sweep", f"anisotropy={text(anisotropy)}", *words, "-o", "grid", timeout=550).expect(0)
    cells = {}
    for row in rows_of(bench, "grid"):
        settings = row["settings"]
        cell = (os.path.basename(row["env"]), round(settings["roughness"], 3), round(settings["anisotropy"], 3))
        cells.setdefault(cell, {})[row["technique"]] = row["flip_mean"]
    return cells


@case("chart.major_axis_is_nearer_than_bent_normal", tier="nightly")
def claims(bench):
    """Cocco, Zanni, Chermain 2024: benefit of 16 samples along the axis, over widths and anisotropies. On average they beat the bent
    normal.
    For roughness to 0.5 and anisotropy from 0.5 they do so in every cell except the cells of CLAIM_FAILS. A cell of that list that holds again
    is printed.
    On rougher surfaces some cells may fail, and there the samples by density beat both."""
    needs_embree(bench)
    cells = grid_of(bench, "builtin:spheres", ("bent_normal", "major_axis", "major_axis_weighted"), 16, (0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 0.9),
                    (-0.9, -0.7, -0.5, 0.0, 0.5, 0.7, 0.9))
    check(len(cells) == 2 * 49, f"{len(cells)} cells")
    faults, lost = [], 0
    for env in (STUDIO, WORKSHOP):
        here = [flip for cell, flip in cells.items() if cell[0] == env]
        mean = {name: round(sum(flip[name] for flip in here) / len(here), 4) for name in here[0]}
        print(f"{env}: mean FLIP over the grid {mean}")
        if not mean["major_axis_weighted"] < mean["major_axis"] < mean["bent_normal"]:
            faults.append(f"{env}: means {mean}")
    for cell, flip in sorted(cells.items()):
        _, r, a = cell
        bent, equal, dense = flip["bent_normal"], flip["major_axis"], flip["major_axis_weighted"]
        told = f"{cell}: bent_normal {bent:.4f}, major_axis {equal:.4f}, major_axis_weighted {dense:.4f}"
        if r <= 0.5 and abs(a) >= 0.5 and not equal < bent and cell not in CLAIM_FAILS:
            faults.append(told)
        if cell in CLAIM_FAILS and equal < bent:
            print(f"{told}: holds again, take it out of CLAIM_FAILS")
        lost += r > 0.5 and equal > bent
        if r > 0.5 and not dense <= min(bent, equal):
            faults.append(told)
    print(f"major_axis is worse than bent_normal in {lost} cells of rough surfaces")
    check(not faults, "\n".join(faults))


@case("chart.equal_samples_are_bounded_by_their_line", tier="nightly")
def bounds(bench):
    """Explains why the first claim fails in some cells. The line is one deviation long, for a lobe without tails, and GGX has tails. The
    lobe without tails was no better with 1024 samples, and a longer line beats the bent normal there too. A cell where the claim holds again
    needs no reason."""
    needs_embree(bench)
    for env, roughness, anisotropy in sorted(CLAIM_FAILS):
        words = ("builtin:spheres", "--env", env if ":" in env else bench.data_file("env/" + env), "--roughness", str(roughness), "--anisotropy",
                 str(anisotropy), "--size", "160x90", "--msaa", "4", "--no-background", "-q")
        bench.run("render", *words, "--backend", "reference", "--samples", "1024", "-o", "ref.exr", timeout=200).expect(0)

        def flip(*technique):
            bench.run("render", *words, "--technique", *technique, "-o", "t.exr", timeout=200).expect(0)
            return json.loads(bench.run("compare", "ref.exr", "t.exr", "--metric", "flip-hdr", "--json", "-", "-q").expect(0).out)["flip_mean"]
        bent, equal, longer = flip("bent_normal"), flip("major_axis"), flip("major_axis", "--axis-k", "2.5")
        no_tails, tails = flip("filtered_is", "--samples", "1024"), flip("filtered_is_ggx", "--samples", "1024")
        told = (f"{env}: bent_normal {bent:.4f}, major_axis {equal:.4f}, with k = 2.5 {longer:.4f}; 1024 samples of a lobe without tails "
                f"{no_tails:.4f}, with them {tails:.4f}")
        print(told)
        check(equal < bent or (longer < bent and tails < 0.5 * max(equal, no_tails)), told)


@case("chart.grazing_views_need_samples_by_density", tier="nightly")
def grazing(bench):
    """Seen at 8 degrees above a plate, equal samples along the axis may be worse than the bent normal from roughness 0.3 on. Below it they
    are not. Samples by density are better than both, or equal to them within 1 %."""
    needs_embree(bench)
    cells = grid_of(bench, "builtin:plate", ("bent_normal", "major_axis", "major_axis_weighted"), 16, (0.2, 0.3, 0.5), (-0.9, -0.5, 0.5, 0.9),
                    "--eye", "0.9,0.06,0.14", "--target", "0,0,0", "--fov", "14")
    faults = []
    for cell, flip in sorted(cells.items()):
        bent, equal, dense = flip["bent_normal"], flip["major_axis"], flip["major_axis_weighted"]
        rough = cell[1] >= 0.3
        if (not rough and equal > bent) or not dense < 1.01 * min(bent, equal):
            faults.append(f"{cell}: bent_normal {bent:.4f}, major_axis {equal:.4f}, major_axis_weighted {dense:.4f}")
    check(not faults, "\n".join(faults))


def check_samples(bench, names, *words):
    """More samples along the axis help up to 8 at least, and do not harm beyond 16 to 32."""
    bench.run("chart", "builtin:spheres", "--size", "240x135", "--msaa", "4", "--reference-samples", "4096", "--runs", "5", "--techniques",
              "major_axis,major_axis_weighted,filtered_is", "--sweep", "samples=1,2,4,8,16,25,32,64", *words, "-o", "r", timeout=550).expect(0)
    places, faults, cpu = {}, [], {}
    for row in rows_of(bench, "r"):
        places.setdefault(row["env"], {})[row["technique"], row["settings"]["samples"]] = row["flip_mean"]
        cpu.setdefault((row["technique"], row["settings"]["samples"]), []).append(row["cpu_ms_median"])
    # Filtered importance sampling with 5 x 5 samples is slower and has the larger error.
    slow, fast = min(cpu["filtered_is", 25]), min(cpu["major_axis", 16])
    print(f"CPU time of a frame: filtered_is 5 x 5 {slow:.1f} ms, major_axis 16 {fast:.1f} ms")
    if not slow > fast:
        faults.append(f"filtered_is takes {slow:.1f} ms, major_axis {fast:.1f} ms")
    for env, flip in places.items():
        for name in names:
            by = [round(flip[name, n], 4) for n in (1, 2, 4, 8, 16, 32, 64)]
            print(env, name, by)
            if not by[0] > by[1] > by[2] > by[3]:
                faults.append(f"{env}, {name}: does not fall from 1 to 8 samples: {by}")
            if not by[6] - by[5] < 0.1 * (by[0] - by[5]):
                faults.append(f"{env}, {name}: rises from 32 samples to 64: {by}")
            if not by[5] - by[4] < 0.15 * (by[0] - by[4]):
                faults.append(f"{env}, {name}: rises from 16 samples to 32: {by}")
        if not flip["filtered_is", 25] > flip["major_axis", 16]:
            faults.append(f"{env}: filtered_is {flip['filtered_is', 25]:.4f}, major_axis {flip['major_axis', 16]:.4f}")
    check(not faults, "\n".join(faults))


@case("chart.error_falls_with_samples", tier="nightly")
def samples(bench):
    needs_embree(bench)
    check_samples(bench, ("major_axis", "major_axis_weighted"), "--env", STUDIO, "--env", "builtin:sky", "--env", bench.data_file("env/" + WORKSHOP))


@case("chart.error_of_long_lobes_falls_with_weighted_samples", tier="nightly")
def samples_of_long_lobes(bench):
    """On long lobes, equal samples on a line of one deviation need not converge to the reference: from 8 on they may approach a line that
    is too short. Samples by density keep the tails, and their error keeps falling."""
    needs_embree(bench)
    bench.run("chart", "builtin:spheres", "--size", "240x135", "--msaa", "4", "--reference-samples", "4096", "--runs", "1", "--techniques",
              "major_axis,major_axis_weighted", "--sweep", "samples=1,2,4,8,16,32,64", "--no-background", "--sweep", "roughness=0.3",
              "--sweep", "anisotropy=0.9", "-o", "r", timeout=500).expect(0)
    flip = {(row["technique"], row["settings"]["samples"]): row["flip_mean"] for row in rows_of(bench, "r")}
    equal, dense = ([round(flip[name, n], 4) for n in (1, 2, 4, 8, 16, 32, 64)] for name in ("major_axis", "major_axis_weighted"))
    print("equal samples", equal, "by density", dense)
    check(equal[0] > equal[1] > equal[2] > equal[3], f"equal samples: {equal}")
    check(all(a > b for a, b in zip(dense[1:], dense[2:])) and dense[6] < 0.5 * max(equal[3], equal[6]), f"by density: {dense}")
