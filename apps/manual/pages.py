"""Reads the pages of this folder: their commands, their pictures and their links. `make` and the tests share it."""

import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import tempfile
import textwrap

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
STAND_INS = {"lamp.glb": "models/AnisotropyBarnLampSmall.glb", "workshop.hdr": "env/workshop_1k.hdr",
             "goldens.json": "goldens.json", "brushed.mtlx": "materials/brushed.mtlx",
             "ring.glb": "models/ring.glb"}  # placeholder: file below tests/data
BY_PROGRAMS = ("square.png", "lamp_python.png")  # by programs that a page shows: `make --installed` runs them
BLOCK = re.compile(r"^## (?P<section>[^\n]*)$|(?:^`(?P<file>\w+\.\w+)`[^\n]*:\n\n)?^```(?P<language>\w*)\n(?P<text>.*?)^```$|^(?P<shell>(?:    [^\n]*\n)+)",
                   re.M | re.S)
TYPED = re.compile(r"(?:[A-Z_]+=\S+ )+\S|(?:burnish|cp|cmake|cpack|cc|g\+\+|npm|node|pip|python3|pkg-config|export|man) \S|\./\w")
NAMED = re.compile(r"burnish \w+|burnish (?:bake|export|train) \w+|.*(?:\b(?:FOLDER|NAME|FILE|DIR)\b|\.\.\.).*")
LAB = ("atlas", "conform", "race", "plot", "train")  # run by burnish-lab
BROWSERS = ("chromium", "chromium-browser", "google-chrome")


def pages():
    """The pages that people write, and the front page."""
    return [ROOT / "README.md", *sorted(HERE.glob("*.md"))]


def blocks_of(text):
    """[(section, file or "", language, text)] of a page's code blocks. An indented block holds commands for a shell. A line before a block that
    begins with a file's name in backquotes gives the file."""
    section = ""
    for found in BLOCK.finditer(text):
        if found["section"] is not None:
            section = found["section"]
        elif found["shell"]:
            yield section, "", "sh", textwrap.dedent(found["shell"])
        else:
            yield section, found["file"] or "", found["language"], found["text"]


def lines_of(block):
    """The lines of a block for a shell, each continued line as one."""
    return [line.strip() for line in re.sub(r"\\\n *", "", block).splitlines()]


def typed(line):
    """(line without its comment, exit code): a line ends with `# exit code N` where N is not 0."""
    code = re.search(r"# exit code (\d+)", line)
    return re.sub(r"\s+#.*", "", line), int(code[1]) if code else 0


def photographs(block):
    """Returns true for lines that photograph a page in a browser."""
    return any(line.startswith("chromium ") for line in lines_of(block))


def shell_of(text):
    """The lines that a page's reader types, as typed() has them, without those of blocks that photograph a page."""
    return [typed(line) for _, _, language, block in blocks_of(text) if language == "sh" and not photographs(block) for line in lines_of(block)]


def of_program(line):
    """The parts of a line between `&&` that begin with `burnish `, `mkdir ` or `cp `: they run without a shell. A line with a pipe has none, nor
    has one that copies files of the repository."""
    parts = [part for part in line.split(" && ") if part.startswith(("burnish ", "mkdir ", "cp "))]
    return [] if " | " in line else [part for part in parts if not part.startswith("cp tests/")]


def commands_of(text):
    """[(words, exit code)] of the parts that run without a shell. A block that photographs a page is one command, for bash."""
    found = []
    for _, _, language, block in blocks_of(text):
        if language == "sh" and photographs(block):
            found.append((["bash", "-ec", "\n".join(lines_of(block))], 0))
        elif language == "sh":
            found += [(shlex.split(part), code) for line, code in map(typed, lines_of(block)) for part in of_program(line)]
    return found


def written_by(words):
    """The files and folders that a command writes."""
    flags = ["-o", "--risks", "--error-map", "--preview", "--plan-out", "--write", *(["--variance"] if words[1] == "render" else [])]
    if words[0] == "bash":
        return re.findall(r"\w+\.webp", words[2])
    if words[0] == "cp":
        return words[2:]
    return [words[i + 1] for i, word in enumerate(words[:-1]) if word in flags] + (words[3:4] if "--draw" in words else [])


