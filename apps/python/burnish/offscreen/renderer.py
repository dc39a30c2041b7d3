"""Draws a scene through its main camera: colours, depths, and colours by node."""

import array
import math
import os
import tempfile

from .. import _load, _native, _png
from . import gltf
from .checks import refuse, whole
from .display import over
from .views import SHADOWS

try:
    import numpy
except ImportError:
    numpy = None

SAMPLES = 4  # of a pixel, as pyrender takes them
EVEN_LIGHT = {"env_size": 16, "env_samples": 1, "env_exposure": 0, "cache": False}  # an even light needs no more
MIDDLES = {"msaa": 1, "technique": "split_isotropic"}  # one sample, in the pixel's middle, and hardly any shading

MADE = "no TANGENT for"  # of a warning: primitives here never have tangents


class RenderFlags:
    """Flags of OffscreenRenderer.render(), with pyrender's values. Those of LACKING raise burnish.Error there."""

    NONE, DEPTH_ONLY, OFFSCREEN, ALL_SOLID, SKIP_CULL_FACES, RGBA, FLAT, SEG = 0, 1, 2, 16, 1024, 2048, 4096, 8192
    FLIP_WIREFRAME, ALL_WIREFRAME, SHADOWS_DIRECTIONAL, SHADOWS_POINT, SHADOWS_SPOT, SHADOWS_ALL = 4, 8, 32, 64, 128, 224
    VERTEX_NORMALS, FACE_NORMALS, DISABLE_ANTI_ALIASING = 256, 512, 16384
    _all = DEPTH_ONLY | OFFSCREEN | ALL_SOLID | SKIP_CULL_FACES | RGBA | FLAT | SEG


WIREFRAMES, NORMALS = "burnish draws no wireframes: leave the flag out", "burnish draws no arrows: burnish.load() and layers=[\"normal\"] give normals"
LACKING = {"FLIP_WIREFRAME": WIREFRAMES, "ALL_WIREFRAME": WIREFRAMES, "SHADOWS_DIRECTIONAL": SHADOWS, "SHADOWS_POINT": SHADOWS, "SHADOWS_SPOT": SHADOWS,
           "VERTEX_NORMALS": NORMALS, "FACE_NORMALS": NORMALS, "DISABLE_ANTI_ALIASING": "OffscreenRenderer(..., msaa=1) takes one sample a pixel"}


