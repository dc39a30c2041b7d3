"""Output files: leftovers of killed runs do no harm, permissions and links stay, and cache files belong to the user."""

import fcntl
import os
import pathlib
import shutil
import subprocess

from environment_files import small_sky
from harness import SMALL, Skipped, case, check, scratch

TEMPORARY = ".o.png.0123456789abcdef.bntmp"


def in_new_namespace(bench, *arguments):
    """Runs as process 1 or 2 of a new namespace, like in a container, where pids repeat."""
    command = ["unshare", "--pid", "--fork", "--mount-proc"] + (["--map-root-user"] if os.geteuid() else [])
    try:
        probe = subprocess.run([*command, "true"], capture_output=True, timeout=60, check=False)
    except FileNotFoundError:
        raise Skipped("no unshare") from None
    if probe.returncode:
        raise Skipped(f"no namespace here: {probe.stderr.decode().strip()}")
    return subprocess.run([*command, bench.program, *map(str, arguments)], cwd=bench.folder, env=bench.environment({}),
                          capture_output=True, text=True, timeout=300, check=False)


@case("file.leftovers_do_not_stand_in_the_way")
def leftovers(bench):
    for pid in (1, 2):
        for number in range(4):
            scratch(bench, f".o.png.{pid}.{number}.tmp", b"of a run that was killed")
    scratch(bench, TEMPORARY, b"of another")
    scratch(bench, ".other.png.1.0.tmp", b"of another picture")
    scratch(bench, ".o.png.txt.tmp", b"of another program")
    done = in_new_namespace(bench, "render", *SMALL, "--quiet", "-o", "o.png")
    check(done.returncode == 0, f"exit code {done.returncode}: {done.stderr}")
    check(bench.left_behind() == [".o.png.txt.tmp", ".other.png.1.0.tmp", "o.png"], f"left: {bench.left_behind()}")


@case("file.a_living_writer_keeps_its_file")
def living_writer(bench):
    path = scratch(bench, TEMPORARY, b"being written")
    with open(path, "rb") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        bench.run("render", *SMALL, "-o", "o.png").expect(0)
        check(path.read_bytes() == b"being written", "the file of a living process was removed")
    bench.run("render", *SMALL, "-o", "o.png").expect(0)
    check(bench.left_behind() == ["o.png"], f"left: {bench.left_behind()}")


@case("file.permissions_are_kept")
def permissions(bench):
    for mode in (0o600, 0o640, 0o755, 0o666):
        path = scratch(bench, "o.png", b"there before")
        path.chmod(mode)
        bench.run("render", *SMALL, "-o", "o.png", "--stats", "s.json").expect(0)
        check(path.stat().st_mode & 0o777 == mode, f"{mode:o} became {path.stat().st_mode & 0o777:o}")
        check(path.read_bytes().startswith(b"\x89PNG"), "nothing was written")
    umask = os.umask(0)
    os.umask(umask)
    check((bench.folder / "s.json").stat().st_mode & 0o777 == 0o666 & ~umask, "a new file has other permissions than others")


def cache_of(bench, *words):
    """Returns a new cache for the case with one environment, after a picture by these options, and its file."""
    cache = bench.folder / "cache"
    bench.run("render", *words, env={"XDG_CACHE_HOME": str(cache)}).expect(0)
    files = sorted((cache / "burnish").glob("environment-*.bnenv"))
    check(len(files) == 1, f"the cache holds {files}")
    return {"XDG_CACHE_HOME": str(cache)}, files[0]


@case("file.leftovers_in_the_cache_count_and_go", budget=4)
def cache_leftovers(bench):
    env, kept = cache_of(bench, *SMALL)
    for name in (f".{kept.name}.77.0.tmp", f".{kept.name}.00112233445566ff.bntmp"):
        scratch(bench, kept.parent.relative_to(bench.folder) / name, bytes(1 << 20))
    said = bench.run("info", env=env).expect(0).out
    check(": 4 files" in said, f"leftovers are not seen by info\n{said}")
    kept.unlink()
    bench.run("render", *SMALL, env=env).expect(0)
    names = {name.split("-")[0] for name in os.listdir(kept.parent)}
    check(len(os.listdir(kept.parent)) == 3 and names == {"environment", "locks", "sky"}, f"the cache holds {os.listdir(kept.parent)}")


