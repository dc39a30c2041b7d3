"""Pictures of brushed metal and other anisotropic materials, drawn on the CPU, without a display.

    import burnish
    scene = burnish.load("lamp.glb", environment="workshop.hdr")
    picture = scene.render(width=640, height=480, technique="lobe_line")
    picture.save("lamp.png")

Colours are linear Rec.709 radiance as 32-bit floats; lengths are metres, angles degrees. Equal calls give equal bits on every machine.
Errors of the library are exceptions of class Error with the program's words. numpy is not needed; where it is there, `numpy.asarray(picture)` copies nothing.
"""

import contextlib
import ctypes
import numbers
import operator
import os
import warnings

from . import _native, _show
from ._native import Error, library

__all__ = ["Comparison", "Error", "InputWarning", "Mesh", "Picture", "Scene", "compare", "load", "meshes", "options", "techniques", "version"]


class InputWarning(UserWarning):
    """What was repaired or left out while a scene or an environment was read."""


def version():
    """The library's version, such as "0.1.0"."""
    return library().burnish_version().decode()


def techniques():
    """Techniques for light from the environment: {name: summary}."""
    return _native.listed("burnish_technique_name", "burnish_technique_help")


def options():
    """Keywords of load(), meshes(), Scene.render(), Scene.reference() and Scene.set_environment(): {name: meaning}. Their docstrings say which
    call takes which."""
    return _native.listed("burnish_option_name", "burnish_option_help")


class Picture(_native.Alone):
    """A picture of `height` rows and `width` columns, 3 floats a pixel. Offers the buffer of its pixels, numpy's array interface and DLPack.
    `name` is a caption for notebooks, which scripts may set."""

    def __init__(self, frame, name="picture"):
        super().__init__()
        self.name = name
        self._frame, self._free = frame, library().burnish_frame_free
        self.width, self.height = library().burnish_frame_width(frame), library().burnish_frame_height(frame)

    def __del__(self):
        if getattr(self, "_frame", None):
            self._free(self._frame)
            self._frame = None

    def __reduce__(self):
        raise TypeError("a Picture cannot be copied or pickled; numpy.array(picture) copies its pixels")

    def __repr__(self):
        return f"<burnish.Picture {self.width}x{self.height}, hash {self.hash}>"

    def _view(self, address, channels):
        array = _native.Values(self, address, (self.height, self.width, channels))
        return array

    @property
    def pixels(self):
        """The pixels, height x width x 3: linear Rec.709 radiance. See Values."""
        return self._view(library().burnish_frame_pixels(self._frame), 3)

    @property
    def variance(self):
        """Variance of the reference's pixel means, height x width x 3, or None."""
        address = library().burnish_frame_variance(self._frame)
        return self._view(address, 3) if address else None

    def layer(self, name):
        """A layer asked for by render(layers=[...]) or render(aov=[...]), height x width x channels. Raises KeyError."""
        channels = ctypes.c_int()
        address = library().burnish_frame_layer(self._frame, name.encode(), ctypes.byref(channels))
        if not address:
            raise KeyError(name)
        return self._view(address, channels.value)

    @property
    def __array_interface__(self):
        return self.pixels.__array_interface__

    def __dlpack_device__(self):
        return self.pixels.__dlpack_device__()

    def __dlpack__(self, **keywords):
        return self.pixels.__dlpack__(**keywords)

    @property
    def hash(self):
        """16 hexadecimal digits over the pixels' bits, as `burnish render` prints them."""
        return f"{library().burnish_frame_hash(self._frame):016x}"

    @contextlib.contextmanager
    def _exposed(self, exposure, tonemap):
        """Chooses the tone curve. Gives the options of a call."""
        if not isinstance(exposure, numbers.Real):
            raise TypeError(f"exposure: {exposure!r} is no number")
        with _native.Options({}, "render()") as given, self._alone():
            _native.call("burnish_frame_tonemap", self._frame, str(tonemap).encode())
            yield given

    def png(self, exposure=0.0, tonemap="pbr-neutral", progress=None):
        """The picture as bytes of a PNG file. exposure: stops. tonemap: "none", "pbr-neutral" or "aces". progress: see load()."""
        data, size = ctypes.c_void_p(), ctypes.c_size_t()
        with self._exposed(exposure, tonemap) as given:
            _native.call_told("burnish_frame_png_told", given, progress, self._frame, exposure, given, ctypes.byref(data), ctypes.byref(size),
                              undo=lambda: None)
            return ctypes.string_at(data.value, size.value)

    def save(self, path, exposure=0.0, tonemap="pbr-neutral", progress=None):
        """Writes .exr .hdr .pfm (linear floats; .exr with layers) or .png .jpg .tif (exposed, tonemapped). exposure, tonemap and progress: see
        png(). Work that is stopped leaves no file, or the old one."""
        name = _native.path(path)
        with self._exposed(exposure, tonemap) as given:
            _native.call_told("burnish_write_told", given, progress, self._frame, name, exposure, given,
                              undo=lambda: None)  # Ctrl-C counts even where the file is whole

    def _repr_png_(self):
        return self.png()

    def _repr_html_(self):
        return _show.figure(self.png(), self.name, self.width)


