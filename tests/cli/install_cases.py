"""Files that an installed program finds. OpenImageIO, with some 250 shared libraries, is loaded only for images that need it."""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from harness import SMALL, Skipped, case, check

MODULE = "burnish_openimageio.so"
ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "apps/manual"))

import pages  # noqa: E402

INSTALLING = {**os.environ, "BN_TEST_INSTALL": "1"}  # builds for tests refuse to be installed otherwise
SOURCES = ("core/", "shading/", "raster/", "tests/", "bench/", "apps/README.md")  # that pages link to and no installation holds


@case("install.copy_reads_and_writes_pictures", "input")
def installed(bench):
    """Installs outside the build tree, whose module would otherwise be found."""
    cmake = shutil.which("cmake")
    if not cmake:
        raise Skipped("no cmake")
    with tempfile.TemporaryDirectory(prefix="burnish-install-") as prefix:
        subprocess.run([cmake, "--install", str(pathlib.Path(bench.program).parent), "--prefix", prefix, "--component", "program"],
                       check=True, timeout=120, stdout=subprocess.DEVNULL, env=INSTALLING)
        program = pathlib.Path(prefix, "bin", "burnish")
        module = pathlib.Path(prefix, "lib", "burnish", MODULE)
        check(program.is_file() and module.is_file(), f"{program} or {module} is not installed")
        for text in ("man/man1/burnish.1", "bash-completion/completions/burnish", "zsh/site-functions/_burnish",
                     "fish/vendor_completions.d/burnish.fish"):
            file = pathlib.Path(prefix, "share", text)
            check(file.is_file() and "--technique" in file.read_text().replace("\\-", "-").replace("-l t", "--t"), f"{file} is not installed")
            if pathlib.Path(bench.program).with_name("burnish-lab").is_file():
                check("bless" in file.read_text(), f"{file} lacks the options of burnish-lab")
        bench.run("render", *SMALL, "-o", "a.exr", "-o", "a.hdr", "-o", "a.jpg", program=program).expect(0)
        for env in ("a.exr", "a.hdr", "a.jpg"):
            bench.run("render", *SMALL, "--env", env, "-o", "b.png", program=program).expect(0)


