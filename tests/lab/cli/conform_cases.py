"""burnish conform: conformance folders, and mistakes in an engine's pictures of them."""

import array
import json
import pathlib
import re
import shutil
import sys
import xml.etree.ElementTree

from browser import Browser
from chart_cases import needs_embree
from harness import case, check, scratch

ROOT = pathlib.Path(__file__).resolve().parents[3]
SCENES = ("mirror", "round", "rotation_0", "rotation_30", "rotation_90", "strength_half", "rough", "smooth", "direction_map", "strength_map", "linear_map",
          "second_coordinates", "moved_coordinates", "own_tangents", "no_tangents", "left_handed", "mirrored_coordinates", "mirrored_node", "skewed_node",
          "normal_map", "pole", "grazing", "back", "minified", "dielectric", "high_index", "dark_limb", "few_triangles",
          "coat", "lamp", "area_light")

FEW = ("mirror", "round", "rotation_30", "direction_map", "left_handed", "mirrored_coordinates", "lamp")


def written(bench, name="folder"):
    """Writes a conformance folder with coarse references."""
    needs_embree(bench)
    bench.run("conform", "--write", name, "--samples", "64", "-q", timeout=300).expect(0)
    return name


def without(*kept):
    others = [name for name in SCENES if name not in kept]
    return ("--without", ",".join(others)) if others else ()


def judged(bench, folder, pictures, *words, code=None):
    done = bench.run("conform", folder, pictures, "--json", "-", "-q", *words, timeout=600)
    check(done.code in ((0, 1) if code is None else (code,)), done.describe())
    return json.loads(done.out)


def drawn(bench, folder, pictures, *words):
    bench.run("conform", folder, pictures, "--draw", "-q", *words, timeout=300).expect(0)
    return pictures


@case("conform.refuses_wrong_requests", tier="quick")
def requests(bench):
    bench.run("conform").expect(2).expect_one_line("DIR", "--write")
    bench.run("conform", "folder").expect(2).expect_one_line("PICTURES")
    bench.run("conform", "folder", "--write", "other").expect(2).expect_one_line("DIR", "--write")
    bench.run("conform", "a", "b", "--samples", "64").expect(2).expect_one_line("--samples", "--write")
    bench.run("conform", "a", "b", "--mistake", "no_bend").expect(2).expect_one_line("--mistake", "--draw")
    bench.run("conform", "a", "b", "--draw", "--html", "a.html").expect(2).expect_one_line("--html", "--draw")
    bench.run("conform", "a", "b", "--draw", "--mistake", "no_bent").expect(2).expect_one_line("no_bent", "no_bend")
    bench.run("conform", "a", "b", "--draw", "--mistake", "no_bend", "--technique", "mc").expect(2).expect_one_line("--technique", "mc", "gltf")
    bench.run("conform", "a", "b", "--without", "nothing").expect(2).expect_one_line("nothing")
    bench.run("conform", "a", "b").expect(4).expect_one_line("a/conform.json", "--write")
    bench.run("conform", "a", "b", "--without", ",".join(SCENES)).expect(2).expect_one_line("--without", "no scene")
    for name in ("reference", "truth"):
        bench.run("conform", "a", f"a/{name}", "--draw").expect(2).expect_one_line("PICTURES", "references")
    bench.run("conform", "a", "b", "--draw", "--mistake", "no_bend", "--technique", "hdrp").expect(2).expect_one_line("no_bend", "gltf")
    for way in ((), ("--technique", "gltf")):
        bench.run("conform", "a", "b", "--draw", "--mistake", "no_bend", *way).expect(4).expect_one_line("a/conform.json")
    (bench.folder / "mine").mkdir()
    scratch(bench, "mine/README.md", "mine")
    bench.run("conform", "--write", "mine").expect(2).expect_one_line("mine", "holds other files")
    check((bench.folder / "mine/README.md").read_text() == "mine", "a user's file is lost")
    bench.run("conform", "a", "b", "--html", "nowhere/a.html").expect(7).expect_one_line("nowhere")
    folder = bench.folder / "a"
    for name in ("reference", "truth"):
        (folder / name).mkdir(parents=True)
    for name in ("README.md", "reference/mirror.variance.exr", "truth/mirror.exr", "mirror.exr", "lamp.png"):
        scratch(bench, f"a/{name}", "mine")
    for pictures, out in (("b", "a/README.md"), ("b", "a/reference/mirror.variance.exr"), ("b", "a/truth/mirror.exr"), ("a/", "a/mirror.exr")):
        bench.run("conform", "a" if pictures == "b" else "c", pictures, "--html", out).expect(2).expect_one_line(out)
        check((bench.folder / out).read_text() == "mine", f"{out} is lost")
    bench.run("conform", "a", "a", "--draw").expect(2).expect_one_line("PICTURES")
    (folder / "conform.json").write_text('{"burnish_conform": 99}')
    bench.run("conform", "a", "b", "--html", "a/conform.json").expect(2).expect_one_line("a/conform.json")
    bench.run("conform", "a", "b").expect(4).expect_one_line("/burnish_conform", "99", "write the folder anew")
    for version in ("[" * 400000 + "]" * 400000, '"1"', "1.5", "null"):
        (folder / "conform.json").write_text('{"burnish_conform":' + version + "}")
        bench.run("conform", "a", "b").expect(4).expect_one_line("conform.json")
    (folder / "conform.json").write_text('[]')
    bench.run("conform", "a", "b").expect(4).expect_one_line("describes no conformance folder")


