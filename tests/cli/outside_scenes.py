"""Scenes of the integrals from outside: plates, balls, lamps and skies, as glTF, and the renderers' pictures of them."""

import base64
import math
import struct

import environment_files
from gltf_files import data_uri, text
from harness import check
from model_cases import read_pfm
from outside_integrals import cross, times, two_lobes, unit, white

NEAREST = 9728
REPEATED = 10497


def plate(half=4.0, hand=1.0, texels=1):
    """Corners and faces of a square about the origin that faces +z, with its tangent along +x. u runs from 0 to 1 over -1 to 1 of x."""
    corners = [(x, y, 0, 0, 0, 1, 1, 0, 0, hand, 0.5 + 0.5 * x, 0.5 - 0.5 * y) for x, y in ((-half, -half), (half, -half), (half, half), (-half, half))]
    return corners, [0, 1, 2, 0, 2, 3]


def ball(rows=64, towards_pole=False):
    """A ball of radius 1 about the origin, whose tangents run about +y, or about +z."""
    corners, faces = [], []
    turn = (lambda x, y, z: (x, -z, y)) if towards_pole else (lambda x, y, z: (x, y, z))
    around = 2 * rows
    for j in range(rows + 1):
        for i in range(around + 1):
            e, a = math.pi * (j / rows - 0.5), 2.0 * math.pi * i / around
            n = (math.cos(e) * math.sin(a), math.sin(e), math.cos(e) * math.cos(a))
            corners.append((*turn(*n), *turn(*n), *turn(math.cos(a), 0, -math.sin(a)), 1, i / around, 1 - j / rows))
    for j in range(rows):
        for i in range(around):
            k = (around + 1) * j + i
            faces += [k, k + 1, k + around + 2, k, k + around + 2, k + around + 1]
    return corners, faces


def rectangle(low, high, z):
    """Of two corners, at a height, facing down."""
    corners = [(x, y, z, 0, 0, -1, 1, 0, 0, 1, 0, 0) for x, y in ((low[0], low[1]), (low[0], high[1]), (high[0], high[1]), (high[0], low[1]))]
    return corners, [0, 1, 2, 0, 2, 3]


def texture(picture):
    return "data:image/png;base64," + base64.b64encode(picture).decode()


def scene(parts, eye, window, lamps=(), images=()):
    """parts: [((corners, faces), material)]. An orthographic camera looks along -eye at the origin; window: half its width, half its height, of the
    picture's proportions.
    lamps: extras.burnish.areaLight. images: PNGs, a texture each, without filters."""
    gltf = {"asset": {"version": "2.0"}, "scene": 0, "nodes": [], "meshes": [], "accessors": [], "bufferViews": [], "buffers": [], "materials": []}
    for (corners, faces), material in parts:
        data = b"".join(struct.pack("<12f", *c) for c in corners) + struct.pack(f"<{len(faces)}H", *faces)
        at, views, count = len(gltf["accessors"]), len(gltf["bufferViews"]), len(corners)
        gltf["buffers"].append({"byteLength": len(data), "uri": data_uri(data)})
        buffer = len(gltf["buffers"]) - 1
        gltf["bufferViews"] += [{"buffer": buffer, "byteLength": 48 * count, "byteStride": 48},
                                {"buffer": buffer, "byteOffset": 48 * count, "byteLength": 2 * len(faces)}]
        of = lambda offset, kind, **more: {"bufferView": views, "byteOffset": offset, "componentType": 5126, "count": count, "type": kind, **more}
        low, high = ([float(f(c[k] for c in corners)) for k in range(3)] for f in (min, max))
        low, high = ([struct.unpack("<f", struct.pack("<f", v))[0] for v in bound] for bound in (low, high))
        gltf["accessors"] += [of(0, "VEC3", min=low, max=high), of(12, "VEC3"), of(24, "VEC4"), of(40, "VEC2"),
                              {"bufferView": views + 1, "componentType": 5123, "count": len(faces), "type": "SCALAR"}]
        gltf["materials"].append(material)
        gltf["nodes"].append({"mesh": len(gltf["meshes"])})
        gltf["meshes"].append({"primitives": [{"attributes": {"POSITION": at, "NORMAL": at + 1, "TANGENT": at + 2, "TEXCOORD_0": at + 3},
                                               "indices": at + 4, "material": len(gltf["materials"]) - 1}]})
    x = unit(cross((0.0, 1.0, 0.0), eye))
    y = cross(eye, x)
    gltf["nodes"].append({"camera": 0, "matrix": [*x, 0, *y, 0, *eye, 0, *times(eye, 20.0), 1]})
    gltf["cameras"] = [{"type": "orthographic", "orthographic": {"xmag": window[0], "ymag": window[1], "znear": 0.1, "zfar": 40}}]
    gltf["nodes"] += [{"extras": {"burnish": {"areaLight": lamp}}} for lamp in lamps]
    if images:
        gltf["images"] = [{"uri": texture(picture)} for picture in images]
        gltf["samplers"] = [{"magFilter": NEAREST, "minFilter": NEAREST, "wrapS": REPEATED, "wrapT": REPEATED}]
        gltf["textures"] = [{"source": k, "sampler": 0} for k in range(len(images))]
    used = sorted({name for material in gltf["materials"] for name in material.get("extensions", {})})
    gltf["scenes"] = [{"nodes": list(range(len(gltf["nodes"])))}]
    return text({**gltf, **({"extensionsUsed": used} if used else {})})


