"""burnish golden: many pictures against golden ones, and the way of a change from a failed check to a blessed golden."""

import json
import os
import pathlib
import re
import shutil
import stat
import struct
import subprocess
import xml.etree.ElementTree

from browser import Browser
from harness import Skipped, case, check

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SMALL = ["--size", "64x48", "--env-size", "64", "--env-samples", "64"]
ROWS = [{"name": "pot", "scene": "builtin:teapot"}, {"name": "plate", "scene": "builtin:plate", "hold": {"flip": 0.01}},
        {"name": "ball", "scene": "builtin:sphere", "keep": "hash"}]


def write(bench, rows, **more):
    (bench.folder / "m.json").write_text(json.dumps({"defaults": {"options": SMALL}, "rows": rows, **more}))


def results(bench, folder="golden-results"):
    return {r["name"]: r for r in map(json.loads, (bench.folder / folder / "results.jsonl").read_text().splitlines())}


def verdicts(bench, folder="golden-results"):
    return {name: r["verdict"] for name, r in results(bench, folder).items()}


def program(bench, name, text):
    path = bench.folder / name
    path.write_text("#!/bin/sh\n" + text + "\n")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)
    return f"./{name}"


@case("golden.goes_from_nothing_to_a_blessed_change", budget=3)
def whole_way(bench):
    write(bench, ROWS)
    bench.run("golden", "check", "m.json").expect(5)
    check(set(verdicts(bench).values()) == {"missing"}, verdicts(bench))
    done = bench.run("golden", "bless", "m.json").expect(0)
    check(done.out.count("blessed ") == 3 and "3 pictures blessed" in done.out, done.out)
    bench.run("golden", "check", "m.json").expect(0)
    check(set(verdicts(bench).values()) == {"passed"}, verdicts(bench))
    check("nothing to bless" in bench.run("golden", "bless", "m.json").expect(0).out, "something was blessed")
    # A small change passes by its tolerance, a large one fails with reasons in words
    changed = [{**row, "options": ["--exposure", "0.001" if row["name"] == "plate" else "0.5"]} for row in ROWS]
    write(bench, changed)
    done = bench.run("golden", "check", "m.json").expect(1)
    check(verdicts(bench) == {"pot": "differs", "plate": "passed", "ball": "differs"}, verdicts(bench))
    check("% of the pixels differ, within 64x48 pixels from 0,0" in results(bench)["pot"]["reason"] and "its hash is" in done.out, done.out)
    suite = xml.etree.ElementTree.parse(bench.folder / "golden-results/junit.xml").getroot()
    check(suite.get("tests") == "3" and suite.get("failures") == "2" and suite.get("errors") == "0", suite.attrib)
    # The list chooses the blessed pictures
    (bench.folder / "list.txt").write_text('"pot"\n')
    done = bench.run("golden", "bless", "m.json", "--from", "list.txt").expect(0)
    check("1 picture blessed" in done.out and "goldens/pot.png" in done.out, done.out)
    bench.run("golden", "check", "m.json").expect(1)
    check(verdicts(bench) == {"pot": "passed", "plate": "passed", "ball": "differs"}, verdicts(bench))


@case("golden.bless_writes_where_the_manifest_says", budget=3)
def tampered(bench):
    """Results may come from somebody else's machine."""
    (bench.folder / "a.ppm").write_bytes(b"P6 1 1 255\n\0\0\0")
    write(bench, [{"name": "a", "picture": "a.ppm"}])
    bench.run("golden", "check", "m.json").expect(5)
    path = bench.folder / "golden-results/results.jsonl"
    path.write_text(path.read_text().replace("goldens/a.ppm", "outside.ppm"))
    bench.run("golden", "bless", "m.json").expect(0)
    check(not (bench.folder / "outside.ppm").exists() and (bench.folder / "goldens/a.ppm").exists(), "written elsewhere")
    path.write_text(path.read_text().replace('"missing"', '"bogus"'))
    bench.run("golden", "bless", "m.json").expect(4).expect_one_line("line 1")
    # From another folder the same files are meant
    (bench.folder / "goldens/a.ppm").unlink()
    (bench.folder / "sub").mkdir()
    bench.run("golden", "check", "sub/../m.json").expect(5)
    bench.run("golden", "bless", "m.json").expect(0)
    check((bench.folder / "goldens/a.ppm").exists(), "no golden")


@case("golden.bless_refuses_results_of_other_rows")
def stale(bench):
    """A picture of an earlier manifest never becomes golden. A row whose bits depend on the machine is told."""
    write(bench, ROWS[:1])
    bench.run("golden", "check", "m.json").expect(5)
    write(bench, [{**ROWS[0], "options": ["--roughness", "0.5"]}])
    bench.run("golden", "bless", "m.json").expect(4).expect_one_line("golden-results", "run golden check again")
    check(not (bench.folder / "goldens").exists(), "a stale picture is golden")
    bench.run("golden", "check", "m.json").expect(5)
    bench.run("golden", "bless", "m.json").expect(0)
    for options, held, told in ((["--budget-ms", "1e5"], {}, True), (["--budget-ms", "1e5"], {"hold": {"flip": 0.1}}, False), ([], {}, False)):
        write(bench, [{**ROWS[0], "options": options, **held}])
        done = bench.run("golden", "check", "m.json", "-o", "r")
        check(("other bits on another machine" in done.err) == told, f"{options} {held}: {done.err}")


