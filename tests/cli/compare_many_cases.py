"""burnish compare: verdicts in every report, folders of pictures, pages of sequences."""

import csv
import json
import xml.etree.ElementTree as tree

from browser import Browser
from compare_cases import bright, pfm, pictures, png, ramp
from harness import case, check, scratch


def junit_of(bench, name):
    """Returns {name of a case: (element, message)} of a JUnit file, where a passed case has no element, and the suite's counts."""
    suite = tree.parse(bench.folder / name).getroot()
    told = {row.get("name"): next(((child.tag, child.get("message")) for child in row), None) for row in suite}
    return told, tuple(int(suite.get(key)) for key in ("tests", "failures", "errors"))


@case("compare.every_report_says_what_was_judged", "input")
def verdicts(bench):
    pictures(bench)
    words = ("a.png", "b.png", "--json", "j.json", "--csv", "c.csv", "--junit", "u.xml", "--html", "p.html", "-q")
    for limits, code, verdict in (((), 0, None), (("--fail-max", "0.5"), 0, "passed"), (("--fail-flip", "0.5", "--fail-max", "0.01"), 1, "differs")):
        done = bench.run("compare", *words, *limits).expect(code)
        found = json.loads((bench.folder / "j.json").read_text())
        check((found["reference"], found["test"], found["verdict"]) == ("a.png", "b.png", verdict), str(found))
        check(found["limits"] == {name.strip("-").replace("-", "_"): float(value) for name, value in zip(limits[::2], limits[1::2])}, str(found))
        row = next(csv.DictReader((bench.folder / "c.csv").open(newline="")))
        check((row["test"], row["verdict"]) == ("b.png", verdict or "") and row.get("limits.fail_max") == (limits[-1] if limits else None), str(row))
        told, counts = junit_of(bench, "u.xml")
        check(counts == (1, code, 0) and list(told) == ["b.png"], str(told))
        page = (bench.folder / "p.html").read_text()
        if code:
            check(found["reason"].startswith("--fail-max: a channel differs by") and found["reason"] in done.err, str(found))
            check(told["b.png"] == ("failure", found["reason"]), str(told))
            check("<strong>Fails.</strong> " + found["reason"] in page, "the page does not say why it fails")
        else:
            check(found["reason"] is None and told["b.png"] is None and "Fails" not in page, str(found))
            check(("Passes.</strong> Limits: --fail-max 0.5" if limits else "No limit was given") in page, "the page does not say what was judged")
    nan = float("nan")
    scratch(bench, "nan.pfm", pfm(24, 16, lambda x, y: (nan if x == 3 else 1.0, 1.0, 1.0)))
    bench.run("compare", "-q", "a.pfm", "nan.pfm", "--json", "j.json", "--junit", "u.xml").expect(6)
    check(json.loads((bench.folder / "j.json").read_text())["verdict"] == "failed", "NaN passes")
    check(junit_of(bench, "u.xml")[0]["nan.pfm"][0] == "error", "NaN is no error")


@case("compare.folders_pair_pictures_by_their_paths", "input")
def folders(bench):
    for folder in ("expected/sub", "actual/sub"):
        (bench.folder / folder).mkdir(parents=True)
    strange = 'a <b> "&"\n.png'
    for name, expected, actual in (("same.png", ramp, ramp), ("sub/other.png", ramp, lambda x, y: (0, 8 * y, 9)), (strange, ramp, ramp)):
        scratch(bench, "expected/" + name, png(24, 16, expected))
        scratch(bench, "actual/" + name, png(24, 16, actual))
    words = ("compare", "expected", "actual", "--json", "j.json", "--csv", "c.csv", "--junit", "u.xml")
    bench.run(*words, "-q").expect(0)
    done = bench.run(*words, "--fail-flip", "0.01").expect(1)
    check(len(done.err.splitlines()) == 4 and "sub/other.png: --fail-flip" in done.err and "1 of 3 fail" in done.out, done.describe())
    found = json.loads((bench.folder / "j.json").read_text())
    check({row["name"]: row["verdict"] for row in found["pictures"]} == {"same.png": "passed", "sub/other.png": "differs", strange: "passed"}, str(found))
    alone = json.loads(bench.run("compare", "expected/sub/other.png", "actual/sub/other.png", "--json", "-").expect(0).out)
    row = next(row for row in found["pictures"] if row["name"] == "sub/other.png")
    check(all(row[key] == alone[key] for key in ("flip_mean", "ssim", "max_abs", "width")), "a folder's figures are others than a pair's")
    named = [row["name"] for row in csv.DictReader((bench.folder / "c.csv").open(newline=""))]
    check(len(named) == 3 and {"same.png", "sub/other.png"} < set(named), f"CSV: {named}")
    told, counts = junit_of(bench, "u.xml")
    check(counts == (3, 1, 0) and told["sub/other.png"][0] == "failure" and told["same.png"] is None, str(told))
    # Graver: sizes, then missing and unreadable pictures
    scratch(bench, "actual/same.png", png(12, 16, ramp))
    bench.run(*words, "-q", "--fail-flip", "0.01").expect(3)
    scratch(bench, "expected/gone.png", png(24, 16, ramp))
    done = bench.run(*words, "-q").expect(4)
    check("actual/gone.png" in done.err and json.loads((bench.folder / "j.json").read_text())["failed"] == 2, done.describe())
    check(junit_of(bench, "u.xml")[1] == (4, 0, 2), "missing pictures are errors")
    for words, code, needle in ((("expected", "actual", "--html", "p.html"), 2, "golden check expected actual"), (("expected", "actual/same.png"), 4, "expected"),
                                (("expected", "actual", "--error-map", "e.png"), 2, "--error-map"), (("expected", "nowhere"), 4, "expected"),
                                (("actual/sub", "actual/empty"), 4, "actual")):
        bench.run("compare", *words).expect(code).expect_one_line(needle)
    (bench.folder / "none").mkdir()
    bench.run("compare", "none", "none").expect(4).expect_one_line("holds no picture")


