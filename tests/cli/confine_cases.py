"""The program with few resources: memory (ulimit -v, control groups), threads, no rights, a read-only root."""

import json
import os
import pathlib
import resource
import shutil
import subprocess

from fault_cases import CHART, TINY
from harness import Skipped, case, check

BIG = ("render", *TINY, "--size", "2048x2048", "--msaa", "4", "-o", "o.png")
MIB = 1 << 20


def with_little_memory(bench, words, output, limits):
    """Runs under ulimit -v. Each run gives an error line and a code, or the whole output. Returns the messages of failed runs."""
    if bench.sanitized:
        raise Skipped("shadow memory reserves terabytes of addresses")
    codes, said = [], []
    for limit in limits:
        done = subprocess.run([bench.program, *words], cwd=bench.folder, env=bench.environment({}), capture_output=True, text=True,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)), timeout=300, check=False)
        if done.returncode == 127 and "shared librar" in done.stderr:
            continue  # the loader had no memory
        check(done.returncode in (0, 4, 7, 77), f"{limit // MIB} MiB: exit code {done.returncode}: {done.stderr}")
        check((bench.folder / output).exists() == (done.returncode == 0), f"{limit // MIB} MiB: output and exit code do not agree")
        (bench.folder / output).unlink(missing_ok=True)
        codes.append(done.returncode)
        if done.returncode:
            said.append(f"{limit // MIB} MiB: {done.stderr}")
    print("exit codes", codes)
    check(0 in codes and any(codes), f"the limits are not where they should be: {codes}")
    return said


@case("confine.little_address_space", tier="nightly")
def little_memory(bench):
    bench.run("render", *TINY).expect(0)
    with_little_memory(bench, BIG, "o.png", [m * MIB for m in (96, 160, 256, 1024)])


@case("confine.little_address_space_all", tier="nightly")
def little_memory_all(bench):
    bench.run("render", *TINY).expect(0)
    with_little_memory(bench, BIG, "o.png", [m * MIB for m in range(32, 1100, 16)])


@case("confine.a_picture_that_does_not_fit_is_not_called_damaged", tier="nightly")
def exr_memory(bench):
    """OpenEXR's message for missing memory is not taken for its message for a damaged file."""
    bench.run("render", "builtin:plate", *TINY, "--size", "4000x4000", "-o", "big.exr").expect(0)
    words = ("compare", "big.exr", "big.exr", "--metric", "flip", "--error-map", "map.pfm")  # figures are written of failures too
    said = with_little_memory(bench, words, "map.pfm", [m * MIB for m in (300, 900, 960, 1020, 1080, 9000)])
    check(any("big.exr: out of memory" in text for text in said), f"the library was never short of memory: {said}")
    for text in said:
        check("damaged" not in text and "corrupt" not in text and "memory" in text, text)


MEMORY, THREADS = ("memory", ("memory.limit_in_bytes", "memory.max")), ("pids", ("pids.max",))


def in_group(bench, kind, limit, words):
    """Runs the command in a control group with so many bytes of memory, or so many threads."""
    controller, names = kind
    for group in (pathlib.Path("/sys/fs/cgroup") / controller, pathlib.Path("/sys/fs/cgroup")):
        own = group / f"burnish_test_{os.getpid()}"
        if not (group / "cgroup.procs").exists():
            continue
        try:
            own.mkdir()
        except OSError as error:
            raise Skipped(f"no control group can be made here: {error}") from error
        try:
            files = [own / name for name in names if (own / name).exists()]
            if not files:
                continue
            files[0].write_text(str(limit))
            join = lambda: (own / "cgroup.procs").write_text(str(os.getpid()))
            return subprocess.run([bench.program, *words], cwd=bench.folder, env=bench.environment({}), capture_output=True, text=True,
                                  preexec_fn=join, timeout=300, check=False)
        except (OSError, subprocess.SubprocessError) as error:
            raise Skipped(f"the control group cannot be used here: {error}") from error
        finally:
            own.rmdir()
    raise Skipped(f"no control groups of {controller} here")


@case("confine.little_memory_of_a_control_group", tier="nightly")
def memory_group(bench):
    """Instead of being killed silently, the program prints an error, and leaves no partial image."""
    if bench.sanitized:
        raise Skipped("sanitizers need memory of their own")
    words = ("--threads", "2", "-o", "o.png")
    done = in_group(bench, MEMORY, 256 * MIB, ("render", *TINY, *words))
    check(done.returncode == 0 and (bench.folder / "o.png").exists(), f"exit code {done.returncode}: {done.stderr}")
    (bench.folder / "o.png").unlink()
    done = in_group(bench, MEMORY, 256 * MIB, ("render", *TINY, "--size", "8192x8192", "--msaa", "4", *words))
    check(done.returncode == 4, f"exit code {done.returncode}: {done.stderr}")
    check("memory" in done.stderr and len(done.stderr.splitlines()) == 1, done.stderr)
    check(not bench.left_behind(), f"left: {bench.left_behind()}")


