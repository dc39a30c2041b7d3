"""What goes wrong around the program: calls that fail, memory that ends, processes that are killed, folders that cannot be written."""

import json
import os
import pathlib
import random
import resource
import signal
import subprocess
import time

from harness import SMALL, Skipped, case, check

TINY = ("--size", "64x48", "--msaa", "1", "--env-size", "16", "--env-samples", "16", "--threads", "2", "-q")
REFERENCE = ("render", "--backend", "reference", "--size", "48x32", "--samples", "256", "--env-size", "16", "--env-samples", "16",
             "--threads", "2", "-q")
CHART = ("chart", *TINY, "--techniques", "split_isotropic", "--runs", "1", "--reference-samples", "64", "--error-size", "32x24")
DOCUMENTED = (0, 2, 4, 7, 77)  # and 6 and 70 are faults here


def needs_embree(bench):
    if "reference" not in bench.run("info").expect(0).out:
        raise Skipped("built without Embree")


def preloaded(bench):
    library = bench.cache.parent / "burnish_fail_calls.so"
    if bench.sanitized or not library.exists():
        raise Skipped("no library to fail calls with; sanitizers have their own allocator")
    return str(library)


def fail_in_turn(bench, words, outputs, calls, steps):
    """Fails the n-th call for n in `steps` until a run has fewer calls; what is there afterwards is whole or what was there before."""
    library = preloaded(bench)
    bench.run(*words).expect(0)
    whole = {name: (bench.folder / name).read_bytes() for name in outputs}
    fired, codes = 0, {}
    for call in calls:
        for n in steps:
            for name in outputs:
                (bench.folder / name).write_bytes(b"old")
            mark = bench.folder / "mark"
            env = {"LD_PRELOAD": library, "BN_FAIL": f"{call}:{n}", "BN_FAIL_MARK": str(mark), "XDG_CACHE_HOME": str(bench.folder / "none")}
            done = bench.run(*words, env=env)
            check(done.code in DOCUMENTED, f"{call} {n}: {done.describe()}")
            for name in outputs:
                found = (bench.folder / name).read_bytes()
                right = whole[name] if done.code == 0 else found if found in (whole[name], b"old") else None
                check(found == right, f"{call} {n}: {name} is neither whole nor what it was\n{done.describe()}")
            left = [name for name in bench.left_behind() if name.endswith((".tmp", ".bntmp"))]
            check(not left, f"{call} {n}: {left} is left behind")
            codes[done.code] = codes.get(done.code, 0) + 1
            if not mark.exists():
                check(done.code == 0, f"{call} {n}: no call failed, and {done.describe()}")
                break
            fired += 1
            mark.unlink()
    check(fired >= len(calls), f"only {fired} calls failed")
    print(f"{fired} failed calls, exit codes {codes}")


FILE_CALLS = ("write", "fsync", "rename", "linkat", "flock", "tmpfile", "create", "getrandom")


@case("fault.calls_on_files")
def file_calls(bench):
    fail_in_turn(bench, ("render", *TINY, "--no-cache", "-o", "o.png"), ("o.png",), FILE_CALLS, range(1, 100))


@case("fault.calls_on_files_all", tier="slow")
def all_calls(bench):
    needs_embree(bench)
    fail_in_turn(bench, ("render", *TINY, "-o", "o.exr", "-o", "o.png"), ("o.exr", "o.png"), (*FILE_CALLS, "read", "mmap"), range(1, 1000))
    fail_in_turn(bench, (*REFERENCE, "--checkpoint", "c.part", "-o", "r.png"), ("r.png",), FILE_CALLS[:4], range(1, 1000))


@case("fault.memory_runs_out")
def memory_calls(bench):
    fail_in_turn(bench, ("render", *TINY, "--no-cache", "-o", "o.png"), ("o.png",), ("malloc",), (1, 2, 3, 5, 8, 13, 21, 34, 55))


@case("fault.memory_runs_out_all", tier="slow")
def all_memory(bench):
    needs_embree(bench)
    fail_in_turn(bench, ("render", *TINY, "-o", "o.png"), ("o.png",), ("malloc",), range(1, 3000))
    fail_in_turn(bench, (*REFERENCE, "-o", "r.png"), ("r.png",), ("malloc",), range(1, 3000))


