"""burnish golden: contents of results, and results that others may replace: NaN, other shards, and stopped runs."""

import json
import signal
import struct
import subprocess
import time
import xml.etree.ElementTree

from golden_cases import program, results, verdicts, write
from harness import case, check


@case("golden.merge_takes_shards_of_one_manifest_alone", budget=4)
def foreign_shards(bench):
    (bench.folder / "a.ppm").write_bytes(b"P6 1 1 255\n\0\0\0")
    rows = [{"name": name, "picture": "a.ppm"} for name in "ab"]
    shard = lambda i: bench.run("golden", "check", "m.json", "--shard", f"{i}/2", "-o", f"s{i}").expect(5)
    write(bench, rows)
    shard(1)
    for other in ([rows[0], {**rows[1], "hold": {"flip": 0.5}}], [rows[0], {**rows[1], "seconds": 9}], [{**rows[0], "golden": "g.ppm"}, rows[1]]):
        write(bench, other)
        shard(2)
        bench.run("golden", "merge", "s1", "s2", "-o", "merged").expect(4).expect_one_line("s2", "other rows", "s1")
    check(not (bench.folder / "merged").exists(), "a file is written")
    write(bench, rows)
    shard(2)
    bench.run("golden", "merge", "s1", "s2", "-o", "merged").expect(5)
    # One shard twice is not two shards
    bench.run("golden", "merge", "s2", "s2", "-o", "merged").expect(4).expect_one_line("s2", "shard 2/2")
    # Paths stay within the folder
    path = bench.folder / "s2/results.jsonl"
    result = json.loads(path.read_text())
    for member, value in (("picture", "pictures/../../../secret.png"), ("picture", "/etc/passwd"), ("picture", "pictures/.."), ("picture", "pictures/..\\..\\x.png"),
                          ("picture", "logs/b.ppm"), ("log", "logs/../../x.txt"), ("golden_copy", "https://evil.example/x.png")):
        path.write_text("\n".join(json.dumps(r) for r in ({**result, "name": "c"}, {**result, member: value})) + "\n")
        bench.run("golden", "merge", "s1", "s2", "-o", "merged").expect(4).expect_one_line("s2/results.jsonl", "line 2", f"'{member}'")
        bench.run("golden", "bless", "m.json", "-o", "s2").expect(4).expect_one_line("s2/results.jsonl", "line 2")
    check(len(results(bench, "merged")) == 2, "the earlier results are gone")