class OffscreenRenderer:
    """Draws pictures of viewport_width x viewport_height pixels. keywords: further ones of burnish.load() and Scene.render(), such as
    technique="mc" or msaa=8."""

    def __init__(self, viewport_width, viewport_height, point_size=1.0, **keywords):
        if point_size != 1.0:
            refuse("point_size", "burnish draws no points")
        for name in ("width", "height", "layers", "aov", "floor", "camera", "eye", "target", "orbit", "fov", "zoom", "background"):
            if name in keywords:
                refuse(name, "the scene and the viewport decide it")
        self.viewport_width, self.viewport_height, self.point_size, self.keywords = viewport_width, viewport_height, point_size, keywords
        self._cached = {}  # scenes opened last, for colours and for coverage: (bytes, environment), scene

    viewport_width = property(lambda self: self._width, lambda self, value: setattr(self, "_width", whole(value, "viewport_width", 1)))
    viewport_height = property(lambda self: self._height, lambda self, value: setattr(self, "_height", whole(value, "viewport_height", 1)))

    def render(self, scene, flags=RenderFlags.NONE, seg_node_map=None):
        """Draws the scene. Returns (colour, depth).

        colour: height x width x 3 bytes, sRGB with pbr-neutral tones. RGBA adds a fourth byte, the share that is covered.
        depth: height x width 32-bit floats, metres along the camera's -z at the pixel's middle, 0 where nothing is.
        Both are numpy arrays, or memoryviews where numpy is absent. DEPTH_ONLY returns depth alone. SEG colours each node by seg_node_map:
        {node: (red, green, blue)}, 0 to 255, and leaves other nodes black. Raises burnish.Error, which names the fault.
        """
        for name, instead in LACKING.items():
            if flags & getattr(RenderFlags, name):
                refuse("flags", f"{name}: {instead}")
        if flags & ~RenderFlags._all:
            refuse("flags", f"{flags & ~RenderFlags._all:#x} is none of RenderFlags")
        if scene.main_camera_node is None:
            refuse("camera", "the scene has none")
        width, height = self.viewport_width, self.viewport_height
        if not scene.drawn():
            return self._empty(scene, width, height, flags)
        seg = flags & RenderFlags.SEG
        ways = {"flat": bool(flags & (RenderFlags.FLAT | RenderFlags.SEG)), "both_sides": bool(flags & RenderFlags.SKIP_CULL_FACES)}
        opened = self._open(scene, "colour", width, height, **ways)
        size = {"width": width, "height": height, "camera": 0, "background": False}
        middles = opened.render(**size, **MIDDLES, layers=["depth", "object-id"])
        depth = _depth_of(middles, scene.main_camera_node.camera)
        if flags & RenderFlags.DEPTH_ONLY:
            return depth
        if seg:
            return _shaped(_segments(middles, scene.drawn(), seg_node_map or {}), height, width, 3), depth
        size.update({"msaa": SAMPLES, **{name: value for name, value in self.keywords.items() if not _loads(name)}})
        picture = opened.render(**{**size, "background": scene.environment is not None and scene.bg_color is None})
        colours = _png.decode(picture.png())[2]
        alpha = None
        if flags & RenderFlags.RGBA or (scene.bg_color is not None and scene.bg_color[:3] != [0, 0, 0]):
            cover = self._open(scene, "coverage", width, height, both_sides=ways["both_sides"], coverage=True).render(**size).pixels.bytes()[::3]
            colours, alpha = over(colours, cover, scene.bg_color or [0.0] * 4)
        if flags & RenderFlags.RGBA:
            colours = b"".join(colours[3 * i : 3 * i + 3] + alpha[i : i + 1] for i in range(width * height))
        return _shaped(colours, height, width, 4 if flags & RenderFlags.RGBA else 3), depth

    def delete(self):
        """Frees what the renderer keeps. It may draw again."""
        self._cached.clear()

    def _empty(self, scene, width, height, flags):
        """Returns the picture of a scene without meshes."""
        depth = _floats(array.array("f", bytes(4 * width * height)), height, width)
        if flags & RenderFlags.DEPTH_ONLY:
            return depth
        if scene.bg_color is None:
            refuse("scene", "it has no mesh, and the environment alone is no scene")
        shown = [0] * 4 if flags & RenderFlags.SEG else [round(255 * value) for value in scene.bg_color]
        channels = 4 if flags & RenderFlags.RGBA else 3
        return _shaped(bytes(shown[:channels]) * (width * height), height, width, channels), depth

    def _open(self, scene, role, width, height, **ways):
        """Opens the scene by a file in a new folder, unless it is as it was."""
        data, environment = scene.write(width, height, **ways), scene.environment
        given = {name: value for name, value in self.keywords.items() if _loads(name)}
        key = data, environment, tuple(scene.ambient_light)
        if self._cached.get(role, (None,))[0] != key:
            with tempfile.TemporaryDirectory(prefix="burnish") as folder:
                path, light = os.path.join(folder, "scene.glb"), gltf.even_light(scene.ambient_light) if environment is None else environment
                with open(path, "wb") as file:
                    file.write(data)
                # 6 calls up: the script's own line
                opened = _load(path, light, None, {**given, **({} if environment else EVEN_LIGHT)}, 6,
                               lambda text: role == "colour" and MADE not in text)
            self._cached[role] = key, opened
        return self._cached[role][1]


def _loads(keyword):
    """Returns true for keywords of load()."""
    return "load()" in _native.calls().get(keyword, ())


def _shaped(data, *shape):
    """Returns bytes as an array of the shape, which may be written."""
    if numpy is not None:
        return numpy.frombuffer(bytearray(data), numpy.uint8).reshape(shape)
    return memoryview(bytearray(data)).cast("B", shape)


def _floats(values, *shape):
    if numpy is not None:
        return numpy.array(values, numpy.float32).reshape(shape)
    return memoryview(values).cast("B").cast("f", shape)


def _depth_of(picture, camera):
    """Returns the depths with 0 where nothing is. Refuses a camera whose far plane would cut something off."""
    seen = array.array("f", (0.0 if value == math.inf else value for value in picture.layer("depth").bytes()))
    if camera.zfar is not None and max(seen) > camera.zfar:
        refuse("zfar", f"a surface lies at {max(seen):g} m, beyond {camera.zfar:g} m")
    return _floats(seen, picture.height, picture.width)


def _segments(picture, nodes, colours):
    """Returns 3 bytes a pixel: the colour of the node in the pixel's middle, black where it has none."""
    known = {}
    for index, node in enumerate(nodes):
        given = [int(value) for value in colours.get(node, (0, 0, 0))]
        if len(given) != 3 or not all(0 <= value <= 255 for value in given):
            refuse("seg_node_map", f"{given} are no 3 numbers of 0 to 255")
        known[index + 1] = bytes(given)
    return b"".join(known.get(int(value), bytes(3)) for value in picture.layer("object-id").bytes())
