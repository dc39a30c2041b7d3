"""Light that surfaces reflect, by closed forms and sums over grids, from published formulas alone. Nothing here is the renderer's text.

Surfaces lie at a point p and have a frame (tangent, bitangent, normal). Directions are unit tuples and point away from the surface."""

import math


def add(a, b):
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def minus(a, b):
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def times(a, s):
    return a[0] * s, a[1] * s, a[2] * s


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def unit(a):
    return times(a, 1.0 / math.sqrt(dot(a, a)))


LEVEL = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


def turned(frame, degrees):
    """The frame, counter-clockwise about its normal."""
    t, b, n = frame
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return add(times(t, c), times(b, s)), add(times(t, -s), times(b, c)), n


def under_map(frame, slope, scale=1.0):
    """The frame that a texel of a normal map makes, whose tangent is projected into the new plane."""
    t, b, n = frame
    m = unit(add(add(times(t, scale * slope[0]), times(b, scale * slope[1])), times(n, slope[2])))
    along = unit(minus(t, times(m, dot(t, m))))
    side = 1.0 if dot(cross(n, t), b) > 0 else -1.0
    return along, times(cross(m, along), side), m


# ---- skies -------------------------------------------------------------------------------------------------------------------------------------

SIDES = (unit((0.9, -0.2, 0.4)), unit((-0.3, 0.8, 0.5)), unit((0.1, -0.7, 0.6)))
PEAKS = (unit((0.5, 0.3, 0.7)), unit((-0.6, 0.2, 0.6)), unit((0.2, -0.5, 0.8)))


def two_lobes(d):
    """A gradient and a broad peak, elsewhere in each colour."""
    return tuple(0.7 + 0.5 * dot(d, SIDES[k]) + 1.5 * math.exp((5.0 - k) * (dot(d, PEAKS[k]) - 1.0)) for k in range(3))


def white(_):
    return 1.0, 1.0, 1.0


# ---- lobes: GGX, masking of correlated heights (Heitz 2014), Schlick's reflectance ------------------------------------------------------------------

class Lobe:
    """roughness and strength as glTF and KHR_materials_anisotropy have them. f0 and f90 are colours; above: the surface's own normal, below which
    no light comes from."""

    def __init__(self, frame, roughness, strength=0.0, f0=(1.0,) * 3, f90=(1.0,) * 3, above=None):
        alpha = roughness * roughness
        self.frame, self.f0, self.f90, self.above = frame, f0, f90, above or frame[2]
        self.along, self.across = alpha + (1.0 - alpha) * strength * strength, alpha

    def local(self, d):
        return dot(self.frame[0], d), dot(self.frame[1], d), dot(self.frame[2], d)

    def slope(self, d):
        """sqrt(1 + (alpha tan)^2), of a local direction."""
        x, y = self.along * d[0] / d[2], self.across * d[1] / d[2]
        return math.sqrt(1.0 + x * x + y * y)

    def schlick(self, cosine):
        p = (1.0 - cosine) ** 5
        return tuple(a + (b - a) * p for a, b in zip(self.f0, self.f90))

    def value(self, o, i):
        """The BRDF times the cosine at i; of directions in space."""
        if dot(i, self.above) <= 0.0:
            return 0.0, 0.0, 0.0
        lo, li = self.local(o), self.local(i)
        if lo[2] <= 0.0 or li[2] <= 0.0:
            return 0.0, 0.0, 0.0
        m = unit(add(lo, li))
        w = (m[0] / self.along) ** 2 + (m[1] / self.across) ** 2 + m[2] ** 2
        density = 1.0 / (math.pi * self.along * self.across * w * w)
        masking = 2.0 / (self.slope(lo) + self.slope(li))
        return times(self.schlick(dot(m, lo)), density * masking / (4.0 * lo[2]))

    def reflected(self, o, sky, rings=40):
        """Radiance towards o under a sky: a sum over facets, which lie as densely as GGX has them."""
        t, b, n = self.frame
        lo = self.local(o)
        total, turns = [0.0, 0.0, 0.0], 2 * rings
        for k in range(rings):
            s = (k + 0.5) / rings
            u, share = 1.0 - (1.0 - s) ** 2, 2.0 * (1.0 - s) / (rings * turns)
            r = math.sqrt(u / (1.0 - u))
            for j in range(turns):
                a = 2.0 * math.pi * (j + 0.5) / turns
                x, y = self.along * r * math.cos(a), self.across * r * math.sin(a)
                z = 1.0 / math.sqrt(1.0 + x * x + y * y)
                m = (x * z, y * z, z)
                c = dot(m, lo)
                i = minus(times(m, 2.0 * c), lo)
                if c <= 0.0 or i[2] <= 0.0:
                    continue
                d = add(add(times(t, i[0]), times(b, i[1])), times(n, i[2]))
                if dot(d, self.above) <= 0.0:
                    continue
                weight = share * c / (lo[2] * z) * 2.0 / (self.slope(lo) + self.slope(i))
                light, f = sky(d), self.schlick(c)
                for q in range(3):
                    total[q] += weight * f[q] * light[q]
        return tuple(total)

    def albedo(self, o, rings=40):
        return self.reflected(o, white, rings)


