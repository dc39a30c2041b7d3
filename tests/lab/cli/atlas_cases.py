"""burnish atlas: failures of methods, and their golden figures."""

import csv
import io
import json
import os
import re
import signal
import subprocess
import time

from browser import Browser
from chart_cases import needs_embree
from chart_page_cases import healthy
from harness import Skipped, case, check, scratch
from wasm_cases import package

FAST = "albedo_by_a_fit" # two images of the tile renderer a step, no reference


@case("atlas.lists_what_breaks", tier="quick")
def lists(bench):
    out = bench.run("atlas", "--list").expect(0).out
    check(FAST in out and "environment:" in out and "burnish render builtin:sphere" in out, out)
    one = bench.run("atlas", FAST, "--list").expect(0).out
    check(FAST in one and len(one.splitlines()) == 4, one)


@case("atlas.refuses_what_is_no_entry", tier="quick")
def mistakes(bench):
    bench.run("atlas", "albedo_by_a_fti").expect(2).expect_one_line("no entry 'albedo_by_a_fti'", "did you mean 'albedo_by_a_fit'?")
    bench.run("atlas", FAST, "--bless").expect(2).expect_one_line("--bless", "--table")
    bench.run("atlas", FAST, "--with", "--axis-k x").expect(2).expect_one_line("--with")
    bench.run("atlas", FAST, "--with", "--no-option 1").expect(2).expect_one_line("--with", "--no-option")
    bench.run("atlas", FAST, "--with", "--axis-k 1", "--bless", "--table", "t.md").expect(2).expect_one_line("--with")
    scratch(bench, "file", "")
    bench.run("atlas", FAST, "-o", "file").expect(7).expect_one_line("file")
    bench.run("atlas", FAST, "-o", "file/folder").expect(7).expect_one_line("file/folder")
    bench.run("atlas", FAST, "--json", "nowhere/a.json").expect(7).expect_one_line("nowhere")
    bench.run("atlas", FAST, "--table", "no.md").expect(4).expect_one_line("no.md")
    scratch(bench, "t.md", "Version 3\n## quick\n| a | b | c | d | e | f |\n")
    bench.run("atlas", FAST, "--table", "t.md").expect(4).expect_one_line("t.md", "is no row")
    check(bench.left_behind() == ["file", "t.md"], f"{bench.left_behind()}")


@case("atlas.holds_its_golden_figures", "input", tier="nightly")
def held(bench):
    needs_embree(bench)
    words = ("atlas", FAST, "--quick")
    done = bench.run(*words, "--table", "t.md", "--bless", "-o", "dir", "--json", "-").expect(0)
    entry = json.loads(done.out)["entries"][0]
    check(entry["id"] == FAST and len(entry["steps"]) == 7 and 0 < entry["onset"] <= 1 and entry["worst"] > entry["threshold"], f"{entry}")
    check(entry["steps"][0]["s"] == 0 and entry["steps"][-1]["s"] == 1 and entry["cure_worst"] == 0, f"{entry}")
    check(entry["worst"] == max(s["error"] for s in entry["steps"]), f"{entry}")
    check(json.loads((bench.folder / "dir/atlas.json").read_text())["entries"][0] == entry, "the same in both files")
    page = (bench.folder / "dir/index.html").read_text()
    check(FAST in page and f"url('{FAST}-quick.png')" in page and "not blessed" in page, "the page lacks the entry")
    table = (bench.folder / "t.md").read_text()
    bench.run(*words, "--table", "t.md").expect(0)
    # a worse figure is named, a better figure asks for a bless
    row = next(line for line in table.splitlines() if line.startswith(f"| {FAST} "))
    cells = [cell.strip() for cell in row.split("|")]
    for worst, code, says in ((0.5 * entry["worst"], 1, "is off by"), (2 * entry["worst"], 0, "bless it")):
        changed = [*cells[:3], f"{worst:.4f}", *cells[4:]]
        scratch(bench, "other.md", table.replace(row, " | ".join(changed).strip()))
        done = bench.run(*words, "--table", "other.md").expect(code)
        check(says in done.err and FAST in done.err, done.describe())
    # a table of another version is reported, not compared
    scratch(bench, "other.md", table.replace("Version 3", "Version 9"))
    done = bench.run(*words, "--table", "other.md").expect(0)
    check("version 9" in done.err and "nothing is compared" in done.err, done.describe())
    # a change that removes the failure
    done = bench.run(*words, "--table", "t.md", "--with", "--dfg table").expect(0)
    check("worst 0.0000" in done.out and "bless it" in done.err, done.describe())


