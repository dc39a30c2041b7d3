#!/usr/bin/env python3
"""The shader of "Real-Time Rendering of Anisotropic Materials under Image-Based Lighting", as that thesis has it, beside as_mc.

Usage: as_hammersley.py --program build/release/burnish --library build/release/raster/session/libburnish.so --env FILE.hdr [--work FOLDER]

Each pixel takes the same N half vectors of the Hammersley set, without weights and without filtered levels: the mean radiance of the
directions above the horizon, times f0 s + b. Draws a sphere by numpy from burnish's normals and tangents, and compares it with the
reference. Prints mean HDR-FLIP and pattern of the shader and of as_mc by equal samples.

Exit code: 0 as_mc is nearer to the reference everywhere; 1 it is not; 2 something could not be run.
"""

import argparse
import json
import os
import pathlib
import subprocess
import sys

import numpy as np

SIZE, EYE, FOV = 96, (0.0, 0.0, 1.3), 32.0
SAMPLES = (16, 64, 256, 1024)
LOBES = ((0.3, 0.6), (0.5, 0.6), (0.7, 0.3))  # roughness, anisotropy
F0 = 0.85


def read_hdr(path):
    """Radiance's pictures whose rows are run-length coded."""
    content = pathlib.Path(path).read_bytes()
    end = content.index(b"\n", content.index(b"\n\n") + 2)
    _, height, _, width = content[content.index(b"\n\n") + 2:end].split()
    width, height, at = int(width), int(height), end + 1
    rows = np.zeros((height, 4, width), np.uint8)
    for row in rows:
        at += 4
        for channel in row:
            x = 0
            while x < width:
                count = content[at]
                if count > 128:
                    channel[x:x + count - 128] = content[at + 1]
                    x, at = x + count - 128, at + 2
                else:
                    channel[x:x + count] = np.frombuffer(content, np.uint8, count, at + 1)
                    x, at = x + count, at + 1 + count
    scale = np.ldexp(1.0, rows[:, 3].astype(int) - 136) * (rows[:, 3] > 0)
    return np.moveaxis(rows[:, :3], 1, 2) * scale[..., None]


def write_pfm(path, image):
    head = f"PF\n{image.shape[1]} {image.shape[0]}\n-1.0\n".encode()
    pathlib.Path(path).write_bytes(head + image[::-1].astype("<f4").tobytes())


def hammersley(count):
    y = np.zeros(count)
    for i in range(count):
        bit, k = 0.5, i
        while k:
            y[i] += bit * (k & 1)
            bit, k = bit / 2, k >> 1
    return np.arange(count) / count, y


def half_vectors(nu, nv, count):
    """Ashikhmin and Shirley's equations 9 and 10, for all four quadrants at once."""
    x, y = hammersley(count)
    a, b = np.sqrt(nv + 1) * np.cos(2 * np.pi * x), np.sqrt(nu + 1) * np.sin(2 * np.pi * x)
    length = np.hypot(a, b)
    c, s = a / length, b / length
    less = np.log1p(-y) / (nu * c * c + nv * s * s + 1)
    q = np.sqrt(np.maximum(-np.expm1(2 * less), 0))
    return np.stack((c * q, s * q, np.exp(less)), -1)


def radiance(environment, d):
    """Bilinear fetches of the picture itself: the shader reads no other level."""
    height, width, _ = environment.shape
    u = (0.5 + np.arctan2(d[..., 2], d[..., 0]) / (2 * np.pi)) * width - 0.5
    v = np.arctan2(np.hypot(d[..., 0], d[..., 2]), d[..., 1]) / np.pi * height - 0.5
    column, row = np.floor(u).astype(int), np.floor(v).astype(int)
    part, down = (u - column)[..., None], (v - row)[..., None]

    def at(i, j):
        return environment[np.clip(j, 0, height - 1), i % width]

    return (at(column, row) * (1 - part) + at(column + 1, row) * part) * (1 - down) + (at(column, row + 1) * (1 - part) + at(column + 1, row + 1) * part) * down