@case("golden.makes_the_rows_that_are_named")
def named_rows(bench):
    write(bench, ROWS)
    bench.run("golden", "check", "m.json", "--row", "plate", "--row", "ball").expect(5)
    check(verdicts(bench) == {"plate": "missing", "ball": "missing"}, verdicts(bench))
    bench.run("golden", "bless", "m.json").expect(0)
    bench.run("golden", "check", "m.json", "--row", "ball").expect(0)
    check(verdicts(bench) == {"ball": "passed"}, verdicts(bench))
    bench.run("golden", "check", "m.json", "--row", "bal").expect(2).expect_one_line("--row", "did you mean 'ball'")
    bench.run("golden", "bless", "m.json", "--row", "ball").expect(2).expect_one_line("--row", "golden check")


@case("golden.draws_with_any_program", budget=3)
def commands(bench):
    (bench.folder / "a.ppm").write_bytes(b"P6 2 1 255\n" + bytes([255, 0, 0, 0, 255, 0]))
    copy = program(bench, "copy.sh", 'cp "$FROM" "$1"; echo made "$1"')
    rows = [{"name": "copied", "command": [copy, "out.ppm"], "picture": "out.ppm", "environment": {"FROM": "a.ppm"}},
            {"name": "there", "picture": "a.ppm"}]
    write(bench, rows)
    bench.run("golden", "check", "m.json").expect(5)
    bench.run("golden", "bless", "m.json").expect(0)
    bench.run("golden", "check", "m.json").expect(0)
    check((bench.folder / "golden-results/logs/copied.txt").read_text() == "made out.ppm\n", "the output of the program is not kept")
    (bench.folder / "a.ppm").write_bytes(b"P6 2 1 255\n" + bytes([255, 0, 0, 0, 254, 0]))
    bench.run("golden", "check", "m.json").expect(1)
    check("50.0 % of the pixels differ, within 1x1 pixels from 1,0" in results(bench)["there"]["reason"], results(bench))


@case("golden.programs_that_fail_are_named", budget=10)
def failing(bench):
    (bench.folder / "old.png").write_bytes(b"")
    bad = {"ends": ["sh", "-c", "echo no >&2; exit 3"], "hangs": ["sh", "-c", "sleep 60 & sleep 60"], "dies": ["sh", "-c", "kill -9 $$"],
           "writes nothing": ["true"], "into a folder": ["sh", "-c", "echo words > new/3.png; exit 0"], "absent": ["./no-such-program"]}
    rows = [{"name": name, "command": words, "picture": "old.png" if name == "writes nothing" else "new/3.png" if name == "into a folder" else f"{i}.png", "seconds": 0.5}
            for i, (name, words) in enumerate(bad.items())]
    rows.append({"name": "no picture", "picture": "absent.png"})
    rows.append({"name": "no scene", "scene": "absent.glb"})
    write(bench, rows)
    done = bench.run("golden", "check", "m.json", "--jobs", "3", timeout=30.0).expect(4)
    reasons = {name: r["reason"] for name, r in results(bench).items()}
    for name, words in {"ends": "exit code 3: no", "hangs": "stopped after 0.5 s", "dies": "signal 9", "writes nothing": "wrote no old.png", "into a folder": "new/3.png",
                        "absent": "cannot be started", "no picture": "absent.png", "no scene": "absent.glb"}.items():
        check(words in reasons[name], f"{name}: {reasons[name]}")
    check(set(verdicts(bench).values()) == {"failed"} and "8 could not be made" in done.out, done.out)
    check((bench.folder / "golden-results/logs/ends.txt").read_text() == "no\n", "the output of the program is not kept")
    bench.run("golden", "bless", "m.json").expect(0)  # nothing can be
    (bench.folder / "other.json").write_text(json.dumps({"rows": [{"name": "another", "picture": "absent.png"}]}))
    bench.run("golden", "bless", "other.json").expect(4).expect_one_line("golden-results", "no row of the manifest")
    (bench.folder / "list.txt").write_text("ends\n")
    bench.run("golden", "bless", "m.json", "--from", "list.txt").expect(4).expect_one_line("ends", "no new picture")


@case("golden.long_outputs_are_kept_in_part", budget=3)
def outputs(bench):
    write(bench, [{"name": "floods", "command": ["sh", "-c", "echo first; exec yes"], "picture": "1.png", "seconds": 1},
                  {"name": "counts", "command": ["sh", "-c", "seq 1000000; echo last >&2; exit 3"], "picture": "2.png"},
                  {"name": "closes", "command": ["sh", "-c", "exec >&- 2>&-; sleep 0.3; exit 4"], "picture": "3.png"},
                  {"name": "leaves", "command": ["sh", "-c", "setsid yes & exit 5"], "picture": "4.png"}])
    bench.run("golden", "check", "m.json", timeout=30.0).expect(4)
    reasons = {name: r["reason"] for name, r in results(bench).items()}
    for name, words in {"floods": "stopped after 1 s", "counts": "exit code 3: last", "closes": "exit code 4", "leaves": "exit code 5"}.items():
        check(words in reasons[name], reasons)
    for name, begin, end in (("floods", "first\ny\n", "y\n"), ("counts", "1\n2\n3\n", "999999\n1000000\nlast\n")):
        text = (bench.folder / f"golden-results/logs/{name}.txt").read_text()
        check(text.startswith(begin) and text.rstrip().endswith(end.rstrip()) and len(text) < (1 << 20) + 100 and "bytes are left out here" in text, f"{name}: {len(text)} bytes")
    left = int(re.search(r"\.\.\. (\d+) bytes", text)[1])
    whole = sum(len(str(n)) + 1 for n in range(1, 1000001)) + len("last\n")
    check(left == whole - (1 << 20), f"{left} of {whole} bytes")


