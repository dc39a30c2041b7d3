"""Display values (sRGB), and pictures laid over a background."""


def linear(value):
    """Decodes sRGB: 0 to 1 in both (IEC 61966-2-1)."""
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def encoded(value):
    return 12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055


LINEAR = [linear(i / 255) for i in range(256)]


def over(colours, cover, background):
    """Returns (3 bytes, 1 byte of alpha) a pixel: the colours over the background, mixed as light. colours: display values over black."""
    behind = [linear(value) for value in background[:3]]
    plain = bytes(round(255 * value) for value in background[:3])
    out, alpha = bytearray(colours), bytearray(b"\xff" * len(cover))
    for i, share in enumerate(cover):
        if share < 1:
            left = max(0.0, 1 - share)
            mixed = [round(255 * min(1.0, encoded(LINEAR[out[3 * i + c]] + left * behind[c]))) for c in range(3)] if share > 0 else plain
            out[3 * i : 3 * i + 3] = bytes(mixed)
            alpha[i] = round(255 * min(1.0, share + left * background[3]))
    return bytes(out), bytes(alpha)
