"""`burnish render --backend reference`: options, files, interruption."""

import os
import signal
import subprocess
import time

from harness import Skipped, case, check

SMALL = ("--backend", "reference", "--size", "48x32", "--env-size", "64", "--env-samples", "32")


def needs_embree(bench):
    if "reference" not in bench.run("info").expect(0).out:
        raise Skipped("built without Embree")


@case("reference.pictures_and_figures_are_whole", "input")
def pictures(bench):
    needs_embree(bench)
    found = bench.figures(*SMALL, "--samples", "256", "-o", "mean.exr", "--variance", "variance.exr")
    check(bench.left_behind() == ["mean.exr", "variance.exr"], f"left behind: {bench.left_behind()}")
    check(found["backend"] == found["technique"] == "reference" and found["samples"] == 256 and "Embree" in found["device"], f"{found}")
    figures = found["reference"]
    check(figures["mode"] == "direct" and figures["samples_before"] == 0, f"{figures}")
    check(0 < figures["relative_error"] < 1 and figures["million_samples_per_second"] > 0.01, f"{figures}")
    check(figures["rays"] >= 48 * 32 * 64 and 0 < figures["ray_time_fraction"] < 1, f"{figures}")
    check(found["nan_pixels"] == 0, f"{found}")


@case("reference.modes_differ_and_threads_and_isa_do_not", tier="nightly")
def modes(bench):
    needs_embree(bench)
    hashes = set()
    for mode in ("direct", "shadowed", "path"):
        words = (*SMALL, "--samples", "64", "--reference-mode", mode)
        one = bench.figures(*words, "--threads", "1")["pixel_hash"]
        check(bench.figures(*words, "--threads", "3")["pixel_hash"] == one, f"{mode}: threads change the picture")
        check(bench.figures(*words, "--threads", "2", "--isa", "scalar")["pixel_hash"] == one, f"{mode}: the ISA changes the picture")
        hashes.add(one)
    check(len(hashes) == 3, "two modes give one picture")


@case("reference.bakes_only_what_it_reads", tier="nightly")
def bakes_little(bench):
    """Without a cached bake the reference makes none, and its image is equal."""
    needs_embree(bench)
    own = {"XDG_CACHE_HOME": str(bench.folder / "own")}
    for environment in ("builtin:sky", "builtin:studio"):
        words = (*SMALL, "--env", environment, "--samples", "64")
        alone = bench.figures(*words, env=own)
        check(not alone["environment_from_cache"] and not list((bench.folder / "own").rglob("*.bnenv")), f"{environment} was baked as a whole")
        bench.figures("--size", "16x16", "--env", environment, *SMALL[4:], env=own)
        cached = bench.figures(*words, env=own)
        check(cached["environment_from_cache"], f"the bake of {environment} is not taken")
        check(alone["pixel_hash"] == cached["pixel_hash"] and alone["key_lights"] == cached["key_lights"], f"{environment}: {alone} and {cached}")
        for kept in (bench.folder / "own").rglob("*.bnenv"):
            kept.unlink()


@case("reference.samples_are_whole_passes")
def passes(bench):
    needs_embree(bench)
    done = bench.run("render", *SMALL, "--samples", "65").expect(0)
    check("--samples 65" in done.err and "128" in done.err, done.describe())


@case("reference.options_that_do_not_fit_are_refused")
def misfits(bench):
    needs_embree(bench)
    for words, needle in (
        (("--reference-mode", "fast"), "path"),
        (("--reference-strategy", "hope"), "mis"),
        (("--bounces", "3"), "--bounces"),
        (("--bounces", "-1", "--reference-mode", "path"), "--bounces"),
        (("--samples", "0"), "--samples"),
        (("--target-error", "2"), "--target-error"),
        (("--frames", "2"), "--frames"),
        (("--variance", "v.png"), "--variance"),
        (("--variance", "v.exr", "--samples", "64"), "--variance"),
        (("--checkpoint", "-"), "--checkpoint"),
        (("--checkpoint", "no/such/folder/c"), "no/such/folder"),
        (("--checkpoint", "a.exr", "-o", "a.exr"), "a.exr"),
        (("--variance", "a.exr", "-o", "a.exr"), "a.exr"),
    ):
        done = bench.run("render", *SMALL, *words)
        check(done.code in (2, 7), done.describe())
        done.expect_one_line(needle)
    for words in (("--checkpoint", "c"), ("--variance", "v.exr"), ("--target-error", "0.1"), ("--reference-mode", "path"), ("--bounces", "2")):
        bench.run("render", *words).expect(2).expect_one_line(words[0], "--backend reference")
    check(bench.left_behind() == [], f"left behind: {bench.left_behind()}")


@case("reference.target_error_is_met")
def target(bench):
    needs_embree(bench)
    found = bench.figures(*SMALL, "--samples", "1000000", "--target-error", "0.05")
    check(found["reference"]["relative_error"] <= 0.05 and 512 <= found["samples"] < 100000, f"{found}")


@case("reference.checkpoint_of_something_else_is_refused")
def other_checkpoint(bench):
    needs_embree(bench)
    words = (*SMALL, "--samples", "64", "--checkpoint", "part")
    bench.run("render", *words).expect(0)
    before = (bench.folder / "part").read_bytes()
    for change in (("--seed", "5"), ("--roughness", "0.3"), ("--env", "builtin:sky"), ("--reference-mode", "path"), ("--eye", "1,1,1")):
        bench.run("render", *words, *change, "-o", "a.exr").expect(4).expect_one_line("part", "another picture")
    check((bench.folder / "part").read_bytes() == before and bench.left_behind() == ["part"], f"{bench.left_behind()}")
    (bench.folder / "part").write_bytes(b"a letter")
    bench.run("render", *words).expect(4).expect_one_line("part", "not a checkpoint")


@case("reference.stopped_by_a_signal_goes_on", tier="nightly")
def stopped(bench):
    needs_embree(bench)
    words = (*SMALL, "--samples", "16384", "--reference-mode", "path", "-o", "a.exr")
    whole = bench.figures(*words)["pixel_hash"]
    (bench.folder / "a.exr").unlink()
    stops = 0
    for attempt in range(200):
        number = (signal.SIGINT, signal.SIGTERM)[attempt % 2]
        child = subprocess.Popen([bench.program, "render", *words, "--checkpoint", "part", "--stats", "s.json"], cwd=bench.folder,
                                 env=bench.environment({}), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        time.sleep(0.3 + 0.1 * attempt)
        child.send_signal(number)
        _, said = child.communicate(timeout=120)
        if child.returncode == 0:
            break
        if child.returncode == -number:  # killed before the handler was ready: nothing was lost
            continue
        check(child.returncode == 128 + number, f"exit code {child.returncode}: {said!r}")
        check(b"stopped" in said and b"part" in said, f"{said!r}")
        check("a.exr" not in os.listdir(bench.folder), "a picture was written")
        stops += 1
    found = bench.figures(*words, "--checkpoint", "part")
    check(found["pixel_hash"] == whole, "stopping changed the picture")
    check(found["reference"]["samples_before"] == 16384, f"{found}")
    check(stops > 0, "the run was never stopped")
