"""Outputs are complete, repeatable and without volatile data. Failed outputs are reported and leave no trace."""

import json
import os
import re
import shutil
import struct
import subprocess
import sys
import time

import gltf_files as files
from environment_files import small_sky
from harness import SMALL, Skipped, case, check, scratch

MAGIC = {
    "a.exr": b"\x76\x2f\x31\x01",
    "a.hdr": b"#?RADIANCE",
    "a.pfm": b"PF",
    "a.png": b"\x89PNG",
    "a.jpg": b"\xff\xd8\xff",
    "a.tif": (b"II*\0", b"MM\0*"),
}


@case("output.several_files_are_written_at_once", "input")
def several(bench):
    outputs = [word for name in MAGIC for word in ("-o", name)]
    done = bench.run("render", *SMALL, *outputs, "--stats", "s.json", "--trace", "t.json").expect(0)
    for name, magic in MAGIC.items():
        check((bench.folder / name).read_bytes().startswith(magic), f"{name} does not begin like its format")
        check(name in done.err, f"{name} is not announced\n{done.describe()}")
    check(bench.left_behind() == sorted([*MAGIC, "s.json", "t.json"]), f"more was written: {bench.left_behind()}")


STATS = {
    "scene": str, "env": str, "technique": str, "samples": int, "backend": str, "device": str, "isa": str, "threads": int,
    "width": int, "height": int, "msaa": int, "frames": int, "ms_min": float, "ms_median": float, "ms_p95": float,
    "load_ms": float, "bake_ms": float, "triangles": int, "visible_fragments": int, "pixel_hash": str, "nan_pixels": int,
    "peak_memory_bytes": int, "version": str,
}


@case("output.stats_hold_every_figure")
def stats(bench):
    found = bench.figures(*SMALL, "--frames", "5", "--threads", "2")
    for key, kind in STATS.items():
        value = found.get(key)
        check(isinstance(value, (int, float) if kind is float else kind), f"{key} is {value!r}")
    expected = {"scene": "builtin:teapot", "env": "builtin:studio", "technique": "auto", "backend": "tile",
                "threads": 2, "width": 160, "height": 120, "msaa": 4, "frames": 5, "nan_pixels": 0}
    for key, value in expected.items():
        check(found[key] == value, f"{key} is {found[key]!r}, not {value!r}")
    check(0 < found["ms_min"] <= found["ms_median"] <= found["ms_p95"], f"times out of order: {found}")
    check(found["triangles"] > 1000 and found["visible_fragments"] > 1000, f"an empty picture: {found}")
    check(len(found["pixel_hash"]) == 16 and int(found["pixel_hash"], 16) != 0, found["pixel_hash"])
    check(1 << 20 < found["peak_memory_bytes"] < 8 << 30, f"peak memory {found['peak_memory_bytes']}")


def tiff_pixels(path):
    """Returns the pixels of a TIFF file by the program, 8 bits RGBA, each as (r, g, b, a)."""
    data = path.read_bytes()
    fields = {}
    for i in range(int.from_bytes(data[8:10], "little")):
        tag, kind, _, value = struct.unpack_from("<HHII", data, 10 + 12 * i)
        fields[tag] = value & 0xFFFF if kind == 3 else value
    check(fields[277] == 4, f"{fields[277]} channels")
    check(fields[338] == 2, f"alpha of kind {fields[338]}")
    begin = fields[273]
    return [tuple(data[i : i + 4]) for i in range(begin, begin + fields[279], 4)]


ROUGH_BALL = ("render", "builtin:sphere", "--size", "64x64", "--msaa", "8", "--env-size", "32", "--env-samples", "16", "--roughness", "0.9",
              "--technique", "split_isotropic", "--tonemap", "none", "--no-background", "-q")