@case("file.what_stands_at_a_cache_file_s_name_is_replaced")
def cache_intruders(bench):
    words = ("builtin:sphere", "--size", "64x48", "--msaa", "1", *small_sky(bench))
    env, kept = cache_of(bench, *words)
    whole = kept.read_bytes()
    target = scratch(bench, "precious", b"precious")

    def link():
        kept.symlink_to(target)

    def fifo():
        os.mkfifo(kept)

    for put in (link, fifo):
        kept.unlink()
        put()
        bench.run("render", *words, env=env, timeout=30.0).expect(0)
        check(target.read_bytes() == b"precious", "the target of a link in the cache was overwritten")
        check(kept.is_file() and not kept.is_symlink() and kept.read_bytes() == whole, "the cache file was not made anew")
    other = pathlib.Path(shutil.copy(kept, bench.folder / "elsewhere"))
    kept.unlink()
    kept.symlink_to(other)
    found = bench.figures(*words, env=env)
    check(not found["environment_from_cache"], "a link in the cache was read")


@case("file.names_that_cannot_be")
def impossible_names(bench):
    (bench.folder / "a.png").symlink_to("b.png")
    (bench.folder / "b.png").symlink_to("a.png")
    scratch(bench, "file", b"")
    for name in ("n" * 300 + ".png", "a.png", "file/o.png", "/".join(["x" * 200] * 30) + ".png"):
        bench.run("render", *SMALL, "-o", name).expect(7).expect_one_line(name[:100])
        bench.run("render", *SMALL, "--stats", name).expect(7).expect_one_line(name[:100])
    check(bench.left_behind() == ["a.png", "b.png", "file"], f"left: {bench.left_behind()}")


@case("file.names_that_cannot_be_by_every_option", tier="nightly")
def impossible_names_everywhere(bench):
    """Outputs end with 7 and inputs with 4, in one line with the name, by every option that names a file."""
    (bench.folder / "a.png").symlink_to("b.png")
    (bench.folder / "b.png").symlink_to("a.png")
    scratch(bench, "file", b"")
    bench.run("render", *SMALL, "-o", "p.pfm").expect(0)
    before = sorted(bench.left_behind())
    compare = ("compare", "p.pfm", "p.pfm")
    for stem in ("n" * 300, "a", "file/o", "/".join(["x" * 200] * 30)):
        name = lambda ending: stem + ending
        for words in (("render", *SMALL, "--trace", name(".json")), ("render", *SMALL, "--risks", name(".png")), (*compare, "--json", name(".json")),
                      (*compare, "--html", name(".html")), (*compare, "--error-map", name(".png")), ("bake", "mip", "builtin:bumps", "-o", name(".mip")),
                      ("export", "glsl", "--technique", "bent_normal", "-o", name(".glsl"))):
            if stem != "a" or words[-1] == "a.png":
                bench.run(*words).expect(7).expect_one_line(words[-1][:100])
        for words in (("render", name(".gltf")), ("render", *SMALL, "--env", name(".exr")), ("render", *SMALL, "--normal-map", name(".png")),
                      ("render", "builtin:bumps", "--mip-pyramid", name(".mip")), ("compare", "p.pfm", name(".png"))):
            bench.run(*words).expect(4).expect_one_line(words[-1][:100])
    check(sorted(bench.left_behind()) == before, f"left: {bench.left_behind()}")


# A link, its target, and the place of the file written through the link; None: exit code 7.
LINKS = (("l.png", "missing.png", "missing.png"), ("l.png", "sub/missing.png", "sub/missing.png"), ("sub/l.png", "../missing.png", "missing.png"),
         ("l.png", "{}/sub/whole.png", "sub/whole.png"), ("l.png", "m.png", "sub/end.png"), ("l.png", "gone/missing.png", None),
         ("l.png", "l.png", None), ("l.png", "sub", None), ("l.png", "there.png", "there.png"))


@case("file.links_that_lead_nowhere_yet_keep_pointing")
def dangling_links(bench):
    bench.run("render", *SMALL, "-q", "-o", "o.png").expect(0)
    whole = (bench.folder / "o.png").read_bytes()
    (bench.folder / "sub").mkdir()
    (bench.folder / "m.png").symlink_to("sub/end.png")
    for name, to, place in LINKS:
        scratch(bench, "there.png", b"before")
        link = bench.folder / name
        link.symlink_to(to.format(bench.folder))
        done = bench.run("render", *SMALL, "-q", "-o", name).expect(7 if place is None else 0)
        check(link.is_symlink() and os.readlink(link) == to.format(bench.folder), f"{to}: the link is another one")
        if place is None:
            done.expect_one_line(name)
        else:
            check((bench.folder / place).read_bytes() == whole and not (bench.folder / place).is_symlink(), f"{to}: not written")
            (bench.folder / place).unlink()
        link.unlink()
    # A checkpoint too
    (bench.folder / "l.part").symlink_to("sub/c.part")
    words = ("render", *SMALL, "-q", "--backend", "reference", "--samples", "2", "--checkpoint")
    if bench.run(*words, "c.part", "-o", "r.pfm").code != 77: # without Embree there is no reference
        bench.run(*words, "l.part", "-o", "r.pfm").expect(0)
        check((bench.folder / "sub/c.part").exists() and (bench.folder / "l.part").is_symlink(), "no checkpoint where the link points")
    (bench.folder / "l.png").symlink_to("missing.png")
    bench.run("render", *SMALL, "-q", "-o", "l.png", "-o", "missing.png").expect(2).expect_one_line("missing.png", "given twice")