class Scene(_native.Alone):
    """A scene under an environment. One thread at a time may use it. Make it by load() or meshes(). `name` is a caption for notebooks."""

    PREVIEW = {"width": 240, "height": 180, "msaa": 4}  # keywords of the picture that notebooks show

    def __init__(self, session, name="scene", level=4, tells=lambda text: True):
        super().__init__()
        self.name = name
        self._session, self._close = session, library().burnish_close
        self._warned, self._tells = set(), tells
        self._warn(level)

    def _warn(self, level):
        """Warns once of what was repaired or left out, where tells(text) is true. level: calls up to the script's own line."""
        for text in _native.texts("burnish_warning", self._session):
            if text not in self._warned and self._tells(text):
                self._warned.add(text)
                warnings.warn(text, InputWarning, stacklevel=level)

    @property
    def nodes(self):
        """Names of the nodes, by index."""
        return _native.texts("burnish_scene_node", self._session)

    @property
    def materials(self):
        """Names of the materials, by index."""
        return _native.texts("burnish_scene_material", self._session)

    @property
    def variants(self):
        """Names of the variants of materials, for load(path, variant=...)."""
        return _native.texts("burnish_scene_variant", self._session)

    @property
    def lights(self):
        """Names of the point, spot and directional lights, by index."""
        return _native.texts("burnish_scene_light", self._session)

    def __del__(self):
        if getattr(self, "_session", None):
            self._close(self._session)
            self._session = None

    def __reduce__(self):
        raise TypeError("a Scene cannot be copied or pickled")

    def __repr__(self):
        return f"<burnish.Scene {self.name}>"

    def _repr_png_(self):
        return self.render(**self.PREVIEW).png()

    def _repr_html_(self):
        return _show.figure(self._repr_png_(), self.name, self.PREVIEW["width"])

    def _caption(self, keywords):
        """Returns the scene's name and the keywords that choose how it is drawn."""
        return ", ".join([self.name, *(f"{name} {keywords[name]}" for name in ("technique", "samples") if name in keywords)])

    def render(self, progress=None, **keywords):
        """Draws a Picture. progress: see load()."""
        frame, free = ctypes.c_void_p(), library().burnish_frame_free
        with _native.Options(keywords, "render()") as given, self._alone():
            _native.call_told("burnish_render", given, progress, self._session, given, ctypes.byref(frame), undo=lambda: free(frame))
        return Picture(frame, self._caption(keywords))

    def reference(self, samples=1024, progress=None, **keywords):
        """Draws a Picture by the Monte Carlo reference. progress: see load()."""
        frame, free = ctypes.c_void_p(), library().burnish_frame_free
        with _native.Options({**keywords, "samples": samples}, "reference()") as given, self._alone():
            _native.call_told("burnish_reference", given, progress, self._session, given, _native.POLL(), None, ctypes.byref(frame),
                              undo=lambda: free(frame))
        return Picture(frame, self._caption({"technique": "reference", "samples": samples}))

    def _index(self, of, find, what):
        """Returns the index of an index or a name."""
        if isinstance(of, str):
            index = getattr(library(), find)(self._session, of.encode())
            if index < 0:
                raise KeyError(f"no {what} has the name {of!r}")
            return index
        return operator.index(of)

    def move(self, node, matrix):
        """Places a node, by name or index, for the pictures to come. matrix: to its parent's space, 4 rows of 4 numbers, or 16 column by
        column. Mesh i of meshes() has node i. Scenes with a floor refuse it."""
        with self._alone():
            _native.call("burnish_set_node", self._session, self._index(node, "burnish_find_node", "node"), _native.matrix(matrix, "matrix"))

    def set_material(self, material, **factors):
        """Changes factors of a material, by name or index, for the pictures to come: roughness=0.2, base_color=(1, 0, 0, 1), ... Mesh i of
        meshes() has material i. Scenes with a floor refuse it."""
        with _native.Options(factors, "set_material()") as given, self._alone():
            index = self._index(material, "burnish_find_material", "material")
            _native.call_told("burnish_set_material", given, None, self._session, index, given)
        self._warn(3)

    def set_primitive_material(self, primitive, material):
        """Gives a primitive, by index, another material, by name or index, for the pictures to come. Primitive i of meshes() is mesh i. Scenes
        with a floor refuse it."""
        with self._alone():
            index = self._index(material, "burnish_find_material", "material")
            _native.call("burnish_set_primitive_material", self._session, operator.index(primitive), index)
        self._warn(3)

    def set_light(self, light, **factors):
        """Changes factors of a point, spot or directional light, by name or index, for the pictures to come: intensity=4, ..."""
        with _native.Options(factors, "set_light()") as given, self._alone():
            _native.call("burnish_set_light", self._session, self._index(light, "burnish_find_light", "light"), given)

    def set_environment(self, environment=None, progress=None, **keywords):
        """Lights the pictures to come by another environment. Arguments: see load()."""
        with _native.Options(keywords, "set_environment()") as given, self._alone():
            light = _native.environment_of(environment, given)
            _native.call_told("burnish_set_environment", given, progress, self._session, light, given)
        self._warn(3)


