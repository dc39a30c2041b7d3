#!/usr/bin/env python3
"""Compares a sun as an extracted light with the sun as an area light: mean HDR-FLIP of both to the reference, by place.

Usage: sun_as_disk.py --program build/release/burnish [--size WxH] [--samples N] [--technique NAME] [--work FOLDER] [--json FILE]

Skies that are dim but for an even disc, high or low, small or large, are drawn in three ways on builtin:spheres: by the reference; with the
disc as the extracted light that baking finds in it; and without the disc, under a disk-shaped area light of that extracted light's direction, axes and
radiance, 200 metres away from balls of 0.7 metres across, by transformed cosines. Printed is a line a place, and means by roughness and by sky. Files in --work are not
made again.

Exit code: 0 extracted lights are nearer in the mean; 1 area lights are; 2 something could not be run.
"""

import itertools
import json
import math
import pathlib
import sys

from key_lights import mean, towards, write_sky

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1]))
from workbench import Program, arguments, in_folder  # noqa: E402

RADII_DEG, ELEVATIONS_DEG = (1.0, 1.6), (5.0, 30.0, 65.0)
ROUGHNESS, ANISOTROPY = (0.3, 0.5, 0.7, 0.9), (0.5, 0.9)
AZIMUTH_DEG, IRRADIANCE, FAR = 60.0, 6.0, 200.0


def sky_of(radius_deg, elevation_deg, with_sun):
    place, cosine = towards(AZIMUTH_DEG, elevation_deg), math.cos(math.radians(radius_deg))
    radiance = IRRADIANCE / (2.0 * math.pi * (1.0 - cosine))

    def light(d):
        if with_sun and d[0] * place[0] + d[1] * place[1] + d[2] * place[2] > cosine:
            return (radiance, 0.9 * radiance, 0.75 * radiance)
        return (0.03, 0.04, 0.06) if d[1] > 0.0 else (0.03, 0.025, 0.02)
    return light


def disk_light(run, sky):
    """--light's words for the only extracted light of a sky."""
    keys = json.loads(run("info", "--env", sky, "--json"))["environment"]["key_lights"]
    if len(keys) != 1:
        print(f"{sky} has {len(keys)} extracted lights", file=sys.stderr)
        sys.exit(2)
    key = keys[0]
    u, v = key["axis_u"], key["axis_v"]
    across = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    solid = math.pi * math.sqrt(sum(c * c for c in across))
    middle = [FAR * c for c in key["direction"]]
    points = [middle, [m + FAR * c for m, c in zip(middle, u)], [m + FAR * c for m, c in zip(middle, v)]]
    words = "/".join(",".join(f"{c:.9g}" for c in p) for p in points)
    return f"disk:points={words}:radiance={','.join(f'{c / solid:.6g}' for c in key['irradiance'])}:two-sided"


def main():
    parser = arguments(__doc__)
    parser.add_argument("--size", default="96x54")
    parser.add_argument("--samples", default="256", help="of the reference")
    parser.add_argument("--technique", default="lobe_line")
    return in_folder(parser.parse_args(), measure)


def measure(a, work):
    rows, run = [], Program(a, work).run
    for radius, elevation in itertools.product(RADII_DEG, ELEVATIONS_DEG):
        sky = f"{radius:g}_{elevation:g}"
        paths = {True: work / f"sun_{sky}.hdr", False: work / f"dim_{sky}.hdr"}
        for with_sun, path in paths.items():
            if not path.exists():
                write_sky(path, sky_of(radius, elevation, with_sun), 512)
        disk = disk_light(run, paths[True])
        for roughness, eta in itertools.product(ROUGHNESS, ANISOTROPY):
            words = ("builtin:spheres", "--size", a.size, "--eye", "0,0.1,0.7", "--target", "0,0,0", "--no-background", "--roughness", roughness,
                     "--anisotropy", eta, "-q")
            name = work / f"{sky}_{roughness:g}_{eta:g}"
            ways = {"reference": ("--env", paths[True], "--backend", "reference", "--samples", a.samples),
                    "key": ("--env", paths[True], "--technique", a.technique, "--msaa", "8"),
                    "area": ("--env", paths[False], "--technique", a.technique, "--msaa", "8", "--light", disk)}
            for way, more in ways.items():
                if not pathlib.Path(f"{name}_{way}.pfm").exists():
                    run("render", *words, *more, "-o", f"{name}_{way}.pfm")
            flip = {way: json.loads(run("compare", f"{name}_reference.pfm", f"{name}_{way}.pfm", "--metric", "flip-hdr", "--json", "-",
                                        "-q"))["flip_mean"] for way in ("key", "area")}
            rows.append({"radius_deg": radius, "elevation_deg": elevation, "roughness": roughness, "anisotropy": eta, **flip})
            print(f"disc of {radius:g} degrees at {elevation:g}, roughness {roughness:g}, anisotropy {eta:g}: extracted light {flip['key']:.4f}, area "
                  f"light {flip['area']:.4f}", flush=True)
    for what, values in (("roughness", ROUGHNESS), ("anisotropy", ANISOTROPY), ("radius_deg", RADII_DEG), ("elevation_deg", ELEVATIONS_DEG)):
        for value in values:
            part = [r for r in rows if r[what] == value]
            print(f"{what:14} {value:<5g} extracted light {mean([r['key'] for r in part]):.4f}, area light {mean([r['area'] for r in part]):.4f}, nearer at "
                  f"{sum(r['area'] < r['key'] for r in part)} of {len(part)}")
    key, area = mean([r["key"] for r in rows]), mean([r["area"] for r in rows])
    print(f"all            extracted light {key:.4f}, area light {area:.4f}, nearer at {sum(r['area'] < r['key'] for r in rows)} of {len(rows)}")
    if a.json:
        pathlib.Path(a.json).write_text(json.dumps(rows, indent=1) + "\n")
    return 0 if key <= area else 1


if __name__ == "__main__":
    sys.exit(main())
