"""HTML for notebooks: pictures, scenes and comparisons, with PNG files within the text."""

import base64
import html
import math

from . import _png

MOST_SIDE = 400  # pixels of a difference map
FLOOR = 0.01     # radiance that counts as dark
# Colours of differences from 0 to 1, in even steps: dark violet to pale yellow.
SCALE = ((0, 0, 4), (81, 18, 124), (183, 55, 121), (252, 137, 97), (252, 253, 191))
MEANINGS = {"flip_mean": "HDR-FLIP, mean", "flip_p99": "HDR-FLIP, 99th percentile", "flip_max": "HDR-FLIP, largest", "mse": "mean squared error",
            "rel_mse": "relative squared error", "max_abs": "largest difference", "differing_fraction": "share of pixels that differ"}


def figure(png, caption, width=None):
    """Returns a figure as HTML. png: bytes; caption: plain text, escaped here; width: pixels on the page."""
    text = html.escape(caption)
    data = base64.b64encode(png).decode()
    size = f' width="{int(width)}"' if width else ""
    return (f'<figure style="display:inline-block;margin:0 8px 8px 0"><img alt="{text}"{size} src="data:image/png;base64,{data}">'
            f"<figcaption>{text}</figcaption></figure>")


def colour_of(value):
    """Returns 3 bytes for a difference in [0, 1]."""
    at = min(max(value, 0.0), 1.0) * (len(SCALE) - 1)
    low = min(int(at), len(SCALE) - 2)
    return tuple(round(a + (at - low) * (b - a)) for a, b in zip(SCALE[low], SCALE[low + 1]))


def difference_map(reference, test, width, height):
    """Returns (PNG bytes, step) of |a - b| / (|a| + |b| + FLOOR), the mean of three channels. Shows every step-th pixel in both
    directions. reference, test: flat floats, 3 a pixel."""
    step = step_of(width, height)
    colours = [bytes(colour_of(i / 255)) for i in range(256)]
    rgb = bytearray()
    for y in range(0, height, step):
        for x in range(0, width, step):
            at = 3 * (y * width + x)
            error = sum(abs(a - b) / (abs(a) + abs(b) + FLOOR) for a, b in zip(reference[at : at + 3], test[at : at + 3]))
            rgb += colours[round(255 * min(error / 3, 1.0))]
    return _png.encode(-(-width // step), -(-height // step), rgb), step


def step_of(width, height):
    """Returns n such that every n-th pixel in both directions gives a picture of at most MOST_SIDE."""
    return max(1, -(-max(width, height) // MOST_SIDE))


def layer(values):
    """Returns the PNG of a layer, by every step-th pixel. One channel: white for the least value, dark grey for the largest. Three: grey for
    0 where some are negative, else black for 0. Black for values that are not finite."""
    (height, width, channels), flat = values.shape, values.bytes()
    step = step_of(width, height)
    rows = [[flat[channels * (y * width + x) : channels * (y * width + x + 1)] for x in range(0, width, step)] for y in range(0, height, step)]
    finite = [value for row in rows for pixel in row for value in pixel if math.isfinite(value)] or [0.0]
    least, most = min(finite), max(finite)
    if channels == 1:
        shade = lambda value: 255 - round(215 * (value - least) / ((most - least) or 1.0))
    elif least < 0:
        shade = lambda value: round(127.5 + 127.5 * value / max(-least, most))
    else:
        shade = lambda value: round(255 * value / (most or 1.0))
    rgb = bytearray()
    for row in rows:
        for pixel in row:
            rgb += bytes(shade(value) if math.isfinite(value) else 0 for value in (pixel if channels == 3 else [pixel[0]] * 3))
    return _png.encode(len(rows[0]), len(rows), rgb)


def comparison(of, reference, test, width, height):
    """Returns the HTML of a Comparison: pictures that have names, the difference map, and all figures. reference, test: flat floats."""
    parts = [figure(picture.png(), f"{role}: {picture.name}", picture.width) for role, picture in zip(("reference", "test"), of.pictures)
             if hasattr(picture, "png")]
    png, step = difference_map(reference, test, width, height)
    often = "" if step == 1 else f", 1 of {step} x {step} pixels"
    parts.append(figure(png, f"relative difference, black 0 to yellow 1{often}", width))
    rows = "".join(f"<tr><td>{meaning}</td><td><code>{name}</code></td><td>{getattr(of, name):.6g}</td></tr>" for name, meaning in MEANINGS.items())
    return f"<div>{''.join(parts)}</div><table>{rows}</table>"
