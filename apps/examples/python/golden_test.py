#!/usr/bin/env python3
"""A test that holds a picture by its hash. Equal calls give equal bits on every machine, so one hash is enough.

Usage: golden_test.py [-v]    or python3 -m unittest golden_test

After a change that is meant, run it with BLESS=1, look at golden_test.png, and commit golden_test.json.
"""

import json
import os
import pathlib
import unittest

import burnish

HASHES = pathlib.Path(__file__).with_suffix(".json")


class Golden(unittest.TestCase):
    def hold(self, name, picture):
        """Fails where the picture's hash is not the one that is kept. Leaves the picture then."""
        kept = json.loads(HASHES.read_text()) if HASHES.exists() else {}
        if os.environ.get("BLESS") == "1":
            HASHES.write_text(json.dumps({**kept, name: picture.hash}, indent=4, sort_keys=True) + "\n")
        if os.environ.get("BLESS") == "1" or kept.get(name) != picture.hash:
            picture.save(f"{name}.png")
        if os.environ.get("BLESS") != "1":
            self.assertEqual(picture.hash, kept.get(name), f"look at {name}.png; BLESS=1 keeps its hash")

    def test_brushed_teapot(self):
        scene = burnish.load("builtin:teapot", env_size=32, env_samples=16)
        self.hold("golden_test", scene.render(width=96, height=72, technique="lobe_line"))


if __name__ == "__main__":
    unittest.main()
