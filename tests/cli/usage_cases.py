"""Help, version, lists, and errors of wrong options."""

import json
import os
import re
import shlex

import gltf_files
from harness import ROOT, SMALL, Skipped, case, check, lab_commands, scratch


@case("usage.help_is_everywhere")
def help_is_everywhere(bench):
    for words in ((), ("render",), ("compare",), ("list",), ("info",)):
        done = bench.run(*words, "--help").expect(0)
        check("Examples:" in done.out and "Usage: burnish" in done.out, f"help without examples\n{done.describe()}")
        check(done.err == "", f"help belongs on standard output\n{done.describe()}")
        check("\x1b" not in done.out, "help is coloured")


@case("usage.no_words_print_the_subcommands")
def no_words(bench):
    """A mistake of a script that lost its words. The answer is the help, not a pointer to it."""
    done = bench.run().expect(2)
    listed = bench.run("--help").expect(0).out
    check(done.out == "" and done.err == listed + "burnish: a subcommand is required\n", done.describe())


@case("usage.options_that_must_be_given_show_no_default")
def required(bench):
    seen = 0
    for name in re.findall(r"^  (\w+) ", bench.run("--help").expect(0).out.split("Subcommands:")[1].split("\n\n")[0], re.M):
        text = bench.run(name, "--help").expect(0).out
        for line in re.findall(r"^ .* REQUIRED.*(?:\n {30,}.*)?", text, re.M):
            seen += 1
            check(not line.rstrip().endswith(")"), f"{name}: {line}")
    check(seen >= 3, f"only {seen} options were seen")


@case("usage.version_is_name_and_number")
def version(bench):
    done = bench.run("--version").expect(0)
    name, number = done.out.split()
    check(name == "burnish" and len(number.split(".")) == 3, done.describe())


WRITTEN = {"-o", "--json", "--svg", "--stats", "--trace", "--html", "--junit", "--csv", "--variance", "--error-map", "--write"}  # options that name a file or folder
MORE = {"serve": ("-o", "file/pictures"), "render": ("-o", "file/a.png"), "parity": ("--json", "file/a"), "profile": ("--json", "file/a")}


def examples(bench):
    """Returns the command lines of the pages and of --help, without those that show alternatives."""
    lines = []
    for page in (ROOT / "README.md", *sorted((ROOT / "apps/manual").glob("*.md"))):
        lines += [line.strip() for line in re.sub(r"\\\n +", "", page.read_text()).splitlines() if line.startswith("    burnish ")]
    for name in set(line.split()[1] for line in lines if line.split()[1].isalpha()):
        lines += [line.strip() for line in bench.run(name, "--help").out.split("Examples:")[-1].splitlines() if line.startswith("  burnish ")]
    lines = [part.strip() for line in lines for part in re.split("  ", line)[0].split("&&")]
    return sorted(set(line for line in lines if not any(word in line for word in ("|", ">", "--help")) and not re.search(r"\[|\.\.\.|\b[A-Z]{3,}", line)))


def take_examples(bench, of_lab, more, least):
    """Runs the examples of the laboratory, or all others, up to their missing inputs or their outputs, which are below a file. more: words
    by subcommand for examples without an output."""
    lab = lab_commands()
    lines = [line for line in examples(bench) if (line.split()[1] in lab) == of_lab]
    check(len(lines) > least, f"only {len(lines)} examples were found")
    scratch(bench, "file", "")
    wrong = []
    for line in lines:
        words = shlex.split(line)[1:]
        stopped = [f"file/{w}" if before in WRITTEN and w != "-" else w for before, w in zip([""] + words, words)]
        if stopped == words:
            stopped += [word for word in more.get(words[0], ()) if "--list" not in words]
        done = bench.run(*stopped)
        if done.code not in ((0, 4) if stopped == words or words[0] == "submit" else (4, 7)): # submit prints a script
            wrong.append(f"{line}: exit code {done.code}, {done.err.strip()}")
    check(not wrong, "\n".join(wrong))


@case("usage.examples_of_the_pages_are_taken_as_they_are_written", budget=10)
def every_example(bench):
    take_examples(bench, False, MORE, 80)