class Mesh:
    """A mesh of triangles for meshes().

    positions, normals: 3 floats a vertex, flat or nested, or arrays; coordinates: 2 floats a vertex, (0, 0) is a picture's upper left.
    triangles: 3 vertex numbers each, counter-clockwise from the front; None: vertices in order. transform: 4 rows of 4 numbers, or
    16 column by column.
    Further keywords are factors of its material: base_color=(r, g, b, a), metallic=1, roughness=0.4, anisotropy_strength=0.8, ...
    """

    def __init__(self, positions, triangles=None, normals=None, coordinates=None, transform=None, **material):
        self.positions = _native.floats(positions, 3, "positions")
        self.vertices = len(self.positions) // 3
        self.normals = self._of_vertices(normals, 3, "normals")
        self.coordinates = self._of_vertices(coordinates, 2, "coordinates")
        self.triangles = None if triangles is None else _native.numbers(triangles, 3, "triangles")
        self.transform = None if transform is None else _native.matrix(transform, "transform")
        self.material = material

    def _of_vertices(self, values, each, name):
        if values is None:
            return None
        array = _native.floats(values, each, name)
        if len(array) // each != self.vertices:
            raise ValueError(f"{name}: {len(array) // each} for {self.vertices} vertices")
        return array


def load(path, environment=None, progress=None, **keywords):
    """Opens a scene: a .gltf, .glb or .obj file, or "builtin:NAME".

    environment: a path, "builtin:NAME", or an equirectangular picture of height x width x 3 floats, linear Rec.709 radiance. None: the
    scene's own light, else builtin:studio. progress: called with the work's name and the share of its current step that is done, -1 where
    unknown, about ten times a second. A true result stops the work, as Ctrl-C does. Raises KeyboardInterrupt then."""
    return _load(path, environment, progress, keywords, 5)


