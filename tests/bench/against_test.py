"""bench/against.py computes ratios of two programs' known times, and bench/instructions/mix.py reads callgrind's counts."""

import contextlib
import importlib.util
import io
import json
import pathlib
import sys
import tempfile
import unittest


def load(*place):
    path = pathlib.Path(__file__).parents[2].joinpath("bench", *place)
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


against, mix = load("against.py"), load("instructions", "mix.py")

# Replaces bench_frame: returns the times of TIMES, one workload a call, with an image hash.
PROGRAM = """#!{python}
import json, sys
times = {times}
name = sys.argv[sys.argv.index("--only") + 1]
rows = [dict(name=name, isa="avx2", cpu_ms_rounds=times[name], pixels="{pixels}")] if name in times else []
open(sys.argv[sys.argv.index("--json") + 1], "w").write(json.dumps(dict(workloads=rows)))
"""


class AgainstTest(unittest.TestCase):
    def run_on(self, old, new, pixels=("1", "1")):
        with tempfile.TemporaryDirectory() as folder:
            for name, times, picture in (("old", old, pixels[0]), ("new", new, pixels[1])):
                program = pathlib.Path(folder, name, "bench_frame")
                program.parent.mkdir()
                program.write_text(PROGRAM.format(python=sys.executable, times=times, pixels=picture))
                program.chmod(0o755)
            out, figures = io.StringIO(), pathlib.Path(folder, "figures.json")
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
                code = against.main([f"{folder}/old", "--program", f"{folder}/new/bench_frame", "--isa", "avx2", "--turns", "3", "--json", str(figures)])
            return code, out.getvalue(), {row["name"]: row for row in json.loads(figures.read_text())["rows"]}

    def test_ratios_are_those_of_medians(self):
        code, text, rows = self.run_on({"trivial_8x": [9.0, 10.0, 50.0], "slivers_10k": [4.0]}, {"trivial_8x": [5.0, 5.0, 1.0]})
        self.assertEqual(code, 0)
        self.assertAlmostEqual(rows["trivial_8x"]["ratio"], 0.5)
        self.assertEqual(list(rows), ["trivial_8x"])
        line = next(line for line in text.splitlines() if "constant colour, 8x" in line)
        self.assertTrue(line.endswith("met"), line)
        self.assertIn("not in both", next(line for line in text.splitlines() if "slivers" in line))

    def test_what_is_slower_or_looks_otherwise_is_said(self):
        code, text, rows = self.run_on({"trivial_8x": [10.0]}, {"trivial_8x": [11.0]}, ("1", "2"))
        self.assertEqual((code, rows["trivial_8x"]["other_pixels"]), (1, True))
        self.assertIn("missed other pixels", text)
        self.assertEqual(self.run_on({}, {})[0], 2)

    def test_every_workload_of_the_table_is_one(self):
        known = (pathlib.Path(__file__).parents[2] / "bench" / "frame" / "workloads.cpp").read_text()
        for name, what, aim in against.TABLE:
            self.assertIn(f'{{"{name}", ', known, what)


class MixTest(unittest.TestCase):
    def test_addresses_are_differences_and_callees_do_not_count(self):
        text = "fn=(1) f\n0x100 0 7\n+4 0 2\ncalls=1 0x200 0\n* 0 1000\n-4 +1 5\n* * 1\n"
        self.assertEqual(dict(mix.counts_of(text.splitlines())), {0x100: 13, 0x104: 2})

    def test_kinds(self):
        for text, kind in (("vmulps %ymm0,%ymm1,%ymm2", "multiply"), ("vdivps %ymm0,%ymm1,%ymm2", "divide, root"), ("vpmulld %ymm0,%ymm1,%ymm2", "multiply"),
                           ("vmovaps %ymm0,0x20(%rsp)", "move"), ("vpermilps $0x0,%ymm0,%ymm1", "shuffle"), ("vcvtph2ps (%rax),%ymm0", "convert"),
                           ("jne 1234", "branch, call"), ("lea 0x1(%rax),%ecx", "scalar"), ("vblendvps %ymm0,%ymm1,%ymm2,%ymm3", "compare, select")):
            self.assertEqual(mix.kind_of(text), kind, text)


if __name__ == "__main__":
    sys.exit(unittest.main())
