"""Cameras and lights, with pyrender's names and arguments."""

import math

from .checks import colour, number, refuse


class PerspectiveCamera:
    """yfov: vertical field of view, radians. znear: metres. zfar: metres; it may not cut anything off, since burnish draws to infinity.
    aspectRatio: None, or the viewport's."""

    def __init__(self, yfov, znear=0.05, zfar=None, aspectRatio=None, name=None):
        self.yfov, self.znear = number(yfov, "yfov", 1e-3, 3.1), number(znear, "znear", 1e-5)
        self.zfar = None if zfar is None else number(zfar, "zfar", self.znear)
        self.aspectRatio, self.name = None if aspectRatio is None else number(aspectRatio, "aspectRatio", 1e-6), name

    def write(self, width, height):
        _check_aspect(self.aspectRatio, "aspectRatio", width, height)
        return {"type": "perspective", "perspective": {"yfov": self.yfov, "znear": self.znear}}


class IntrinsicsCamera:
    """A pinhole camera. fx, fy: focal lengths in pixels, equal. cx, cy: the picture's middle in pixels."""

    def __init__(self, fx, fy, cx, cy, znear=0.05, zfar=100.0, name=None):
        self.fx, self.fy, self.cx, self.cy = (number(value, name, 1e-6) for name, value in (("fx", fx), ("fy", fy), ("cx", cx), ("cy", cy)))
        self.znear, self.zfar, self.name = number(znear, "znear", 1e-5), number(zfar, "zfar", znear), name

    def write(self, width, height):
        for name, value, needed in (("fx", self.fx, self.fy), ("cx", self.cx, width / 2), ("cy", self.cy, height / 2)):
            if abs(value - needed) > 1e-6 * needed:
                refuse(name, f"{value:g} is not {needed:g}: pixels are square, and the axis meets the middle")
        return {"type": "perspective", "perspective": {"yfov": 2 * math.atan(height / (2 * self.fy)), "znear": self.znear}}


class OrthographicCamera:
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
    def __init__(self, kind, color, intensity, range=None, name=None):
        self.name = name
        self.entry = {"type": kind, "color": colour([1.0] * 3 if color is None else color, "color", 1)[:3],
                       "intensity": number(1.0 if intensity is None else intensity, "intensity", 0)}
        if range is not None:
            self.entry["range"] = number(range, "range", 1e-6)


class DirectionalLight(Light):
    """A sun. intensity: lux."""

    def __init__(self, color=None, intensity=None, name=None):
        super().__init__("directional", color, intensity, name=name)


class PointLight(Light):
    """intensity: candela. range: metres, None for no limit."""

    def __init__(self, color=None, intensity=None, range=None, name=None):
        super().__init__("point", color, intensity, range, name)


class SpotLight(Light):
    """intensity: candela. range: metres. innerConeAngle, outerConeAngle: half angles in radians."""

    def __init__(self, color=None, intensity=None, range=None, innerConeAngle=0.0, outerConeAngle=math.pi / 4, name=None):
        super().__init__("spot", color, intensity, range, name)
        outer = number(outerConeAngle, "outerConeAngle", 1e-6, math.pi / 2)
        self.entry["spot"] = {"innerConeAngle": number(innerConeAngle, "innerConeAngle", 0, outer), "outerConeAngle": outer}


CAMERAS = (PerspectiveCamera, IntrinsicsCamera, OrthographicCamera)
