#!/usr/bin/env python3
"""Turns the camera around a scene: one PNG a step, and all of them as an animated PNG that browsers play.

Usage: turntable.py lamp.glb -o FOLDER [--environment workshop.hdr] [--steps 24] [--size 480x360] [--elevation 25]
"""

import argparse
import pathlib
import struct
import zlib

import burnish


def animated(pngs, seconds):
    """Returns one animated PNG of pictures of one size. seconds: how long each is shown."""
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    out, number = b"", 0
    for i, png in enumerate(pngs):
        at, pixels = 8, b""
        while at < len(png):
            size, kind = struct.unpack_from(">I4s", png, at)
            body = png[at + 8 : at + 8 + size]
            if kind == b"IHDR" and i == 0:
                width, height = struct.unpack_from(">II", body)
                out = png[:8] + chunk(kind, body) + chunk(b"acTL", struct.pack(">II", len(pngs), 0))
            pixels += body if kind == b"IDAT" else b""
            at += size + 12
        out += chunk(b"fcTL", struct.pack(">IIIIIHHBB", number, width, height, 0, 0, round(1000 * seconds), 1000, 0, 0))
        out += chunk(b"IDAT", pixels) if i == 0 else chunk(b"fdAT", struct.pack(">I", number + 1) + pixels)
        number += 1 if i == 0 else 2
    return out + chunk(b"IEND", b"")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--environment")
    parser.add_argument("--steps", type=int, default=24)
    parser.add_argument("--size", default="480x360")
    parser.add_argument("--elevation", type=float, default=25, help="degrees above the horizon")
    options = parser.parse_args()
    width, height = map(int, options.size.split("x"))
    scene, pngs = burnish.load(options.scene, environment=options.environment), []
    options.output.mkdir(parents=True, exist_ok=True)
    for step in range(options.steps):
        pngs.append(scene.render(width=width, height=height, orbit=(360 * step / options.steps, options.elevation)).png())
        (options.output / f"{step:03}.png").write_bytes(pngs[-1])
    (options.output / "turntable.png").write_bytes(animated(pngs, 1 / 12))
    print(f"{options.steps} pictures in {options.output}, and turntable.png")


if __name__ == "__main__":
    main()
