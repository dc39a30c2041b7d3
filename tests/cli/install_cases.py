"""Files that an installed program finds. OpenImageIO, with some 250 shared libraries, is loaded only for images that need it."""

import pathlib
import shutil
import subprocess
import tempfile

from harness import SMALL, Skipped, case, check

MODULE = "burnish_openimageio.so"


@case("install.copy_reads_and_writes_pictures", "input")
def installed(bench):
    """Installs outside the build tree, whose module would otherwise be found."""
    cmake = shutil.which("cmake")
    if not cmake:
        raise Skipped("no cmake")
    with tempfile.TemporaryDirectory(prefix="burnish-install-") as prefix:
        subprocess.run([cmake, "--install", str(pathlib.Path(bench.program).parent), "--prefix", prefix, "--component", "program"],
                       check=True, timeout=120, stdout=subprocess.DEVNULL)
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


@case("install.library_is_found_and_draws_the_same")
def library(bench):
    """Another program, built against the installed tree by find_package alone, draws the image of `burnish render`."""
    cmake = shutil.which("cmake")
    if not cmake:
        raise Skipped("no cmake")
    build = pathlib.Path(bench.program).parent
    source = pathlib.Path(__file__).resolve().parent.parent / "package"
    with tempfile.TemporaryDirectory(prefix="burnish-library-") as folder:
        prefix, out = pathlib.Path(folder, "prefix"), pathlib.Path(folder, "build")
        quiet = dict(check=True, timeout=300, stdout=subprocess.DEVNULL)
        subprocess.run([cmake, "--build", str(build), "--target", "burnish_library"], **quiet)
        subprocess.run([cmake, "--install", str(build), "--prefix", str(prefix)], **quiet)
        text = "".join(path.read_text() for path in (prefix / "lib/cmake/burnish").glob("*.cmake"))
        for word in ("-Wall", "-march", "fmt::", "TBB", "embree", str(build)):
            check(word not in text, f"the installed package names {word}")
        subprocess.run([cmake, "-S", str(source), "-B", str(out), f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Release"], **quiet)
        subprocess.run([cmake, "--build", str(out)], **quiet)
        run = subprocess.run([str(out / "turntable"), "builtin:spheres"], cwd=folder, capture_output=True, text=True, timeout=300)
        check(run.returncode == 0, f"turntable ended with {run.returncode}: {run.stderr}")
        hashes = run.stdout.split()
        check(len(set(hashes)) == 4, f"four sides, four pictures: {hashes}")
        for i in range(4):
            bench.run("render", "builtin:sphere", "--env", str(pathlib.Path(folder, f"side{i}.exr")), "--size", "8x8", "--env-size", "16", "--env-samples",
                      "4", "--floor", "off", "--no-cache").expect(0)  # the library found its image module


@case("install.without_the_module_png_still_works", "input")
def without_module(bench):
    """A program alone still renders built-in scenes to PNG, and reports other formats in one line."""
    bench.run("render", *SMALL, "-o", "a.exr", "-o", "a.hdr").expect(0)
    with tempfile.TemporaryDirectory(prefix="burnish-alone-") as folder:
        program = pathlib.Path(shutil.copy(bench.program, folder))
        bench.run("render", *SMALL, "-o", "a.png", "-o", "a.tif", "-o", "a.pfm", program=program).expect(0)
        for words in (("atlas", "--list"), ("help", "train"), ("race", "builtin:plate"), ("bake", "ltc", "-o", "t.ltc"),
                      ("chart", "--mip", "-o", "r")):
            bench.run(*words, program=program).expect(77).expect_one_line("burnish-lab", "target burnish-lab")
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
