"""`race`: the lean shaders draw the kernels' pictures, so that both cost what the same picture costs."""
import json

from harness import Skipped, case, check

# Techniques whose fragments share samples, which no device does. All others stay within 0.005.
SHARE = {"lobe_line": 0.025, "as_mc": 0.075}


@case("race.lean_shaders_draw_the_pictures_of_kernels", budget=12)
def lean(bench):
    done = bench.run("race", "builtin:spheres", "builtin:lights", "--techniques", "all", "--shaders", "lean", "--devices", "lavapipe", "--msaa", "1",
                     "--size", "128x72", "--runs", "1", "--json", "race.json", timeout=300.0)
    if done.code == 77:
        raise Skipped(done.err.strip())
    done.expect(0)
    rows = json.loads((bench.folder / "race.json").read_text())["rows"]
    check(len(rows) == 20, f"{len(rows)} rows")
    for row in rows:
        name, most = f"{row['scene']} {row['technique']}", SHARE.get(row["technique"], 0.005)
        check(row["error"] is None, f"{name}: {row['error']}")
        check(row["flip_mean"] < most, f"{name}: FLIP {row['flip_mean']}")