# Outputs with their command, and valid exit codes with few threads: burnish's loops go on, while libraries may fail to start.
PLATE = ("render", "builtin:plate", *TINY[:-3], "-q")
FEW_THREADS = {
    "o.png": ((*PLATE, "--threads", "4"), (0,)),
    "o.pfm": ((*PLATE, "--mip-filter", "mipnet", "--threads", "3"), (0,)),
    "r.pfm": ((*PLATE, "--backend", "reference", "--samples", "4", "--threads", "4"), (0,)),
    "v.pfm": ((*PLATE, "--backend", "vulkan", "--threads", "2"), (0, 4)),
    "o.exr": ((*PLATE, "--threads", "2"), (0, 4)),
    "o.mip": (("bake", "mip", "builtin:roofs=1", "-q"), (0,)),
    "levels": (("bake", "mip", "builtin:roofs=1", "--format", "png-levels", "--threads", "4", "-q"), (0,)),
    "tiles": (("bake", "mip", "builtin:roofs=1", "--format", "exr-mip", "--threads", "2", "-q"), (0, 4)),
    "report": (("chart", "builtin:plate", *CHART[1:]), (0, 4)),
    "lit.png": ((*PLATE, "--env", "sky.exr", "--threads", "4"), (0, 4)),
    "found.json": (("compare", "a.pfm", "b.pfm", "--threads", "4", "-q"), (0, 4)),
}
OUTPUT = {"found.json": "--json"}  # -o for all others


def bytes_of(path):
    return {file.name: file.read_bytes() for file in ([path] if path.is_file() else sorted(path.glob("*"))) if file.is_file()}


def with_few_threads(bench, jobs, counts, user):
    """Makes equal files by `counts` processes of another user, or one error line, a code, and no file."""
    if os.geteuid() or bench.sanitized:
        raise Skipped("needs root, to become a user with a limit, and no threads of sanitizers")
    bench.folder.chmod(0o777)
    env = {"XDG_CACHE_HOME": str(bench.folder / "own")}
    try:
        bench.run("--version", user=user).expect(0)
    except Exception as error:
        raise Skipped(f"another user cannot run the program here: {error}") from error
    for picture, more in (("sky.exr", ("--size", "64x32")), ("a.pfm", ()), ("b.pfm", ("--samples", "4"))):  # inputs
        bench.run(*PLATE, *more, "-o", picture).expect(0)
        (bench.folder / picture).chmod(0o644)
    for name, (words, codes) in jobs.items():
        words += (OUTPUT.get(name, "-o"), name)
        path = bench.folder / name
        done = bench.run(*words, user=user, env=env)
        if done.code == 77:
            continue  # the library or the device is missing
        done.expect(0)
        whole = bytes_of(path)
        for count in counts:
            shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)
            done = bench.run(*words, user=user, processes=count, env=env, timeout=60.0)
            check(done.code in codes, f"{name} by {count}: {done.describe()}")
            if done.code == 0:
                check(name == "report" or bytes_of(path) == whole, f"{name} by {count}: other bytes")
            else:
                done.expect_one_line("thread")
                failed = path.exists() and name == "found.json" and json.loads(path.read_text())["verdict"] == "failed"  # as compare reports
                check(name == "report" or failed or not path.exists(), f"{name} by {count}: something is left")
            if not path.exists():
                continue
        shutil.rmtree(path) if path.is_dir() else path.unlink(missing_ok=True)


@case("confine.few_threads_draw_the_same", tier="nightly")
def few_threads(bench):
    with_few_threads(bench, {name: FEW_THREADS[name] for name in ("o.png", "o.pfm", "r.pfm", "levels")}, (1, 2, 3), 50000 + os.getpid() % 5000)


@case("confine.few_threads_of_libraries_are_said", tier="nightly")
def few_threads_of_libraries(bench):
    with_few_threads(bench, {name: FEW_THREADS[name] for name in ("o.exr", "v.pfm")}, (1, 2, 4, 6), 55000 + os.getpid() % 5000)


@case("confine.few_threads_all", tier="nightly")
def few_threads_all(bench):
    with_few_threads(bench, FEW_THREADS, range(1, 13), 60000 + os.getpid() % 5000)


@case("confine.fewer_threads_are_a_warning", tier="nightly")
def fewer_are_said(bench):
    if os.geteuid() or bench.sanitized:
        raise Skipped("needs root, to become a user with a limit, and no threads of sanitizers")
    bench.folder.chmod(0o777)
    words = (*PLATE[:-1], "--threads", "4", "-o", "o.png")
    done = bench.run(*words, user=50000 + os.getpid() % 5000, processes=2, env={"XDG_CACHE_HOME": str(bench.folder / "own")}).expect(0)
    check("burnish: warning: the system gives " in done.err and " of 4 threads" in done.err, done.describe())
    check("warning" not in bench.run(*words).expect(0).err, "all threads, and a warning")


@case("confine.threads_of_a_control_group", tier="nightly")
def threads_group(bench):
    words = FEW_THREADS["o.png"][0]
    bench.run(*words, "-o", "whole.png").expect(0)
    for limit in (1, 2, 3):
        done = in_group(bench, THREADS, limit, (*words, "-o", "o.png"))
        check(done.returncode == 0, f"{limit}: exit code {done.returncode}: {done.stderr}")
        check((bench.folder / "o.png").read_bytes() == (bench.folder / "whole.png").read_bytes(), f"{limit}: another picture")