@case("output.without_a_background_alpha_is_coverage")
def alpha(bench):
    bench.run(*ROUGH_BALL, "-o", "a.tif", "-o", "a.exr", "-o", "a.pfm").expect(0)
    pixels = tiff_pixels(bench.folder / "a.tif")
    check(pixels[0] == (0, 0, 0, 0), f"a corner is {pixels[0]}")
    check(pixels[32 * 64 + 32][3] == 255, f"the middle is {pixels[32 * 64 + 32]}")
    edge = {pixel[3] for pixel in pixels} - {0, 255}
    check(len(edge) >= 5 and all(min(abs(a - 255 * k / 8) for k in range(9)) < 1 for a in edge), f"edges are {sorted(edge)}")
    for y in range(1, 63):  # a rough sphere: without alpha the edge is as bright as the inside
        row = pixels[64 * y : 64 * y + 64]
        inside = [x for x in range(64) if row[x][3] == 255]
        if inside and 0 < row[inside[0] - 1][3] < 255:
            edge, next_to = row[inside[0] - 1], row[inside[0]]
            check(all(edge[c] >= next_to[c] - 24 for c in range(3)), f"row {y}: {edge} beside {next_to}")


@case("output.alpha_of_a_device_is_that_of_the_tile_renderer", tier="nightly")
def device_alpha(bench):
    done = bench.run(*ROUGH_BALL, "--backend", "vulkan", "-o", "v.tif")
    if done.code == 77:
        raise Skipped("no device")
    done.expect(0)
    bench.run(*ROUGH_BALL, "-o", "a.tif").expect(0)
    check(tiff_pixels(bench.folder / "v.tif") == tiff_pixels(bench.folder / "a.tif"), "Vulkan's alpha is another")


@case("output.the_reference_has_the_alpha_of_the_tile_renderer")
def reference_alpha(bench):
    drawn = ("render", "builtin:sphere", "--size", "48x48", "--msaa", "4", "--env-size", "32", "--roughness", "0.9", "--no-background", "-q")
    done = bench.run(*drawn, "--backend", "reference", "--samples", "64", "-o", "r.tif", "-o", "r.exr", "-o", "r.png")
    if done.code == 77:
        raise Skipped("built without the reference")
    check(done.expect(0).err == "", done.describe())
    bench.run(*drawn, "-o", "t.tif", "-o", "t.exr").expect(0)
    reference, tile = (tiff_pixels(bench.folder / f"{name}.tif") for name in "rt")
    off = sum(a[3] != b[3] for a, b in zip(reference, tile))
    check(off <= 2, f"alpha of {off} pixels is another")  # rays meet edges in floats, not on a grid of 1/256 pixel
    check(len({a[3] for a in reference}) == 5, "a pixel has four samples")
    found = json.loads(bench.run("compare", "r.exr", "t.exr", "--json", "-").expect(0).out)
    check(found["flip_mean"] < 0.1, f"{found}")
    # with a background the sample option has no effect, and a warning says so
    done = bench.run("render", "builtin:sphere", "--size", "16x16", "--env-size", "32", "--backend", "reference", "--samples", "4", "--msaa", "4").expect(0)
    check("--msaa has no effect" in done.err, done.describe())


@case("output.numbers_are_written_as_they_were_given")
def shortest(bench):
    """A float of 0.4 is 0.4, not 0.4000000059604645."""
    text = bench.run("render", *SMALL, "--roughness", "0.4", "--anisotropy", "0.3", "--exposure", "0.1", "--stats", "-", "-q").expect(0).out
    for line in ('"roughness": 0.4,', '"anisotropy": 0.3,', '"axis_beta": 2.3,'):
        check(line in text, f"{line} is not in {text}")
    text += bench.run("info", "--env", "builtin:sky", "--json").expect(0).out
    direction = re.search(r'"direction": \[(.*?)\]', text, re.S)[1]
    check(all(len(number.strip().lstrip("-")) <= 12 for number in direction.split(",")), direction)


@case("output.words_go_to_stderr")
def words(bench):
    done = bench.run("render", *SMALL, "--stats", "s.json").expect(0)
    found = json.loads((bench.folder / "s.json").read_text())
    check(f"pixel hash: {found['pixel_hash']}\n" in done.err, f"no hash line\n{done.describe()}")
    for word in ("builtin:teapot", "triangles", "builtin:studio", "frame", "s.json"):
        check(word in done.err, f"'{word}' is not said\n{done.describe()}")
    check(done.out == "" and "\x1b" not in done.err and "\r" not in done.err, done.describe())
    quiet = bench.run("render", *SMALL, "--quiet").expect(0)
    check(quiet.out == "" and quiet.err == "", f"--quiet speaks\n{quiet.describe()}")
    more = bench.run("render", *SMALL, "-v").expect(0)
    check("world to clip" in more.err, f"-v does not print the camera\n{more.describe()}")


