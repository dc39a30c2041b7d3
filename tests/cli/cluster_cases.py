"""Jobs in pieces under the engines of clusters: GNU parallel, mpirun, Slurm."""

import os
import pathlib
import random
import shutil
import signal
import socket
import subprocess
import time

from fault_cases import needs_embree
from harness import Skipped, case, check
from pieces_cases import CHART, PICTURE, ROW, files_of


def kill_one(bench, word):
    """Kills one process in the bench's folder whose command holds a word. Returns true if there was one."""
    for folder in pathlib.Path("/proc").iterdir():
        try:
            words = (folder / "cmdline").read_bytes().split(b"\0")
            if words[0].endswith(b"burnish") and word.encode() in words and (folder / "cwd").samefile(bench.folder):
                os.kill(int(folder.name), signal.SIGKILL)
                return True
        except (OSError, ValueError):
            pass  # no process, or one that ended
    return False


def tool(name):
    if not shutil.which(name):
        raise Skipped(f"{name} is not installed")
    return name


def script(bench, engine, words, *more):
    text = bench.run("submit", "--for", engine, *more, "--work", "w", "--", *words).expect(0).out
    (bench.folder / "burnish").symlink_to(bench.program)
    (bench.folder / "run.sh").write_text(text)
    return text


def by_script(bench, engine, extra=None, *more):
    """Runs the script of an engine, and compares with one process."""
    bench.run(*ROW, "-o", "one_%d.png", "-o", "one.apng").expect(0)
    script(bench, engine, (*ROW, "-o", "two_%d.png", "-o", "two.apng"), *more)
    env = bench.environment({"PATH": f"{bench.folder}:/usr/sbin:/usr/bin:/bin", **(extra or {})})
    done = subprocess.run(["sh", "run.sh"], cwd=bench.folder, env=env, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300)
    check(done.returncode == 0, done.stdout + done.stderr)
    return lambda: check((bench.folder / "one.apng").read_bytes() == (bench.folder / "two.apng").read_bytes(), "other bytes")


@case("pieces.run_by_gnu_parallel", tier="nightly")
def by_parallel(bench):
    tool("parallel")
    by_script(bench, "parallel", None, "--at-once", "2")()


MPI = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1"}


@case("pieces.run_by_mpirun", tier="nightly")
def by_mpirun(bench):
    tool("mpirun")
    by_script(bench, "mpi", MPI, "--shards", "3")()


@case("pieces.survive_a_killed_rank_of_mpirun", tier="nightly")
def killed_rank(bench):
    tool("mpirun")
    needs_embree(bench)
    words = (*PICTURE, "--samples", "65536", "--threads", "1")
    bench.run(*words, "-o", "one.exr", timeout=300).expect(0)
    script(bench, "mpi", (*words, "-o", "two.exr"), "--shards", "3")
    text = (bench.folder / "run.sh").read_text()
    check(" || true\n" in text, text)
    (bench.folder / "run.sh").write_text(text.replace(" || true\n", '; echo "mpirun ends with $?"\n', 1))
    env = bench.environment({"PATH": f"{bench.folder}:/usr/sbin:/usr/bin:/bin", **MPI})
    running = subprocess.Popen(["sh", "run.sh"], cwd=bench.folder, env=env, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    until, killed = time.monotonic() + 60, False
    while not killed and running.poll() is None and time.monotonic() < until:
        killed = bool(list(bench.folder.glob("w/*.piece"))) and kill_one(bench, "--shard")
        time.sleep(0.02)
    out = running.communicate(timeout=300)[0]
    check(killed, f"no rank was there to be killed: {out}")
    check("mpirun ends with 0" in out, f"mpirun judges by itself: {out}")
    check(running.returncode == 0 and (bench.folder / "one.exr").read_bytes() == (bench.folder / "two.exr").read_bytes(), out)


SLURM = """ClusterName=here
SlurmctldHost={host}(127.0.0.1)
AuthType=auth/none
CredType=cred/none
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SlurmUser=root
SlurmdUser=root
SlurmctldPidFile={at}/ctld.pid
SlurmdPidFile={at}/d.pid
SlurmdSpoolDir={at}/spool
StateSaveLocation={at}/state
SlurmctldPort={port}
SlurmdPort={other}
InactiveLimit=0
ReturnToService=2
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes={host} Default=YES State=UP OverSubscribe=YES
"""


def output_of(words, env, wait=60):
    return subprocess.run(words, env=env, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=wait).stdout


@case("pieces.run_by_slurm", tier="nightly")
def by_slurm(bench):
    """Both daemons on this machine, without users, keys and control groups. One task of the array is killed."""
    tool("slurmctld")
    if os.getuid() != 0:
        raise Skipped("Slurm's daemons need the superuser")
    ports = random.Random(os.getpid()).randrange(20000, 30000, 2)
    at, host = bench.folder / "slurm", socket.gethostname().split(".")[0]
    for name in ("spool", "state"):
        (at / name).mkdir(parents=True)
    (at / "slurm.conf").write_text(SLURM.format(host=host, at=at, port=ports, other=ports + 1))
    env = bench.environment({"PATH": f"{bench.folder}:/usr/sbin:/usr/bin:/bin", "SLURM_CONF": str(at / "slurm.conf"),
                             "XDG_CACHE_HOME": str(bench.folder / "own")}) # references are made anew
    daemons = [subprocess.Popen([name, "-D"], env=env, stdin=subprocess.DEVNULL, stdout=open(at / (name + ".log"), "w"), stderr=subprocess.STDOUT)
               for name in ("slurmctld", "slurmd")]
    try:
        until = time.monotonic() + 60
        while "idle" not in output_of(["sinfo", "-h", "-o", "%T"], env):
            check(time.monotonic() < until, "no node of Slurm: " + (at / "slurmctld.log").read_text()[-2000:] + (at / "slurmd.log").read_text()[-2000:])
            time.sleep(0.5)
        chart = (*CHART, "--reference-samples", "4096")
        bench.run(*chart, "-o", "one", timeout=300).expect(0)
        script(bench, "slurm", (*chart, "-o", "two"), "--shards", "4")
        done = subprocess.run(["sh", "run.sh"], cwd=bench.folder, env=env, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60)
        check(done.returncode == 0, done.stdout + done.stderr)
        killed = False
        until = time.monotonic() + 300
        while output_of(["squeue", "-h"], env):
            check(time.monotonic() < until, "the jobs do not end")
            if not killed:
                killed = kill_one(bench, "--take")
            time.sleep(0.2)
        check(killed, "no task was there to be killed")
        logs = "".join(path.read_text() for path in bench.folder.glob("slurm-*.out"))
        check((bench.folder / "two/report.csv").exists(), f"no report: {logs}")
        one, two = files_of(bench.folder / "one"), files_of(bench.folder / "two")
        check(one == two, f"other files: {[name for name in one if one[name] != two.get(name)]}")
    finally:
        for daemon in reversed(daemons):
            daemon.terminate()
        for daemon in daemons:
            daemon.wait(timeout=30)
