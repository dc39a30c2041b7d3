"""The pages of apps/manual: reference pages match the program, commands run as written, links and images exist."""

import pathlib
import re
import shutil
import signal
import subprocess
import sys

from harness import Skipped, case, check, lab_commands

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MANUAL = ROOT / "apps/manual"
sys.path.insert(0, str(MANUAL))

import pages  # noqa: E402

NEEDS = {"--backend": "a Vulkan device or Embree", "parity": "a Vulkan device", "--devices": "a Vulkan device"}
MOST_BYTES, MOST_PICTURE = 16 << 18, 80 << 10
SHOWN_BY = {("render", "--aov"): "--show"}  # an option without pictures of its own: one that shows the same
# Options without pictures, and the reasons. A key is a subcommand, a group of options (up to "," or " of "), a subcommand's group, an option
# of every subcommand, or one subcommand's option.
WITHOUT_PICTURES = {
    **dict.fromkeys(("golden", "info", "manual", "merge", "serve", "submit"), "judges, prints or passes on; draws what render draws"),
    **dict.fromkeys(("atlas", "parity", "race", "train"), "measures and prints figures"),
    "Limits on input": "refuse files",
    "Limits": "refuse files",
    "Pieces": "share a job among processes; the picture is the same",
    "Bands": "share memory among bands; the picture is the same",
    "Machine": "never changes a picture",
    "With --backend vulkan": "needs a device that few machines have; exact samplers draw the same picture",
    "Failing (exit code 1)": "judges figures",
    "bake: With WHAT ltc": "makes a table, whose errors --report charts",
    "chart: Measurements": "changes figures and charts of a report, whose pictures are render's",
    "chart: Mip filters": "figures and charts of a report",
    "conform: Judge": "writes verdicts",
    "conform: Write": "writes scenes; the samples lower noise alone",
    **dict.fromkeys(("--output", "--quiet", "--verbose", "--threads", "--no-cache", "--json", "--csv", "--junit", "--html", "--svg", "--stats", "--trace", "--live",
                     "--renderer", "--count-operations"), "files and words"),
    "--budget-ms": "chooses by the machine's speed, and draws otherwise on each",
    "--plan-out": "writes a file",
    "--verify": "prints figures",
    "--checkpoint": "writes a file",
    "--checkpoint-seconds": "writes a file",
    "bake --textures": "names files; their pixels are those of --format",
    "bake --texels": "16 bits or 32; pictures of 8 bits are equal",
    "compare --second-reference": "figures; the error map is the same",
    "compare --variance": "figures; the error map is the same",
    "compare --sequence": "figures of flicker",
    "compare --significance": "figures of a test",
    "chart --size": "the size of frames that are timed",
    "chart --error-size": "the size of pictures that are compared",
    "conform --without": "leaves out scenes",
    "export --ltc": "adds a function to a text",
}
BOUNDS = ("free after 20 seconds", "longer than 10 seconds", "within 10 seconds", "at most 1.5 times the reference's")  # of contracts, measured nowhere


def lab_program(bench):
    return pathlib.Path(bench.program).with_name("burnish-lab")


@case("manual.reference_pages_are_the_program_s")
def reference(bench):
    """apps/manual/make --reference rewrites them."""
    text = (ROOT / "apps/cli/commands.def").read_text()
    names = re.findall(r"^BN_(LAB_)?COMMAND\((\w+)", text, re.M)
    check(len(names) > 10, f"only {len(names)} subcommands were seen")
    wrong = []
    for lab, name in names:
        program = lab_program(bench) if lab else None
        if lab and not program.exists():
            continue
        page = MANUAL / "reference" / f"{name}.md"
        made = bench.run("manual", "markdown", name, program=program).expect(0).out
        if not page.exists() or page.read_text() != made:
            wrong.append(f"apps/manual/reference/{name}.md differs from burnish manual markdown {name}")
    index = (MANUAL / "reference/README.md").read_text()
    for lab, name in names:
        row = re.search(rf"^\| \[{name}\]\({name}\.md\) \| .*$", index, re.M)
        if not row or row[0].endswith("(laboratory) |") != bool(lab):
            wrong.append(f"apps/manual/reference/README.md: no row of {name}, or the laboratory is not named rightly")
    check(not wrong, "\n".join(wrong))
    known = {f"{name}.md" for _, name in names} | {"README.md"}
    left = sorted(path.name for path in (MANUAL / "reference").iterdir() if path.name not in known)
    check(not left, f"pages without a subcommand: {left}")


