"""Blended surfaces over their background: files, alpha of images, the reference, the device."""

import json

from harness import case, check
from model_cases import read_pfm
from parity_cases import check_equal, parity
from reference_cases import needs_embree

SHEETS = {  # colours in the middle of the image
    "two_sheets": (0.5, 0.25, 0.25),
    "twelve_sheets": (1 - 0.8**12,) * 3,
    "thin": (0.03,) * 3,
}
NIGHT = ("--env", "builtin:night", "--env-size", "16", "--env-samples", "1", "--no-background")


def middle(bench, name="a.pfm"):
    width, height, values = read_pfm(bench.folder / name)
    at = 3 * (height // 2 * width + width // 2)
    return values[at : at + 3]


def check_middle(found, wanted, bound, what):
    check(max(abs(a - b) for a, b in zip(found, wanted)) <= bound, f"{what}: {found} for {wanted}")


def sheets(bench, name):
    return bench.data_file(f"reports/blend_{name}.gltf")


@case("blend.sheets_are_composed_by_any_number_of_samples", tier="nightly")
def samples(bench):
    for name, wanted in SHEETS.items():
        for msaa in (1, 2, 4, 8, 16):
            bench.run("render", sheets(bench, name), "--size", "24x24", "--msaa", msaa, *NIGHT, "-o", "a.pfm").expect(0)
            check_middle(middle(bench), wanted, 1e-5, f"{name}, {msaa} samples")


@case("blend.alpha_of_pictures_is_what_does_not_shine_through", tier="nightly")
def alpha(bench):
    """White sheets over nothing: alpha equals light."""
    for backend in ("tile", "reference"):
        if backend == "reference":
            needs_embree(bench)
        more = ("--samples", "64") if backend == "reference" else ()
        bench.run("render", sheets(bench, "twelve_sheets"), "--size", "24x24", *NIGHT, "--backend", backend, *more, "-o", f"{backend}.exr", "-o",
                  f"{backend}.pfm").expect(0)
    check_middle(middle(bench, "tile.pfm"), SHEETS["twelve_sheets"], 1e-5, "tile")
    check_middle(middle(bench, "reference.pfm"), SHEETS["twelve_sheets"], 0.2, "reference, which meets sheets by chance")
    compared = bench.run("compare", "tile.exr", "reference.exr", "--json", "-")
    compared.expect(0)
    check(json.loads(compared.out), "no figures")


@case("blend.sheets_on_lavapipe_equal_the_tiles", tier="nightly")
def device(bench):
    check_equal(parity(bench, sheets(bench, "twelve_sheets"), "--technique", "bent_normal", "--msaa", "1,4", "--size", "40x40"))


@case("blend.shared_samples_and_layers_on_lavapipe_equal_the_tiles", tier="nightly")
def shared(bench):
    gltf = json.loads(sheets(bench, "two_sheets").read_text())
    for material in gltf["materials"]:  # lit, so that neighbours share samples within a layer
        del material["extensions"]
        material["pbrMetallicRoughness"].update(metallicFactor=1, roughnessFactor=0.4)
        material["extensions"] = {"KHR_materials_anisotropy": {"anisotropyStrength": 0.8}}
    gltf["extensionsUsed"] = ["KHR_materials_anisotropy"]
    (bench.folder / "lit.gltf").write_text(json.dumps(gltf))
    check_equal(parity(bench, "lit.gltf", "--technique", "lobe_line", "--msaa", "4", "--size", "40x40"))


@case("blend.the_forward_pipeline_refuses_blended_scenes")
def forward(bench):
    done = bench.run("render", sheets(bench, "thin"), "--size", "24x24", *NIGHT, "--backend", "vulkan", "--device", "lavapipe", "--pipeline", "forward",
                     "-q", "-o", "a.pfm")
    if done.code != 77:
        done.expect(2).expect_one_line("forward does not sort blended surfaces")