@case("confine.little_address_space_of_a_bake", tier="nightly")
def little_memory_of_a_bake(bench):
    words = ("bake", "mip", "builtin:roofs=1", "--format", "png-levels", "-q", "-o", "levels")
    if bench.sanitized:
        raise Skipped("shadow memory reserves terabytes of addresses")
    for limit in (60, 80, 100, 128, 192, 2048):
        done = subprocess.run([bench.program, *words], cwd=bench.folder, env=bench.environment({}), capture_output=True, text=True,
                              preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit * MIB, limit * MIB)), timeout=120, check=False)
        if done.returncode == 127 and "shared librar" in done.stderr:
            continue  # the loader had no memory
        check(done.returncode in (0, 4, 7, 77), f"{limit} MiB: exit code {done.returncode}: {done.stderr}")
        check((bench.folder / "levels").exists() == (done.returncode == 0), f"{limit} MiB: output and exit code do not agree")
        check(done.returncode == 0 or len(done.stderr.splitlines()) == 1, f"{limit} MiB: {done.stderr}")
        shutil.rmtree(bench.folder / "levels", ignore_errors=True)
    check(done.returncode == 0, f"2 GiB are not enough: {done.stderr}")


@case("confine.read_only_root_and_no_rights", tier="nightly")
def read_only_root(bench):
    """Runs as nobody, as process 1, without a network, with one small writable file system: like in a container."""
    if os.geteuid():
        raise Skipped("needs root, to become nobody")
    folder = bench.folder / "free"
    folder.mkdir()
    script = ('mount --make-rprivate / && mount -t proc none /proc && mount -t tmpfs -o mode=1777,size=4m none "$0" && mount -o remount,bind,ro / '
              '&& cd "$0" || exit 99; exec setpriv --reuid 65534 --regid 65534 --clear-groups --no-new-privs --bounding-set=-all "$@"')
    command = ["unshare", "--mount", "--pid", "--net", "--ipc", "--fork", "sh", "-c", script, str(folder)]
    try:
        probe = subprocess.run([*command, "true"], capture_output=True, text=True, timeout=60, check=False)
    except FileNotFoundError:
        raise Skipped("no unshare") from None
    reach = subprocess.run([*command, bench.program, "--version"], capture_output=True, text=True, timeout=60, check=False)
    if probe.returncode or reach.returncode:
        raise Skipped(f"cannot be set up here: {probe.stderr} {reach.stderr}")
    env = {"PATH": os.environ["PATH"], "XDG_CACHE_HOME": "/nowhere/at/all"}
    outside = str(pathlib.Path(bench.folder).parent / "nobody.png")
    for words, code in ((("render", *TINY, "-o", "o.png", "-o", "o.exr", "--stats", "-"), 0), (("render", *TINY, "-o", outside), 7), (("info",), 0),
                        (("render", *TINY, "-o", "/o.png"), 7), (("compare", "none.png", "none.png"), 4),
                        (("render", *TINY, "--size", "2000x2000", "-o", "o.pfm"), 7),  # more than the available 4 MiB
                        (("chart", *TINY, "-o", "/report"), 7), (("list", "scenes"), 0)):
        done = subprocess.run([*command, bench.program, *words], capture_output=True, text=True, env=env, timeout=300, check=False)
        check(done.returncode == code, f"{words}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
        check(code == 0 or len(done.stderr.splitlines()) == 1, f"{words}: {done.stderr}")
        if words[-1] == "-":
            check(any("is not cached" in line for line in json.loads(done.stdout)["warnings"]), "the cache that cannot be is not told")
    check(not os.path.exists(outside) and not os.path.exists("/o.png"), "written where nothing can be")


@case("confine.a_folder_without_rights", tier="nightly")
def no_rights(bench):
    """Runs as nobody in a folder of root. Failed writes are reported, and nothing is left."""
    if os.geteuid():
        raise Skipped("needs root, to become nobody")
    bench.folder.chmod(0o755)
    free = bench.folder / "free"
    free.mkdir()
    os.chown(free, 65534, 65534)
    try:
        bench.run("--version", user=65534).expect(0)
    except Exception as error:
        raise Skipped(f"nobody cannot run the program here: {error}") from error
    env = {"XDG_CACHE_HOME": str(bench.folder / "own")}
    bench.run("render", *TINY, "-o", "o.png", user=65534, env=env).expect(7).expect_one_line("o.png")
    bench.run("render", *TINY, "-o", "free/o.png", user=65534, env=env).expect(0)
    (free / "o.png").chmod(0o444)
    bench.run("render", *TINY, "-o", "free/o.png", user=65534, env=env).expect(0)
    check((free / "o.png").stat().st_mode & 0o777 == 0o444, "permissions have changed")
    check(bench.left_behind() == ["free", "o.png"], f"left: {bench.left_behind()}")
    shutil.rmtree(free)
