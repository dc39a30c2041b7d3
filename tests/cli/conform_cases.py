"""burnish conform: conformance folders, and mistakes in an engine's pictures of them."""

import json
import pathlib
import re
import shutil
import xml.etree.ElementTree

from browser import Browser
from chart_cases import needs_embree
from harness import case, check, scratch

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = ("mirror", "round", "rotation_0", "rotation_30", "rotation_90", "strength_half", "rough", "smooth", "direction_map", "strength_map", "linear_map",
          "second_coordinates", "moved_coordinates", "own_tangents", "no_tangents", "left_handed", "mirrored_coordinates", "mirrored_node", "skewed_node",
          "normal_map", "pole", "grazing", "back", "minified", "dielectric", "coat", "lamp", "area_light")

FEW = ("mirror", "round", "rotation_30", "direction_map", "left_handed", "mirrored_coordinates", "lamp")


def written(bench, name="folder"):
    """Writes a conformance folder with coarse truths."""
    needs_embree(bench)
    bench.run("conform", "--write", name, "--samples", "64", "-q", timeout=300).expect(0)
    return name


def without(*kept):
    return ("--without", ",".join(name for name in SCENES if name not in kept))


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
    bench.run("conform", "a", "a/truth", "--draw").expect(2).expect_one_line("PICTURES", "truths")
    bench.run("conform", "a", "b", "--draw", "--mistake", "no_bend", "--technique", "hdrp").expect(2).expect_one_line("no_bend", "gltf")
    (bench.folder / "mine").mkdir()
    scratch(bench, "mine/README.md", "mine")
    bench.run("conform", "--write", "mine").expect(2).expect_one_line("mine", "holds other files")
    check((bench.folder / "mine/README.md").read_text() == "mine", "a user's file is lost")
    bench.run("conform", "a", "b", "--html", "nowhere/a.html").expect(7).expect_one_line("nowhere")
    folder = bench.folder / "a"
    folder.mkdir()
    (folder / "conform.json").write_text('{"burnish_conform": 99}')
    bench.run("conform", "a", "b", "--html", "a/conform.json").expect(2).expect_one_line("a/conform.json")
    bench.run("conform", "a", "b").expect(4).expect_one_line("/burnish_conform", "99", "write the folder anew")
    for version in ("[" * 400000 + "]" * 400000, '"1"', "1.5", "null"):
        (folder / "conform.json").write_text('{"burnish_conform":' + version + "}")
        bench.run("conform", "a", "b").expect(4).expect_one_line("conform.json")
    (folder / "conform.json").write_text('[]')
    bench.run("conform", "a", "b").expect(4).expect_one_line("describes no conformance folder")


@case("conform.a_folder_holds_scenes_that_any_reader_takes", budget=25)
def folder_is_whole(bench):
    folder = bench.folder / written(bench)
    listed = json.loads((folder / "conform.json").read_text())
    check(tuple(s["name"] for s in listed["scenes"]) == SCENES, f"{listed}")
    for scene in listed["scenes"]:
        check(scene["about"] and (folder / scene["file"]).is_file(), f"{scene}")
        for kind in ("exr", "variance.exr"):
            check((folder / f"truth/{scene['name']}.{kind}").is_file(), f"no {kind} of {scene}")
    for name in ("README.md", "pages/three.html", "pages/babylon.html", "pages/pictures.js"):
        check((folder / name).stat().st_size > 500, name)
    # Readers find nothing to repair or to ignore
    for name in ("mirrored_node", "moved_coordinates", "lamp", "coat"):
        done = bench.run("render", f"folder/scenes/{name}.gltf", "--size", "16x16", "--env-size", "16", "-o", "a.png").expect(0)
        check("warning" not in done.err, done.err)
    # Both environments are the same light
    done = bench.run("compare", "folder/environment.exr", "folder/environment.hdr", "--metric", "rel-mse", "--json", "-").expect(0)
    check(json.loads(done.out)["rel_mse"] < 1e-4, done.out)


