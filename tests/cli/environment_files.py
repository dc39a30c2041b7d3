"""Pictures of environments with values of every kind."""

import struct


def exr(width, height, value):
    """Uncompressed OpenEXR of floats; value(x, y) gives (r, g, b)."""
    def attribute(name, kind, data):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data

    channels = b"".join(name + b"\0" + struct.pack("<iiii", 2, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    header = struct.pack("<II", 20000630, 2) + attribute("channels", "chlist", channels) + attribute("compression", "compression", b"\0")
    header += attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window) + attribute("lineOrder", "lineOrder", b"\0")
    header += attribute("pixelAspectRatio", "float", struct.pack("<f", 1.0)) + attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0.0, 0.0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1.0)) + b"\0"
    line = 8 + 12 * width
    first = len(header) + 8 * height
    offsets = b"".join(struct.pack("<Q", first + y * line) for y in range(height))
    lines = bytearray()
    for y in range(height):
        row = [value(x, y) for x in range(width)]
        lines += struct.pack("<ii", y, 12 * width)
        for channel in (2, 1, 0):
            lines += struct.pack(f"<{width}f", *(pixel[channel] for pixel in row))
    return header + offsets + bytes(lines)


def even(value):
    return lambda x, y: (value, value, value)


def with_texels(texels, rest=0.5):
    """Even but for {(x, y): value}."""
    return lambda x, y: (texels.get((x, y), rest),) * 3