def behind(text):
    """{file or folder: words of all commands behind it}: of the command that writes it, and of those that write what that command reads. A
    photograph NAME.webp is of the figure NAME.svg. A page's .svg is of its first chart."""
    made = {}
    for words, _ in commands_of(text):
        for file in written_by(words):
            read = {file.replace(".webp", ".svg")} if words[0] == "bash" else set(words) - {file}
            of = [found for name, commands in made.items() if any(name.split("/")[0] == word.split("/")[0] for word in read) for found in commands]
            made[file] = [words, *of]
    charts = [words for words, _ in commands_of(text) if words[1] == "chart"]
    return {**{name: charts[:1] for name in pictures_of(text) if name.endswith(".svg")}, **made}


def inline_of(text):
    """The commands within a page's sentences, without names of subcommands and without placeholders."""
    codes = re.findall(r"`([^`\n]+)`", BLOCK.sub("", text))
    return [code for code in codes if TYPED.match(code) and not NAMED.fullmatch(code)]


def lacks(words):
    """Returns what this machine lacks for a command of bash, or nothing."""
    if not any(map(shutil.which, BROWSERS)):
        return "no Chromium: package chromium, group test of apps/packages.txt"
    if "npm install" in words[2] and not os.environ.get("BURNISH_ENGINES"):
        return "no engines: BURNISH_ENGINES is to name a folder with node_modules that holds three, babylonjs and babylonjs-loaders"
    return None


def tools(folder, program, lab):
    """Fills a folder for PATH: with the programs of a page's lines, as this machine runs them. Returns it."""
    made = folder.resolve() / ".tools"
    if made.exists():
        return made
    made.mkdir()
    browser = next(filter(None, map(shutil.which, BROWSERS)), "false")
    texts = {"burnish": f'case "$1" in {"|".join(LAB)}) exec {lab.resolve()} "$@" ;; esac\nexec {program.resolve()} "$@"',
             "chromium": f'exec timeout 400 {browser} --no-sandbox --test-type --enable-unsafe-swiftshader --user-data-dir="$(mktemp -d -p {made})" "$@"',
             "npm": f'ln -s "{pathlib.Path(os.environ.get("BURNISH_ENGINES", "")).resolve()}/node_modules" node_modules'}
    for name, text in texts.items():
        (made / name).write_text(f"#!/bin/sh\n{text}\n")
        (made / name).chmod(0o755)
    for engine in ("three", "babylon"):  # where a reader has the repository
        shutil.copytree(ROOT / "apps/examples" / engine, folder / "apps/examples" / engine, ignore=shutil.ignore_patterns("node_modules"))
    return made


def run_shell(words, folder, tools, environment):
    """Runs a command of bash, and ends all that it left running. Returns its exit code and all that it said."""
    with tempfile.TemporaryFile("w+", errors="replace") as said:
        child = subprocess.Popen(words, cwd=folder, env={**environment, "PATH": f"{tools}:{environment['PATH']}"}, stdin=subprocess.DEVNULL, stdout=said,
                                 stderr=subprocess.STDOUT, start_new_session=True)
        try:
            code = child.wait(timeout=900)
        except subprocess.TimeoutExpired:
            code = 124
        try:
            os.killpg(child.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        said.seek(0)
        return code, said.read()


def examples_of(text):
    """The examples of a reference page, as lines of a shell."""
    return [line.strip() for line in text.partition("\n## Examples\n")[2].splitlines() if line.startswith("    ")]


def pictures_of(text):
    """Names of the pictures that a page shows out of pictures/."""
    return re.findall(r"!\[[^\]]*\]\([^)]*pictures/([^)]+)\)", text)


def links_of(text):
    """[(file or "", anchor or "")] of a page's links within the repository."""
    without_code = re.sub(r"```[\s\S]*?```|^    .*$|`[^`\n]*`", "", text, flags=re.M)
    links = re.findall(r"\]\(([^)\s]+)\)", without_code)
    return [(link.partition("#")[0], link.partition("#")[2]) for link in links if not re.match(r"[a-z]+:", link)]


def anchors_of(text):
    """Anchors of a page's headings, as web pages of repositories make them."""
    headings = re.findall(r"^#+ (.*)$", re.sub(r"```.*?```", "", text, flags=re.S), re.M)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}