PRODUCT = ("--env", "folder/environment.exr", "--env-size", "256", "--env-samples", "512", "--key-lights", "off", "--technique", "bent_normal", "--size",
           "256x192", "--msaa", "8", "--no-background")


@case("conform.any_reader_takes_a_folder_and_draws_what_its_kernels_draw", tier="nightly")
def folder_is_whole(bench):
    """The folder is whole. The product's pictures of its scenes equal the kernels' pictures without a mistake, and they are judged right."""
    folder = bench.folder / written(bench)
    listed = json.loads((folder / "conform.json").read_text())
    check(tuple(s["name"] for s in listed["scenes"]) == SCENES, f"{listed}")
    for scene in listed["scenes"]:
        check(scene["about"] and (folder / scene["file"]).is_file(), f"{scene}")
        for kind in ("exr", "variance.exr"):
            check((folder / f"reference/{scene['name']}.{kind}").is_file(), f"no {kind} of {scene}")
    for name in ("README.md", "pages/three.html", "pages/babylon.html", "pages/pictures.js"):
        check((folder / name).stat().st_size > 500, name)
    # A folder whose scenes, list or exposure changed is no longer one
    for name, old, new, words in (("conform.json", '"rotation_30"', '"rotation_31"', "/scenes"), ("conform.json", '"exposure_ev": -1', '"exposure_ev": 5', "/exposure_ev"),
                                  ("scenes/rotation_30.gltf", '"version"', '"Version"', "/content")):
        text = (folder / name).read_text()
        check(old in text, f"{name} has no {old}")
        (folder / name).write_text(text.replace(old, new, 1))
        bench.run("conform", folder, "own").expect(4).expect_one_line(words, "write the folder anew")
        (folder / name).write_text(text)
    # Both environments are the same light
    done = bench.run("compare", "folder/environment.exr", "folder/environment.hdr", "--metric", "rel-mse", "--json", "-").expect(0)
    check(json.loads(done.out)["rel_mse"] < 1e-4, done.out)
    # A reader finds nothing to repair or to ignore, and draws the same bits
    drawn(bench, "folder", "own", "--technique", "hdrp")
    for name in ("rotation_30", "direction_map", "normal_map", "dielectric", "coat", "mirrored_node", "moved_coordinates", "lamp"):
        light = [] if name != "lamp" else ["--env-exposure", "-30"]
        done = bench.run("render", f"folder/scenes/{name}.gltf", *PRODUCT, *light, "-o", f"{name}.pfm").expect(0)  # without alpha, as own pictures are
        check("warning" not in done.err, done.err)
        alone = json.loads(bench.run("compare", f"{name}.pfm", f"own/{name}.exr", "--metric", "max", "--json", "-").expect(0).out)
        check(alone["max_abs"] <= (0 if name != "lamp" else 1e-6), f"{name}: {alone}")
    check_right(bench, "own", "direction_map", "lamp")
    # An older folder names its references otherwise
    (folder / "reference").rename(folder / "truth")
    done = bench.run("conform", "folder", "own", *without("direction_map", "lamp")).expect(0)
    check(done.err.count("warning") == 1 and "folder/truth" in done.err and "folder/reference" in done.err, done.err)