# Arguments, and text that the one-line message must contain.
WRONG = (
    (("frobnicate",), "frobnicate"),
    (("render", "--bogus"), "--bogus"),
    (("render", "one.glb", "two.glb"), "two.glb"),
    (("render", "builtin:nothing"), "builtin:teapot"),
    (("render", "--env", "builtin:nothing"), "builtin:studio"),
    (("render", "--size", "10"), "--size"),
    (("render", "--size", "0x10"), "--size"),
    (("render", "--size", "-5x10"), "--size"),
    (("render", "--size", "70000x10"), "65536"),
    (("profile", "--size", "16384x16384", "--msaa", "2"), "268435456"),
    (("render", "--size", "99999999999x1"), "--size"),
    (("render", "--msaa", "3"), "1, 2, 4, 8, 16"),
    (("render", "--threads", "0"), "--threads"),
    (("render", "--threads", "many"), "--threads"),
    (("render", "--isa", "sse9"), "scalar, "),
    (("render", "--technique", "nothing"), "split_isotropic"),
    (("render", "--samples", "0"), "--samples"),
    (("render", "--samples", "65537", "--technique", "mc"), "--samples"),
    (("render", "--samples", "65", "--technique", "major_axis"), "major_axis takes 1 to 64"),
    (("render", "--samples", "4096", "--technique", "major_axis_adaptive"), "major_axis_adaptive takes 1 to 64"),
    (("render", "--samples", "100", "--technique", "major_axis_weighted"), "major_axis_weighted takes 1 to 64"),
    (("render", "--axis-k", "0"), "--axis-k"),
    (("render", "--axis-beta", "-1"), "--axis-beta"),
    (("render", "--seed", "-1"), "--seed"),
    (("render", "--tilt", "10"), "--tilt"),
    (("render", "--tilt", "10,"), "--tilt"),
    (("render", "--tilt", "10,90"), "--tilt"),
    (("render", "--dfg", "guess"), "table, fit"),
    (("render", "--limit-draw-bytes", "lots"), "--limit-draw-bytes"),
    (("render", "--backend", "nothing"), "tile, vulkan, reference"),
    (("render", "--tile-size", "48"), "32, 64"),
    (("render", "--texture-anisotropy", "17"), "--texture-anisotropy"),
    (("render", "--roughness", "nan"), "--roughness"),
    (("render", "--roughness", "1.5"), "--roughness"),
    (("render", "--anisotropy", "2"), "--anisotropy"),
    (("render", "--exposure", "inf"), "--exposure"),
    (("render", "--tonemap", "nothing"), "pbr-neutral"),
    (("render", "--frames", "0"), "--frames"),
    (("render", "--eye", "1,2"), "--eye"),
    (("render", "--eye", "1,2,nan"), "--eye"),
    (("render", "--eye", "1,2,3,4"), "--eye"),
    (("render", "--orbit", "30"), "--orbit"),
    (("render", "--orbit", "30,91"), "-90 to 90"),
    (("render", "--orbit", "30,10", "--eye", "1,2,3"), "--eye"),
    (("render", "--orbit", "30,10", "--camera", "0"), "--camera"),
    (("render", "--zoom", "0"), "--zoom"),
    (("render", "--eye", "1,2,3", "--target", "1,2,3"), "--target"),
    (("render", "--eye", "1,2,3", "--camera", "0"), "--camera"),
    (("render", "--eye", "1,2,3", "--fov", "180"), "--fov"),
    (("render", "--camera", "nothing"), "--camera"),
    (("render", "--env-size", "100"), "--env-size"),
    (("render", "--env-rotation", "north"), "--env-rotation"),
    (("render", "--limit-file-bytes", "lots"), "--limit-file-bytes"),
    (("render", "--limit-file-bytes", "99999999999G"), "--limit-file-bytes"),
    (("render", "--limit-json-depth", "0"), "--limit-json-depth"),
    (("render", "-o", "picture.xyz"), "picture.xyz"),
    (("render", "-o", "picture"), "png"),
    (("render", "-o", "a.png", "-o", "a.png"), "a.png"),
    (("render", "-o"), "--output"),
    (("render", "--stats", ""), "--stats"),
    (("list", "nothing"), "techniques"),
    (("info", "--bogus"), "--bogus"),
)


@case("usage.wrong_options_say_one_line_and_exit_2")
def wrong_options(bench):
    small = ("--env-size", "64", "--env-samples", "32")
    for words, needle in WRONG:
        extra = small if words == ("render", "--camera", "nothing") else ()
        done = bench.run(*words, *extra).expect(2).expect_one_line(needle)
        check(done.out == "", f"an error belongs on stderr\n{done.describe()}")
    check(bench.left_behind() == [], f"files were left: {bench.left_behind()}")


