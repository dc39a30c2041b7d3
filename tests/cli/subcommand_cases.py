"""Every subcommand once, small, also in a build with sanitizers. The laboratory's are in tests/lab/cli/command_cases.py."""

import json
import re

from fault_cases import CHART, REFERENCE, TINY
from harness import case, check, lab_commands

NO_DEVICE = {"VK_DRIVER_FILES": "/nowhere", "VK_ICD_FILENAMES": "/nowhere"}  # drivers are not under test here
VIEW = ("--size", "32x24", "--msaa", "1", "--env-size", "16", "--env-samples", "16")
BARE = (*VIEW, "--floor", "off")
MAPPED = "builtin:roofs=1"  # a map of few texels

# Command lines by subcommand, each with its allowed exit codes: 77 where a device or the reference is missing.
RUNS = {
    "render": [((*TINY, "-o", "a.png", "-o", "a.exr", "-o", "a.hdr", "-o", "a.pfm", "-o", "a.jpg", "-o", "a.tif", "--stats", "s.json",
                 "--trace", "t.json"), (0,)),
               ((*REFERENCE[1:], "--checkpoint", "c.part", "--checkpoint-seconds", "0", "--variance", "v.exr", "-o", "r.exr"), (0, 77)),
               (("builtin:plate", *BARE, "--backend", "vulkan", "-o", "v.png"), (0, 77)),
               (("builtin:plate", *BARE, "--animate", "roughness=0.1:0.6", "--steps", "2", "-o", "m%d.png"), (0,)),
               (("builtin:plate", *BARE, "--turntable", "2", "-o", "t%d.png", "-o", "t.apng"), (0,)),
               (("builtin:plate", *BARE, "--direction-map", "a.png", "-o", "d.pfm"), (0,)),
               (("builtin:plate", *BARE, "--technique", "bent_normal", "--risks", "risks.png"), (0,)),
               (("builtin:glass", *BARE, "--technique", "mc", "-o", "g.pfm"), (0,)),
               (("builtin:plate", *BARE, "--normal-map", "a.png", "--mip-filter", "lean", "--frame-map", "quaternion", "-o", "n.pfm"), (0,)),
               (("builtin:plate", *BARE, "--normal-map", "a.png", "--mip-filter", "teacher", "-o", "t.pfm"), (0,)),
               ((MAPPED, *BARE, "--mip-filter", "kappa", "--mip-kappa", "0.9", "-o", "k.pfm"), (0,)),
               ((MAPPED, *BARE, "--couple", "albedo", "--color-kernel", "kaiser", "--show", "tensor", "-o", "f.png"), (0,)),
               ((MAPPED, *BARE, "--height-scale", "2", "--height-map", "a.png", "--pom-metric", "uv", "-o", "h.pfm"), (0,)),
               (("builtin:lights", *BARE, "--light", "sphere:points=0,1,0:radius=0.1:radiance=9,9,9", "-o", "l.pfm"), (0,))],
    "compare": [(("a.exr", "a.hdr", "--json", "-", "--error-map", "e.png", "--html", "c.html"), (0,)), (("a.png", "a.tif"), (0,)),
                (("--sequence", "m%d.png", "t%d.png", "--json", "-"), (0,))],
    "golden": [(("check", "goldens.json"), (5,)), (("bless", "goldens.json"), (0,)), (("merge", "golden-results", "-o", "merged"), (5,))],
    "serve": [(("nothing.glb",), (4,))],
    "chart": [((*CHART[1:], "--sweep", "roughness=0.2,0.5", "--sweep", "anisotropy=0,0.5", "-o", "report"), (0, 77))],
    "profile": [((*VIEW, "--frames", "2", "--json", "p.json", "--svg", "p.svg", "--trace", "pt.json"), (0,))],
    "parity": [(("builtin:plate", *VIEW, "--technique", "mc", "--device", "lavapipe", "--json", "y.json", "--html", "y.html",
                 "--junit", "y.xml"), (0, 77))],
    "bake": [(("direction", "a.png", "--from", "luminance", "-o", "d.png"), (0,)), (("quaternion", "a.png", "-o", "q.png"), (0,)),
             (("tpr", "--expr", "u", "1-v", "--size", "4x4", "-o", "r.pfm"), (0,)),
             (("half-vectors", "--nu", "9", "--nv", "70", "--size", "4x4", "-o", "h.png"), (0,)),
             (("brdf-lut", "--nu", "9", "--nv", "70", "--size", "4x4", "-o", "l.pfm"), (0,)),
             (("environment", "a.hdr", "--env-size", "16", "--env-samples", "4", "-o", "baked"), (0,)),
             (("displaced", "builtin:sphere", "a.png", "--triangles", "1", "-o", "s.glb"), (0,)),
             (("lobe", "a.png", "--size", "1x1", "-o", "lobes"), (0,)),
             (("mip", MAPPED, "--mip-filter", "ssgt", "-o", "b.mip", "--preview", "seen"), (0,)),
             (("mip", MAPPED, "--format", "png-levels", "-o", "textures"), (0,)), (("mip", MAPPED, "--format", "exr-mip", "-o", "levels"), (0,))],
    "export": [*(((what, "--technique", "lobe_line", "-o", f"l.{what}"), (0,)) for what in ("essl", "hlsl", "msl", "wgsl", "three", "three-node", "babylon", "godot", "bevy")),
               (("glsl", "--technique", "lobe_line", "-o", "l.glsl"), (0,)), (("glsl", "--technique", "filtered_is", "-o", "-"), (0,)),
               (("page", "builtin:plate", *BARE, "-o", "p.html"), (0, 77))],
    "list": [((what,), (0,)) for what in ("all", "techniques", "scenes", "environments", "models", "area-lights", "mip-filters", "extensions")],
    "merge": [(("nothing",), (4,))],
    "submit": [(("--for", engine, "--", "render", "builtin:plate", "--turntable", "8", "-o", "t%d.png"), (0,)) for engine in ("slurm", "mpi", "parallel", "k8s", "openjd", "github")],
    "manual": [((what,), (0,)) for what in ("man", "bash", "zsh", "fish", "markdown")],
    "info": [((), (0,)), (("--json",), (0,))],
}
LEFT = {"bake": 1}  # number of WHATs that the laboratory runs