@case("atlas.goes_on_where_it_was_stopped", tier="nightly")
def goes_on(bench):
    """Finished entries are kept in DIR. A stopped run ends with the figures of an uninterrupted run."""
    needs_embree(bench)
    ids = (FAST, "rough_metal_loses_light", "separable_tilt") # in table order
    words = ("atlas", *ids, "--quick", "--no-cache")
    code, err = stopped(bench, words, "a", signal.SIGINT)
    check(code == 130 and b"stopped" in err and not (bench.folder / "a/index.html").exists(), f"{code} {err}")
    before = (bench.folder / f"a/{FAST}-quick.json").stat().st_mtime_ns
    bench.run(*words, "-o", "a").expect(0)
    check((bench.folder / f"a/{FAST}-quick.json").stat().st_mtime_ns == before, "what was finished was measured again")
    bench.run(*words, "-o", "b", "-t", "1").expect(0)
    same_figures(bench)


def stopped(bench, words, folder, by):
    """Returns the exit code and standard error of an atlas that got a signal after its first entry."""
    child = subprocess.Popen([bench.program, *words, "-o", folder], cwd=bench.folder, env=bench.environment({}), stdout=subprocess.PIPE,
                             stderr=subprocess.PIPE)
    begin = time.monotonic()
    while not list((bench.folder / folder).glob(f"{FAST}-*.json")) and child.poll() is None and time.monotonic() - begin < 60:
        time.sleep(0.01)
    child.send_signal(by)
    _, err = child.communicate()
    return child.returncode, err


def same_figures(bench):
    a, b = ((bench.folder / f"{name}/atlas.json").read_bytes() for name in "ab")
    check(a == b, "the figures differ from those of a run that was not stopped")


@case("atlas.full_walk_goes_on_after_kill_9", tier="nightly")
def goes_on_in_full(bench):
    """Takes 33 steps an entry."""
    needs_embree(bench)
    words = ("atlas", FAST, "tangents_left")
    check(stopped(bench, words, "a", signal.SIGKILL)[0] == -signal.SIGKILL, "it was over before")
    kept = {p.name for p in (bench.folder / "a").iterdir()}
    check(f"{FAST}-full.json" in kept and "tangents_left-full.json" not in kept and "index.html" not in kept, f"{kept}")
    before = (bench.folder / f"a/{FAST}-full.json").stat().st_mtime_ns
    done = bench.run(*words, "-o", "a").expect(0)
    check((bench.folder / f"a/{FAST}-full.json").stat().st_mtime_ns == before, "what was finished was measured again")
    bench.run(*words, "-o", "b").expect(0)
    same_figures(bench)
    check(all(len(e["steps"]) == 33 for e in json.loads((bench.folder / "a/atlas.json").read_text())["entries"]), done.describe())


@case("atlas.page_walks_paths_by_slider_and_keys", tier="nightly")
def page(bench):
    needs_embree(bench)
    with Browser(bench.folder / "browser") as browser:
        bench.run("atlas", FAST, "rough_metal_loses_light", "--quick", "-o", "dir")
        browser.size(1200, 900)
        browser.open(bench.folder / "dir/index.html")
        says = "document.querySelectorAll('.says')[{}].textContent".format
        check(browser.value("document.querySelectorAll('.entry').length") == 2, "a section an entry")
        check(browser.value(says(0)).startswith("s = 1.000: roughness 1;"), browser.value(says(0)))
        place = "getComputedStyle(document.querySelectorAll('.panes')[{}].querySelector('.pane')).backgroundPosition".format
        before = browser.value(place(0))
        browser.press("ArrowLeft", number=37)  # on the first entry, without focus
        check(browser.value(says(0)).startswith("s = 0.833:") and browser.value(place(0)) != before, "an arrow key does not go along the path")
        browser.press("n", number=78, text="n")
        check(browser.value("document.activeElement === document.querySelectorAll('.path')[1]"), "N does not go to the next entry")
        browser.press("ArrowLeft", number=37)
        check(browser.value(says(1)).startswith("s = 0.833:") and browser.value(says(0)).startswith("s = 0.833:"), "an arrow key moves another path")
        browser.press("+", number=107, text="+")
        check(browser.value("document.querySelectorAll('.panes')[1].style.getPropertyValue('--zoom')") == "2", "no zoom")
        browser.press("f", number=70, text="f")
        browser.until("document.querySelectorAll('.panes')[1].querySelector('[data-row=\"1\"]').classList.contains('flickers')")
        browser.press("f", number=70, text="f")
        for width in (400, 1200):
            for scheme in ("light", "dark"):
                browser.size(width, 900)
                browser.scheme(scheme)
                check(browser.value("document.documentElement.scrollWidth <= innerWidth"), f"{width} pixels are too few")
                paper = browser.value("getComputedStyle(document.body).backgroundColor")
                check((sum(map(int, re.findall(r"\d+", paper)[:3])) < 200) == (scheme == "dark"), f"{scheme}: {paper}")
                browser.screenshot(bench.folder / f"{width}-{scheme}.png")
        healthy(browser)


