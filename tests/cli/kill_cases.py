"""Jobs that are killed (kill -9) at random moments and started again: no loss, equal bits, no leftovers."""

import json
import random
import shutil
import signal
import subprocess
import time

from fault_cases import CHART, REFERENCE, TINY, needs_embree
from harness import case, check


def start(bench, words, env=None):
    return subprocess.Popen([bench.program, *map(str, words)], cwd=bench.folder, env=bench.environment(env or {}),
                            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def seconds_of(bench, words, env=None):
    begin = time.monotonic()
    bench.run(*words, env=env).expect(0)
    return time.monotonic() - begin


def kill_at_random(bench, words, kills, seed, longest, env=None, after=lambda: None, enough=lambda: True):
    """Starts the command until it was killed `kills` times and `enough` is true. `after` checks the files. A run lives for at most
    `longest` seconds. The machine's load changes, so a run that ends by itself tells the present duration, and runs then live longer
    until there are enough kills."""
    chance = random.Random(seed)
    killed = 0
    for _ in range(20 * kills):
        if killed >= kills and enough():
            return
        child = start(bench, words, env)
        begin = time.monotonic()
        try:
            code = child.wait(timeout=chance.uniform(0.0, longest))
            longest = time.monotonic() - begin
        except subprocess.TimeoutExpired:
            child.kill()
            code = child.wait()
            longest *= 1.0 if killed < kills else 1.5
        check(code in (0, -signal.SIGKILL), f"it ended with {code}")
        killed += code == -signal.SIGKILL
        after()
    check(killed >= kills and enough(), f"killed {killed} times only, or nothing was kept")


def temporary(names):
    return [name for name in names if name.endswith((".tmp", ".bntmp", ".part"))]


def killed_reference(bench, kills):
    """Renders some rounds of samples, with the state written after each."""
    needs_embree(bench)
    words = (*REFERENCE[:-1], "--samples", "8192", "--env", "builtin:sky")
    begin = time.monotonic()
    straight = bench.figures(*words[1:])["pixel_hash"]
    longest = time.monotonic() - begin
    words = (*words, "--checkpoint", "c.part", "--checkpoint-seconds", "0", "-o", "o.exr")
    kill_at_random(bench, words, kills, 7, 0.9 * longest, enough=(bench.folder / "c.part").exists)
    found = bench.figures(*words[1:])
    check(found["reference"]["samples_before"] > 0, "it did not go on from what was kept")
    check(found["pixel_hash"] == straight, "the picture after kills is another one")
    check(bench.left_behind() == ["c.part", "o.exr"], f"left: {bench.left_behind()}")


@case("kill.references_go_on", tier="nightly")
def references(bench):
    killed_reference(bench, 3)


@case("kill.references_go_on_long", tier="nightly")
def references_long(bench):
    killed_reference(bench, 40)


def killed_charts(bench, kills):
    """Compares a chart's errors, images and reference; times differ from run to run."""
    needs_embree(bench)
    chart = (*CHART, "--sweep", "roughness=0.2,0.5")
    env = lambda name: {"XDG_CACHE_HOME": str(bench.folder / name)}

    def made(folder):
        rows = json.loads((bench.folder / folder / "report.json").read_text())["rows"]
        keys = ("technique", "settings", "flip_mean", "flip_p99", "rel_mse", "max_abs", "nan_pixels")
        return ([[row[key] for key in keys] for row in rows],
                {path.name: path.read_bytes() for path in (bench.folder / folder / "pictures").iterdir()})

    longest = seconds_of(bench, (*chart, "-o", "straight"), env("straight_cache"))

    def rows_are_whole():
        kept = bench.folder / "report/rows.json"
        if kept.exists():
            json.loads(kept.read_text())

    words = (*chart, "-o", "report")
    kill_at_random(bench, words, kills, 3, longest, env("cache"), rows_are_whole)
    bench.run(*words, env=env("cache")).expect(0)
    check(made("report") == made("straight"), "errors or pictures after kills are other ones")
    caches = [{path.name: path.read_bytes() for path in (bench.folder / name / "burnish").iterdir()} for name in ("cache", "straight_cache")]
    check(caches[0] == caches[1], f"the caches hold {sorted(caches[0])} and {sorted(caches[1])}")
    left = temporary(path.name for path in (bench.folder / "report").rglob("*"))
    check(not left, f"left: {left}")


@case("kill.charts_go_on", tier="nightly")
def charts(bench):
    killed_charts(bench, 3)


@case("kill.charts_go_on_long", tier="nightly")
def charts_long(bench):
    killed_charts(bench, 40)


def killed_bakes(bench, kills):
    words = ("render", "--size", "32x24", "--msaa", "1", "--env-size", "64", "--env-samples", "64", "--threads", "2", "-q", "-o", "o.png")
    env = lambda name: {"XDG_CACHE_HOME": str(bench.folder / name)}
    kept = lambda name: {path.name: path.read_bytes() for path in (bench.folder / name / "burnish").glob("*")}
    longest = seconds_of(bench, words, env("straight"))
    picture = (bench.folder / "o.png").read_bytes()
    whole = kept("straight")

    def nothing_half():
        for name, data in kept("cache").items():
            check(name not in whole or data == whole[name], f"{name} is damaged after a kill")
        for name in whole:
            if name != "locks":
                (bench.folder / "cache/burnish" / name).unlink(missing_ok=True)

    kill_at_random(bench, words, kills, 5, longest, env("cache"), nothing_half)
    bench.run(*words, env=env("cache")).expect(0)
    check(kept("cache") == whole, f"the cache holds {sorted(kept('cache'))}")
    check((bench.folder / "o.png").read_bytes() == picture, "the picture after kills is another one")


@case("kill.bakes_are_whole_or_not_there", tier="nightly")
def bakes(bench):
    killed_bakes(bench, 4)


@case("kill.bakes_are_whole_or_not_there_long", tier="nightly")
def bakes_long(bench):
    killed_bakes(bench, 40)


def killed_renders(bench, kills):
    words = ("render", *TINY, "-o", "o.exr", "-o", "o.png", "--stats", "s.json")
    longest = seconds_of(bench, words) + 0.05
    whole = {name: (bench.folder / name).read_bytes() for name in ("o.exr", "o.png")}

    def nothing_half():
        for name, data in whole.items():
            check((bench.folder / name).read_bytes() == data, f"{name} is damaged after a kill")
        json.loads((bench.folder / "s.json").read_text())

    kill_at_random(bench, words, kills, 13, longest, after=nothing_half)
    bench.run(*words).expect(0)
    check(bench.left_behind() == ["o.exr", "o.png", "s.json"], f"left: {bench.left_behind()}")


@case("kill.renders_leave_whole_files", tier="nightly")
def renders(bench):
    killed_renders(bench, 5)


@case("kill.renders_leave_whole_files_long", tier="nightly")
def renders_long(bench):
    killed_renders(bench, 60)


def killed_job(bench, words, made, kills):
    """A file under its final name is complete after a kill. The command, given again, makes the bytes of an uninterrupted run and leaves
    nothing else."""
    of = lambda word: [text.replace("{}", word) for text in words]
    env = {"XDG_CACHE_HOME": str(bench.folder / "cache")}

    def files(word):
        found = {}
        for root in (bench.folder / text.replace("{}", word) for text in made):
            for path in [root] if root.is_file() else root.rglob("*"):
                if path.is_file():
                    found[str(path.relative_to(bench.folder)).replace(word, "", 1)] = path.read_bytes()
        return found

    longest = seconds_of(bench, of("straight"), env)
    straight = files("straight")
    check(straight, "nothing was made")

    def whole():
        for path, data in files("killed").items():
            check(temporary([path]) or straight.get(path) == data, f"{path} is not whole after a kill")

    kill_at_random(bench, of("killed"), kills, 13, 0.9 * longest, env, whole)
    bench.run(*of("killed"), env=env, timeout=300.0).expect(0)
    check(files("killed") == straight, f"{sorted(files('killed'))} after kills, {sorted(straight)} without")
    left = temporary(path.name for path in bench.folder.rglob("*"))
    check(not left, f"left: {left}")


def add_job(name, words, made, needs=lambda bench: None):
    """Words of a job and its output (files or folders), equal in every run. {} is a name before its suffix. needs: skips."""
    def killed(bench, kills):
        needs(bench)
        killed_job(bench, words, made, kills)

    case(f"kill.{name}_are_made_whole", tier="nightly")(lambda bench: killed(bench, 2))
    case(f"kill.{name}_are_made_whole_long", tier="nightly")(lambda bench: killed(bench, 25))


add_job("levels", ("bake", "mip", "builtin:shaderballs", "--mip-filter", "mipnet", "--couple", "albedo", "-q", "-o", "{}.mip", "--preview", "{}"), ("{}.mip", "{}"))
add_job("environments", ("bake", "environment", "builtin:sky", "--env-size", "64", "--env-samples", "64", "-q", "-o", "{}"), ("{}",))


def sets_of_textures(bench, rounds, formats):
    """Three commands make one new folder together, and a fourth is killed at some moment. At each moment the folder is missing or
    complete. In the end all three have succeeded, and nothing else is left."""
    chance = random.Random(29)
    for form in formats:
        words = ("bake", "mip", "builtin:roofs=1", "--threads", "1", "--format", form, "-q", "-o")
        longest = seconds_of(bench, (*words, f"whole_{form}"))
        whole = {path.name: path.read_bytes() for path in (bench.folder / f"whole_{form}").iterdir()}
        for i in range(rounds):
            folder = bench.folder / f"{form}_{i}"
            children = [start(bench, (*words, folder.name)) for _ in range(4)]
            time.sleep(chance.uniform(0.5, 2.0) * longest)
            children[0].kill()
            children[0].wait()
            if folder.exists():
                check({path.name for path in folder.iterdir() if path not in temporary_paths(folder)} == set(whole), f"{form}: not all files")
            codes = [child.wait(timeout=120) for child in children[1:]]
            check(codes == [0, 0, 0], f"{form}, round {i}: exit codes {codes}")
            bench.run(*words, folder.name).expect(0)  # removes the killed run's leftovers
            check({path.name: path.read_bytes() for path in folder.iterdir()} == whole, f"{form}, round {i}: other files")
    left = temporary(bench.left_behind())
    check(not left, f"left: {left}")


def temporary_paths(folder):
    return [path for path in folder.iterdir() if temporary([path.name])]


def killed_sets(bench, kills):
    """A single killed command leaves all files or no folder."""
    words = ("bake", "mip", "builtin:roofs=1", "--threads", "1", "--format", "png-levels", "-q", "-o")
    longest = seconds_of(bench, (*words, "whole"))
    names = {path.name for path in (bench.folder / "whole").iterdir()}
    folder = bench.folder / "killed"

    def together():
        if folder.exists():
            check({path.name for path in folder.iterdir()} == names, f"a part of the files: {sorted(path.name for path in folder.iterdir())}")
            shutil.rmtree(folder)

    kill_at_random(bench, (*words, "killed"), kills, 31, 1.1 * longest, after=together)
    bench.run(*words, "killed").expect(0)
    check(not temporary(bench.left_behind()), f"left: {bench.left_behind()}")


@case("kill.sets_of_textures_appear_together", tier="nightly")
def sets(bench):
    sets_of_textures(bench, 3, ("png-levels",))
    killed_sets(bench, 4)


@case("kill.sets_of_textures_appear_together_long", tier="nightly")
def sets_long(bench):
    sets_of_textures(bench, 24, ("png-levels", "exr-mip"))
    killed_sets(bench, 40)
