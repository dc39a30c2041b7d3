"""Scripts of bench/lab: their measurements with the program."""

import colorsys
import json
import math
import os
import pathlib
import subprocess
import sys

from brdf_cases import lobes
from compare_cases import png
from harness import Failed, Skipped, case, check, scratch
from reference_cases import needs_embree

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.append(str(ROOT / "bench/lab"))


def measured(bench, script):
    """Runs the short form of a script. Returns its exit code, and the JSON it writes."""
    needs_embree(bench)
    found = bench.folder / "found.json"
    done = subprocess.run([sys.executable, "-B", ROOT / "bench/lab" / script, "--quick", "--program", bench.program, "--json", found],
                          capture_output=True, text=True, env=bench.environment({}), timeout=550, check=False)
    print(done.stdout)
    if done.returncode not in (0, 1):
        raise Failed(done.stderr)
    return done.returncode, json.loads(found.read_text())


@case("extracted_lights.lower_the_error_under_suns", tier="nightly")
def lower_the_error(bench):
    """The small table of bench/lab/key_lights.py: under suns, extracted lights lower the mean error to at most .85 times."""
    code, table = measured(bench, "key_lights.py")
    check(code == 0, "a place is worse with extracted lights than without")
    for env in ("builtin:sky", "low_sun", "two_suns"):
        rows = [row for row in table if env in row["env"]]
        off, on = (sum(row[f"flip_{k}"] for row in rows) for k in ("off", "auto"))
        check(rows and rows[0]["key_lights"] > 0 and on < 0.85 * off, f"{env}: {off} -> {on}")


def made_up_report(flips, cpu=1.0):
    """Returns a report in the format of `burnish chart`, with two places; flips: by technique, a number a place."""
    return {"rows": [{"scene": "s", "env": env, "technique": technique, "flip_mean": flip, "cpu_ms_median": cpu * (samples or 1),
                      "settings": {"samples": samples, "roughness": 0.5, "anisotropy": 0.8}}
                     for technique, found in flips.items()
                     for samples in ((None,) if technique in ("bent_normal", "split_isotropic") else (16, 12))
                     for env, flip in zip(("sun", "none"), found)]}


@case("extracted_lights.table_of_aims_is_counted_by_places")
def table_of_aims(_):
    """Runs bench/lab/aims.py on invented reports."""
    import aims  # noqa: PLC0415
    flips = {"lobe_line": (0.02, 0.05), "major_axis_weighted": (0.1, 0.1), "bent_normal": (0.06, 0.04), "split_isotropic": (0.2, 0.2)}
    on = aims.places_of(made_up_report(flips))
    off = aims.places_of(made_up_report({**flips, "lobe_line": (0.035, 0.045)}))
    cpu = aims.places_of(made_up_report(flips), "cpu_ms_median")
    ratios = aims.ratios_of_time(cpu)
    check(ratios == {16: 1.0, 12: 0.75} and aims.most_within(ratios) == 16, f"{ratios}")
    check(aims.most_within({16: 1.01, 14: 0.9, 12: 0.8}) == 14 and aims.most_within({16: 1.2, 12: 1.1}) == 12, "the most within the time, or the least")
    found = aims.judge(on, off, on["major_axis_weighted:16"], "lobe_line:16", {"sun": 1, "none": 0})
    reached = [(result["reached"], result["met"]) for result in found]
    check(reached == [("0.350", True), ("0.700", False), ("0.700", False), ("50.0 %", False), ("100.0 %", True), ("1", False), ("0.571", False)],
          f"{reached}")


@case("extracted_lights.aims_are_measured_by_one_command", tier="nightly")
def aims_are_measured(bench):
    """Runs the short form, four places, where lobe_line must be the best."""
    code, found = measured(bench, "aims.py")
    check(code == 0, "aims.py fails")
    check(len(found["places"]) == 4 and all(0.0 < place["noise"] < 0.1 for place in found["places"]), f"{found['places']}")
    reached = {result["aim"]: result["reached"] for result in found["aims"]}
    check(float(reached["lobe_line to major_axis_weighted as it was, equal time"]) < 0.9, f"{reached}")
    check(float(reached["lobe_line to bent_normal, both with extracted lights"]) < 0.7, f"{reached}")