@case("golden.programs_have_the_memory_that_they_had_without_it")
def memory_of_programs(bench):
    before = subprocess.run(["sh", "-c", "ulimit -d"], capture_output=True, text=True, check=True).stdout.strip()
    write(bench, [{"name": f"bound {i}", "command": ["sh", "-c", "echo memory $(ulimit -d); exit 3"], "picture": f"{i}.png"} for i in range(4)])
    bench.run("golden", "check", "m.json", "--jobs", "4").expect(4)
    said = (bench.folder / "golden-results/results.jsonl").read_text()
    check(said.count(f"memory {before}") == 4, said)


@case("golden.shards_merge_to_the_files_of_one_run", budget=3)
def shards(bench):
    write(bench, [*ROWS, {"name": "late <b>|", "scene": "builtin:plate"}])
    bench.run("golden", "check", "m.json", "-o", "whole").expect(5)
    for i in (1, 2, 3):
        bench.run("golden", "check", "m.json", "--shard", f"{i}/3", "-o", f"s{i}", "--jobs", i).expect(5)
    bench.run("golden", "merge", "s3", "s1", "s2", "-o", "merged").expect(5)
    files = lambda folder: {str(p.relative_to(bench.folder / folder)): p.read_bytes() for p in (bench.folder / folder).rglob("*") if p.is_file()}
    check(files("merged") == files("whole"), "other files")
    bench.run("golden", "merge", "s1", "s1", "-o", "twice").expect(4).expect_one_line("s1", "earlier folder")
    check(bench.run("golden", "merge", "s1", "gone", "s3", "-o", "twice").expect(5).out, "a folder that is not there")
    bench.run("golden", "merge", "gone", "-o", "twice").expect(4).expect_one_line("gone")
    left = bench.run("golden", "merge", "s1", "s3", "-o", "twice").expect(5)
    left.expect_one_line("2 of 3 shards")
    check(left.out == "burnish golden check --shard 2/3 -o shard-2-of-3 m.json\n", left.out)
    bench.run(*left.out.split()[1:]).expect(5)
    bench.run("golden", "merge", "s1", "s3", "shard-2-of-3", "-o", "later").expect(5)
    check(files("later") == files("whole"), "other files by the command that was printed")
    bench.run("golden", "merge", "s1", "-o", "s1").expect(2).expect_one_line("-o")
    for bad in ("0/3", "4/3", "1/", "1/3x", "a"):
        bench.run("golden", "check", "m.json", "--shard", bad).expect(2).expect_one_line("--shard")


@case("golden.folders_need_no_manifest", budget=6)
def folders(bench):
    for folder in ("e/sub", "a/sub"):
        (bench.folder / folder).mkdir(parents=True)
    pixel = lambda value: b"P6 1 1 255\n" + bytes([value, 0, 0])
    for name, expected, actual in (("same.ppm", 9, 9), ("sub/other.ppm", 9, 200), ("gone.ppm", 9, None), ("new.ppm", None, 9)):
        if expected is not None:
            (bench.folder / "e" / name).write_bytes(pixel(expected))
        if actual is not None:
            (bench.folder / "a" / name).write_bytes(pixel(actual))
    bench.run("golden", "check", "e", "a").expect(4)
    check(verdicts(bench) == {"same.ppm": "passed", "sub/other.ppm": "differs", "gone.ppm": "failed", "new.ppm": "missing"}, verdicts(bench))
    (bench.folder / "e/gone.ppm").unlink()
    bench.run("golden", "bless", "e", "a").expect(0)
    bench.run("golden", "check", "e", "a").expect(0)
    check((bench.folder / "e/new.ppm").read_bytes() == pixel(9), "the new picture is not golden")
    (bench.folder / "a/same.ppm").write_bytes(pixel(10))
    bench.run("golden", "check", "e", "a").expect(1)
    bench.run("golden", "check", "e", "a", "--flip", "0.05").expect(0)
    bench.run("golden", "check", "e", "a", "--flip", "0.05", "--flip-p99", "0").expect(1)
    bench.run("golden", "check", "e", "a", "--flip", "0.05", "--pattern", "0").expect(0)
    # A mask for all pictures, and a folder of masks by name
    (bench.folder / "black.ppm").write_bytes(pixel(0))
    (bench.folder / "masks/sub").mkdir(parents=True)
    (bench.folder / "masks/sub/other.ppm").write_bytes(pixel(0))
    bench.run("golden", "check", "e", "a", "--mask", "black.ppm").expect(0)
    bench.run("golden", "check", "e", "a", "--mask", "masks").expect(1)
    (bench.folder / "masks/same.ppm").write_bytes(pixel(0))
    bench.run("golden", "check", "e", "a", "--mask", "masks").expect(0)
    bench.run("golden", "check", "e", "a", "--mask", "absent.ppm").expect(4)


