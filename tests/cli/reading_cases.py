"""Colours, shapes and numbers in files are applied, refused or reported, never ignored."""

import struct

from compare_cases import figures as compared
from environment_files import attribute, exr, hdr, rgbe
from harness import SMALL, case, check, scratch
from input_cases import accept, refuse

ACESCG = (0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767)
# From linear Rec.709 to ACEScg, with Bradford white adaptation, as the Academy's and other tools print it.
TO_ACESCG = ((0.613097, 0.339523, 0.047380), (0.070194, 0.916354, 0.013452), (0.020616, 0.109570, 0.869815))
WIDTH, HEIGHT = 32, 16


def sky(x, y):
    return (0.2 + x / WIDTH, 0.2 + y / HEIGHT, 0.3 + 0.5 * ((x // 8 + y // 8) % 2))


def steps(x, y):
    return sky(x // 8 * 8, y)


def to_acescg(x, y):
    return tuple(sum(a * b for a, b in zip(row, sky(x, y))) for row in TO_ACESCG)


def chroma(x, y):
    r, g, b = sky(x, y)
    luminance = 0.2126390 * r + 0.7151687 * g + 0.0721923 * b
    return luminance, (r - luminance) / luminance, (b - luminance) / luminance


def said(primaries):
    return attribute("chromaticities", "chromaticities", struct.pack("<8f", *primaries))


def plain_hdr(value, lines=""):
    return hdr(WIDTH, HEIGHT, lambda y: b"".join(rgbe(value(x, y)) for x in range(WIDTH)), lines)


def drawn(bench, env):
    """Returns the pixel hash and warnings of a sphere under this environment."""
    found = bench.figures("builtin:sphere", "--size", "64x48", "--msaa", "1", "--floor", "off", "--env", env, "--env-size", "16", "--env-samples", "4")
    return found["pixel_hash"], found["warnings"]


@case("reading.environments_have_the_light_that_their_files_say", "input", budget=4)
def environments(bench):
    scratch(bench, "right.exr", exr(WIDTH, HEIGHT, sky))
    scratch(bench, "acescg.exr", exr(WIDTH, HEIGHT, to_acescg, attributes=said(ACESCG)))
    scratch(bench, "chroma.exr", exr(WIDTH, HEIGHT, chroma, names=("Y", "RY", "BY")))
    for name in ("acescg.exr", "chroma.exr"):
        off = compared(bench, "right.exr", name)["max_abs"]
        check(off < 2e-5, f"{name} is {off} off")
        warnings = drawn(bench, name)[1]
        check(warnings == [], f"{warnings}")
    scratch(bench, "right.hdr", plain_hdr(sky))
    scratch(bench, "exposed.hdr", plain_hdr(lambda x, y: tuple(4 * v for v in sky(x, y)), "EXPOSURE=2\nEXPOSURE=2\n"))
    scratch(bench, "steps.hdr", plain_hdr(steps))
    scratch(bench, "runs.hdr", hdr(WIDTH, HEIGHT, lambda y: b"".join(rgbe(steps(x, y)) + bytes([1, 1, 1, 7]) for x in range(0, WIDTH, 8))))
    for name, right in (("exposed.hdr", "right.hdr"), ("runs.hdr", "steps.hdr")):
        check(drawn(bench, name) == drawn(bench, right), f"{name} is not {right}")
    check(drawn(bench, "right.hdr")[0] != drawn(bench, "steps.hdr")[0], "all environments look the same")
    check(drawn(bench, "right.exr") == (drawn(bench, scratch(bench, "rec709.exr", exr(WIDTH, HEIGHT, sky, attributes=said(
        (0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.329)))))[0], []), "the chromaticities of Rec.709 change something")


@case("reading.environments_of_other_shapes_are_said", "input", budget=6)
def shapes(bench):
    for width, height, words in ((16, 16, "16 x 16 pixels are not twice as wide as high"), (16, 12, "cross"), (12, 16, "cross"), (24, 4, "row"), (4, 24, "column")):
        name = scratch(bench, "shape.hdr", hdr(width, height, lambda y: b"".join(rgbe(sky(x, y)) for x in range(width))))
        warnings = drawn(bench, name)[1]
        check(len(warnings) == 1 and words in warnings[0], f"{width} x {height}: {warnings}")
    cube = attribute("envmap", "envmap", b"\1")
    face = {0: (3, 1, 1), 1: (1, 3, 3), 2: (1, 3, 1), 3: (3, 1, 3), 4: (1, 1, 3), 5: (3, 3, 1)}
    scratch(bench, "cube.exr", exr(4, 24, lambda x, y: face[y // 4], attributes=cube))
    scratch(bench, "grey.exr", exr(4, 24, lambda x, y: (1, 1, 1), attributes=cube))
    scratch(bench, "even.hdr", hdr(2, 1, lambda y: 2 * rgbe((1, 1, 1))))
    (cube_hash, warnings), grey = drawn(bench, "cube.exr"), drawn(bench, "grey.exr")
    check(warnings == [], f"{warnings}")
    check(grey == drawn(bench, "even.hdr"), "a grey cube is no grey sky")
    check(cube_hash != grey[0], "the faces of a cube do not count")
    refuse(bench, "builtin:plate", env=scratch(bench, "bad.exr", exr(4, 20, sky, attributes=cube)), needles=("envmap", "4 x 20"))
    for words, warning in ((attribute("oiio:ColorSpace", "string", b"ACEScg"), "ACEScg"), (said((0,) * 8), "primaries"),
                           (attribute("adoptedNeutral", "v2f", struct.pack("<2f", 0.35, 0.36)), "adoptedNeutral")):
        warnings = drawn(bench, scratch(bench, "odd.exr", exr(WIDTH, HEIGHT, sky, attributes=words)))[1]
        check(len(warnings) == 1 and warning in warnings[0], f"{warnings}")
    xyz = scratch(bench, "xyz.exr", exr(WIDTH, HEIGHT, sky, names=("X", "Y", "Z")))
    refuse(bench, "builtin:plate", env=xyz, needles=("X, Y and Z hold CIE colours",))
    warnings = drawn(bench, scratch(bench, "layer.exr", exr(WIDTH, HEIGHT, sky, names=("a.R", "a.G", "a.B"))))[1]
    check(len(warnings) == 1 and "no channels R, G, B or Y" in warnings[0], f"{warnings}")
    for lines, place in (("EXPOSURE=0\n", "EXPOSURE"), ("COLORCORR=1 2\n", "COLORCORR"), ("FORMAT=32-bit_rle_xyze\n", "XYZE")):
        refuse(bench, "builtin:plate", env=scratch(bench, "bad.hdr", plain_hdr(sky, lines)), needles=(place,))


@case("reading.pictures_to_compare_are_converted_too")
def compared_pictures(bench):
    scratch(bench, "right.exr", exr(WIDTH, HEIGHT, sky))
    scratch(bench, "acescg.exr", exr(WIDTH, HEIGHT, to_acescg, attributes=said(ACESCG)))
    scratch(bench, "unnamed.exr", exr(WIDTH, HEIGHT, to_acescg))
    check(compared(bench, "right.exr", "unnamed.exr")["max_abs"] > 0.01, "other colours are no difference")
    check(compared(bench, "right.exr", "acescg.exr")["max_abs"] < 2e-5, "named colours are a difference")
    scratch(bench, "variance.exr", exr(WIDTH, HEIGHT, lambda x, y: (1, 1, 1)))
    bench.run("compare", "right.exr", "acescg.exr", "--variance", "variance.exr").expect(2).expect_one_line("--variance", "acescg.exr")
    scratch(bench, "named.exr", exr(WIDTH, HEIGHT, sky, attributes=attribute("oiio:ColorSpace", "string", b"sRGB")))
    done = bench.run("compare", "right.exr", "named.exr").expect(0)
    check(done.err.count("warning") == 1 and "named.exr: " in done.err and "'sRGB'" in done.err, done.describe())


HEAD = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
FACE = "f 1/1/1 2/2/1 3/3/1 4/4/1\n"


@case("reading.obj_texts_are_read_as_the_format_says", "input")
def obj_texts(bench):
    def hash_of(text):
        found = bench.figures(scratch(bench, "a.obj", text), *SMALL)
        check(found["warnings"] == [], f"{found['warnings']}")
        return found["pixel_hash"]

    quad = hash_of(HEAD + FACE)
    for text in (b"\xef\xbb\xbf" + (HEAD + FACE).encode(), HEAD + "f 1/1/1 2/2/1 \\\n 3/3/1 4/4/1\n", HEAD + FACE[:-1] + " # the whole quad\n",
                 HEAD + FACE[:-1] + " # 20261125143000\n", (HEAD + FACE).replace("\n", "\r"), (HEAD + FACE).replace(" 1", " +1.0", 1)):
        check(hash_of(text) == quad, f"other pixels: {text}")
    red = hash_of("".join(line + (" 1 0 0\n" if line.startswith("v ") else "\n") for line in HEAD.splitlines()) + FACE)
    check(red not in (quad, hash_of(HEAD.replace("v 1 1 0", "v 0.75 0.75 0") + FACE)), "colours of vertices do not count")
    for word in ("0,75", "nan", "inf", "x1", "0x1", "1.0x", "1d3", "1e999"):
        refuse(bench, scratch(bench, "bad.obj", HEAD.replace("v 1 1 0", f"v {word} 1 0") + FACE), needles=("bad.obj: line 3: position 3", f"'{word}'"))
    for text, needle in (("V 1 2 3\n", "line 11"), ("f 0 1 2\n", "line 11: face 2"), ("v 1 2\n", "line 11: position 5")):
        refuse(bench, scratch(bench, "bad.obj", HEAD + FACE + text), needles=(needle,))
    for text, words in (("l 1 2\n", "lines are not drawn"), ("surf 0 1 0 1 1 2 3 4\n", "surfaces are not drawn"), ("foo\n", "'foo' is not read"),
                        ("usemtl a\nf 1 2 3\n", "MTL")):
        done = accept(bench, scratch(bench, "said.obj", HEAD + FACE + text))
        check(done.err.count("warning") == 1 and words in done.err, done.describe())


@case("reading.files_of_reports_are_read_right", tier="nightly")
def reports(bench):
    """Optional files that were once read wrongly."""
    folder = bench.data_file("reports/env_acescg.exr").parent

    def hash_of(name):
        return bench.figures("builtin:plate", *SMALL, "--env", folder / name)["pixel_hash"]

    for name, right in (("env_acescg.exr", "env_right.exr"), ("env_chroma.exr", "env_chroma_right.exr")):
        off = compared(bench, folder / right, folder / name)["max_abs"]
        check(off < 1e-3, f"{name} is {off} off")
    for name, right in (("env_exposure.hdr", "env_right.hdr"), ("env_old_runs.hdr", "env_steps_right.hdr")):
        check(hash_of(name) == hash_of(right), f"{name} is not {right}")
    done = accept(bench, "builtin:plate", "--env", folder / "env_square.exr")
    check(done.err.count("twice as wide as high") == 1, done.describe())
    quad = bench.figures(folder / "quad.obj", *SMALL)["pixel_hash"]
    for name in ("byte_order_mark", "line_continued", "comment_after_face", "comment_of_digits"):
        check(bench.figures(folder / (name + ".obj"), *SMALL)["pixel_hash"] == quad, f"{name} is no quad")
    check(bench.figures(folder / "vertex_colours.obj", *SMALL)["pixel_hash"] != quad, "colours of vertices do not count")
    for name in ("decimal_comma", "no_number_nan", "no_number_word"):
        refuse(bench, folder / (name + ".obj"), needles=("line 3: position 3",))
