"""KHR_materials_clearcoat: in files, in both renderers, in the reference, on a device."""

import json

import gltf_files as files
from brdf_cases import against_files
from fresnel_cases import CLOSE
from harness import case, check
from input_cases import refuse, scratch
from mip_cases import grain
from mip_zoom_cases import wide_floor
from parity_cases import check_equal, parity
from reference_cases import needs_embree

PLACE = "/materials/0/extensions/KHR_materials_clearcoat"


def dented(x, y):
    return (128 + 40 * (x % 4 - 1), 128 + 30 * (y % 4 - 2), 230)


def leaning(x, y):
    return (150, 110, 230)


def coated(roughness=0.3, textures=(), metallic=0.0, coat=None, color=dented, **more):
    """Returns a triangle that fills the view. textures: of clearcoat, clearcoatRoughness, clearcoatNormal; color: function of their
    texels."""
    gltf = files.textured("data:image/png;base64," + files.base64.b64encode(files.png(16, 16, color=color)).decode())
    coat = {"clearcoatFactor": 0.9, "clearcoatRoughnessFactor": roughness, **(coat or {}), **{name + "Texture": {"index": 0} for name in textures}}
    extensions = {"KHR_materials_clearcoat": coat, "KHR_materials_anisotropy": {"anisotropyStrength": 0.6}}
    gltf["materials"] = [{"pbrMetallicRoughness": {"metallicFactor": metallic, "roughnessFactor": 0.4, "baseColorFactor": [0.6, 0.3, 0.1, 1]},
                          "extensions": extensions, "doubleSided": True, **more}]
    gltf["extensionsUsed"] = list(extensions)
    return gltf


def scene(bench, name, **material):
    return scratch(bench, name + ".gltf", files.text(coated(**material)))


@case("coat.faults_are_named_by_their_place", "input")
def faults(bench):
    for coat, place in (({"clearcoatFactor": 2}, "/clearcoatFactor"), ({"clearcoatFactor": -0.1}, "/clearcoatFactor"),
                        ({"clearcoatFactor": "much"}, "/clearcoatFactor"), ({"clearcoatRoughnessFactor": 1.5}, "/clearcoatRoughnessFactor"),
                        ({"clearcoatRoughnessFactor": [1]}, "/clearcoatRoughnessFactor"), ({"clearcoatTexture": 0}, "/clearcoatTexture"),
                        ({"clearcoatTexture": {"index": 3}}, "/clearcoatTexture/index"),
                        ({"clearcoatRoughnessTexture": {}}, "/clearcoatRoughnessTexture"),
                        ({"clearcoatNormalTexture": {"index": 0, "scale": "x"}}, "/clearcoatNormalTexture/scale"),
                        ({"clearcoatNormalTexture": {"index": 0, "texCoord": -1}}, "/clearcoatNormalTexture/texCoord")):
        refuse(bench, scene(bench, "bad", coat=coat), needles=(PLACE + place,))
    bad = coated()
    bad["materials"][0]["extensions"]["KHR_materials_clearcoat"] = 1
    refuse(bench, scratch(bench, "bad.gltf", files.text(bad)), needles=(PLACE,))
    listed = bench.run("list", "extensions").expect(0).out
    check(any(line.split()[:2] == ["KHR_materials_clearcoat", "supported"] for line in listed.splitlines()), listed)
    words = (scene(bench, "all", textures=("clearcoat", "clearcoatRoughness", "clearcoatNormal")), *CLOSE, "--strict")
    check("clearcoat" not in bench.run("render", *words).expect(0).err, "--strict has something to say of a clear coat")


@case("coat.each_of_its_numbers_is_seen", tier="nightly")
def seen(bench):
    full = {name: bench.figures(scene(bench, name, **material), *CLOSE)["pixel_hash"] for name, material in
            (("coated", {}), ("bare", dict(coat={"clearcoatFactor": 0})), ("half", dict(coat={"clearcoatFactor": 0.5})), ("smooth", dict(roughness=0)),
             ("by share", dict(textures=("clearcoat",))), ("by roughness", dict(textures=("clearcoatRoughness",))),
             ("by normal", dict(textures=("clearcoatNormal",))))}
    check(len(set(full.values())) == len(full), f"two coats give one picture: {full}")
    plain = coated()
    del plain["materials"][0]["extensions"]["KHR_materials_clearcoat"]
    bare = bench.figures(scratch(bench, "plain.gltf", files.text(plain)), *CLOSE)["pixel_hash"]
    check(bare == full["bare"], "a coat of no share is seen")
    textured = scene(bench, "none", textures=("clearcoat", "clearcoatRoughness", "clearcoatNormal"), coat={"clearcoatFactor": 0})
    check(bare == bench.figures(textured, *CLOSE)["pixel_hash"], "a textured coat of no share is seen")


