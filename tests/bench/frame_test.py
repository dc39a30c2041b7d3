"""bench_frame: its JSON is consistent. Usage: frame_test.py BENCH_FRAME FOLDER"""

import json
import os
import pathlib
import statistics
import subprocess
import sys

program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
folder.mkdir(parents=True, exist_ok=True)
environment = {**os.environ, "XDG_CACHE_HOME": str(folder / "cache")}


def run(*arguments, code=0):
    done = subprocess.run([program, *arguments], capture_output=True, text=True, env=environment)
    assert done.returncode == code, f"{arguments} ended with {done.returncode}\n{done.stdout}\n{done.stderr}"
    return done


listed = [line.split()[1] for line in run("--list").stdout.splitlines()]
assert len(listed) == len(set(listed)) > 30, "names of workloads"
file = folder / "frame.json"
done = run("--only", "trivial_", "--rounds", "3", "--isa", "scalar", "--threads", "1", "--json", str(file))
found = json.loads(file.read_text())
for key in ("processor", "cores", "version", "compiler", "load_average"):
    assert key in found["machine"], key
assert 0.2 < found["clock_ghz"] < 10 and 0 <= found["waited"] <= 1 and (not found["headline"] or found["waited"] < 0.03)
assert found["threads"] == 1 and found["rounds"] == 3
times = {}
for workload in found["workloads"]:
    for clock in ("cpu_ms", "wall_ms"):
        rounds = workload[clock + "_rounds"]
        assert len(rounds) == 3 and all(ms > 0 for ms in rounds), workload
        assert abs(workload[clock]["median"] - statistics.median(rounds)) < 1e-9, workload
        assert workload[clock]["low"] <= workload[clock]["median"] <= workload[clock]["high"], workload
    assert workload["isa"] == "scalar" and workload["name"] in listed
    assert len(workload["pixels"]) == 16 and int(workload["pixels"], 16), workload
    times[workload["name"]] = workload
assert {"trivial_1x", "trivial_8x"} <= times.keys(), times.keys()
# The CPU time of one thread cannot exceed the elapsed time.
assert all(w["cpu_ms"]["median"] < 1.05 * w["wall_ms"]["median"] for w in times.values() if "two" not in w["name"]), times
rows = {row["what"]: row for row in found["rows"]}
for what, name, limit in (("constant colour, 1x", "trivial_1x", 4), ("constant colour, 8x", "trivial_8x", 8)):
    row = rows[what]
    assert row["measured"] == times[name]["cpu_ms"] and row["unit"] == "ms" and row["aim"] == limit, row
    assert row["met"] == ((row["measured"]["median"] <= limit) if found["headline"] else None), row
    assert ("busy" in done.stdout) != found["headline"]
    assert what in done.stdout
run("--isa", "sse9", code=2)
run("--rounds", "0", code=2)
run("--unknown", code=2)
run("--only", "first_pixel", "--rounds", "1", "--program", "/nowhere/burnish", code=70)