def check_options(bench, *names):
    """Each row of --help is a row of the subcommand's page."""
    for name in names:
        page = bench.run("manual", "markdown", name).expect(0).out
        check(page.startswith(f"# burnish {name}\n"), page[:200])
        for option in re.findall(r"^  (?:-\w,)?(--[a-z][a-z0-9-]*)", bench.run(name, "--help").expect(0).out, re.M):
            check(option == "--help" or re.search(rf"^\| (?:`-\w`, )?`{option}` \|", page, re.M), f"{name}: no row of {option}")


@case("manual.reference_names_every_option")
def options(bench):
    """An unknown subcommand is an error."""
    check_options(bench, "render", "compare", "bake", "info")
    bench.run("manual", "markdown", "nothing").expect(2).expect_one_line("nothing")
    bench.run("manual", "bash", "render").expect(2).expect_one_line("markdown")
    everything = bench.run("manual", "--markdown").expect(0).out
    check(bench.run("manual", "markdown", "render").expect(0).out in everything and len(re.findall("^# burnish ", everything, re.M)) > 10, "not all pages")
    bench.run("manual", "fish", "--markdown").expect(2).expect_one_line("--markdown")


def reference_page(bench, command):
    """Returns the subcommand's page of the reference, or nothing where the laboratory that has it is absent."""
    lab = lab_program(bench) if command in lab_commands() else None
    return bench.run("manual", "markdown", command, program=lab).expect(0).out if lab is None or lab.exists() else ""


def has_value(commands, option, value):
    """Returns true if a command gives the option this value, or if none gives the option one."""
    values = [words[i + 1] for words in commands for i, word in enumerate(words[:-1]) if word == option]
    return not values or value in values or value == "FILE"


@case("manual.pictures_beside_options_show_them", tier="quick")
def option_pictures(bench):
    """A command of the manual draws a picture with the option beside which it stands, and the page shows the picture."""
    drawn = {}
    for page in pages.pages():
        drawn |= pages.behind(page.read_text())
    rows = re.findall(r'^BN_PICTURE\("(\w+)", "([^"]+)", "([^"]+)", "([^"]+)"\)$', (ROOT / "apps/cli/option_pictures.def").read_text(), re.M)
    check(len({(command, option) for command, option, _, _ in rows}) > 120, f"{rows}")
    for command, option in sorted({(command, option) for command, option, _, _ in rows}):
        page = reference_page(bench, command)
        if not page:
            continue
        row = re.search(rf"^\| (?:`-\w`, )?`{option}` \|.*$", page, re.M)[0]
        own = [(words, file) for c, o, words, file in rows if (c, o) == (command, option)]
        check(all(f"`{words}` ![{words}](../pictures/{file})" in row for words, file in own), row)
        name = SHOWN_BY.get((command, option), option)
        check(any(name in words for _, file in own for words in drawn[file]), f"{command} {option}: no picture was drawn with it")
        for words, file in own:
            given = re.findall(r"(--[a-z-]+) (\S+)", words)
            wrong = [f"{name} {value}" for name, value in given if not has_value(drawn[file], name, value)]
            check(not wrong, f"{file} was not drawn by {wrong}")
    # Another subcommand's option shows them where it means the same
    row_of = lambda command, option: re.search(rf"^\| `{option}` \|.*$", bench.run("manual", "markdown", command).expect(0).out, re.M)[0]
    check("![" in row_of("chart", "--fov") and "![" in row_of("profile", "--tilt"), "options of render have pictures on render's page alone")
    check("![" not in row_of("bake", "--samples") and "![" not in row_of("golden", "--flip"), "an option has another one's pictures")


