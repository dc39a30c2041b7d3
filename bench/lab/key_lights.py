#!/usr/bin/env python3
"""Measures the effect of extracted lights: FLIP to the reference with and without them, by environment, roughness and anisotropy.

Usage: key_lights.py --program build/release/burnish [--env FILE|FOLDER]... [--technique NAME,...] [--scene SCENE]... [--work FOLDER]
                     [--quick] [--json FILE]

Under builtin:sky, three skies that it makes (a low sun, two suns, a sun behind thin cloud) and the environments given, or else those that
lie beside the checkout, `burnish chart` measures every technique twice, with --key-lights auto and off, against one reference. A stopped
run goes on where --work names the same folder. A line a place: mean FLIP without and with, and the ratio. At the end, by environment,
how many extracted lights it has, the means, and the aims:
  - no place is worse by more than 0.002;
  - where there are extracted lights and roughness is at most 0.65, the mean is at most half.

Exit code: 0 nothing became worse; 1 a place did; 2 something could not be run.
"""

import argparse
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile

WORSE = 0.002
SHARP = 0.65  # up to this roughness, the mean must halve
FULL = {"roughness": "0.2,0.4,0.6,0.8", "anisotropy": "-0.9,0.5,0.8,0.95", "size": "128x72", "samples": "256"}
QUICK = {"roughness": "0.3,0.6", "anisotropy": "-0.5,0.8", "size": "96x54", "samples": "256"}


def towards(azimuth_deg, elevation_deg):
    a, e = math.radians(azimuth_deg), math.radians(elevation_deg)
    return (math.cos(e) * math.cos(a), math.sin(e), math.cos(e) * math.sin(a))


def sun(d, place, radius_deg, radiance, colour):
    angle = math.degrees(math.acos(min(1.0, sum(a * b for a, b in zip(d, place)))))
    t = min(max((1.15 * radius_deg - angle) / (0.3 * radius_deg), 0.0), 1.0)
    return angle, [radiance * c * t * t * (3.0 - 2.0 * t) for c in colour]


def air(d, zenith, horizon, ground):
    up = max(d[1], 0.0)
    low = (1.0 - up) ** 4
    above = [z + (h - z) * low for z, h in zip(zenith, horizon)]
    t = min(max(d[1] * 40.0 + 0.5, 0.0), 1.0)
    return [g + (a - g) * t for g, a in zip(ground, above)]


def low_sun(d):
    angle, light = sun(d, towards(30.0, 4.0), 0.5, 12000.0, (1.0, 0.6, 0.25))
    base = air(d, (0.08, 0.12, 0.3), (0.9, 0.5, 0.3), (0.1, 0.08, 0.07))
    return [b + l + c * 0.9 / (1.0 + (angle / 6.0) ** 2) for b, l, c in zip(base, light, (1.0, 0.55, 0.25))]


def two_suns(d):
    _, first = sun(d, towards(60.0, 50.0), 0.8, 8000.0, (1.0, 0.95, 0.85))
    _, second = sun(d, towards(150.0, 25.0), 1.4, 900.0, (0.8, 0.3, 0.2))
    base = air(d, (0.1, 0.2, 0.5), (0.7, 0.7, 0.8), (0.2, 0.18, 0.15))
    return [a + b + c for a, b, c in zip(base, first, second)]


def veiled_sun(d):
    angle, light = sun(d, towards(100.0, 40.0), 0.6, 700.0, (1.0, 0.97, 0.9))
    wave = math.sin(9.0 * d[0] + 2.0 * math.sin(7.0 * d[2])) * math.sin(8.0 * d[1] + 3.0 * d[2])
    cloud = 0.8 + 0.35 * wave
    glow = 40.0 * math.exp(-angle / 2.5) + 4.0 * math.exp(-angle / 12.0)
    base = air(d, (0.5, 0.55, 0.65), (0.8, 0.8, 0.82), (0.2, 0.2, 0.18))
    return [cloud * (b + glow) + l for b, l in zip(base, light)]


def write_sky(path, radiance, width=1024):
    """Equirectangular, in Radiance's format: the orientation of shading/bake/environment/environment.h."""
    height = width // 2
    columns = [(math.cos(p), math.sin(p)) for p in (((x + 0.5) / width - 0.5) * 2.0 * math.pi for x in range(width))]
    with open(path, "wb") as file:
        file.write(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode())
        for y in range(height):
            theta = (y + 0.5) / height * math.pi
            s, c = math.sin(theta), math.cos(theta)
            row = bytearray()
            for x, z in columns:
                rgb = radiance((s * x, c, s * z))
                _, exponent = math.frexp(max(max(rgb), 1e-9))
                scale = math.ldexp(256.0, -exponent)
                row += struct.pack("4B", *(min(int(v * scale), 255) for v in rgb), exponent + 128)
            file.write(row)