def sky_on_diffuse(normal, above, sky, rings=48):
    """Radiance of a white Lambertian surface."""
    t = unit(cross(normal, (0.3, 0.9, -0.4)))
    b = cross(normal, t)
    total, turns = [0.0, 0.0, 0.0], 2 * rings
    for k in range(rings):
        r = math.sqrt((k + 0.5) / rings)
        z = math.sqrt(1.0 - r * r)
        for j in range(turns):
            a = 2.0 * math.pi * (j + 0.5) / turns
            d = add(add(times(t, r * math.cos(a)), times(b, r * math.sin(a))), times(normal, z))
            if dot(d, above) > 0.0:
                for q, light in enumerate(sky(d)):
                    total[q] += light / (rings * turns)
    return tuple(total)


# ---- lamps: each gives [(direction, solid angle)] as a point sees it -----------------------------------------------------------------------------------

def quad_seen(p, corners, steps=40):
    """One-sided, of a parallelogram: it shines to where its corners run counter-clockwise."""
    e, f = minus(corners[1], corners[0]), minus(corners[3], corners[0])
    return _flat(p, cross(e, f), [(add(corners[0], add(times(e, (x + 0.5) / steps), times(f, (y + 0.5) / steps))), 1.0 / steps**2)
                                  for x in range(steps) for y in range(steps)])


def disk_seen(p, centre, one, other, steps=28):
    """one, other: ends of its half axes."""
    e, f = minus(one, centre), minus(other, centre)
    places = []
    for k in range(steps):
        r = math.sqrt((k + 0.5) / steps)
        for j in range(2 * steps):
            a = math.pi * (j + 0.5) / steps
            places.append((add(centre, add(times(e, r * math.cos(a)), times(f, r * math.sin(a)))), math.pi / (2 * steps * steps)))
    return _flat(p, cross(e, f), places)


def _flat(p, area, places):
    """area: the normal, as long as the area of e x f."""
    size = math.sqrt(dot(area, area))
    normal, seen = times(area, 1.0 / size), []
    for place, share in places:
        to = minus(place, p)
        far = dot(to, to)
        d = times(to, 1.0 / math.sqrt(far))
        shining = -dot(d, normal)
        if shining > 0.0:
            seen.append((d, share * size * shining / far))
    return seen


def sphere_seen(p, centre, radius, steps=28):
    to = minus(centre, p)
    far = math.sqrt(dot(to, to))
    axis = times(to, 1.0 / far)
    least = math.sqrt(1.0 - (radius / far) ** 2)
    t = unit(cross(axis, (0.3, 0.9, -0.4)))
    b = cross(axis, t)
    seen = []
    for k in range(steps):
        c = 1.0 - (1.0 - least) * (k + 0.5) / steps
        s = math.sqrt(1.0 - c * c)
        for j in range(2 * steps):
            a = math.pi * (j + 0.5) / steps
            d = add(add(times(t, s * math.cos(a)), times(b, s * math.sin(a))), times(axis, c))
            seen.append((d, math.pi * (1.0 - least) / (steps * steps)))
    return seen


def seen_by_lobe(lobe, o, seen, radiance):
    total = [0.0, 0.0, 0.0]
    for d, angle in seen:
        for q, v in enumerate(lobe.value(o, d)):
            total[q] += angle * v * radiance[q]
    return tuple(total)


def seen_by_diffuse(normal, seen, above=None):
    """Radiance of a white Lambertian surface by a lamp of radiance 1."""
    return sum(angle * max(dot(d, normal), 0.0) for d, angle in seen if above is None or dot(d, above) > 0.0) / math.pi


# ---- closed forms: radiance of a white Lambertian surface by a lamp of radiance 1 ------------------------------------------------------------------------

def lambert(p, normal, corners):
    """Lambert's formula for a polygon, cut at the horizon. Its front is where corners run counter-clockwise."""
    points, cut = [minus(c, p) for c in corners], []
    if dot(cross(minus(points[1], points[0]), minus(points[-1], points[0])), points[0]) >= 0.0:
        return 0.0  # seen from behind
    for a, b in zip(points, points[1:] + points[:1]):
        ha, hb = dot(a, normal), dot(b, normal)
        if ha > 0.0:
            cut.append(a)
        if ha * hb < 0.0:
            cut.append(add(a, times(minus(b, a), ha / (ha - hb))))
    total = 0.0
    for a, b in zip(cut, cut[1:] + cut[:1]):
        side, a, b = cross(a, b), unit(a), unit(b)
        total -= math.acos(max(-1.0, min(1.0, dot(a, b)))) * dot(unit(side), normal)
    return total / (2.0 * math.pi)


def disk_facing(height, aside, radius):
    """A disk parallel to the surface at `height`, whose centre is `aside` of the point's normal (Howell, a catalog of factors, B-13)."""
    h, r = height / aside, radius / aside
    z = 1.0 + h * h + r * r
    return 0.5 * (1.0 - (1.0 + h * h - r * r) / math.sqrt(z * z - 4.0 * r * r))


def ball_above(p, normal, centre, radius):
    """A ball above the horizon."""
    to = minus(centre, p)
    far = dot(to, to)
    return radius * radius / far * dot(to, normal) / math.sqrt(far)