def installed_examples(bench, folder, *targets):
    """Installs the build below a folder, and compiles examples by find_package alone. Returns prefix and build folder."""
    cmake = shutil.which("cmake")
    if not cmake:
        raise Skipped("no cmake")
    build, prefix, out = pathlib.Path(bench.program).parent, pathlib.Path(folder, "prefix"), pathlib.Path(folder, "build")
    quiet = dict(check=True, timeout=300, stdout=subprocess.DEVNULL, env=INSTALLING)
    subprocess.run([cmake, "--build", str(build), "--target", "burnish_library"], **quiet)
    subprocess.run([cmake, "--install", str(build), "--prefix", str(prefix)], **quiet)
    subprocess.run([cmake, "-S", str(ROOT / "apps/examples"), "-B", str(out), f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Release"], **quiet)
    subprocess.run([cmake, "--build", str(out), *(("--target", *targets) if targets else ())], **quiet)
    return prefix, out


def check_pages(installed):
    """Checks that installed pages show no picture and link to no file that is missing, but files of the sources."""
    wrong, shown = [], 0
    for page in sorted(installed.rglob("*.md")):
        text = page.read_text()
        pictures = re.findall(r"!\[[^\]]*\]\(([^)\s]+)\)", text)
        shown += len(pictures)
        wrong += [f"{page.relative_to(installed)} shows {file}" for file in pictures if not (page.parent / file).is_file()]
        for file, _ in pages.links_of(text):
            target = os.path.relpath(page.parent / file, installed)
            if file and not (installed / target).exists() and not target.startswith(SOURCES):
                wrong.append(f"{page.relative_to(installed)} links to {file}")
    check(not wrong, "not installed:\n" + "\n".join(wrong))
    check(shown > 300, f"installed pages show only {shown} pictures")


def hashes_of_turntable(bench, folder, out):
    run = subprocess.run([str(out / "turntable"), "builtin:spheres"], cwd=folder, capture_output=True, text=True, timeout=300)
    check(run.returncode == 0, f"turntable ended with {run.returncode}: {run.stderr}")
    return run.stdout.split()


@case("install.library_is_found_and_draws_the_same", budget=12)
def library(bench):
    """Another program, built against the installed tree by find_package alone, draws the image of `burnish render`. A compiler builds that
    program."""
    with tempfile.TemporaryDirectory(prefix="burnish-library-") as folder:
        prefix, out = installed_examples(bench, folder, "turntable")
        check_pages(prefix / "share/doc/burnish")
        text = "".join(path.read_text() for path in [*(prefix / "lib/cmake/burnish").glob("*.cmake"), prefix / "lib/pkgconfig/burnish.pc"])
        for word in ("-Wall", "-march", "fmt::", "TBB", "embree", str(pathlib.Path(bench.program).parent)):
            check(word not in text, f"the installed package names {word}")
        headers = [path for path in (prefix / "include").rglob("*") if path.is_file()]
        check({path.relative_to(prefix / "include").parts[0] for path in headers} == {"burnish"}, "a header beside include/burnish")
        wrong = [path.name for path in headers if '#include "' in path.read_text()]
        check(len(headers) > 30 and not wrong, f"headers that need another include path: {wrong}")
        if shutil.which("pkg-config"):
            told = subprocess.run(["pkg-config", "--cflags", "--libs", "burnish"], env={**os.environ, "PKG_CONFIG_PATH": str(prefix / "lib/pkgconfig")},
                                  capture_output=True, text=True, check=True).stdout
            check("-lburnish" in told and any(pathlib.Path(word[2:]).resolve() == prefix / "include" for word in told.split() if word.startswith("-I")), told)
        hashes = hashes_of_turntable(bench, folder, out)
        check(len(set(hashes)) == 5, f"four sides and a turned mesh, five pictures: {hashes}")
        for i in range(4):
            bench.run("render", "builtin:sphere", "--env", str(pathlib.Path(folder, f"side{i}.exr")), "--size", "8x8", "--env-size", "16", "--env-samples",
                      "4", "--floor", "off", "--no-cache").expect(0)  # the library found its image module


@case("install.examples_build_and_run", tier="nightly")
def examples(bench):
    with tempfile.TemporaryDirectory(prefix="burnish-examples-") as folder:
        _, out = installed_examples(bench, folder)
        first = hashes_of_turntable(bench, folder, out)
        check(hashes_of_turntable(bench, folder, out) == first, "two runs differ")
        run = lambda name, *words, env=None: subprocess.run([str(out / name), *words], cwd=folder, capture_output=True, text=True, timeout=300,
                                                            env={**os.environ, **(env or {})})
        done = run("layers")
        check(done.returncode == 0 and done.stdout.split()[:4] == ["R", "G", "B", "Z"], done.stdout + done.stderr)
        check(run("layers", "nothing.glb").returncode == 4, "a missing file")
        done = run("compare", "lobe_line", "bent_normal")
        check(done.returncode == 0 and 0.01 < float(done.stdout) < 0.5, done.stdout + done.stderr)
        check(float(run("compare", "mc", "mc").stdout) == 0.0, "one technique differs from itself")
        check(run("mesh").returncode == 0, "mesh")
        check(run("stop").returncode == 0, "a stop is not heard")
        bench.run("compare", str(pathlib.Path(folder, "square.png")), str(ROOT / "apps/manual/pictures/square.png"), "--fail-max", "0").expect(0)
        words = ("render", "builtin:plate", "--floor", "off", "--size", "64x48", "--stats", "-", "-q")
        golden = json.loads(bench.run(*words).expect(0).out)["pixel_hash"]
        if (out / "golden_test").exists():
            check(run("golden_test", env={"PLATE_HASH": golden}).returncode == 0, "the library's hash is another than the program's")
            check(run("golden_test", env={"PLATE_HASH": "1"}).returncode == 1, "a golden test that cannot fail")


def packages_needed(depends):
    """Returns the names of installed packages that a list of dependencies needs, theirs included."""
    found, open_lists = set(), [depends]
    while open_lists:
        for needed in filter(None, map(str.strip, open_lists.pop().split(","))):
            for name in (re.match(r"[^ (:]+", choice.strip())[0] for choice in needed.split("|")):
                asked = subprocess.run(["dpkg-query", "-W", "-f", "${Status}\n${Pre-Depends}, ${Depends}", name], capture_output=True, text=True)
                if asked.returncode == 0 and "ok installed" in asked.stdout:
                    if name not in found:
                        found.add(name)
                        open_lists.append(asked.stdout.split("\n", 1)[1])
                    break
    return found


def furnish(root, packages):
    """Puts the packages' libraries into a root, as links where the file system allows."""
    merged = [path for path in map(pathlib.Path, ("/lib", "/lib64", "/bin", "/sbin")) if path.is_symlink()]
    for path in merged:
        (root / path.name).symlink_to(os.readlink(path))
    # Copy the choices that the packages' scripts would make
    shutil.copytree("/etc/alternatives", root / "etc/alternatives", symlinks=True)
    chosen = [path for path in pathlib.Path("/usr/lib").glob("*/*.so*") if path.is_symlink() and os.readlink(path).startswith("/etc/alternatives/")]
    for path in chosen:
        (root / path.parent.relative_to("/")).mkdir(parents=True, exist_ok=True)
        shutil.copy(path, root / path.relative_to("/"), follow_symlinks=False)
    listed = subprocess.run(["dpkg", "-L", *sorted(packages)], capture_output=True, text=True, check=True).stdout.split("\n")
    for line in sorted(set(filter(None, listed))):
        path = pathlib.Path(line)
        if not re.match(r"/(usr/)?lib", line) or path.is_dir() and not path.is_symlink() or not path.exists():
            continue
        to = root / path.parent.resolve().relative_to("/") / path.name
        to.parent.mkdir(parents=True, exist_ok=True)
        if not to.exists() and not to.is_symlink():
            shutil.copy(path, to, follow_symlinks=False)


@case("install.debian_package_installs_and_draws", tier="nightly")
def debian_package(bench):
    """Installs the package below a root of its own, whose own Debian has nothing else."""
    if not all(map(shutil.which, ("cpack", "dpkg", "dpkg-deb", "dpkg-shlibdeps"))) or os.geteuid() != 0:
        raise Skipped("no cpack, no dpkg-dev, or not root")
    with tempfile.TemporaryDirectory(prefix="burnish-deb-") as folder:
        folder = pathlib.Path(folder)
        quiet = dict(check=True, timeout=300, stdout=subprocess.DEVNULL, env=INSTALLING)
        subprocess.run(["cpack", "-G", "DEB", "--config", str(pathlib.Path(bench.program).parent / "CPackConfig.cmake"), "-B", str(folder)], **quiet)
        package = next(folder.glob("burnish_*.deb"))
        depends = subprocess.run(["dpkg-deb", "-f", str(package), "Depends"], capture_output=True, text=True, check=True).stdout
        for name in ("libc6", "libstdc++6", "libopenimageio", "libtbb12", "libpng16-16"):
            check(name in depends, f"{name} is not among what the package depends on: {depends}")
        root = folder / "root"
        for part in ("updates", "info"):
            (root / "var/lib/dpkg" / part).mkdir(parents=True)
        (root / "var/lib/dpkg/status").touch()
        (root / "etc").mkdir()
        subprocess.run(["dpkg", f"--root={root}", "--force-depends", "--force-script-chrootless", "--no-triggers", "--install", str(package)], stderr=subprocess.DEVNULL, **quiet)
        program = root / "usr/bin/burnish"
        own = json.loads(bench.run("render", *SMALL, "--stats", "-", "-q").expect(0).out)["pixel_hash"]
        told = json.loads(bench.run("render", *SMALL, "--stats", "-", "-q", "-o", "a.exr", program=program).expect(0).out)["pixel_hash"]
        check(told == own and (bench.folder / "a.exr").exists(), "the packaged program draws another picture")
        # In a root that holds nothing but the packages that it names, and theirs
        furnish(root, packages_needed(depends))
        for node in ("null", "urandom"):
            (root / "dev").mkdir(exist_ok=True)
            (root / "dev" / node).write_bytes(b"" if node == "null" else os.urandom(4096))
        (root / "proc/self").mkdir(parents=True)
        (root / "proc/self/exe").symlink_to("/usr/bin/burnish")
        linker = subprocess.run(["ldconfig", "-r", str(root)], capture_output=True, text=True)
        done = subprocess.run(["/usr/sbin/chroot", str(root), "/usr/bin/burnish", "render", *SMALL, "--stats", "-", "-q", "-o", "/b.exr"],
                              capture_output=True, text=True, timeout=120, env={"HOME": "/", "PATH": "/usr/bin"})
        check(done.returncode == 0 and json.loads(done.stdout)["pixel_hash"] == own and (root / "b.exr").exists(), f"on a bare root: {done.stderr}{linker.stderr}")
        subprocess.run(["dpkg", f"--root={root}", "--force-script-chrootless", "--no-triggers", "--purge", "burnish"], **quiet)
        check(not [path for path in (root / "usr").rglob("*burnish*")], "files stay when the package goes")


@case("install.without_the_module_png_still_works", "input")
def without_module(bench):
    """A program alone still renders built-in scenes to PNG, and reports other formats in one line."""
    bench.run("render", *SMALL, "-o", "a.exr", "-o", "a.hdr").expect(0)
    with tempfile.TemporaryDirectory(prefix="burnish-alone-") as folder:
        program = pathlib.Path(shutil.copy(bench.program, folder))
        bench.run("render", *SMALL, "-o", "a.png", "-o", "a.tif", "-o", "a.pfm", program=program).expect(0)
        for words in (("atlas", "--list"), ("help", "train"), ("race", "builtin:plate"), ("bake", "ltc", "-o", "t.ltc"),
                      ("chart", "--mip", "-o", "r"), ("render", "builtin:needles=0.01", *SMALL)):
            bench.run(*words, program=program).expect(77).expect_one_line("`cmake --build build/release --target burnish-lab`")
        written = bench.run("render", *SMALL, "--quiet", "-o", "b.exr", program=program).expect(77)
        written.expect_one_line("b.exr", MODULE, folder)
        read = bench.run("render", *SMALL, "--quiet", "--env", "a.exr", "-o", "c.png", program=program).expect(77)
        read.expect_one_line("a.exr", MODULE, folder)
        bench.run("render", *SMALL, "--quiet", "--env", "a.hdr", "-o", "a.png", program=program).expect(0)
        damaged = pathlib.Path(folder, MODULE)
        damaged.write_bytes(b"no module")
        bench.run("render", *SMALL, "--quiet", "-o", "b.exr", program=program).expect(77).expect_one_line("b.exr", damaged)
    check(bench.left_behind() == ["a.exr", "a.hdr", "a.pfm", "a.png", "a.tif"], f"left: {bench.left_behind()}")


def loaded(bench, *arguments):
    """Returns the dynamic loader's list of loaded files."""
    bench.run(*arguments, env={"LD_DEBUG": "files", "LD_DEBUG_OUTPUT": str(bench.folder / "loader")}).expect(0)
    accounts = list(bench.folder.glob("loader.*"))
    text = "".join(account.read_text("utf-8", "replace") for account in accounts)
    for account in accounts:
        account.unlink()
    if "libc.so" not in text:
        raise Skipped("this dynamic loader gives no account of what it loads")
    return text


@case("install.png_loads_no_image_library")
def png_loads_none(bench):
    bench.run("render", *SMALL).expect(0)  # puts the environment in the cache
    for arguments in (("list", "techniques"), ("info",), ("render", *SMALL, "-o", "a.png")):
        account = loaded(bench, *arguments)
        for name in ("OpenImageIO", MODULE):
            check(name not in account, f"{arguments[0]} loads {name}")
    account = loaded(bench, "render", *SMALL, "-o", "a.exr")
    check("OpenImageIO" in account and MODULE in account, "an EXR is written without OpenImageIO: this case looks for the wrong names")
