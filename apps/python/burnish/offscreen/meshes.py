"""Materials and meshes, with pyrender's names and arguments."""

import itertools
import math

from .. import _native, _png
from . import gltf
from .checks import colour, number, refuse, refuse_given

try:
    import numpy
except ImportError:
    numpy = None

TRIANGLES = 4
ALPHA_MODES = ("OPAQUE", "MASK", "BLEND")


class Texture:
    """A picture of sRGB colours: height x width x 1, 3 or 4 values by rows from the top, whole numbers of 0 to 255 or floats of 0 to 1; an array
    or a PIL picture. It repeats, and (0, 0) is its lower left corner."""

    def __init__(self, name=None, sampler=None, source=None, source_channels=None, width=None, height=None, tex_type=None, data_format=None):
        refuse_given(sampler=sampler, width=width, height=height, tex_type=tex_type, data_format=data_format)
        if source_channels not in (None, "RGB", "RGBA"):
            refuse("source_channels", f"{source_channels!r} is neither RGB nor RGBA")
        self.name, (self.width, self.height, self.pixels, self.channels) = name, _picture_of(source, "source")
        if source_channels == "RGB" and self.channels == 4:
            self.pixels, self.channels = b"".join(self.pixels[i : i + 3] for i in range(0, len(self.pixels), 4)), 3
        self.png = _png.encode(self.width, self.height, self.pixels, channels=self.channels)

    def coverage(self):
        """Returns the PNG of white with the picture's alpha, or None where the picture covers everything."""
        if self.channels == 3:
            return None
        white = b"".join(b"\xff\xff\xff" + self.pixels[i : i + 1] for i in range(3, len(self.pixels), 4))
        return _png.encode(self.width, self.height, white, channels=4)


def _picture_of(source, name):
    """Returns (width, height, bytes, 3 or 4 channels) of an array or a PIL picture."""
    if hasattr(source, "convert") and hasattr(source, "tobytes"):  # PIL
        kind = "RGBA" if "A" in source.mode or "transparency" in getattr(source, "info", {}) else "RGB"
        return (*source.size, source.convert(kind).tobytes(), len(kind))
    shape = tuple(getattr(source, "shape", ()) or ())
    if len(shape) not in (2, 3) or 0 in shape or (len(shape) == 3 and shape[2] not in (1, 3, 4)):
        refuse(name, f"{type(source).__name__} of shape {shape} is no picture of height x width x 1, 3 or 4 values" if shape else
               f"a {type(source).__name__} is no picture")
    height, width = shape[:2]
    channels = shape[2] if len(shape) == 3 else 1
    kind = getattr(getattr(source, "dtype", None), "kind", "")
    flat = list(_native.flat(source.tolist() if hasattr(source, "tolist") else source))
    whole = kind in "ui" if kind else all(isinstance(value, int) for value in flat)
    for i, value in enumerate(flat):
        if not isinstance(value, (int, float)):
            refuse(f"{name}/{i}", f"{value!r} is no number")
        if not 0 <= value <= (255 if whole else 1):
            refuse(f"{name}/{i}", f"{value} does not lie in 0..{255 if whole else 1}")
    values = [value if whole else round(255 * value) for value in flat]
    if channels == 1:
        values, channels = [value for value in values for _ in range(3)], 3
    return width, height, bytes(values), channels


def _texture_of(given, name):
    """Returns the Texture of a Texture or a picture, or None."""
    if given is None or isinstance(given, Texture):
        return given
    _picture_of(given, name)  # an error names the argument
    return Texture(source=given)


class Material:
    """What all materials are."""

    def __init__(self, *_, **__):
        refuse("Material", "it has no model: make a MetallicRoughnessMaterial")