@case("coat.mc_agrees_with_the_reference", tier="nightly")
def agrees(bench):
    needs_embree(bench)
    lamp = ("--light", "quad:points=-1,-0.2,0.1/-1,0.8,0.1/-1,0.8,0.7/-1,-0.2,0.7:radiance=5,5,5:two-sided", "--area-lights", "mc")
    for name, material, more in (("smooth", dict(roughness=0.02), ()), ("satin", dict(roughness=0.2), ()), ("rough", dict(roughness=0.6), ("--tilt", "20,-10")),
                                 ("dull", dict(roughness=1, metallic=1), ("--energy-compensation",)),
                                 ("lit", {}, (*lamp, "--light-samples", "4096", "--env", "builtin:night")),
                                 ("mapped", dict(color=leaning, textures=("clearcoat", "clearcoatRoughness", "clearcoatNormal")), ())):
        words = (scene(bench, name, **material), *CLOSE, "-q", "--env", "builtin:sky", *more)
        bench.run("render", *words, "--backend", "reference", "--samples", "1024", "-o", "r.pfm", "--variance", "v.pfm").expect(0)
        bench.run("render", *words, "--technique", "mc", "--samples", "16384", "-o", "mc.pfm").expect(0)
        found = against_files(bench, "r.pfm", "mc.pfm", "v.pfm")
        check(found["z_rejected_fraction"] <= 0.01, f"{name}: {found}")
    bare = scene(bench, "bare", textures=("clearcoat", "clearcoatRoughness", "clearcoatNormal"), coat={"clearcoatFactor": 0})
    bench.run("render", bare, *words[1:], "--technique", "mc", "--samples", "16384", "-o", "mc.pfm").expect(0)
    check(against_files(bench, "r.pfm", "mc.pfm", "v.pfm")["z_rejected_fraction"] > 0.1, "the test sees no coat")


@case("coat.devices_give_the_same_words", tier="nightly")
def devices(bench):
    mapped = scene(bench, "mapped", textures=("clearcoat", "clearcoatRoughness", "clearcoatNormal"))
    small = ("--size", "32x24", "--env", "builtin:sky")
    check_equal(parity(bench, mapped, "builtin:lacquer", *small, "--msaa", "4", "--technique", "auto", also=[("--tilt", "20,-10", "--horizon", "off")]))
    check_equal(parity(bench, mapped, *small, "--msaa", "1", "--technique", "mc", "--samples", "4"))
    light = ("--light", "quad:points=-1,-0.2,0.1/-1,0.8,0.1/-1,0.8,0.7/-1,-0.2,0.7:radiance=5,5,5:two-sided")
    check_equal(parity(bench, mapped, *small, *light, "--msaa", "1", "--technique", "bent_normal"))
    # Other indices, and normals of the coat that mip filters widen
    dense = scene(bench, "dense", textures=("clearcoatNormal",), extras={"burnish": {"clearcoat": {"ior": 2.2}}})
    check(bench.figures(dense, *CLOSE)["pixel_hash"] != bench.figures(scene(bench, "usual", textures=("clearcoatNormal",)), *CLOSE)["pixel_hash"], "the index is not seen")
    check_equal(parity(bench, dense, *small, "--msaa", "1", "--technique", "auto", "--mip-filter", "kappa", also=[(*light, "--mip-filter", "box")]))

@case("coat.mip_filters_widen_it_by_its_normals", budget=4)
def widened(bench):
    """A grained coat on a black floor, seen from afar: filters come nearer to the reference, whose rays read the map's own texels."""
    needs_embree(bench)
    floor = wide_floor(24)
    coat = {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.25, "clearcoatNormalTexture": {"index": 0}}
    floor["materials"] = [{"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 1, "roughnessFactor": 1},
                           "extensions": {"KHR_materials_clearcoat": coat}}]
    floor["extensionsUsed"] = ["KHR_materials_clearcoat"]
    scratch(bench, "grain.png", grain(128, 0.3))
    floor["images"], floor["textures"] = [{"uri": "grain.png"}], [{"source": 0}]
    words = (scratch(bench, "floor.gltf", files.text(floor)), "--eye", "0,3,4", "--target", "0,0,0", "--fov", "35", "--size", "48x36", "--env", "builtin:sky",
             "--env-size", "64", "--env-samples", "64", "--no-background", "-q")
    bench.run("render", *words, "--backend", "reference", "--reference-textures", "full", "--samples", 512, "-o", "reference.pfm", timeout=300.0).expect(0)
    error = {}
    for name in ("box", "lean", "kappa", "leadr", "ssgt"):
        bench.run("render", *words, "--mip-filter", name, "--msaa", "8", "--technique", "mc", "--samples", 256, "-o", name + ".pfm", timeout=300.0).expect(0)
        found = json.loads(bench.run("compare", "reference.pfm", name + ".pfm", "--json", "-").expect(0).out)
        error[name] = found["flip_mean"]
    check(error["kappa"] < 0.6 * error["box"] and max(error.values()) == error["box"], f"{error}")
