"""Scenes with light as a cube of images (EXT_lights_image_based)."""

import base64
import copy
import json
import struct
import zlib

import gltf_files as files
from harness import case, check, scratch
from model_cases import read_pfm

TINY_BAKE = ("--env-size", "64", "--env-samples", "16")
NAME = "EXT_lights_image_based"
COLOURS = {"+x": (1, 0, 0), "-x": (0, 1, 1), "+y": (0, 1, 0), "-y": (1, 0, 1), "+z": (0, 0, 1), "-z": (1, 1, 0)}
AWAY = {"+x": (1, 0, 0), "-x": (-1, 0, 0), "+y": (0.001, 1, 0), "-y": (0.001, -1, 0), "+z": (0, 0, 1), "-z": (0, 0, -1)}


def lit(image="data:image/png;base64,", size=8, faces=None):
    """Returns a triangle with a light of six images."""
    gltf = files.triangle()
    uris = faces or [image + base64.b64encode(files.png(size, size, color=lambda x, y, c=c: [255 * k for k in c])).decode() for c in COLOURS.values()]
    gltf["images"] = [{"uri": uri} for uri in uris]
    gltf["extensionsUsed"] = [NAME]
    gltf["scenes"][0]["extensions"] = {NAME: {"light": 0}}
    gltf["extensions"] = {NAME: {"lights": [{"irradianceCoefficients": [[1, 1, 1]] + [[0, 0, 0]] * 8, "specularImageSize": size,
                                             "specularImages": [list(range(6))]}]}}
    return gltf


def light(gltf):
    return gltf["extensions"][NAME]["lights"][0]