@case("output.trace_shows_every_stage")
def trace(bench):
    bench.run("render", *SMALL, "--threads", "2", "--trace", "t.json").expect(0)
    loaded = json.loads((bench.folder / "t.json").read_text())
    events = loaded["traceEvents"] if isinstance(loaded, dict) else loaded
    spans = [event for event in events if event.get("ph") == "X"]
    names = {event["name"] for event in spans}
    check({"load scene", "environment", "frame"} <= names, f"stages are missing: {sorted(names)}")
    check(all(event["dur"] >= 0 and "tid" in event and "ts" in event for event in spans), "a span without its time")


@case("output.two_runs_give_the_same_bytes")
def same_bytes(bench):
    for folder in ("one", "another_folder"):
        (bench.folder / folder).mkdir()
        threads = ("--threads", "1") if folder == "one" else ()
        bench.run("render", *SMALL, *threads, "-o", f"{folder}/a.exr", "-o", f"{folder}/a.png",
                  "-o", f"{folder}/a.hdr", "-o", f"{folder}/a.tif", "-o", f"{folder}/a.jpg").expect(0)
        time.sleep(1.1)  # dates in files count seconds
    for name in ("a.exr", "a.png", "a.hdr", "a.tif", "a.jpg"):
        one, other = ((bench.folder / folder / name).read_bytes() for folder in ("one", "another_folder"))
        check(one == other, f"{name} differs between two runs")
        for volatile in (b"DateTime", b"HostComputer", b"render ", b"another_folder"):
            check(volatile not in one, f"{name} holds {volatile!r}")


@case("output.exr_holds_linear_float")
def exr_is_float(bench):
    tool = shutil.which("oiiotool")
    if not tool:
        raise Skipped("no oiiotool")
    bench.run("render", *SMALL, "-o", "a.exr").expect(0)
    said = subprocess.run([tool, "--info", "-v", str(bench.folder / "a.exr")], capture_output=True, text=True, timeout=60,
                          check=True).stdout
    for word in ("160 x  120", "3 channel", "float"):
        check(word in said, f"'{word}' is not in\n{said}")
    check("half" not in said, said)


@case("output.file_size_limit_keeps_what_was_there", "input")
def file_size_limit(bench):
    """The EXR does not fit, the small PNG does."""
    kept = scratch(bench, "old.exr", b"kept")
    done = bench.run("render", *SMALL, "--quiet", "-o", "old.exr", file_size=2048)
    done.expect(7).expect_one_line("old.exr")
    check(kept.read_bytes() == b"kept", "the file that was there is lost")
    done = bench.run("render", *SMALL, "--quiet", "-o", "big.exr", "-o", "small.png", "--stats", "s.json", file_size=65536)
    done.expect(7).expect_one_line("big.exr")
    check(bench.left_behind() == ["old.exr", "s.json", "small.png"], f"left: {bench.left_behind()}")


@case("output.full_disk_keeps_what_was_there", "input")
def full_disk(bench):
    """A disk of 64 KB in a separate mount namespace, which ends with the shell."""
    disk = bench.folder / "disk"
    disk.mkdir()
    probe = ["unshare", "--mount"] + (["--map-root-user"] if os.geteuid() else []) + ["sh", "-c"]
    mount = 'mount -t tmpfs -o size=64k none "$0" || exit 99; cd "$0" || exit 99; '
    try:
        tried = subprocess.run([*probe, mount + "true", str(disk)], capture_output=True, timeout=60, check=False)
    except FileNotFoundError:
        raise Skipped("no unshare") from None
    if tried.returncode:
        raise Skipped(f"no small disk can be mounted here: {tried.stderr.decode().strip()}")
    bench.figures(*SMALL)  # the environment goes to the cache, not to the small disk
    script = mount + 'echo kept > old.exr; "$@"; code=$?; ls -A; cat old.exr; exit $code'
    done = subprocess.run([*probe, script, str(disk), bench.program, "render", *SMALL, "--quiet", "-o", "old.exr", "-o", "new.exr"],
                          capture_output=True, text=True, env=bench.environment({}), timeout=600, check=False)
    check(done.returncode == 7, f"exit code {done.returncode}: {done.stderr}")
    check(done.stdout == "old.exr\nkept\n", f"on the disk: {done.stdout!r}")
    lines = done.stderr.splitlines()
    check(len(lines) == 2 and all(name in done.stderr for name in ("old.exr", "new.exr")), done.stderr)