@case("golden.two_checks_do_not_share_a_folder")
def shared_folder(bench):
    begun = bench.folder / "begun"
    wait = program(bench, "wait.sh", f"touch {begun}; sleep 2; printf 'P6 1 1 255\\n\\0\\0\\0' > out.ppm")
    write(bench, [{"name": "slow", "command": [wait], "picture": "out.ppm"}])
    first = subprocess.Popen([bench.program, "golden", "check", "m.json", "-o", "r"], cwd=bench.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while not begun.exists() and first.poll() is None:
        time.sleep(0.02)
    bench.run("golden", "check", "m.json", "-o", "r").expect(7).expect_one_line("r:", "another run")
    check(first.wait(timeout=60) == 5 and len(results(bench, "r")) == 1, "the first check")
    bench.run("golden", "check", "m.json", "-o", "r").expect(5)


@case("golden.pictures_with_nan_fail_and_are_not_blessed", budget=10)
def not_finite(bench):
    pfm = lambda *values: b"PF\n2 2\n-1.0\n" + struct.pack("<12f", *values, *[0.5] * (12 - len(values)))
    whole, broken = pfm(0.5), pfm(float("nan"), 0.5, 0.5, 0.5, float("inf"))
    copy = program(bench, "copy.sh", "cp n.pfm out.pfm")
    rows = [{"name": "plain", "picture": "n.pfm"}, {"name": "hold", "picture": "n.pfm", "hold": {"flip": 0.1}}, {"name": "hash", "picture": "n.pfm", "keep": "hash"},
            {"name": "mask", "picture": "n.pfm", "mask": "black.ppm"}, {"name": "made", "command": [copy], "picture": "out.pfm"}]
    (bench.folder / "black.ppm").write_bytes(b"P6 2 2 255\n" + bytes(12))
    put = lambda picture: (bench.folder / "n.pfm").write_bytes(picture)
    write(bench, rows)

    def all_fail():
        done = bench.run("golden", "check", "m.json").expect(6)
        check("5 hold NaN or Inf" in done.out and "0 could not be made" in done.out, done.out)
        check(set(verdicts(bench).values()) == {"failed"} and all("2 of 4 pixels are NaN or Inf" in r["reason"] for r in results(bench).values()), results(bench))
        page = (bench.folder / "golden-results/index.html").read_text()
        check(page.count("2 of 4 pixels are NaN or Inf") == 5 and 'class="bless"' not in page, "the page")
        suite = xml.etree.ElementTree.parse(bench.folder / "golden-results/junit.xml").getroot()
        check(suite.get("tests") == "5" and suite.get("errors") == "5", suite.attrib)
        lines = bench.run("golden", "bless", "m.json").expect(6).err.splitlines()
        check(len(lines) == 5 and all("is not blessed: 2 of 4 pixels are NaN or Inf" in line for line in lines), lines)

    # Without a golden, then with one
    put(broken)
    all_fail()
    check(not (bench.folder / "goldens").exists(), "a golden is written")
    put(whole)
    bench.run("golden", "check", "m.json").expect(5)
    bench.run("golden", "bless", "m.json").expect(0)
    goldens = {path.name: path.read_bytes() for path in (bench.folder / "goldens").iterdir()}
    put(broken)
    all_fail()
    check({path.name: path.read_bytes() for path in (bench.folder / "goldens").iterdir()} == goldens, "a golden has changed")
    (bench.folder / "list.txt").write_text("hold\n")
    bench.run("golden", "bless", "m.json", "--from", "list.txt").expect(6).expect_one_line("'hold' is not blessed", "2 of 4")
    path = bench.folder / "golden-results/results.jsonl"  # may come from somebody else
    listed = path.read_text()
    path.write_text(listed.replace('"not_finite":true', '"not_finite":false').replace('"verdict":"failed"', '"verdict":"differs"'))
    bench.run("golden", "bless", "m.json", "--from", "list.txt").expect(6).expect_one_line("2 pixels are NaN or Inf")
    check({path.name: path.read_bytes() for path in (bench.folder / "goldens").iterdir()} == goldens, "a golden has changed by forged results")
    path.write_text(listed)
    # The gravest verdict makes the exit code, and bless takes the others over
    (bench.folder / "other.pfm").write_bytes(whole)
    rows.append({"name": "new", "picture": "other.pfm"})
    write(bench, rows)
    bench.run("golden", "check", "m.json").expect(6)
    check("1 picture blessed" in bench.run("golden", "bless", "m.json").expect(6).out, "the whole picture is not blessed")
    (bench.folder / "other.pfm").write_bytes(pfm(0.75))
    bench.run("golden", "check", "m.json").expect(6)
    write(bench, [*rows, {"name": "absent", "picture": "absent.pfm"}])
    bench.run("golden", "check", "m.json").expect(4)
    # Shards keep the code
    write(bench, rows)
    for i in (1, 2):
        bench.run("golden", "check", "m.json", "--shard", f"{i}/2", "-o", f"s{i}").expect(6)
    bench.run("golden", "merge", "s1", "s2", "-o", "merged").expect(6)
    # Two folders; a golden with NaN is replaced
    for folder, picture in (("e", broken), ("a", broken)):
        (bench.folder / folder).mkdir()
        (bench.folder / folder / "x.pfm").write_bytes(picture)
    for more in ((), ("--flip", "0.1")):
        bench.run("golden", "check", "e", "a", *more).expect(6)
    (bench.folder / "a/x.pfm").write_bytes(whole)
    bench.run("golden", "check", "e", "a", "--flip", "0.1").expect(1)
    check(results(bench)["x.pfm"]["reason"] == "2 pixels of the golden are NaN or Inf", results(bench))
    bench.run("golden", "bless", "e", "a").expect(0)
    bench.run("golden", "check", "e", "a").expect(0)


FIGURES = ("flip_mean", "flip_p99", "differing_fraction", "max_abs")


@case("golden.figures_are_null_unless_they_were_measured", budget=4)
def unmeasured(bench):
    """Equal pictures have zeros. Reports, pages, merge and bless take nulls."""
    ppm = lambda width, value: b"P6 %d 1 255\n" % width + bytes([value, 0, 0] * width)
    pfm = lambda value: b"PF\n1 1\n-1.0\n" + struct.pack("<3f", value, 0.5, 0.5)
    put = lambda name, content: (bench.folder / name).write_bytes(content)
    kept = {"equal.ppm": ppm(2, 9), "other.ppm": ppm(2, 9), "size.ppm": ppm(2, 9), "hash.ppm": ppm(2, 9), "changed.ppm": ppm(2, 9), "nan.pfm": pfm(0.5)}
    rows = [{"name": name[:-4], "picture": name, **({"keep": "hash"} if name in ("hash.ppm", "changed.ppm") else {})} for name in kept]
    for name, content in kept.items():
        put(name, content)
    write(bench, rows)
    bench.run("golden", "check", "m.json").expect(5)
    none = dict.fromkeys(FIGURES)
    figures = lambda folder="golden-results": {name: {key: row[key] for key in FIGURES} for name, row in results(bench, folder).items()}
    check(all(row == none for row in figures().values()), f"figures without goldens: {figures()}")
    bench.run("golden", "bless", "m.json").expect(0)
    zeros = dict.fromkeys(FIGURES, 0)
    bench.run("golden", "check", "m.json").expect(0)
    check(all(row == zeros for row in figures().values()), f"figures of equal pictures: {figures()}")
    for name, content in (("other.ppm", ppm(2, 99)), ("size.ppm", ppm(3, 9)), ("changed.ppm", ppm(2, 99)), ("nan.pfm", pfm(float("nan")))):
        put(name, content)
    write(bench, [*rows, {"name": "absent", "picture": "absent.ppm"}])
    bench.run("golden", "check", "m.json").expect(4)
    found = figures()
    check(found["equal"] == found["hash"] == zeros and all(value > 0 for value in found["other"].values()), f"{found}")
    check(all(found[name] == none for name in ("size", "changed", "nan", "absent")), f"{found}")
    # Shards give the same files
    texts = lambda folder: [(bench.folder / folder / name).read_bytes() for name in ("results.jsonl", "junit.xml", "summary.md", "index.html")]
    for i in (1, 2):
        bench.run("golden", "check", "m.json", "--shard", f"{i}/2", "-o", f"s{i}")
    bench.run("golden", "merge", "s1", "s2", "-o", "merged").expect(4)
    check(texts("merged") == texts("golden-results"), "merged shards have other files")
    bench.run("golden", "check", "m.json", "--take", "--work", "w").expect(0)
    bench.run("golden", "check", "m.json", "--merge", "--work", "w", "-o", "pieces").expect(4)
    check(figures("pieces") == found, f"pieces have other figures: {figures('pieces')}")
    write(bench, rows)
    bench.run("golden", "check", "m.json").expect(6)
    (bench.folder / "list.txt").write_text("size\nother\nchanged\n")
    bench.run("golden", "bless", "m.json", "--from", "list.txt").expect(0)
    check((bench.folder / "goldens/size.ppm").read_bytes() == ppm(3, 9), "a picture of another size is not blessed")


@case("golden.a_stopped_check_keeps_the_earlier_results", budget=4)
def interrupted(bench):
    for name in "ab":
        (bench.folder / f"{name}.ppm").write_bytes(b"P6 1 1 255\n" + bytes([ord(name), 0, 0]))
    slow = program(bench, "slow.sh", "cp $1.ppm out_$1.ppm; if [ -e wait ] && [ $1 = b ]; then touch started; sleep 20; fi")
    write(bench, [{"name": name, "command": [slow, name], "picture": f"out_{name}.ppm"} for name in "ab"])
    bench.run("golden", "check", "m.json").expect(5)
    folder = bench.folder / "golden-results"
    files = lambda: {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    before = files()
    check({"index.html", "results.jsonl", "junit.xml", "summary.md", "pictures/a.ppm", "pictures/b.ppm"} <= set(before), sorted(before))
    (bench.folder / "wait").touch()
    (bench.folder / "a.ppm").write_bytes(b"P6 1 1 255\n\1\1\1")  # which the stopped run draws

    def started():
        (bench.folder / "started").unlink(missing_ok=True)
        child = subprocess.Popen([bench.program, "golden", "check", "m.json", "--jobs", "1", "-q"], cwd=bench.folder, env=bench.environment({}))
        begin = time.monotonic()
        while not (bench.folder / "started").exists():
            check(child.poll() is None and time.monotonic() - begin < 60, "the row does not start")
            time.sleep(0.02)
        return child

    for number in (signal.SIGINT, signal.SIGTERM):
        child = started()
        child.send_signal(number)
        check(child.wait(timeout=60) == 128 + number, f"it ended with {child.returncode}")
        check(files() == before, f"other files: {sorted(set(files()) ^ set(before))}")
    # A killed run leaves them too, and the next one takes their place
    child = started()
    child.kill()
    child.wait()
    check(before.items() <= files().items(), "earlier results are gone")
    (bench.folder / "wait").unlink()
    bench.run("golden", "bless", "m.json").expect(0)
    check((bench.folder / "goldens/a.ppm").read_bytes() == before["pictures/a.ppm"], "the golden is not the picture of the page")
    bench.run("golden", "check", "m.json").expect(1)
    check(set(files()) >= {"goldens/a.ppm"} and not any(name.startswith((".new", ".old")) for name in files()), sorted(files()))
    check(files()["pictures/a.ppm"] == b"P6 1 1 255\n\1\1\1", "no new picture")