@case("manual.options_without_pictures_say_why", tier="quick")
def options_without_pictures(bench):
    """An option that changes a picture shows it on its reference page. The tables at the top list all others."""
    names = re.findall(r"^BN_(?:LAB_)?COMMAND\((\w+)", (ROOT / "apps/cli/commands.def").read_text(), re.M)
    wrong, used, absent = [], set(), False
    for command in names:
        group, page = "", reference_page(bench, command)
        absent |= not page
        for line in page.splitlines():
            group = line[3:] if line.startswith("## ") else group
            option = re.match(r"\| (?:`-\w`, )?`(--[a-z0-9-]+)` \|", line)
            if not option or "](../pictures/" in line:
                continue
            keys = [command, re.sub(r",.*| of .*", "", group), f"{command}: {group}", option[1], f"{command} {option[1]}"]
            used |= set(keys)
            if not any(key in WITHOUT_PICTURES for key in keys):
                wrong.append(f"burnish {command} {option[1]}, under {group}: no picture beside it")
    check(not wrong, "\n".join(wrong) + "\nadd pictures to apps/cli/option_pictures.def and a page of apps/manual, or a reason to WITHOUT_PICTURES")
    stale = [] if absent else sorted(set(WITHOUT_PICTURES) - used)
    check(not stale, f"no option without a picture is of {stale}")


@case("manual.links_and_pictures_are_there")
def links(bench):
    """Checks the manual and the front page. A page shows every image, and no image is large."""
    wrong, shown = [], set()
    everything = [*pages.pages(), *sorted((MANUAL / "reference").glob("*.md")), ROOT / "apps/README.md", ROOT / "apps/promises.md"]
    for page in everything:
        text = page.read_text()
        shown.update(pages.pictures_of(text))
        for file, anchor in pages.links_of(text):
            target = (page.parent / file).resolve() if file else page
            if not target.exists():
                wrong.append(f"{page.relative_to(ROOT)}: no file {file}")
            elif anchor and anchor not in pages.anchors_of(target.read_text()):
                wrong.append(f"{page.relative_to(ROOT)}: no heading {file}#{anchor}")
    files = {path.name: path.stat().st_size for path in (MANUAL / "pictures").iterdir()}
    wrong += [f"pictures/{name}: no page shows it" for name in sorted(set(files) - shown)]
    wrong += [f"pictures/{name}: {size} bytes" for name, size in files.items() if size > MOST_PICTURE]
    check(not wrong, "\n".join(wrong))
    check(sum(files.values()) <= MOST_BYTES and len(files) > 30, f"{len(files)} pictures, {sum(files.values())} bytes")


@case("manual.library_page_has_the_tested_programs")
def library_page(bench):
    page = (MANUAL / "library.md").read_text()
    check((ROOT / "apps/examples/mesh.cpp").read_text() in page, "library.md and apps/examples/mesh.cpp differ")
    plain = lambda text: "\n".join(line.strip() for line in text.strip().splitlines())
    programs = [plain(path.read_text()) for path in (ROOT / "apps/examples").glob("*.cpp")]
    pieces = [plain(piece) for piece in re.findall(r"```cpp\n(.*?)```", page, re.S)]
    wrong = [piece for piece in pieces if not any(piece in program for program in programs)]
    check(len(pieces) > 2 and not wrong, f"no example that is compiled holds {wrong}")


@case("manual.pages_hold_no_dates_and_no_times")
def no_dates(bench):
    """Dates and times belong in bench/lab, and times also between the marks of bench/README.md. Rows of reference pages hold ranges."""
    dated = re.compile(r"\b20\d\d-\d\d-\d\d\b|\b\d+(\.\d+)? (ms|µs|(CPU )?(seconds|minutes|hours))\b|\b(takes?|costs?) (seconds|minutes|hours)\b"
                       r"|\ba (second|minute|hour) (more|less)\b|\b(many|\d+(\.\d+)?) times (the|as)\b|\ba (half|third|quarter|tenth) of the\b")
    left_out = re.compile(r"<!-- speed: .*?<!-- end of speed -->|" + "|".join(map(re.escape, BOUNDS)), re.S)
    folders = [ROOT / name / "README.md" for name in ("core", "shading", "raster", "apps", "tests", "bench")]
    texts = {page: page.read_text() for page in [*pages.pages(), *folders, ROOT / "apps/promises.md"]}
    texts |= {page: re.sub(r"^\|.*$", "", page.read_text(), flags=re.M) for page in (MANUAL / "reference").glob("*.md")}
    wrong = [f"{page.relative_to(ROOT)}: {found[0]}" for page, text in texts.items() for found in dated.finditer(left_out.sub("", text))]
    check(not wrong, "\n".join(wrong))


