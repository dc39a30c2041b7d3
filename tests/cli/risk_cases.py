"""burnish render --risks: places where a technique exceeds the limits that the atlas found."""

import json
import re

from environment_files import even, exr
from harness import ROOT, case, check, scratch

VIEW = ("render", "builtin:sphere", "--size", "96x64", "--env-size", "64", "--env-samples", "64")
BRUSHED = ("--technique", "bent_normal", "--roughness", "0.4", "--anisotropy", "0.7")


def shares(out):
    """Returns {entry: percent}, and the percentage of any entry under ""."""
    found = {entry: float(share) for share, entry in re.findall(r"^[a-z]+ #[0-9a-f]{6}, ([\d.]+) % of shaded pixels: .*; (\w+)\)$", out, re.M)}
    found[""] = float(re.search(r"^([\d.]+) % of shaded pixels are past", out, re.M)[1])
    return found


@case("risks.are_told_and_change_no_picture")
def told(bench):
    done = bench.run(*VIEW, *BRUSHED, "--risks", "r.png", "-o", "a.png", "-o", "a.exr", "--stats", "a.json").expect(0)
    found = shares(done.out)
    check(found["bent_normal_bends_too_far"] > 30 and found[""] >= found["bent_normal_bends_too_far"], done.out)
    check("bent_normal past its limit, anisotropy 0." in done.out and "upside down" in done.out, done.out)
    bench.run(*VIEW, *BRUSHED, "-o", "b.png", "-o", "b.exr", "--stats", "b.json").expect(0)
    a, b = (json.loads((bench.folder / f"{name}.json").read_text()) for name in "ab")
    check(a["pixel_hash"] == b["pixel_hash"], "the picture changed")
    for kind in ("png", "exr"):
        check((bench.folder / f"a.{kind}").read_bytes() == (bench.folder / f"b.{kind}").read_bytes(), f"the .{kind} changed")
    # text alone; machine-readable figures keep standard output
    check(shares(bench.run(*VIEW, *BRUSHED, "--risks", "-").expect(0).out) == found, "words without a picture are others")
    done = bench.run(*VIEW, *BRUSHED, "--risks", "-", "--stats", "-").expect(0)
    check(json.loads(done.out)["pixel_hash"] == a["pixel_hash"] and shares(done.err) == found, done.describe())
    # "-" prints with -q as well, and nothing else is printed
    quiet = bench.run(*VIEW, *BRUSHED, "--risks", "-", "-q").expect(0)
    check(shares(quiet.out) == found and quiet.err == "", quiet.describe())


@case("risks.say_the_eye_as_an_angle")
def angle(bench):
    """A trial's eye position has no meaning in another scene."""
    done = bench.run("render", "builtin:plate", "--size", "48x32", "--env-size", "64", "--env-samples", "64", "--technique", "bent_normal",
                     "--risks", "-").expect(0)
    check(re.search(r"bent_normal past its limit, seen from lower than \d\d degrees above the surface \(", done.out), done.out)
    check(not re.search(r"limit, [^(]*\d,", done.out), done.out)
    done = bench.run("render", "builtin:bumps", "--size", "48x32", "--env-size", "64", "--env-samples", "64", "--technique", "lobe_line",
                     "--tilt", "0,60", "--roughness", "0.4", "--risks", "-").expect(0)
    check(re.search(r"limit, a tilt of \d\d degrees \(", done.out) and not re.search(r"limit, [^(]*\d,", done.out), done.out)


@case("risks.follow_inputs_and_surroundings")
def follow(bench):
    name = "bent_normal_bends_too_far"
    words = lambda *more: shares(bench.run(*VIEW, *more, "--risks", "-").expect(0).out)
    check(name not in words(*BRUSHED, "--anisotropy", "0.02"), "a bend that is none is marked")
    check(words(*BRUSHED, "--anisotropy", "0.3").get(name, 0) < words(*BRUSHED)[name], "more of a bend marks less")
    check(words(*BRUSHED, "--technique", "mc", "--samples", "4096")[""] < 1, "what has samples enough is marked")
    check(words(*BRUSHED, "--technique", "mc", "--samples", "1").get("mc_fireflies", 0) > 30, "one sample is not noise")
    check("separable_masking" in words("--technique", "lobe_line", "--roughness", "1", "--masking", "separable"), "masking is not seen")
    # under a uniform sky a technique's directions do not show
    (bench.folder / "even.exr").write_bytes(exr(16, 8, even(1.0)))
    check(words(*BRUSHED, "--env", "even.exr")[""] == 0, "one colour all around, and a place of it is wrong")
    # an environment turned by half with the eye: nearly equal parts are marked
    still = words(*BRUSHED, "--eye", "0.3,0.2,0.5", "--target", "0,0.05,0")[name]
    turned = words(*BRUSHED, "--eye", "-0.3,0.2,-0.5", "--target", "0,0.05,0", "--env-rotation", "180")[name]
    check(abs(still - turned) < 3, f"{still} % and {turned} %")


@case("risks.are_the_same_for_every_number_of_threads")
def threads(bench):
    for n in ("1", "3"):
        bench.run(*VIEW, "--env", "builtin:sky", "--technique", "split_isotropic", "--anisotropy", "0.6", "-t", n, "--risks", f"{n}.png").expect(0)
    check((bench.folder / "1.png").read_bytes() == (bench.folder / "3.png").read_bytes(), "threads change marks")


@case("risks.that_cannot_be_are_refused")
def refused(bench):
    scratch(bench, "file", "")
    for code, needle, *words in ((2, "the reference has none", "--risks", "a.png", "--backend", "reference"), (2, "8 bits", "--risks", "a.exr"),
                                 (2, "--risks", "--risks", "-", "--animate", "roughness=0.1:0.2", "-o", "a%d.png"),
                                 (2, "a.png", "--risks", "a.png", "-o", "a.png"), (7, "nowhere", "--risks", "nowhere/a.png"),
                                 (2, "file", "--risks", "file")):
        bench.run(*VIEW, *words).expect(code).expect_one_line(needle)
    check(bench.left_behind() == ["file"], f"{bench.left_behind()}")


@case("risks.every_technique_has_rules_and_a_row_in_the_manual", tier="quick")
def every_technique(bench):
    techniques = re.findall(r"^BN_TECHNIQUE\((\w+)", (ROOT / "shading/models.def").read_text(), re.M)
    check(len(techniques) > 5, f"only {techniques} were seen")
    readers = [rule.split() for rule in re.findall(r'^BN_RISK\(\w+, \w+, \w+, "([^"]*)"', (ROOT / "apps/risks/risks.def").read_text(), re.M)]
    beginnings = {word for rule in readers for word in rule}
    without = [name for name in techniques if not name.startswith(tuple(beginnings))]
    check(not without, f"no rule of apps/risks/risks.def applies to {without}")
    unread = [word for word in beginnings if not any(name.startswith(word) for name in techniques)]
    check(not unread, f"apps/risks/risks.def: no technique begins with {unread}")
    page = (ROOT / "apps/manual/techniques.md").read_text()
    without = [name for name in techniques if f"\n| `{name}` | ![](pictures/t_{name}.png) |" not in page]
    check(not without, f"apps/manual/techniques.md has no row with a picture of {without}")
    samples = page.partition("\n## How many samples\n")[2].partition("\n## ")[0]
    check(all(f"`{name}`" in samples for name in techniques), "apps/manual/techniques.md does not name every technique's samples")
