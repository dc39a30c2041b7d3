"""KHR_materials_iridescence: in files, in both renderers, in the reference, on a device."""

import struct

import gltf_files as files
from brdf_cases import against_files
from fresnel_cases import CLOSE
from harness import case, check
from input_cases import refuse, scratch
from parity_cases import check_equal, parity
from reference_cases import needs_embree

QUAD = ("--light", "quad:points=-1,-0.2,0.1/-1,0.8,0.1/-1,0.8,0.7/-1,-0.2,0.7:radiance=5,5,5:two-sided")
PLACE = "/materials/0/extensions/KHR_materials_iridescence"


def film(textures=(), metallic=1, roughness=0.3, share=1, thickness=400, below=None, **more):
    """Returns a triangle that fills the view. textures: of iridescence, iridescenceThickness."""
    texture = files.base64.b64encode(files.png(16, 16, color=lambda x, y: (250 - 30 * (x % 4), 60 + 30 * (y % 5), 200, 255))).decode()
    gltf = files.textured("data:image/png;base64," + texture)
    own = {"iridescenceFactor": share, "iridescenceThicknessMaximum": thickness, **more,
           **{name + "Texture": {"index": 0} for name in textures}}
    gltf["materials"] = [{"pbrMetallicRoughness": {"metallicFactor": metallic, "roughnessFactor": roughness, "baseColorFactor": [0.9, 0.7, 0.5, 1]},
                          "extensions": {"KHR_materials_iridescence": own, **(below or {})}, "doubleSided": True}]
    gltf["extensionsUsed"] = ["KHR_materials_iridescence", *(below or {})]
    return gltf


def scene(bench, name, **material):
    return scratch(bench, name + ".gltf", files.text(film(**material)))


@case("film.faults_are_named_by_their_place", "input")
def faults(bench):
    for name, value in (("iridescenceFactor", 2), ("iridescenceFactor", "x"), ("iridescenceIor", 0.5), ("iridescenceThicknessMinimum", -1),
                        ("iridescenceThicknessMaximum", -1), ("iridescenceThicknessMaximum", [1])):
        refuse(bench, scene(bench, "bad", **{name: value}), needles=(PLACE + "/" + name,))
    refuse(bench, scene(bench, "bad", iridescenceTexture={"index": 3}), needles=(PLACE + "/iridescenceTexture/index",))
    refuse(bench, scene(bench, "bad", iridescenceThicknessTexture={}), needles=(PLACE + "/iridescenceThicknessTexture",))
    listed = bench.run("list", "extensions").expect(0).out
    check(any(line.split()[:2] == ["KHR_materials_iridescence", "supported"] for line in listed.splitlines()), listed)
    words = (scene(bench, "all", textures=("iridescence", "iridescenceThickness")), *CLOSE, "--strict")
    check("KHR_materials_iridescence" not in bench.run("render", *words).expect(0).err, "--strict has something to say of films")


@case("film.each_of_its_numbers_is_seen")
def seen(bench):
    full = {name: bench.figures(scene(bench, name, **material), *CLOSE)["pixel_hash"] for name, material in
            (("film", {}), ("bare", dict(share=0)), ("half", dict(share=0.5)), ("thin", dict(thickness=200)), ("dense", dict(iridescenceIor=1.8)),
             ("by share", dict(textures=("iridescence",))), ("by thickness", dict(textures=("iridescenceThickness",))),
             ("least", dict(textures=("iridescenceThickness",), iridescenceThicknessMinimum=0)), ("plastic", dict(metallic=0)))}
    check(len(set(full.values())) == len(full), f"two films give one picture: {full}")
    textured = scene(bench, "none", textures=("iridescence", "iridescenceThickness"), share=0)
    check(full["bare"] == bench.figures(textured, *CLOSE)["pixel_hash"], "a textured film without a share is seen")
    huge = bench.figures(scene(bench, "huge", thickness=3e38, iridescenceIor=3e38), *CLOSE)
    check(huge["nan_pixels"] == 0, f"{huge['nan_pixels']} pixels are no numbers")


@case("film.mc_agrees_with_the_reference", tier="nightly")
def agrees(bench):
    needs_embree(bench)
    for name, material, more in (("metal", {}, ()), ("plastic", dict(metallic=0), ()), ("half a metal", dict(metallic=0.5), ()),
                                 ("exact", dict(metallic=0), ("--fresnel", "dielectric")),
                                 ("glass", dict(metallic=0, below={"KHR_materials_transmission": {"transmissionFactor": 1}}), ()),
                                 ("mapped", dict(textures=("iridescenceThickness",)), ())):
        words = (scene(bench, name, **material), *CLOSE, "-q", "--env", "builtin:studio", *more)
        bench.run("render", *words, "--backend", "reference", "--samples", "1024", "-o", "r.pfm", "--variance", "v.pfm").expect(0)
        bench.run("render", *words, "--technique", "mc", "--samples", "16384", "-o", "mc.pfm").expect(0)
        found = against_files(bench, "r.pfm", "mc.pfm", "v.pfm")
        check(found["z_rejected_fraction"] <= 0.01, f"{name}: {found}")
    bare = scene(bench, "bare", share=0)
    bench.run("render", bare, *words[1:], "--technique", "mc", "--samples", "16384", "-o", "mc.pfm").expect(0)
    check(against_files(bench, "r.pfm", "mc.pfm", "v.pfm")["z_rejected_fraction"] > 0.1, "the test sees no film")