def start(bench, words, env=None):
    return subprocess.Popen([bench.program, *map(str, words)], cwd=bench.folder, env=bench.environment(env or {}),
                            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def kill_at_random(bench, words, kills, seed, longest):
    """Starts the command again and again and kills it; then lets it end."""
    chance = random.Random(seed)
    killed = 0
    for _ in range(kills):
        child = start(bench, words)
        time.sleep(chance.uniform(0.0, longest))
        child.send_signal(signal.SIGKILL)
        killed += child.wait() == -signal.SIGKILL
    return killed


def killed_reference(bench, kills):
    needs_embree(bench)
    words = (*REFERENCE, "--samples", "4096", "--env", "builtin:sky")
    straight = bench.figures(*words[1:])["pixel_hash"]
    begin = time.monotonic()
    bench.run(*words).expect(0)
    longest = time.monotonic() - begin
    words = (*words, "--checkpoint", "c.part", "-o", "o.exr")
    check(kill_at_random(bench, words, kills, 7, longest) > 0, "nothing was killed")
    check(bench.figures(*words[1:])["pixel_hash"] == straight, "the picture after kills is another one")
    check(bench.left_behind() == ["c.part", "o.exr"], f"left: {bench.left_behind()}")


@case("fault.killed_references_go_on")
def killed_short(bench):
    killed_reference(bench, 4)


@case("fault.killed_references_go_on_long", tier="slow")
def killed_long(bench):
    killed_reference(bench, 40)


@case("fault.killed_renders_leave_whole_files", tier="slow")
def killed_renders(bench):
    words = ("render", *TINY, "-o", "o.exr", "-o", "o.png", "--stats", "s.json")
    bench.run(*words).expect(0)
    whole = {name: (bench.folder / name).read_bytes() for name in ("o.exr", "o.png")}
    for round_ in range(30):
        kill_at_random(bench, words, 1, round_, 0.4)
        for name, data in whole.items():
            check((bench.folder / name).read_bytes() == data, f"{name} is damaged after a kill")
        json.loads((bench.folder / "s.json").read_text())
    bench.run(*words).expect(0)
    check(bench.left_behind() == ["o.exr", "o.png", "s.json"], f"left: {bench.left_behind()}")


@case("fault.killed_charts_go_on", tier="slow")
def killed_charts(bench):
    needs_embree(bench)
    words = (*CHART, "--no-cache", "-o", "report")
    kill_at_random(bench, words, 10, 3, 2.0)
    bench.run(*words).expect(0)
    json.loads((bench.folder / "report" / "chart.json").read_text())
    left = [name for name in bench.left_behind() if name.endswith((".tmp", ".bntmp"))]
    check(not left, f"left: {left}")


def with_little_memory(bench, words, limits):
    """Under ulimit -v: a line and a code, or the picture."""
    if bench.sanitized:
        raise Skipped("shadow memory reserves terabytes of addresses")
    codes = []
    for limit in limits:
        done = subprocess.run([bench.program, *words], cwd=bench.folder, env=bench.environment({}), capture_output=True, text=True,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)), timeout=300, check=False)
        if done.returncode == 127 and "shared librar" in done.stderr:
            continue  # the loader itself had no room
        check(done.returncode in (0, 4, 7, 77), f"{limit >> 20} MiB: exit code {done.returncode}: {done.stderr}")
        check((bench.folder / "o.png").exists() == (done.returncode == 0), f"{limit >> 20} MiB: picture and exit code do not agree")
        (bench.folder / "o.png").unlink(missing_ok=True)
        codes.append(done.returncode)
    print("exit codes", codes)
    check(0 in codes and any(codes), f"the limits are not where they should be: {codes}")


@case("fault.little_memory")
def little_memory(bench):
    bench.run("render", *TINY).expect(0)
    with_little_memory(bench, ("render", *TINY, "--size", "2048x2048", "--msaa", "4", "-o", "o.png"), [m << 20 for m in (96, 160, 256, 1024)])


@case("fault.little_memory_all", tier="slow")
def little_memory_all(bench):
    bench.run("render", *TINY).expect(0)
    with_little_memory(bench, ("render", *TINY, "--size", "2048x2048", "--msaa", "4", "-o", "o.png"), [m << 20 for m in range(32, 1100, 16)])


@case("fault.read_only_root_and_no_rights")
def read_only_root(bench):
    """As nobody, with every file system read-only but one small one."""
    if os.geteuid():
        raise Skipped("needs root, to become nobody")
    folder = bench.folder / "free"
    folder.mkdir()
    script = ('mount --make-rprivate / && mount -t tmpfs -o mode=1777 none "$0" && mount -o remount,bind,ro / && cd "$0" || exit 99; '
              'exec setpriv --reuid 65534 --regid 65534 --clear-groups "$@"')
    command = ["unshare", "--mount", "sh", "-c", script, str(folder)]
    try:
        probe = subprocess.run([*command, "true"], capture_output=True, text=True, timeout=60, check=False)
    except FileNotFoundError:
        raise Skipped("no unshare") from None
    reach = subprocess.run([*command, bench.program, "--version"], capture_output=True, text=True, timeout=60, check=False)
    if probe.returncode or reach.returncode:
        raise Skipped(f"cannot be set up here: {probe.stderr} {reach.stderr}")
    env = {"PATH": os.environ["PATH"], "XDG_CACHE_HOME": "/nowhere/at/all"}
    outside = str(pathlib.Path(bench.folder).parent / "nobody.png")
    for words, code in ((("render", *TINY, "-o", "o.png", "--stats", "-"), 0), (("render", *TINY, "-o", outside), 7), (("info",), 0),
                        (("render", *TINY, "-o", "/o.png"), 7)):
        done = subprocess.run([*command, bench.program, *words], capture_output=True, text=True, env=env, timeout=300, check=False)
        check(done.returncode == code, f"{words}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
        if words[-1] == "-":
            check(any("is not cached" in line for line in json.loads(done.stdout)["warnings"]), "the cache that cannot be is not told")
