"""Names of pyrender that burnish does not serve. Making one raises burnish.Error, which says what to do instead."""

from .checks import refuse


class Viewer:
    """pyrender's window. burnish opens none."""

    def __init__(self, *_, **__):
        refuse("Viewer", "burnish opens no window: draw pictures with OffscreenRenderer")


class Renderer:
    """pyrender's renderer for a window."""

    def __init__(self, *_, **__):
        refuse("Renderer", "burnish has no OpenGL context: draw pictures with OffscreenRenderer")


class Sampler:
    """pyrender's filters and edges of textures."""

    def __init__(self, *_, **__):
        refuse("Sampler", "textures repeat and are always filtered: leave the sampler out")


class TextAlign:
    """Places of captions in a Viewer, with pyrender's values."""

    CENTER, CENTER_LEFT, CENTER_RIGHT, BOTTOM_LEFT, BOTTOM_RIGHT, BOTTOM_CENTER, TOP_LEFT, TOP_RIGHT, TOP_CENTER = range(9)


class GLTF:
    """Numbers of glTF, with pyrender's names. Primitive() takes TRIANGLES alone."""

    POINTS, LINES, LINE_LOOP, LINE_STRIP, TRIANGLES, TRIANGLE_STRIP, TRIANGLE_FAN = range(7)
    NEAREST, LINEAR = 9728, 9729
    NEAREST_MIPMAP_NEAREST, LINEAR_MIPMAP_NEAREST, NEAREST_MIPMAP_LINEAR, LINEAR_MIPMAP_LINEAR = range(9984, 9988)
    CLAMP_TO_EDGE, MIRRORED_REPEAT, REPEAT = 33071, 33648, 10497
