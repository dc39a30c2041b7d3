"""bench/instructions/flame.py counts instructions for their callers, and draws functions with proportional widths."""

import os
import pathlib
import sys
import tempfile
import unittest
import xml.etree.ElementTree as tree

sys.path.append(str(pathlib.Path(__file__).parents[2] / "bench" / "instructions"))
import flame  # noqa: E402

SVG = "{http://www.w3.org/2000/svg}"
# Output of addr2line for four addresses, innermost function first: lanes and intrinsics in a kernel, the kernel, a slot alone.
LINES = """0x0000000000000010
_mm256_mul_ps
/usr/lib/gcc/include/avxintrin.h:318
burnish::avx2::operator*(burnish::avx2::real, burnish::avx2::real)
/home/a/burnish/core/simd/lanes_avx2.h:20
burnish::avx2::k_dot3(burnish::avx2::real3, burnish::avx2::real3)
/home/a/burnish/shading/kernels/math.k.h:40
burnish::avx2::shade_slot(burnish::avx2::Tile const&)
/home/a/burnish/raster/tile/tile.isa.cpp:200
0x0000000000000020
burnish::avx2::k_dot3(burnish::avx2::real3, burnish::avx2::real3)
/home/a/burnish/shading/kernels/math.k.h:41
burnish::avx2::shade_slot(burnish::avx2::Tile const&)
/home/a/burnish/raster/tile/tile.isa.cpp:200
0x0000000000000030
burnish::avx2::shade_slot(burnish::avx2::Tile const&)
/home/a/burnish/raster/tile/tile.isa.cpp:201
0x0000000000000040
memcpy
??:?
"""
COUNTS = {0x10: 600, 0x20: 100, 0x30: 200, 0x40: 100}


class Flame(unittest.TestCase):
    def tree(self):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "addr2line"
            program.write_text(f"#!/bin/sh\ncat > /dev/null\ncat << 'END'\n{LINES}END\n")
            program.chmod(0o755)
            before = os.environ["PATH"]
            os.environ["PATH"] = f"{folder}:{before}"
            try:
                return flame.tree_of(COUNTS, flame.stacks_of("any", list(COUNTS)))
            finally:
                os.environ["PATH"] = before

    def test_lanes_count_for_who_asks(self):
        root = self.tree()
        self.assertEqual((root.count, root.own), (1000, 0))
        slot = root.parts["avx2::shade_slot"]
        self.assertEqual((slot.count, slot.own, slot.folder), (900, 200, "raster/tile"))
        dot = slot.parts["avx2::k_dot3"]
        self.assertEqual((dot.count, dot.own, dot.folder, dot.parts), (700, 700, "shading/kernels", {}))
        self.assertEqual((root.parts["memcpy"].own, root.parts["memcpy"].folder), (100, ""))

    def test_widths_are_counts(self):
        drawn = tree.fromstring(flame.picture_of([("now", self.tree())], 10.0))
        widths = {g.find(SVG + "title").text.split(" ")[0]: float(g.find(SVG + "rect").get("width")) for g in drawn.iter(SVG + "g")}
        self.assertEqual(widths, {"frame": 1400.0, "avx2::shade_slot": 1260.0, "avx2::k_dot3": 980.0, "memcpy": 140.0})
        self.assertIn("avx2::k_dot3 70: 70.0 %, 70.0 % by itself; shading/kernels", [g.find(SVG + "title").text for g in drawn.iter(SVG + "g")])

    def test_two_programs_have_one_scale(self):
        half = flame.tree_of({0x40: 500}, {0x40: (("memcpy", ""),)})
        drawn = tree.fromstring(flame.picture_of([("before", self.tree()), ("now", half)], 1.0))
        frames = [g for g in drawn.iter(SVG + "g") if g.find(SVG + "title").text.startswith("frame ")]
        self.assertEqual([float(g.find(SVG + "rect").get("width")) for g in frames], [1400.0, 700.0])


if __name__ == "__main__":
    unittest.main()