def material(metal=None, diffuse=None, roughness=1.0, strength=0.0, rotation=0.0, **more):
    """metal, diffuse: the colour of one or of the other; a diffuse one has no lobe at all."""
    m = {"pbrMetallicRoughness": {"baseColorFactor": [*(metal or diffuse), 1], "metallicFactor": 1 if metal else 0, "roughnessFactor": roughness}}
    extensions = {}
    if diffuse:
        extensions["KHR_materials_specular"] = {"specularFactor": 0}
    if strength:
        extensions["KHR_materials_anisotropy"] = {"anisotropyStrength": strength, "anisotropyRotation": math.radians(rotation)}
    extensions.update(more.pop("extensions", {}))
    return {**m, **more, **({"extensions": extensions} if extensions else {})}


def quad(points, radiance):
    return {"shape": "quad", "points": [v for p in points for v in p], "radiance": list(radiance)}


def disk(centre, one, other, radiance):
    return {"shape": "disk", "points": [*centre, *one, *other], "radiance": list(radiance)}


def sphere(centre, radius, radiance):
    return {"shape": "sphere", "points": list(centre), "radius": radius, "radiance": list(radiance)}


# ---- skies as files ---------------------------------------------------------------------------------------------------------------------------

WIDE = 256


def direction(x, y):
    """The middle of a texel: +X is the picture's middle, +Y is up."""
    theta, phi = math.pi * (y + 0.5) / (WIDE // 2), 2.0 * math.pi * ((x + 0.5) / WIDE - 0.5)
    return math.sin(theta) * math.cos(phi), math.cos(theta), math.sin(theta) * math.sin(phi)


def sky_file(bench, sky):
    path = bench.folder / f"{sky.__name__}.exr"
    if not path.exists():
        small = sky in (white, black)
        path.write_bytes(environment_files.exr(16, 8, lambda *_: sky(None)) if small else
                         environment_files.exr(WIDE, WIDE // 2, lambda x, y: sky(direction(x, y))))
    return path.name


def black(_):
    return 0.0, 0.0, 0.0


# ---- pictures -----------------------------------------------------------------------------------------------------------------------------------

# Ways to draw under a lamp or a sky.
REFERENCE = ("--backend", "reference")
SHADOWED = (*REFERENCE, "--reference-mode", "shadowed")
PATH = (*REFERENCE, "--reference-mode", "path")
COSINES = ("--technique", "bent_normal", "--area-lights", "ltc")
POINTS = ("--technique", "bent_normal", "--area-lights", "mc", "--light-samples", "1024")
MC = ("--technique", "mc")


def drawn(bench, text_of, sky, way, size, samples, stripes=1):
    """[(mean colour, standard error)] of the picture's stripes from left to right; the tile renderer's error is not known."""
    (bench.folder / "scene.gltf").write_text(text_of)
    words = ["scene.gltf", "--env", sky_file(bench, sky), "--env-size", "64", "--env-samples", "16", "--size", size, "--no-background", "--threads", "1", "-q",
             *way, "-o", "a.pfm"]
    by_reference = "reference" in way
    if by_reference or "mc" in way:
        words += ["--samples", str(samples)]
    if by_reference:
        words += ["--variance", "v.pfm"]
    bench.run("render", *words).expect(0)
    width, height, values = read_pfm(bench.folder / "a.pfm")
    spread = read_pfm(bench.folder / "v.pfm")[2] if by_reference else (0.0,) * len(values)
    found = []
    for k in range(stripes):
        at = [3 * (y * width + x) for y in range(height) for x in range(k * width // stripes, (k + 1) * width // stripes)]
        mean = [sum(values[i + c] for i in at) / len(at) for c in range(3)]
        found.append((mean, [math.sqrt(sum(spread[i + c] for i in at)) / len(at) for c in range(3)]))
    return found


def is_near(found, error, expected, bound):
    return all(abs(a - x) <= bound * x + 4.5 * e + 1e-9 for a, e, x in zip(found, error, expected))


def check_near(name, found, expected, bound=0.003):
    """Within the bound and chance of the expected colour; 2 % beside it would be too far, but for wider bounds."""
    mean, error = found
    off = ["%+.3f+-%.3f" % (100.0 * (a / x - 1.0), 100.0 * e / x) for a, e, x in zip(mean, error, expected)]
    print(f"{name}: {' '.join('%.5g' % x for x in expected)}, off by {' '.join(off)} %", flush=True)
    check(is_near(mean, error, expected, bound), f"{name}: {mean} for {expected}, standard error {error}")
    check(bound > 0.02 or not is_near(mean, error, [1.02 * x for x in expected], bound), f"{name}: 2 % would not be seen")
