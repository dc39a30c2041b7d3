"""burnish plot: figures of lobes."""

import re
import xml.dom.minidom

from harness import case, check


def discs(bench, *words):
    """{family: [(x, y)]} of the dots of `plot axis`."""
    bench.run("plot", "axis", *words, "-o", "a.svg").expect(0)
    text = (bench.folder / "a.svg").read_text()
    xml.dom.minidom.parseString(text)
    found = {}
    for family, circle in re.findall(r'<g class="best (c\d)"[^>]*>\s*<circle ([^>]*)', text):
        found.setdefault(family, []).append(tuple(float(re.search(rf'\b{name}="([-\d.]+)"', circle)[1]) for name in ("cx", "cy")))
    return found


# A panel is 300 px wide and shows slopes to 1.5 times k deviations; the middle of the first one lies at (174, 190).
@case("plot.seen_along_the_normal_everything_is_symmetric", tier="quick")
def symmetric(bench):
    found = discs(bench, "--eye", "0,0", "--samples", "5")
    far = sorted(p for p in found["c4"] if p[0] < 324 and p[1] < 340)
    check([(round(x, 1), round(y, 1)) for x, y in far] == [(74, 190), (274, 190)], f"the farthest points are {far}")
    samples = sorted(x for x, y in found["c2"] if x < 324 and y < 340)
    check(len(samples) == 5 and abs(samples[2] - 174) < 0.1 and abs(samples[0] + samples[4] - 348) < 0.1, f"the samples are at {samples}")
    turned = discs(bench, "--eye", "0,0", "--samples", "5", "--anisotropy", "-0.8")
    check(turned == found, "an ellipse that is turned is drawn along its own axes")


@case("plot.at_grazing_views_the_axis_ends_at_the_horizon", tier="quick")
def clamped(bench):
    found = discs(bench, "--eye", "75,0", "--roughness", "0.7", "--samples", "9")
    far = sorted(x for x, y in found["c4"] if x < 324 and y < 340)
    samples = sorted(x for x, y in found["c2"] if x < 324 and y < 340)
    check(len(far) == 2 and min(samples) > far[0] + 20 and max(samples) < far[1] + 1, f"samples at {samples} between {far}")
    beyond = [x for x, y in found["c4"] if x > 672 and y < 340] # of the mirrored ones, the one below the horizon is not shown
    check(len(beyond) == 1, f"{beyond}")


@case("plot.files_are_the_same_every_time", tier="quick")
def same(bench):
    for name in ("a.svg", "b.svg", "a.png", "b.png"):
        bench.run("plot", "axis", "-o", name, "-q").expect(0)
    for kind in ("svg", "png"):
        check((bench.folder / f"a.{kind}").read_bytes() == (bench.folder / f"b.{kind}").read_bytes(), f"two runs make different {kind} files")


@case("plot.wrong_options_say_one_line", tier="quick")
def wrong(bench):
    for words, code, needle in (
            (("axes", "-o", "a.svg"), 2, "axis"), (("axis",), 2, "--output"), (("axis", "-o", "a.pdf"), 2, ".svg"),
            (("axis", "-o", "no/a.svg"), 7, "no/a.svg"), (("axis", "--eye", "95,0", "-o", "a.svg"), 2, "--eye"),
            (("axis", "--eye", "nan,0", "-o", "a.svg"), 2, "--eye"), (("axis", "--samples", "0", "-o", "a.svg"), 2, "--samples"),
            (("axis", "--roughness", "0", "-o", "a.svg"), 2, "--roughness")):
        bench.run("plot", *words).expect(code).expect_one_line(needle)
    check(bench.left_behind() == [], f"left {bench.left_behind()}")
