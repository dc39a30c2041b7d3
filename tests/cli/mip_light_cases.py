"""Mean light of far surfaces with strong normal maps, by each mip filter, against the reference that reads all texels."""

import base64
import json
import math
import struct

from compare_cases import png
from environment_files import hdr, rgbe
from harness import case, check
from input_cases import scratch
from model_cases import read_pfm
from reference_cases import needs_embree

SIDE = 64  # texels
FILTERS = ("box", "lean", "baseline", "covariance", "leadr", "ssgt", "kappa", "mipnet")
VIEWS = {60: (0.0, 1.73, 1.0), 30: (0.7, 1.0, 1.58), 12: (-1.2, 0.42, 1.58)}  # by the eye's elevation over the plate, in degrees
FAR = ("--target", "0,0,0", "--fov", "14", "--env-size", "128", "--env-samples", "256", "--no-background", "--frame-map", "quaternion", "-q")


def chance(x, y, salt):
    h = (x * 374761393 + y * 668265263 + salt * 2246822519) & 0xFFFFFFFF
    h = ((h ^ (h >> 13)) * 1274126177) & 0xFFFFFFFF
    return (h ^ (h >> 16)) / 4294967296


def hammered(cells):
    """Bowls around scattered points, which meet in ridges."""
    def slope(u, v):
        x, y, best, found = u * cells, v * cells, 9.0, (0.0, 0.0)
        for cy in range(int(y) - 1, int(y) + 2):
            for cx in range(int(x) - 1, int(x) + 2):
                place = (cx % cells, cy % cells)
                dx, dy = x - (cx + 0.15 + 0.7 * chance(*place, 1)), y - (cy + 0.15 + 0.7 * chance(*place, 2))
                if dx * dx + dy * dy < best:
                    best, found = dx * dx + dy * dy, (1.6 * dx, 1.6 * dy)
        return found
    return slope


def knurled(diamonds):
    """Diamond-shaped pyramids, which have four slopes."""
    def slope(u, v):
        a, b = (0.8 if ((u + side * v) * diamonds) % 1 < 0.5 else -0.8 for side in (1, -1))
        return 0.5 * (a + b), 0.5 * (b - a)
    return slope


def woven(threads):
    """A plain weave of round threads."""
    def slope(u, v):
        x, y = u * threads, v * threads
        along = (int(x) + int(y)) % 2 == 0
        across = 2 * ((y if along else x) % 1) - 1
        return (0.0, across) if along else (-across, 0.0)
    return slope


def scratched(rows):
    """Grooves along u with random length and depth."""
    def slope(u, v):
        row = int(v * rows)
        along = ((u + chance(row, 0, 11)) % 1) * 2
        piece = int(along)
        deep = chance(row, piece, 13) if along - piece < 0.2 + 0.7 * chance(row, piece, 12) else 0.0
        return 0.0, -1.5 * deep * (2 * ((v * rows) % 1) - 1)
    return slope


KINDS = {"hammered": (hammered, (4, 8)), "knurled": (knurled, (4, 8)), "woven": (woven, (4, 8)), "scratched": (scratched, (8, 16))}


def code_of(sx, sy):
    length = math.sqrt(1 + sx * sx + sy * sy)
    return tuple(int(127.5 + 127.5 * n / length + 0.5) for n in (-sx, -sy, 1))


def far_plate(bench, kind, size, **material):
    """Writes a metal plate whose map repeats 64 times each way, and returns its name."""
    make, name = KINDS[kind][0](size), f"{kind}{size}"
    scratch(bench, name + ".png", png(SIDE, SIDE, lambda i, j: code_of(*make((i + 0.5) / SIDE, (j + 0.5) / SIDE))))
    columns = ((3, (-1, 0, 1, 1, 0, 1, 1, 0, -1, -1, 0, -1)), (3, (0, 1, 0) * 4), (4, (1, 0, 0, 1) * 4), (2, (0, 64, 64, 64, 64, 0, 0, 0)))
    data, views, accessors = b"", [], []
    for width, values in columns:
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": 4 * len(values)})
        accessors.append({"bufferView": len(accessors), "componentType": 5126, "count": 4, "type": f"VEC{width}"})
        data += struct.pack(f"<{len(values)}f", *values)
    accessors[0] |= {"min": [-1, 0, -1], "max": [1, 0, 1]}
    views.append({"buffer": 0, "byteOffset": len(data), "byteLength": 12})
    accessors.append({"bufferView": 4, "componentType": 5123, "count": 6, "type": "SCALAR"})
    data += struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    surface = {"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.9, 0.9, 1], "metallicFactor": 1, "roughnessFactor": 0.3}}
    gltf = {"asset": {"version": "2.0"}, "bufferViews": views, "accessors": accessors,
            "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TANGENT": 2, "TEXCOORD_0": 3}, "indices": 4, "material": 0}]}],
            "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}], "scene": 0, "images": [{"uri": name + ".png"}],
            "textures": [{"source": 0}], "materials": [{**surface, **material, "name": name, "normalTexture": {"index": 0}}]}
    scratch(bench, name + ".gltf", json.dumps(gltf))
    return name


def horizon(bench, on):
    """Returns options that turn the horizon of normal maps on or off, for every frame."""
    choice = "--horizon NAME" in bench.run("render", "--help").expect(0).out
    return ("--horizon", "on" if on else "off") if choice else ("--horizon",) if on else ()


def eye_at(elevation):
    eye = VIEWS[elevation]
    far = 4.4 / math.sqrt(sum(c * c for c in eye))
    return "--eye", ",".join(f"{c * far:.4f}" for c in eye)