@case("conform.kernels_without_a_mistake_are_those_of_the_product", budget=30)
def same_bits(bench):
    written(bench)
    drawn(bench, "folder", "own", "--technique", "hdrp")
    for name in ("rotation_30", "direction_map", "normal_map", "dielectric", "lamp"):
        light = [] if name != "lamp" else ["--env-exposure", "-30"]
        bench.run("render", f"folder/scenes/{name}.gltf", "--env", "folder/environment.exr", "--env-size", "256", "--env-samples", "512", "--key-lights",
                  "off", "--technique", "bent_normal", "--size", "256x192", "--msaa", "8", "--no-background", *light, "-o", f"{name}.exr", "-q").expect(0)
        alone = json.loads(bench.run("compare", f"{name}.exr", f"own/{name}.exr", "--metric", "max", "--json", "-").expect(0).out)
        check(alone["max_abs"] <= (0 if name != "lamp" else 1e-6), f"{name}: {alone}")


@case("conform.what_is_right_passes", budget=40)
def right(bench):
    written(bench)
    for way in ("gltf", "hdrp", "filtered_is_ggx"):
        result = judged(bench, "folder", drawn(bench, "folder", way, "--technique", way), *without(*FEW), code=0)
        check(result["right"] and not result["mistakes"] and all(s["outcome"] == "right" for s in result["scenes"]), f"{way}: {result}")


def known_mistakes(bench):
    refused = bench.run("conform", "folder", "x", "--draw", "--mistake", "?").expect(2).err
    return re.findall(r"\w+", refused.split("is not one of", 1)[1])


def named(bench, folder, *mistakes, kept=SCENES):
    """Returns the names found in pictures with mistakes."""
    pictures = "_".join(mistakes)
    words = without(*kept) if kept != SCENES else ()
    result = judged(bench, folder, drawn(bench, folder, pictures, "--mistake", ",".join(mistakes)), *words)
    shutil.rmtree(bench.folder / pictures)
    return [m["name"] for m in result["mistakes"]]


@case("conform.names_a_mistake_and_two", budget=60)
def names(bench):
    written(bench)
    for mistakes in (("rotation_clockwise",), ("handedness_ignored", "sky_turned_half")):
        found = named(bench, "folder", *mistakes, kept=FEW)
        check(sorted(found) == sorted(mistakes), f"{mistakes}: {found}")


@case("conform.names_a_mistake_made_in_the_files", budget=40)
def in_the_files(bench):
    """The product's kernels draw edited files: the mistake does not come from the kernels that it is compared with."""
    written(bench)
    (bench.folder / "pictures").mkdir()
    kept = ("mirror", "round", "rotation_30", "left_handed")
    for name in kept:
        path = bench.folder / f"folder/scenes/{name}.gltf"
        scene = json.loads(path.read_text())
        anisotropy = scene["materials"][0].get("extensions", {}).get("KHR_materials_anisotropy", {})
        if anisotropy:
            anisotropy["anisotropyRotation"] *= -1
        (bench.folder / f"{name}.gltf").write_text(json.dumps(scene))
        bench.run("render", f"{name}.gltf", "--env", "folder/environment.exr", "--env-size", "256", "--key-lights", "off", "--technique", "bent_normal", "--size",
                  "256x192", "--no-background", "-o", f"pictures/{name}.exr", "-q").expect(0)
    result = judged(bench, "folder", "pictures", *without(*kept), code=1)
    check([m["name"] for m in result["mistakes"]] in (["rotation_clockwise"], ["rotation_negated"]) and result["way"] == "hdrp", f"{result}")


@case("conform.measures_an_exposure", budget=60)
def exposure(bench):
    written(bench)
    for stops in (0.5, -1.2):
        (bench.folder / "exposed").mkdir(exist_ok=True)
        lit = ("mirror", "round", "rotation_30", "direction_map")
        for name in lit:
            bench.run("render", f"folder/scenes/{name}.gltf", "--env", "folder/environment.exr", "--env-exposure", str(stops), "--env-size", "256", "--key-lights",
                      "off", "--technique", "bent_normal", "--size", "256x192", "--no-background", "-o", f"exposed/{name}.pfm", "-q").expect(0)
        result = judged(bench, "folder", "exposed", *without(*lit), code=1)
        check([m["name"] for m in result["mistakes"]] == ["exposure"] and abs(result["exposure_ev"] - stops) < 0.1, f"{stops}: {result}")


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


