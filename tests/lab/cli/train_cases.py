"""burnish train: nets that make mipmaps."""

import hashlib
import json
import os
import pathlib
import signal
import subprocess
import time

from compare_cases import png
from confine_cases import with_few_threads
from detail_cases import bumps
from harness import case, check
from pieces_cases import one_and_pieces, pieces_of

SMALL = ("train", "mip", "--steps", "20")
SHIPPED = pathlib.Path(__file__).resolve().parents[3] / "shading/bake/mipnet"


@case("train.threads_and_instruction_sets_make_no_difference", budget=5)
def threads(bench):
    hashes = set()
    for name, options, env in (("1", ("--threads", "1"), {}), ("3", ("--threads", "3"), {}), ("s", (), {"BN_FORCE_ISA": "avx2"})):
        bench.run("train", "mip", "--steps", "4", *options, "-o", f"w{name}.mipnet", "-q", env=env).expect(0)
        hashes.add(hashlib.sha256((bench.folder / f"w{name}.mipnet").read_bytes()).hexdigest())
    check(len(hashes) == 1, "weights by 1 and 3 threads and by AVX2 differ")
    check(bench.left_behind() == ["w1.mipnet", "w3.mipnet", "ws.mipnet"], f"left {bench.left_behind()}")


@case("train.killed_goes_on_to_the_same_bytes", budget=5)
def killed(bench):
    bench.run(*SMALL, "-o", "straight.mipnet", "-q").expect(0)
    part = bench.folder / "kept.part"
    words = (*SMALL, "--checkpoint", "kept.part", "-o", "w.mipnet", "-q")
    child = subprocess.Popen([bench.program, *words], cwd=bench.folder, env=bench.environment({}))
    time.sleep(1.0)
    child.send_signal(signal.SIGTERM)
    code = child.wait()
    check(code in (128 + signal.SIGTERM, 0, -signal.SIGTERM), f"it ended with {code}")
    check(code != 128 + signal.SIGTERM or part.exists(), "nothing was kept")
    bench.run(*words).expect(0)
    check((bench.folder / "w.mipnet").read_bytes() == (bench.folder / "straight.mipnet").read_bytes(), "the weights after a stop are others")
    check(bench.left_behind() == ["straight.mipnet", "w.mipnet"], f"left {bench.left_behind()}")


@case("train.pieces_of_seeds_make_the_best_weights", tier="nightly")
def seeds(bench):
    """One seed is a piece: more seeds share the pieces of fewer, and the best weights equal the weights of their seed alone."""
    words = ("train", "mip", "--steps", "40", "--size", "1x8", "--seed", "5", "-q")
    three = (*words, "--seeds", "3")
    one_and_pieces(bench, three, ("best.mipnet",), machine=("--threads", "1"))
    alone = {}
    for seed in range(5, 8):
        bench.run(*words, "--seed", str(seed), "-o", f"{seed}.mipnet").expect(0)
        alone[seed] = (bench.folder / f"{seed}.mipnet").read_bytes()
    best = (bench.folder / "one/best.mipnet").read_bytes()
    check(best in alone.values(), "the best weights are those of no seed")
    for seed in alone:
        bench.run("train", "mip", "--evaluate", f"{seed}.mipnet", "--validation", "-q", "--json", f"{seed}.json").expect(0)
    error = {seed: [row["mean"]["l1"] for row in json.loads((bench.folder / f"{seed}.json").read_text())["rows"] if row["filter"] == "mipnet"] for seed in alone}
    check(best == alone[min(error, key=lambda seed: sum(error[seed]))], f"not the lowest error: { {seed: sum(e) for seed, e in error.items()} }")
    keys = [key for key, _, _ in pieces_of(bench, (*three, "-o", "a.mipnet"))]
    check(keys[:2] == [key for key, _, _ in pieces_of(bench, (*words, "--seeds", "2", "-o", "b.mipnet"))], "two seeds have other pieces")
    check(keys[1:] == [key for key, _, _ in pieces_of(bench, (*words, "--seed", "6", "--seeds", "2", "-o", "b.mipnet"))], "a later first seed has other pieces")
    check(not set(keys) & {key for key, _, _ in pieces_of(bench, (*three, "--light", "1", "-o", "a.mipnet"))}, "another loss has the same pieces")
    bench.run(*three, "-o", "a.mipnet", "--pieces", "--checkpoint", "c.part").expect(2).expect_one_line("--checkpoint")
    # A killed maker's checkpoint is used by the next: it ends at the same bytes
    long = (*words, "--steps", "240", "-o", "long.mipnet")
    maker = subprocess.Popen([bench.program, *long, "--take", "--work", "k"], cwd=bench.folder, env=bench.environment({}))
    time.sleep(0.6)
    maker.send_signal(signal.SIGTERM)
    code = maker.wait()
    check(code in (0, 128 + signal.SIGTERM, -signal.SIGTERM), f"it ended with {code}")
    check(code != 128 + signal.SIGTERM or list((bench.folder / "k").glob("*.part")), "no checkpoint stays")
    bench.run(*long, "--take", "--work", "k", timeout=100).expect(0)
    check(not list((bench.folder / "k").glob("*.part")), "a checkpoint stays beside its piece")
    bench.run("merge", "k").expect(0)
    merged = (bench.folder / "long.mipnet").read_bytes()
    bench.run(*long, timeout=100).expect(0)
    check((bench.folder / "long.mipnet").read_bytes() == merged, "other bytes after a stop")