def check_right(bench, pictures, *kept):
    result = judged(bench, "folder", pictures, *without(*kept), code=0)
    check(result["right"] and not result["mistakes"] and all(s["outcome"] == "right" for s in result["scenes"]), f"{pictures}: {result}")


@case("conform.what_is_right_passes_in_every_scene", tier="nightly")
def right(bench):
    written(bench)
    for way in ("gltf", "hdrp", "filtered_is_ggx"):
        check_right(bench, drawn(bench, "folder", way, "--technique", way), *SCENES)


def known_mistakes(bench):
    refused = bench.run("conform", "folder", "x", "--draw", "--mistake", "?").expect(2).err
    return re.findall(r"\w+", refused.split("is not one of", 1)[1])


def named(bench, folder, *mistakes, kept=SCENES):
    """Returns the names found in pictures with mistakes."""
    pictures = "_".join(mistakes)
    result = judged(bench, folder, drawn(bench, folder, pictures, "--mistake", ",".join(mistakes), *without(*kept)), *without(*kept))
    shutil.rmtree(bench.folder / pictures)
    return [m["name"] for m in result["mistakes"]]


@case("conform.names_a_mistake_and_two", tier="nightly")
def names(bench):
    """Names one mistake, made in the files, then one that few scenes show, then two, made by kernels and pictures, then an exposure."""
    written(bench)
    check_mistake_in_files(bench)
    check_few_scenes(bench, ("no_bend", "rotation_0", "rotation_30", "lamp", "area_light"))
    # Of two mistakes the second is seen where the first is taken into account
    found = named(bench, "folder", "handedness_ignored", "upside_down", kept=("mirror", "rotation_30", "left_handed"))
    check(sorted(found) == ["handedness_ignored", "upside_down"], f"{found}")
    check_exposures(bench)


def check_few_scenes(bench, *rows):
    for mistake, *kept in rows:
        found = named(bench, "folder", mistake, kept=("mirror", "round", *kept))
        check(found == [mistake], f"{mistake}: {found}")


@case("conform.names_mistakes_that_few_scenes_show", tier="nightly")
def names_few(bench):
    written(bench)
    check_few_scenes(bench, ("no_fresnel", "dark_limb"), ("no_energy_share", "high_index"), ("geometric_normals", "few_triangles"))


def check_mistake_in_files(bench):
    """The product's kernels draw edited files: the mistake does not come from the kernels that it is compared with."""
    (bench.folder / "edited").mkdir()
    kept = ("rotation_0", "rotation_30")
    for name in kept:
        scene = json.loads((bench.folder / f"folder/scenes/{name}.gltf").read_text())
        for material in scene["materials"]:
            anisotropy = material.get("extensions", {}).get("KHR_materials_anisotropy", {})
            if "anisotropyRotation" in anisotropy:
                anisotropy["anisotropyRotation"] *= -1
        (bench.folder / f"{name}.gltf").write_text(json.dumps(scene))
        bench.run("render", f"{name}.gltf", *PRODUCT, "-o", f"edited/{name}.exr", "-q").expect(0)
    result = judged(bench, "folder", "edited", *without(*kept), code=1)
    check([m["name"] for m in result["mistakes"]] in (["rotation_clockwise"], ["rotation_negated"]) and result["way"] == "hdrp", f"{result}")


