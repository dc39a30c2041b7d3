"""Environment images with values of every kind."""

import math
import struct


def attribute(name, kind, data):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data


def exr(width, height, value, names="RGB", attributes=b""):
    """Returns an uncompressed OpenEXR of floats. value(x, y) gives one value for each name, by default (r, g, b). attributes: further
    ones."""
    names = list(names)
    stored = sorted(range(len(names)), key=lambda i: names[i])
    channels = b"".join(names[i].encode() + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for i in stored) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<II", 20000630, 2) + attribute("channels", "chlist", channels) + attribute("compression", "compression", b"\0")
    header += attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", b"\0")
    header += attribute("pixelAspectRatio", "float", struct.pack("<f", 1.0)) + attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0.0, 0.0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1.0)) + attributes + b"\0"
    line = 8 + 4 * len(names) * width
    first = len(header) + 8 * height
    offsets = b"".join(struct.pack("<Q", first + y * line) for y in range(height))
    lines = bytearray()
    for y in range(height):
        row = [value(x, y) for x in range(width)]
        lines += struct.pack("<ii", y, 4 * len(names) * width)
        for channel in stored:
            lines += struct.pack(f"<{width}f", *(pixel[channel] for pixel in row))
    return header + offsets + bytes(lines)


def even(value):
    return lambda x, y: (value, value, value)


def with_texels(texels, rest=0.5):
    """Returns a uniform value function, except for {(x, y): value}."""
    return lambda x, y: (texels.get((x, y), rest),) * 3


def hdr(width, height, scanline, lines=""):
    """Returns a Radiance file. scanline(y) gives its bytes, plain or as runs. lines: further header lines."""
    return f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n{lines}\n-Y {height} +X {width}\n".encode() + b"".join(map(scanline, range(height)))


def small_sky(bench):
    """Writes a picture that costs nothing to read and little to bake, and returns the options that light a scene by it."""
    (bench.folder / "sky.hdr").write_bytes(hdr(32, 16, lambda y: 32 * rgbe((0.2, 0.9 - 0.04 * y, 1.2 - 0.05 * y))))
    return "--env", "sky.hdr", "--env-size", "16", "--env-samples", "4", "--floor", "off"


def rgbe(value):
    """Returns the four bytes of a colour."""
    exponent = math.frexp(max(value))[1]
    return bytes([int(v * 256.0 / 2.0 ** exponent) for v in value] + [exponent + 128])