@case("train.what_is_wrong_says_one_line", "input")
def wrong(bench):
    (bench.folder / "bad.mipnet").write_bytes(b"bnmip01\n" + b"\1\0\0\0" * 20)
    (bench.folder / "t.mipnet.part").write_bytes(b"something else")
    for words, code, needle in (
            ((), 2, "-o"), (("-o", "w.mipnet", "--evaluate", "w.mipnet"), 2, "-o"), (("--evaluate", "no.mipnet"), 4, "no.mipnet"),
            (("--evaluate", "bad.mipnet"), 4, "bad.mipnet"), (("--evaluate", "bad.mipnet", "--steps", "5"), 2, "--steps"),
            (("-o", "w.mipnet", "--maps", "."), 4, "no folder"), (("-o", "w.mipnet", "--maps", ".", "--only-maps", "."), 2, "--only-maps"), (("-o", "w.mipnet", "--brdf", "ward"), 2, "--brdf"),
            *((("-o", "w.mipnet", "--size", size), 2, "--size") for size in ("0x3", "3", "2x32/", "2x32/2x64/2x8", "9x3", "2x32/2", "2x5000", "-1x4", "2x32 ")),
            (("-o", "w.mipnet", "--loss", "l3"), 2, "--loss"), (("-o", "w.mipnet", "--levels", "6"), 2, "--levels"),
            (("-o", "w.mipnet", "--from", "bad.mipnet"), 4, "bad.mipnet"), (("-o", "w.mipnet", "--from", "none"), 4, "none"),
            (("-o", "w.mipnet", "--taught-by", "bad.mipnet"), 4, "bad.mipnet"), (("-o", "w.mipnet", "--taught-by", SHIPPED / "beckmann.mipnet"), 4, "beckmann"),
            (("-o", "w.mipnet", "--footprint", "8", "--size", "2x8"), 2, "--footprint"), (("-o", "w.mipnet", "--footprint", "6"), 2, "--footprint"),
            (("-o", "w.mipnet", "--light", "-1"), 2, "--light"), (("-o", "w.mipnet", "--seeds", "0"), 2, "--seeds"),
            (("-o", "w.mipnet", "--from", SHIPPED / "beckmann.mipnet"), 4, "beckmann"), (("-o", "w.mipnet", "--from", SHIPPED / "ggx_aniso.mipnet", "--size", "2x8"), 4, "2x32/2x64"), (("-o", "-"), 2, "-o"), (("-o", "no/w.mipnet"), 7, "no/w.mipnet"),
            (("-o", "t.mipnet"), 4, "t.mipnet.part"), (("-o", "w.mipnet", "--steps", "0"), 2, "--steps")):
        bench.run("train", "mip", *words).expect(code).expect_one_line(needle)
    bench.run("train", "map", "-o", "w.mipnet").expect(2).expect_one_line("map")
    check(bench.left_behind() == ["bad.mipnet", "t.mipnet.part"], f"left {bench.left_behind()}")


