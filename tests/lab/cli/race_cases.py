"""`race`: the lean shaders draw the kernels' pictures, so that both costs are of the same picture."""
import csv
import json
import re
import shutil

from harness import Skipped, case, check
from parity_cases import ALONE, COARSE, ROOT, TECHNIQUES, compile_listed, never_written_over

# Techniques whose fragments share samples, which no device does. All others stay within 0.005.
SHARE = {"lobe_line": 0.025, "as_mc": 0.075}


@case("race.lean_shaders_draw_the_pictures_of_kernels", budget=12)
def lean(bench):
    """A device of the CPU compiles a shader for each technique."""
    done = bench.run("race", "builtin:spheres", "builtin:lights", "--techniques", "all", "--shaders", "lean", "--devices", "lavapipe", "--msaa", "1",
                     "--size", "128x72", "--runs", "1", "--json", "race.json", timeout=300.0)
    if done.code != 77:
        done.expect(0)
    elif not (bench.folder / "race.json").exists():
        raise Skipped(done.err.strip())
    rows = json.loads((bench.folder / "race.json").read_text())["rows"]
    check(len(rows) == 2 * len(TECHNIQUES), f"{len(rows)} rows")
    left_out = sorted({f"{row['technique']}: {row['error']}" for row in rows if row["error"]})
    check(not left_out, "not drawn:\n" + "\n".join(left_out))
    for row in rows:
        name, most = f"{row['scene']} {row['technique']}", SHARE.get(row["technique"], 0.005)
        check(row["flip_mean"] < most, f"{name}: FLIP {row['flip_mean']}")


@case("race.lean_coats_and_leaves_glass_out", budget=12)
def lean_coats(bench):
    """Coats under a sky; a note counts the materials that no renderer draws. A device of the CPU compiles the shaders."""
    rows = lean_rows(bench, "builtin:lacquer", "builtin:glass", "--size", "64x48", "--techniques", "split_isotropic", "--msaa", "1")
    check_lean(rows, 2)
    notes = json.loads((bench.folder / "race.json").read_text())["notes"]
    check("builtin:glass: 4 of 5 materials let light through or blend; neither renderer draws them" in notes, f"{notes}")
    check(not any("lacquer" in note for note in notes), f"{notes}")


@case("race.rows_hold_picture_and_times", tier="nightly")
def race_rows(bench):
    done = bench.run("race", "--size", "96x64", "--techniques", "split_isotropic", "--msaa", "1", "--runs", "2", "--devices", "lavapipe,abacus", *COARSE,
                     "--json", "race.json", "--csv", "race.csv", "--pictures", "beside", timeout=540.0)
    if done.code == 77:
        raise Skipped(done.err.strip())
    done.expect(0)
    check("split_isotropic" in done.out and "geometric mean" in done.out and "split_isotropic" not in done.err, done.describe())
    figures = [line for line in done.out.splitlines() if not line.startswith("abacus:")]  # this line names every available device
    check(max(map(len, figures)) <= 100, f"lines are longer than 100 columns\n{done.describe()}")
    report = json.loads((bench.folder / "race.json").read_text())
    lines = list(csv.DictReader((bench.folder / "race.csv").open(newline="")))
    check([row["shader"] for row in report["rows"]] == [line["shader"] for line in lines] == ["own", "lean"], f"{lines}")
    for row, line in zip(report["rows"], lines):
        check(line["technique"] == "split_isotropic" and float(line["ratio"]) == row["ratio"], f"{line}")
        check(row["flip_mean"] < 0.01 and row["same_picture"], f"another picture: {row}")
        check(all(row[key] > 0 for key in ("tile_ms", "device_ms", "tile_cpu_ms", "device_cpu_ms")), f"no times: {row}")
        check(abs(row["ratio"] - row["device_cpu_ms"] / row["tile_cpu_ms"]) < 1e-6 * row["ratio"], f"another ratio: {row}")
        check(abs(report["geomean_ratio"][row["shader"]] - row["ratio"]) < 1e-6 * row["ratio"], "the mean of one row is that row")
    check(any("abacus" in note for note in report["notes"]), "nothing is said of the device that is absent")
    beside = sorted(path.name for path in (bench.folder / "beside").iterdir())
    check([re.sub("-[^-]*$", "", name) for name in beside] == ["001-builtin_teapot-split_isotropic-1x-own", "002-builtin_teapot-split_isotropic-1x-lean"],
          f"{beside}")
    for name in beside:
        check((bench.folder / "beside" / name).read_bytes()[16:24] == bytes((0, 0, 0, 192, 0, 0, 0, 64)), f"{name} is not twice as wide as a frame")


@case("race.goes_on_after_a_row_that_fails", tier="nightly")
def race_goes_on(bench):
    (bench.folder / "broken.glb").write_text("glTF, not")
    done = bench.run("race", "broken.glb", "builtin:teapot", "--size", "32x24", "--techniques", "split_isotropic", "--msaa", "8,1", "--runs", "1", "--devices",
                     "lavapipe", *COARSE, "--json", "race.json", timeout=540.0)
    if done.code == 77 and not (bench.folder / "race.json").exists():
        raise Skipped(done.err.strip())
    done.expect(4)
    rows = json.loads((bench.folder / "race.json").read_text())["rows"]
    check([bool(row["error"]) for row in rows] == 6 * [True] + 2 * [False], f"{rows}")
    check("ratio" not in rows[5] and rows[6]["ratio"] > 0, f"{rows}")