@case("atlas.everything_is_held_in_quick_steps", tier="nightly")
def quick(bench):
    needs_embree(bench)
    begin = time.monotonic()
    done = bench.run("atlas", "--quick", "-o", "dir", timeout=900).expect(0)
    print(done.out, f"{time.monotonic() - begin:.0f} s")
    check("not blessed" not in done.out, done.describe())
    check(len(done.out.splitlines()) == len(re.findall(r"^  \w", bench.run("atlas", "--list").out, re.M)), done.describe())


# Wrong constants of techniques: options, entries that must see the defect, and prefixes of entries that may.
DEFECTS = {
    "half_the_overlap": ("--axis-beta 1.15", {"axis_few_samples", "axis_more_samples_are_worse", "axis_at_grazing_angles"}, ("axis_",)),
    "half_the_deviations": ("--axis-k 0.5", {"axis_too_short_for_rough_lobes"}, ("axis_", "adaptive_")),
    "few_samples": ("--samples 3", {"adaptive_counts_step"}, ("",)),
}


def add_defect(name, words, must, may):
    @case(f"atlas.entries_see.{name}", tier="nightly")
    def defect(bench):
        needs_embree(bench)
        report = json.loads(bench.run("atlas", "--quick", "--with", words, "--json", "-", timeout=1100).expect(1).out)
        red = {e["id"] for e in report["entries"] if e["verdict"] in ("worse", "cure fails")}
        print(sorted(red))
        check(must <= red and all(e in must or e.startswith(may) for e in red), f"{sorted(red)}")


for defect, what in DEFECTS.items():
    add_defect(defect, *what)


