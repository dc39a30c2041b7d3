"""burnish compare: figures, outputs, limits, and an exit code for each kind of failure."""

import base64
import csv
import html.parser
import json
import os
import re
import struct
import zlib

from browser import Browser
from harness import Failed, Skipped, case, check, scratch

NAN, INF = float("nan"), float("inf")


def png(width, height, pixel, channels=3, bits=8):
    """Returns a PNG. pixel(x, y) gives the channels."""
    form = ">%dB" if bits == 8 else ">%dH"
    rows = b"".join(b"\0" + struct.pack(form % (width * channels), *(v for x in range(width) for v in pixel(x, y)))
                    for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    kinds = {1: 0, 2: 4, 3: 2, 4: 6}
    header = struct.pack(">IIBBBBB", width, height, bits, kinds[channels], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def pfm(width, height, pixel):
    """Returns a PFM of RGB floats, which begins with the bottom row."""
    values = [v for y in reversed(range(height)) for x in range(width) for v in pixel(x, y)]
    return b"PF\n%d %d\n-1.0\n" % (width, height) + struct.pack("<%df" % len(values), *values)


def ramp(x, y):
    return (8 * x % 256, 8 * y % 256, 128)


def bright(x, y):
    return (0.1 * x, 0.2 * y, 1.0)


def pictures(bench):
    """Writes pairs of small images: 8 bits, and floats."""
    scratch(bench, "a.png", png(24, 16, ramp))
    scratch(bench, "b.png", png(24, 16, lambda x, y: (8 * x % 256, 8 * y % 256, 128 if x or y else 153)))
    scratch(bench, "a.pfm", pfm(24, 16, bright))
    scratch(bench, "b.pfm", pfm(24, 16, lambda x, y: (0.1 * x, 0.2 * y, 1.5 if x < 6 else 1.0)))


def figures(bench, *words, code=0):
    done = bench.run("compare", *words, "--json", "-").expect(code)
    try:
        return json.loads(done.out)
    except ValueError as error:
        raise Failed(f"--json - is not JSON: {error}\n{done.describe()}") from error


ALL = ("width", "height", "flip_mean", "flip_p99", "flip_weighted_median", "flip_max", "mse", "rel_mse", "psnr", "ssim", "max_abs",
       "differing_fraction", "nan_pixels")


@case("compare.equal_pictures_pass", "input")
def equal(bench):
    pictures(bench)
    for name in ("a.png", "a.pfm"):
        limits = ("--fail-flip", "0", "--fail-max", "0", "--fail-fraction", "0")
        found = figures(bench, name, name, *limits)
        for key in ALL:
            check(key in found, f"{key} is missing: {found}")
        zero = ("flip_mean", "flip_p99", "flip_weighted_median", "flip_max", "mse", "rel_mse", "max_abs", "differing_fraction", "nan_pixels")
        check(all(found[key] == 0 for key in zero), f"equal pictures differ: {found}")
        check((found["width"], found["height"], found["ssim"], found["psnr"]) == (24, 16, 1.0, None), f"{found}")


@case("compare.known_pictures_have_their_known_errors", tier="nightly")
def known(bench):
    """Means printed by the FLIP authors' program; see SOURCES.md beside the images."""
    folder = bench.data_file("flip")
    for one, other, mean in (("ldr_ref.png", "ldr_blur.png", 0.098760), ("ldr_ref.png", "ldr_tint.png", 0.263008),
                             ("hdr_ref.exr", "hdr_blur.exr", 0.125888)):
        found = figures(bench, folder / one, folder / other)
        check(abs(found["flip_mean"] - mean) < 1e-4, f"{other}: {found['flip_mean']} instead of {mean}")
    check(found["flip_kind"] == "flip-hdr" and found["exposures"] == 8, f"{found}")
    check(abs(found["start_exposure"] + 3.5562) < 1e-3, f"{found}")


@case("compare.writes_only_what_was_asked_for", tier="nightly")
def asked(bench):
    pictures(bench)
    found = figures(bench, "a.png", "b.png", "--metric", "mse,max")
    named = {"reference", "test", "verdict", "reason", "limits", "width", "height", "nan_pixels"}
    check(set(found) - named == {"differing_fraction", "max_abs", "mse"}, f"{found}")
    check(abs(found["max_abs"] - 25 / 255) < 1e-6, f"{found}")
    check(abs(found["mse"] - (25 / 255) ** 2 / (24 * 16 * 3)) < 1e-9, f"{found}")
    check(found["differing_fraction"] == 1 / (24 * 16), f"{found}")
    found = figures(bench, "a.pfm", "b.pfm", "--metric", "flip")
    check(found["flip_kind"] == "flip" and "mse" not in found and "exposures" not in found, f"{found}")
    found = figures(bench, "a.pfm", "b.pfm", "--metric", "rel-mse,psnr,ssim")
    check(set(found) - named == {"psnr", "rel_mse", "ssim"}, f"{found}")


@case("compare.kind_follows_the_pictures", tier="nightly")
def kind(bench):
    pictures(bench)
    check(figures(bench, "a.png", "b.png")["flip_kind"] == "flip", "8 bits are for LDR-FLIP")
    check(figures(bench, "a.pfm", "b.pfm")["flip_kind"] == "flip-hdr", "floats are for HDR-FLIP")
    scratch(bench, "wide.png", png(24, 16, lambda x, y: tuple(257 * v for v in ramp(x, y)), bits=16))
    check(figures(bench, "a.png", "wide.png")["differing_fraction"] == 0, "16 bits of the same values are the same")


@case("compare.flip_options_count", tier="nightly")
def flip_options(bench):
    pictures(bench)
    near = figures(bench, "a.png", "b.png", "--ppd", "20")["flip_max"]
    far = figures(bench, "a.png", "b.png", "--ppd", "200")["flip_max"]
    check(near > far > 0, f"one pixel is seen better from near: {near}, {far}")
    given = figures(bench, "a.pfm", "b.pfm", "--start-exposure", "-1", "--stop-exposure", "2.5", "--exposures", "3")
    check((given["start_exposure"], given["stop_exposure"], given["exposures"]) == (-1, 2.5, 3), f"{given}")
    means = {tone: figures(bench, "a.pfm", "b.pfm", "--tonemapper", tone)["flip_mean"] for tone in ("aces", "reinhard", "hable")}
    check(len(set(means.values())) == 3, f"{means}")
    check(means["aces"] == figures(bench, "a.pfm", "b.pfm")["flip_mean"], "aces is the default")


@case("compare.limits_decide_the_exit_code", tier="nightly")
def limits(bench):
    pictures(bench)
    found = figures(bench, "a.png", "b.png")
    for option, key in (("--fail-flip", "flip_mean"), ("--fail-max", "max_abs"), ("--fail-fraction", "differing_fraction")):
        bench.run("compare", "-q", "a.png", "b.png", option, repr(found[key])).expect(0)
        done = bench.run("compare", "-q", "a.png", "b.png", option, repr(found[key] * 0.99)).expect(1)
        done.expect_one_line("b.png", option)
        # A limit computes its figure.
        bench.run("compare", "-q", "a.png", "b.png", "--metric", "ssim", option, "0").expect(1)
    bench.run("compare", "-q", "a.png", "b.png").expect(0)  # no limit to fail
    check(figures(bench, "a.png", "b.png", "--fail-flip", "0", code=1)["flip_mean"] > 0, "a failing run writes its figures too")


@case("compare.patterns_are_measured_without_the_references_noise", budget=7)
def patterns(bench):
    """A comb of 2 % under references with noise of 5 %; the noise is a fixed hash of the pixel."""
    noisy = lambda seed: pfm(64, 48, lambda x, y: (1.0 + 0.05 * ((x * 7919 + y * 104729 + seed * 1299709) ** 3 % 1009 / 504 - 1),) * 3)
    scratch(bench, "r.pfm", noisy(1))
    scratch(bench, "r2.pfm", noisy(2))
    scratch(bench, "t.pfm", pfm(64, 48, lambda x, y: (1.02 if x % 2 else 0.98,) * 3))
    plain = figures(bench, "r.pfm", "t.pfm", "--metric", "pattern")
    cleaned = figures(bench, "r.pfm", "t.pfm", "--second-reference", "r2.pfm")
    check(plain["pattern_rms"] > 0.03 and "flip_mean" not in plain, str(plain))
    check(abs(cleaned["pattern_rms"] - 0.02) < 0.002 and "flip_mean" in cleaned, str(cleaned))
    check((cleaned["pattern_period"], cleaned["pattern_period_axis"]) == (2.0, "x"), str(cleaned))
    check(cleaned["pattern_pixels"] == 60 * 44 and abs(cleaned["quad_ratio_x"] - 1) < 0.2, str(cleaned))
    check("pattern_rms" not in figures(bench, "r.pfm", "t.pfm"), "pattern without being asked for")
    words = ("compare", "r.pfm", "t.pfm", "--second-reference", "r2.pfm", "-q", "--fail-pattern")
    bench.run(*words, "0.03").expect(0)
    bench.run(*words, "0.01").expect(1).expect_one_line("--fail-pattern")
    # a second reference of another size, or with NaN, is refused
    scratch(bench, "small.pfm", pfm(8, 8, bright))
    scratch(bench, "nan.pfm", pfm(64, 48, lambda x, y: (NAN if x == 3 else 1.0, 1.0, 1.0)))
    bench.run("compare", "r.pfm", "t.pfm", "--second-reference", "small.pfm").expect(3).expect_one_line("small.pfm")
    bench.run("compare", "r.pfm", "t.pfm", "--second-reference", "nan.pfm").expect(6).expect_one_line("nan.pfm")
    check(figures(bench, "r.pfm", "t.pfm", "--second-reference", "nan.pfm", code=6)["nan_pixels"] == 48, "NaN of a second reference")
    bench.run("compare", "r.pfm", "t.pfm", "--second-reference", "r.pfm").expect(2).expect_one_line("--second-reference")
    same = figures(bench, "t.pfm", "t.pfm", "--metric", "pattern")
    check((same["pattern_rms"], same["pattern_period"], same["pattern_period_axis"], same["quad_ratio_x"]) == (0, None, None, None), str(same))
    # nothing inside a surface: no figures, and a limit is not held
    scratch(bench, "black.pfm", pfm(8, 8, lambda x, y: (0.0, 0.0, 0.0)))
    none = figures(bench, "black.pfm", "black.pfm", "--metric", "pattern")
    bench.run("compare", "black.pfm", "black.pfm", "--fail-pattern", "1").expect(1).expect_one_line("no pixel lies inside")
    check(none["pattern_pixels"] == 0 and none["pattern_rms"] is None, str(none))


# Scene, options; greatest pattern, and greatest quad ratio along x and y. Aimed at: .038 and .030, 1.15.
PATTERNS = (
    ("builtin:teapot", (), 0.044, 1.15),
    ("builtin:sphere", ("--roughness", "0.5", "--anisotropy", "0.9"), 0.033, 1.5),
    ("builtin:spheres", (), 0.14, 1.15),
)


@case("compare.default_pictures_show_no_quads", tier="nightly")
def default_patterns(bench):
    """Averages over quads of 2x2 pixels would have .086 on the sphere with a quad ratio of 13, and .20 on the spheres."""
    for scene, options, most, step in PATTERNS:
        words = ("render", scene, *options, "--env", "builtin:studio", "--no-background", "--size", "480x270", "-q", "-o")
        bench.run(*words, "test.exr").expect(0)
        for seed in ("1", "2"):
            bench.run(*words, f"r{seed}.exr", "--backend", "reference", "--samples", "512", "--seed", seed).expect(0)
        found = figures(bench, "r1.exr", "test.exr", "--second-reference", "r2.exr", "--metric", "pattern")
        check(found["pattern_pixels"] > 10000 and found["pattern_rms"] < most, f"{scene}: {found}")
        check(max(found["quad_ratio_x"], found["quad_ratio_y"]) < step, f"{scene}: {found}")


@case("compare.sizes_and_channels_must_match", "input", tier="nightly")
def mismatch(bench):
    pictures(bench)
    scratch(bench, "narrow.png", png(23, 16, ramp))
    scratch(bench, "low.png", png(24, 15, ramp))
    scratch(bench, "gray.png", png(24, 16, lambda x, y: (x,), channels=1))
    for name in ("narrow.png", "low.png", "gray.png", "a.pfm"):
        for pair in (("a.png", name), (name, "a.png")):
            bench.run("compare", *pair, "--json", "j.json").expect(3).expect_one_line(*pair)
    found = json.loads((bench.folder / "j.json").read_text())
    check(found["verdict"] == "failed" and "flip_mean" not in found, f"figures of pictures that cannot be compared: {found}")


@case("compare.alpha_of_one_alone_must_be_1_everywhere", "input")
def lone_alpha(bench):
    pictures(bench)
    clear = lambda x, y: (*ramp(x, y), 255)
    holed = lambda x, y: (*ramp(x, y), 40 if (x, y) == (23, 15) else 255)
    scratch(bench, "wide.png", png(24, 16, lambda x, y: tuple(257 * v for v in clear(x, y)), channels=4, bits=16))
    scratch(bench, "gray.png", png(24, 16, lambda x, y: (x,), channels=1))
    scratch(bench, "gray_alpha.png", png(24, 16, lambda x, y: (x, 255), channels=2))
    scratch(bench, "gray_holed.png", png(24, 16, lambda x, y: (x, y), channels=2))
    scratch(bench, "clear.png", png(24, 16, clear, channels=4))
    for name, other in (("clear.png", "a.png"), ("wide.png", "a.png"), ("gray_alpha.png", "gray.png")):
        for pair in ((other, name), (name, other)):
            done = bench.run("compare", *pair, "--json", "-").expect(0)
            found = json.loads(done.out)
            check(found["max_abs"] == 0 and found["flip_mean"] == 0, f"{found}")
            check(done.err.startswith(f"note        {name} alone has alpha, 1 everywhere: colours are compared\n"), done.describe())
            check(bench.run("compare", *pair, "-q").expect(0).err == "", "--quiet notes alpha")
    # Another alpha is another picture, whatever the limits and with -q
    scratch(bench, "holed.png", png(24, 16, holed, channels=4))
    limits = ("--fail-max", "0", "--fail-flip", "0", "-q")
    for name, other, count in (("holed.png", "a.png", 1), ("gray_holed.png", "gray.png", 384)):
        for pair in ((other, name), (name, other)):
            bench.run("compare", *pair, *limits, "--json", "j.json").expect(3).expect_one_line(f"{name}: alpha is not 1 in {count} of 384 pixels, and {other} has no alpha")
            check(json.loads((bench.folder / "j.json").read_text())["verdict"] == "failed", "the verdict")
    scratch(bench, "narrow.png", png(23, 16, clear, channels=4))  # it differs in size as well
    bench.run("compare", "a.png", "narrow.png").expect(3).expect_one_line("23x16, 4 channels")
    bench.run("compare", "gray.png", "clear.png").expect(3).expect_one_line("24x16, 4 channels")
    for number in (1, 2):  # rows too
        scratch(bench, f"r{number}.png", png(24, 16, ramp))
        scratch(bench, f"t{number}.png", png(24, 16, clear, channels=4))
    done = bench.run("compare", "--sequence", "r%d.png", "t%d.png").expect(0)
    check(done.err.count("alone has alpha") == 1 and "FLIP mean   0.000000" in done.out, done.describe())
    scratch(bench, "t2.png", png(24, 16, holed, channels=4))
    bench.run("compare", "--sequence", "r%d.png", "t%d.png", "-q").expect(3).expect_one_line("t2.png: alpha is not 1", "r2.png")


@case("compare.unreadable_pictures_are_refused", "input", tier="nightly")
def unreadable(bench):
    pictures(bench)
    scratch(bench, "text.png", b"no picture at all")
    scratch(bench, "cut.png", (bench.folder / "a.png").read_bytes()[:60])
    scratch(bench, "empty.png", b"")
    for name in ("text.png", "cut.png", "empty.png", "absent.png", "."):
        bench.run("compare", "a.png", name).expect(4).expect_one_line(name)
        bench.run("compare", name, "a.png").expect(4).expect_one_line(name)
    bench.run("compare", "a.png", "b.png", "--limit-image-side", "20").expect(4).expect_one_line("a.png")
    bench.run("compare", "a.png", "b.png", "--limit-file-bytes", "50").expect(4).expect_one_line("a.png")
    bench.run("compare", "a.png", "b.png", "--limit-texture-bytes", "1K").expect(4).expect_one_line("a.png")


@case("compare.nan_and_inf_exit_6", "input", tier="nightly")
def not_finite(bench):
    pictures(bench)
    holes = {(3, 4): (NAN, 1, 1), (5, 6): (1, INF, -INF)}
    scratch(bench, "holes.pfm", pfm(24, 16, lambda x, y: holes.get((x, y), bright(x, y))))
    for pair, bad in ((("a.pfm", "holes.pfm"), "holes.pfm"), (("holes.pfm", "a.pfm"), "holes.pfm"), (("holes.pfm", "holes.pfm"), "2")):
        done = bench.run("compare", "-q", *pair, "--json", "j.json", "--html", "p.html", "--error-map", "e.png").expect(6)
        done.expect_one_line(bad, "2 of 384")
        found = json.loads((bench.folder / "j.json").read_text())
        check(found["nan_pixels"] == 2 and found["flip_mean"] is None and found["mse"] is None, f"{found}")
        check("The comparison failed" in (bench.folder / "p.html").read_text(), "the page does not say that the comparison failed")
        (bench.folder / "p.html").unlink()
    check(sorted(p.name for p in bench.folder.glob("[ep].*")) == [], "an error map of NaN")
    done = bench.run("compare", "-q", "a.pfm", "holes.pfm", "--fail-flip", "1", "--fail-max", "1e9")
    done.expect(6)  # no limit can allow NaN


@case("compare.page_stands_alone", tier="nightly")
def page(bench):
    pictures(bench)
    strange = scratch(bench, 'a <b> & "c".png', png(24, 16, ramp))
    for reference, test, kind_name in ((strange.name, "b.png", "LDR-FLIP"), ("a.pfm", "b.pfm", "HDR-FLIP")):
        bench.run("compare", "-q", reference, test, "--html", "p.html").expect(0)
        text = (bench.folder / "p.html").read_text()
        tags = []
        parser = html.parser.HTMLParser()
        parser.handle_starttag = lambda tag, attributes: tags.append((tag, dict(attributes)))
        parser.feed(text)
        images = [attributes for tag, attributes in tags if tag == "img"]
        check([image["alt"] for image in images] == ["Reference", "Test", "Error"], f"pictures: {images}")
        for image in images:
            data = base64.b64decode(image["src"].removeprefix("data:image/png;base64,"), validate=True)
            check(data.startswith(b"\x89PNG") and struct.unpack(">II", data[16:24]) == (24, 16), "not the picture as PNG")
        check(not re.search(r'(src|href)="(?!data:)|url\(|https?://(?!www.w3.org/2000/svg)|<script src', text), "the page needs something from outside")
        name = "a &lt;b&gt; &amp; &quot;c&quot;.png" if reference == strange.name else reference
        check(text.count(name) == 3, "title, heading and caption name the reference, escaped")
        for word in (kind_name, "weighted median", "psnr", "24 x 16", "width=device-width", "color-scheme"):
            check(word in text, f"'{word}' is not on the page")
    first = (bench.folder / "p.html").read_bytes()
    bench.run("compare", "-q", "a.pfm", "b.pfm", "--html", "p.html", "--threads", "1").expect(0)
    check((bench.folder / "p.html").read_bytes() == first, "two pages differ")
    done = bench.run("compare", "-q", "a.png", "b.png", "--html", "-").expect(0)
    check(done.out.startswith("<!DOCTYPE html>") and done.out.endswith("</html>\n"), "no page on standard output")


@case("compare.page_slides_flickers_zooms_and_shows_the_histogram", tier="nightly")
def page_in_browser(bench):
    pictures(bench)
    with Browser(bench.folder / "browser") as browser:
        bench.run("compare", "-q", "a.pfm", "b.pfm", "--html", "p.html").expect(0)
        browser.size(1200, 900)
        browser.open(bench.folder / "p.html")
        browser.until("document.querySelectorAll('.tile img').length === 3 && [...document.querySelectorAll('.tile img')].every(i => i.complete && i.naturalWidth === 24)")
        check(browser.value("document.querySelector('.tile .picture').src === document.getElementById('test').src"), "the tile shows another picture")
        tiles = "document.querySelector('.tiles')"
        browser.value("document.querySelector('.view').focus()")
        for key, mode in (("r", "reference"), ("e", "error"), ("t", "technique"), ("s", "split")):
            browser.press(key, text=key)
            check(browser.value(f"{tiles}.dataset.mode") == mode, f"{key} shows {browser.value(f'{tiles}.dataset.mode')}")
        browser.press("f", text="f")
        browser.until(f"{tiles}.dataset.mode === 'reference'")
        browser.until(f"{tiles}.dataset.mode === 'technique'")
        browser.press("f", text="f")
        browser.press("+", text="+")
        check(browser.value("getComputedStyle(document.querySelector('.view img')).transform").startswith("matrix(2,"), "no zoom")
        check(browser.value("[...document.querySelectorAll('.controls label')].some(l => l.textContent === 'Test')"), "what is compared is called a technique")
        bars = browser.value("[...document.querySelectorAll('svg.chart rect')].map(r => r.getBoundingClientRect().height)")
        check(bars and min(bars) > 0, f"bars: {bars}")
        check(not browser.faults, f"the console says {browser.faults}")
        browser.screenshot(bench.folder / "page.png")


@case("compare.error_map_shows_errors_in_magma", tier="nightly")
def error_map(bench):
    pictures(bench)
    scratch(bench, "green.png", png(8, 8, lambda x, y: (0, 255, 0)))
    scratch(bench, "blue.png", png(8, 8, lambda x, y: (0, 0, 255)))
    magma_first, magma_last = bytes((0, 0, 4)), bytes((0xFC, 0xFD, 0xBF))
    for test, colour in (("green.png", magma_first), ("blue.png", magma_last)):
        bench.run("compare", "-q", "green.png", test, "--error-map", "e.png", "--metric", "mse").expect(0)
        data = (bench.folder / "e.png").read_bytes()
        rows = zlib.decompress(b"".join(data[m.end():m.end() + struct.unpack(">I", data[m.start() - 4:m.start()])[0]]
                                        for m in re.finditer(b"IDAT", data)))
        check(len(rows) == 8 * 25, f"{len(rows)} bytes of pixels")
        # Every PNG filter stores the first pixel of the first row unchanged.
        check(rows[1:4] == colour, f"{test}: {rows[1:4]!r}")
    bench.run("compare", "-q", "green.png", "blue.png", "--error-map", "e.pfm").expect(0)
    data = (bench.folder / "e.pfm").read_bytes()
    errors = struct.unpack("<64f", data[-256:])
    check(data.startswith(b"Pf") and all(abs(e - 1) < 1e-4 for e in errors), f"{errors}")


@case("compare.z_test_tells_noise_from_difference", tier="nightly")
def z_test(bench):
    scratch(bench, "mean.pfm", pfm(10, 10, lambda x, y: (1, 1, 1)))
    scratch(bench, "near.pfm", pfm(10, 10, lambda x, y: (1.35, 0.8, 1)))
    scratch(bench, "far.pfm", pfm(10, 10, lambda x, y: (1, 1, 1.5 if (x, y) == (2, 3) else 1)))
    scratch(bench, "variance.pfm", pfm(10, 10, lambda x, y: (0.01, 0.01, 0.01)))  # standard deviation 0.1
    found = figures(bench, "mean.pfm", "near.pfm", "--variance", "variance.pfm")
    check(abs(found["z_max"] - 3.5) < 1e-4 and found["z_rejected_fraction"] == 0, f"{found}")
    check(abs(found["z_limit"] - 4.15) < 0.01, f"the limit of 300 tests at 1 %: {found}")
    found = figures(bench, "mean.pfm", "far.pfm", "--variance", "variance.pfm", code=1)
    check(abs(found["z_max"] - 5) < 1e-4 and found["z_rejected_fraction"] == 0.01, f"{found}")
    done = bench.run("compare", "-q", "mean.pfm", "far.pfm", "--variance", "variance.pfm").expect(1)
    done.expect_one_line("far.pfm", "--variance")
    bench.run("compare", "-q", "mean.pfm", "far.pfm", "--variance", "variance.pfm", "--fail-z", "0.01").expect(0)
    both = ("--variance", "variance.pfm", "--variance", "variance.pfm")
    found = figures(bench, "mean.pfm", "far.pfm", *both)
    check(abs(found["z_max"] - 5 / 2**0.5) < 1e-4, f"variances add: {found}")
    bench.run("compare", "-q", "mean.pfm", "near.pfm", "--variance", "variance.pfm", "--significance", "0.5").expect(1)


@case("compare.variances_are_checked", "input", tier="nightly")
def variances(bench):
    pictures(bench)
    scratch(bench, "negative.pfm", pfm(24, 16, lambda x, y: (1, 1, -1 if (x, y) == (3, 3) else 1)))
    scratch(bench, "nan.pfm", pfm(24, 16, lambda x, y: (NAN, 1, 1)))
    scratch(bench, "small.pfm", pfm(4, 4, bright))
    for name, code in (("negative.pfm", 4), ("nan.pfm", 6), ("small.pfm", 3), ("a.png", 3), ("absent.pfm", 4)):
        bench.run("compare", "-q", "a.pfm", "b.pfm", "--variance", name).expect(code).expect_one_line(name)
    bench.run("compare", "-q", "a.png", "b.png", "--variance", "a.pfm").expect(2).expect_one_line("--variance")


@case("compare.figures_do_not_depend_on_the_machine", tier="nightly")
def repeatable(bench):
    pictures(bench)
    found = set()
    for words in ((), ("--threads", "1"), ("--threads", "2"), ("--threads", "7"), ("--isa", "scalar")):
        for pair in (("a.png", "b.png"), ("a.pfm", "b.pfm")):
            found.add(bench.run("compare", "-q", *pair, "--json", "-", *words).expect(0).out)
    for isa in json.loads(bench.run("info", "--json").expect(0).out)["isa_available"]:
        for pair in (("a.png", "b.png"), ("a.pfm", "b.pfm")):
            found.add(bench.run("compare", "-q", *pair, "--json", "-", env={"BN_FORCE_ISA": isa}).expect(0).out)
    check(len(found) == 2, f"{len(found)} different outputs of two comparisons")


@case("compare.other_build_gives_the_same", "compilers")
def other_build(bench):
    if not os.path.exists(bench.compare_program):
        raise Skipped(f"no program at {bench.compare_program}")
    pictures(bench)
    for pair in (("a.png", "b.png"), ("a.pfm", "b.pfm")):
        found = {bench.run("compare", "-q", *pair, "--json", "-", program=program).expect(0).out
                 for program in (bench.program, bench.compare_program)}
        check(len(found) == 1, f"{pair}: {found}")


@case("compare.wrong_options_say_one_line_and_exit_2")
def wrong_options(bench):
    pictures(bench)
    before = bench.left_behind()
    pair = ("a.png", "b.png")
    for words, needle in (
        ((), "REFERENCE"), (("a.png",), "TEST"), ((*pair, "c.png"), "c.png"), ((*pair, "--bogus"), "--bogus"),
        ((*pair, "--metric", "mse,bogus"), "bogus"), ((*pair, "--metric", ","), "--metric"), ((*pair, "--metric", ""), "--metric"),
        ((*pair, "--metric", "flip,flip-hdr"), "choose one"), ((*pair, "--metric", "flip-hdr"), "flip-hdr"),
        ((*pair, "--ppd", "0"), "--ppd"), ((*pair, "--ppd", "nan"), "--ppd"), ((*pair, "--ppd", "1e9"), "--ppd"),
        ((*pair, "--tonemapper", "bogus"), "aces"), ((*pair, "--exposures", "0"), "--exposures"),
        ((*pair, "--start-exposure", "inf"), "--start-exposure"),
        ((*pair, "--start-exposure", "2", "--stop-exposure", "1"), "--stop-exposure"),
        ((*pair, "--fail-flip", "2"), "--fail-flip"), ((*pair, "--fail-max", "-1"), "--fail-max"),
        ((*pair, "--fail-fraction", "some"), "--fail-fraction"), ((*pair, "--fail-z", "0.5"), "--variance"),
        ((*pair, "--significance", "0.5"), "--variance"),
        ((*pair, "--variance", "a", "--variance", "b", "--variance", "c"), "--variance"),
        ((*pair, "--threads", "0"), "--threads"), ((*pair, "--isa", "sse9"), "scalar, "),
        ((*pair, "--error-map", "e.xyz"), "e.xyz"), ((*pair, "--json", ""), "--json"),
        ((*pair, "--json", "x", "--html", "x"), "twice"), ((*pair, "--json", "-", "--html", "-"), "twice"),
        ((*pair, "--json", "a.png"), "input"), ((*pair, "--error-map", "./b.png"), "input"),
    ):
        done = bench.run("compare", *words).expect(2).expect_one_line(needle)
        check(done.out == "", f"an error belongs on stderr\n{done.describe()}")
    check(bench.left_behind() == before, f"files were left: {bench.left_behind()}")


@case("compare.outputs_that_cannot_be_written_exit_7", "input")
def unwritable(bench):
    pictures(bench)
    (bench.folder / "folder.png").mkdir()
    for words in (("--json", "absent/j.json"), ("--html", "absent/p.html"), ("--error-map", "absent/e.png"), ("--error-map", "folder.png")):
        bench.run("compare", "-q", "a.png", "b.png", *words).expect(7).expect_one_line(words[1])
    kept = scratch(bench, "p.html", b"kept")
    # The page does not fit, the figures do. A failed output outranks a failed limit.
    done = bench.run("compare", "-q", "a.png", "b.png", "--html", "p.html", "--json", "j.json", "--fail-flip", "0", file_size=1024)
    done.expect(7)
    check(kept.read_bytes() == b"kept", "the page that was there is lost")
    check(json.loads((bench.folder / "j.json").read_text())["width"] == 24, "the figures that could be written are not there")


@case("compare.figures_go_to_stdout_and_words_to_stderr", tier="nightly")
def words(bench):
    pictures(bench)
    done = bench.run("compare", "a.pfm", "b.pfm", "--json", "j.json").expect(0)
    for word in ("flip-hdr", "mean", "p99", "exposures", "mse", "psnr", "ssim", "differing"):
        check(word in done.out, f"'{word}' is not said\n{done.describe()}")
    check(done.err == "wrote       j.json\n" and "\x1b" not in done.out, done.describe())
    quiet = bench.run("compare", "-q", "a.pfm", "b.pfm").expect(0)
    check(quiet.out == "" and quiet.err == "", f"--quiet speaks\n{quiet.describe()}")
    more = bench.run("compare", "-v", "a.pfm", "b.pfm").expect(0)
    check("24x16, 3 channels, floats" in more.err, more.describe())
    piped = bench.run("compare", "a.pfm", "b.pfm", "--json", "-").expect(0)
    json.loads(piped.out)  # nothing else is printed
    check("flip-hdr" in piped.err and "wrote" not in piped.err, piped.describe())


@case("compare.csv_holds_what_json_holds")
def csv_figures(bench):
    pictures(bench)
    bench.run("compare", "-q", "a.pfm", "b.pfm", "--json", "j.json", "--csv", "c.csv", "--fail-flip", "1").expect(0)
    figures = json.loads((bench.folder / "j.json").read_text())
    figures.update({f"limits.{name}": value for name, value in figures.pop("limits").items()})
    rows = list(csv.DictReader((bench.folder / "c.csv").open(newline="")))
    check(len(rows) == 1 and sorted(rows[0]) == sorted(figures), f"{rows}")
    for name, value in figures.items():
        check(rows[0][name] == ("" if value is None else value if isinstance(value, str) else rows[0][name]), f"{name}: {rows[0][name]}")
        if isinstance(value, (int, float)):
            check(float(rows[0][name]) == value, f"{name}: {rows[0][name]} is not {value}")