@case("timeline.joins_equal_stacks_and_leaves_gaps", tier="quick")
def timeline_of_samples(_):
    """Draws bench/lab/timeline.py's chart of two threads, from samples as perf writes them."""
    import timeline  # noqa: PLC0415
    def sample(thread, ms, *names):
        return f"{thread:>6} {ms / 1000:.6f}: \n" + "".join(f"\t{0x5000 + k:16x} {name}\n" for k, name in enumerate(names))
    inner = "std::vector<int, std::allocator<int> > burnish::(anonymous namespace)::decode_png<3>(int, char const*)"
    text = "\n".join([sample(7, 1, inner, "burnish::run(int)", "main"), sample(7, 2, inner, "burnish::run(int)", "main"),
                      sample(7, 3, "burnish::run(int)", "tbb::detail::task::execute", "main"), sample(7, 9, "burnish::run(int)", "main"),
                      "".join(f"     8 0.00{ms}000: \n\tffffffff81000130 asm_exc_page_fault\n\tffffffffffffffff [unknown]\n\n" for ms in (2, 3))])
    found = {}
    for thread, time, names in timeline.samples_of(text):
        found.setdefault(thread, []).append((time, names))
    boxes = [[(depth, round(1000 * (end - begin)), name) for depth, begin, end, name, _ in timeline.boxes_of(samples, 0.001)] for samples in found.values()]
    check(sorted(boxes[0]) == [(0, 1, "main"), (0, 3, "main"), (1, 1, "run"), (1, 3, "run"), (2, 2, "decode_png")], f"{boxes[0]}")
    check(boxes[1] == [(0, 2, "kernel")], f"{boxes[1]}")
    drawn = timeline.chart([timeline.boxes_of(samples, 0.001) for samples in found.values()], 0.0, 0.01, "a & b")
    check("a &amp; b" in drawn and "decode_png: 2.0 ms" in drawn and drawn.count("thread ") == 2, drawn[:300])


@case("brdf.models_match_their_references_on_one_sheet", tier="nightly")
def models_match_their_references_on_one_sheet(bench):
    needs_embree(bench)
    script = ROOT / "bench/lab/models_sheet.py"
    words = (sys.executable, "-B", script, "--program", bench.program, "-o", "sheet.png", "--side", "32", "--samples", "256",
             "--reference-samples", "128", "--work", "work", "--fail-flip")

    def sheet(limit):
        return subprocess.run([*words, limit], cwd=bench.folder, env=bench.environment({}), capture_output=True, text=True)

    done = sheet("0.12")
    check(done.returncode == 0, f"{done.stdout}{done.stderr}")
    drawn = {line.split()[0] for line in done.stdout.splitlines()}
    check(drawn == set(lobes(bench)) | {"lambert", "ellipsoid_dielectric"}, f"it shows {drawn}")
    check((bench.folder / "sheet.png").read_bytes().startswith(b"\x89PNG"), "no sheet")
    (bench.folder / "work/ward.pfm").write_bytes((bench.folder / "work/heidrich_seidel.pfm").read_bytes())
    check(sheet("0.12").returncode == 1, "another picture than the model's is close to its reference too")


@case("pixels.lines_that_turn_fast_leave_no_dots", budget=3)
def no_dots(bench):
    """If a quad's fragments share too few of their samples, quads show: their error correlates more at two pixels than at one."""
    needs_embree(bench)
    from lobe_line import pattern, read_pfm

    def hue(x, y):
        u, v = x / 128 - 1.5, y / 128 - 1.0
        angle = 0.5 * math.sin(5 * u + 2 * math.sin(4 * v)) + 0.6 * v * v + 0.15 * math.sin(17 * u * v + 9 * v)
        return tuple(int(255 * c) for c in colorsys.hsv_to_rgb(angle % 1.0, 1, 1))

    scratch(bench, "p.png", png(384, 256, hue))
    bench.run("bake", "direction", "p.png", "-o", "d.png").expect(0)
    words = ("builtin:plate", "--direction-map", "d.png", "--roughness", "0.3", "--anisotropy", "0.95", "--size", "300x200", "--msaa", "1",
             "--env-size", "64", "--env-samples", "64", "--no-background", "-q")
    bench.run("render", *words, "--samples", "16", "-o", "16.pfm").expect(0)
    bench.run("render", *words, "--backend", "reference", "--samples", "256", "-o", "r.pfm").expect(0)
    width, height, reference = read_pfm(bench.folder / "r.pfm")
    found = pattern(reference, read_pfm(bench.folder / "16.pfm")[2], width, height)
    print(found)
    check(found["two"] < found["one"], f"dots: {found}")


@case("export.modules_bring_engines_nearer_to_the_reference", tier="nightly")
def nearer(bench):
    engines = os.environ.get("BURNISH_ENGINES", "")
    if not engines:
        raise Skipped("no engines: BURNISH_ENGINES is to name a folder with node_modules that holds three, babylonjs and babylonjs-loaders")
    done = subprocess.run(["python3", "-B", ROOT / "bench/lab/conform.py", "--program", bench.program, "--engines", engines, "--work", bench.folder / "work",
                           "--only", "three,babylon", "--modules", "lobe_line:64", "--json", bench.folder / "rows.json"], capture_output=True, text=True)
    check(done.returncode == 0, done.stderr[-1500:])
    for row in json.loads((bench.folder / "rows.json").read_text()):
        before, after = row["flip_to_truth"]["as_it_is"], row["flip_to_truth"]["module"]
        for scene in ("rotation_0", "rotation_30", "rotation_90", "smooth", "direction_map", "own_tangents", "no_tangents", "mirrored_node", "minified", "coat"):
            check(after[scene] < 0.5 * before[scene], f"{row['engine']}, {scene}: {before[scene]:.3f} before, {after[scene]:.3f} with the module")
        for scene in ("mirror", "round", "lamp"):
            check(abs(after[scene] - before[scene]) < 1e-6, f"{row['engine']}, {scene}: changed")