class MetallicRoughnessMaterial(Material):
    """glTF's metallic-roughness material; baseColorTexture, a Texture or a picture, is its only texture. Colours are linear, 0 to 1; roughness
    is perceptual. anisotropyStrength (0 to 1) and anisotropyRotation (radians from the first texture axis) are burnish's own."""

    def __init__(self, name=None, normalTexture=None, occlusionTexture=None, emissiveTexture=None, emissiveFactor=None, alphaMode=None,
                 alphaCutoff=None, doubleSided=False, smooth=True, wireframe=False, baseColorFactor=None, baseColorTexture=None,
                 metallicFactor=1.0, roughnessFactor=1.0, metallicRoughnessTexture=None, *, anisotropyStrength=0.0, anisotropyRotation=0.0):
        refuse_given(normalTexture=normalTexture, occlusionTexture=occlusionTexture, emissiveTexture=emissiveTexture,
                      metallicRoughnessTexture=metallicRoughnessTexture, wireframe=wireframe or None)
        if (alphaMode or "OPAQUE") not in ALPHA_MODES:
            refuse("alphaMode", f"{alphaMode!r} is none of {', '.join(ALPHA_MODES)}")
        self.baseColorTexture = _texture_of(baseColorTexture, "baseColorTexture")
        self.name, self.smooth, self.doubleSided, self.alphaMode = name, smooth, bool(doubleSided), alphaMode or "OPAQUE"
        self.alphaCutoff = number(0.5 if alphaCutoff is None else alphaCutoff, "alphaCutoff", 0)
        self.baseColorFactor = colour([1.0] * 4 if baseColorFactor is None else baseColorFactor, "baseColorFactor", 1)
        self.emissiveFactor = colour([0.0] * 3 if emissiveFactor is None else emissiveFactor, "emissiveFactor", 1)[:3]
        self.metallicFactor, self.roughnessFactor = number(metallicFactor, "metallicFactor", 0, 1), number(roughnessFactor, "roughnessFactor", 0, 1)
        self.anisotropyStrength = number(anisotropyStrength, "anisotropyStrength", 0, 1)
        self.anisotropyRotation = number(anisotropyRotation, "anisotropyRotation")

    def write(self, to, flat, both_sides, coverage, mapped):
        """Adds the material to a file. mapped: the primitive has texture coordinates."""
        members = {"doubleSided": self.doubleSided or both_sides, "alphaMode": self.alphaMode}
        if self.alphaMode == "MASK":
            members["alphaCutoff"] = self.alphaCutoff
        shine = {"baseColorFactor": [1.0, 1.0, 1.0, self.baseColorFactor[3]] if coverage else self.baseColorFactor}
        picture = self.baseColorTexture.png if self.baseColorTexture else None
        if coverage and picture:
            picture = self.baseColorTexture.coverage()
        if picture and mapped:
            shine["baseColorTexture"] = {"index": to.texture(picture)}
        if flat or coverage:
            return to.material({**members, "pbrMetallicRoughness": shine}, {"KHR_materials_unlit": {}})
        shine.update(metallicFactor=self.metallicFactor, roughnessFactor=self.roughnessFactor)
        brushed = {"anisotropyStrength": self.anisotropyStrength, "anisotropyRotation": self.anisotropyRotation}
        return to.material({**members, "pbrMetallicRoughness": shine, "emissiveFactor": self.emissiveFactor},
                           {"KHR_materials_anisotropy": brushed} if self.anisotropyStrength else {})


class Boxed:
    """What has bounds."""

    @property
    def centroid(self):
        """The middle of the bounds."""
        middle = tuple((a + b) / 2 for a, b in zip(*self.bounds))
        return middle if numpy is None else numpy.array(middle)

    @property
    def extents(self):
        """The sides of the bounds, metres."""
        sides = tuple(b - a for a, b in zip(*self.bounds))
        return sides if numpy is None else numpy.array(sides)

    @property
    def scale(self):
        """The length of the bounds' diagonal, metres."""
        return math.sqrt(sum(float(side) ** 2 for side in self.extents))


