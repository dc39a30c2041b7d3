"""Examples of the reference pages (apps/manual/reference) run: each as it is written, with options behind it that make it small."""

import json
import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import time

import manual_page_cases
from compare_cases import png
from detail_cases import bumps, square
from harness import Skipped, case, check
from manual_page_cases import MANUAL, pages, served

LIMIT = 600 # seconds that an example may take
COARSE = ("--env-size 16", "--env-samples 16")
TINY = ("--size 32x24", *COARSE)
# Options behind the examples that begin so; the longest beginning counts. An example that has an option keeps its own.
SMALL = {
    "burnish render": TINY,
    "burnish profile": (*TINY, "--frames 2"),
    "burnish chart": ("--size 64x36", "--msaa 1", *COARSE, "--reference-samples 64", "--runs 1"),
    "burnish chart lamp.glb": (*COARSE, "--reference-samples 64", "--runs 0", "--error-size 64x36"), # its --size is large for timed frames
    "burnish parity": ("--technique split_isotropic", "--msaa 1", "--env-size 64", "--env-samples 32"),
    "burnish export page": TINY,
    "burnish bake environment": COARSE,
    "burnish bake displaced": ("--triangles 1000",),
}
DRAW = "burnish render builtin:plate -q " + " ".join(TINY)
# Commands that make inputs, before the first example that begins so.
BEFORE = {
    "burnish compare reference.png": (f"{DRAW} --roughness 0.4 -o reference.png -o reference.exr", f"{DRAW} --roughness 0.401 -o test.png -o test.exr"),
    "burnish compare expected/": ("mkdir expected actual", f"{DRAW} -o expected/plate.png", "cp expected/plate.png actual"),
    "burnish compare --sequence": tuple(f"{DRAW} --animate roughness=0.3:0.4 --steps 3 -o {name}_%04d.exr" for name in ("reference", "test")),
    "burnish compare reference.exr test.exr --second-reference": (f"{DRAW} --roughness 0.4 --technique mc --samples 64 --seed 7 -o other_seed.exr",),
    "burnish compare mean.exr": (f"{DRAW} --roughness 0.4 --backend reference --samples 128 -o mean.exr --variance variance.exr",),
    "burnish golden check goldens.json": ("burnish golden check goldens.json -q || test $? = 5", "burnish golden bless goldens.json -q",
                                          "burnish golden check goldens.json -q --shard 1/3 -o shard-1",
                                          "burnish golden check goldens.json -q --shard 3/3 -o shard-3"),
    "burnish golden check expected": ("mkdir expected actual", f"{DRAW} -o expected/plate.png", "cp expected/plate.png actual"),
    "burnish golden check 'out/": ("mkdir out", f"{DRAW} -o out/plate_golden.png", "cp out/plate_golden.png out/plate_now.png"),
    "burnish parity builtin:teapot": ("burnish export glsl --technique major_axis -q -o edited.glsl",),
}
# Commands behind an example, which show that it did its work.
AFTER = {"source <(": "complete -p burnish"}
# Exit codes other than 0.
ANSWERS = {"burnish compare mean.exr": (0, 1)} # 1: the z-test tells the tile renderer from the reference

# Files that stand for the examples' inputs: copies from tests/data, and made ones.
LAMP = "models/AnisotropyBarnLampSmall.glb"
COPIED = {"lamp.glb": LAMP, "models/lamp.glb": LAMP, "workshop.hdr": "env/workshop_1k.hdr", "wave.jpg": "textures/fabric_301x200.jpg"}
GOLDENS = {"defaults": {"options": " ".join(TINY).split()},
           "rows": [{"name": "pot", "scene": "builtin:teapot"}, {"name": "plate", "scene": "builtin:plate", "hold": {"flip": 0.01}},
                    {"name": "ball", "scene": "builtin:sphere", "keep": "hash"}]}
MADE = {"normal.png": lambda: png(64, 64, bumps), "heights.png": lambda: png(16, 16, lambda x, y: (16 * x,), channels=1),
        "mask.png": lambda: png(32, 24, lambda x, y: (255, 255, 255)), "spot.obj": lambda: square(30), "wall.obj": lambda: square(0),
        "copper_brushed/copper_normal.png": lambda: png(64, 64, bumps),
        "copper_brushed/copper_roughness.png": lambda: png(64, 64, lambda x, y: (80 + 2 * x,), channels=1),
        "textures/waves/waves_normal.png": lambda: png(64, 64, bumps), "goldens.json": lambda: json.dumps(GOLDENS).encode(), "bless.txt": lambda: b"pot\n"}
INPUTS = {
    "bake": ("workshop.hdr", "wave.jpg", "normal.png", "heights.png", "spot.obj", "wall.obj", "copper_brushed/copper_normal.png",
             "copper_brushed/copper_roughness.png"),
    "chart": ("lamp.glb", "workshop.hdr"),
    "chart_mip": ("textures/waves/waves_normal.png",),
    "compare": ("lamp.glb",),
    "export": ("lamp.glb", "workshop.hdr"),
    "golden": ("goldens.json", "bless.txt", "mask.png"),
    "merge": ("lamp.glb",),
    "parity": ("lamp.glb", "workshop.hdr", "models/lamp.glb"),
    "profile": ("lamp.glb",),
    "render": ("lamp.glb", "workshop.hdr"),
    "serve": ("lamp.glb", "models/lamp.glb"),
    "submit": ("lamp.glb",),
    "train": ("textures/waves/waves_normal.png",),
}
# Words of the examples that may end with 77.
NEEDS = {**manual_page_cases.NEEDS, "--isa": "the instruction set", "page": "a build for WebAssembly", "--live": "a build for WebAssembly",
         "chart": "Embree", "atlas": "Embree", "conform": "Embree"}
