"""Checks of poses, colours and numbers in scenes for the offscreen renderer."""

import math

from .. import _native

LOOSE = 1e-4  # how far a rotation's axes may be from unit length and right angles


def refuse(name, reason):
    raise _native.Error(_native.USAGE, f"{name}: {reason}")


def refuse_given(**arguments):
    """Refuses arguments that are set and that burnish cannot honour."""
    for name, value in arguments.items():
        if value is not None:
            refuse(name, "burnish's offscreen scenes have none")


def number(value, name, least=-math.inf, most=math.inf):
    """Returns a finite float within the range."""
    try:
        result = float(value)
    except (TypeError, ValueError):
        refuse(name, f"{value!r} is no number")
    if not (math.isfinite(result) and least <= result <= most):
        refuse(name, f"{result:g} does not lie in {least:g}..{most:g}")
    return result


def whole(value, name, least):
    """Returns a whole number, `least` or more."""
    result = number(value, name, least)
    if result != int(result):
        refuse(name, f"{result:g} is no whole number")
    return int(result)


def numbers(values, name, least=-math.inf, most=math.inf):
    """Returns a list of finite floats within the range."""
    try:
        flat = list(_native.flat(values))
    except TypeError:
        refuse(name, f"{values!r} is no sequence of numbers")
    return [number(value, f"{name}/{i}", least, most) for i, value in enumerate(flat)]


def colour(values, name, most=math.inf):
    """Returns [red, green, blue, alpha]: floats as they are, whole numbers divided by 255. One number is grey."""
    kind = getattr(getattr(values, "dtype", None), "kind", "")
    flat = list(_native.flat(values)) if hasattr(values, "__iter__") else [values] * 3
    whole = kind in "ui" if kind else all(isinstance(value, int) for value in flat)
    scaled = [number(value, f"{name}/{i}") / (255 if whole else 1) for i, value in enumerate(flat)]
    if len(scaled) not in (3, 4):
        refuse(name, f"{len(scaled)} numbers are no colour")
    return [number(value, f"{name}/{i}", 0, most) for i, value in enumerate(scaled)] + [1.0] * (4 - len(scaled))


def matrix(pose, name):
    """Returns a pose as 16 floats, column by column. pose: 4 rows of 4 numbers that map columns (x, y, z, 1) to world space; None: the
    identity."""
    if pose is None:
        return [float(row == column) for column in range(4) for row in range(4)]
    flat = numbers(pose, name)
    if len(flat) != 16:
        refuse(name, f"{len(flat)} numbers are no 4 x 4 matrix")
    if flat[12:] != [0, 0, 0, 1]:
        refuse(name, "the last row is not 0, 0, 0, 1")
    return [flat[4 * row + column] for column in range(4) for row in range(4)]


def check_rotation(columns, name):
    """Refuses a pose that scales, shears or mirrors. columns: from matrix()."""
    axes = [columns[4 * i : 4 * i + 3] for i in range(3)]
    for i in range(3):
        for j in range(3):
            if abs(sum(a * b for a, b in zip(axes[i], axes[j])) - (i == j)) > LOOSE:
                refuse(name, "its axes are not at right angles and of unit length")
    (a, b, c), (d, e, f), (g, h, i) = axes
    if a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g) < 0:
        refuse(name, "it mirrors")
