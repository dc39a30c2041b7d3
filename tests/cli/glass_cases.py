"""KHR_materials_transmission: in files, by one fetch, in mc, in the reference and on a device."""

import csv
import io
import math

import gltf_files as files
from brdf_cases import against_files
from fresnel_cases import CLOSE
from harness import case, check
from input_cases import refuse, scratch
from model_cases import read_pfm
from parity_cases import check_equal, parity
from reference_cases import needs_embree

PLACE = "/materials/0/extensions/KHR_materials_"


def glass(factor=1.0, ior=1.5, texture=False, roughness=0.4, **more):
    """Returns a triangle that fills the view."""
    gltf = files.textured("data:image/png;base64," + files.base64.b64encode(files.png(4, 4)).decode())
    transmission = {"transmissionFactor": factor, **({"transmissionTexture": {"index": 0}} if texture else {})}
    extensions = {"KHR_materials_transmission": transmission, "KHR_materials_ior": {"ior": ior},
                  "KHR_materials_anisotropy": {"anisotropyStrength": 0.6}}
    gltf["materials"] = [{"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": roughness, "baseColorFactor": [0.9, 0.6, 0.3, 1]},
                          "extensions": extensions, "doubleSided": True, **more}]
    gltf["extensionsUsed"] = list(extensions)
    return gltf


def scene(bench, name, **material):
    return scratch(bench, name + ".gltf", files.text(glass(**material)))


@case("glass.faults_are_named_by_their_place", "input")
def faults(bench):
    for material, place in ((dict(factor=2), "transmission/transmissionFactor"), (dict(factor=-0.1), "transmission/transmissionFactor"),
                            (dict(factor="much"), "transmission/transmissionFactor"), (dict(ior=0.5), "ior/ior"), (dict(ior=-1), "ior/ior")):
        refuse(bench, scene(bench, "bad", **material), needles=(PLACE + place,))
    bad = glass(texture=True)
    bad["materials"][0]["extensions"]["KHR_materials_transmission"]["transmissionTexture"]["index"] = 3
    refuse(bench, scratch(bench, "bad.gltf", files.text(bad)), needles=(PLACE + "transmission/transmissionTexture/index",))
    listed = bench.run("list", "extensions").expect(0).out
    check(any(line.split()[:2] == ["KHR_materials_transmission", "supported"] for line in listed.splitlines()), listed)


@case("glass.rough_bodies_show_no_line_where_surfaces_behind_end")
def no_line(bench):
    """The frosted ball stands before the rim of the disc. A step of .2 in the logarithm is a fifth of the light, from one pixel to the next."""
    bench.run("render", "builtin:glass", "--floor", "off", "--size", "640x360", "--msaa", "1", "--env-size", "128", "--env-samples", "64", "-q", "-o", "g.pfm").expect(0)
    width, height, values = read_pfm(bench.folder / "g.pfm")

    def light(x, y):
        at = 3 * ((height - 1 - y) * width + x)
        return math.log(sum(values[at : at + 3]))

    steps, seen = [], []
    for y in range(114, 186):
        for x in range(412, 484):
            if (x - 448) ** 2 + (y - 150) ** 2 < 36 ** 2:
                seen.append(light(x, y))
                steps += [abs(seen[-1] - light(x + 1, y)), abs(seen[-1] - light(x, y + 1))]
    check(max(seen) - min(seen) > 0.7, "the ball shows nothing behind it")
    check(max(steps) < 0.2, f"the logarithm of the light steps by {max(steps)}")


