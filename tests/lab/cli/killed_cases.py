"""Jobs of the laboratory that are killed at random moments and started again."""

import json
import time

from fault_cases import needs_embree
from harness import Skipped, case, check
from kill_cases import add_job, kill_at_random, temporary


def killed_reports(bench, words, kills):
    """`race` and `parity` write once, at the end, completely or not at all. Cached pipelines do no harm to the next run."""
    own = kills > 10  # a separate cache, so that pipelines are compiled and written repeatedly
    env = {"XDG_CACHE_HOME": str(bench.folder / "cache")} if own else {}
    env["GALLIVM_PERF"] = "nopt"  # optimising pipelines would take longer than drawing
    words = (*words, "--json", "found.json")
    begin = time.monotonic()
    done = bench.run(*words, env=env, timeout=500.0)
    if done.code == 77:
        raise Skipped(done.err.strip())
    done.expect(0)
    longest = time.monotonic() - begin
    rows = len(json.loads((bench.folder / "found.json").read_text())["rows"])

    def whole():
        path = bench.folder / "found.json"
        check(not path.exists() or len(json.loads(path.read_text())["rows"]) == rows, "half a report")
        path.unlink(missing_ok=True)
        for kept in (bench.folder / "cache/burnish").glob("pipelines-*"):
            kept.unlink()

    kill_at_random(bench, words, kills, 11, longest, env, whole)
    bench.run(*words, env=env, timeout=500.0).expect(0)
    whole()
    left = temporary(path.name for path in bench.folder.rglob("*"))
    check(not left, f"left: {left}")


RACE = ("race", "builtin:teapot", "--size", "96x64", "--techniques", "split_isotropic", "--msaa", "1", "--runs", "2", "--devices", "lavapipe",
        "--env-size", "16", "--env-samples", "16")


PARITY = ("parity", "builtin:plate", "--size", "64x48", "--technique", "split_isotropic,mc", "--msaa", "1", "--device", "lavapipe",
          "--env-size", "16", "--env-samples", "16")


@case("kill.races_report_all_or_nothing", tier="nightly")
def races(bench):
    killed_reports(bench, RACE, 2)


@case("kill.races_report_all_or_nothing_long", tier="nightly")
def races_long(bench):
    killed_reports(bench, RACE, 15)
    killed_reports(bench, PARITY, 15)


add_job("tables", ("bake", "ltc", "--resolution", "4", "--steps", "6", "--samples", "4", "-q", "-o", "{}.ltc"), ("{}.ltc",))
add_job("trainings", ("train", "mip", "--steps", "12", "--size", "1x4", "-q", "-o", "{}.mipnet"), ("{}.mipnet",))
add_job("atlases", ("atlas", "albedo_by_a_fit", "--quick", "--threads", "2", "-q", "-o", "{}"), ("{}/atlas.json",), needs_embree)