class Primitive(Boxed):
    """Triangles with one material. positions, normals: 3 floats a vertex; texcoord_0: 2, v upwards; color_0: 3 or 4, floats of 0 to 1 or whole
    numbers of 0 to 255. indices: 3 a triangle, counter-clockwise from the front; None: vertices in order. Without normals faces are flat."""

    def __init__(self, positions, normals=None, tangents=None, texcoord_0=None, texcoord_1=None, color_0=None, joints_0=None, weights_0=None,
                 indices=None, material=None, mode=None, targets=None, poses=None):
        refuse_given(tangents=tangents, texcoord_1=texcoord_1, joints_0=joints_0, weights_0=weights_0, targets=targets, poses=poses)
        if mode not in (None, TRIANGLES):
            refuse("mode", f"{mode} is not {TRIANGLES}, triangles")
        self.positions = _native.floats(positions, 3, "positions")
        self.count = len(self.positions) // 3
        self._check(self.positions, 3, "positions")
        self.normals = self._of_vertices(normals, 3, "normals")
        self.texcoord_0 = self._of_vertices(texcoord_0, 2, "texcoord_0")
        for i in range(1, len(self.texcoord_0 or ()), 2):
            self.texcoord_0[i] = 1.0 - self.texcoord_0[i]  # the library has v downwards
        self.color_0 = None if color_0 is None else _native.floats([colour(row, f"color_0/{i}", 1) for i, row in enumerate(color_0)], 4, "color_0")
        self._check(self.color_0, 4, "color_0")
        self.indices = None if indices is None else _native.numbers(indices, 3, "indices")
        if self.indices is not None and max(self.indices) >= self.count:
            refuse(f"indices/{list(self.indices).index(max(self.indices))}", f"{max(self.indices)} is beyond {self.count} vertices")
        self.material = MetallicRoughnessMaterial() if material is None else material
        if getattr(self.material, "baseColorTexture", None) and self.texcoord_0 is None:
            refuse("texcoord_0", "the material's baseColorTexture needs it")

    @property
    def bounds(self):
        """((x, y, z), (x, y, z)): the least and the largest corner."""
        return tuple(tuple(of(self.positions[i::3]) for i in range(3)) for of in (min, max))

    def _check(self, values, each, name):
        for i, value in enumerate(values or ()):
            if not math.isfinite(value):
                refuse(f"{name}/{i}", f"{value} is not finite")
        if values is not None and len(values) // each != self.count:
            refuse(name, f"{len(values) // each} for {self.count} vertices")
        return values

    def _of_vertices(self, values, each, name):
        return None if values is None else self._check(_native.floats(values, each, name), each, name)

    def write(self, to, *ways):
        named = {"NORMAL": (self.normals, 3), "TEXCOORD_0": (self.texcoord_0, 2), "COLOR_0": (self.color_0, 4)}
        attributes = {name: to.accessor(values, each) for name, (values, each) in named.items() if values is not None and not (name == "COLOR_0" and ways[-1])}
        entry = {"attributes": {"POSITION": to.accessor(self.positions, 3, bounds=True), **attributes}, "material": self.material.write(to, *ways, self.texcoord_0 is not None)}
        if self.indices is not None:
            entry["indices"] = to.accessor(self.indices, 1, gltf.ELEMENTS)
        return entry


def corners_of(bounds):
    """Returns the 8 corners of a box."""
    return list(itertools.product(*zip(*bounds)))


class Mesh(Boxed):
    """Primitives that move together."""

    def __init__(self, primitives, name=None, weights=None, is_visible=True):
        refuse_given(weights=weights)
        self.primitives, self.name, self.is_visible = list(primitives), name, is_visible

    @property
    def bounds(self):
        """((x, y, z), (x, y, z)): the least and the largest corner of the primitives. Zeros without primitives."""
        boxes = [part.bounds for part in self.primitives]
        return tuple(tuple(of(box[side][i] for box in boxes) if boxes else 0.0 for i in range(3)) for side, of in ((0, min), (1, max)))

    @classmethod
    def from_points(cls, *_, **__):
        refuse("from_points", "burnish draws no points: add a small Mesh at the place of each")

    @classmethod
    def from_trimesh(cls, mesh, material=None, is_visible=True, poses=None, wireframe=False, smooth=True):
        """Returns a Mesh of an object with `vertices` and `faces`, such as trimesh's, or of a list of them. `vertex_normals` give smooth
        shading. `visual.vertex_colors` colours a mesh without a material, and so does a texture of base colours. Others raise burnish.Error."""
        refuse_given(poses=poses, wireframe=wireframe or None)
        parts = mesh if isinstance(mesh, (list, tuple)) else [mesh]
        return cls([_primitive_of(part, material, smooth) for part in parts], is_visible=is_visible)


def _primitive_of(part, material, smooth):
    """Returns the primitive of an object like a trimesh."""
    visual = getattr(part, "visual", None)
    kind = getattr(visual, "kind", None)
    uv = getattr(visual, "uv", None) if kind == "texture" else None
    if material is None and kind == "texture":
        given = getattr(visual, "material", None)
        for name in ("metallicRoughnessTexture", "normalTexture", "emissiveTexture", "occlusionTexture"):
            refuse_given(**{name: getattr(given, name, None)})
        names = ("baseColorFactor", "metallicFactor", "roughnessFactor", "emissiveFactor", "doubleSided", "alphaMode", "alphaCutoff")
        factors = {name: getattr(given, name, None) for name in names}
        pictures = {name: getattr(given, name, None) for name in ("image", "baseColorTexture")}
        factors["baseColorTexture"] = next((_texture_of(picture, name) for name, picture in pictures.items() if picture is not None), None)
        material = MetallicRoughnessMaterial(**{name: value for name, value in factors.items() if value is not None})
    if material is None and kind == "face":
        refuse("face_colors", "burnish colours vertices: give vertex_colors or a material")
    colours = visual.vertex_colors if material is None and kind == "vertex" else None
    if material is None:
        material = MetallicRoughnessMaterial(metallicFactor=0.2, roughnessFactor=0.8)  # as pyrender has it
    return Primitive(part.vertices, getattr(part, "vertex_normals", None) if smooth else None, texcoord_0=uv, color_0=colours, indices=part.faces,
                     material=material)
