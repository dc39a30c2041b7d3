#!/usr/bin/env python3
"""Draws a scene by two techniques, prints how far they differ, and writes both pictures with a map of the differences as one HTML page.

Usage: compare_techniques.py lamp.glb split_isotropic lobe_line [-o compared.html] [--environment workshop.hdr] [--size 480x360]

The first technique is the reference. HDR-FLIP is 0 for equal pictures and at most 1.
"""

import argparse
import pathlib

import burnish


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("reference", choices=burnish.techniques(), metavar="REFERENCE")
    parser.add_argument("test", choices=burnish.techniques(), metavar="TEST")
    parser.add_argument("-o", "--output", type=pathlib.Path)
    parser.add_argument("--environment")
    parser.add_argument("--size", default="480x360")
    options = parser.parse_args()
    width, height = map(int, options.size.split("x"))
    scene = burnish.load(options.scene, environment=options.environment)
    reference, test = (scene.render(width=width, height=height, technique=name) for name in (options.reference, options.test))
    compared = burnish.compare(reference, test)
    print(f"{options.test} against {options.reference}")
    print(f"mean FLIP           {compared.flip_mean:.4f}")
    print(f"99th percentile     {compared.flip_p99:.4f}")
    print(f"largest FLIP        {compared.flip_max:.4f}")
    print(f"pixels that differ  {100 * compared.differing_fraction:.1f} %")
    if options.output:
        options.output.write_text(f"<!doctype html><meta charset='utf-8'>{compared._repr_html_()}", encoding="utf-8")


if __name__ == "__main__":
    main()