@case("output.paths_are_checked_before_the_work")
def checked_before(bench):
    begin_limit = 5.0
    (bench.folder / "folder.exr").mkdir()
    for path, code in (("absent/a.exr", 7), ("folder.exr", 7), ("a.xyz", 2)):
        done = bench.run("render", "--size", "4096x4096", "-o", path).expect(code).expect_one_line(path)
        check(done.seconds < begin_limit, f"rendered before looking: {done.seconds:.1f} s")
    for option in ("--stats", "--trace"):
        bench.run("render", option, "absent/a.json").expect(7).expect_one_line("absent/a.json")
    check(bench.left_behind() == ["folder.exr"], f"left: {bench.left_behind()}")


@case("output.an_input_is_never_overwritten")
def input_kept(bench):
    bench.run("render", *SMALL, "-o", "env.exr").expect(0)
    before = (bench.folder / "env.exr").read_bytes()
    (bench.folder / "same.exr").symlink_to("env.exr")
    for path in ("env.exr", "./env.exr", "same.exr"):
        bench.run("render", *SMALL, "--env", "env.exr", "-o", path).expect(2).expect_one_line(path)
    check((bench.folder / "env.exr").read_bytes() == before, "the environment was overwritten")
    scene = scratch(bench, "scene.gltf", files.text(files.triangle()))
    bench.run("render", scene, *SMALL, "--stats", "scene.gltf").expect(2)
    check(scene.read_text() == files.text(files.triangle()), "the scene was overwritten")
    picture = scratch(bench, "maps/wood.png", files.png(4, 4))
    binary = scratch(bench, "mesh.bin", files.POSITIONS + files.INDICES)
    gltf = files.textured("maps/wood.png")
    gltf["buffers"][0]["uri"] = "mesh.bin"
    scratch(bench, "textured.gltf", files.text(gltf))
    bench.run("render", "textured.gltf", *SMALL, "-o", "fine.png").expect(0)
    for words in (("-o", "maps/wood.png"), ("--stats", "mesh.bin"), ("--trace", "maps/../mesh.bin")):
        bench.run("render", "textured.gltf", *SMALL, *words).expect(2).expect_one_line(words[1])
    check(picture.read_bytes() == files.png(4, 4), "a texture was overwritten")
    check(binary.read_bytes() == files.POSITIONS + files.INDICES, "a buffer was overwritten")


@case("output.a_file_is_named_once")
def named_once(bench):
    (bench.folder / "sub").mkdir()
    (bench.folder / "link").symlink_to("sub")
    for one, other in (("a.exr", "a.exr"), ("a.exr", "./a.exr"), ("sub/a.exr", "link/a.exr")):
        bench.run("render", *SMALL, "-o", one, "-o", other).expect(2).expect_one_line("twice")
    check(bench.left_behind() == ["link", "sub"], f"left: {bench.left_behind()}")


@case("output.a_failed_run_keeps_what_was_there")
def failed_run(bench):
    kept = scratch(bench, "a.png", b"kept")
    bench.run("render", "absent.glb", "-o", "a.png").expect(4)
    check(kept.read_bytes() == b"kept", "the picture that was there is lost")


@case("output.devices_are_written_into")
def devices(bench):
    """Uses names that a fault could not harm: links in the case's folder, and /proc."""
    done = bench.run("render", *SMALL, "--quiet", "--stats", "/proc/self/fd/1").expect(0)
    check('"pixel_hash"' in done.out, done.describe())
    for name in ("stats", "trace"):
        (bench.folder / name).symlink_to("/dev/null")
    bench.run("render", *SMALL, "--stats", "stats", "--trace", "trace").expect(0)
    for name in ("stats", "trace"):
        check((bench.folder / name).is_symlink(), f"the link {name} was replaced")
    (bench.folder / "picture.exr").symlink_to("/dev/null")
    bench.run("render", *SMALL, "-o", "picture.exr").expect(7).expect_one_line("picture.exr")