def choices(bench, *few):
    """Each choice beside `few`, which are in all commands."""
    folder = bench.folder / "maps/waves"
    folder.mkdir(parents=True)
    (folder / "a_normal.png").write_bytes(png(64, 64, bumps))
    (bench.folder / "from.mipnet").write_bytes((SHIPPED / "ggx_aniso.mipnet").read_bytes())
    made = {}
    maps = () if few else (("--maps", "maps"), ("--only-maps", bench.folder / "maps/"))
    for words in ((), ("--loss", "l2"), ("--loss", "charbonnier"), ("--tone", "log"), ("--levels", "2"), ("--size", "2x16"), *maps,
                  ("--from", bench.folder / "from.mipnet"), ("--taught-by", bench.folder / "from.mipnet"), ("--light", "0.5"), ("--mirrored", "1"),
                  ("--footprint", "8")):
        bench.run("train", "mip", "--steps", "2" if few else "4", *few, *words, "-o", "w.mipnet", "-q").expect(0)
        made[words] = (bench.folder / "w.mipnet").read_bytes()
        said = json.loads(bench.run("info", "--json", "--weights", "w.mipnet").expect(0).out)["command"].split()
        # paths lose their folders, so nothing identifies the machine
        check(all(str(word).rpartition("/")[2] in said for word in words) and not any("/" in word for word in said[1:] if word != said[said.index("--size") + 1]),
              f"{words}: {said}")
        bench.run(*said[1:], "-o", "again.mipnet", "-q").expect(0)
        check((bench.folder / "again.mipnet").read_bytes() == made[words], f"{words}: the command makes others")
    check(len(set(made.values())) == len(made), "an option changes nothing")
    # nets with footprints of four and sixty-four texels make pyramids, too
    for words in (("--size", "2x16"), ("--footprint", "8")):
        (bench.folder / "w.mipnet").write_bytes(made[words])
        bench.run("bake", "mip", "maps/waves", "--mip-filter", "mipnet", "--mip-net", "w.mipnet", "-q", "-o", "a.mip").expect(0)


@case("train.each_choice_makes_other_weights_and_says_how", budget=4)
def choices_for_one_map(bench):
    choices(bench, "--only-maps", bench.folder / "maps/")


@case("train.each_choice_beside_the_families_makes_other_weights_and_says_how", tier="nightly")
def choices_for_families(bench):
    choices(bench)


@case("train.shipped_weights_say_what_they_are")
def shipped(bench):
    for file in sorted(SHIPPED.glob("*.mipnet")):
        name = file.stem
        check(file.stat().st_size < 100000, f"{file} is too large")
        said = json.loads(bench.run("info", "--json", "--weights", file).expect(0).out)
        check(said["brdf"] == name and said["steps"] > 0, f"{said}")
        check(said["command"].startswith(f"burnish train mip --brdf {name} ") and f"--seed {said['seed']}" in said["command"], f"{said}")
        check("hammered" in said["families"] and "twill" not in said["families"], f"{said}")


@case("train.the_shipped_weights_are_what_the_commands_make", tier="nightly")
def remade(bench):
    for file in sorted(SHIPPED.glob("*.mipnet")):
        words = json.loads(bench.run("info", "--json", "--weights", file).expect(0).out)["command"].split()[1:]
        bench.run(*words, "-o", file.name, "-q", timeout=3600).expect(0)
        check((bench.folder / file.name).read_bytes() == file.read_bytes(), f"{file.name} is another one")


@case("confine.few_threads_train_the_same", tier="nightly")
def few_threads(bench):
    jobs = {"w.mipnet": (("train", "mip", "--steps", "2", "--threads", "3", "-q"), (0,))}
    with_few_threads(bench, jobs, range(1, 13), 45000 + os.getpid() % 5000)