def environments_of(given):
    """Lists paths and names; of a folder, the environments in it. Nothing given: the folder beside the checkout, where there is one."""
    beside = pathlib.Path(__file__).resolve().parents[3] / "shared/data/env"
    found = []
    for name in given or ([beside] if beside.is_dir() else []):
        path = pathlib.Path(name)
        found += sorted(str(p) for p in path.iterdir() if p.suffix in (".exr", ".hdr")) if path.is_dir() else [str(name)]
    return found


def run(command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if done.returncode:
        print(f"{' '.join(map(str, command))}\n{done.stderr}", file=sys.stderr)
        sys.exit(2)
    return done.stdout


def charted(program, report, scenes, environments, techniques, size, key_lights, samples="16", more=()):
    """Returns the report of `burnish chart` for every technique at every place. Pictures are as large as timed frames, on one thread."""
    command = [program, "chart", *scenes, "--techniques", techniques, "--sweep", "roughness=" + size["roughness"], "--sweep",
               "anisotropy=" + size["anisotropy"], "--sweep", "samples=" + samples, "--size", size["size"], "--msaa", "16",
               "--reference-samples", size["samples"], "--runs", size.get("runs", "1"), "--no-background", "--key-lights", key_lights,
               "-t", "1", "-q", *more, "-o", report]
    for environment in environments:
        command += ["--env", environment]
    run(command)
    return json.loads((report / "report.json").read_text())


def measure(program, folder, scenes, environments, techniques, size, key_lights):
    """{(scene, environment, technique, roughness, anisotropy): mean FLIP}"""
    rows = charted(program, folder / f"report_{key_lights}", scenes, environments, techniques, size, key_lights)["rows"]
    return {(r["scene"], r["env"], r["technique"], r["settings"]["roughness"], r["settings"]["anisotropy"]): r["flip_mean"] for r in rows}


def mean(values):
    return sum(values) / len(values) if values else 0.0


def main():
    parser = argparse.ArgumentParser(description="FLIP with and without extracted lights")
    parser.add_argument("--program", required=True, type=pathlib.Path)
    parser.add_argument("--env", action="append", default=[], help="further environments, or folders of them; several times (../shared/data/env)")
    parser.add_argument("--scene", action="append", default=[], help="builtin:spheres and builtin:teapot")
    parser.add_argument("--technique", default="lobe_line")
    parser.add_argument("--work", type=pathlib.Path, help="folder for skies and reports; a temporary one")
    parser.add_argument("--quick", action="store_true", help="few places in small pictures")
    parser.add_argument("--json", type=pathlib.Path)
    given = parser.parse_args()
    program, size = given.program.resolve(), QUICK if given.quick else FULL
    with tempfile.TemporaryDirectory() as temporary:
        folder = given.work or pathlib.Path(temporary)
        folder.mkdir(parents=True, exist_ok=True)
        environments = ["builtin:sky"]
        for sky in (low_sun, two_suns, veiled_sun):
            path = folder / f"{sky.__name__}.hdr"
            if not path.exists():
                write_sky(path, sky, 512 if given.quick else 1024)
            environments.append(str(path))
        environments += [] if given.quick and not given.env else environments_of(given.env)
        scenes = given.scene or (["builtin:spheres"] if given.quick else ["builtin:spheres", "builtin:teapot"])
        lights = {e: len(json.loads(run([program, "info", "--json", "--env", e]))["environment"]["key_lights"]) for e in environments}
        off, on = (measure(program, folder, scenes, environments, given.technique, size, k) for k in ("off", "auto"))
    worse = 0
    for place in sorted(off, key=str):
        bad = on[place] > off[place] + WORSE
        worse += bad
        scene, env, technique, roughness, anisotropy = place
        print(f"{scene} {pathlib.Path(env).name} {technique} roughness {roughness:.2f} eta {anisotropy:+.2f}: {off[place]:.4f} -> {on[place]:.4f} "
              f"({on[place] / max(off[place], 1e-9):.2f}){' worse' if bad else ''}")
    print()
    for env in environments:
        for technique in given.technique.split(","):
            places = [p for p in off if p[1] == env and p[2] == technique]
            sharp = [p for p in places if p[3] <= SHARP + 1e-6]
            ratio = mean([on[p] for p in sharp]) / max(mean([off[p] for p in sharp]), 1e-9)
            aim = "" if not lights[env] else ", at most half" if ratio <= 0.5 else ", not halved"
            print(f"{pathlib.Path(env).name}, {technique}: {lights[env]} extracted lights, mean FLIP {mean([off[p] for p in places]):.4f} -> "
                  f"{mean([on[p] for p in places]):.4f}, up to roughness {SHARP} by {ratio:.2f}{aim}")
    print(f"{worse} of {len(off)} places worse by more than {WORSE}")
    if given.json:
        given.json.write_text(json.dumps([{"scene": p[0], "env": p[1], "technique": p[2], "roughness": p[3], "anisotropy": p[4],
                                           "key_lights": lights[p[1]], "flip_off": off[p], "flip_auto": on[p]} for p in sorted(off, key=str)], indent=1))
    return 1 if worse else 0


if __name__ == "__main__":
    sys.exit(main())
