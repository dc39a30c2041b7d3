"""PNG files of RGB: written for notebooks, and read back where a script wants display values."""

import struct
import zlib

try:
    import numpy
except ImportError:
    numpy = None

MAGIC = b"\x89PNG\r\n\x1a\n"
PAETH = 4  # the filter of the library's files


def encode(width, height, rgb, bits=8, channels=3):
    """Returns the bytes of a PNG file. rgb: bytes by rows from the top, numbers of 8 or 16 bits (the high byte first). channels: 3, or 4 with
    alpha."""
    stride = channels * width * bits // 8
    rows = b"".join(b"\0" + bytes(rgb[stride * y : stride * (y + 1)]) for y in range(height))
    chunks = ((b"IHDR", struct.pack(">IIBBBBB", width, height, bits, {3: 2, 4: 6}[channels], 0, 0, 0)), (b"IDAT", zlib.compress(rows)), (b"IEND", b""))
    return MAGIC + b"".join(struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data)) for kind, data in chunks)


def decode(data):
    """Returns (width, height, bytes) of an 8-bit RGB file without interlacing, as the library writes them."""
    at, packed, width, height = len(MAGIC), b"", 0, 0
    while at < len(data):
        size, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8 : at + 8 + size]
        if kind == b"IHDR":
            width, height, *rest = struct.unpack(">IIBBBBB", body)
            if rest != [8, 2, 0, 0, 0]:
                raise ValueError("a PNG file that the library did not write")
        packed += body if kind == b"IDAT" else b""
        at += size + 12
    raw = zlib.decompress(packed)
    filters = raw[:: 3 * width + 1]
    if numpy is not None and set(filters) == {PAETH}:
        return width, height, _unpaeth(raw, width, height).tobytes()
    return width, height, bytes(_unfilter(raw, width, height))


def _unpaeth(raw, width, height):
    """Undoes Paeth's filter in every row. A pixel needs its left, upper and upper left neighbours, so one diagonal is done at a time."""
    coded = numpy.frombuffer(raw, numpy.uint8).reshape(height, 3 * width + 1)[:, 1:].reshape(height, width, 3)
    out = numpy.zeros((height + 1, width + 1, 3), numpy.int16)  # a black row and column come first
    for diagonal in range(width + height - 1):
        y = numpy.arange(max(0, diagonal - width + 1), min(height, diagonal + 1))
        x = diagonal - y
        left, up, corner = out[y + 1, x], out[y, x + 1], out[y, x]
        to_left, to_up, to_corner = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
        best = numpy.where((to_left <= to_up) & (to_left <= to_corner), left, numpy.where(to_up <= to_corner, up, corner))
        out[y + 1, x + 1] = (coded[y, x] + best) & 255
    return out[1:, 1:].astype(numpy.uint8)


def _unfilter(raw, width, height):
    """Undoes the filters of all rows, byte by byte."""
    stride = 3 * width
    out, above = bytearray(), bytes(stride)
    for y in range(height):
        kind = raw[y * (stride + 1)]
        line = bytearray(raw[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        for i in range(stride):
            left, up, corner = (line[i - 3], above[i], above[i - 3]) if i >= 3 else (0, above[i], 0)
            if kind == PAETH:
                to_left, to_up, to_corner = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
                guess = left if to_left <= to_up and to_left <= to_corner else up if to_up <= to_corner else corner
            else:
                guess = (0, left, up, (left + up) // 2)[kind]
            line[i] = (line[i] + guess) & 255
        out += line
        above = line
    return out
