#!/usr/bin/env python3
"""Frames a second of three.js in headless Chromium on its software GL, beside the tile renderer, with the same models, view and environment.

Usage: three_frames.py --program build/release/burnish --engines FOLDER --env FILE.hdr [--size 1920x1080] [--frames N] [--work FOLDER] MODEL.glb ...

FOLDER holds node_modules with three. three.js draws with its own materials and antialiasing (4 samples); burnish draws by bent_normal, --msaa 4.
Wall and CPU time of N frames after the first; CPU time of the browser counts all its processes. HDR-FLIP tells how alike both pictures are.
Prints a line a model and writes both pictures to --work. Exit code: 0 printed; 2 something could not be run.
"""

import argparse
import base64
import json
import os
import pathlib
import resource
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests/cli"))
from browser import Browser  # noqa: E402
from browser_frames import cpu_of_group  # noqa: E402
from conform import Server  # noqa: E402
from harness import Failed, Skipped  # noqa: E402

FOV = 40  # degrees, vertical
PAGE = """<!DOCTYPE html><title>frames</title><link rel="icon" href="data:,">
<script type="importmap">{ "imports": { "three": "/node_modules/three/build/three.module.js", "three/addons/": "/node_modules/three/examples/jsm/" } }</script>
<script type="module">
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { HDRLoader } from 'three/addons/loaders/HDRLoader.js';
const [width, height] = [WIDTH, HEIGHT];
const renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
renderer.toneMapping = THREE.NoToneMapping;
renderer.setSize(width, height);
const sky = await new HDRLoader().loadAsync('/environment.hdr');
sky.mapping = THREE.EquirectangularReflectionMapping;
const root = new THREE.Scene();
root.environment = new THREE.PMREMGenerator(renderer).fromEquirectangular(sky).texture;
root.background = new THREE.Color(0, 0, 0);
const gltf = await new GLTFLoader().loadAsync('/models/MODEL');
root.add(gltf.scene);
gltf.scene.updateMatrixWorld(true);
const box = new THREE.Box3().setFromObject(gltf.scene), middle = box.getCenter(new THREE.Vector3()), radius = 0.5 * box.getSize(new THREE.Vector3()).length();
const eye = middle.clone().add(new THREE.Vector3(0.5, 0.35, 1).normalize().multiplyScalar(radius / Math.sin(FOV * Math.PI / 360)));
const camera = new THREE.PerspectiveCamera(FOV, width / height, radius / 50, radius * 50);
camera.position.copy(eye);
camera.lookAt(middle);
const gl = renderer.getContext(), pixel = new Uint8Array(4);
globalThis.frames_of = n => {
  const begin = performance.now();
  for (let i = 0; i < n; ++i) {
    renderer.render(root, camera);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel); // waits for the frame
  }
  return (performance.now() - begin) / n;
};
globalThis.view = { eye: eye.toArray(), target: middle.toArray(), samples: gl.getParameter(gl.SAMPLES) };
globalThis.picture = () => renderer.domElement.toDataURL('image/png').split(',')[1];
globalThis.ready = true;
</script>"""


def by_three(server, name, size, frames, work):
    """Returns the view, wall and CPU seconds of a frame."""
    server.pages["/page.html"] = PAGE.replace("WIDTH", str(size[0])).replace("HEIGHT", str(size[1])).replace("MODEL", name).replace("FOV", str(FOV))
    with Browser(work, webgl=True) as browser:
        browser.visit(server.address("/page.html"))
        browser.until("globalThis.ready === true", 120)
        browser.value("frames_of(1)")
        group = os.getpgid(browser.process.pid)
        before, walls = cpu_of_group(group), []
        for _ in range(frames):
            walls.append(browser.value("frames_of(1)") * 1e-3)
        cpu = (cpu_of_group(group) - before) / frames
        view = browser.value("view")
        pathlib.Path(work, "three.png").write_bytes(base64.b64decode(browser.value("picture()")))
    return view, sorted(walls)[len(walls) // 2], cpu


def by_burnish(program, model, words, frames, work):
    """Returns wall and CPU seconds of a frame."""
    times = []
    for count in (1, 1 + frames):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([program, "render", model, *words, "--frames", str(count), "--stats", f"{work}/stats.json", "-q", "-o", f"{work}/burnish.png"], check=True,
                       stdout=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        times.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return json.loads(pathlib.Path(work, "stats.json").read_text())["ms_median"] * 1e-3, (times[1] - times[0]) / frames


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, type=pathlib.Path)
    parser.add_argument("--engines", required=True, type=pathlib.Path)
    parser.add_argument("--env", required=True, type=pathlib.Path)
    parser.add_argument("--size", default="1920x1080")
    parser.add_argument("--frames", default=5, type=int)
    parser.add_argument("--work", default="three_frames", type=pathlib.Path)
    parser.add_argument("models", nargs="+", type=pathlib.Path)
    given = parser.parse_args()
    size, program = [int(side) for side in given.size.split("x")], str(given.program.resolve())
    root = given.work.resolve() / "served"
    shutil.rmtree(root, ignore_errors=True)
    (root / "models").mkdir(parents=True)
    (root / "node_modules").symlink_to(given.engines.resolve() / "node_modules")
    (root / "environment.hdr").symlink_to(given.env.resolve())
    server = Server(root)
    for model in given.models:
        work = given.work.resolve() / model.stem
        work.mkdir(exist_ok=True)
        (root / "models" / model.stem).symlink_to(model.resolve().parent)
        try:
            view, wall, cpu = by_three(server, f"{model.stem}/{model.name}", size, given.frames, work)
            words = ["--env", str(given.env), "--no-background", "--size", given.size, "--technique", "bent_normal", "--msaa", "4", "--tonemap", "none",
                     "--eye", ",".join(map(str, view["eye"])), "--target", ",".join(map(str, view["target"])), "--fov", str(FOV)]
            own_wall, own_cpu = by_burnish(program, str(model), words, given.frames, work)
            judged = subprocess.run([program, "compare", f"{work}/burnish.png", f"{work}/three.png", "--json", "-"], capture_output=True, text=True, check=False)
        except (OSError, subprocess.CalledProcessError, Failed, Skipped) as fault:
            print(f"{model.stem}: {fault}", file=sys.stderr)
            return 2
        flip = json.loads(judged.stdout).get("flip_mean")
        print(f"{model.stem:22} three.js {1 / wall:6.2f} frames/s {cpu:7.3f} CPU s ({view['samples']} samples)  burnish {1 / own_wall:7.2f} frames/s {own_cpu:7.3f} CPU s"
              f"  ratio {wall / own_wall:5.1f} wall {cpu / own_cpu:5.1f} CPU  FLIP {flip}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
