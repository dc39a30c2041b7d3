"""Small scenes that Cycles drew as well (cycles_record.py). Each is plain data, which both renderers' files are made from."""

import math

import outside_scenes as drawing
from gltf_files import png
from outside_integrals import unit, two_lobes, white

WHITE = (1.0, 1.0, 1.0)
PAINT = (0.8, 0.5, 0.2)
FRONT = (0.0, 0.0, 1.0)
ABOVE = unit((0.2, -0.6, 0.8))
LAMP = (3.0, 2.0, 1.0)
# Balls are seen within their outline. At the outline Cycles loses up to 1 % where corners of the mesh share normals.
INSIDE = 0.65


def moved(shape, scale=1.0, by=(0.0, 0.0, 0.0)):
    """Returns a mesh with positions scaled and moved. Normals and tangents stay."""
    corners, faces = shape
    return [(*(scale * c[k] + by[k] for k in range(3)), *c[3:]) for c in corners], faces


def walls():
    """Returns a room of five walls, whose front is open: x and y in [-1, 1], z in [-1, 1]."""
    corners, faces = [], []
    for normal, tangent in (((1, 0, 0), (0, 1, 0)), ((-1, 0, 0), (0, 0, 1)), ((0, 1, 0), (0, 0, 1)), ((0, -1, 0), (1, 0, 0)), ((0, 0, 1), (1, 0, 0))):
        other = drawing.cross(normal, tangent)
        first = len(corners)
        for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
            place = tuple(s * a + t * b - n for a, b, n in zip(tangent, other, normal))
            corners.append((*map(float, place), *map(float, normal), *map(float, tangent), 1.0, 0.5 + 0.5 * s, 0.5 - 0.5 * t))
        faces += [first, first + 1, first + 2, first, first + 2, first + 3]
    return corners, faces


def metal(roughness, strength=0.0, rotation=0.0, **more):
    """White metal, whose reflectance is 1 at every angle: Cycles has no Fresnel term by Schlick."""
    return {"kind": "metal", "colour": WHITE, "roughness": roughness, "strength": strength, "rotation": rotation, **more}


def diffuse(colour=PAINT, **more):
    return {"kind": "diffuse", "colour": colour, "roughness": 1.0, **more}


# Paint has no normal map here: Cycles darkens it on purpose, to hide the edges of shadows.
# Parts: (mesh, material). Lamps are rectangles: centre, half edges a and b, radiance; they shine along a x b.
# roughness_codes, normal_code: 8-bit texels of a texture. sky: a function of the direction.
SCENES = {
    "brushed ball": {"parts": [(drawing.ball(), metal(0.45, 0.7, 20.0))], "eye": FRONT, "window": INSIDE, "sky": two_lobes},
    "ball with a roughness texture": {"parts": [(drawing.ball(), metal(0.9, roughness_codes=(70, 110, 170, 240)))], "eye": FRONT, "window": INSIDE,
                                      "sky": two_lobes},
    "metal ball with a normal map": {"parts": [(drawing.ball(), metal(0.4, normal_code=(165, 150, 240)))], "eye": FRONT, "window": INSIDE,
                                     "sky": two_lobes},
    "paint ball over a brushed plate": {"parts": [(drawing.plate(2.0), metal(0.3, 0.6, 30.0)), (moved(drawing.ball(), 0.5, (0.2, 0.1, 0.7)), diffuse())],
                                        "eye": ABOVE, "window": 1.2, "sky": two_lobes},
    "metal ball over a paint plate": {"parts": [(drawing.plate(2.0), diffuse()), (moved(drawing.ball(), 0.5, (-0.2, 0.1, 0.6)), metal(0.35))],
                                      "eye": ABOVE, "window": 1.2, "sky": two_lobes},
    "lamp over a brushed plate and a paint ball": {
        "parts": [(drawing.plate(2.0), metal(0.5, 0.6, 30.0)), (moved(drawing.ball(), 0.4, (0.3, -0.2, 0.5)), diffuse())],
        "eye": ABOVE, "window": 1.2, "sky": drawing.black, "lamps": [((-0.3, 0.4, 1.8), (0.0, 0.5, 0.0), (0.6, 0.0, 0.0), LAMP)]},
    "room with a lamp and a metal ball": {
        "parts": [(walls(), diffuse()), (moved(drawing.ball(), 0.45, (0.2, -0.5, 0.0)), metal(0.4, 0.5, 45.0))],
        "eye": FRONT, "window": 0.98, "sky": drawing.black, "lamps": [((0.0, 0.95, 0.1), (0.4, 0.0, 0.0), (0.0, 0.0, 0.4), LAMP)]},
    "emissive ball beside a paint plate": {
        "parts": [(drawing.plate(2.0), diffuse()), (moved(drawing.ball(), 0.3, (0.0, 0.3, 0.6)), {"kind": "emission", "colour": (2.0, 1.0, 0.5)})],
        "eye": ABOVE, "window": 1.2, "sky": drawing.black},
    "frosted ball of glass": {"parts": [(drawing.ball(), {"kind": "glass", "colour": WHITE, "roughness": 0.25})], "eye": FRONT, "window": INSIDE,
                              "sky": two_lobes},
    "black wall half over a plate": {"parts": [(drawing.plate(2.0), diffuse()), (moved(drawing.plate(0.5), 1.0, (0.3, 0.2, 0.5)), diffuse((0.0, 0.0, 0.0)))],
                                     "eye": ABOVE, "window": 1.2, "sky": white},
}


def corners_of_lamp(lamp):
    centre, a, b, _ = lamp
    return [tuple(c + s * x + t * y for c, x, y in zip(centre, a, b)) for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))]


def material_of(of, images):
    """Returns a glTF material. Appends its texture to `images`."""
    if of["kind"] == "emission":
        strongest = max(of["colour"])
        return drawing.material(diffuse=(0.0, 0.0, 0.0), emissiveFactor=[c / strongest for c in of["colour"]],
                                extensions={"KHR_materials_emissive_strength": {"emissiveStrength": strongest}})
    if of["kind"] == "glass":
        return {"pbrMetallicRoughness": {"baseColorFactor": [*of["colour"], 1], "metallicFactor": 0, "roughnessFactor": of["roughness"]},
                "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 1},
                               "KHR_materials_ior": {"ior": 1.5}}}
    m = drawing.material(**{of["kind"]: of["colour"]}, roughness=of["roughness"], strength=of.get("strength", 0.0), rotation=of.get("rotation", 0.0))
    if "roughness_codes" in of:
        images.append(png(len(of["roughness_codes"]), 1, color=lambda x, _: (0, of["roughness_codes"][x], 255)))
        m["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {"index": len(images) - 1}
    if "normal_code" in of:
        images.append(png(1, 1, color=lambda *_: of["normal_code"]))
        m["normalTexture"] = {"index": len(images) - 1}
    return m


def gltf_of(scene):
    images = []
    parts = [(mesh, material_of(of, images)) for mesh, of in scene["parts"]]
    lamps = [drawing.quad(corners_of_lamp(lamp), lamp[3]) for lamp in scene.get("lamps", ())]
    return drawing.scene(parts, scene["eye"], (scene["window"], scene["window"]), lamps, images)


def alphas(of, code=255):
    """Returns GGX's widths along and across the tangent, by KHR_materials_anisotropy."""
    alpha = (of["roughness"] * code / 255.0) ** 2
    return alpha + (1.0 - alpha) * of.get("strength", 0.0) ** 2, alpha


def turn(of):
    return math.radians(of.get("rotation", 0.0))
