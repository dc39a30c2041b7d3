#!/usr/bin/env python3
"""CPU time of a frame: natively by AVX2 on one thread, and in headless Chromium with one worker, in one sitting.

Usage: browser_frames.py --program build/release/burnish --renderer build/wasm/package [--work FOLDER] [--frames N]

Browser: CPU time of all its processes while a page draws N pictures, so encoding and showing them count too. Native: user and system time
of N frames more. Prints a line a scene and the geometric mean of the ratios.

Exit code: 0 printed; 2 something could not be run.
"""

import argparse
import json
import math
import os
import pathlib
import resource
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests/cli"))
from browser import Browser  # noqa: E402
from harness import Failed, Skipped  # noqa: E402

SIZE = (640, 360)
SCENES = (("builtin:teapot", "auto", 1), ("builtin:teapot", "auto", 4), ("builtin:spheres", "lobe_line", 4), ("builtin:lights", "bent_normal", 4),
          ("builtin:bumps", "split_isotropic", 4), ("builtin:lacquer", "mc", 1))
ENVIRONMENT = ("--env-size", "128", "--env-samples", "64")


def cpu_of_group(group):
    """CPU time of all processes of a process group, in seconds."""
    ticks = 0
    for folder in pathlib.Path("/proc").iterdir():
        try:
            fields = (folder / "stat").read_text().rpartition(")")[2].split()
            ticks += int(fields[11]) + int(fields[12]) if int(fields[2]) == group else 0
        except (OSError, IndexError):
            pass  # no process, or one that ended
    return ticks / os.sysconf("SC_CLK_TCK")


def native(program, words, frames):
    times = []
    for count in (1, 1 + frames):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run([program, "render", *words, "--threads", "1", "--isa", "avx2", "--frames", str(count), "-q", "-o", "native.exr"], check=True, stdout=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        times.append(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)
    return (times[1] - times[0]) / frames


DRAW = """(async () => {{
  const row = burnish_live.page;
  for (let k = 0; k < {frames}; ++k) {{
    const answer = await burnish_live.ask('/draw', {{ scene: row.scene, environment: row.environment, options: {{ ...row.options, '--exposure': String({first} + k * 1e-3) }}, width: row.width, height: row.height, reduction: 1 }});
    if (!answer.ok) throw new Error((await answer.json()).error);
  }}
  return true;
}})()"""


def in_browser(program, renderer, words, frames):
    subprocess.run([program, "export", "page", *words, "--renderer", renderer, "-q", "-o", "page.html"], check=True, stdout=subprocess.DEVNULL)
    with Browser(pathlib.Path.cwd()) as browser:
        browser.send("Page.addScriptToEvaluateOnNewDocument", source="Object.defineProperty(navigator, 'hardwareConcurrency', { value: 1 })")
        browser.open("page.html")
        browser.until("document.body.dataset.proof", 120)
        group = os.getpgid(browser.process.pid)
        browser.value(DRAW.format(frames=2, first=1))
        before = cpu_of_group(group)
        browser.value(DRAW.format(frames=frames, first=2))
        return (cpu_of_group(group) - before) / frames


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, type=pathlib.Path)
    parser.add_argument("--renderer", required=True, type=pathlib.Path)
    parser.add_argument("--work", default="browser_frames", type=pathlib.Path)
    parser.add_argument("--frames", default=12, type=int)
    given = parser.parse_args()
    program, renderer = str(given.program.resolve()), str(given.renderer.resolve())
    given.work.mkdir(exist_ok=True)
    os.chdir(given.work)
    ratios = []
    for scene, technique, msaa in SCENES:
        words = (scene, "--technique", technique, "--msaa", str(msaa), "--size", f"{SIZE[0]}x{SIZE[1]}", "--floor", "off", *ENVIRONMENT)
        try:
            own, there = native(program, words, given.frames), in_browser(program, renderer, words, given.frames)
        except (OSError, subprocess.CalledProcessError, Failed, Skipped) as fault:
            print(fault, file=sys.stderr)
            return 2
        ratios.append(there / own)
        print(f"{scene:16} {technique:16} {msaa}x  native {1e3 * own:6.1f} ms  browser {1e3 * there:6.1f} ms  {there / own:.2f}", flush=True)
    print(json.dumps({"geometric_mean": round(math.exp(sum(map(math.log, ratios)) / len(ratios)), 3)}))
    return 0


if __name__ == "__main__":
    sys.exit(main())