@case("output.cache_is_optional")
def cache(bench):
    """A cache folder that is not writable, or holds rubbish, never stops a render."""
    elsewhere = {"XDG_CACHE_HOME": str(bench.folder / "cache")}
    words = ("builtin:sphere", "--size", "64x48", "--msaa", "1", *small_sky(bench))
    first = bench.figures(*words, env=elsewhere)
    again = bench.figures(*words, env=elsewhere)
    check(not first["environment_from_cache"] and again["environment_from_cache"], "the second run does not use the cache")
    without = bench.figures(*words, "--no-cache", env=elsewhere)
    check(not without["environment_from_cache"], "--no-cache reads the cache")
    for path in (bench.folder / "cache").rglob("*"):
        if path.is_file():
            path.write_bytes(path.read_bytes()[:100])
    damaged = bench.figures(*words, env=elsewhere)
    scratch(bench, "file", b"")
    nowhere = bench.figures(*words, env={"XDG_CACHE_HOME": str(bench.folder / "file")})
    hashes = {found["pixel_hash"] for found in (first, again, without, damaged, nowhere)}
    check(len(hashes) == 1, f"the cache changes the picture: {hashes}")


@case("output.contact_shadows_are_kept_between_runs", budget=6)
def contact_shadows(bench):
    own = {"XDG_CACHE_HOME": str(bench.folder / "cache")}
    words = ("builtin:plate", "--size", "64x36", "--env-size", "16", "--env-samples", "16")

    def drawn(*more):
        found = bench.figures(*words, *more, "--trace", "trace.json", env=own)
        return found["pixel_hash"], "contact shadows" in (bench.folder / "trace.json").read_text()

    first, traced = drawn()
    check(traced, "the first run traces no rays")
    kept = list((bench.folder / "cache/burnish").glob("sky-*.vis"))
    check(len(kept) == 1, f"the cache holds {kept}")
    check(drawn() == (first, False), "the second run traces rays, or draws another picture")
    check(drawn("--no-cache") == (first, True), "--no-cache reads the cache, or draws another picture")
    check(drawn("--roughness", "0.5")[1] is False, "a material's roughness hides no sky")
    whole = kept[0].read_bytes()
    kept[0].write_bytes(whole[:-1] + bytes([whole[-1] ^ 1]))
    check(drawn() == (first, True), "a damaged file is read")
    check(kept[0].read_bytes() == whole, "the damaged file is not made anew")


def same_in_locales(bench, commands, least):
    """Numbers are read and written with a point, even if the user's locale has a comma. least: number of files that the commands make."""
    folder = bench.folder / "locales"
    folder.mkdir()
    try:
        subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", str(folder / "de_DE.UTF-8")], capture_output=True, timeout=60, check=False)
    except FileNotFoundError:
        raise Skipped("no localedef") from None
    german = {"LOCPATH": str(folder), "LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8"}
    probe = [sys.executable, "-c", "import locale; locale.setlocale(locale.LC_ALL, ''); print(locale.localeconv()['decimal_point'])"]
    if subprocess.run(probe, env={**os.environ, **german}, capture_output=True, text=True, timeout=60, check=False).stdout.strip() != ",":
        raise Skipped("no locale with a decimal comma can be made here")
    found = []
    for env in ({}, german):
        outs = [bench.run(*words, env=env).expect(0).out for words in commands]
        made = {path: path.read_bytes() for path in sorted(bench.folder.rglob("*")) if path.is_file() and folder not in path.parents}
        found.append((outs, made))
        check(len(made) >= least, f"{sorted(made)}")
    check(found[0] == found[1], "another locale, other bytes")


@case("output.locales_change_no_byte")
def locales(bench):
    same_in_locales(bench, (("render", "builtin:plate", *SMALL, "--roughness", "0.25", "--exposure", "-0.5", "-q", "-o", "a.png", "-o", "a.pfm"),
                            ("compare", "a.png", "a.png", "--json", "-"),
                            ("bake", "mip", "builtin:roofs=1", "--mip-kappa", "0.5", "--format", "png-levels", "-o", "levels", "-q"),
                            ("list", "extensions")), 5)
