"""Cameras and lights, with pyrender's names and arguments."""

import math

from .checks import colour, number, refuse

SHADOWS = 'OffscreenRenderer(..., shadows="on") draws those of all lights'


class Camera:
    """What all cameras are."""

    def __init__(self, *_, **__):
        refuse("Camera", "it has no lens: make a PerspectiveCamera, an OrthographicCamera or an IntrinsicsCamera")

    def get_projection_matrix(self, *_, **__):
        refuse("get_projection_matrix", "burnish projects by itself: the camera's own numbers tell its view")

    def unproject_depth_map(self, *_, **__):
        refuse("unproject_depth_map", "OffscreenRenderer.render() returns metres: use them as they are")


class PerspectiveCamera(Camera):
    """yfov: vertical field of view, radians. znear: metres. zfar: metres; it may not cut anything off, since burnish draws to infinity.
    aspectRatio: None, or the viewport's."""

    def __init__(self, yfov, znear=0.05, zfar=None, aspectRatio=None, name=None):
        self.yfov, self.znear = number(yfov, "yfov", 1e-3, 3.1), number(znear, "znear", 1e-5)
        self.zfar = None if zfar is None else number(zfar, "zfar", self.znear)
        self.aspectRatio, self.name = None if aspectRatio is None else number(aspectRatio, "aspectRatio", 1e-6), name

    def write(self, width, height):
        _check_aspect(self.aspectRatio, "aspectRatio", width, height)
        return {"type": "perspective", "perspective": {"yfov": self.yfov, "znear": self.znear}}


class IntrinsicsCamera(Camera):
    """A pinhole camera. fx, fy: focal lengths in pixels, equal. cx, cy: the picture's middle in pixels."""

    def __init__(self, fx, fy, cx, cy, znear=0.05, zfar=100.0, name=None):
        self.fx, self.fy, self.cx, self.cy = (number(value, name, 1e-6) for name, value in (("fx", fx), ("fy", fy), ("cx", cx), ("cy", cy)))
        self.znear, self.zfar, self.name = number(znear, "znear", 1e-5), number(zfar, "zfar", znear), name

    def write(self, width, height):
        for name, value, needed in (("fx", self.fx, self.fy), ("cx", self.cx, width / 2), ("cy", self.cy, height / 2)):
            if abs(value - needed) > 1e-6 * needed:
                refuse(name, f"{value:g} is not {needed:g}: pixels are square, and the axis meets the middle")
        return {"type": "perspective", "perspective": {"yfov": 2 * math.atan(height / (2 * self.fy)), "znear": self.znear}}


class OrthographicCamera(Camera):
    """xmag, ymag: half the view's width and height, metres, in the viewport's proportion."""

    def __init__(self, xmag, ymag, znear=0.05, zfar=100.0, name=None):
        self.xmag, self.ymag = number(xmag, "xmag", 1e-6), number(ymag, "ymag", 1e-6)
        self.znear, self.zfar, self.name = number(znear, "znear", 0), number(zfar, "zfar", znear), name

    def write(self, width, height):
        _check_aspect(self.xmag / self.ymag, "xmag", width, height)
        sides = {"xmag": self.xmag, "ymag": self.ymag, "znear": self.znear, "zfar": self.zfar}
        return {"type": "orthographic", "orthographic": sides}


def _check_aspect(given, name, width, height):
    if given is not None and abs(given * height - width) > 1e-3 * width:
        refuse(name, f"the viewport has {width} x {height} pixels, which must be square")


class Light:
    """What all lights are. Their numbers may change between pictures."""

    KIND = None  # in glTF

    def __init__(self, color=None, intensity=None, range=None, name=None):
        if self.KIND is None:
            refuse("Light", "it has no kind: make a DirectionalLight, a PointLight or a SpotLight")
        self.color, self.intensity, self.range, self.name = [1.0] * 3 if color is None else color, 1.0 if intensity is None else intensity, range, name
        self.entry()  # an error names the argument

    def entry(self):
        """Returns the light's object of a glTF file."""
        found = {"type": self.KIND, "color": colour(self.color, "color", 1)[:3], "intensity": number(self.intensity, "intensity", 0)}
        return found if self.range is None else {**found, "range": number(self.range, "range", 1e-6)}

    @property
    def shadow_texture(self):
        self.generate_shadow_texture()

    def generate_shadow_texture(self, *_, **__):
        refuse("shadow_texture", f"rays find the shadows: {SHADOWS}")

    def get_shadow_camera(self, *_, **__):
        refuse("get_shadow_camera", f"rays find the shadows: {SHADOWS}")


class DirectionalLight(Light):
    """A sun. intensity: lux."""

    KIND = "directional"

    def __init__(self, color=None, intensity=None, name=None):
        super().__init__(color, intensity, name=name)


class PointLight(Light):
    """intensity: candela. range: metres, None for no limit."""

    KIND = "point"


class SpotLight(Light):
    """intensity: candela. range: metres. innerConeAngle, outerConeAngle: half angles in radians."""

    KIND = "spot"

    def __init__(self, color=None, intensity=None, range=None, innerConeAngle=0.0, outerConeAngle=math.pi / 4, name=None):
        self.innerConeAngle, self.outerConeAngle = innerConeAngle, outerConeAngle
        super().__init__(color, intensity, range, name)

    def entry(self):
        outer = number(self.outerConeAngle, "outerConeAngle", 1e-6, math.pi / 2)
        return {**super().entry(), "spot": {"innerConeAngle": number(self.innerConeAngle, "innerConeAngle", 0, outer), "outerConeAngle": outer}}


CAMERAS = (PerspectiveCamera, IntrinsicsCamera, OrthographicCamera)