def check_exposures(bench):
    lit = ("mirror", "rotation_30")
    (bench.folder / "exposed").mkdir()
    for name in lit:
        bench.run("render", f"folder/scenes/{name}.gltf", *PRODUCT, "-o", f"{name}.pfm", "-q").expect(0)
    for stops in (0.5, -1.2):
        for name in lit:
            exposed(bench.folder / f"{name}.pfm", stops, bench.folder / f"exposed/{name}.pfm")
        result = judged(bench, "folder", "exposed", *without(*lit), code=1)
        check([m["name"] for m in result["mistakes"]] == ["exposure"] and abs(result["exposure_ev"] - stops) < 0.1, f"{stops}: {result}")


def exposed(picture, stops, to):
    """Writes a PFM file's picture with its light scaled."""
    *header, values = picture.read_bytes().split(b"\n", 3)
    check(header[0] == b"PF" and float(header[2]) < 0 and sys.byteorder == "little", f"{picture}: {header}")
    scaled = array.array("f", (v * 2**stops for v in array.array("f", values)))
    to.write_bytes(b"\n".join([*header, scaled.tobytes()]))


@case("conform.the_manual_names_every_mistake", tier="quick")
def manual_names_all(bench):
    page = (ROOT / "apps/manual/conform.md").read_text()
    known = known_mistakes(bench)
    # Each mistake of the kernels is in their text and in the list
    header = (ROOT / "shading/lab/conform/mutated.h").read_text()
    texts = "".join(path.read_text() for path in (ROOT / "shading").rglob("*.[kt].h"))
    listed = (ROOT / "apps/lab/conform/mutants.cpp").read_text()
    for name in re.findall(r"^    X\((\w+)\)", header, re.M):
        check(f"BN_MUTANT({name}," in texts and (name == "gltf_bend" or f"K::{name}" in listed), name)
    check(len(known) > 40 and all(f"`{name}`" in page for name in known), f"{[name for name in known if f'`{name}`' not in page]}")


QUARTERS = 4


def names_all(bench, quarter):
    written(bench)
    found = {mistake: named(bench, "folder", mistake) for mistake in known_mistakes(bench)[quarter::QUARTERS]}
    lost = {mistake: names for mistake, names in found.items() if names[:1] != [mistake]}
    check(found and not lost, f"{lost}")


for at in range(QUARTERS):
    case(f"conform.names_every_mistake.{at}", tier="nightly")(lambda bench, quarter=at: names_all(bench, quarter))


@case("conform.names_two_mistakes", tier="nightly")
def names_two(bench):
    """Two of whole pictures, of which neither explains them alone, one of them beside one of few scenes, and two of the lobe."""
    written(bench)
    for two, *kept in ((("handedness_ignored", "sky_turned_half"), FEW), (("upside_down", "sky_turned_half"),), (("sky_mirrored_x", "sky_turned_quarter"),), (("axes_swapped", "strength_squared_twice"),)):
        found = named(bench, "folder", *two, **({"kept": kept[0]} if kept else {}))
        check(sorted(found) == sorted(two), f"{two}: {found}")


@case("conform.what_is_right_passes", tier="nightly", budget=60)
def passes_and_fails(bench):
    """Right pictures pass. Those that no known mistake explains do not."""
    written(bench)
    drawn(bench, "folder", "pictures")
    check_right(bench, "pictures", "rotation_30", "left_handed", "lamp")
    check_right(bench, drawn(bench, "folder", "filtered", "--technique", "filtered_is_ggx"), "mirror", "rotation_30", "left_handed", "lamp")
    check_no_known_mistake(bench, {"round": "lamp"}, "round", "lamp")