@case("compare.folders_tell_of_alpha_that_one_picture_alone_has", "input")
def folder_alpha(bench):
    for name, alpha in (("clear.png", 255), ("holed.png", 40)):
        scratch(bench, "expected/" + name, png(24, 16, ramp))
        scratch(bench, "actual/" + name, png(24, 16, lambda x, y: (*ramp(x, y), alpha), channels=4))
    words = ("compare", "expected", "actual", "--fail-max", "0", "--fail-flip", "0", "--json", "j.json", "--junit", "u.xml")
    done = bench.run(*words).expect(3)
    check("note        actual/clear.png alone has alpha" in done.err and done.err.count("alone has alpha") == 1 and "1 of 2 fail" in done.out, done.describe())
    reason = "alpha is not 1 in 384 of 384 pixels, and expected/holed.png has no alpha"
    rows = {row["name"]: row for row in json.loads((bench.folder / "j.json").read_text())["pictures"]}
    check((rows["clear.png"]["verdict"], rows["clear.png"]["max_abs"]) == ("passed", 0), str(rows))
    check((rows["holed.png"]["verdict"], rows["holed.png"]["reason"]) == ("failed", reason) and "max_abs" not in rows["holed.png"], str(rows))
    told, counts = junit_of(bench, "u.xml")
    check(counts == (2, 0, 1) and told["holed.png"] == ("error", "actual/holed.png: " + reason) and told["clear.png"] is None, str(told))
    done = bench.run(*words, "-q").expect(3)
    check("note" not in done.err and reason in done.err, done.describe())


@case("compare.sequences_have_a_page_of_their_worst_frame", budget=3)
def sequence_page(bench):
    for frame in range(1, 6):
        scratch(bench, f"r{frame}.pfm", pfm(24, 16, bright))
        scratch(bench, f"t{frame}.pfm", pfm(24, 16, lambda x, y: (0.1 * x, 0.2 * y, 1.0 + 0.2 * (frame == 4))))
    words = ("compare", "--sequence", "r%d.pfm", "t%d.pfm", "-q", "--html", "p.html", "--json", "j.json", "--junit", "u.xml")
    bench.run(*words, "--fail-flicker", "1").expect(0)
    page = (bench.folder / "p.html").read_text()
    for needle in ("Passes.", "--fail-flicker 1", "The worst frame: 4", "t4.pfm", "HDR-FLIP", "reference&apos;s change"):
        check(needle in page or needle.replace("&apos;", "'") in page, f"{needle} is not on the page")
    done = bench.run(*words, "--fail-flicker", "0.0001").expect(1)
    found = json.loads((bench.folder / "j.json").read_text())
    check(found["verdict"] == "differs" and found["reason"] in (bench.folder / "p.html").read_text() and "--fail-flicker" in done.err, str(found))
    check(junit_of(bench, "u.xml")[0]["t%d.pfm"] == ("failure", found["reason"]), "JUnit")
    with Browser(bench.folder / "browser") as browser:
        browser.size(1200, 900)
        browser.open(bench.folder / "p.html")
        browser.until("document.querySelectorAll('.tile img').length === 3")
        marks = browser.value("document.querySelectorAll('figure svg.chart circle.mark').length")
        check(marks == 5 + 4 + 4, f"{marks} marks")
        check(not browser.faults, f"the console says {browser.faults}")
        browser.screenshot(bench.folder / "page.png")