def seen(bench, towards, *words):
    """Returns the sky's colour in a direction, from far beside the scene."""
    eye = (50.0, 70.0, 300.0)
    target = [e + d for e, d in zip(eye, AWAY[towards])]
    at = ("--eye", ",".join(map(str, eye)), "--target", ",".join(map(str, target)), "--fov", "5")
    bench.run("render", *words, *at, "--size", "9x9", "--msaa", "1", *TINY_BAKE, "-q", "-o", "sky.pfm").expect(0)
    width, height, values = read_pfm(bench.folder / "sky.pfm")
    middle = (height // 2 * width + width // 2) * 3
    return values[middle:middle + 3]


def near(found, wanted):
    return all(abs(f - w) < 0.02 for f, w in zip(found, wanted))


@case("image_light.lights_the_scene_that_brings_it", "input", budget=5)
def lights(bench):
    model = bench.data_file("models/ibl_six_colours.glb")
    for towards, colour in COLOURS.items():
        found = seen(bench, towards, model)
        check(near(found, colour), f"towards {towards} is {found}, not {colour}")
    figures = bench.figures(model, "--size", "32x24", *TINY_BAKE, "-q")
    check(figures["env"] == str(model) and figures["warnings"] == [] and figures["ignored_extensions"] == [], f"{figures['env']} {figures['warnings']}")
    check(near(seen(bench, "+x", "builtin:plate", "--env", model), COLOURS["+x"]), "--env does not take it for another scene")
    check(not near(seen(bench, "+x", model, "--env", "builtin:night"), COLOURS["+x"]), "--env is not obeyed")
    check(near(seen(bench, "-z", model, "--env-rotation", "90"), COLOURS["+x"]), "--env-rotation does not turn it")
    profiled = json.loads(bench.run("profile", model, "--size", "32x24", "--frames", "1", *TINY_BAKE, "-q", "--json", "-").expect(0).out)
    check(profiled["env"] == str(model), f"profile has {profiled['env']}")
    told = json.loads(bench.run("info", "--json", "--env", model).expect(0).out)["environment"]
    mean = sum(w for w in (0.2126, 0.7152, 0.0722)) / 2  # each channel shines on half of the faces
    check(abs(told["mean_radiance"] - mean) < 0.005, f"{told}")


@case("image_light.rotation_intensity_and_divisors_are_taken", "input")
def taken(bench):
    gltf = lit()
    light(gltf)["rotation"], light(gltf)["intensity"] = [0, 0.5 ** 0.5, 0, 0.5 ** 0.5], 3
    scratch(bench, "turned.gltf", files.text(gltf))
    found = seen(bench, "-z", "turned.gltf")  # a quarter turn about +Y, counter-clockwise from above
    check(near(found, (3, 0, 0)), f"turned and three times as bright it is {found}")
    rgba = b"\x89PNG\r\n\x1a\n"
    for kind, data in ((b"IHDR", struct.pack(">IIBBBBB", 8, 8, 8, 6, 0, 0, 0)), (b"IDAT", zlib.compress((b"\0" + b"\xff\xff\0\x33" * 8) * 8)), (b"IEND", b"")):
        rgba += struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    scratch(bench, "bright.png", rgba)
    scratch(bench, "divided.gltf", files.text(lit(faces=["bright.png"] * 6)))
    found = seen(bench, "+y", "divided.gltf")
    check(near(found, (5, 5, 0)), f"RGBD of .2 is {found}")
    done = bench.run("render", "builtin:plate", "--env", "divided.gltf", "-o", "bright.png").expect(2)
    check("bright.png" in done.err and (bench.folder / "bright.png").read_bytes() == rgba, f"a face was written over\n{done.describe()}")
    scratch(bench, "row2.png", rgba)
    scratch(bench, "row.gltf", files.text(lit(faces=["row2.png"] * 6)))
    done = bench.run("render", "builtin:plate", "--env", "row.gltf", "--size", "16x12", *TINY_BAKE, "--turntable", "3", "-o", "row%d.png").expect(2)
    check("row2.png" in done.err and (bench.folder / "row2.png").read_bytes() == rgba, f"a row wrote over a face\n{done.describe()}")


def broken():
    place = f"/extensions/{NAME}/lights/0"

    def one(name, where, edit):
        gltf = copy.deepcopy(lit())
        edit(gltf)
        return name, where, gltf

    def drop(key):
        return lambda g: light(g).pop(key)

    def put(key, value):
        return lambda g: light(g).__setitem__(key, value)

    yield one("no_coefficients", place, drop("irradianceCoefficients"))
    yield one("eight_coefficients", place + "/irradianceCoefficients", put("irradianceCoefficients", [[0, 0, 0]] * 8))
    yield one("a_coefficient_of_two", place + "/irradianceCoefficients/3", put("irradianceCoefficients", [[0, 0, 0]] * 3 + [[0, 0]] + [[0, 0, 0]] * 5))
    yield one("no_images", place, drop("specularImages"))
    yield one("images_of_no_level", place + "/specularImages", put("specularImages", []))
    yield one("images_as_a_number", place + "/specularImages", put("specularImages", 3))
    yield one("five_faces", place + "/specularImages/0", put("specularImages", [[0, 1, 2, 3, 4]]))
    yield one("a_face_that_is_not", place + "/specularImages/0/5", put("specularImages", [[0, 1, 2, 3, 4, 6]]))
    yield one("more_levels_than_texels", place + "/specularImages", put("specularImages", [list(range(6))] * 5))
    yield one("no_size", place, drop("specularImageSize"))
    yield one("another_size", place + "/specularImages/0/0", put("specularImageSize", 16))
    yield one("a_size_beyond_the_limit", place + "/specularImageSize", put("specularImageSize", 4096))
    yield one("negative_intensity", place + "/intensity", put("intensity", -1))
    yield one("no_rotation", place + "/rotation", put("rotation", [0, 0, 0, 0]))
    yield one("a_light_that_is_not", f"/scenes/0/extensions/{NAME}/light", lambda g: g["scenes"][0]["extensions"][NAME].update(light=1))
    yield one("a_scene_without_index", f"/scenes/0/extensions/{NAME}", lambda g: g["scenes"][0]["extensions"][NAME].clear())


@case("image_light.what_is_wrong_is_told_by_its_place", "input")
def refused(bench):
    for name, where, gltf in broken():
        scratch(bench, f"{name}.gltf", files.text(gltf))
        bench.run("render", f"{name}.gltf", "--size", "16x16", *TINY_BAKE, "-q", "-o", "o.png").expect(4).expect_one_line(f"{name}.gltf: {where}: ")
        check(not (bench.folder / "o.png").exists(), f"{name}: a picture was written")
    scratch(bench, "plain.gltf", files.text(files.triangle()))
    bench.run("render", "--env", "plain.gltf", "-o", "o.png").expect(4).expect_one_line("no image-based light")
    odd = lit(size=6)
    scratch(bench, "odd.gltf", files.text(odd))
    done = bench.run("render", "odd.gltf", "--size", "16x16", *TINY_BAKE).expect(0)
    check(done.err.count("is no power of two") == 1, done.describe())
    bench.run("render", "odd.gltf", "--strict", "-o", "o.png").expect(4).expect_one_line("/specularImageSize")
    scratch(bench, "fine.gltf", files.text(lit()))
    bench.run("render", "fine.gltf", "--strict", "--size", "16x16", *TINY_BAKE, "-q").expect(0)
