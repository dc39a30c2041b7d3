"""bench/speed_page.py writes known figures into the page, and the project's own page is the one that its figures give."""

import contextlib
import importlib.util
import io
import json
import pathlib
import tempfile
import unittest

BENCH = pathlib.Path(__file__).parents[2] / "bench"
spec = importlib.util.spec_from_file_location("speed_page", BENCH / "speed_page.py")
speed_page = importlib.util.module_from_spec(spec)
spec.loader.exec_module(speed_page)

PAGE = f"# Benchmarks\n\nbefore\n\n{speed_page.BEGIN}\n\nold\n\n{speed_page.END}\n\nafter\n"


def frame_row(what, isa, median, **more):
    return {"group": "g", "what": what, "isa": isa, "unit": "ms", "aim": 4.0, "bound": "at most", "met": median <= 4.0,
            "measured": {"median": median, "low": 1, "high": 9}, "note": "", **more}


def frames(*rows, processor="P"):
    return {"machine": {"processor": processor, "compiler": "C", "load_average": 0.1}, "threads": 2, "rounds": 7, "headline": True,
            "load_average_end": 0.2, "rows": list(rows)}


def race_row(scene, technique, msaa, ratio, flip=0.001):
    return {"shader": "lean", "scene": scene, "technique": technique, "msaa": msaa, "device": "lavapipe (LLVM)", "error": None, "ratio": ratio,
            "flip_mean": flip, "same_picture": flip < 0.01}


def race(*rows, processor="P", isa="avx2", notes=()):
    return {"machine": {"processor": processor, "isa": isa}, "width": 1920, "height": 1080, "notes": list(notes), "rows": list(rows)}


class SpeedPageTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "README.md").write_text(PAGE, encoding="utf-8")

    def run_with(self, *words):
        out = io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
            code = speed_page.main([*words, "--folder", str(self.folder)])
        return code, out.getvalue(), (self.folder / "README.md").read_text(encoding="utf-8")

    def file(self, name, data):
        path = self.folder / name
        path.write_text(data if isinstance(data, str) else json.dumps(data), encoding="utf-8")
        return str(path)

    def test_tables_hold_the_figures(self):
        one = self.file("frames.json", frames(frame_row("a million triangles", "avx2", 5.5), frame_row("a million triangles", "avx512", 3.25)))
        two = self.file("a.json", race(race_row("builtin:teapot", "bent_normal", 1, 2.0), race_row("builtin:teapot", "major_axis", 1, 8.0),
                                       notes=["/a/b/lamp.glb: two materials are left out"]))
        three = self.file("b.json", race(race_row("x/lamp.glb", "bent_normal", 1, 4.0), race_row("x/lamp.glb", "mc", 1, 99.0, flip=0.5)))
        code, _, page = self.run_with("--frames", one, "--races", two, three)
        self.assertEqual(code, 0)
        self.assertTrue(page.startswith("# Benchmarks\n\nbefore\n") and page.endswith("\nafter\n"))
        self.assertNotIn("old", page)
        self.assertIn("| a million triangles | <= 4 ms | 5.5 ms (missed) | 3.25 ms |", page)
        self.assertIn("| builtin:teapot | 4.0 (least 2.0) |", page)
        self.assertIn("| lamp.glb | 4.0 (least 4.0), 1 not counted |", page)
        self.assertIn("| **all, lavapipe** | 4.0 (least 2.0), 1 not counted |", page)
        self.assertIn("- lamp.glb: two materials are left out", page)
        self.assertEqual(self.run_with("--check")[0], 0)

    def test_a_page_edited_by_hand_fails(self):
        self.run_with("--frames", self.file("frames.json", frames(frame_row("a", "avx2", 3.0))))
        page = self.folder / "README.md"
        page.write_text(page.read_text(encoding="utf-8").replace("| a | <= 4 ms | 3 ms |", "| a | <= 4 ms | 2 ms |"), encoding="utf-8")
        self.assertEqual(self.run_with("--check")[0], 1)
        self.assertEqual(self.run_with()[0], 0)
        self.assertEqual(self.run_with("--check")[0], 0)

    def test_text_around_the_tables_is_free(self):
        self.run_with("--frames", self.file("frames.json", frames(frame_row("a", "avx2", 3.0))))
        page = self.folder / "README.md"
        page.write_text(page.read_text(encoding="utf-8") + "more\n", encoding="utf-8")
        self.assertEqual(self.run_with("--check")[0], 0)

    def test_bad_figures_change_nothing(self):
        good = self.file("frames.json", frames(frame_row("a", "avx2", 3.0)))
        other = self.file("race.json", race(race_row("s", "mc", 1, 2.0), processor="Q"))
        for words, said in ((("--frames", good, "--races", other), "several processors"), (("--frames", self.file("b.json", "{")), "b.json"),
                            (("--frames", self.file("c.json", "[]")), "not the figures"), (("--frames", "absent.json"), "absent.json"), ((), "speed.json")):
            code, text, page = self.run_with(*words)
            self.assertEqual((code, page), (2, PAGE), words)
            self.assertIn(said, text)
        self.assertFalse((self.folder / "speed.json").exists())

    def test_the_project_s_page_is_the_one_of_its_figures(self):
        with contextlib.redirect_stderr(io.StringIO()) as said:
            self.assertEqual(speed_page.main(["--check"]), 0, said)


if __name__ == "__main__":
    unittest.main()
