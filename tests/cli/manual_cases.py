"""The manual page and the completions contain every option, and installed shells accept them."""

import re
import shutil
import subprocess

from harness import Skipped, case, check

COMMANDS = ("render", "compare", "chart", "profile", "parity", "list", "info", "manual")


def options_of(bench, command):
    """Returns the long names of a subcommand's options, from its help."""
    text = bench.run(command, "--help").expect(0).out
    return set(re.findall(r"^  (?:-\w,)?(--[a-z][a-z0-9-]*)", text, re.M)) - {"--help"}


@case("usage.help_and_version_are_found_where_people_look")
def help_and_version(bench):
    for command in COMMANDS:
        asked = bench.run("help", command).expect(0)
        check(asked.out == bench.run(command, "--help").expect(0).out, f"help {command} is not {command} --help")
        check(bench.run(command, "--version").expect(0).out == bench.run("--version").out, f"{command} --version")
    check(bench.run("help").expect(0).out == bench.run("--help").out, "help is not --help")
    check(bench.run("render", "-o", "--version").code != 0, "--version is the value of -o here")


@case("usage.manual_and_completions_name_every_option")
def every_option(bench):
    texts = {what: bench.run("manual", what).expect(0).out for what in ("man", "bash", "zsh", "fish")}
    check(bench.run("manual").expect(0).out == texts["man"], "the manual page is the default")
    for command in COMMANDS:
        for option in options_of(bench, command):
            check(option.replace("-", "\\-") in texts["man"], f"the manual page lacks {command} {option}")
            check(re.search(rf"\n *{command}\) words='[^\n]*{option}(?![a-z-])", texts["bash"]), f"bash: {command} {option}")
            check(re.search(rf"\n    {command}\)\n(?:.+\n)*?.*'\*?{option}\[", texts["zsh"]), f"zsh: {command} {option}")
            check(re.search(rf"__fish_seen_subcommand_from {command}'.* -l {option[2:]} ", texts["fish"]), f"fish: {command} {option}")
    for text in texts.values():
        check("major_axis_weighted" in text and "builtin:studio" in text, "names that options take are missing")


def completed(script, *words):
    """Returns bash's completions of the last word."""
    program = script + '\nCOMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _burnish; printf "%s\\n" "${COMPREPLY[@]}"'
    done = subprocess.run(["bash", "-c", program, "bash", "burnish", *words], capture_output=True, text=True, timeout=60)
    check(done.returncode == 0 and done.stderr == "", f"bash: {done.stderr}")
    return done.stdout.split()


@case("usage.bash_completes_subcommands_options_names_and_files")
def bash(bench):
    script = bench.run("manual", "bash").expect(0).out
    check(completed(script, "comp") == ["compare"], "a subcommand")
    check(completed(script, "render", "--tech") == ["--technique"], "an option")
    check("lobe_line" in completed(script, "render", "--technique", ""), "names of an option")
    check(completed(script, "render", "--env", "builtin:st") == ["builtin:studio"], "a name with a colon")
    check(completed(script, "render", "builtin:t") == ["builtin:teapot"], "a scene")
    (bench.folder / "lamp.glb").write_bytes(b"")
    here = f"cd '{bench.folder}'\n" + script
    check(completed(here, "render", "la") == ["lamp.glb"] and completed(here, "render", "-o", "la") == ["lamp.glb"], "a file")
    check(completed(script, "render", "--samples", "") == [], "numbers are not guessed")
    check("compare" in completed(script, "help", ""), "help of a subcommand")


@case("usage.zsh_and_fish_take_their_completions")
def other_shells(bench):
    """Tests installed shells: both read the text, and fish offers bash's completions."""
    shells = [shell for shell in ("zsh", "fish") if shutil.which(shell)]
    if not shells:
        raise Skipped("neither zsh nor fish")
    for shell in shells:
        (bench.folder / shell).write_text(bench.run("manual", shell).expect(0).out)
        done = subprocess.run([shell, "-n", shell], cwd=bench.folder, capture_output=True, text=True, timeout=60)
        check(done.returncode == 0 and done.stderr == "", f"{shell}: {done.stderr}")
    for typed, offered in (("burnish comp", "compare"), ("burnish render --tech", "--technique"), ("burnish render --technique lobe_", "lobe_line")):
        if "fish" in shells:
            done = subprocess.run(["fish", "--no-config", "-c", f"source fish; complete -C '{typed}'"], cwd=bench.folder, capture_output=True, text=True,
                                  timeout=60)
            check(offered in done.stdout.split() and done.stderr == "", f"{typed}: {done.stdout}{done.stderr}")


@case("usage.manual_page_is_good_roff")
def roff(bench):
    page = bench.run("manual", "man").expect(0).out
    check(not re.search(r"^[.'](?!(?:TH|ad|SH|SS|TP|B|PP|nf|fi|br)\b)", page, re.M), "a request that the page does not mean")
    if shutil.which("groff"):
        done = subprocess.run(["groff", "-man", "-Tascii", "-ww"], input=page, capture_output=True, text=True, timeout=60)
        check(done.returncode == 0 and done.stderr == "", f"groff: {done.stderr[:500]}")
        check("BURNISH RENDER" in done.stdout.upper() and "--technique" in re.sub("\x1b\\[[0-9;]*m|.\b", "", done.stdout), done.stdout[:2000])