@case("glass.blended_surfaces_beside_glass_are_named", "input")
def blended(bench):
    """Glass shows opaque surfaces alone behind itself."""
    gltf = glass()
    gltf["materials"].append({"name": "veil", "alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 0.5]}})
    veil = {**gltf["meshes"][0]["primitives"][0], "material": 1}
    warning = "material 'veil' is blended: glass"
    lone = scratch(bench, "lone.gltf", files.text(gltf))
    check(warning not in bench.run("render", lone, *CLOSE).expect(0).err, "a material that nothing is made of is named")
    gltf["meshes"][0]["primitives"].append(veil)
    both = scratch(bench, "both.gltf", files.text(gltf))
    check(bench.run("render", both, *CLOSE).expect(0).err.count(warning) == 1, "nothing says that glass shows no veil")


@case("glass.every_factor_changes_the_picture_of_every_technique")
def factors(bench):
    opaque_mirror = scene(bench, "opaque", ior=0, factor=0)
    for technique in ("auto", "bent_normal", "filtered_is_ggx", "mc"):
        words = (*CLOSE, "--technique", technique, "--samples", "16")
        drawn = {name: bench.figures(scene(bench, name, **material), *words)["pixel_hash"] for name, material in
                 (("clear", {}), ("none", dict(factor=0)), ("half", dict(factor=0.5)), ("textured", dict(texture=True)), ("dense", dict(ior=2.4)),
                  ("mirror", dict(ior=0)))}
        check(len(set(drawn.values())) == len(drawn), f"{technique}: two materials give one picture: {drawn}")
        check(bench.figures(opaque_mirror, *words)["pixel_hash"] == drawn["mirror"], f"{technique}: an index of 0 lets light through")


def volume(bench, name, **values):
    """Returns the triangle of glass with KHR_materials_volume."""
    gltf = glass(roughness=0)
    gltf["materials"][0]["extensions"]["KHR_materials_volume"] = values
    gltf["extensionsUsed"].append("KHR_materials_volume")
    return scratch(bench, name + ".gltf", files.text(gltf))


@case("glass.open_bodies_are_named", "input")
def open_bodies(bench):
    warning = "on an open mesh"
    plain = scene(bench, "plain", roughness=0)
    check(warning not in bench.run("render", plain, *CLOSE).expect(0).err, "glass without a volume is called open")
    absorbing = {"thicknessFactor": 0.1, "attenuationDistance": 0.01, "attenuationColor": [0.1, 0.2, 0.3]}
    asked = volume(bench, "asked", **absorbing)
    check(bench.run("render", asked, *CLOSE).expect(0).err.count(warning) == 1, "nothing says that the mesh is open")
    check(bench.figures(asked, *CLOSE)["pixel_hash"] == bench.figures(plain, *CLOSE)["pixel_hash"], "a thin sheet absorbs light")
    textured = volume(bench, "textured", thicknessFactor=0.1, thicknessTexture={"index": 0})
    check(bench.run("render", textured, *CLOSE).expect(0).err.count("the thickness texture is left out") == 1, "nothing says that it is")
    for field, value in (("thicknessFactor", -1), ("thicknessFactor", "thick"), ("attenuationDistance", -2), ("attenuationColor", [2, 0, 0])):
        refuse(bench, volume(bench, "bad", **{field: value}), needles=(PLACE + "volume/" + field,))


@case("glass.interface_is_the_plain_one_of_mc")
def interface(bench):
    words = ("builtin:glass-ball=1.5", "--size", "48x48", "--msaa", "2", "--env-size", "64", "--env-samples", "64")
    body = bench.figures(*words)["pixel_hash"]
    check(bench.figures(*words, "--glass", "interface")["pixel_hash"] != body, "--glass changes nothing")
    check(bench.figures(*words, "--threads", "1", "--tile-size", "32")["pixel_hash"] == body, "bodies depend on tiles or threads")
    check("--glass has no effect with --technique mc" in bench.run("render", *words, "--technique", "mc", "--glass", "interface").expect(0).err,
          "mc takes --glass")


@case("glass.one_fetch_is_near_the_reference", tier="nightly")
def fetched(bench):
    """Balls of clear, frosted and rough glass, with the sun behind them and without, and glass seen from within."""
    needs_embree(bench)
    for name, most, words in (("studio", 0.078, ("builtin:glass", "--env-rotation", "90")),
                              ("sun", 0.024, ("builtin:glass", "--env", "builtin:sky", "--env-rotation", "160")),
                              ("within", 0.012, ("builtin:inside-glass=1.5", "--target", "0,0,0", "--eye", "0,0.3,0.5"))):
        words = (*words, "--size", "160x90", "-q")
        bench.run("render", *words, "--backend", "reference", "--samples", "1024", "-o", "r.exr").expect(0)
        found = {}
        for technique in ("auto", "split_isotropic", "mc"):
            bench.run("render", *words, "--technique", technique, "--glass", "interface", "-o", "t.exr").expect(0)
            out = bench.run("compare", "r.exr", "t.exr", "--metric", "flip-hdr", "-q", "--csv", "-").expect(0).out
            found[technique] = float(next(csv.DictReader(io.StringIO(out)))["flip_mean"])
        print(name, found)
        check(found["auto"] <= most, f"{name}: {found}")


@case("glass.mc_agrees_with_the_reference", tier="nightly")
def agrees(bench):
    needs_embree(bench)
    lamp = ("--light", "quad:points=-1,-0.2,0.1/-1,0.8,0.1/-1,0.8,0.7/-1,-0.2,0.7:radiance=5,5,5:two-sided", "--area-lights", "mc")
    for name, more in (("lit", (*lamp, "--light-samples", "4096", "--env", "builtin:night")), ("clear", ()), ("tilted", ("--tilt", "20,-10")),
                       ("whole", ("--energy-compensation",))):
        path = scene(bench, name, factor=0.8)
        words = (path, *CLOSE, "--key-lights", "off", "-q", *more)
        bench.run("render", *words, "--backend", "reference", "--samples", "1024", "-o", "r.pfm", "--variance", "v.pfm").expect(0)
        bench.run("render", *words, "--technique", "mc", "--samples", "16384", "-o", "mc.pfm").expect(0)
        found = against_files(bench, "r.pfm", "mc.pfm", "v.pfm")
        check(found["z_rejected_fraction"] <= 0.01, f"{name}: {found}")
    bench.run("render", *words[:-1], "--technique", "mc", "--samples", "16384", "-o", "mc.pfm").expect(0)
    check(against_files(bench, "r.pfm", "mc.pfm", "v.pfm")["z_rejected_fraction"] > 0.1, "energy compensation does nothing to glass")


@case("glass.devices_give_the_same_words", tier="nightly")
def devices(bench):
    textured, smooth, dense = scene(bench, "textured", texture=True), scene(bench, "smooth", roughness=0, factor=0.5), scene(bench, "dense", ior=2.4, roughness=1)
    check_equal(parity(bench, textured, smooth, dense, "builtin:glass", "--technique", "mc,auto,filtered_is", "--samples", "4", "--size", "32x24", "--msaa", "1",
                       "--env", "builtin:sky", also=[("--tilt", "20,-10", "--energy-compensation")]))
