"""Reads the pages of this folder: their commands, their pictures and their links. `make` and the tests share it."""

import os
import pathlib
import re
import shlex
import shutil
import signal
import subprocess
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
STAND_INS = {"lamp.glb": "models/AnisotropyBarnLampSmall.glb", "workshop.hdr": "env/workshop_1k.hdr",
             "goldens.json": "goldens.json", "brushed.mtlx": "materials/brushed.mtlx",
             "ring.glb": "models/ring.glb"}  # placeholder: file below tests/data
BY_OTHERS = ("square.png", "lamp_python.png")  # pictures that no command writes: examples
LAB = ("atlas", "conform", "race", "plot", "train")  # run by burnish-lab
BROWSERS = ("chromium", "chromium-browser", "google-chrome")


def pages():
    """The pages that people write, and the front page."""
    return [ROOT / "README.md", *sorted(HERE.glob("*.md"))]


def blocks_of(text):
    """The page's code blocks, indented or fenced, as lists of lines, each continued line as one."""
    blocks, fenced = [[]], False
    for line in re.sub(r"\\\n *", "", text).splitlines():
        if line.startswith("```"):
            fenced = not fenced
        elif fenced or line.startswith("    "):
            blocks[-1].append(line.strip())
            continue
        blocks.append([])
    return [block for block in blocks if block]


def code_of(text):
    """The lines of a page's code blocks."""
    return [line for block in blocks_of(text) for line in block]


def commands_of(text):
    """[(words, exit code)]: lines that begin with `burnish ` or `mkdir `; a line ends with `# exit code N` where N is not 0. A block with a line
    that begins with `chromium ` is one command, for bash, which photographs a page."""
    found = []
    for block in blocks_of(text):
        if any(line.startswith("chromium ") for line in block):
            found.append((["bash", "-ec", "\n".join(block)], 0))
            continue
        for line in block:
            code = re.search(r"# exit code (\d+)", line)
            for part in re.sub(r"\s#.*", "", line).split(" && "):
                if part.startswith(("burnish ", "mkdir ")):
                    found.append((shlex.split(part), int(code[1]) if code else 0))
    return found


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