# Options that must turn each entry red. They change the failing picture and its cure, and not the reference. Some options cannot hit the
# subject of an entry: --env-rotation, --roughness, --frame-map, --normal-y, --height-scale, --anisotropy, --zoom and --fov. They draw
# another picture, which checks that the entry compares its drawing.
SEEDED = {
    "--samples 3": "axis_loses_to_the_bent_normal axis_too_long axis_overlaps_too_much axis_at_grazing_angles adaptive_counts_step half_vectors_in_bands threads_for_a_lobe",
    "--samples 8": "mc_fireflies fibres_by_few_samples ward_cheap_by_few_samples beckmann_by_few_samples phong_by_few_samples round_by_few_samples "
                   "masking_by_the_smaller rough_metal_loses_light axes_swap_without_grain",
    "--samples 4": "glass_from_within grid_without_tails tables_of_few_widths half_vectors_in_eight_bits",
    "--axis-beta 1.15": "axis_few_samples axis_more_samples_are_worse",
    "--axis-k 0.5": "axis_too_short_for_rough_lobes",
    "--masking separable": "prefiltered_tilt albedo_by_a_fit",
    "--dfg fit": "separable_masking",
    "--env-rotation 20": "bent_normal_bends_too_far split_isotropic_is_round prefilter_knows_no_angle sun_in_prefiltered_levels coarse_cube "
                         "masking_bends_the_lobe glass_by_few_samples grains_that_cross few_texture_taps separable_tilt tilt_under_normal_maps tilt_of_diffuse_parts",
    "--roughness 0.85": "line_of_lobes_limited line_in_combs grid_of_few phong_grid_of_few triangles_between_samples tiles_of_one_picture needles_between_samples "
                        "plates_at_one_depth near_plane texels_far_from_zero texels_of_wide_pictures texels_that_are_no_numbers "
                        "normals_in_halves",
    "--roughness 0.1": "area_lights_left_out few_points_of_lights round_cosines_on_brushed_metal colours_that_face_the_eye sphere_through_the_horizon",
    "--area-lights ltc-isotropic": "cosines_of_thin_lobes cosines_of_sharp_lobes cosines_at_grazing_angles sphere_for_a_polygon cosines_for_ward "
                                   "lamps_below_the_horizon cosines_are_no_lunes cosines_through_the_horizon cosines_across_the_grain cosines_unaligned cosines_unsymmetric cosines_inverse",
    "--frame-map off": "tangents_left slopes_in_a_frame_left frames_turned_around mip_box_of_sharp_lobes "
                       "mip_baseline_of_sharp_lobes mip_covariance_of_sharp_lobes "
                       "mip_kappa_of_sharp_lobes",
    "--normal-y down": "mip_net_at_first_levels",
    "--env-rotation 40": "mip_ssgt_of_sharp_lobes",
    "--height-scale 0": "steps_of_relief relief_at_80_degrees depths_by_stretched_coordinates",
    "--anisotropy -0.9": "cores_of_few_texels mip_lean_of_sharp_lobes mip_leadr_of_sharp_lobes",
    "--msaa 2": "edges_of_bright_things",
    "--zoom 4": "darkness_measured",
    "--fov 0.2": "eye_far_away",
}


@case("atlas.every_entry_has_a_seeded_defect", tier="quick")
def seeds(bench):
    seeded = sorted(" ".join(SEEDED.values()).split())
    check(seeded == sorted(re.findall(r"^  (\w+)", bench.run("atlas", "--list").out, re.M)), f"{seeded}")


@case("atlas.every_entry_sees_its_own_defect", tier="nightly")
def own_defects(bench):
    needs_embree(bench)
    blind = []
    for words, ids in SEEDED.items():
        done = bench.run("atlas", *ids.split(), "--quick", "--with", words, "--json", "r.json", timeout=1100)
        blind += [f"{e['id']} {words}" for e in json.loads((bench.folder / "r.json").read_text())["entries"]
                  if e["verdict"] not in ("worse", "cure fails")]
        check(done.code == 1 or blind, done.describe())
    check(not blind, f"{blind} do not see it")


@case("atlas.every_entry_can_fail", tier="nightly")
def can_fail(bench):
    """If all drawings are twice as bright as the reference, no entry is held. Patterns have no scale, and darkness sets this exposure itself."""
    needs_embree(bench)
    report = json.loads(bench.run("atlas", "--quick", "--with", "--env-exposure 1", "--json", "-", timeout=1100).expect(1).out)
    blind = [e["id"] for e in report["entries"] if e["verdict"] not in ("worse", "cure fails")]
    check(set(blind) <= {"line_in_combs", "darkness_measured"}, f"{blind} do not see it")


@case("atlas.glass_does_not_break_as_its_index_comes_near_one", tier="nightly")
def near_index_one(bench):
    """Fails neither with many samples nor with few: reflection vanishes, and light passes ever straighter."""
    needs_embree(bench)
    found = {}
    for index in ("1.5", "1.1", "1.01", "1.001", "1"):
        words = (f"builtin:glass-ball={index}", "--env-size", "64", "--env-samples", "64", "--size", "48x48", "--no-background", "-q")
        bench.run("render", *words, "--backend", "reference", "--samples", "1024", "-o", "reference.pfm").expect(0)
        for samples in (4, 1024):
            bench.run("render", *words, "--technique", "mc", "--samples", samples, "-o", "mc.pfm").expect(0)
            out = bench.run("compare", "reference.pfm", "mc.pfm", "--metric", "flip-hdr", "-q", "--csv", "-").expect(0).out
            found.setdefault(samples, []).append(float(next(csv.DictReader(io.StringIO(out)))["flip_mean"]))
    print(found)
    for samples, errors in found.items():
        check(all(near <= far + 1e-4 for far, near in zip(errors, errors[1:])) and errors[-1] < 0.5 * errors[0], f"{samples} samples: {errors}")