@case("usage.negative_numbers_are_values")
def negative_numbers(bench):
    for eye in (("--eye", "-1,0.5,3"), ("--eye=-.5,.5,3",)):
        bench.run("render", *SMALL, *eye, "--exposure", "-1.5", "-o", "a.png").expect(0)


@case("usage.lists_name_what_options_accept", budget=5)
def lists(bench):
    """An option takes every name of its list. The reflection models are listed too, and no option names one."""
    tiny = ("--size", "8x8", "--msaa", "1", "--env-size", "16", "--env-samples", "4", "--floor", "off")
    options = {"techniques": lambda name: ("--technique", name, "--samples", "1"), "scenes": lambda name: (name,),
               "environments": lambda name: ("--env", name), "models": None, "extensions": None}
    expected = {"techniques": "split_isotropic", "scenes": "builtin:teapot", "environments": "builtin:studio", "models": "ggx",
                "extensions": "KHR_materials_anisotropy"}
    for what, option in options.items():
        lines = bench.run("list", what).expect(0).out.splitlines()
        names = [line.split()[0] for line in lines]
        check(expected[what] in names and len(set(names)) == len(names), f"list {what} lacks {expected[what]}: {lines}")
        check(all(len(line.split(None, 1)) == 2 for line in lines), f"a name without a summary: {lines}")
        for name in names if option else ():
            bench.run("render", *option(name), *tiny, "-q").expect(0)


@case("usage.ignored_extensions_are_in_the_figures_and_strict_refuses_them")
def ignored(bench):
    gltf = gltf_files.triangle()
    gltf["extensionsUsed"] = ["KHR_materials_ior", "KHR_materials_diffuse_transmission"]
    scratch(bench, "a.gltf", gltf_files.text(gltf))
    found = bench.figures("a.gltf", *SMALL)
    check(found["ignored_extensions"] == ["KHR_materials_diffuse_transmission"], f"{found['ignored_extensions']}")
    bench.run("render", "a.gltf", *SMALL, "--strict").expect(4).expect_one_line("KHR_materials_diffuse_transmission")
    listed = dict(line.split(None, 1) for line in bench.run("list", "extensions").out.splitlines())
    check(listed["KHR_materials_diffuse_transmission"].startswith("ignored") and listed["KHR_materials_ior"].startswith("supported"), f"{listed}")


@case("usage.info_names_machine_and_build")
def info(bench):
    facts = json.loads(bench.run("info", "--json").expect(0).out)
    for key in ("version", "compiler", "processor", "cores", "isa", "isa_available", "backends", "openimageio"):
        check(facts.get(key), f"info lacks {key}: {facts}")
    check("scalar" in facts["isa_available"] and facts["isa"] in facts["isa_available"], f"{facts}")
    check("tile" in facts["backends"], f"{facts}")
    capped = json.loads(bench.run("info", "--json", env={"BN_FORCE_ISA": "scalar"}).expect(0).out)
    check(capped["isa"] == "scalar", f"BN_FORCE_ISA=scalar gave {capped['isa']}")
    text = bench.run("info").expect(0).out
    check(facts["version"] in text and facts["isa"] in text, text)


@case("usage.info_warns_of_options_without_effect")
def info_without_effect(bench):
    bench.run("bake", "environment", "builtin:studio", "--env-size", "16", "--env-samples", "1", "-q", "-o", "baked").expect(0)
    for words, warnings in ((("--env-rotation", "30"), ["--env-rotation has no effect without --env"]),
                            (("--env", "baked", "--key-lights", "2"), ["--key-lights has no effect with --env baked, whose bake has its own"]),
                            (("--env", "builtin:studio", "--key-lights", "2"), [])):
        said = [line for line in bench.run("info", *words).expect(0).err.splitlines() if "warning" in line]
        check(said == [f"burnish: warning: {text}" for text in warnings], f"{words}: {said}")


@case("usage.lost_standard_output_is_an_error")
def lost_output(bench):
    if not os.path.exists("/dev/full"):
        raise Skipped("no /dev/full")
    import subprocess

    with open("/dev/full", "wb") as full:
        done = subprocess.run([bench.program, "info"], stdout=full, stderr=subprocess.PIPE, timeout=60, check=False)
    check(done.returncode == 7, f"exit code {done.returncode}, stderr {done.stderr!r}")