@case("file.links_in_a_folder_of_textures_keep_pointing")
def links_of_sets(bench):
    words = ("bake", "mip", "builtin:roofs=1", "--format", "png-levels", "-q", "-o")
    bench.run(*words, "whole").expect(0)
    names = sorted(path.name for path in (bench.folder / "whole").iterdir())
    (bench.folder / "linked").mkdir()
    (bench.folder / "linked" / names[0]).symlink_to("../elsewhere.png")
    scratch(bench, f"linked/{names[1]}", b"before").chmod(0o640)
    bench.run(*words, "linked").expect(0)
    check(os.readlink(bench.folder / "linked" / names[0]) == "../elsewhere.png", "the link is another one")
    check((bench.folder / "elsewhere.png").exists(), "nothing is where it points")
    check((bench.folder / "linked" / names[1]).stat().st_mode & 0o777 == 0o640, "permissions have changed")
    for name in names:
        check((bench.folder / "linked" / name).read_bytes() == (bench.folder / "whole" / name).read_bytes(), f"{name} is another one")
    (bench.folder / "linked" / names[2]).unlink()
    (bench.folder / "linked" / names[2]).mkdir()
    bench.run(*words, "linked").expect(7).expect_one_line(names[2])


def refuse_folders(bench, *commands):
    """Each command that makes a folder reports the fault of its name."""
    (bench.folder / "circle").symlink_to("circle")
    (bench.folder / "nowhere").symlink_to("missing")
    scratch(bench, "file", b"")
    locked = bench.folder / "locked"
    locked.mkdir(mode=0o700)
    bench.folder.chmod(0o777)
    user = 50000 + os.getpid() % 5000 if not os.geteuid() and not bench.sanitized else None
    there = bench.left_behind()
    for words in commands:
        for name in ("n" * 300, "circle", "circle/in", "file", "file/in", "nowhere") + (("locked/in",) if user else ()):
            done = bench.run(*words, name, user=user).expect(7)
            check(name[:100] in done.err and len(done.err.splitlines()) == 1, done.describe())
    check(bench.left_behind() == there, f"left: {bench.left_behind()}")


@case("file.folders_that_cannot_be")
def impossible_folders(bench):
    mip = ("bake", "mip", "builtin:roofs=1")
    chart = ("chart", "builtin:plate", *SMALL, "--techniques", "split_isotropic", "--runs", "1", "--reference-samples", "1")
    refuse_folders(bench, (*mip, "--format", "png-levels", "-o"), (*mip, "-o", "p.mip", "--preview"), (*chart, "-o"), ("bake", "environment", "builtin:studio", "-o"))


@case("file.a_lost_checkpoint_does_not_lose_the_picture", "program", "input")
def lost_checkpoint(bench):
    """No file may be as large as the checkpoint; the image is smaller."""
    if "reference" not in bench.run("info").expect(0).out:
        raise Skipped("built without Embree")
    words = ("render", "--backend", "reference", "--size", "48x32", "--samples", "64", "--env-size", "64", "--env-samples", "32")
    bench.run(*words, "-o", "whole.png").expect(0)
    done = bench.run(*words, "--checkpoint", "c.part", "-o", "o.png", "--stats", "s.json", file_size=20000).expect(7)
    check("c.part: cannot be written" in done.err, done.describe())
    check((bench.folder / "o.png").exists(), f"the picture is lost: {bench.left_behind()}")
    check((bench.folder / "o.png").read_bytes() == (bench.folder / "whole.png").read_bytes(), "the picture differs")
    check(bench.left_behind() == ["o.png", "s.json", "whole.png"], f"left: {bench.left_behind()}")


@case("file.an_environment_is_baked_once_however_it_is_turned_and_exposed")
def one_bake(bench):
    small = ("builtin:sphere", "--size", "64x48", "--msaa", "1", *small_sky(bench))
    env, kept = cache_of(bench, *small)
    for words in (("--env-rotation", "70"), ("--env-exposure", "1.5"), ("--env-rotation", "-90", "--env-exposure", "-2")):
        check(bench.figures(*small, *words, env=env)["environment_from_cache"], f"{words} baked it anew")
    baked = [name for name in os.listdir(kept.parent) if name.startswith("environment-")]
    check(baked == [kept.name], f"the cache holds {os.listdir(kept.parent)}")
