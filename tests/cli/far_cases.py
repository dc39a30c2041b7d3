"""Geometry that is large beside the near plane or far from the origin: floors up to the horizon, scenes 4600 km away."""

import json
import math
import struct

import gltf_files
from harness import case, check, scratch
from model_cases import read_pfm
from parity_cases import check_equal, parity
from reference_cases import needs_embree

GREEN = (0.2, 0.6, 0.3)
NIGHT = ("--env", "builtin:night", "--env-size", "16", "--env-samples", "1", "--no-background", "--msaa", "1", "-o", "a.pfm")


def quad(corners, eye, pitch=0.0, yfov=0.7, znear=0.01, place=(0, 0, 0)):
    """Returns a glTF with one unlit green quad at `place`, and a camera at `eye` that looks down by `pitch`."""
    data = struct.pack("<12f", *(x for corner in corners for x in corner)) + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    gltf = gltf_files.triangle()
    gltf["buffers"] = [{"byteLength": len(data), "uri": gltf_files.data_uri(data)}]
    gltf["bufferViews"] = [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 12}]
    least, most = ([f(c[axis] for c in corners) for axis in range(3)] for f in (min, max))
    gltf["accessors"] = [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": least, "max": most},
                         {"bufferView": 1, "componentType": 5123, "count": 6, "type": "SCALAR"}]
    gltf["extensionsUsed"] = ["KHR_materials_unlit"]
    gltf["materials"] = [{"pbrMetallicRoughness": {"baseColorFactor": [*GREEN, 1]}, "extensions": {"KHR_materials_unlit": {}}, "doubleSided": True}]
    gltf["meshes"][0]["primitives"][0]["material"] = 0
    gltf["cameras"] = [{"type": "perspective", "perspective": {"yfov": yfov, "znear": znear}}]
    gltf["nodes"] = [{"mesh": 0, "translation": list(place)},
                     {"camera": 0, "translation": list(eye), "rotation": [-math.sin(pitch / 2), 0, 0, math.cos(pitch / 2)]}]
    gltf["scenes"] = [{"nodes": [0, 1]}]
    return json.dumps(gltf)


def skinned(text):
    """Returns this quad as a skin, bent by a joint at its node."""
    gltf = json.loads(text)
    data = struct.pack("<16B", *(0, 0, 0, 0) * 4) + struct.pack("<16f", *(1, 0, 0, 0) * 4)
    gltf["buffers"].append({"byteLength": len(data), "uri": gltf_files.data_uri(data)})
    gltf["bufferViews"] += [{"buffer": 1, "byteLength": 16}, {"buffer": 1, "byteOffset": 16, "byteLength": 64}]
    gltf["accessors"] += [{"bufferView": 2, "componentType": 5121, "count": 4, "type": "VEC4"},
                          {"bufferView": 3, "componentType": 5126, "count": 4, "type": "VEC4"}]
    gltf["meshes"][0]["primitives"][0]["attributes"].update({"JOINTS_0": 2, "WEIGHTS_0": 3})
    gltf["nodes"].append({"translation": gltf["nodes"][0].pop("translation")})
    gltf["nodes"][0]["skin"] = 0
    gltf["skins"] = [{"joints": [2]}]
    gltf["scenes"][0]["nodes"].append(2)
    return json.dumps(gltf)


def floor(half, eye=1.7, pitch=0.15, **more):
    return quad([(-half, 0, half), (half, 0, half), (half, 0, -half), (-half, 0, -half)], (0, eye, 0), pitch, **more)


def floor_is_seen(half, eye, pitch, yfov, aspect, x, y):
    """Returns True where the ray through a place, -1 to 1 over the image with y up, meets the floor."""
    up, across = y * math.tan(yfov / 2), x * aspect * math.tan(yfov / 2)
    dy, dz = up * math.cos(pitch) - math.sin(pitch), -math.cos(pitch) - up * math.sin(pitch)
    return dy < 0 and max(abs(across), abs(dz)) * eye / -dy < half


def wrong_pixels(bench, half, eye, pitch, yfov=0.7):
    """Returns the pixels of a.pfm that contradict all their corners."""
    width, height, values = read_pfm(bench.folder / "a.pfm")
    corner = [[floor_is_seen(half, eye, pitch, yfov, width / height, 2 * x / width - 1, 2 * y / height - 1) for x in range(width + 1)]
              for y in range(height + 1)]  # rows go upwards, as in the file
    wrong = 0
    for y in range(height):
        for x in range(width):
            around = {corner[y + j][x + i] for i in (0, 1) for j in (0, 1)}
            found = values[3 * (y * width + x) : 3 * (y * width + x) + 3]
            expected = GREEN if around == {True} else (0, 0, 0)
            wrong += len(around) == 1 and max(abs(a - b) for a, b in zip(found, expected)) > 1e-3
    return wrong


# Half a side, eye height, pitch, near plane, size.
FLOORS = ((5e4, 1.7, 0.15, 0.01, "640x360"), (1e5, 1.7, 0.15, 0.01, "512x512"), (2e5, 1.0, 0.9, 0.01, "96x96"), (500, 1.7, 0.3, 1e-4, "160x90"),
          (1e7, 2.0, 0.4, 0.01, "97x61"), (3e6, 500.0, 0.2, 1.0, "96x96"), (100, 1.7, 0.2, 0.01, "96x96"))


