#!/usr/bin/env python3
"""What 8-bit weights of texture filters do to area lights by transformed cosines.

Usage: ltc_weights.py --program build/release/burnish [--bits N]

Draws quads about seeded points by the exported GLSL on lavapipe, once with float weights between the table's nodes, as the file has them,
and once with weights in steps of 2^-N (8), as texture units filter. Prints the differences relative to the light. Exit code: 0 measured; 2
something could not be run.
"""

import argparse
import pathlib
import statistics
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/cli"))
import export_language_cases as cases  # noqa: E402
import harness  # noqa: E402


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    parser.add_argument("--bits", type=int, default=8)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        bench = harness.Bench(str(pathlib.Path(given.program).resolve()), "", [ROOT / "tests/data"], folder, False)
        bench.open("ltc_weights")
        try:
            table = cases.ltc_table(bench)
            bench.run("export", "glsl", "--ltc", "--technique", "bent_normal", "-o", "bent_normal.glsl").expect(0)
            text = cases.source(bench, cases.GLSL_QUAD, "bent_normal", "glsl")
            mark = "    c.u_lambda = lambda_at - float(l);\n"
            if text.count(mark) != 1:
                raise SystemExit("ltc_weights.py: the exported text has other weights")
            steps = "".join(f"    c.u_{axis} = floor(c.u_{axis} * {2.0 ** given.bits} + 0.5) / {2.0 ** given.bits};\n" for axis in ("theta", "phi", "alpha", "lambda"))
            exact = cases.on_lavapipe(bench, text, more=table)
            stepped = cases.on_lavapipe(bench, text.replace(mark, mark + steps), more=table)
        except (harness.Skipped, harness.Failed) as reason:
            print(reason, file=sys.stderr)
            return 2
    off = sorted(abs(a - b) / a for a, b in zip(exact[::3], stepped[::3]) if a > 1e-4)
    print(f"{len(off)} quads, weights of {given.bits} bits: relative difference: median {statistics.median(off):.2e}, 99 % {off[int(0.99 * len(off))]:.2e}, worst {off[-1]:.2e}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