@case("golden.patterns_pair_files", budget=4)
def patterns(bench):
    pixel = lambda value: b"P6 1 1 255\n" + bytes([value, 0, 0])
    for name, value in (("a_golden.ppm", 9), ("a_now.ppm", 9), ("b_golden.ppm", 9), ("b_now.ppm", 200), ("gone_golden.ppm", 9), ("new_now.ppm", 9), ("other.ppm", 1),
                        ("a_now.txt", 1), (".hidden_now.ppm", 1)):
        (bench.folder / name).write_bytes(pixel(value))
    pair = ("*_golden.ppm", "*_now.ppm")
    bench.run("golden", "check", *pair).expect(4)
    check(verdicts(bench) == {"a_golden.ppm": "passed", "b_golden.ppm": "differs", "gone_golden.ppm": "failed", "new_golden.ppm": "missing"}, verdicts(bench))
    (bench.folder / "gone_golden.ppm").unlink()
    bench.run("golden", "check", *pair).expect(1)
    bench.run("golden", "bless", *pair).expect(0)
    bench.run("golden", "check", *pair).expect(0)
    check((bench.folder / "b_golden.ppm").read_bytes() == pixel(200) and (bench.folder / "new_golden.ppm").exists(), "not blessed")
    (bench.folder / "sub").mkdir()
    (bench.folder / "sub/a.ppm").write_bytes(pixel(9))
    (bench.folder / "sub/b.ppm").write_bytes(pixel(9))
    bench.run("golden", "check", "sub/*.ppm", "*_now.ppm").expect(1)
    check(verdicts(bench) == {"a.ppm": "passed", "b.ppm": "differs", "new.ppm": "missing"}, verdicts(bench))
    for bad, code, needle in ((("s*/*.ppm", "*.ppm"), 2, "s*/*.ppm"), (("sub/*.ppm", "sub"), 2, "sub"), (("*a*.ppm", "*.ppm"), 2, "*a*.ppm"), (("s*/a.ppm", "*.ppm"), 2, "s*/a.ppm"),
                              (("nowhere/*.ppm", "*.ppm"), 4, "nowhere"), (("x*.ppm", "y*.ppm"), 4, "matches no picture"), (("*.ppm", "./*.ppm"), 2, "expected and actual")):
        bench.run("golden", "check", *bad).expect(code).expect_one_line(needle)
    for option in ("--flip-p99", "--pattern", "--mask"):
        bench.run("golden", "check", "m.json", option, "0.1").expect(2).expect_one_line(option)


@case("golden.limits_and_masks_decide", budget=5)
def limits(bench):
    def draw(*words):
        bench.run("render", "builtin:teapot", *SMALL, *words, "-q", "-o", "pot.exr").expect(0)

    rows, expected = [], {}

    def add(name, verdict, **more):
        rows.append({"name": name, "picture": "pot.exr", "golden": f"goldens/{name}.exr", **more})
        expected[name] = verdict

    for i, (hold, verdict) in enumerate((({"flip": 0.5}, "passed"), ({"flip": 1e-6}, "differs"), ({"flip": 0.5, "flip_p99": 1e-6}, "differs"),
                                         ({"pattern": 1e-9}, "differs"), ({"pattern": 50}, "passed"))):
        add(f"hold{i}", verdict, hold=hold)
    # Black pixels of the mask do not count
    (bench.folder / "none.ppm").write_bytes(b"P6 64 48 255\n" + bytes(3 * 64 * 48))
    (bench.folder / "all.ppm").write_bytes(b"P6 64 48 255\n" + b"\xff" * (3 * 64 * 48))
    (bench.folder / "small.ppm").write_bytes(b"P6 1 1 255\n\0\0\0")
    for mask, verdict in (("none.ppm", "passed"), ("all.ppm", "differs"), ("small.ppm", "failed"), ("absent.ppm", "failed")):
        add(mask, verdict, mask=mask)
    draw()
    write(bench, [{key: value for key, value in row.items() if key != "mask"} for row in rows])
    bench.run("golden", "check", "m.json").expect(5)
    bench.run("golden", "bless", "m.json").expect(0)
    draw("--env-exposure", "-0.2")
    write(bench, rows)
    bench.run("golden", "check", "m.json").expect(4)
    check(verdicts(bench) == expected, f"{results(bench)}")
    # Another size or kind differs, and says so
    draw("--size", "32x32")
    write(bench, rows[:1])
    bench.run("golden", "check", "m.json").expect(1)
    reason = results(bench)["hold0"]["reason"]
    check("32x32" in reason and "64x48" in reason, reason)


@case("golden.noise_is_judged_by_variance", budget=4)
def noise(bench):
    row = {"name": "noisy", "scene": "builtin:sphere", "format": "exr", "hold": {"z": 0.02},
           "options": ["--backend", "reference", "--samples", "256", "--size", "32x32", "--no-background"]}
    write(bench, [row])
    bench.run("golden", "check", "m.json").expect(5)
    bench.run("golden", "bless", "m.json").expect(0)
    check((bench.folder / "goldens/noisy.exr.variance.exr").exists(), "the variance is not kept")
    write(bench, [{**row, "options": [*row["options"], "--seed", "9"]}])
    bench.run("golden", "check", "m.json").expect(0)
    write(bench, [{**row, "options": [*row["options"], "--env-exposure", "0.5"]}])
    bench.run("golden", "check", "m.json").expect(1)
    check("z-test" in results(bench)["noisy"]["reason"], results(bench))


