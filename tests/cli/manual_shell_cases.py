"""Lines of the manual's pages for a shell: a new reader types them in a fresh copy of the repository, page by page."""

import os
import pathlib
import shlex
import shutil
import signal
import subprocess

from harness import Skipped, case, check
from manual_page_cases import ROOT, pages

LIMIT = 7000  # seconds that a page may take
# Pages with lines for a shell, in the order of a reader who builds once. Beside each: needs beyond the group `build` of apps/packages.txt,
# by name, with a command that fails where the need is absent.
PAGES = {
    "apps/manual/start.md": {},
    "README.md": {},
    "apps/manual/cluster.md": {},
    "apps/manual/library.md": {"pkg-config": "pkg-config --version", "dpkg-dev": "dpkg-shlibdeps --version"},
    "apps/manual/python.md": {"python3-venv": "python3 -c 'import ensurepip'"},
    "apps/manual/conform.md": {"npm and its registry": "npm view three version", "a free port 8000": "! (: < /dev/tcp/localhost/8000)"},
    "apps/manual/page.md": {"emscripten": "emcc --version", "npm": "npm --version"},
}
CLONE = "~/burnish"
# Sections that a reader follows in another folder than before. Each page begins in the clone.
FOLDERS = {
    ("cluster.md", "By hand"): "~/cluster",
    ("library.md", "A program that uses it"): "~/library",
    ("python.md", "Draw"): "~/python",
    ("python.md", "From C and other languages"): CLONE,
    ("conform.md", "Draw the scenes"): "~/conform",
    ("page.md", "A scene as one file"): "~/page",
}
NOT_RUN = {
    "./tests/run": "the gate cannot run inside one of its tests",
    "man burnish": "opens a pager",
    "npm pack": "a part of its line on the page",
    "burnish render --floor off": "names options, and no scene",
}
LANGUAGES = ("sh", "python", "cmake", "cpp", "js", "glsl", "json", "yaml", "text")  # of blocks; commands for a shell are sh
SERVERS = {"python3 -m http.server": "http://localhost:8000/pages/three.html"}  # begin of a line: a page that it serves
PICTURES = {"library/square.png": "square.png", "python/lamp_python.png": "lamp_python.png"}  # by programs of pages
ABSENT = '#!/bin/sh\necho "make is not in the group build of apps/packages.txt" >&2\nexit 1\n'
STAND_INS = {
    # A reader with the group `build` has neither make nor libbenchmark-dev. The machines that run tests do.
    "make": ABSENT,
    "gmake": ABSENT,  # CMake looks for it first
    "benchmarkConfig.cmake": 'message(FATAL_ERROR "libbenchmark-dev is not in the group build of apps/packages.txt")\n',
}
END = "END_OF_THE_BLOCK"


def untested(name, text, shown):
    """Returns the commands of a page that no test runs. shown: all lines of all pages for a shell."""
    lines = [] if name in PAGES else [line for line, _ in pages.shell_of(text) if pages.of_program(line) != line.split(" && ")]
    inline = [code for code in pages.inline_of(text) if code not in shown and not code.startswith("burnish ")]
    blocks = [f"```{language}" for _, _, language, _ in pages.blocks_of(text) if language not in LANGUAGES]
    return [f"{name}: {line}" for line in lines + inline + blocks if line not in NOT_RUN]


@case("manual.every_line_for_a_shell_is_run_by_a_test", tier="quick")
def every_line(bench):
    """Commands of burnish within sentences, which no block shows, run here."""
    texts = {str(page.relative_to(ROOT)): page.read_text() for page in pages.pages()}
    shown = {line for text in texts.values() for line, _ in pages.shell_of(text)}
    wrong = [line for name, text in texts.items() for line in untested(name, text, shown)]
    check(not wrong, "a line that no test runs; PAGES lists pages that run whole:\n" + "\n".join(wrong))
    made_up = "# Page\n\n    burnish list\n    frobnicate scene.glb\n\n`cmake --build nowhere` builds it.\n\n```bash\nls\n```\n"
    found = untested("made_up.md", made_up, shown)
    check(found == [f"made_up.md: {line}" for line in ("frobnicate scene.glb", "cmake --build nowhere", "```bash")], f"of made-up lines: {found}")
    sections = {(pathlib.Path(name).name, section) for name in PAGES for section, *_ in pages.blocks_of(texts[name])}
    stale = [*(set(FOLDERS) - sections), *(line for line in NOT_RUN if not any(line in text for text in texts.values()))]
    check(not stale, f"no page has {stale}")
    inline = {code for text in texts.values() for code in pages.inline_of(text) if code.startswith("burnish ")} - shown - set(NOT_RUN)
    check(len(inline) > 3, f"only {inline}")
    for code in sorted(inline):
        bench.run(*shlex.split(code)[1:]).expect(0)


def line_for_shell(line, code):
    """A line as bash runs it: with its exit code, and a server until it has answered."""
    if line in NOT_RUN:
        return f": left out: {line}"
    for begin, page in SERVERS.items():
        if line.startswith(begin):
            ask = f"python3 -c \"import urllib.request; urllib.request.urlopen('{page}')\""
            return f"{line} &\ntimeout 60 bash -c {shlex.quote(f'until {ask} 2> /dev/null; do sleep 1; done')}\nkill $!"
    return f"{line} || test $? = {code} || exit 1" if code else f"{line} || exit"  # -e alone looks at the last part of `a && b`