def broken_ends(bench):
    """Returns {entry: words of `burnish render`} at each path's end, without tables that only the atlas makes."""
    ends = {}
    for entry, words, path in re.findall(r"^  (\w+)\n.*\n      burnish render ([^,]*(?:,[^ ]*)*(?: [^ ]+)*?), (\S+=\S+)", bench.run("atlas", "--list").out, re.M):
        words = words.split()
        for option, end in re.findall(r"([a-z-]+)=[^:]*:([^=]*?)(?=,[a-z-]+=|,?$)", path):
            words = [f"{words[0]}={end}", *words[1:]] if option == "amount" else [*words, f"--{option}", end]
        if not any(word.startswith("trial:") for word in words):
            ends[entry] = words
    return ends


def broken_hash(bench, words, *how, program=None):
    coarse = ("--env-samples", "16") if "--env-size" in words else ("--env-samples", "16", "--env-size", "16")
    done = bench.run("render", *words, *coarse, "--size", "40x40", "--no-background", "-q", "--stats", "-", *how, program=program, timeout=600)
    if done.code == 77:
        raise Skipped(done.err.strip())
    return json.loads(done.expect(0).out)["pixel_hash"]


@case("atlas.broken_pictures_are_the_same_words_by_another_compiler", "compilers", tier="nightly")
def by_compilers(bench):
    if not os.path.exists(bench.compare_program):
        raise Skipped(f"no program at {bench.compare_program}")
    ends = broken_ends(bench)
    other = [entry for entry, words in ends.items()
             if broken_hash(bench, words) != broken_hash(bench, words, "--no-cache", program=bench.compare_program)]
    print(f"{len(ends)} entries")
    check(not other, f"{other} are drawn otherwise by {bench.compare_program}")
    check(len(ends) > 70, f"only {len(ends)} entries")


@case("atlas.broken_pictures_are_the_same_words_on_a_device", tier="nightly")
def by_device(bench):
    ends, hashes = broken_ends(bench), {}
    for entry, words in ends.items():
        hashes[entry] = broken_hash(bench, words), broken_hash(bench, words, "--backend", "vulkan", "--device", "lavapipe")
    other = [entry for entry, (tile, device) in hashes.items() if tile != device]
    print(f"{len(ends)} entries, {len(set(hashes.values()))} pictures")
    check(not other, f"{other} are drawn otherwise on the device")
    check(len(set(hashes.values())) > 50, "most pictures are one")


@case("wasm.worst_places_of_the_atlas_are_drawn_anew", "of_wasm", tier="nightly", budget=150)
def atlas_anew(bench):
    entries = ("bent_normal_bends_too_far", "half_vectors_in_eight_bits")  # the latter reads a table of a trial
    done = bench.run("atlas", *entries, "--quick", "--live", "--renderer", package(bench), "-o", "atlas").expect(0)
    check("the page cannot draw 1 of 2 entries" in done.err, done.err)
    worst = max(json.loads((bench.folder / "atlas/atlas.json").read_text())["entries"][0]["steps"], key=lambda step: step["error"])
    with Browser(bench.folder) as browser:
        browser.size(1200, 800)
        browser.open(bench.folder / "atlas/index.html")
        check(browser.value("document.querySelectorAll('.burnish-open').length") == 1, "one entry has a button")
        browser.value("document.querySelector('.burnish-open').click()")
        inside = "document.querySelector('dialog.burnish-live iframe')?.contentDocument"
        browser.until(f"{inside}?.body?.dataset.proof", 120)
        check(browser.value(f"{inside}.body.dataset.proof") == "same", browser.value(f"{inside}.getElementById('proof').textContent"))
        name, value = worst["values"].split()
        check(f"--{name} {value}" in browser.value(f"{inside}.getElementById('command').textContent"), f"not the worst place, {worst}")
        browser.screenshot(bench.folder / "atlas.png", whole=False)
        check(not browser.faults, str(browser.faults))
    for words, text in ((["--live"], "--live: needs -o"), (["-o", "b", "--renderer", "x"], "--renderer: needs --live")):
        check(text in bench.run("atlas", "--quick", *words, entries[0]).expect(2).err, text)