@case("golden.mistakes_of_a_manifest_have_their_place")
def mistakes(bench):
    pot = {"name": "pot", "scene": "builtin:teapot"}
    for rows, place in (([], "/rows"), ([1], "/rows/0"), ([{"scene": "builtin:teapot"}], "/rows/0/name"), ([pot, pot], "/rows/1/name"),
                        ([{**pot, "sceen": "x"}], "/rows/0/sceen"), ([{**pot, "hold": {"flip": 2}}], "/rows/0/hold/flip"),
                        ([{**pot, "hold": {"flop": 0}}], "/rows/0/hold/flop"), ([{**pot, "options": "x"}], "/rows/0/options"),
                        ([{**pot, "options": [1]}], "/rows/0/options/0"), ([{**pot, "picture": "x.png"}], "/rows/0"),
                        ([{**pot, "seconds": -1}], "/rows/0/seconds"), ([{**pot, "format": "gif"}], "/rows/0/format"),
                        ([{**pot, "keep": "all"}], "/rows/0/keep"), ([{**pot, "keep": "hash", "hold": {"flip": 0.1}}], "/rows/0/hold"),
                        ([{**pot, "environment": {"A=B": "x"}}], "/rows/0/environment/A=B"), ([{"name": "a", "command": ["x"]}], "/rows/0"),
                        ([{"name": "a\n", "picture": "x.png"}], "/rows/0/name"), ([{"name": "a", "picture": "x.png", "options": ["-q"]}], "/rows/0/options")):
        write(bench, rows)
        bench.run("golden", "check", "m.json").expect(4).expect_one_line("m.json", place)
    for text, place in (('{"rows": [{"name": "a", "name": "b", "picture": "x.png"}]}', "/rows/0/name"), ('{"rows": [], "rows": []}', "/rows: is there twice"),
                        ('{"rows": [1, [2, {}], {"hold": {"flip": 1, "z": 1, "flip": 0}}]}', "/rows/2/hold/flip"), ('{"defaults": {"keep": "hash", "keep": "hash"}}', "/defaults/keep"), ('{"rows": [{"seconds": 1e999}]}', "number"),
                        ('{"rows": [\n  // no\n]}', "line 2, column 3"), ("", "m.json"), ("[]", "m.json"), ('{"rows": [], "more": 1}', "/more")):
        (bench.folder / "m.json").write_text(text)
        bench.run("golden", "check", "m.json").expect(4).expect_one_line("m.json", place)
    (bench.folder / "m.json").write_text('{"rows": []}')
    bench.run("golden", "check", "m.json").expect(4).expect_one_line("m.json", "/rows", "is empty")
    bench.run("golden", "check", "absent.json").expect(4).expect_one_line("absent.json")
    for rows, place in (([{"name": "a", "picture": "x.png", "golden": "./x.png"}], "/rows/0/golden"), ([{"name": "a", "command": [], "picture": "x.png"}], "/rows/0/command"),
                        ([{"name": n, "picture": "x.png", "golden": "g.png"} for n in "ab"], "/rows/1/golden"), ([{**pot, "keep": "hash", "mask": "m.png"}], "/rows/0/mask"),
                        ([{"name": n, "command": ["true"], "picture": "x.png"} for n in "ab"], "/rows/1/picture"), ([{"name": "\u202e", "picture": "x.png"}], "/rows/0/name")):
        write(bench, rows)
        bench.run("golden", "check", "m.json").expect(4).expect_one_line("m.json", place)
    # Options of a scene write no file and print nothing
    for options, at in ((["-o", "evil.png"], 0), (["-qo", "evil.png"], 0), (["--output=evil.png"], 0), (["--msaa", "4", "--stats", "-"], 2), (["--trace", "t.json"], 0),
                        (["--backend", "reference", "--variance", "v.exr"], 2), (["--backend", "reference", "--checkpoint=c"], 2), (["--risks", "-"], 0),
                        (["--plan-out", "p.json"], 0), (["-q", "--help"], 1), (["-qh"], 0), (["--version"], 0), (["--msaa", "4", "--stats"], 2)):
        write(bench, [{**pot, "options": options}])
        bench.run("golden", "check", "m.json").expect(4).expect_one_line("m.json", f"/rows/0/options/{at}")
    (bench.folder / "m.json").write_text(json.dumps({"defaults": {"options": ["-q", "--env"]}, "rows": [{**pot, "options": ["--size", "--stats", "s.json"]}]}))
    bench.run("golden", "check", "m.json").expect(4).expect_one_line("m.json", "/rows/0/options/1")
    (bench.folder / "m.json").write_text(json.dumps({"defaults": {"options": ["-q", "-o", "evil.png"]}, "rows": [pot]}))
    bench.run("golden", "check", "m.json").expect(4).expect_one_line("m.json", "/defaults/options/1")
    for scene in ("--help", "-h", "-o"):
        write(bench, [{**pot, "scene": scene}])
        bench.run("golden", "check", "m.json").expect(4).expect_one_line("m.json", "/rows/0/scene", "./" + scene)
    check(not list(bench.folder.glob("evil*")) and not (bench.folder / "golden-results").exists(), "a file is written")
    # A folder with other files is never emptied, nor one with an input
    (bench.folder / "mine/pictures").mkdir(parents=True)
    (bench.folder / "mine/pictures/a.png").write_text("mine")
    write(bench, [pot])
    bench.run("golden", "check", "m.json", "-o", "mine").expect(2).expect_one_line("-o", "mine")
    bench.run("golden", "check", "m.json", "-o", ".").expect(2).expect_one_line("-o")
    check((bench.folder / "mine/pictures/a.png").read_text() == "mine", "a file is gone")
    bench.run("golden", "check", "m.json", "-o", "old").expect(5)
    bench.run("golden", "check", "old/pictures", "mine", "-o", "old").expect(2).expect_one_line("-o", "old/pictures")
    check((bench.folder / "old/pictures/pot.png").exists(), "an input is gone")
    bench.run("golden", "bless", "m.json").expect(4).expect_one_line("results.jsonl", "golden check")
    bench.run("golden", "check", "m.json", "--from", "x").expect(2).expect_one_line("--from")
    bench.run("golden", "check", "m.json", "--flip", "0.1").expect(2).expect_one_line("--flip")
    bench.run("golden", "check", "m.json", "m.json").expect(4).expect_one_line("m.json")
    bench.run("golden", "check", "m.json", "m.json", "m.json").expect(2).expect_one_line("PATH")