def lean_rows(bench, *arguments, code=0, timeout=540.0):
    """Returns the rows of a race against the lean shader."""
    done = bench.run("race", *arguments, "--runs", "1", "--shaders", "lean", "--devices", "lavapipe", *COARSE, "--json", "race.json", timeout=timeout)
    if done.code == 77 and not (bench.folder / "race.json").exists():
        raise Skipped(done.err.strip())
    done.expect(code)
    return json.loads((bench.folder / "race.json").read_text())["rows"]


def check_lean(rows, count):
    for row in rows:
        check(not row["error"] and row["same_picture"] and row["flip_mean"] <= 0.01, f"another picture: {row}")
        check((row["silhouettes"] > 0) == (row["msaa"] > 1) and row["silhouettes"] < 0.2, f"silhouettes: {row}")
    check(len(rows) == count, f"{len(rows)} rows")


@case("race.lean_draws_the_same", tier="nightly")
def lean_draws(bench):
    check_lean(lean_rows(bench, "builtin:teapot", "--size", "480x270", "--techniques", "split_isotropic,major_axis_adaptive", "--msaa", "4"), 2)


@case("race.lean_draws_the_same_everywhere", tier="nightly")
def lean_draws_all(bench):
    """Except techniques whose samples the tile renderer shares between pixels. A fragment does not share them."""
    alone = ",".join(ALONE)
    small = lean_rows(bench, "builtin:spheres", "builtin:teapot", "builtin:plate", "--size", "480x270", "--techniques", alone, "--msaa", "1")
    check_lean(small, 3 * len(ALONE))
    # spheres have triangles smaller than pixels there
    check_lean(lean_rows(bench, "builtin:spheres", "builtin:teapot", "builtin:plate", "--size", "1920x1080", "--techniques", alone, "--msaa", "4",
                         timeout=3000.0), 3 * len(ALONE))


# Defects of the lean shader: file, text, replacement, technique that must then draw another image.
LEAN_DEFECTS = (("techniques.glsl", "reflect(-s.v, bent)", "reflect(-s.v, s.n)", "bent_normal"),
                ("techniques.glsl", "min(sqrt(radius), 1.0)", "min(radius, 1.0)", "major_axis_weighted"),
                ("lean.vert", "normal = in_normal;", "normal = vec3(in_normal.xy, 1.0);", "split_isotropic"))


def lean_with(bench, replaced, name):
    """Compiles the lean shader with replacements (file, old text, new text). Returns the folder of its stages."""
    if not shutil.which("glslc"):
        raise Skipped("no glslc here")
    source, shaders = bench.folder / name / "source", bench.folder / name / "shaders"
    shutil.copytree(ROOT / "shading/lab/lean", source / "shading/lab/lean")
    (source / "core/scene").mkdir(parents=True)
    shutil.copy(ROOT / "core/scene/material.def", source / "core/scene")  # counts texture slots
    shaders.mkdir()
    for file, old, new in replaced:
        path = source / "shading/lab/lean" / file
        check(old in path.read_text(), f"{file} does not hold '{old}' any more")
        path.write_text(path.read_text().replace(old, new))
    compile_listed("raster/vulkan/lab/stages.txt", source, "shading/lab", shaders)
    return shaders


def sees_lean_defects(bench, defects):
    for i, (file, old, new, technique) in enumerate(defects):
        row, = lean_rows(bench, "builtin:spheres", "--size", "160x90", "--techniques", technique, "--msaa", "1", "--shader-folder",
                         lean_with(bench, [(file, old, new)], str(i)))
        check(not row["error"] and not row["same_picture"], f"'{new}' in place of '{old}' is not seen: {row}")


@case("race.sees_a_defect_of_lean")
def sees_lean_defect(bench):
    sees_lean_defects(bench, LEAN_DEFECTS[:1])


@case("race.sees_defects_of_lean", tier="nightly")
def sees_all_lean_defects(bench):
    check_lean(lean_rows(bench, "builtin:spheres", "--size", "160x90", "--techniques", "bent_normal", "--msaa", "1", "--shader-folder",
                         lean_with(bench, [], "whole")), 1)
    sees_lean_defects(bench, LEAN_DEFECTS)


@case("race.lean_refuses_what_it_does_not_draw", tier="nightly")
def lean_refuses(bench):
    """Refuses by row and races the other rows. An image that it would draw wrongly is not drawn."""
    row, = lean_rows(bench, "builtin:spheres", "--env", "builtin:sky", "--size", "32x24", "--techniques", "split_isotropic", "--msaa", "1", code=77)
    check("extracted lights" in row["error"] and "ratio" not in row, f"{row}")


@case("race.writes_over_no_model")
def writes_over_no_model(bench):
    never_written_over(bench, ("race", "models/a.gltf"))


@case("race.wrong_options_say_one_line_and_exit_2")
def wrong_options(bench):
    for option, value in (("--devices", "lavapipe,"), ("--msaa", ",1")):
        done = bench.run("race", option, value)
        if done.code == 77:
            raise Skipped(done.err.strip())
        done.expect(2).expect_one_line(option)
