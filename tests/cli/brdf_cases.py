"""--brdf: every surface model, under lamps, in mc, in the reference, on a device."""

import json

from harness import case, check
from parity_cases import check_equal, parity
from reference_cases import needs_embree

ONE_LOBE = ("auto", "split_isotropic", "bent_normal", "major_axis", "lobe_line", "filtered_is", "filtered_is_ggx")
# A sphere that fills the image, so that no edge is visible, and a smooth environment, since mc takes few samples.
CLOSE = ("builtin:sphere", "--eye", "0,0,0.5", "--fov", "35", "--size", "40x40", "--msaa", "1", "--no-background",
         "--env-size", "64", "--env-samples", "64")


def lobes(bench):
    """Returns {name: True if lamps alone meet the lobe} for the models of --brdf, as list models prints them."""
    found = {}
    for line in bench.run("list", "models").expect(0).out.splitlines():
        if "--brdf" in line:
            found[line.split()[0]] = "--brdf, lights" in line
    return found


@case("brdf.list_models_names_what_it_takes", tier="nightly")
def names(bench):
    found = lobes(bench)
    check(len(found) == 11 and [name for name, lamps in found.items() if lamps] == ["heidrich_seidel"], f"{found}")
    hashes = {}
    for name in found:
        hashes[name] = bench.figures(*CLOSE, "--technique", "mc", "--samples", "4", "--brdf", name)
        check(hashes[name]["brdf"] == name and hashes[name]["nan_pixels"] == 0, f"{name}: {hashes[name]}")
    check(len({figures["pixel_hash"] for figures in hashes.values()}) == len(found), "two models give one picture")
    check(bench.figures(*CLOSE, "--technique", "mc", "--samples", "4")["pixel_hash"] == hashes["ggx_aniso"]["pixel_hash"],
          "ggx_aniso is not what is taken where nothing is said")
    bench.run("render", "--brdf", "lambert").expect(2).expect_one_line("--brdf", "lambert", "ashikhmin_shirley")


@case("brdf.a_technique_made_for_one_lobe_refuses_others")
def refusals(bench):
    for technique in ONE_LOBE:
        done = bench.run("render", *CLOSE, "--technique", technique, "--brdf", "ward", "-o", "a.exr").expect(2)
        done.expect_one_line("--technique", technique, "ward")
    bench.run("render", *CLOSE, "--technique", "mc", "--brdf", "ward", "--tilt", "10,0", "-o", "a.exr").expect(2).expect_one_line("--tilt", "ward")
    bench.run("render", *CLOSE, "--backend", "reference", "--brdf", "beckmann", "--tilt", "10,0").expect(2).expect_one_line("--tilt", "beckmann")
    for words in (("--technique", "mc"), ("--backend", "reference")):
        bench.run("render", *CLOSE, *words, "--brdf", "ward", "--masking", "separable", "-o", "a.exr").expect(2).expect_one_line("--masking", "ward")
    bench.run("render", *CLOSE, "--masking", "none", "-o", "a.exr").expect(2).expect_one_line("--masking", "correlated", "separable")
    bench.run("chart", "builtin:sphere", "--brdf", "ward", "--techniques", "mc,lobe_line", "-o", "r").expect(2).expect_one_line("lobe_line", "ward")
    bench.run("parity", "builtin:sphere", "--brdf", "ward", "--technique", "mc,major_axis").expect(2).expect_one_line("major_axis", "ward")
    check(bench.left_behind() == [], f"left behind: {bench.left_behind()}")


# Without tilt, level models and tiltable models give the same image.
@case("brdf.masking_chooses_among_the_models")
def masking(bench):
    mc = (*CLOSE, "--technique", "mc", "--samples", "4")
    hashes = {}
    for name, words in (("usual", ()), ("separable", ("--masking", "separable")), ("tilted", ("--tilt", "20,0")),
                        ("tilted, separable", ("--tilt", "20,0", "--masking", "separable")), ("ggx_aniso_separable", ("--brdf", "ggx_aniso_separable")),
                        ("correlated", ("--masking", "correlated"))):
        hashes[name] = bench.figures(*mc, *words)["pixel_hash"]
    check(hashes["separable"] == hashes["ggx_aniso_separable"] and hashes["correlated"] == hashes["usual"], f"{hashes}")
    check(len(set(hashes.values())) == 4, f"{hashes}")


# A patch of the sphere with little change across a pixel: mc shades the pixel's centre, the reference the whole pixel.
PATCH = ("builtin:sphere", "--eye", "0,0,0.5", "--target", "0.08,0.06,0.173", "--fov", "3", "--size", "24x24", "--msaa", "1",
         "--no-background", "--env-size", "64", "--env-samples", "64", "--env-rotation", "60", "--key-lights", "off", "-q")


def reference_of(bench, name):
    bench.run("render", *PATCH, "--backend", "reference", "--samples", "1024", "--brdf", name, "-o", "r.pfm", "--variance", "v.pfm").expect(0)


def against_files(bench, reference, test, variance):
    """Returns the difference between an image and a reference with known variance."""
    done = bench.run("compare", reference, test, "--variance", variance, "--significance", "0.01", "--json", "c.json", "-q")
    check(done.code in (0, 1), done.describe())
    return json.loads((bench.folder / "c.json").read_text())


def against_reference(bench, samples, name):
    """Returns the difference between mc by `name` and the existing reference."""
    bench.run("render", *PATCH, "--technique", "mc", "--samples", samples, "--brdf", name, "-o", "mc.pfm").expect(0)
    return against_files(bench, "r.pfm", "mc.pfm", "v.pfm")


# Compares many samples, where the reference's noise dominates, and few samples.
@case("brdf.mc_agrees_with_the_reference", tier="nightly")
def agrees(bench):
    needs_embree(bench)
    for name, lamps in lobes(bench).items():
        reference_of(bench, name)
        few = against_reference(bench, "256", name)
        check(few["rel_mse"] < (1e-6 if lamps else 1e-3), f"{name}: {few}")
        many = against_reference(bench, "16384", name)
        check(lamps or many["z_rejected_fraction"] <= 0.01, f"{name}: {many}")
    reference_of(bench, "beckmann")
    for name in ("ggx_aniso", "ward"):
        found = against_reference(bench, "16384", name)
        check(found["z_rejected_fraction"] > 0.2, f"{name} passes for beckmann: {found}")


def devices_agree(bench, *looks):
    lights = bench.data_file("models/Lights.glb")
    check_equal(parity(bench, "builtin:sphere", lights, "--technique", "mc", "--samples", "9", "--size", "48x32", "--msaa", "1", "--env", "builtin:sky",
                       also=[("--brdf", *look) for look in looks]))


# Draws the models with the least shared code; the nightly case below draws all.
@case("brdf.devices_give_the_same_words", tier="nightly")
def devices(bench):
    devices_agree(bench, ("ashikhmin_shirley",), ("ellipsoid",), ("beckmann", "--energy-compensation"))


@case("brdf.devices_give_the_same_words_by_all", tier="nightly")
def devices_by_all(bench):
    devices_agree(bench, *((name,) for name in lobes(bench)))