def shaded(environment, normal, tangent, eye, roughness, anisotropy, count):
    """normal, tangent, eye: of the pixels, unit. Returns their radiance."""
    alpha = roughness * roughness
    nu, nv = 1 / (alpha * (1 + anisotropy)) ** 2, 1 / (alpha * (1 - anisotropy)) ** 2
    bitangent = np.cross(normal, tangent)
    frame = np.stack((tangent, bitangent, normal), 1)
    o = np.einsum("pij,pj->pi", frame, eye)
    o[:, 2] = np.maximum(o[:, 2], 1e-4)
    light, valid, s, b = np.zeros_like(o), np.zeros(len(o)), np.zeros(len(o)), np.zeros(len(o))
    for h in half_vectors(nu, nv, count):
        o_h = o @ h
        i = 2 * o_h[:, None] * h - o
        above = (o_h > 0) & (i[:, 2] > 0)
        own, fresnel = np.where(above, np.minimum(i[:, 2] / o[:, 2], 1), 0), (1 - np.clip(o_h, 0, 1)) ** 5
        s += own * (1 - fresnel) / count
        b += own * fresnel / count
        light += np.where(above[:, None], radiance(environment, np.einsum("pi,pij->pj", i, frame)), 0)
        valid += above
    return light / np.maximum(valid, 1)[:, None] * (F0 * s + b)[:, None]


def figures(program, reference, test):
    words = [program, "compare", reference, test, "--metric", "flip-hdr,pattern", "--json", "-"]
    done = subprocess.run(list(map(str, words)), capture_output=True, text=True)
    if done.returncode:
        print(done.stderr, file=sys.stderr)
        sys.exit(2)
    return json.loads(done.stdout)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name in ("program", "library", "env"):
        parser.add_argument(f"--{name}", required=True)
    parser.add_argument("--work", default="as_hammersley", type=pathlib.Path)
    arguments = parser.parse_args()
    os.environ["BURNISH_LIBRARY"] = str(pathlib.Path(arguments.library).resolve())
    sys.path.insert(0, str(pathlib.Path(__file__).parents[2] / "apps/python"))
    import burnish

    arguments.work.mkdir(exist_ok=True)
    environment = read_hdr(arguments.env)
    scene = burnish.load("builtin:sphere", environment=arguments.env, key_lights=0, f0=(F0, F0, F0))
    view = {"width": SIZE, "height": SIZE, "eye": EYE, "target": (0, 0, 0), "fov": FOV, "background": False}
    worse = 0
    for roughness, anisotropy in LOBES:
        lobe = {**view, "roughness": roughness, "anisotropy": anisotropy}
        reference = scene.reference(samples=1024, brdf="ashikhmin_shirley", **lobe)
        reference.save(str(arguments.work / "reference.pfm"))
        layers = scene.render(technique="as_mc", samples=16, msaa=1, layers=["normal", "tangent"], **lobe)
        normal, tangent = (np.asarray(layers.layer(name), dtype=np.float64).reshape(-1, 3) for name in ("normal", "tangent"))
        seen = np.linalg.norm(normal, axis=1) > 0.5
        up = np.tan(np.radians(FOV) / 2)
        y, x = np.mgrid[0:SIZE, 0:SIZE]
        rays = np.stack(((2 * x + 1 - SIZE) / SIZE * up, (SIZE - 2 * y - 1) / SIZE * up, -np.ones((SIZE, SIZE))), -1).reshape(-1, 3)
        eye = -rays / np.linalg.norm(rays, axis=1)[:, None]
        for count in SAMPLES:
            picture = np.zeros((SIZE * SIZE, 3))
            picture[seen] = shaded(environment, normal[seen], tangent[seen], eye[seen], roughness, anisotropy, count)
            write_pfm(arguments.work / f"thesis-{roughness}-{count}.pfm", picture.reshape(SIZE, SIZE, 3))
            scene.render(technique="as_mc", samples=count, msaa=1, **lobe).save(str(arguments.work / f"as_mc-{roughness}-{count}.pfm"))
            own, ours = (figures(arguments.program, arguments.work / "reference.pfm", arguments.work / f"{name}-{roughness}-{count}.pfm") for name in ("thesis", "as_mc"))
            print(f"roughness {roughness} anisotropy {anisotropy} {count:5} samples: FLIP {own['flip_mean']:.4f} as_mc {ours['flip_mean']:.4f}; "
                  f"pattern {own['pattern_rms']:.3f} as_mc {ours['pattern_rms']:.3f}", flush=True)
            worse += ours["flip_mean"] > own["flip_mean"]
    return 1 if worse else 0


if __name__ == "__main__":
    sys.exit(main())