def run_each(bench, name, runs, timeout=120.0):
    for words, codes in runs:
        done = bench.run(name, *words, env=NO_DEVICE, timeout=timeout)
        check(done.code in codes, done.describe())
        check("Sanitizer" not in done.err and "runtime error" not in done.err, done.describe())
        for word in words:
            if word.endswith(".json"):
                check(done.code or json.loads((bench.folder / word).read_text()), f"{word} is empty")


def check_named(bench, of_lab, names):
    """Checks that the help's subcommands, of the laboratory or of the product, are these."""
    said = bench.run("--help").expect(0).out
    named = {line.split()[0] for line in said.split("Subcommands:\n")[1].split("\n\n")[0].splitlines()}
    named = named & lab_commands() if of_lab else named - lab_commands()
    check(named == set(names), f"{sorted(named ^ set(names))}: in the help or among these runs, not in both")


def check_whats(bench, name, runs, left=0):
    """Checks that each WHAT in the help has a run, but for the number that is left."""
    whats = re.search(r"^  WHAT(?: REQUIRED)? +(.*)$", bench.run(name, "--help").expect(0).out, re.MULTILINE)
    whats = re.findall(r"[a-z-]+", re.sub(r"\(.*| or ", " ", whats.group(1))) if whats else []
    without = set(whats) - {words[0] for words, _ in runs if words}
    check(len(without) == left, f"{name} {sorted(without)}: in the help, and without a run; {left} may be")


@case("subcommand.each_runs_small", "input", budget=11)
def each(bench):
    """Starts every subcommand several times."""
    check_named(bench, False, RUNS)
    (bench.folder / "goldens.json").write_text('{"rows": [{"name": "a", "picture": "a.png"}]}')
    for name, runs in RUNS.items():
        check_whats(bench, name, runs, LEFT.get(name, 0))
        run_each(bench, name, runs)


def refuse_each(bench, commands, on_devices):
    """Each command prints one line on invalid input. Drivers may print more, so the exit code alone counts for those on devices."""
    (bench.folder / "bad.glb").write_bytes(b"glTF, not")
    (bench.folder / "bad.exr").write_bytes(b"\x76\x2f\x31\x01, not")
    for words, codes in commands:
        done = bench.run(*words)
        check(done.code in codes, done.describe())
        done.expect_one_line()
    for words in on_devices:
        done = bench.run(*words, env=NO_DEVICE)
        check(done.code in (4, 77), done.describe())


@case("subcommand.each_refuses_bad_input", "input")
def bad_input(bench):
    refuse_each(bench, ((("render", "bad.glb"), (4,)), (("render", "--env", "bad.exr"), (4,)), (("compare", "bad.exr", "bad.exr"), (4,)),
                        (("chart", "bad.glb", "-o", "r"), (4, 77)), (("chart", "--env", "bad.exr", "-o", "r"), (4, 77)), (("profile", "bad.glb"), (4,)),
                        (("golden", "check", "bad.glb"), (4,)), (("list", "nothing"), (2,)), (("info", "nothing"), (2,))),
                (("parity", "bad.glb", *VIEW, "--device", "lavapipe"),))
