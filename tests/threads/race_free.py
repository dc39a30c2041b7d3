#!/usr/bin/env python3
"""threads.tsan: small runs of every kind of work on several threads, under ThreadSanitizer.

Usage: race_free.py SOURCE-FOLDER BUILD-FOLDER [PROGRAM]    PROGRAM: an existing build
Exit code 77 where the compiler has no ThreadSanitizer.
"""

import ctypes.util
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

DATA = pathlib.Path(__file__).resolve().parents[1] / "data"
SMALL = ("--size", "96x64", "--env-size", "16", "--threads", "4")
RUNS = {
    "tile": ("render", "builtin:spheres", *SMALL, "--msaa", "4", "--tile-size", "32", "-o", "tile.exr"),
    "tile by every technique": ("render", "builtin:plate", *SMALL, "--technique", "major_axis_adaptive", "-o", "plate.png"),
    "bake": ("render", "builtin:teapot", "--size", "32x32", "--env-size", "64", "--threads", "4", "--no-cache", "-o", "bake.png"),
    "reference": ("render", "builtin:teapot", *SMALL, "--backend", "reference", "--samples", "4", "--checkpoint", "state", "-o", "reference.exr"),
    "reference of paths": ("render", "builtin:plate", *SMALL, "--backend", "reference", "--reference-mode", "path", "--samples", "2", "-o", "p.exr"),
    "compare": ("compare", "tile.exr", "tile.exr", "--metric", "flip-hdr,ssim,mse"),
    "parity": ("parity", "builtin:plate", "--size", "64x48", "--env-size", "16", "--technique", "bent_normal,lobe_line", "--msaa", "1", "--device",
               "lavapipe"),
    "chart": ("chart", "builtin:plate", "--size", "48x32", "--env-size", "16", "--techniques", "bent_normal", "--sweep", "samples=1", "--reference-samples", "4", "-o",
              "report"),
    "animation": ("render", "builtin:plate", *SMALL, "--animate", "roughness=0.1:0.6", "--steps", "3", "-o", "step%d.png"),
    "images of a model": ("render", DATA / "models/AnisotropyBarnLampSmall.glb", *SMALL, "--msaa", "4", "-o", "lamp.png"),
    "maps and mip filters": ("render", "builtin:bumps", *SMALL, "--mip-filter", "mipnet", "-o", "bumps.png"),
    "bake of levels": ("bake", "mip", "builtin:bumps", "--mip-filter", "kappa", "-o", "bumps.mip"),
    "bake of a table": ("bake", "ltc", "--resolution", "3", "--steps", "1", "--samples", "1", "--threads", "4", "-o", "table.ltc"),
    "training": ("train", "mip", "--steps", "2", "--size", "1x4", "--threads", "4", "-o", "net.mipnet"),
    "atlas": ("atlas", "albedo_by_a_fit", "--quick", "--threads", "4", "-o", "atlas"),
}
MAY_BE_ABSENT = {"parity": 77}  # no device
DRIVER = "libvulkan_lvp.so"  # stays loaded: the sanitizer fails when a library that it ignores is unloaded


def build(source, folder):
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    for command in (["cmake", "--preset", "tsan", "-B", folder, "-DBN_BUILD_TESTS=OFF", *launcher],
                    ["cmake", "--build", folder, "--target", "burnish", "burnish-lab"]):
        done = subprocess.run(list(map(str, command)), cwd=source, capture_output=True, text=True)
        if done.returncode != 0:
            print(done.stdout[-4000:], done.stderr[-4000:])
            sys.exit(77 if "libtsan" in done.stdout + done.stderr else 1)
    return folder / "burnish"


def main():
    source, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    program = pathlib.Path(sys.argv[3]) if len(sys.argv) > 3 else build(source, folder)
    program = program.resolve()
    suppressions = pathlib.Path(__file__).with_name("suppressions.txt").resolve()
    failed = 0
    with tempfile.TemporaryDirectory(prefix="burnish-threads-") as place:
        environment = {**os.environ, "XDG_CACHE_HOME": place + "/cache", "BN_FORCE_ISA": "scalar",  # the lanes under test
                       "TSAN_OPTIONS": f"suppressions={suppressions} halt_on_error=0 exitcode=66 second_deadlock_stack=1"}
        for what, arguments in RUNS.items():
            stays = {"LD_PRELOAD": DRIVER} if what == "parity" and ctypes.util.find_library("vulkan_lvp") else {}
            done = subprocess.run([program, *arguments], cwd=place, env={**environment, **stays}, capture_output=True, text=True, timeout=1200)
            if done.returncode == MAY_BE_ABSENT.get(what):
                print(f"{what}: skipped, {done.stderr.strip().splitlines()[-1]}")
                continue
            races = done.stderr.count("WARNING: ThreadSanitizer")
            print(f"{what}: exit code {done.returncode}, {races} reports")
            if done.returncode != 0 or races:
                failed += 1
                print(done.stderr[:6000])
    sys.exit(failed != 0)


if __name__ == "__main__":
    main()
