"""extras.burnish.tilt and tiltTexture: lobes that a file tilts against their surface, in every technique, in the reference, on a device."""

import base64
import json

import gltf_files as files
from brdf_cases import against_files
from fresnel_cases import triangle_of
from harness import case, check
from input_cases import refuse, scratch
from parity_cases import check_equal, parity
from reference_cases import needs_embree

VIEW = ("--eye", "0.5,0.8,1", "--target", "0,0.3,0", "--fov", "12", "--size", "24x24", "--msaa", "1", "--no-background",
        "--env-size", "64", "--env-samples", "64", "--key-lights", "off")
GRAIN = {"extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 0.7, "anisotropyRotation": 0.4}}}


def tilted(tilt, **more):
    gltf = triangle_of(**GRAIN, **({} if tilt is None else {"extras": {"burnish": {"tilt": tilt}}}), **more)
    gltf["extensionsUsed"] = ["KHR_materials_anisotropy"]
    return gltf


def beside_another(tilt):
    """Returns a tilted triangle and, above it, one without tilt."""
    gltf = tilted(tilt)
    gltf["materials"].append({key: value for key, value in gltf["materials"][0].items() if key != "extras"})
    gltf["meshes"].append({"primitives": [dict(gltf["meshes"][0]["primitives"][0], material=1)]})
    gltf["nodes"].append({"mesh": 1, "translation": [0, 1.05, 0]})
    gltf["scenes"][0]["nodes"].append(1)
    return gltf


@case("tilt.faults_are_named_by_their_place", "input")
def faults(bench):
    at = "/materials/0/extras/burnish/tilt"
    for tilt, place in ((3, at), ([1], at), ([1, 2, 3], at), ("1,2", at), ([1, "2"], at + "/1"), ([81, 0], at + "/0"), ([0, -80.5], at + "/1")):
        refuse(bench, scratch(bench, "bad.gltf", files.text(tilted(tilt))), needles=(place,))


@case("tilt.of_a_file_is_that_of_the_option")
def same(bench):
    for name, tilt in (("plain", None), ("level", [0, 0]), ("tilted", [20, -10]), ("half", [10, -5]), ("steep", [80, 0])):
        scratch(bench, name + ".gltf", files.text(tilted(tilt)))
    for technique in ("auto", "major_axis", "filtered_is", "mc"):
        words = (*VIEW, "--technique", technique, "--samples", "16")
        plain, option = (bench.figures("plain.gltf", *words, *more)["pixel_hash"] for more in ((), ("--tilt", "20,-10")))
        check(plain != option, f"{technique}: --tilt changes nothing")
        check(bench.figures("tilted.gltf", *words)["pixel_hash"] == option, f"{technique}: extras.burnish.tilt is not --tilt")
        check(bench.figures("level.gltf", *words)["pixel_hash"] == plain, f"{technique}: no tilt is one")
        check(bench.figures("half.gltf", *words, "--tilt", "10,-5")["pixel_hash"] == option, f"{technique}: tilts are not added")
        check(bench.figures("tilted.gltf", *words, "--tilt=-20,10")["pixel_hash"] == plain, f"{technique}: tilts that cancel leave something")
        check(bench.figures("steep.gltf", *words, "--tilt", "40,0")["pixel_hash"] == bench.figures("plain.gltf", *words, "--tilt", "80,0")["pixel_hash"],
              f"{technique}: a sum is not held below the horizon")


# A neighbouring material keeps its look, drawn by the tiltable lobe.
@case("tilt.is_of_one_material_alone")
def alone(bench):
    for technique in ("auto", "filtered_is_ggx", "mc"):
        words = (*VIEW, "--target", "0,1.3,0", "--technique", technique, "--samples", "64", "--roughness", "0.5", "-q")
        for name, tilt in (("plain", None), ("tilted", [25, -15])):
            bench.run("render", scratch(bench, name + ".gltf", files.text(beside_another(tilt))), *words, "-o", name + ".pfm").expect(0)
        bench.run("compare", "plain.pfm", "tilted.pfm", "--metric", "max", "--json", "c.json", "-q").expect(0)
        off = json.loads((bench.folder / "c.json").read_text())
        check(off["max_abs"] < 1e-3, f"{technique}: a material is tilted by its neighbour: {off}")


@case("tilt.is_refused_by_models_that_cannot_be_tilted")
def refusals(bench):
    scene = scratch(bench, "tilted.gltf", files.text(tilted([5, 0])))
    for words in (("--technique", "mc"), ("--backend", "reference")):
        bench.run("render", scene, *VIEW, *words, "--brdf", "ward", "-q", "-o", "a.exr").expect(2).expect_one_line("--brdf", "ward", "ellipsoid_correlated")
    bench.run("render", scene, *VIEW, "--technique", "mc", "--brdf", "ward", "--tilt=-5,0", "-o", "a.pfm").expect(2).expect_one_line("--tilt", "ward")
    bench.run("render", scene, *VIEW, "--technique", "mc", "--brdf", "ellipsoid", "-o", "a.pfm").expect(0)


@case("tilt.is_seen_by_the_reference")
def agrees(bench):
    needs_embree(bench)
    for name, tilt in (("plain", None), ("tilted", [20, -10])):
        scratch(bench, name + ".gltf", files.text(tilted(tilt)))
    sampled = ("--backend", "reference", "--samples", "1024", "-q", "--variance", "v.pfm")
    bench.run("render", "tilted.gltf", *VIEW, *sampled, "-o", "r.pfm").expect(0)
    for name, agree in (("tilted", True), ("plain", False)):
        bench.run("render", name + ".gltf", *VIEW, "--technique", "mc", "--samples", "16384", "-q", "-o", "mc.pfm").expect(0)
        found = against_files(bench, "r.pfm", "mc.pfm", "v.pfm")
        check((found["z_rejected_fraction"] <= 0.01) == agree, f"{name}: {found}")


def mapped(*names, transform=None):
    """Returns a triangle with checkered maps, many checks to a pixel: tilts, directions, roughness."""
    colors = {"tilt": lambda x, y: ((255, 40, 0), (1, 200, 0))[(x + y) % 2], "grain": lambda x, y: ((255, 128, 255), (128, 255, 100))[x % 2],
              "rough": lambda x, y: (0, (51, 204)[(x + y) % 2], 255)}
    picture = lambda name: "data:image/png;base64," + base64.b64encode(files.png(64, 64, color=colors[name])).decode()
    gltf = files.textured(picture("rough"))
    material = {"pbrMetallicRoughness": {"roughnessFactor": 0.9}, "extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 0.8}}}
    gltf["images"], gltf["textures"] = ([{"uri": picture(name)} for name in names], [{"source": i} for i in range(len(names))])
    for i, name in enumerate(names):
        info = {"index": i}
        if name == transform:
            info["extensions"] = {"KHR_texture_transform": {"scale": [2, 2]}}
        if name == "tilt":
            material["extras"] = {"burnish": {"tiltTexture": dict(info, scale=0.3)}}
        elif name == "grain":
            material["extensions"]["KHR_materials_anisotropy"]["anisotropyTexture"] = info
        else:
            material["pbrMetallicRoughness"]["metallicRoughnessTexture"] = info
    gltf["materials"] = [material]
    gltf["extensionsUsed"] = ["KHR_materials_anisotropy", "KHR_texture_transform"]
    return gltf


@case("tilt.faults_of_a_map_are_named_by_their_place", "input")
def map_faults(bench):
    at = "/materials/0/extras/burnish/tiltTexture"
    for info, place in ((3, at), ({}, at), ({"index": 7}, at + "/index"), ({"index": 0, "scale": "1"}, at + "/scale"),
                        ({"index": 0, "texCoord": -1}, at + "/texCoord")):
        gltf = mapped("tilt")
        gltf["materials"][0]["extras"]["burnish"]["tiltTexture"] = info
        refuse(bench, scratch(bench, "bad.gltf", files.text(gltf)), needles=(place,))


@case("tilt.maps_give_the_same_words_on_devices", tier="nightly")
def map_devices(bench):
    scenes = [scratch(bench, "-".join(names) + ".gltf", files.text(mapped(*names)))
              for names in (("tilt",), ("tilt", "grain"), ("grain", "rough"), ("tilt", "grain", "rough"))]
    common = ("--samples", "9", "--size", "48x32", "--msaa", "1", "--env", "builtin:sky", "--technique")
    check_equal(parity(bench, *scenes, *common, "auto", also=(("--technique", "mc", "--tilt", "5,5"), ("--roughness", "0.4"), ("--anisotropy", "0.6"))))


@case("tilt.devices_give_the_same_words", tier="nightly")
def devices(bench):
    scene = scratch(bench, "both.gltf", files.text(beside_another([20, -10])))
    check_equal(parity(bench, scene, "--samples", "9", "--size", "48x32", "--msaa", "1", "--env", "builtin:sky", "--technique", "auto",
                       also=(("--technique", "filtered_is", "--tilt", "5,5", "--energy-compensation"), ("--technique", "mc", "--masking", "separable"))))
