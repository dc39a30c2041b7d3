"""The project's own golden pictures, by `burnish golden`: tests/golden/manifest.json draws them, hashes hold them, and files show them."""

import json
import pathlib
import re
import shutil
import sys

from harness import Failed, Skipped, case, check

GOLDEN = pathlib.Path(__file__).resolve().parent.parent / "golden"
sys.path.append(str(GOLDEN))
from rounded import rounded

SCENES = ("teapot", "spheres", "plate")  # that every technique draws


def draw(bench, isa, kind, operations=None):
    """Draws all golden pictures with an instruction set, as files of a kind, into a folder with its name, and judges them. With operations, each
    frame may take 1 % more than its row, or none without a row."""
    manifest = json.loads((GOLDEN / "manifest.json").read_text())
    for row in manifest["rows"] if operations is not None else ():
        row["hold"] = {"operations": 1.01 * operations.get(row["name"], 0)}
    manifest["goldens"] = str(GOLDEN / manifest["goldens"])
    manifest["defaults"]["format"] = kind
    manifest["defaults"]["options"] += ["--isa", isa]
    (bench.folder / f"{isa}.json").write_text(json.dumps(manifest))
    return bench.run("golden", "check", f"{isa}.json", "-o", isa, timeout=300.0)


def show(bench, isa):
    """Compares the pictures that differ with the kept files, in 16 bits a channel. Returns the run, whose page shows them."""
    folders = [bench.folder / f"{isa}-kept", bench.folder / f"{isa}-drawn"]
    for folder in folders:
        folder.mkdir()
    for row in map(json.loads, (bench.folder / isa / "results.jsonl").read_text().splitlines()):
        kept, drawn = GOLDEN / f"pictures/{row['name']}.exr", bench.folder / isa / row["picture"]
        if row["verdict"] != "passed" and drawn.exists():
            (folders[1] / kept.name).write_bytes(rounded(drawn.read_bytes()))
            if kept.exists():
                shutil.copy(kept, folders[0])
    return bench.run("golden", "check", *folders, "-o", f"{isa}-shown")


@case("own_goldens.are_drawn_by_every_instruction_set", budget=30)
def every_isa(bench):
    """Draws each golden picture once an instruction set: no cheaper test holds them."""
    for isa in json.loads(bench.run("info", "--json").expect(0).out)["isa_available"]:
        if draw(bench, isa, "pfm").code != 0:  # pfm takes a third of exr's time
            drawn, shown = draw(bench, isa, "exr"), show(bench, isa)
            raise Failed(f"{isa} draws other pictures:\n{drawn.describe()}\nIn 16 bits a channel:\n{shown.out or shown.err}\n"
                         f"{bench.folder}/{isa}-shown/index.html shows them. If they are right: tests/bless")


@case("own_goldens.take_no_more_operations", tier="nightly")
def operations_of_frames(bench):
    """Holds each frame's float operations to 1 % above tests/golden/operations.json. The right file lies in the folder of a failed test."""
    if bench.run("render", "builtin:plate", "--size", "16x16", "--count-operations", "--stats", "-", "-q").code == 77:
        raise Skipped("the program counts no operations")
    kept = GOLDEN / "operations.json"
    operations = json.loads(kept.read_text())
    done = draw(bench, "scalar", "pfm", operations)
    rows = [json.loads(line) for line in (bench.folder / "scalar/results.jsonl").read_text().splitlines()]
    text = json.dumps({row["name"]: int(row["operations"]) for row in sorted(rows, key=lambda row: row["name"])}, indent=1) + "\n"
    (bench.folder / "operations.json").write_text(text)
    copy = f"cp {bench.folder}/operations.json {kept}"
    new = sorted({row["name"] for row in rows} - set(operations))
    check(not new, f"{kept} lacks {', '.join(new)}\ntests/bless adds the rows. By hand: {copy}")
    check(done.code == 0, f"{done.describe()}\nIf more work is right: {copy}")


@case("own_goldens.have_a_row_for_every_file_and_technique", tier="quick")
def rows_and_files(bench):
    rows = {row["name"]: row for row in json.loads((GOLDEN / "manifest.json").read_text())["rows"]}
    for folder, suffix in ((GOLDEN / "hashes", ".hash"), (GOLDEN / "pictures", ".exr")):
        names = {path.name.removesuffix(suffix) for path in folder.iterdir()}
        check(names == set(rows), f"{folder}: {sorted(names ^ set(rows))} lacks a row or a file")
    counted = set(json.loads((GOLDEN / "operations.json").read_text()))
    check(counted >= set(rows), f"operations.json lacks {', '.join(sorted(set(rows) - counted))}: tests/bless adds rows")
    check(counted <= set(rows), f"operations.json has rows without a golden: {', '.join(sorted(counted - set(rows)))}")
    check(all(re.fullmatch(r"[0-9a-f]{16}\n", path.read_text()) for path in (GOLDEN / "hashes").iterdir()), "a file of hashes holds no hash")
    techniques = re.findall(r"^(\w+)  ", bench.run("list", "techniques").expect(0).out, re.MULTILINE)
    check("auto" in techniques and "lobe_line" in techniques, techniques)
    for name in techniques:
        for scene in SCENES:
            row = rows.get(f"{'frames' if name == 'auto' else name}.{scene}", {"scene": "none", "options": []})
            given = dict(zip(row["options"][0::2], row["options"][1::2]))
            check(row["scene"] == f"builtin:{scene}" and given.get("--technique", "auto") == name, f"{name} draws no golden picture of the {scene}")
