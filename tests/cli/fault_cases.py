"""Calls and allocations that fail in turn: never a wrong file under a final name, never a crash, always a documented exit code."""

import json
import shutil

from harness import Skipped, case, check

TINY = ("--size", "64x48", "--msaa", "1", "--env-size", "16", "--env-samples", "16", "--threads", "2", "-q")
REFERENCE = ("render", "--backend", "reference", "--size", "48x32", "--samples", "256", "--env-size", "16", "--env-samples", "16",
             "--threads", "2", "-q")
CHART = ("chart", *TINY, "--techniques", "split_isotropic", "--runs", "1", "--reference-samples", "64", "--error-size", "32x24")
DOCUMENTED = (0, 2, 4, 7, 77)  # 6 and 70 are faults here


def needs_embree(bench):
    if "reference" not in bench.run("info").expect(0).out:
        raise Skipped("built without Embree")


def preloaded(bench):
    library = bench.cache.parent / "burnish_fail_calls.so"
    if bench.sanitized or not library.exists():
        raise Skipped("no library to fail calls with; sanitizers have their own allocator")
    return str(library)


class Job:
    """A command with known files: `same` have equal bytes in every run; `made` (patterns) are made anew, so they are removed before each
    run."""

    def __init__(self, words, same=(), made=()):
        self.words, self.same, self.made = words, same, made


# Jobs whose calls fail in turn. XDG_CACHE_HOME is the case's folder "own".
RENDER = Job(("render", *TINY, "-o", "o.png"), same=("o.png",))
PICTURES = Job(("render", *TINY, "-o", "o.exr", "-o", "o.png"), same=("o.exr", "o.png"))
BAKE = Job(("render", *TINY, "-o", "o.png"), same=("o.png",), made=("own",))
LEVELS = Job(("bake", "mip", "builtin:shaderballs", "--couple", "albedo", "--threads", "2", "-q", "-o", "o.mip"), same=("o.mip",))
KEPT = Job((*REFERENCE, "--checkpoint", "c.part", "-o", "r.png"), same=("r.png",), made=("c.part",))
REPORT = Job((*CHART, "-o", "report"), made=("report", "own/burnish/reference-*"))


def remove(path):
    shutil.rmtree(path, ignore_errors=True)
    path.unlink(missing_ok=True)


def check_report(bench, n):
    """Checks that a report is complete or absent, and that a chart's cached rows are JSON."""
    for name in ("report.json", "rows.json"):
        path = bench.folder / "report" / name
        if path.exists():
            json.loads(path.read_text())
    page = bench.folder / "report/report.html"
    check(not page.exists() or page.read_text().rstrip().endswith("</html>"), f"{n}: the page is cut off")


def fail_in_turn(bench, job, calls, steps, every=1, fail_bytes=65536, always=""):
    """Fails the n-th call for n in `steps` until a run has fewer calls. Files are then complete or unchanged. After each `every`-th
    failure the command runs again and makes equal files. Calls of `always` fail each time as well."""
    library = preloaded(bench)
    env = {"XDG_CACHE_HOME": str(bench.folder / "own")}

    def run(**more):
        for pattern in job.made:
            for path in list(bench.folder.glob(pattern)):
                remove(path)
        for name in job.same:
            (bench.folder / name).write_bytes(b"old")
        return bench.run(*job.words, env={**env, **more})

    run().expect(0)
    whole = {name: (bench.folder / name).read_bytes() for name in job.same}
    fired, codes, came = 0, {}, set()
    for call in calls:
        for n in steps:
            mark = bench.folder / "mark"
            done = run(LD_PRELOAD=library, BN_FAIL=f"{call}:{n}", BN_FAIL_MARK=str(mark), BN_FAIL_BYTES=str(fail_bytes), BN_FAIL_ALWAYS=always)
            place = f"{call} {n}"
            check(done.code in DOCUMENTED, f"{place}: {done.describe()}")
            check(done.code == 0 or done.err.startswith("burnish: "), f"{place}: no reason is given\n{done.describe()}")
            for name in job.same:
                found = (bench.folder / name).read_bytes()
                right = found == whole[name] if done.code == 0 else found in (whole[name], b"old")
                check(right, f"{place}: {name} is neither whole nor what it was\n{done.describe()}")
            check_report(bench, place)
            left = [name for name in bench.left_behind() if name.endswith((".tmp", ".bntmp"))]
            check(not left, f"{place}: {left} is left behind")
            codes[done.code] = codes.get(done.code, 0) + 1
            if not mark.exists():
                check(done.code == 0, f"{place}: no call failed, and {done.describe()}")
                break
            mark.unlink()
            fired += 1
            came.add(call)
            if fired % every == 0:  # files that stayed must be good
                bench.run(*job.words, env=env).expect(0)
                for name in job.same:
                    check((bench.folder / name).read_bytes() == whole[name], f"{place}: the next run makes another {name}")
    check(came == set(calls), f"never called: {sorted(set(calls) - came)}")
    print(f"{fired} failed calls, exit codes {codes}")


