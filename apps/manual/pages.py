"""Reads the pages of this folder: their commands, their pictures and their links. `make` and the tests share it."""

import pathlib
import re
import shlex

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
STAND_INS = {"lamp.glb": "models/AnisotropyBarnLampSmall.glb", "workshop.hdr": "env/workshop_1k.hdr",
             "goldens.json": "goldens.json", "brushed.mtlx": "materials/brushed.mtlx",
             "ring.glb": "models/ring.glb"}  # placeholder: file below tests/data
BY_OTHERS = ("serve.png", "engines.png", "conform_page.png", "square.png", "lamp_python.png")  # pictures that no command writes: pages in a browser, an example
LAB = ("atlas", "conform", "race", "plot", "train")  # run by burnish-lab


def pages():
    """The pages that people write, and the front page."""
    return [ROOT / "README.md", *sorted(HERE.glob("*.md"))]


def code_of(text):
    """The lines of a page's code blocks, indented or fenced, each continued line as one."""
    fenced = False
    for line in re.sub(r"\\\n *", "", text).splitlines():
        if line.startswith("```"):
            fenced = not fenced
        elif fenced or line.startswith("    "):
            yield line.strip()


def commands_of(text):
    """[(words, exit code)]: lines that begin with `burnish ` or `mkdir `; a line ends with `# exit code N` where N is not 0."""
    found = []
    for line in code_of(text):
        code = re.search(r"# exit code (\d+)", line)
        for part in re.sub(r"\s#.*", "", line).split(" && "):
            if part.startswith(("burnish ", "mkdir ")):
                found.append((shlex.split(part), int(code[1]) if code else 0))
    return found


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