def script_of(page):
    """A page as a script: its lines as they are typed, its files as they are shown, its Python as it stands."""
    script, last = ["trap 'kill $(jobs -p) 2> /dev/null || true' EXIT", f"cd {CLONE}"], ""
    for section, file, language, block in pages.blocks_of(page.read_text()):
        if section != last and (page.name, section) in FOLDERS:
            script.append(f"cd {FOLDERS[page.name, section]}")
        last = section
        if language == "sh" and not pages.photographs(block):  # manual.commands_run_as_they_are_written photographs
            script += [line_for_shell(*pages.typed(line)) for line in pages.lines_of(block)]
        elif file or language == "python":
            script += [f"cat > {file} << '{END}'" if file else f"python3 - << '{END}'", block + END]
    return "\n".join(script) + "\n"


def copied(home):
    """Makes a reader's home: a clone of the repository, folders of their own, and stand-ins for packages."""
    clone = home / "burnish"
    if (ROOT / ".git").exists():
        listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
        for name in filter(None, listed.split("\0")):
            if (ROOT / name).is_file():
                (clone / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(ROOT / name, clone / name)
    else:
        shutil.copytree(ROOT, clone, ignore=lambda folder, names: {"build", "out"} & set(names) if pathlib.Path(folder) == ROOT else ())
    for folder in {folder for folder in FOLDERS.values() if folder != CLONE}:
        own = home / folder[2:]
        own.mkdir()
        for name, data in pages.STAND_INS.items():
            shutil.copy(clone / "tests/data" / data, own / name)
    (home / "bin").mkdir()
    for name, text in STAND_INS.items():
        (home / "bin" / name).write_text(text)
        (home / "bin" / name).chmod(0o755)


def environment(bench, home):
    """The reader's environment, with the compiler cache of this machine where it has one."""
    env = {"HOME": str(home), "BURNISH_NO_INSTALL": "1", "PATH": f"{home / 'bin'}:{os.environ['PATH']}", "benchmark_DIR": str(home / "bin")}
    if shutil.which("ccache"):
        known = subprocess.run(["ccache", "--get-config", "cache_dir"], capture_output=True, text=True, check=True).stdout.strip()
        env |= {"CCACHE_DIR": known, "CCACHE_BASEDIR": str(home), "CCACHE_NOHASHDIR": "1"}
        env |= {name: os.environ.get(name, "ccache") for name in ("CMAKE_C_COMPILER_LAUNCHER", "CMAKE_CXX_COMPILER_LAUNCHER")}
    return {name: value for name, value in bench.environment(env).items() if name not in ("PYTHONPATH", "BURNISH_LIBRARY")}


def run_script(path, env, log):
    """Returns the exit code of a script, None where it did not end in time."""
    with open(log, "w", encoding="utf-8") as out, subprocess.Popen(["bash", "-ex", str(path)], env=env, stdin=subprocess.DEVNULL, stdout=out,
                                                                    stderr=subprocess.STDOUT, start_new_session=True) as running:
        try:
            return running.wait(timeout=LIMIT)
        except subprocess.TimeoutExpired:
            os.killpg(running.pid, signal.SIGKILL)  # the shell and its children
            return None


def run_pages(bench, home, names):
    """Runs the pages in turn. Returns the fault of the first that fails, and all unmet needs; pages with unmet needs do not run."""
    env, lacking = environment(bench, home), []
    for name in names:
        page = ROOT / name
        lacks = [what for what, asks in PAGES[name].items() if subprocess.run(["bash", "-c", asks], env=env, capture_output=True).returncode]
        if lacks:
            lacking.append(f"{name} needs {', '.join(lacks)}")
            continue
        script = bench.folder / f"{page.parent.name}_{page.stem}.sh"
        script.write_text(script_of(page))
        code = run_script(script, env, script.with_suffix(".log"))
        if code != 0:
            return f"{name}: exit code {code}: {script.with_suffix('.log').read_text(errors='replace')[-4000:]}", lacking
        if page.stem == "start":
            env["PATH"] = f"{home / 'burnish/build/release'}:{env['PATH']}"  # as that page says, in each further shell
    return None, lacking


@case("manual.pages_run_in_a_fresh_clone", tier="nightly", budget=7200)
def fresh_clone(bench):
    """The pictures that programs of pages wrote are those that the pages show."""
    if bench.sanitized:
        raise Skipped("takes too long under sanitizers")
    if not shutil.which("bash"):
        raise Skipped("no bash")
    home = bench.folder / "home"
    copied(home)
    fault, lacking = run_pages(bench, home, PAGES)
    check(not fault, fault)
    for made, shown in PICTURES.items():
        if not any(f"{made.split('/')[0]}.md" in lack for lack in lacking):
            bench.run("compare", home / made, ROOT / "apps/manual/pictures" / shown, "--fail-max", "0").expect(0)
    shutil.rmtree(home)
    if lacking:
        raise Skipped("other pages ran; " + "; ".join(lacking))