@case("conform.missing_and_unusable_pictures_are_said", tier="nightly")
def missing_or_unusable(bench):
    """In check, `conform.refuses_wrong_requests` holds the faults that need no reference."""
    written(bench)
    drawn(bench, "folder", "pictures")
    kept, pictures = without("rotation_0", "lamp"), bench.folder / "pictures"
    drawn(bench, "folder", "two", *kept)
    check(sorted(path.name for path in (bench.folder / "two").iterdir()) == ["lamp.exr", "rotation_0.exr"], "scenes that were left out are drawn")
    check((bench.folder / "two/lamp.exr").read_bytes() == (pictures / "lamp.exr").read_bytes(), "fewer scenes, another picture")
    # A missing one
    (pictures / "rotation_0.exr").unlink()
    done = bench.run("conform", "folder", "pictures", *kept, "--json", "-", "--junit", "j.xml", "-q").expect(1)
    done.expect_one_line("1 of 2 pictures are missing: rotation_0")
    check([s["outcome"] for s in json.loads(done.out)["scenes"]] == ["missing", "right"], done.out)
    suite = xml.etree.ElementTree.parse(bench.folder / "j.xml").getroot()
    check(len(suite.findall(".//testcase")) == 2 and len(suite.findall(".//error")) == 1, "JUnit")
    # Two pictures of one scene
    shutil.copy(pictures / "lamp.exr", pictures / "lamp.hdr")
    done = bench.run("conform", "folder", "pictures", *kept, "-q").expect(4).expect_one_line("lamp", "twice")
    (pictures / "lamp.hdr").unlink()
    # NaN, another size, and an end that comes too early
    picture = pictures / "rotation_0.pfm"
    picture.write_bytes(b"PF\n256 192\n-1.0\n" + b"\0\0\xc0\x7f" * (256 * 192 * 3))
    bench.run("conform", "folder", "pictures", *kept, "-q").expect(6).expect_one_line("rotation_0", "NaN")
    picture.write_bytes(b"PF\n2 2\n-1.0\n" + b"\0" * 48)
    bench.run("conform", "folder", "pictures", *kept, "-q").expect(4).expect_one_line("rotation_0", "2x2", "256x192")
    picture.write_bytes(b"PF\n256 192\n-1.0\n")
    bench.run("conform", "folder", "pictures", *kept, "-q").expect(4).expect_one_line("rotation_0")
    # Eight bits are taken, and said
    picture.unlink()
    bench.run("render", "folder/scenes/rotation_0.gltf", *PRODUCT, "--tonemap", "none", "--exposure", "-1", "-o", "pictures/rotation_0.png", "-q").expect(0)
    done = bench.run("conform", "folder", "pictures", *kept).expect(0)
    check("1 pictures of 8 or 16 bits" in done.err and "-1 stops" in done.err, done.err)
    # References of another kind
    shutil.copy(pictures / "rotation_0.png", bench.folder / "folder/reference/lamp.exr")
    bench.run("conform", "folder", "pictures", *kept, "-q").expect(4).expect_one_line("reference/lamp.exr")
    (bench.folder / "empty").mkdir()
    bench.run("conform", "folder", "empty", *without("rotation_0"), "-q").expect(4).expect_one_line("holds no picture of a scene")


def check_no_known_mistake(bench, others, *kept):
    """Judges pictures of which some show other scenes: {scene: the scene that is seen}."""
    mixed = bench.folder / "mixed"
    mixed.mkdir()
    for name in kept:
        shutil.copy(bench.folder / f"pictures/{others.get(name, name)}.exr", mixed / f"{name}.exr")
    done = bench.run("conform", "folder", "mixed", *without(*kept), "--html", "p.html", timeout=600).expect(1)
    check(f"none of ours looks like {', '.join(others)}\n" in done.out and "no known mistake explains it" in done.err, done.describe())
    with Browser(bench.folder) as browser:
        browser.open(bench.folder / "p.html")
        for width in (1280, 400):
            browser.size(width, 900)
            check(browser.value("document.documentElement.scrollWidth <= innerWidth"), f"the page is wider than {width}")
        check(browser.value("document.querySelectorAll('.pictures img').length") >= 4 * len(kept), "pictures")
        check("None of ours" in browser.value("document.body.innerText"), "the sentence")
        check(not browser.faults, f"{browser.faults}")


@case("conform.says_where_no_known_mistake_explains_two_of_five_pictures", tier="nightly")
def none_of_ours(bench):
    written(bench)
    drawn(bench, "folder", "pictures")
    check_no_known_mistake(bench, {"rotation_30": "mirror", "direction_map": "lamp"}, "mirror", "round", "rotation_30", "direction_map", "lamp")