def mean_light(bench, name, *words):
    bench.run("render", name + ".gltf", *FAR, *words, "-o", "m.pfm").expect(0)
    values = read_pfm(bench.folder / "m.pfm")[2]
    return sum(values) / len(values)


def reference_of(bench, name, samples, *words):
    return mean_light(bench, name, *words, "--backend", "reference", "--reference-textures", "full", "--samples", samples)


def furnace(bench):
    scratch(bench, "white.hdr", hdr(32, 16, lambda y: 32 * rgbe((1.0, 1.0, 1.0))))
    return "--env", "white.hdr"


def light_is_kept(bench, kind):
    """Constant light: each filter's mean against the reference's, at one size and for one eye, with the horizon and without."""
    needs_embree(bench)
    name, white = far_plate(bench, kind, KINDS[kind][1][0]), furnace(bench)
    for on in (False, True):
        look = (*white, *eye_at(30), "--size", "6x6", *horizon(bench, on))
        reference = reference_of(bench, name, 256, *look)
        off = {mip: mean_light(bench, name, *look, "--mip-filter", mip, "--technique", "mc", "--samples", 64) / reference - 1 for mip in FILTERS}
        print(kind, on, {mip: round(by, 3) for mip, by in off.items()})
        check(all(abs(by) < 0.1 for by in off.values()), f"{kind}, horizon {on}: {off}")


@case("mip.far_hammered_metal_keeps_its_light")
def far_hammered(bench):
    light_is_kept(bench, "hammered")


@case("mip.far_knurled_metal_keeps_its_light")
def far_knurled(bench):
    light_is_kept(bench, "knurled")


@case("mip.far_woven_metal_keeps_its_light")
def far_woven(bench):
    light_is_kept(bench, "woven")


@case("mip.far_scratched_metal_keeps_its_light")
def far_scratched(bench):
    light_is_kept(bench, "scratched")


def light_is_that_of_texels(bench, kind):
    """The whole table of a kind: both sizes, all filters, three eyes. Constant light is kept for each eye. For two environments with
    small lights the mean over eyes is kept: from one eye a sun shows details that 32 groups of normals omit."""
    needs_embree(bench)
    white, far_off = furnace(bench), []
    for size in KINDS[kind][1]:
        name = far_plate(bench, kind, size)
        for light, most in ((white, 0.07), (("--env", "builtin:studio"), 0.1), (("--env", "builtin:sky"), 0.1)):
            off = {mip: [] for mip in FILTERS}
            for elevation in VIEWS:
                look = (*light, *eye_at(elevation), "--size", "12x12", *horizon(bench, True))
                reference = reference_of(bench, name, 1024, *look)
                for mip in FILTERS:
                    off[mip].append(mean_light(bench, name, *look, "--mip-filter", mip, "--technique", "mc", "--samples", 64) / reference - 1)
            for mip, by in off.items():
                print(name, light[1], mip, *(f"{b:+.3f}" for b in by))
                if max(map(abs, by if light == white else [sum(by) / len(by)])) > most:
                    far_off.append(f"{name} {light[1]} {mip} {by}")
    check(not far_off, "\n".join(far_off))


@case("mip.mean_light_of_hammered_metal_is_that_of_its_texels", tier="nightly")
def table_hammered(bench):
    light_is_that_of_texels(bench, "hammered")


@case("mip.mean_light_of_knurled_metal_is_that_of_its_texels", tier="nightly")
def table_knurled(bench):
    light_is_that_of_texels(bench, "knurled")


@case("mip.mean_light_of_woven_metal_is_that_of_its_texels", tier="nightly")
def table_woven(bench):
    light_is_that_of_texels(bench, "woven")


@case("mip.mean_light_of_scratched_metal_is_that_of_its_texels", tier="nightly")
def table_scratched(bench):
    light_is_that_of_texels(bench, "scratched")


@case("mip.rough_metal_under_a_strong_map_keeps_its_light", tier="nightly")
def rough_metal(bench):
    """A rough lobe loses little light, and still no single lobe has the shape of many."""
    needs_embree(bench)
    for kind in ("hammered", "woven"):
        surface = {"baseColorFactor": [0.9, 0.9, 0.9, 1], "metallicFactor": 1, "roughnessFactor": 0.6}
        name = far_plate(bench, kind, KINDS[kind][1][0], pbrMetallicRoughness=surface)
        for light in ("builtin:studio", "builtin:sky"):
            for elevation in VIEWS:
                look = ("--env", light, *eye_at(elevation), "--size", "8x8")
                off = mean_light(bench, name, *look, "--mip-filter", "kappa", "--technique", "mc", "--samples", 64) / reference_of(bench, name, 1024, *look) - 1
                print(name, light, elevation, f"{off:+.3f}")
                check(abs(off) < 0.1, f"{name}, {light}, {elevation}: {off}")


@case("mip.mean_light_by_the_default_technique_is_near_that_of_texels", tier="nightly")
def default_technique(bench):
    """One round fetch stands for each group of normals, and lights smaller than its lobe are blurred: bounds hold the known error."""
    needs_embree(bench)
    far_off = []
    for kind, most in (("hammered", 0.13), ("knurled", 0.1), ("woven", 0.11), ("scratched", 0.13)):
        name = far_plate(bench, kind, KINDS[kind][1][0])
        for light in ("builtin:studio", "builtin:sky"):
            off = []
            for elevation in VIEWS:
                look = ("--env", light, *eye_at(elevation), "--size", "6x6")
                off.append(mean_light(bench, name, *look, "--mip-filter", "kappa") / reference_of(bench, name, 1024, *look) - 1)
            print(name, light, *(f"{by:+.3f}" for by in off))
            if abs(sum(off) / len(off)) > most:
                far_off.append(f"{name} {light} {off}")
    check(not far_off, "\n".join(far_off))
