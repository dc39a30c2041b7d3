"""bench/roofline.py draws known figures at their places."""

import contextlib
import importlib.util
import io
import json
import pathlib
import sys
import tempfile
import unittest
import xml.etree.ElementTree as tree

path = pathlib.Path(__file__).parents[2] / "bench" / "roofline.py"
spec = importlib.util.spec_from_file_location("roofline", path)
roofline = importlib.util.module_from_spec(spec)
spec.loader.exec_module(roofline)

SVG = "{http://www.w3.org/2000/svg}"


def row(name, **figures):
    return {"name": name, "run_type": "iteration", "cpu_time": 1.0, "time_unit": "us", **figures}


# avx2: 100 Gop/s and 2 G loads/s from L2. The kernel: 400 operations and 320 bytes (20 loads) in 20 ns.
FIGURES = {"context": {"load_avg": [2.5]}, "benchmarks": [
    row("limit/operations/avx2", operations=100e9), row("limit/operations/avx2", operations=90e9),
    row("limit/random_loads/KiB/16", loads=4e9), row("limit/random_loads/KiB/512", loads=2e9), row("limit/random_loads/KiB/8192", loads=1e9),
    row("limit/random_loads/KiB/262144", loads=1e8),
    row("kernel/some_kernel/eta:0.5/avx2", cpu_time=20.0, operations=400, bytes=320, fragments=1000),
    row("kernel/some_kernel/eta:0.5/avx2", cpu_time=25.0, operations=400, bytes=320, fragments=1000),
    {**row("kernel/some_kernel/eta:0.5/avx2_mean", cpu_time=1.0), "run_type": "aggregate"}]}


class RooflineTest(unittest.TestCase):
    def figures(self):
        return roofline.figures_of(json.dumps(FIGURES))

    def test_limits_and_kernels(self):
        limits, kernels = self.figures()
        self.assertEqual(limits, {"operations": {"avx2": 100e9}, "loads": {"L1": 4e9, "L2": 2e9, "L3": 1e9}})
        self.assertEqual(list(kernels), [("some_kernel", "0.5", "avx2")])
        self.assertAlmostEqual(kernels["some_kernel", "0.5", "avx2"]["ns"], 20.0)

    def test_shares(self):
        limits, kernels = self.figures()
        operations, loads = roofline.share(kernels["some_kernel", "0.5", "avx2"], "avx2", limits)
        self.assertAlmostEqual(operations, 0.2)  # 20 Gop/s of 100
        self.assertAlmostEqual(loads, 0.5)       # 1 G loads/s of 2
        self.assertIn("20.0 %", roofline.table(limits, kernels))

    def test_chart(self):
        root = tree.fromstring(roofline.chart(*self.figures()))
        mark = root.find(f"{SVG}circle[@class='kernel']")
        ceiling = root.find(f"{SVG}line[@class='ceiling']")
        y_mark, y_ceiling = float(mark.get("cy")), float(ceiling.get("y1"))
        self.assertTrue(roofline.TOP < y_ceiling < y_mark < roofline.BOTTOM)  # below the ceiling and inside the chart
        # The kernel lies at half the height of the L2 slope: 1.25 operations a byte times 32 GB/s are 40 Gop/s, and the kernel does 20.
        slopes = [line for line in root.iter(f"{SVG}line") if line.get("class") == "slope"]
        self.assertEqual(len(slopes), 3)
        x0, x1, y0, y1 = (float(slopes[1].get(key)) for key in ("x1", "x2", "y1", "y2"))
        at_slope = y0 + (y1 - y0) * (float(mark.get("cx")) - x0) / (x1 - x0)
        # logarithmic scale: the mark lies 5 times below the ceiling and 2 times below the slope
        self.assertAlmostEqual((y_mark - at_slope) / (y_mark - y_ceiling), 0.6931 / 1.6094, places=2)

    def test_instruction_sets_are_those_of_the_figures(self):
        limits, kernels = self.figures()
        isas = ["avx2", "neon", "sve"]
        limits["operations"] = dict.fromkeys(isas, 100e9)
        kernels = {("some_kernel", "0.5", isa): next(iter(kernels.values())) for isa in isas}
        root = tree.fromstring(roofline.chart(limits, kernels))
        marks, lines = root.findall(f"{SVG}circle[@class='kernel']"), root.findall(f"{SVG}line[@class='ceiling']")
        self.assertEqual(len({mark.get("fill") for mark in marks}), 3)
        self.assertEqual({mark.get("fill") for mark in marks}, {line.get("stroke") for line in lines})
        heads = [text for text in root.iter(f"{SVG}text") if text.text in isas]
        self.assertEqual([text.text for text in heads], isas)
        self.assertTrue(all(float(text.get("x")) + 40 < float(root.get("width")) for text in heads))
        labels = sorted(float(text.get("y")) for text in root.iter(f"{SVG}text") if "not fused" in text.text)
        self.assertTrue(all(b - a >= 16 for a, b in zip(labels, labels[1:])))  # three equal ceilings, each with its name

    def test_command(self):
        with tempfile.TemporaryDirectory() as folder:
            source, target = pathlib.Path(folder, "in.json"), pathlib.Path(folder, "out.svg")
            source.write_text(json.dumps(FIGURES))
            out = io.StringIO()
            with contextlib.redirect_stdout(out):
                self.assertEqual(roofline.main(["--from", str(source), "-o", str(target)]), 0)
            self.assertIn("load average of 2.50", out.getvalue())
            tree.parse(target)
            for bad in ("{", "{}", '{"benchmarks": []}', '{"benchmarks": [{"name": "limit/operations"}]}'):
                source.write_text(bad)
                with contextlib.redirect_stderr(out):
                    self.assertEqual(roofline.main(["--from", str(source), "-o", str(target)]), 2, bad)


if __name__ == "__main__":
    sys.exit(unittest.main())
