"""bench/compare.py reports the known differences of known figures."""

import contextlib
import importlib.util
import io
import json
import pathlib
import sys
import tempfile
import unittest

path = pathlib.Path(__file__).parents[2] / "bench" / "compare.py"
spec = importlib.util.spec_from_file_location("compare", path)
compare = importlib.util.module_from_spec(spec)
spec.loader.exec_module(compare)

STEADY = [10.0, 10.1, 9.9, 10.05, 9.95, 10.02, 9.98, 10.01, 9.99, 10.0, 10.0]


def frame_figures(times, **machine):
    rows = [{"name": name, "isa": "avx2", "cpu_ms_rounds": values} for name, values in times.items()]
    return {"machine": {"processor": "P", "compiler": "C", "build_type": "Release", "load_average": 0.1, **machine}, "threads": 2, "workloads": rows}


def micro_figures(times):
    rows = [{"name": name, "run_type": "iteration", "cpu_time": value} for name, values in times.items() for value in values]
    rows += [{"name": f"{name}_mean", "run_type": "aggregate", "cpu_time": 1e9} for name in times]
    return {"context": {"num_cpus": 2, "mhz_per_cpu": 3000, "load_avg": [0.1]}, "benchmarks": rows}


class CompareTest(unittest.TestCase):
    def run_on(self, old, new, *options):
        with tempfile.TemporaryDirectory() as folder:
            files = []
            for name, figures in (("old", old), ("new", new)):
                file = pathlib.Path(folder, name)
                file.write_text(figures if isinstance(figures, str) else json.dumps(figures))
                files.append(str(file))
            out = io.StringIO()
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
                code = compare.main([*files, *options])
        return code, out.getvalue()

    def scaled(self, factor):
        return [value * factor for value in STEADY]

    def verdict(self, factor):
        code, text = self.run_on(frame_figures({"a": STEADY}), frame_figures({"a": self.scaled(factor)}))
        line = next(line for line in text.splitlines() if line.startswith("a avx2"))
        return code, line

    def test_equal_runs(self):
        code, line = self.verdict(1.0)
        self.assertEqual(code, 0)
        self.assertIn("1.000", line)
        self.assertNotRegex(line, "slower|faster|unsure")

    def test_above_three_percent(self):
        self.assertEqual(self.verdict(1.029)[0], 0)
        code, line = self.verdict(1.031)
        self.assertEqual(code, 1)
        self.assertIn("1.031", line)
        self.assertTrue(line.endswith("slower"))

    def test_faster_is_said_and_passes(self):
        code, line = self.verdict(0.9)
        self.assertEqual(code, 0)
        self.assertTrue(line.endswith("faster"))

    def test_noise_is_not_a_change(self):
        noisy = [10.0, 14.0, 8.0, 12.0, 9.0, 13.0, 10.5, 11.0, 8.5, 12.5, 9.5]
        code, text = self.run_on(frame_figures({"a": noisy}), frame_figures({"a": [value * 1.05 for value in noisy]}))
        self.assertEqual(code, 0)
        self.assertIn("unsure", text)

    def test_other_pixels_are_said(self):
        figures = [frame_figures({"a": STEADY}) for _ in range(2)]
        for pixels, said in (("0123456789abcdef", False), ("0123456789abcdee", True)):
            figures[0]["workloads"][0]["pixels"], figures[1]["workloads"][0]["pixels"] = "0123456789abcdef", pixels
            code, text = self.run_on(*figures)
            self.assertEqual((code, "other pixels" in text), (0, said))

    def test_threshold(self):
        old, new = frame_figures({"a": STEADY}), frame_figures({"a": self.scaled(1.2)})
        self.assertEqual(self.run_on(old, new, "--threshold", "25")[0], 0)
        self.assertEqual(self.run_on(old, new, "--threshold", "10")[0], 1)

    def test_gone_fails_and_new_passes(self):
        one, two = frame_figures({"a": STEADY}), frame_figures({"a": STEADY, "b": STEADY})
        self.assertEqual(self.run_on(two, one)[0], 1)
        code, text = self.run_on(one, two)
        self.assertEqual(code, 0)
        self.assertIn("not measured before", text)

    def test_google_benchmark(self):
        code, text = self.run_on(micro_figures({"f/8": [5.0, 5.0]}), micro_figures({"f/8": [6.0, 6.0]}))
        self.assertEqual(code, 1)
        self.assertIn("1.200", text)
        self.assertNotIn("f/8_mean", text)

    def test_counter_of_a_unit_comes_first(self):
        old, new = micro_figures({"f": [5.0]}), micro_figures({"f": [5.0]})
        old["benchmarks"][0]["ns_triangle"], new["benchmarks"][0]["ns_triangle"] = 10.0, 12.0
        self.assertIn("1.200", self.run_on(old, new)[1])

    def test_another_machine_and_load_are_said(self):
        _, text = self.run_on(frame_figures({"a": STEADY}), frame_figures({"a": STEADY}, processor="Q", load_average=3.0))
        self.assertIn("processor differs", text)
        self.assertIn("load average of 3.00", text)

    def test_what_cannot_be_compared(self):
        good = frame_figures({"a": STEADY})
        for bad in ("{", "{}", "[]", frame_figures({}), frame_figures({"a": []}), frame_figures({"a": [0.0]}), frame_figures({"a": ["x"]}),
                    frame_figures({"b": STEADY})):
            code, text = self.run_on(good, bad)
            self.assertEqual(code, 2, bad)
            self.assertIn("compare: ", text)

    def test_interval_of_a_median(self):
        # 11 values: the 2nd and the 10th enclose the median with 98.8 %, the 3rd and the 9th with 93.5 %
        self.assertEqual(compare.median_interval(list(range(1, 12))), (2, 10))
        self.assertEqual(compare.median_interval([7.0]), (7.0, 7.0))
        self.assertEqual(compare.median_interval([1.0, 2.0, 3.0]), (1.0, 3.0))


if __name__ == "__main__":
    sys.exit(unittest.main())