def _load(path, environment, progress, keywords, *warns):
    """Returns the Scene of load(). warns: the last arguments of Scene()."""
    session = ctypes.c_void_p()
    with _native.Options(keywords, "load()") as given:
        light = _native.environment_of(environment, given)
        _native.call_told("burnish_open", given, progress, _native.path(path), light, given, ctypes.byref(session),
                          undo=lambda: library().burnish_close(session))
    return Scene(session, os.path.basename(os.fsdecode(path)), *warns)


def meshes(*parts, environment=None, progress=None, **keywords):
    """Makes a scene of Mesh objects, one at least. environment and progress: see load()."""
    for i, part in enumerate(parts):
        if not isinstance(part, Mesh):
            raise TypeError(f"parts/{i}: {type(part).__name__} is no burnish.Mesh")
    session = ctypes.c_void_p()
    materials = [_native.Options(part.material, "Mesh()") for part in parts]
    try:
        structs = (_native.MeshStruct * len(parts))(*(
            _native.MeshStruct(ctypes.sizeof(_native.MeshStruct), part.positions, part.normals, part.coordinates, part.triangles, part.vertices,
                               0 if part.triangles is None else len(part.triangles) // 3, part.transform, material.__enter__())
            for part, material in zip(parts, materials)))
        with _native.Options(keywords, "meshes()") as given:
            light = _native.environment_of(environment, given)
            _native.call_told("burnish_open_meshes", given, progress, structs, len(parts), light, given, ctypes.byref(session),
                              undo=lambda: library().burnish_close(session))
    finally:
        for material in materials:
            material.__exit__()
    return Scene(session, f"{len(parts)} mesh{'' if len(parts) == 1 else 'es'}")


class Comparison:
    """Figures of two pictures: flip_mean, flip_p99, flip_max (HDR-FLIP, 0 to 1), mse, rel_mse, max_abs, differing_fraction. Notebooks show
    the pictures, a map of relative differences, and the figures."""

    def __init__(self, figures, reference, test):
        self.pictures = reference, test
        for name, _ in _native.ComparisonStruct._fields_[1:]:
            setattr(self, name, getattr(figures, name))

    def __repr__(self):
        return f"<burnish.Comparison mean FLIP {self.flip_mean:.4f}, {100 * self.differing_fraction:.1f} % of the pixels differ>"

    def _repr_html_(self):
        (a, width, height), (b, _, _) = map(_native.picture_of, self.pictures)
        return _show.comparison(self, _native.floats_at(a), _native.floats_at(b), width, height)


def compare(reference, test, progress=None):
    """Compares two Pictures, or buffers of height x width x 3 floats. Returns a Comparison. progress: as in load()."""
    a, b = _native.picture_of(reference), _native.picture_of(test)
    if a[1:] != b[1:]:
        raise ValueError(f"{a[1]}x{a[2]} and {b[1]}x{b[2]} pixels cannot be compared")
    figures = _native.ComparisonStruct(ctypes.sizeof(_native.ComparisonStruct))
    with _native.Options({}, "render()") as given:
        _native.call_told("burnish_compare_told", given, progress, a[0], b[0], a[1], a[2], given, ctypes.byref(figures), undo=lambda: None)
    return Comparison(figures, reference, test)


def _describe():
    """Adds each call's keywords to its docstring, as the library lists them."""
    for function, indent, more in ((load, 4, {}), (meshes, 4, {}), (Scene.render, 8, {}), (Scene.reference, 8, {"samples": 1024}),
                                   (Scene.set_environment, 8, {})):
        lines = _native.keyword_lines(function.__name__ + "()", " " * indent, **more)
        if function.__doc__:  # python -OO drops them
            function.__doc__ += f"\n\n{' ' * indent}Keywords:\n\n{lines}\n{' ' * indent}"


with contextlib.suppress(ImportError):  # the first use of the library says why it is not there
    _describe()