OF_LAB = {"bake_ltc": "burnish bake ltc", "chart_mip": "burnish chart --mip"} # on pages of the product; run by burnish-lab (tests/lab/cli)


def examples_of(page):
    return pages.examples_of((MANUAL / f"reference/{page}.md").read_text())


def inputs(bench, name):
    """Makes a folder with the inputs of a page's examples, and with a `bin` that holds burnish, and in Slurm's place a command that takes
    every job and runs none."""
    folder = bench.folder / "examples"
    for file in INPUTS.get(name, ()):
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        if file in COPIED:
            shutil.copy(bench.data_file(COPIED[file]), folder / file)
        else:
            (folder / file).write_bytes(MADE[file]())
    for made in ("bin", ".config/fish/completions"):
        (folder / made).mkdir(parents=True)
    (folder / "bin/burnish").symlink_to(pathlib.Path(bench.program).resolve())
    (folder / "bin/sbatch").write_text("#!/bin/sh\necho 1\n")
    (folder / "bin/sbatch").chmod(0o755)
    return folder


def small(line, table):
    """Returns an example with the options behind it that make it small."""
    begins = [begin for begin in table if line.startswith(begin)]
    options = table[max(begins, key=len)] if begins else ()
    return " ".join([line, *(option for option in options if option.split()[0] not in line.split())])


def by_shell(bench, folder, line):
    """Runs a line by bash. Returns its exit code, None where it did not end in time, and the end of its output."""
    own = {"PATH": f"{folder / 'bin'}:{os.environ.get('PATH', '/usr/bin:/bin')}", "HOME": str(folder)}
    if line.startswith("burnish parity"):
        own["GALLIVM_PERF"] = "nopt" # as in parity_cases
    with subprocess.Popen(["bash", "-c", "set -o pipefail\n" + line], cwd=folder, env=bench.environment(own), stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace", start_new_session=True) as running:
        try:
            out, err = running.communicate(timeout=LIMIT)
        except subprocess.TimeoutExpired:
            os.killpg(running.pid, signal.SIGKILL) # the shell and its children
            out, err = running.communicate()
            return None, (out[-300:] + err[-500:]).strip()
    return running.returncode, (out[-300:] + err[-500:]).strip()


def run_line(bench, folder, line, codes=(0,)):
    """Runs a line. Returns its fault and its unmet need; None: there is none."""
    piped = re.search(r"[^|]\| (\w+)", line)
    if piped and not shutil.which(piped[1]):
        return None, f"`{line}` needs {piped[1]}"
    begin = time.monotonic()
    code, said = by_shell(bench, folder, line)
    print(f"{time.monotonic() - begin:.1f} s, exit code {code}: {line}", flush=True)
    if code in codes:
        return None, None
    needs = [NEEDS[word] for word in line.split() if word in NEEDS]
    if code == 77 and needs:
        return None, f"`{line}` needs {needs[0]}: {said}"
    how = {None: f"did not end within {LIMIT} s", 2: "the program refuses its words (exit code 2)"}.get(code, f"exit code {code}")
    return f"`{line}`: {how}: {said}", None


def run_examples(bench, name, lines, table=SMALL, before=BEFORE, answers=ANSWERS):
    """Runs examples in turn in one folder. Fails with all faults. Where some need something that the machine lacks, it runs the others and skips."""
    if not shutil.which("bash"):
        raise Skipped("no bash")
    if bench.sanitized:
        raise Skipped("takes too long under sanitizers")
    check(lines, f"no examples of {name} were found")
    stale = [begin for begin in (*table, *before, *answers) if begin.split()[1] == name and not any(line.startswith(begin) for line in lines)]
    check(not stale, f"no example begins with {stale}")
    folder, left = inputs(bench, name), dict(before)
    wrong, lacking = [], []
    for example in lines:
        if example.startswith("burnish serve"):
            wrong += served(bench, [bench.program, *shlex.split(example)[1:]], folder, MANUAL / f"reference/{name}.md")
            continue
        steps = [(line, (0,)) for begin in list(left) if example.startswith(begin) for line in left.pop(begin)]
        shown = "".join(f" && {AFTER[begin]}" for begin in AFTER if example.startswith(begin))
        codes = next((answers[begin] for begin in answers if example.startswith(begin)), (0,))
        for line, good in (*steps, (small(example, table) + shown, codes)):
            fault, lacks = run_line(bench, folder, line, good)
            wrong += [f"examples of {name}: {fault}"] if fault else []
            lacking += [lacks] if lacks else []
            if fault or lacks:
                break
    check(not wrong, "\n".join(wrong))
    if lacking:
        raise Skipped(f"{len(lacking)} of {len(lines)} examples of {name}, the others ran: " + "; ".join(lacking))


def add_page(page):
    of_wasm = ("of_wasm",) if page in ("compare", "export") else ()

    @case(f"manual.examples_of_reference_pages_run.{page}", *of_wasm, tier="nightly")
    def examples(bench):
        run_examples(bench, page, [line for line in examples_of(page) if not line.startswith(tuple(OF_LAB.values()))])


for path in sorted((MANUAL / "reference").glob("*.md")):
    if path.stem != "README" and path.stem not in pages.LAB:
        add_page(path.stem)
