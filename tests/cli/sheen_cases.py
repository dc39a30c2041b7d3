"""KHR_materials_sheen: in files, in both renderers, in the reference, on a device."""

import gltf_files as files
from brdf_cases import against_files
from fresnel_cases import CLOSE
from harness import case, check
from input_cases import refuse, scratch
from model_cases import read_pfm
from parity_cases import check_equal, parity
from reference_cases import needs_embree

PLACE = "/materials/0/extensions/KHR_materials_sheen"


def worn(x, y):
    return (60 + 40 * (x % 4), 90 + 30 * (y % 4), 200, 255 - 30 * (y % 5))


def cloth(roughness=0.4, textures=(), color=(0.7, 0.4, 0.5), sheen=None, **more):
    """Returns a triangle that fills the view. textures: of sheenColor, sheenRoughness."""
    texture = files.base64.b64encode(files.png(16, 16, color=worn)).decode()
    gltf = files.textured("data:image/png;base64," + texture)
    sheen = {"sheenColorFactor": list(color), "sheenRoughnessFactor": roughness, **(sheen or {}),
             **{name + "Texture": {"index": 0} for name in textures}}
    gltf["materials"] = [{"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.7, "baseColorFactor": [0.3, 0.1, 0.1, 1]},
                          "extensions": {"KHR_materials_sheen": sheen}, "doubleSided": True, **more}]
    gltf["extensionsUsed"] = ["KHR_materials_sheen"]
    return gltf


def scene(bench, name, **material):
    return scratch(bench, name + ".gltf", files.text(cloth(**material)))


@case("sheen.faults_are_named_by_their_place", "input")
def faults(bench):
    for sheen, place in (({"sheenColorFactor": [2, 0, 0]}, "/sheenColorFactor"), ({"sheenColorFactor": 1}, "/sheenColorFactor"),
                         ({"sheenColorFactor": [0, -0.1, 0]}, "/sheenColorFactor"), ({"sheenRoughnessFactor": 1.5}, "/sheenRoughnessFactor"),
                         ({"sheenRoughnessFactor": "much"}, "/sheenRoughnessFactor"), ({"sheenColorTexture": {"index": 3}}, "/sheenColorTexture/index"),
                         ({"sheenRoughnessTexture": {}}, "/sheenRoughnessTexture")):
        refuse(bench, scene(bench, "bad", sheen=sheen), needles=(PLACE + place,))
    listed = bench.run("list", "extensions").expect(0).out
    check(any(line.split()[:2] == ["KHR_materials_sheen", "supported"] for line in listed.splitlines()), listed)
    words = (scene(bench, "all", textures=("sheenColor", "sheenRoughness")), *CLOSE, "--strict")
    check("KHR_materials_sheen" not in bench.run("render", *words).expect(0).err, "--strict has something to say of sheen")


@case("sheen.each_of_its_numbers_is_seen")
def seen(bench):
    full = {name: bench.figures(scene(bench, name, **material), *CLOSE)["pixel_hash"] for name, material in
            (("cloth", {}), ("bare", dict(color=(0, 0, 0))), ("grey", dict(color=(0.5, 0.5, 0.5))), ("smooth", dict(roughness=0.2)),
             ("by colour", dict(textures=("sheenColor",))), ("by roughness", dict(textures=("sheenRoughness",))))}
    check(len(set(full.values())) == len(full), f"two layers give one picture: {full}")
    textured = scene(bench, "none", textures=("sheenColor", "sheenRoughness"), color=(0, 0, 0))
    check(full["bare"] == bench.figures(textured, *CLOSE)["pixel_hash"], "a textured black layer is seen")


@case("sheen.area_lights_on_the_eye_s_side_are_near_their_samples")
def area_lights(bench):
    """Over a black base. A lobe about another direction gives a fraction: lights on the far side do (apps/manual/limits.md)."""
    gltf = cloth(roughness=0.5, color=(1, 1, 1))
    gltf["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = [0, 0, 0, 1]
    gltf["materials"][0]["extensions"]["KHR_materials_specular"] = {"specularFactor": 0}
    gltf["extensionsUsed"].append("KHR_materials_specular")
    black = scratch(bench, "black.gltf", files.text(gltf))
    for low in (0.2, -1.2):
        light = f"quad:points=1,{low},0.1/1,{low + 1},0.1/1,{low + 1},0.7/1,{low},0.7:radiance=5,5,5:two-sided"
        means = []
        for way in ("mc", "ltc"):
            bench.run("render", black, *CLOSE, "--env", "builtin:night", "--light", light, "--area-lights", way, "--light-samples", "1024", "-q",
                      "-o", "a.pfm").expect(0)
            values = read_pfm(bench.folder / "a.pfm")[2]
            means.append(sum(values) / len(values))
        check(0.7 < means[1] / means[0] < 1.1, f"{low}: {means}")


@case("sheen.mc_agrees_with_the_reference", tier="nightly")
def agrees(bench):
    needs_embree(bench)
    lamp = ("--light", "quad:points=-1,-0.2,0.1/-1,0.8,0.1/-1,0.8,0.7/-1,-0.2,0.7:radiance=5,5,5:two-sided", "--area-lights", "mc")
    for name, material, more in (("smooth", dict(roughness=0.15), ()), ("rough", dict(roughness=0.9), ()),
                                 ("lit", {}, (*lamp, "--light-samples", "4096", "--env", "builtin:night")),
                                 ("mapped", dict(textures=("sheenColor",)), ())):
        words = (scene(bench, name, **material), *CLOSE, "-q", "--env", "builtin:sky", *more)
        bench.run("render", *words, "--backend", "reference", "--samples", "1024", "-o", "r.pfm", "--variance", "v.pfm").expect(0)
        bench.run("render", *words, "--technique", "mc", "--samples", "16384", "-o", "mc.pfm").expect(0)
        found = against_files(bench, "r.pfm", "mc.pfm", "v.pfm")
        check(found["z_rejected_fraction"] <= 0.01, f"{name}: {found}")
    bare = scene(bench, "bare", color=(0, 0, 0))
    bench.run("render", bare, *words[1:], "--technique", "mc", "--samples", "16384", "-o", "mc.pfm").expect(0)
    check(against_files(bench, "r.pfm", "mc.pfm", "v.pfm")["z_rejected_fraction"] > 0.1, "the test sees no sheen")


@case("sheen.devices_give_the_same_words", tier="nightly")
def devices(bench):
    mapped = scene(bench, "mapped", textures=("sheenColor", "sheenRoughness"))
    small = ("--size", "32x24", "--env", "builtin:sky")
    check_equal(parity(bench, mapped, *small, "--msaa", "4", "--technique", "auto"))
    check_equal(parity(bench, mapped, *small, "--msaa", "1", "--technique", "mc", "--samples", "4", also=[("--brdf", "charlie")]))
    light = ("--light", "quad:points=-1,-0.2,0.1/-1,0.8,0.1/-1,0.8,0.7/-1,-0.2,0.7:radiance=5,5,5:two-sided")
    check_equal(parity(bench, mapped, *small, *light, "--msaa", "1", "--technique", "bent_normal"))