@case("compare.names_are_no_commands_to_github", "input")
def commands(bench):
    """GitHub obeys printed lines that begin with "::", after blanks too, and "##[" anywhere."""
    names = ("::warning::hello.png", " \u3000::error::x.png", "a\n::error::b.png", "##[error]c.png")
    for name in names:
        for folder in ("expected", "actual"):
            scratch(bench, f"{folder}/{name}", png(24, 16, ramp if folder == "actual" else lambda x, y: (0, 8 * y, 9)))
    scratch(bench, "actual/::notice::none.png", b"no picture")
    for env, code in (({"GITHUB_ACTIONS": "true"}, "\\::"), ({}, "::")):
        done = bench.run("compare", "expected", "actual", "--fail-flip", "0.001", env=env).expect(4)
        check(f"\n{code}warning::hello.png FLIP 0." in "\n" + done.out, done.describe())
        piped = bench.run("compare", "expected", "actual", "--csv", "-", env=env).expect(4)
        check(piped.out.count("::warning::hello.png") == 3 and not any(line.strip().startswith("::") for line in piped.out.splitlines()), piped.describe())
        listed = bench.run("compare", "expected", "actual", "--json", "-", env=env).expect(4)
        check("##[" not in listed.out and "##[error]c.png" in str(json.loads(listed.out)), listed.describe())
        for line in (done.out + done.err).splitlines() if env else ():
            check(not line.strip().startswith("::") and "##[" not in line, done.describe())


@case("compare.a_failed_comparison_has_a_page", "input")
def failure_pages(bench):
    pictures(bench)
    nan = float("nan")
    scratch(bench, "nan.pfm", pfm(24, 16, lambda x, y: (nan if x == 3 else 1.0, 1.0, 1.0)))
    for frame in (1, 2, 3):
        scratch(bench, f"r{frame}.png", png(24, 16, ramp))
        scratch(bench, f"t{frame}.png", png(24, 16, ramp) if frame != 2 else b"no picture")
        scratch(bench, f"n{frame}.pfm", pfm(24, 16, lambda x, y: (nan if frame == 3 else 1.0, 1.0, 1.0)))
        scratch(bench, f"f{frame}.pfm", pfm(24, 16, bright))
    for words, code, needle in ((("a.png", "<missing>.png"), 4, "&lt;missing&gt;.png: "), (("a.png", "a.pfm"), 3, "a.pfm: "), (("a.pfm", "nan.pfm"), 6, "nan.pfm: "),
                                (("--sequence", "r%d.png", "t%d.png"), 4, "t2.png: "), (("--sequence", "r%d.png", "x%d.png"), 4, "x"),
                                (("--sequence", "f%d.pfm", "n%d.pfm"), 6, "n3.pfm: ")):
        (bench.folder / "p.html").unlink(missing_ok=True)
        done = bench.run("compare", *words, "--fail-flip", "0.1", "--html", "p.html", "-q").expect(code)
        text = (bench.folder / "p.html").read_text()
        check("The comparison failed" in text and f"<p>{needle}" in text and "<img" not in text, f"{text[-600:]}\n{done.describe()}")
    bench.run("compare", "a.png", "b.png", "--metric", "flip-hdr", "--html", "q.html").expect(2)
    check(not (bench.folder / "q.html").exists(), "a page of a wrong option")


@case("compare.rows_of_a_sequence_name_files_and_verdict")
def sequence_csv(bench):
    for frame in (1, 2, 3):
        scratch(bench, f"r{frame}.png", png(24, 16, ramp))
        scratch(bench, f"t{frame}.png", png(24, 16, ramp if frame != 2 else lambda x, y: (0, 8 * y, 9)))
    for limit, code, verdict in (("1", 0, "passed"), ("0.001", 1, "differs")):
        bench.run("compare", "--sequence", "r%d.png", "t%d.png", "-q", "--fail-flip", limit, "--csv", "c.csv").expect(code)
        rows = list(csv.DictReader((bench.folder / "c.csv").open(newline="")))
        check([(row["frame"], row["reference"], row["test"]) for row in rows] == [(str(i), f"r{i}.png", f"t{i}.png") for i in (1, 2, 3)], f"{rows}")
        check({(row["verdict"], float(row["limits.fail_flip"])) for row in rows} == {(verdict, float(limit))}, f"{rows}")
        check(all(("--fail-flip" in row["reason"]) == bool(code) for row in rows) and float(rows[1]["flip_mean"]) > 0 and rows[1]["change"], f"{rows}")