@case("golden.hostile_names_stay_text")
def hostile(bench):
    """Names are text in HTML, Markdown, annotations and file names."""
    names = ["<!--<script>", "\u4e16" * 40, "<script>alert(1)</script>", "a|b`c*", "../up", "::error::x%0A", "a,b:c", "\u00e4 \u2603", '"q"', ".",
             "https://evil.example/x", "www.evil.example", "@somebody #1"]
    (bench.folder / "a.ppm").write_bytes(b"P6 1 1 255\n\0\0\0")
    write(bench, [{"name": name, "picture": "a.ppm"} for name in names])
    done = bench.run("golden", "check", "m.json", env={"GITHUB_ACTIONS": "true", "GITHUB_STEP_SUMMARY": str(bench.folder / "step.md")}).expect(5)
    check(set(verdicts(bench)) == set(names), verdicts(bench))
    page = (bench.folder / "golden-results/index.html").read_text()
    check("<script>alert" not in page and "&lt;script&gt;alert" in page, "a name is markup")
    annotations = [line for line in done.out.splitlines() if line.startswith("::error ")]
    check(len(annotations) == len(names) and not any("::x%0A" in line for line in annotations), annotations)
    check(not any(line.strip().startswith("::") for line in (done.out + done.err).splitlines() if line not in annotations), done.describe())
    text = (bench.folder / "step.md").read_text()
    check(not re.search(r"://|www\.|@\w|(?<!&)#\w", text) and "https:&#8288;//evil.example/x" in text, f"GitHub makes links: {text}")
    check("<script>" not in (bench.folder / "step.md").read_text() and "a\\|b" in (bench.folder / "step.md").read_text(), "Markdown")
    check(not (bench.folder / "up.ppm").exists() and len(list((bench.folder / "golden-results/pictures").iterdir())) == len(names), "files")
    bench.run("golden", "bless", "m.json").expect(0)
    done = bench.run("golden", "check", "m.json", env={"GITHUB_STEP_SUMMARY": "/nonexistent/x"}).expect(0)
    done.expect_one_line("warning", "summary", "/nonexistent/x")  # and the exit code stays
    check(len(list((bench.folder / "goldens").iterdir())) == len(names), os.listdir(bench.folder / "goldens"))


@case("golden.the_page_makes_the_list_to_bless", tier="nightly")
def page(bench):
    rows = [*ROWS, {"name": "<!--<script>" + "long_" * 20, "scene": "builtin:plate"}, {"name": "linear", "scene": "builtin:plate", "format": "exr"}]
    write(bench, rows)
    bench.run("golden", "check", "m.json").expect(5)
    bench.run("golden", "bless", "m.json").expect(0)
    write(bench, [{**row, "options": ["--env-exposure", "0.5"]} for row in rows])
    bench.run("golden", "check", "m.json").expect(1)
    with Browser(bench.folder) as browser:
        browser.open(bench.folder / "golden-results/index.html")
        check(browser.value("document.querySelectorAll('.view').length") == 4, "no picture under a slider")
        check(browser.value("[...document.querySelectorAll('.view img')].every(i => i.complete && i.naturalWidth > 0)"), "a picture is missing")
        browser.value("document.querySelectorAll('input.bless')[0].click()")
        names = browser.value("document.getElementById('list').value")
        # The linear row alone has an exposure slider, which keys move
        check(browser.value("document.querySelectorAll('input.exposure').length") == 1, "not one exposure slider")
        label = "document.querySelector('input.exposure').closest('label')"
        wall = "document.querySelector('input.exposure').closest('.wall')"
        sources = f"['.picture', '.reference'].map(name => decodeURIComponent({wall}.querySelector(name).src).split('/').pop())"
        check(browser.value(f"{label}.textContent") == "Exposure0 stops", browser.value(f"{label}.textContent"))
        check(browser.value(sources) == ["linear.png", "linear%golden.png"], browser.value(sources))
        browser.value("document.querySelector('input.exposure').focus()")
        for key, number, stops, end in (("ArrowRight", 39, "+2", "%ev2.png"), ("ArrowRight", 39, "+4", "%ev4.png"), ("Home", 36, "-4", "%ev-4.png")):
            browser.press(key, number=number)
            browser.until(f"{label}.textContent === 'Exposure{stops} stops'")
            check(browser.value("document.querySelector('input.exposure').getAttribute('aria-valuetext')") == f"{stops} stops", "no words for readers")
            check(browser.value(sources) == [f"linear{end}", f"linear%golden{end}"], browser.value(sources))
            browser.until(f"[...{wall}.querySelectorAll('.view img')].every(i => i.complete && i.naturalWidth > 0)")
        # A phone shows the page without scrolling sideways
        browser.size(400, 800)
        browser.open(bench.folder / "golden-results/index.html")
        width = browser.value("document.documentElement.scrollWidth")
        check(width <= 400, f"the page is {width} pixels wide")
        check(not browser.faults, browser.faults)
    (bench.folder / "list.txt").write_text(names)
    check("1 picture blessed" in bench.run("golden", "bless", "m.json", "--from", "list.txt").expect(0).out, names)


