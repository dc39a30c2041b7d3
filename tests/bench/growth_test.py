"""bench/growth.py fits lines to known figures and reports figures that form no line."""

import contextlib
import importlib.util
import io
import json
import pathlib
import sys
import tempfile
import unittest
import xml.etree.ElementTree as tree

path = pathlib.Path(__file__).parents[2] / "bench" / "growth.py"
spec = importlib.util.spec_from_file_location("growth", path)
growth = importlib.util.module_from_spec(spec)
spec.loader.exec_module(growth)

SVG = "{http://www.w3.org/2000/svg}"


def workload(group, along, ms, isa="avx2"):
    return {"group": group, "along": along, "isa": isa, "cpu_ms": {"median": ms}, "wall_ms": {"median": ms}}


FIGURES = {
    "machine": {"processor": "A", "version": "1", "cores": 2}, "threads": 2, "headline": False,
    "workloads": [workload("growth_lights", n, 3.0 + 2.0 * n) for n in (4, 1, 2)] +
                 [workload("growth_layers", n, float(n * n)) for n in (1, 2, 3)] +
                 [workload("growth_threads", n, 8.0 / n) for n in (1, 2, 4)] +
                 [workload("growth_lights", 1, 99.0, "scalar"), workload("msaa", 0, 1.0)]}


class Growth(unittest.TestCase):
    def rows(self):
        return growth.rows_of(json.dumps(FIGURES))[1]

    def test_lines(self):
        rows = self.rows()
        self.assertEqual(list(rows), ["growth_lights", "growth_layers", "growth_threads"])
        for value, wanted in zip(growth.line_through(rows["growth_lights"]), (3.0, 2.0, 0.0)):
            self.assertAlmostEqual(value, wanted)
        start, slope, bend = growth.line_through(rows["growth_layers"])  # through 1, 4, 9: each is off by a ninth
        self.assertAlmostEqual(bend, 100.0 / 9.0)
        for x, y in rows["growth_layers"]:
            self.assertAlmostEqual(abs(start + slope * x - y) / y, 1.0 / 9.0)
        self.assertEqual(rows["growth_threads"], [(1.0, 8.0), (2.0, 8.0)])  # at most one thread a core
        self.assertEqual(growth.line_of("growth_threads", rows["growth_threads"]), (8.0, 0.0, 0.0))
        # a second thread without effect: any line passes through two points, but not a level line
        start, slope, bend = growth.line_of("growth_threads", [(1.0, 8.0), (2.0, 16.0)])
        self.assertEqual(slope, 0.0)
        self.assertAlmostEqual(bend, 100.0 / 3.0)
        for y in (8.0, 16.0):
            self.assertAlmostEqual(abs(start - y) / y, 1.0 / 3.0)

    def test_nearest_of_all(self):
        points = [(1.0, 2.0), (2.0, 2.9), (3.0, 4.3), (5.0, 5.6), (8.0, 9.4)]
        start, slope, bend = growth.line_through(points)
        self.assertAlmostEqual(bend, 100 * max(abs(start + slope * x - y) / y for x, y in points))
        for more in (-0.01, 0.01):
            for turned in (0.0, more / 5.0, -more / 5.0):
                other = max(abs(start + more + (slope + turned) * x - y) / y for x, y in points)
                self.assertGreater(100 * other, bend)

    def test_chart(self):
        root = tree.fromstring(growth.chart("here", self.rows()))
        self.assertEqual(len(root.findall(f"{SVG}polyline[@class='line']")), 3)
        marks = root.findall(f"{SVG}circle[@class='measured']")
        self.assertEqual(len(marks), 8)
        first = [point.split(",") for point in root.find(f"{SVG}polyline[@class='line']").get("points").split()]
        (x0, y0), (x1, y1) = [(float(x), float(y)) for x, y in first]
        for mark in marks[:3]:  # lights lie on their line
            x, y = float(mark.get("cx")), float(mark.get("cy"))
            self.assertAlmostEqual(y0 + (y1 - y0) * (x - x0) / (x1 - x0), y, delta=0.2)

    def test_command(self):
        with tempfile.TemporaryDirectory() as folder:
            source, target = pathlib.Path(folder, "in.json"), pathlib.Path(folder, "out.svg")
            source.write_text(json.dumps(FIGURES))
            out = io.StringIO()
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
                self.assertEqual(growth.main(["--from", str(source), "-o", str(target)]), 0)
                self.assertEqual(growth.main(["--from", str(source), "-o", str(target), "--fail-bend", "5"]), 1)
            self.assertIn("no straight line: growth_layers\n", out.getvalue())
            self.assertIn("the machine was busy", target.read_text())
            for bad in ("{", "{}", '{"workloads": []}', json.dumps({**FIGURES, "workloads": []})):
                source.write_text(bad)
                with contextlib.redirect_stderr(out):
                    self.assertEqual(growth.main(["--from", str(source), "-o", str(target)]), 2, bad)


if __name__ == "__main__":
    sys.exit(unittest.main())