@case("geometry.floors_reach_the_horizon_at_every_size", tier="nightly")
def floors(bench):
    for half, eye, pitch, znear, size in FLOORS:
        scratch(bench, "floor.gltf", floor(half, eye, pitch, znear=znear))
        bench.run("render", "floor.gltf", "--size", size, *NIGHT, "--threads", "1").expect(0)
        wrong = wrong_pixels(bench, half, eye, pitch)
        check(wrong == 0, f"{wrong} pixels of a floor of {half} m at {size}")


@case("geometry.files_of_large_floors_are_green_below_the_horizon", tier="nightly")
def floor_files(bench):
    for name, half, eye, pitch, size in (("50km", 5e4, 1.7, 0.15, "640x360"), ("100km", 1e5, 1.7, 0.15, "512x512"),
                                         ("200km_down", 2e5, 1.0, 0.9, "96x96")):
        bench.run("render", bench.data_file(f"reports/floor_{name}.gltf"), "--size", size, *NIGHT, "--threads", "1").expect(0)
        check(wrong_pixels(bench, half, eye, pitch) == 0, f"floor_{name}.gltf at {size}")


@case("parity.large_floors_are_those_of_the_tile_renderer", tier="nightly")
def floors_on_a_device(bench):
    for half, eye, pitch, znear, size in FLOORS[1:4]:
        scratch(bench, "floor.gltf", floor(half, eye, pitch, znear=znear))
        check_equal(parity(bench, "floor.gltf", "--technique", "split_isotropic", "--msaa", "1,4", "--size", "96x64"))


PLATE = [(-1, -0.5, 0), (1, -0.6, 0.2), (0.9, 0.7, 0), (-0.8, 0.5, -0.3)]
AWAY = (4600000.0, -128.0, 1200000.0)


def places(offset):
    return [sum(pair) for pair in zip((0.25, 0.5, 3.0), offset)]


@case("geometry.far_from_the_origin_is_as_it_is_near_it", tier="nightly")
def far(bench):
    """Moves the plate and its camera. Pixels stay equal, by a camera in the file and by --eye, whose digits floats do not hold."""
    for backend in (("--backend", "tile"), ("--backend", "reference", "--samples", "4"), ("--backend", "vulkan", "--device", "lavapipe")):
        if backend[1] == "reference":
            needs_embree(bench)
        pictures = {}
        for name, offset in (("near", (0, 0, 0)), ("far", AWAY)):
            scratch(bench, "plate.gltf", quad(PLATE, places(offset), place=offset))
            eye, target = (",".join(f"{p:.9f}" for p in point) for point in (places(offset), offset))
            for way, words in (("camera", ()), ("eye", ("--eye", eye, "--target", target, "--fov", "40"))):
                done = bench.run("render", "plate.gltf", "--size", "96x64", *NIGHT, *backend, *words)
                if done.code == 77:
                    break
                done.expect(0)
                check("steps of" not in done.err, done.describe())
                pictures[name, way] = (bench.folder / "a.pfm").read_bytes()
        for way in ("camera", "eye") if pictures else ():
            check(pictures["near", way] == pictures["far", way], f"{backend[1]}: another picture by {way}")
            check(pictures["near", way].count(struct.pack("<f", GREEN[1])) > 500, f"{backend[1]}: no plate by {way}")


@case("geometry.skins_far_from_the_origin_are_as_near_it")
def far_skin(bench):
    pictures = []
    for offset in ((0, 0, 0), AWAY):
        scratch(bench, "plate.gltf", skinned(quad(PLATE, places(offset), place=offset)))
        done = bench.run("render", "plate.gltf", "--size", "96x64", *NIGHT).expect(0)
        check("steps of" not in done.err, done.describe())
        pictures.append((bench.folder / "a.pfm").read_bytes())
    check(pictures[0] == pictures[1], "another picture far away")
    check(pictures[0].count(struct.pack("<f", GREEN[1])) > 500, "no plate")


@case("geometry.digits_that_a_file_has_lost_are_warned_of")
def lost(bench):
    far_corners = [[a + b for a, b in zip(corner, AWAY)] for corner in PLATE]
    scratch(bench, "baked.gltf", quad(far_corners, places(AWAY)))
    done = bench.run("render", "baked.gltf", "--size", "32x32", *NIGHT).expect(0)
    check("steps of 0.5 m" in done.err, done.describe())
    scratch(bench, "near.gltf", quad(PLATE, places((0, 0, 0))))
    lamp = lambda x: ("--light", f"sphere:points={x},0,1:radius=0.1:radiance=1,1,1")
    done = bench.run("render", "near.gltf", *lamp("4600000.9"), "--size", "32x32", *NIGHT).expect(0)
    check("area light 'sphere'" in done.err and "steps of 0.5 m" in done.err, done.describe())
    done = bench.run("render", "near.gltf", *lamp("46.9"), "--size", "32x32", *NIGHT).expect(0)
    check("steps of" not in done.err, done.describe())