FILE_CALLS = ("write", "fsync", "fsync_folder", "rename", "linkat", "flock", "tmpfile", "getentropy")
WRITES = ("write", "fsync", "rename", "linkat")
ALL = range(1, 20000)


@case("fault.calls_on_files", tier="nightly")
def file_calls(bench):
    fail_in_turn(bench, RENDER, FILE_CALLS, ALL, every=4)
    fail_in_turn(bench, RENDER, ("create", "write", "fsync", "fsync_folder", "rename", "flock", "getentropy"), ALL, every=4, always="tmpfile")


@case("fault.calls_of_a_bake", tier="nightly")
def bake_calls(bench):
    fail_in_turn(bench, BAKE, WRITES, ALL, every=3)
    fail_in_turn(bench, LEVELS, WRITES, (1, 2, 3, 5, 8, 13, 21, 34, 55, 89, 144), every=8)


@case("fault.calls_of_a_reference", tier="nightly")
def reference_calls(bench):
    needs_embree(bench)
    fail_in_turn(bench, KEPT, WRITES, ALL, every=3)


@case("fault.calls_of_a_chart", tier="nightly")
def chart_calls(bench):
    needs_embree(bench)
    fail_in_turn(bench, REPORT, WRITES, (1, 2, 3, 5, 8, 13, 21, 34), every=8)


@case("fault.memory_runs_out", tier="nightly")
def memory_calls(bench):
    fail_in_turn(bench, RENDER, ("malloc",), (1, 2, 3, 5, 8, 13, 21, 34, 55), every=100)
    fail_in_turn(bench, BAKE, ("mmap",), (1, 2, 3, 5, 8, 13, 21, 34, 55), every=100)


@case("fault.memory_of_libraries_runs_out", tier="nightly")
def library_memory_calls(bench):
    """Fails memory requests of libraries, when they are loaded or build a tree over the scene."""
    needs_embree(bench)
    fail_in_turn(bench, PICTURES, ("malloc",), range(52, 66), every=100)
    fail_in_turn(bench, KEPT, ("malloc",), range(52, 60), every=100)
    fail_in_turn(bench, KEPT, ("mmap",), range(6, 10), every=100)


@case("fault.small_memory_runs_out")
def small_memory_calls(bench):
    """Counts every allocation, including the program's first."""
    fail_in_turn(bench, RENDER, ("malloc",), (1, 2, 3, 100, 1000, 3000, 5000, 8000), every=100, fail_bytes=1)


def every_call(name, job, embree, mmap):
    calls = (*FILE_CALLS, "read", "mmap") if mmap else (*FILE_CALLS, "read")

    @case(f"fault.every_call.of_a_{name}", tier="nightly")
    def run(bench):
        if embree:
            needs_embree(bench)
        fail_in_turn(bench, job, calls, ALL, every=5)

    @case(f"fault.every_allocation.of_a_{name}", tier="nightly")
    def run_memory(bench):
        if embree:
            needs_embree(bench)
        fail_in_turn(bench, job, ("malloc",), ALL, every=20)


every_call("picture", PICTURES, embree=False, mmap=True)
every_call("bake", BAKE, embree=False, mmap=True)
every_call("reference", KEPT, embree=True, mmap=True)
every_call("chart", REPORT, embree=True, mmap=True)
