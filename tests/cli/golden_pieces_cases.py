"""burnish golden in pieces: rows of a manifest by processes that share a folder."""

import json
import os
import pathlib
import shlex
import shutil
import signal
import subprocess
import time

import gltf_files
from environment_files import hdr, rgbe
from golden_cases import ROWS, program, results, write
from harness import Skipped, case, check


def pixel(value):
    return b"P6 1 1 255\n" + bytes([value, 0, 0])


def sky(red):
    return hdr(32, 16, lambda y: 32 * rgbe((red, 0.5, 0.5)))


@case("golden.pieces_merge_to_the_files_of_one_run", budget=6)
def pieces(bench):
    """Drawn rows, a program's, one that is there, one that fails and one without a golden, by processes that share a folder."""
    (bench.folder / "there.ppm").write_bytes(pixel(5))
    (bench.folder / "goldens").mkdir()
    (bench.folder / "goldens/there.ppm").write_bytes(pixel(9))
    made = program(bench, "draw.sh", "echo drawn; cp there.ppm out.ppm")
    write(bench, [*ROWS, {"name": "there", "picture": "there.ppm"}, {"name": "by a program", "command": [made], "picture": "out.ppm"},
                  {"name": "fails", "command": ["false"], "picture": "none.ppm"}, {"name": "counted", "scene": "builtin:plate", "hold": {"operations": 1e9}},
                  {"name": "several", "scene": "builtin:plate", "options": ["--turntable", "3"]}])
    count = len(ROWS) + 5
    files = lambda folder: {str(p.relative_to(bench.folder / folder)): p.read_bytes() for p in (bench.folder / folder).rglob("*") if p.is_file()}
    bench.run("golden", "check", "m.json", "-o", "whole").expect(4)
    words = ("golden", "check", "m.json", "-o", "merged")
    listed = [line.split(" ", 2) for line in bench.run(*words, "--pieces", "--work", "w").expect(0).out.splitlines()]
    check(len({key for key, _, _ in listed}) == count and all(float(seconds) > 0 for _, seconds, _ in listed), f"{listed}")
    bench.run(*words, "--shard", "2/2", "--work", "w").expect(0)
    left = bench.run("merge", "w").expect(5).out.splitlines()
    check(len(left) == (count + 1) // 2 and all(line.startswith("burnish golden check m.json -o merged --piece ") for line in left), f"{left}")
    check(not (bench.folder / "merged").exists(), "a merge of less than all wrote a folder")
    bench.run(*left[0].split()[1:]).expect(0)
    bench.run(*words, "--take", "--work", "w").expect(0)
    merged = bench.run("merge", "w").expect(4)
    check(merged.out == "" and "fails" in merged.err, f"standard output is for commands of pieces alone: {merged.out}")
    check(files("merged") == files("whole"), f"other files: {[n for n in files('whole') if files('whole')[n] != files('merged').get(n)]} {set(files('merged')['results.jsonl'].splitlines()) ^ set(files('whole')['results.jsonl'].splitlines())}")
    for wrong in (("check", "m.json", "--take", "--work", "w", "--jobs", "2"), ("check", "m.json", "--work", "w"), ("bless", "m.json", "--take")):
        bench.run("golden", *wrong).expect(2)


@case("golden.pieces_have_keys_by_content", budget=11)
def keys(bench):
    """Each file that decides a row changes its key, and no other row's. A folder of pieces thus serves the next commit. The program starts
    once a file."""
    scene = gltf_files.textured("colour.png")
    (bench.folder / "ball.gltf").write_text(gltf_files.text(scene))
    (bench.folder / "colour.png").write_bytes(gltf_files.png(2, 2, color=lambda x, y: (200, 100, 50)))
    (bench.folder / "there.ppm").write_bytes(pixel(5))
    (bench.folder / "mask.ppm").write_bytes(pixel(255))
    (bench.folder / "light.hdr").write_bytes(sky(0.2))
    (bench.folder / "goldens").mkdir()
    made = program(bench, "draw.sh", "cp there.ppm out.ppm")
    material = '<materialx version="1.38"><nodegraph name="g"><image name="i" type="color3"><input name="file" type="filename" value="paint.png"/></image>'\
               '<output name="o" type="color3" nodename="i"/></nodegraph><gltf_pbr name="s" type="surfaceshader">'\
               '<input name="base_color" type="color3" nodegraph="g" output="o"/></gltf_pbr>'\
               '<surfacematerial name="m" type="material"><input name="surfaceshader" type="surfaceshader" nodename="s"/></surfacematerial></materialx>'
    (bench.folder / "paint.mtlx").write_text(material)
    (bench.folder / "paint.png").write_bytes(gltf_files.png(2, 2, color=lambda x, y: (200, 100, 50)))
    rows = [{"name": "drawn", "scene": "ball.gltf", "options": ["--env", "light.hdr"]}, {"name": "painted", "scene": "ball.gltf", "options": ["--material", "paint.mtlx"]}, {"name": "there", "picture": "there.ppm", "mask": "mask.ppm", "hold": {"flip": 0.1}},
            {"name": "by a program", "command": [made], "picture": "out.ppm"}]
    write(bench, rows)

    def now():
        lines = bench.run("golden", "check", "m.json", "--pieces").expect(0).out.splitlines()
        return [line.split(" ")[0] for line in lines]

    def changed(what):
        nonlocal before
        before, old = now(), before
        return [row["name"] for row, a, b in zip(rows, before, old) if a != b]
    before = now()
    check(changed("nothing") == [], "keys change by themselves")
    for name, content, wanted in (("colour.png", gltf_files.png(2, 2, color=lambda x, y: (200, 100, 51)), ["drawn", "painted"]), ("paint.png", gltf_files.png(2, 2, color=lambda x, y: (200, 100, 52)), ["painted"]), ("light.hdr", sky(0.3), ["drawn"]), ("there.ppm", pixel(6), ["there"]),
                                  ("mask.ppm", pixel(254), ["there"]), ("goldens/there.ppm", pixel(6), ["there"]), ("goldens/drawn.png", b"x", ["drawn"]),
                                  ("draw.sh", b"#!/bin/sh\ncp there.ppm  out.ppm\n", ["by a program"])):
        (bench.folder / name).write_bytes(content)
        got = changed(name)
        check(got == wanted, f"{name} changes {got}")
    rows[2]["hold"]["flip"] = 0.2
    write(bench, rows)
    check(changed("a limit") == ["there"], "a limit")
    limited = bench.run("golden", "check", "m.json", "--pieces", "--limit-image-side", "99").expect(0).out.splitlines()
    check(not set(before) & {line.split(" ")[0] for line in limited}, "a limit on input is in no key")
    # One folder serves each commit
    bench.run("golden", "check", "m.json", "--take", "--work", "w").expect(0)
    (bench.folder / "there.ppm").write_bytes(pixel(250))
    bench.run("golden", "check", "m.json", "--take", "--work", "w").expect(0)
    bench.run("merge", "w").expect(4)
    check(results(bench)["there"]["verdict"] == "differs", f"{results(bench)}")
    # A machine without the scene makes no piece
    (bench.folder / "colour.png").unlink()
    bench.run("golden", "check", "m.json", "--take", "--work", "none").expect(4).expect_one_line("colour.png")
    check(not (bench.folder / "none").exists(), "a worker without the scene made a piece")


@case("golden.pieces_of_machines_that_fail_are_made_elsewhere")
def machines_that_fail(bench):
    """A killed program, one that takes too long, one that is not there, and a full disk leave no piece. A program that fails by itself does."""
    for command, reason in ((["sh", "-c", "kill -9 $$"], "signal 9"), (["sleep", "9"], "stopped after 0.5 s"), (["./none"], "cannot be started")):
        write(bench, [{"name": "row", "command": command, "picture": "out.ppm", "seconds": 0.5}])
        bench.run("golden", "check", "m.json", "--take", "--work", "w").expect(7).expect_one_line("row", reason)
        check(not list(bench.folder.glob("w/*.piece*")), f"a piece of {command}")
    for command in (["false"], ["sh", "-c", "kill -11 $$"]):
        write(bench, [{"name": "row", "command": command, "picture": "out.ppm"}])
        bench.run("golden", "check", "m.json", "--take", "--work", "w").expect(0)
        bench.run("golden", "check", "m.json", "--merge", "--work", "w").expect(4)
    write(bench, [{"name": "pot", "scene": "builtin:teapot", "options": ["--size", "400x300"]}])
    bench.run("golden", "check", "m.json", "-o", "one").expect(5)
    full = f"mount -t tmpfs -o size=64k none small && {bench.program} golden check m.json --take --work small"
    (bench.folder / "small").mkdir()
    done = subprocess.run(["unshare", "-m", "sh", "-c", full], cwd=bench.folder, env=bench.environment({}), capture_output=True, text=True, timeout=60)
    if "unshare" in done.stderr or "mount:" in done.stderr:
        raise Skipped("a file system needs the superuser: " + done.stderr)
    check(done.returncode == 7 and "No space left" in done.stderr, f"{done.returncode} {done.stderr}")


def alive(pid):
    try:
        return pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


@case("golden.a_killed_check_ends_its_programs", budget=20)
def killed(bench):
    """Signal 9 to a process that makes rows ends the rows' programs and their children: no program goes on beside its successor. Busy
    machines end them late."""
    here = bench.folder / "go"
    write(bench, [{"name": f"row{i}", "command": ["sh", "-c", f"sleep 60 & echo $! > {here}.{i}; echo $$ >> {here}.{i}; wait"], "picture": f"out{i}.ppm"} for i in range(2)])
    for words in (("--jobs", "2"), ("--take", "--work", "w")):
        maker = subprocess.Popen([bench.program, "golden", "check", "m.json", *words], cwd=bench.folder, env=bench.environment({}), start_new_session=True, stdout=subprocess.DEVNULL,
                                 stderr=subprocess.DEVNULL)
        count = 2 if "--jobs" in words else 1
        until = time.monotonic() + 20
        pids = []
        while len(pids) < 2 * count and time.monotonic() < until:
            time.sleep(0.02)
            pids = [int(line) for path in bench.folder.glob("go.*") for line in path.read_text().split()]
        check(len(pids) == 2 * count and all(map(alive, pids)), f"{words}: {pids}")
        if count == 1:
            maker.kill()
        else:
            os.killpg(maker.pid, signal.SIGKILL)  # the whole group, as launchers do
        maker.wait()
        while any(map(alive, pids)) and time.monotonic() < until:
            time.sleep(0.02)
        check(not any(map(alive, pids)), f"{words}: a program goes on")
        for path in bench.folder.glob("go.*"):
            path.unlink()


@case("golden.merges_of_scripts_end_with_the_verdict", budget=3)
def merges_of_scripts(bench):
    """A merge makes the missing pictures, and its exit code equals one process': 0, or the verdict of golden pictures. No word of a picture's
    name is run. A merge of k8s takes pieces that no pod makes."""
    import yaml
    name = "$(touch run) `touch run`; touch run"
    (bench.folder / "m.json").write_text(json.dumps({"rows": [{"name": name, "scene": "builtin:plate", "options": ["--size", "48x32", "--env-size", "16", "--env-samples", "16"]}]}))
    golden = ("golden", "check", "m.json", "-o", "results")
    (bench.folder / "burnish").symlink_to(bench.program)
    env = bench.environment({"PATH": f"{bench.folder}:/usr/bin:/bin"})
    for engine in ("slurm", "mpi", "parallel", "k8s"):
        text = bench.run("submit", "--for", engine, "--shards", "1", "--work", engine, "--", *golden).expect(0).out
        line = list(yaml.safe_load_all(text))[1]["spec"]["template"]["spec"]["containers"][0]["command"][2].replace("$$", "$") if engine == "k8s" else text.splitlines()[-1]
        if engine == "slurm":
            line = shlex.split(line)[-1]
        done = subprocess.run(["sh", "-c", line], cwd=bench.folder, env=env, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=100)
        check(done.returncode == 5 and "1 have no golden" in done.stderr, f"{engine}: {done.returncode} {done.stdout}{done.stderr}")
        check((bench.folder / "results/index.html").exists(), engine)
        shutil.rmtree(bench.folder / "results")
    check(not (bench.folder / "run").exists(), "a name was run")
