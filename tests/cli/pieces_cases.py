"""Jobs in pieces: the files of one process, whatever the shares, their order, and the processes that die on the way."""

import base64
import json
import pathlib
import random
import re
import shlex
import shutil
import signal
import subprocess
import time

import gltf_files
from fault_cases import REFERENCE, needs_embree
from harness import Skipped, case, check

ROOT = pathlib.Path(__file__).resolve().parents[2]
PICTURE = ("render", "builtin:plate", "--backend", "reference", "--size", "48x32", "--samples", "8192", "--env-size", "16", "--env-samples", "16", "-q")
ROW = ("render", "builtin:plate", "--animate", "roughness=0.1:0.6", "--steps", "5", "--size", "48x32", "--env-size", "16", "--env-samples", "16", "-q")
CHART = ("chart", "builtin:plate", "--techniques", "split_isotropic,bent_normal", "--sweep", "roughness=0.2,0.4,0.6", "--size", "96x64",
         "--error-size", "48x32", "--reference-samples", "64", "--env-size", "16", "--env-samples", "16", "--runs", "0", "-q")


def files_of(folder):
    """Returns {name: bytes} of a file, or of all files of a folder."""
    if folder.is_file():
        return {"": folder.read_bytes()}
    return {str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def pieces_of(bench, words):
    """Returns the list of --pieces as tuples: key, seconds, command."""
    lines = [line.split(" ", 2) for line in bench.run(*words, "--pieces", "--work", "w").expect(0).out.splitlines()]
    check(all(re.fullmatch("[0-9a-f]{16}", key) and float(seconds) >= 0 and command.startswith("burnish ") for key, seconds, command in lines), f"{lines}")
    return lines


def shell(bench, line):
    """Runs a line of the list as a shell does, with this program."""
    return subprocess.run(["sh", "-c", line.replace("burnish ", f"{bench.program} ", 1)], cwd=bench.folder, env=bench.environment({}),
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300)


def one_and_pieces(bench, words, outputs, option="-o", machine=("--threads", "1", "--isa", "scalar")):
    """Makes the outputs by one process in "one", then in "two" by shares out of order, single commands and a merge. Compares all."""
    (bench.folder / "one").mkdir()
    (bench.folder / "two").mkdir()
    at = lambda folder: [word for name in outputs for word in (option, f"{folder}/{name}")]
    bench.run(*words, *at("one")).expect(0)
    words = (*words, *at("two"))
    pieces = pieces_of(bench, words)
    check(len({key for key, _, _ in pieces}) == len(pieces) > 2, f"{pieces}")
    merged = bench.run("merge", "w")
    merged.expect(4)
    bench.run(*words, "--shard", "3/3", "--work", "w", *machine).expect(0)
    bench.run(*words, "--shard", "auto", "--work", "w", env={"PMI_RANK": "0", "PMI_SIZE": "3"}).expect(0)
    missing = bench.run("merge", "w").expect(5)
    missing.expect_one_line("missing")
    commands = missing.out.splitlines()
    key_of = lambda command: re.search(" --piece ([0-9a-f]{16}) ", command)[1]
    check(commands and {key_of(command) for command in commands} <= {key for key, _, _ in pieces}, f"{commands}")
    check(not any((bench.folder / "two").iterdir()), "a merge of less than all wrote a file")
    for line in commands:
        check(shell(bench, line).returncode == 0, line)
    bench.run("merge", "w").expect(0)
    one, two = files_of(bench.folder / "one"), files_of(bench.folder / "two")
    check(one.keys() == two.keys() and one, f"{one.keys()} and {two.keys()}")
    for name, data in one.items():
        check(data == two[name], f"{name} has other bytes")
    return words


@case("pieces.of_a_reference_make_its_bytes", budget=13)
def reference(bench):
    """Draws a reference of several blocks whole and in pieces."""
    needs_embree(bench)
    one_and_pieces(bench, PICTURE, ("o.exr", "o.png"))


@case("pieces.of_the_passes_of_one_block_make_its_bytes", budget=10)
def passes(bench):
    """Many samples of few pixels are several pieces, and more samples of the same picture share them."""
    needs_embree(bench)
    words = ("render", "builtin:plate", "--backend", "reference", "--size", "4x4", "--env-size", "16", "--env-samples", "16", "-q")
    keys = {samples: [key for key, _, _ in pieces_of(bench, (*words, "--samples", str(samples), "-o", "o.exr"))] for samples in (131072, 196608)}
    check(len(keys[131072]) == 2 and len(keys[196608]) == 3 and keys[196608][:2] == keys[131072], f"{keys}")
    shutil.rmtree(bench.folder / "w", ignore_errors=True)
    one_and_pieces(bench, (*words, "--samples", "196608"), ("o.exr",))


@case("pieces.of_a_row_make_its_bytes", budget=5)
def row(bench):
    one_and_pieces(bench, ROW, ("o_%d.png", "o.exr".replace("o.", "o_%d."), "o.apng"))


@case("pieces.of_a_chart_make_its_bytes", budget=6)
def chart(bench):
    needs_embree(bench)
    one_and_pieces(bench, CHART, ("report",))


@case("pieces.of_baked_levels_make_their_bytes", budget=5)
def levels(bench):
    """Levels of each material, with colours and heights that the merge makes. Changed maps and options have other pieces."""
    words = ("bake", "mip", "builtin:bumps", "-q")
    one_and_pieces(bench, words, ("levels.mip",), machine=("--threads", "1"))
    (bench.folder / "one/levels.mip").unlink()
    words = pieces_of(bench, (*words, "-o", "a.mip")), pieces_of(bench, (*words, "--mip-filter", "ssgt", "-o", "a.mip"))
    check(not {key for key, _, _ in words[0]} & {key for key, _, _ in words[1]}, "another filter has the same pieces")
    # Materials with equal maps in textures of their own share a piece, and a file holds their levels once
    image = "data:image/png;base64," + base64.b64encode(gltf_files.png(8, 8, color=lambda x, y: (128 + 9 * x, 128 - 7 * y, 220))).decode()
    gltf = gltf_files.textured(image)
    gltf["meshes"][0]["primitives"] = [dict(gltf["meshes"][0]["primitives"][0], material=i) for i in range(3)]
    gltf["materials"] = [{"normalTexture": {"index": i}, "pbrMetallicRoughness": {"roughnessFactor": 0.3, "metallicFactor": int(i < 2)}} for i in range(3)]
    gltf["textures"], gltf["images"] = [{"source": i} for i in range(3)], [{"uri": image} for _ in range(3)]
    (bench.folder / "equal.gltf").write_text(gltf_files.text(gltf))
    words = ("bake", "mip", "equal.gltf", "-q", "--mip-gain", "on")
    bench.run(*words, "-o", "one.mip").expect(0)
    bench.run(*words, "-o", "two.mip", "--take", "--work", "e").expect(0)
    bench.run("merge", "e").expect(0)
    check((bench.folder / "one.mip").read_bytes() == (bench.folder / "two.mip").read_bytes(), "equal maps: other bytes")
    check(len(list((bench.folder / "e").glob("*.piece"))) == 2, "equal maps: a metal's and a dielectric's are not two pieces")
    # Another output of the same pieces is another job
    bench.run(*words, "-o", "three.mip", "--take", "--work", "e").expect(0)
    check(len(bench.run("merge", "e").expect(4).out.splitlines()) == 2, "two jobs")
    bench.run("bake", "direction", "a.png", "-o", "b.png", "--pieces").expect(2).expect_one_line("direction", "mip")


@case("pieces.of_a_timed_chart_keep_their_times")
def timed(bench):
    needs_embree(bench)
    words = (*CHART, "--runs", "2", "-o", "report")
    bench.run(*words, "--take", "--work", "w").expect(0)
    bench.run("merge", "w").expect(0)
    report = json.loads((bench.folder / "report/report.json").read_text())
    check(all(row["ms_median"] > 0 for row in report["rows"]) and report["machine"]["processor"], f"{report['machine']}")
    again = files_of(bench.folder / "report")
    bench.run("merge", "w", "-o", "other").expect(0)
    other = files_of(bench.folder / "other")
    check(again["report.csv"] == other["report.csv"] and again["report.html"] == other["report.html"], "a second merge made another report")


@case("pieces.damaged_or_of_another_version_are_named")
def damaged(bench):
    words = (*ROW, "-o", "o_%d.png")
    bench.run(*words, "--take", "--work", "w").expect(0)
    files = sorted((bench.folder / "w").glob("*.piece"))
    check(len(files) == 5, f"{files}")
    whole = files[0].read_bytes()
    files[0].write_bytes(whole[:-1] + b"?")
    found = bench.run("merge", "w").expect(5)
    check(files[0].name in found.err and "damaged" in found.err and files[0].stem in found.out, found.describe())
    version = whole[8:whole.index(b"\n")]
    files[0].write_bytes(whole.replace(version, b"0.0.1", 1))
    found = bench.run("merge", "w").expect(5)
    check("0.0.1" in found.err and not (bench.folder / "o_0.png").exists(), found.describe())
    check(shell(bench, found.out.strip()).returncode == 0 and files[0].read_bytes() == whole, "the printed command does not mend it")
    files[1].write_bytes(b"x")
    files[2].write_bytes(files[2].read_bytes()[:-1])
    bench.run(*words, "--take", "--work", "w").expect(0)
    bench.run("merge", "w").expect(0)
    job, = (bench.folder / "w").glob("job-*.json")
    text = job.read_text()
    job.write_text(text.replace(version.decode(), "0.0.1"))
    bench.run("merge", "w").expect(4).expect_one_line("0.0.1")
    job.write_text(re.sub('"build": "[0-9a-f]*"', '"build": "0123456789abcdef"', text))
    bench.run("merge", "w").expect(4).expect_one_line("another build")
    job.write_text("{")
    bench.run("merge", "w").expect(4).expect_one_line("is not a job")
    job.write_text(text)
    bench.run(*ROW[:-1], "--fov", "30", "-o", "o_%d.png", "--shard", "1/5", "--work", "w").expect(0)
    several = bench.run("merge", "w").expect(4)
    several.expect_one_line("several jobs")
    check(len(several.out.splitlines()) == 2, several.describe())
    check(shell(bench, next(line for line in several.out.splitlines() if "fov" not in line)).returncode == 0, "the command of one job fails")


@case("pieces.wrong_words_are_named", "input")
def wrong(bench):
    row = (*ROW, "-o", "o_%d.png")
    for words, needle in (((*row, "--shard", "0/4"), "1..4"), ((*row, "--shard", "5/4"), "1..4"), ((*row, "--shard", "1/0"), "1 or more"),
                          ((*row, "--shard", "auto"), "SLURM_ARRAY_TASK_ID"), ((*row, "--shard", "x"), "I/N"),
                          ((*row, "--shard", "1/2", "--take"), "--take"), ((*row, "--work", "w"), "--shard"),
                          ((*row, "--take", "--work", "a", "--work", "b"), "--merge"), ((*row, "--piece", "12", "--work", "w"), "no piece"),
                          ((*row, "--take", "--stats", "s.json"), "--stats"), (("render", "builtin:plate", "--pieces"), "--backend"),
                          ((*REFERENCE, "--checkpoint", "c.part", "--pieces"), "--checkpoint"),
                          ((*REFERENCE, "--target-error", "0.1", "--take"), "--target-error"), ((*row, "--budget-ms", "20", "--take"), "--budget-ms"),
                          (("submit", "--for", "mpi", "--", "render", "builtin:plate"), "no pieces"), (("submit", "--for", "mpi", "--", "render", "a.glb", "--size", "8192x8192", "--msaa", "1"), "no pieces"),
                          (("submit", "--for", "mpi", "--at-once", "2", "--", *row), "--at-once"),
                          (("submit", "--for", "github", "--shards", "257", "--", *row), "256"),
                          (("submit", "--for", "github", "--", "chart", "${{ secrets.all }}.glb", "-o", "r"), "{{"),
                          (("submit", "--for", "slurm", "--", "golden", "check", "m.json", "--jobs", "2"), "--jobs"),
                          ((*ROW, "-o", "\udcff_%d.png", "--take"), "UTF-8"),
                          (("submit", "--for", "k8s", "--", *ROW, "-o", "\udcff_%d.png"), "UTF-8"),
                          (("submit", "--for", "slurm", "--", "compare", "a.png", "b.png"), "no pieces"),
                          (("submit", "--for", "slurm", "--", "golden", "bless", "m.json"), "golden check have"),
                          (("submit", "--for", "slurm", "--", *row, "--take"), "options of pieces"),
                          (("submit", "--for", "mpi", "--", "render", "a.glb", "--backend", "reference", "--target-error=.1", "-o", "a.exr"), "--target-error"),
                          (("submit", "--for", "lsf", "--", *row), "slurm")):
        if "reference" in words:
            needs_embree(bench)
        bench.run(*words).expect(2).expect_one_line(needle)
    bench.run("merge", "none").expect(4).expect_one_line("none")
    (bench.folder / "empty").mkdir()
    bench.run("merge", "empty").expect(4).expect_one_line("holds no job")
    bench.run(*row, "--piece", "0123456789abcdef", "--work", "w").expect(2)
    check(not (bench.folder / "w").exists(), "a refused command leaves a job")
    bench.run("render", "gone.glb", *ROW[2:], "-o", "o_%d.png", "--shard", "1/2", "--work", "w").expect(4).expect_one_line("gone.glb")


def taken_and_killed(bench, words, output, kills, seed):
    """Workers take pieces; random ones die by kill -9 at random moments. The last ones finish, and a merge writes the one process' bytes."""
    bench.run(*words, "-o", "one." + output, "--threads", "1", timeout=400).expect(0)
    words, chance = (*words, "--threads", "1", "-o", "two." + output, "--take", "--work", "w"), random.Random(seed)
    start = lambda: subprocess.Popen([bench.program, *words], cwd=bench.folder, env=bench.environment({}), stdin=subprocess.DEVNULL,
                                     stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    workers, killed = [start(), start()], 0
    while killed < kills:
        time.sleep(chance.uniform(0.0, 0.4))
        at = chance.randrange(len(workers))
        workers[at].kill()
        killed += workers[at].wait() == -signal.SIGKILL
        workers[at] = start()
    for worker in workers:
        check(worker.wait(timeout=400) == 0, "a worker fails")
    bench.run("merge", "w").expect(0)
    check((bench.folder / ("one." + output)).read_bytes() == (bench.folder / ("two." + output)).read_bytes(), "other bytes after kills")
    check(not list((bench.folder / "w").glob("*.lease")), "a lease is left")


@case("pieces.survive_killed_workers", tier="nightly")
def killed(bench):
    """In quick, `unit_pieces.lease.of_a_dead_owner_is_taken_over` frees a dead worker's lease. In check,
    `pieces.damaged_or_of_another_version_are_named` refuses cut pieces."""
    needs_embree(bench)
    taken_and_killed(bench, (*PICTURE, "--samples", "65536"), "exr", 3, 5)


@case("pieces.survive_twenty_killed_workers", tier="nightly")
def killed_often(bench):
    needs_embree(bench)
    taken_and_killed(bench, (*PICTURE, "--samples", "262144"), "exr", 20, 6)


@case("pieces.of_a_full_disk_are_made_later")
def full_disk(bench):
    """A worker and a merge whose files may not grow: exit code 7, nothing half. The same commands again finish."""
    words = (*ROW, "-o", "o_%d.exr")
    bench.run(*words, "--take", "--work", "w", file_size=2048).expect(7)
    check(not list((bench.folder / "w").glob("*.piece")), "a piece is there")
    bench.run(*words, "--take", "--work", "w").expect(0)
    bench.run("merge", "w", file_size=2048).expect(7)
    check(not list(bench.folder.glob("o_*.exr")), "a picture is there")
    bench.run("merge", "w").expect(0)
    bench.run(*ROW, "-o", "one_%d.exr").expect(0)
    for i in range(5):
        check((bench.folder / f"o_{i}.exr").read_bytes() == (bench.folder / f"one_{i}.exr").read_bytes(), f"other bytes of picture {i}")


@case("pieces.on_a_disk_that_fills_are_made_later")
def disk_that_fills(bench):
    """A file system of 16 kB under a worker's pieces, then under the outputs of a merge."""
    words = (*ROW, "-o", "small/o_%d.exr")
    (bench.folder / "small").mkdir()

    def on_small_disk(*command):
        line = "mount -t tmpfs -o size=16k none small && " + shlex.join(map(str, (bench.program, *command)))
        done = subprocess.run(["unshare", "-m", "sh", "-c", line], cwd=bench.folder, env=bench.environment({}), stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=100)
        if "unshare" in done.stderr or "mount:" in done.stderr:
            raise Skipped("a file system needs the superuser: " + done.stderr)
        check(done.returncode == 7 and "No space left" in done.stderr, f"{command}: {done.returncode} {done.stderr}")

    on_small_disk(*words, "--take", "--work", "small")
    bench.run(*words, "--take", "--work", "w").expect(0)
    on_small_disk("merge", "w")
    check(not list((bench.folder / "small").iterdir()), "a picture is there")
    bench.run("merge", "w").expect(0)
    bench.run(*ROW, "-o", "one_%d.exr").expect(0)
    for i in range(5):
        check((bench.folder / f"small/o_{i}.exr").read_bytes() == (bench.folder / f"one_{i}.exr").read_bytes(), f"other bytes of picture {i}")


@case("pieces.of_a_worker_without_the_scene_are_made_by_others")
def no_scene(bench):
    shutil.copy(bench.data_file("models/AnisotropyStrengthTest.glb"), bench.folder / "s.glb")
    row = ("render", "s.glb", "--env", "builtin:studio", "--animate", "roughness=0.1:0.6", "--steps", "4", "--size", "24x16", "--env-size", "16", "-q")
    bench.run(*row, "-o", "one_%d.png").expect(0)
    job = (*row, "-o", "two_%d.png", "--work", bench.folder / "w")
    bench.run(*job, "--shard", "1/2").expect(0)
    (bench.folder / "elsewhere").mkdir()
    lost = subprocess.run([bench.program, *map(str, job), "--take"], cwd=bench.folder / "elsewhere", env=bench.environment({}), stdin=subprocess.DEVNULL, capture_output=True, text=True)
    check(lost.returncode == 4 and "s.glb" in lost.stderr, lost.stderr)
    bench.run(*job, "--take").expect(0)
    bench.run("merge", "w").expect(0)
    for i in range(4):
        check((bench.folder / f"one_{i}.png").read_bytes() == (bench.folder / f"two_{i}.png").read_bytes(), f"other bytes of picture {i}")
    # Another scene under the same path
    shutil.copy(bench.data_file("models/ClearCoatTest.glb"), bench.folder / "s.glb")
    other = bench.run(*job, "--merge").expect(5)
    other.expect_one_line("of another scene, job or program")
    check(len(other.out.splitlines()) == 4, other.out)


@case("pieces.merge_twice_at_once")
def twice(bench):
    words = (*ROW, "-o", "o_%d.png", "-o", "o.apng")
    bench.run(*words, "--take", "--work", "w").expect(0)
    merges = [subprocess.Popen([bench.program, "merge", "w"], cwd=bench.folder, env=bench.environment({}), stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for _ in range(2)]
    check([merge.wait(timeout=120) for merge in merges] == [0, 0], "a merge beside another fails")
    whole = (bench.folder / "o.apng").read_bytes()
    shutil.copytree(bench.folder / "w", bench.folder / "a")
    (bench.folder / "b").mkdir()
    for i, path in enumerate(sorted((bench.folder / "a").glob("*.piece"))):
        if i % 2:
            path.rename(bench.folder / "b" / path.name)
    for order in (("a", "b"), ("b", "a")):
        if order[0] == "b":
            shutil.copy(next((bench.folder / "a").glob("job-*.json")), bench.folder / "b")
        (bench.folder / "o.apng").unlink()
        bench.run("merge", *order).expect(0)
        check((bench.folder / "o.apng").read_bytes() == whole, f"{order} gives other bytes")


def keys(bench, *words):
    return [key for key, _, _ in pieces_of(bench, words)]


@case("pieces.have_keys_by_content", budget=6)
def content(bench):
    """Names of outputs, threads and messages change no key. Options and the content of files do, also where a path stays."""
    own = keys(bench, *ROW, "-o", "o_%d.png")
    for words in ((*ROW, "-o", "other_%d.png"), (*ROW, "-o", "o_%d.png", "-o", "p_%d.png", "-vt", "1"), (*ROW[:2], "-q", *ROW[2:-1], "-o", "o_%d.png", "--isa", "scalar")):
        check(keys(bench, *words) == own, f"{words} change keys")
    for words in ((*ROW, "-o", "o_%d.exr"), (*ROW, "-o", "o.apng"), (*ROW, "-o", "o_%d.png", "--exposure", "1"), (*ROW, "-o", "o_%d.png", "--technique", "mc"),
                  (*ROW, "-o", "o_%d.png", "--no-background"), (*ROW[:4], "--steps", "6", *ROW[6:], "-o", "o_%d.png")):
        check(not set(keys(bench, *words)) & set(own), f"{words} change no key")
    row = ("render", "builtin:plate", "--animate", "roughness=0.1:0.6", "--steps", "3", "--size", "24x16", "-q", "-o", "o_%d.png", "--env", "baked")
    found = []
    for samples in ("16", "64"):
        shutil.rmtree(bench.folder / "baked", ignore_errors=True)
        bench.run("bake", "environment", "builtin:sky", "--env-size", "16", "--env-samples", samples, "-q", "-o", "baked").expect(0)
        found.append(keys(bench, *row))
    check(not set(found[0]) & set(found[1]), "another bake of the same light changes no key")
    # Scenes with equal triangles in other objects, and folders with equal files of other names
    pictures = ("render", "scene.gltf", "--size", "32x32", "-q", "--band-rows", "16", "--orbit", "0,0", "--aov", "object-id", "-o", "o.exr")
    found = []
    for nodes in (1, 2):
        gltf = gltf_files.triangle()
        mesh = gltf["meshes"][0]
        if nodes == 1:
            mesh["primitives"] = 2 * mesh["primitives"]
        else:
            gltf["nodes"], gltf["scenes"] = 2 * gltf["nodes"], [{"nodes": [0, 1]}]
        (bench.folder / "scene.gltf").write_text(gltf_files.text(gltf))
        found.append(keys(bench, *pictures))
    check(not set(found[0]) & set(found[1]), "another split into objects changes no key")
    material = ("--material", "maps")
    found = []
    for name in ("wood_normal.png", "wood_roughness.png"):
        shutil.rmtree(bench.folder / "maps", ignore_errors=True)
        (bench.folder / "maps").mkdir()
        (bench.folder / "maps" / name).write_bytes(gltf_files.png(4, 4))
        found.append(keys(bench, "render", "builtin:sphere", *material, "--size", "32x32", "-q", "--band-rows", "16", "-o", "o.exr"))
    check(not set(found[0]) & set(found[1]), "another name of a map changes no key")


@case("pieces.of_another_renderer_are_others")
def renderer(bench):
    needs_embree(bench)
    row = ("render", "builtin:plate", "--animate", "roughness=0.1:0.6", "--steps", "3", "--size", "24x16", "-q", "-o", "o_%d.exr")
    own = keys(bench, *row)
    check(not set(keys(bench, *row, "--backend", "reference")) & set(own), "the reference's pictures have the keys of the tile renderer's")


@case("pieces.of_one_kind_are_made_twice_at_once", budget=15)
def at_once(bench):
    """Two processes do the same work at once, three times, to meet in each file."""
    needs_embree(bench)
    for words in ((*ROW[:4], "--steps", "20", *ROW[6:], "-o", "a_%d.png", "-o", "a_%d.exr"), (*CHART, "-o", "report")):
        for _ in range(3):
            shutil.rmtree(bench.folder / "w", ignore_errors=True)
            both = [subprocess.Popen([bench.program, *words, "--shard", "1/1", "--work", "w"], cwd=bench.folder, env=bench.environment({}),
                                     stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) for _ in range(2)]
            check([one.wait(timeout=200) for one in both] == [0, 0], "one of two equal shares fails")
        bench.run("merge", "w").expect(0)


@case("pieces.in_several_folders_are_found")
def folders(bench):
    words = (*ROW, "-o", "o_%d.png")
    bench.run(*words, "--take", "--work", "b").expect(0)
    first, *others = sorted((bench.folder / "b").glob("*.piece"))
    (bench.folder / "a").mkdir()
    (bench.folder / "a" / first.name).write_bytes(b"damaged")
    (bench.folder / "a" / (others[0].name + ".lease")).write_text("elsewhere 1 0000000000000000 4\n")
    (bench.folder / "b" / (first.name + ".0123456789abcdef.png")).write_bytes(b"half")
    bench.run("merge", "a", "b", "-o", "other_%d.png").expect(0)
    check((bench.folder / "other_3.png").read_bytes() == (bench.folder / "o_3.png").read_bytes(), "a further output is another picture")
    check(bench.run("merge", "a").expect(4).err, "a folder without a job merges")
    left = [path.name for folder in "ab" for path in (bench.folder / folder).iterdir() if ".piece." in path.name]
    check(not left, f"left: {left}")


def have_scripts(bench, *jobs):
    for job in jobs:
        check("--merge" in bench.run("submit", "--for", "slurm", "--", *job).expect(0).out, f"{job} has no script")


@case("pieces.scripts_for_engines_are_what_the_engines_read")
def scripts(bench):
    import yaml
    words = ("chart", "my #1: it's.glb", "--runs", "0", "-o", "r")
    text = {engine: bench.run("submit", "--for", engine, "--shards", "3", "--work", "my, pieces", "--", *words).expect(0).out
            for engine in ("slurm", "mpi", "parallel", "k8s", "openjd", "github")}
    have_scripts(bench, ("render", "a.glb", "--size", "20000x300", "-o", "a.png"), ("render", "a.glb", "--size=300x20000", "-o", "a.png"),
                 ("render", "a.glb", "--band-rows", "64", "-o", "a.png"), ("render", "a.glb", "--size", "8192x8192", "-o", "a.png"),
                 ("render", "a.glb", "--size", "8192x8192", "--msaa=16", "-o", "a.png"), ("bake", "mip", "maps", "-o", "m.mip"))
    for engine in ("slurm", "mpi", "parallel"):
        done = subprocess.run(["sh", "-n"], input=text[engine], capture_output=True, text=True)
        check(done.returncode == 0, done.stderr)
    github = yaml.safe_load(text["github"])["jobs"]
    check(github["pieces"]["steps"][1]["run"].startswith("burnish chart 'my #1: it'\\''s.glb' ") and github["pieces"]["steps"][2]["with"]["path"] == "my, pieces", text["github"])
    check(github["merge"]["needs"] == "pieces" and github["pieces"]["strategy"]["matrix"]["share"] == [1, 2, 3], text["github"])
    k8s, waits = yaml.safe_load_all(text["k8s"])
    line_of = lambda job: job["spec"]["template"]["spec"]["containers"][0]["command"][2].replace("$$", "$") # as Kubernetes does
    shell_line = line_of(k8s)
    check(shlex.split(shell_line)[1:7] == list(words) and shlex.split(shell_line)[7] == "--take" and k8s["spec"]["completions"] == 3, text["k8s"])
    merges = line_of(waits)
    check(subprocess.run(["sh", "-n"], input=merges, text=True).returncode == 0 and merges.startswith(shell_line) and "--merge" in merges, merges)
    openjd = yaml.safe_load(text["openjd"])
    check(openjd["steps"][0]["script"]["actions"]["onRun"]["args"][:6] == list(words) and openjd["steps"][1]["dependencies"] == [{"dependsOn": "pieces"}], text["openjd"])