def served(bench, command, folder, page):
    """Returns the faults of a server that prints its address and ends by Ctrl-C."""
    with subprocess.Popen(command, cwd=folder, env=bench.environment({}), stdout=subprocess.PIPE, text=True) as running:
        address = running.stdout.readline()
        running.send_signal(signal.SIGINT)
        code = running.wait(timeout=60)
    if code or not address.startswith("http://127.0.0.1:"):
        yield f"{page.name}: {' '.join(map(str, command))}: exit code {code}, address '{address}'"


def photographed(bench, words, folder, page):
    """Returns the faults of lines that photograph pages in a browser: a picture that is missing, or that holds much less than the manual's."""
    code, said = pages.run_shell(words, folder, pages.tools(folder, pathlib.Path(bench.program), lab_program(bench)), bench.environment({}))
    if code:
        yield f"{page.name}: {words[2]}: exit code {code}: {said[-500:]}"
    for name in pages.pictures_of(page.read_text()):
        made, kept = folder / name, MANUAL / "pictures" / name
        if name in words[2] and (not made.exists() or made.stat().st_size < 0.6 * kept.stat().st_size):
            yield f"{page.name}: {name} is missing or nearly blank: {said[-500:]}"


def run_page(bench, page, left):
    """Returns the faults of a page's commands, which run in sequence in a new folder. left: is told of those that cannot run here."""
    folder = bench.folder / f"{page.parent.name}_{page.stem}"
    folder.mkdir()
    for name, data in pages.STAND_INS.items():
        shutil.copy(bench.data_file(data), folder / name)
    unmade = set()  # files of the laboratory, where its program is absent
    lab_lacks = ""
    for words, code in pages.commands_of(page.read_text()):
        if words[0] == "bash":
            lacks = pages.lacks(words) or lab_lacks
            left += [f"{page.name}: {lacks}"] if lacks else []
            yield from () if lacks else photographed(bench, words, folder, page)
            continue
        program = bench.program if words[0] == "burnish" else words[0]
        lab = len(words) > 1 and words[0] == "burnish" and words[1] in pages.LAB
        if lab and not lab_program(bench).exists():
            unmade.add(words[words.index("-o") + 1] if "-o" in words else "")
            lab_lacks = "no burnish-lab, which makes what the page shows"
            continue
        if unmade & set(words):
            continue
        if words[:2] == ["burnish", "serve"] and code == 0:
            yield from served(bench, [program, *words[1:]], folder, page)
            continue
        done = subprocess.run([program, *words[1:]], cwd=folder, env=bench.environment({}), capture_output=True, text=True, timeout=900)
        absent = done.returncode == 77 and any(word in NEEDS for word in words)
        if done.returncode != code and not absent:
            yield f"{page.name}: {' '.join(words)}: exit code {done.returncode}, not {code}: {done.stderr[-500:]}"
    yield from other_pictures(bench, page, folder)


def other_pictures(bench, page, folder):
    """Returns the page's pictures that its commands no longer draw as the manual holds them. References and devices may round otherwise."""
    drawn = pages.behind(page.read_text())
    for name in pages.pictures_of(page.read_text()):
        made, kept = next(iter(sorted(folder.rglob(name))), None), MANUAL / "pictures" / name
        if made is None or not name.endswith((".png", ".apng")):
            continue
        limit = ("--fail-flip", "0.05") if name not in drawn or {"--backend", "--risks"} & {word for words in drawn[name] for word in words} else ("--fail-max", "0")
        if name.endswith(".apng"):
            equal = made.read_bytes() == kept.read_bytes()
        else:
            equal = bench.run("compare", kept, made, *limit, "-q").code == 0
        if not equal:
            yield f"{page.name}: pictures/{name} is not what its command draws"


@case("manual.commands_run_as_they_are_written", tier="nightly", budget=900)
def commands(bench):
    found = sum(len(pages.commands_of(page.read_text())) for page in pages.pages())
    check(found > 100, f"only {found} commands were found")
    if bench.sanitized:
        raise Skipped("takes too long under sanitizers")
    left = []
    wrong = [fault for page in pages.pages() for fault in run_page(bench, page, left)]
    check(not wrong, "\n".join(wrong))
    if left:
        raise Skipped("all other commands ran; left out: " + "; ".join(left))