@case("conform.names_every_mistake", tier="nightly")
def names_all(bench):
    written(bench)
    lost = []
    for mistake in known_mistakes(bench):
        found = named(bench, "folder", mistake)
        if found[:1] != [mistake]:
            lost.append((mistake, found))
    # Two of whole pictures, of which neither explains them alone
    for two in (("upside_down", "sky_turned_half"), ("sky_mirrored_x", "sky_turned_quarter")):
        found = named(bench, "folder", *two)
        if sorted(found) != sorted(two):
            lost.append((two, found))
    check(not lost, f"{lost}")


@case("conform.says_what_is_missing_or_unusable", budget=40)
def unusable(bench):
    written(bench)
    kept = without("mirror", "rotation_0", "rotation_30")
    pictures = bench.folder / drawn(bench, "folder", "pictures")
    check(judged(bench, "folder", "pictures", *kept, code=0)["right"], "right pictures")
    # A missing one
    (pictures / "rotation_0.exr").rename(pictures / "kept.exr")
    result = judged(bench, "folder", "pictures", *kept, "--junit", "j.xml", code=1)
    check([s["outcome"] for s in result["scenes"]] == ["right", "missing", "right"], f"{result}")
    suite = xml.etree.ElementTree.parse(bench.folder / "j.xml").getroot()
    check(len(suite.findall(".//testcase")) == 3 and len(suite.findall(".//error")) == 1, "JUnit")
    bench.run("conform", "folder", "pictures", *kept, "-q").expect(1).expect_one_line("1 of 3 pictures are missing: rotation_0")
    # NaN, and another size
    (pictures / "rotation_0.pfm").write_bytes(b"PF\n256 192\n-1.0\n" + b"\0\0\xc0\x7f" * (256 * 192 * 3))
    bench.run("conform", "folder", "pictures", *kept, "-q").expect(6).expect_one_line("rotation_0", "NaN")
    (pictures / "rotation_0.pfm").write_bytes(b"PF\n2 2\n-1.0\n" + b"\0" * 48)
    bench.run("conform", "folder", "pictures", *kept, "-q").expect(4).expect_one_line("rotation_0", "2x2", "256x192")
    (pictures / "rotation_0.pfm").write_bytes(b"PF\n256 192\n-1.0\n")
    bench.run("conform", "folder", "pictures", *kept, "-q").expect(4).expect_one_line("rotation_0")
    # Eight bits are taken, and said
    (pictures / "rotation_0.pfm").unlink()
    bench.run("render", "folder/scenes/rotation_0.gltf", "--env", "folder/environment.exr", "--env-size", "256", "--key-lights", "off", "--size", "256x192",
              "--no-background", "--tonemap", "none", "--exposure", "-1", "-o", "pictures/rotation_0.png", "-q").expect(0)
    done = bench.run("conform", "folder", "pictures", *kept).expect(0)
    check("1 8-bit pictures" in done.err and "-1 stops" in done.err, done.err)
    # Truths of another kind
    shutil.copy(pictures / "rotation_0.png", bench.folder / "folder/truth/mirror.exr")
    bench.run("conform", "folder", "pictures", *kept, "-q").expect(4).expect_one_line("truth/mirror.exr")
    (bench.folder / "empty").mkdir()
    bench.run("conform", "folder", "empty", *without("rotation_0"), "-q").expect(4).expect_one_line("holds no picture of a scene")


@case("conform.says_where_no_known_mistake_explains_pictures", budget=60)
def none_of_ours(bench):
    written(bench)
    pictures = bench.folder / drawn(bench, "folder", "pictures")
    for name, other in (("rotation_30", "mirror"), ("direction_map", "lamp")):
        shutil.copy(pictures / f"{other}.exr", pictures / f"{name}.exr")
    kept = ("mirror", "round", "rotation_30", "direction_map", "lamp")
    done = bench.run("conform", "folder", "pictures", *without(*kept), "--html", "p.html", timeout=600).expect(1)
    check("none of ours looks like rotation_30, direction_map" in done.out and "no known mistake explains it" in done.err, done.describe())
    with Browser(bench.folder) as browser:
        browser.open(bench.folder / "p.html")
        for width in (1280, 400):
            browser.size(width, 900)
            check(browser.value("document.documentElement.scrollWidth <= innerWidth"), f"the page is wider than {width}")
        check(browser.value("document.querySelectorAll('.pictures img').length") >= 4 * len(kept), "pictures")
        check("None of ours" in browser.value("document.body.innerText"), "the sentence")
        check(not browser.faults, f"{browser.faults}")