@case("film.devices_give_the_same_words", tier="nightly")
def devices(bench):
    mapped = scene(bench, "mapped", metallic=0.5, textures=("iridescence", "iridescenceThickness"))
    small = ("--size", "32x24", "--env", "builtin:sky")
    check_equal(parity(bench, mapped, *small, "--msaa", "4", "--technique", "auto"))
    check_equal(parity(bench, mapped, *small, "--msaa", "1", "--technique", "mc", "--samples", "4", also=[("--fresnel", "dielectric")]))
    glass = scene(bench, "glass", metallic=0, below={"KHR_materials_transmission": {"transmissionFactor": 1}})
    check_equal(parity(bench, glass, *small, "--msaa", "1", "--technique", "lobe_line"))
    check_equal(parity(bench, mapped, *small, *QUAD, "--msaa", "1", "--technique", "bent_normal"))


def prism(bench, name, dispersion):
    below = {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.6},
             "KHR_materials_dispersion": {"dispersion": dispersion}}
    return scene(bench, name, metallic=0, share=0, roughness=0.1, below=below)


@case("dispersion.is_seen_and_its_faults_are_named", "input")
def dispersed(bench):
    for value in (-1, "x", [1]):
        refuse(bench, prism(bench, "bad", value), needles=("/materials/0/extensions/KHR_materials_dispersion/dispersion",))
    words = (*CLOSE, "--strict", "--glass", "interface")
    hashes = {value: bench.figures(prism(bench, f"glass{value}", value), *words)["pixel_hash"] for value in (0, 0.5, 5, 1e30)}
    check(len(set(hashes.values())) == 4, f"{hashes}")


def octahedron(bench, name, dispersion):
    """A closed body of coloured glass."""
    corners = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0), (0, -1, 0), (0, 0, -1)]
    faces = [(0, 1, 2), (1, 3, 2), (3, 4, 2), (4, 0, 2), (1, 0, 5), (3, 1, 5), (4, 3, 5), (0, 4, 5)]
    positions, indices = struct.pack("<18f", *(c for corner in corners for c in corner)), struct.pack("<24H", *(i for face in faces for i in face))
    gltf = files.triangle(positions, indices)
    primitive = gltf["meshes"][0]["primitives"][0]
    primitive["attributes"]["NORMAL"], primitive["material"] = primitive["attributes"]["POSITION"], 0
    gltf["bufferViews"] = [{"buffer": 0, "byteLength": 72}, {"buffer": 0, "byteOffset": 72, "byteLength": 48}]
    gltf["buffers"][0]["byteLength"] = 120
    for accessor in gltf["accessors"]:
        accessor["count"] = 6 if accessor["type"] == "VEC3" else 24
        if "min" in accessor:
            accessor["min"], accessor["max"] = [-1, -1, -1], [1, 1, 1]
    below = {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.6}, "KHR_materials_dispersion": {"dispersion": dispersion},
             "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2, "attenuationColor": [0.4, 0.8, 0.6]}}
    gltf["materials"] = [{"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.1}, "extensions": below}]
    gltf["extensionsUsed"] = list(below)
    return scratch(bench, name + ".gltf", files.text(gltf))


@case("dispersion.devices_give_the_same_words", tier="nightly")
def dispersed_devices(bench):
    whole = ("--size", "64x48", "--env-size", "64", "--env-samples", "64")
    said = bench.run("render", octahedron(bench, "body", 4), *whole, "-o", "body.png").expect(0)
    check("open mesh" not in said.err, said.describe())
    check(bench.figures(octahedron(bench, "plain", 0), *whole)["pixel_hash"] != bench.figures("body.gltf", *whole)["pixel_hash"], "a body does not disperse")
    small = ("--size", "32x24", "--env", "builtin:sky", "--msaa", "1")
    for technique in ("lobe_line", "mc"):
        check_equal(parity(bench, prism(bench, "glass", 4), octahedron(bench, "body", 4), *small, "--technique", technique, "--samples", "4"))
    check_equal(parity(bench, prism(bench, "glass", 4), *small, *QUAD, "--technique", "bent_normal"))
