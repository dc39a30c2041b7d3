"""--fresnel and extras.burnish.conductor: reflectances by Fresnel's equations, from files, in mc, in the reference, on a device."""

import gltf_files as files
from brdf_cases import against_files
from harness import case, check
from input_cases import refuse, scratch
from parity_cases import check_equal, parity
from reference_cases import needs_embree

GOLD = {"eta": [0.143, 0.375, 1.44], "k": [3.98, 2.39, 1.60]}
# A grazing view, where the laws' reflectances differ most.
CLOSE = ("--eye", "0.85,0.3,0.28", "--target", "0,0.3,0", "--fov", "8", "--size", "24x24", "--msaa", "1", "--no-background",
         "--env-size", "64", "--env-samples", "64")


def triangle_of(conductor=None, metallic=1.0, color=0.4, **more):
    """Returns a triangle that fills the view, with a rough material."""
    gltf = files.triangle()
    gltf["meshes"][0]["primitives"][0]["material"] = 0
    material = {"pbrMetallicRoughness": {"metallicFactor": metallic, "roughnessFactor": 0.5, "baseColorFactor": [color, color, color, 1]}, **more}
    if conductor is not None:
        material["extras"] = {"burnish": {"conductor": conductor}}
    gltf["materials"] = [material]
    return gltf


@case("fresnel.faults_of_a_conductor_are_named_by_their_place", "input")
def faults(bench):
    at = "/materials/0/extras/burnish"
    for conductor, places in ((dict(eta=GOLD["eta"]), (at + "/conductor", '"k" is missing')), (dict(k=GOLD["k"]), (at + "/conductor", '"eta" is missing')),
                              ({}, (at + "/conductor",)), ("gold", (at + "/conductor",)), (dict(GOLD, eta=1.5), (at + "/conductor/eta",)),
                              (dict(GOLD, k=[1, 2]), (at + "/conductor/k",)), (dict(GOLD, k=[1, 2, "3"]), (at + "/conductor/k/2",)),
                              (dict(GOLD, eta=[1, -1, 1]), (at + "/conductor/eta/1",)), (dict(GOLD, k=[1, 2, 1e9]), (at + "/conductor/k/2",))):
        refuse(bench, scratch(bench, "bad.gltf", files.text(triangle_of(conductor))), needles=places)
    refuse(bench, scratch(bench, "bad.gltf", files.text(triangle_of(extras={"burnish": 3}))), needles=(at,))
    for others in ("words", 7, ["a"], {"burn": 1}, {"burnish": {}}, {"conductor": "gold"}): # extras of other programs
        bench.run("render", scratch(bench, "good.gltf", files.text(triangle_of(extras=others))), *CLOSE, "--technique", "bent_normal").expect(0)
    bench.run("render", "--fresnel", "exact").expect(2).expect_one_line("--fresnel", "schlick", "conductor", "dielectric")


@case("fresnel.a_law_changes_what_it_names")
def laws(bench):
    hashes = {}
    for name, gltf in (("gold", triangle_of(GOLD)), ("plain", triangle_of()), ("glass", triangle_of(metallic=0.0))):
        scratch(bench, name + ".gltf", files.text(gltf))
        for law in ("schlick", "conductor", "dielectric", None):
            hashes[name, law] = bench.figures(name + ".gltf", *CLOSE, "--technique", "mc", "--samples", "16", *(("--fresnel", law) if law else ()))["pixel_hash"]
        check(hashes[name, None] == hashes[name, "schlick"], f"{name}: schlick is not what is taken where nothing is said")
    check(hashes["gold", None] == hashes["plain", None], "an index changes pictures that do not ask for it")
    check(hashes["gold", "conductor"] != hashes["gold", "schlick"], "an index changes nothing")
    check(hashes["glass", "dielectric"] == hashes["glass", "conductor"] != hashes["glass", "schlick"], f"{hashes}")


@case("fresnel.mc_agrees_with_the_reference", tier="nightly")
def agrees(bench):
    needs_embree(bench)
    for name, gltf in (("gold", triangle_of(GOLD)), ("mixture", triangle_of(GOLD, metallic=0.5)), ("glass", triangle_of(metallic=0.0, color=0.0))):
        scene = scratch(bench, name + ".gltf", files.text(gltf))
        for law in ("conductor", "dielectric"):
            words = (scene, *CLOSE, "--key-lights", "off", "-q", "--fresnel", law)
            bench.run("render", *words, "--backend", "reference", "--samples", "1024", "-o", "r.pfm", "--variance", "v.pfm").expect(0)
            bench.run("render", *words, "--technique", "mc", "--samples", "16384", "-o", "mc.pfm").expect(0)
            found = against_files(bench, "r.pfm", "mc.pfm", "v.pfm")
            check(found["z_rejected_fraction"] <= 0.01, f"{name}, {law}: {found}")
    bench.run("render", *words[:-1], "schlick", "--technique", "mc", "--samples", "16384", "-o", "mc.pfm").expect(0)
    check(against_files(bench, "r.pfm", "mc.pfm", "v.pfm")["z_rejected_fraction"] > 0.1, "Schlick's approximation passes for exact dielectrics")


@case("fresnel.devices_give_the_same_words", tier="nightly")
def devices(bench):
    mixed = triangle_of(GOLD, metallic=0.5, extensions={"KHR_materials_ior": {"ior": 2.1}, "KHR_materials_anisotropy": {"anisotropyStrength": 0.7}})
    mixed["extensionsUsed"] = ["KHR_materials_ior", "KHR_materials_anisotropy"]
    scene = scratch(bench, "mixed.gltf", files.text(mixed))
    lights = bench.data_file("models/Lights.glb")
    check_equal(parity(bench, scene, lights, "--fresnel", "conductor", "--technique", "all", "--samples", "9", "--size", "48x32", "--msaa", "1",
                       "--env", "builtin:sky", "--energy-compensation", also=[("--fresnel", "dielectric")]))