@case("golden.the_page_orders_and_links_rows")
def order(bench):
    """Failed rows come first; each row that did not pass links its golden, with or without a slider."""
    nan = float("nan")
    ppm = lambda value, width=8: b"P6 %d 8 255\n" % width + bytes([value, 0, 0]) * (8 * width)
    pfm = lambda value: b"PF\n8 8\n-1.0\n" + struct.pack("<192f", *[value, 0.5, 0.5] * 64)
    files = {"passes": "ppm", "new": "ppm", "differs": "ppm", "size": "ppm", "nan": "pfm", "linear": "pfm", "fails": "ppm", "hash": "ppm"}
    (bench.folder / "new").mkdir()
    put = lambda name, picture: (bench.folder / f"new/{name}.{files[name]}").write_bytes(picture)
    for name, kind in files.items():
        put(name, pfm(1.0) if kind == "pfm" else ppm(9))
    write(bench, [{"name": name, "picture": f"new/{name}.{kind}", "keep": "hash" if name == "hash" else "picture"} for name, kind in files.items()])
    bench.run("golden", "check", "m.json").expect(5)
    bench.run("golden", "bless", "m.json").expect(0)
    for name, picture in (("differs", ppm(200)), ("size", ppm(9, 4)), ("nan", pfm(nan)), ("linear", pfm(1.5)), ("fails", b"no picture"), ("hash", ppm(10))):
        put(name, picture)
    (bench.folder / "goldens/new.ppm").unlink()
    bench.run("golden", "check", "m.json").expect(4)
    page = (bench.folder / "golden-results/index.html").read_text()
    names = re.findall(r"<tr><td>.*?<strong>(.*?)</strong>", page)
    check(len(names) == 8 and names[:2] == ["fails", "nan"] and set(names[2:6]) == {"differs", "size", "linear", "hash"} and names[6:] == ["new", "passes"], names)
    linked = set(re.findall(r'<a href="(goldens/[^"]*)">golden</a>', page))
    check(linked == {f"goldens/{name}.{files[name]}" for name in ("differs", "size", "nan", "linear", "fails")}, linked)
    for name in linked:
        check((bench.folder / "golden-results" / name).read_bytes() == (bench.folder / name).read_bytes(), name)
    check("LDR-FLIP 0." in page and "HDR-FLIP 0." in page and page.count('id="wall-') == 2 and "have a slider here" not in page, "walls")
    shown = {path.name for path in (bench.folder / "golden-results/shown").iterdir()}
    check({f"linear{golden}%ev{stops}.png" for golden in ("", "%golden") for stops in (-4, -2, 2, 4)} <= shown, shown)
    check(sum("%ev" in name for name in shown) == 8, shown)


@case("golden.large_pages_stay_small", tier="nightly")
def large(bench):
    """500 rows of noise, which no format shrinks."""
    noise = lambda: (bench.folder / "noise.ppm").write_bytes(b"P6 120 200 255\n" + os.urandom(3 * 120 * 200))
    size = lambda: (bench.folder / "golden-results/index.html").stat().st_size
    noise()
    write(bench, [{"name": f"row {i}", "picture": "noise.ppm"} for i in range(500)])
    bench.run("golden", "check", "m.json", timeout=300.0).expect(5)
    check(size() < 20e6, f"{size()} bytes")
    bench.run("golden", "bless", "m.json", timeout=300.0).expect(0)
    noise()
    bench.run("golden", "check", "m.json", timeout=600.0).expect(1)
    page = (bench.folder / "golden-results/index.html").read_text()
    check(size() < 20e6 and "The first 100 of 500 pictures" in page, f"{size()} bytes")
    linked = re.findall(r'<img src="(shown/[^"]*)"', page)
    check(linked and page.count('<img src="data:image/png') + len(linked) == 500, f"{len(linked)} small pictures are linked")
    check(all((bench.folder / "golden-results" / name.replace("%2520", "%20").replace("%25", "%")).exists() for name in linked), linked[0])


@case("golden.operations_are_counted_the_same_everywhere", budget=10)
def operations(bench):
    words = ("render", "builtin:plate", "--size", "64x48", "--floor", "off", "--stats", "-", "-q")
    stats = lambda *more: json.loads(bench.run(*words, *more).expect(0).out)
    row = {"name": "plate", "scene": "builtin:plate", "options": ["--size", "64x48", "--floor", "off"]}
    write(bench, [{"name": "other", "picture": "a.png", "hold": {"operations": 1}}])
    bench.run("golden", "check", "m.json").expect(4).expect_one_line("/rows/0/hold/operations")
    for more in (("--backend", "reference", "--samples", "64", "--stats", "s.json"), ()) if bench.run(*words, "--count-operations").code == 0 else ():
        check("--count-operations has no effect" in bench.run(*words[:-3], *more, "--count-operations").expect(0).err, more)
    if bench.run(*words, "--count-operations").code == 77:
        bench.run(*words, "--count-operations").expect(77).expect_one_line("BN_COUNTING_LANES")
        write(bench, [{**row, "hold": {"operations": 1}}])
        bench.run("golden", "check", "m.json").expect(4)
        check("BN_COUNTING_LANES" in results(bench)["plate"]["reason"], results(bench))
        raise Skipped("the program counts no operations")
    # The count does not depend on the machine's lanes and threads, and follows the frame's work
    count = lambda *more: stats(*more, "--count-operations")["operations"]
    usual = count()
    check(usual > 1e7 and {count("--threads", "1"), count("--isa", "scalar")} == {usual}, f"{usual}")
    check(count("--technique", "split_isotropic") < 0.7 * usual < 0.7 * count("--samples", "64"), "more samples take no more")
    mc = {n: count("--technique", "mc", "--samples", n) for n in ("64", "128", "256")}
    check(mc["256"] - mc["128"] == 2 * (mc["128"] - mc["64"]), f"{mc}: not a straight line")
    check("operations" not in stats() and stats()["pixel_hash"] == stats("--count-operations")["pixel_hash"], "counting changes pixels")
    # A limit holds it
    for limit, code, verdict in ((usual, 0, "passed"), (usual - 1, 1, "differs")):
        write(bench, [{**row, "hold": {"operations": limit}}])
        if code == 0:
            bench.run("golden", "check", "m.json").expect(5)
            check(results(bench)["plate"]["operations"] == usual, "a row without a golden says no operations")
            bench.run("golden", "bless", "m.json").expect(0)
        bench.run("golden", "check", "m.json").expect(code)
        found = results(bench)["plate"]
        check(found["verdict"] == verdict and found["operations"] == usual, str(found))
        check(code == 0 or f"a frame takes {usual} operations, more than {limit}: if the work is right, raise the manifest's limit" in found["reason"], found["reason"])
    # No new golden helps
    check('class="bless"' not in (bench.folder / "golden-results/index.html").read_text(), "the row can be blessed")
    check("nothing to bless" in bench.run("golden", "bless", "m.json").expect(0).out, "the row was blessed")
    (bench.folder / "list.txt").write_text("plate\n")
    bench.run("golden", "bless", "m.json", "--from", "list.txt").expect(4).expect_one_line("plate", "operations", "manifest")


@case("golden.folders_are_no_pictures_of_themselves", budget=10)
def of_themselves(bench):
    for folder in ("one", "st*r", "masks"):
        (bench.folder / folder).mkdir()
    bench.run("render", "builtin:plate", "--size", "16x16", "-q", "-o", "one/a.png").expect(0)
    shutil.copy(bench.folder / "one/a.png", bench.folder / "st*r/a.png")
    bench.run("golden", "check", "one/*.png", str(bench.folder / "one/*.png")).expect(2).expect_one_line("expected and actual")
    (bench.folder / "link").symlink_to("one")
    bench.run("golden", "check", "one", "link").expect(2).expect_one_line("expected and actual")
    bench.run("golden", "check", "st*r", "one").expect(0)  # a folder, whatever its name
    shutil.copy(bench.folder / "one/a.png", bench.folder / "masks/other.png")
    bench.run("golden", "check", "st*r", "one", "--mask", "masks").expect(4).expect_one_line("masks", "no mask")
    (bench.folder / "m.json").write_text('{"rows": [{"name": "a", "seconds": 1e999}]}')
    bench.run("golden", "check", "m.json").expect(4).expect_one_line("/rows/0/seconds")


@case("golden.the_schema_takes_what_the_program_takes")
def schema(bench):
    try:
        import jsonschema
    except ImportError as missing:
        raise Skipped("no Python package jsonschema") from missing
    text = json.loads((ROOT / "apps/golden/manifest.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(text)
    validator = jsonschema.Draft202012Validator(text)
    page = re.search(r"```json\n(.*?)```", (ROOT / "apps/manual/ci.md").read_text(), re.S)[1]
    for name, good in (("ci.md", page), ("the project's own", (ROOT / "tests/golden/manifest.json").read_text())):
        check(not list(validator.iter_errors(json.loads(good))), f"{name}: {[e.message for e in validator.iter_errors(json.loads(good))]}")
    pot = {"name": "pot", "scene": "builtin:plate"}
    bad = [{}, {"rows": [{}]}, {"rows": [{"name": "a"}]}, {"rows": [{**pot, "picture": "a.png"}]}, {"rows": [{**pot, "seconds": -1}]},
           {"rows": [{**pot, "format": "gif"}]}, {"rows": [{**pot, "hold": {"flop": 1}}]}, {"rows": [{**pot, "hold": {"flip": 2}}]},
           {"rows": [pot], "extra": 1}, {"rows": [pot], "defaults": {"scene": "x"}}, {"rows": [{"name": "a", "command": ["x"]}]},
           {"rows": [{"name": "a", "picture": "a.png", "options": ["--msaa", "1"]}]}, {"rows": [{"name": "", "picture": "a.png"}]}]
    for manifest in bad:  # the program refuses them too
        check(list(validator.iter_errors(manifest)), f"the schema takes {manifest}")
        (bench.folder / "bad.json").write_text(json.dumps(manifest))
        bench.run("golden", "check", "bad.json").expect(4)
    # Each member of the schema is one of the program
    rows = dict.fromkeys(text["$defs"]["row"]["properties"]), dict.fromkeys(text["properties"]["defaults"]["properties"])
    (bench.folder / "bad.json").write_text(json.dumps({"rows": [{"name": "a", "other": 1}]}))
    known = bench.run("golden", "check", "bad.json").expect(4).err.partition("known are ")[2]
    check(set(re.split(r", | and ", known.strip())) == set(rows[0]), f"{known} {list(rows[0])}")
    (bench.folder / "bad.json").write_text(json.dumps({"rows": [pot], "defaults": {"other": 1}}))
    known = bench.run("golden", "check", "bad.json").expect(4).err.partition("known are ")[2]
    check(set(re.split(r", | and ", known.strip())) == set(rows[1]), f"{known} {list(rows[1])}")


@case("golden.the_workflow_of_the_manual_is_one")
def workflow(bench):
    try:
        import yaml
    except ImportError as missing:
        raise Skipped("no Python package yaml") from missing
    text = re.search(r"```yaml\n(.*?)```", (ROOT / "apps/manual/ci.md").read_text(), re.S)[1]
    jobs = yaml.safe_load(text)["jobs"]
    runs = [step["run"] for job in jobs.values() for step in job["steps"] if "run" in step]
    shards = jobs["check"]["strategy"]["matrix"]["shard"]
    check(jobs["page"]["needs"] == "check" and all(("uses" in step) != ("run" in step) for job in jobs.values() for step in job["steps"]), "steps")
    # Its commands, as the steps run them
    (bench.folder / "goldens.json").write_text(json.dumps({"rows": [{"name": name, "scene": "builtin:plate", "keep": "hash", "options": [
        "--size", "16x16", "--env-size", "16", "--env-samples", "16", "--floor", "off"]} for name in "ab"]}))
    for command in [run for run in runs if run.startswith("burnish")]:
        for shard in shards if "matrix" in command else [0]:
            words = command.replace("${{ matrix.shard }}", str(shard)).split()[1:]
            bench.run(*words).expect(5)  # there is no golden
    check((bench.folder / "golden-results/index.html").exists(), "no page")
