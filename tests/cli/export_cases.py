"""burnish export glsl: techniques as files for other engines, compiled alone, and compared word for word in place of the program's text."""

import re
import shutil
import subprocess

from harness import Skipped, case, check
from parity_cases import ROOT, check_equal, parity

MODELS = (ROOT / "shading/models.def").read_text()
TECHNIQUES = re.findall(r"^BN_TECHNIQUE\((\w+), (\w+)", MODELS, re.MULTILINE)
OF_GRIDS = re.findall(r"^BN_TECHNIQUE\((\w+),(?: grid,|[^\n]*kPhongGrid)", MODELS, re.MULTILINE)


def exported(bench, name, *words):
    bench.run("export", "glsl", "--technique", name, *words, "-o", f"{name}.glsl").expect(0)
    return (bench.folder / f"{name}.glsl").read_text()


ENGINE = """#version 450
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) uniform samplerCube cubes[3];
layout(std430, set = 0, binding = 1) buffer Places {{ vec4 at[]; }};
vec4 burnish_radiance(int cube, vec3 direction, float lod)
{{
    return cube == 0 ? textureLod(cubes[0], direction, lod) : cube == 1 ? textureLod(cubes[1], direction, lod) : texture(cubes[2], direction);
}}
{text}
void main()
{{
    burnish_settings f = burnish_usual_settings(256, 9, 16);
    burnish_shaded_point x = burnish_point_of(f, vec3(0.0, 0.0, 1.0), normalize(at[0].xyz), vec3(1.0, 0.0, 0.0), vec3(0.9), vec3(1.0), 0.4, 0.8,
                                              vec2(0.9, 0.1), 3);
    at[1] = vec4(burnish_{name}_specular(f, x), 1.0);
}}
"""


def compiler():
    if not shutil.which("glslc"):
        raise Skipped("no glslc here")


def compiles(bench, text):
    (bench.folder / "engine.comp").write_text(text)
    done = subprocess.run(["glslc", "-w", bench.folder / "engine.comp", "-o", bench.folder / "engine.spv"], capture_output=True, text=True)
    return done.returncode == 0, done.stderr


def undefined(bench):
    """Returns the values that the compiled engine reads without anybody having written them."""
    subprocess.run(["spirv-opt", "-O", bench.folder / "engine.spv", "-o", bench.folder / "small.spv"], check=True)
    return re.findall(r"OpUndef \S+", subprocess.run(["spirv-dis", bench.folder / "small.spv"], capture_output=True, text=True, check=True).stdout)


@case("export.every_technique_compiles_alone_and_reads_nothing_undefined", budget=20)
def compiles_alone(bench):
    """Compiles and optimises a shader for each technique."""
    compiler()
    if not (shutil.which("spirv-opt") and shutil.which("spirv-dis")):
        raise Skipped("no spirv-opt, or no spirv-dis")
    for name, _ in TECHNIQUES:
        text = exported(bench, name)
        good, said = compiles(bench, ENGINE.format(text=text, name=name))
        check(good, f"{name}:\n{said[:800]}")
        check(not undefined(bench), f"{name} reads undefined values")
        if name == "mc":
            check("x.s.exact = 0;" in text and compiles(bench, ENGINE.format(text=text.replace("x.s.exact = 0;", ""), name=name))[0]
                  and undefined(bench), "a member that nobody fills is not seen")
    check(not compiles(bench, ENGINE.format(text="", name=name))[0], "an engine without the file compiles too")


@case("export.a_file_has_what_it_needs_and_no_more", tier="nightly")
def no_more(bench):
    for name, _ in TECHNIQUES:
        text = exported(bench, name)
        check("#include" not in text and "\n# " not in text, f"{name} includes something")
        code = re.sub(r"//[^\n]*", "", text)
        outside = re.sub(r"\{(?:[^{}]|\{(?:[^{}]|\{(?:[^{}]|\{[^{}]*\})*\})*\})*\}", "{}", code)
        strangers = [n for n in re.findall(r"(\w+)\s*\([^()]*\)\s*\{\}", outside) if not n.startswith("burnish_")]
        check(not strangers, f"{name} defines {strangers}")
        for struct in re.findall(r"struct (\w+)", code):
            check(struct.startswith("burnish_") and len(re.findall(rf"\b{struct}\b", code)) > 1, f"{name}: {struct} is of no use")
        for function in set(re.findall(r"^(?:precise )?\w+ (burnish_\w+)\(", code, re.MULTILINE)):
            used = len(re.findall(rf"\b{function}\b", code)) > len(re.findall(rf"^(?:precise )?\w+ {function}\(", code, re.MULTILINE))
            roots = {f"burnish_{name}_specular", f"burnish_{name}_shared", "burnish_usual_settings", "burnish_point_of", "burnish_dfg_fit",
                     "burnish_albedo_place"}
            check(used or function in roots, f"{name}: nobody calls {function}")
        check(("kGrid[" in text) == (name in OF_GRIDS), f"{name}: a grid or none")
    check("beckmann" not in exported(bench, "major_axis"), "models that it does not know")


@case("export.a_grid_has_as_many_samples_as_asked_for")
def grid(bench):
    for asked, count in (("25", 25), ("40", 36)):
        text = exported(bench, "filtered_is", "--samples", asked)
        check(f"burnish_kGrid[{count}]" in text and f"burnish_kGridCount = {count};" in text, f"no {count} samples")
        check(text.count("vec3(", text.index("burnish_kGrid["), text.index(";", text.index("burnish_kGrid["))) == count, "another number of them")


def in_place(bench, name, *also, changed=lambda text: text, code=0):
    """Returns the report of parity with the exported file in place of the program's technique."""
    compiler()
    (bench.folder / f"{name}.glsl").write_text(changed(exported(bench, name)))
    return parity(bench, "builtin:teapot", "--size", "96x64", "--technique", name, "--msaa", "1", "--glsl", f"{name}.glsl", also=also, code=code, timeout=600.0)


def words_of_program(bench, name):
    report = in_place(bench, name, ("--tilt", "8,4", "--energy-compensation", "--axis-k", "1.5", "--samples", "9"))
    check_equal(report)
    check({row["technique"] for row in report["rows"]} == {name} and len(report["rows"]) == 2, f"{name}: {len(report['rows'])} rows")


# A driver takes a minute or two to compile each.
for technique, _ in TECHNIQUES:
    case(f"export.file_gives_the_program_s_words.{technique}", tier="nightly")(lambda bench, name=technique: words_of_program(bench, name))


def wider(text):
    check("w * ((2.0) * burnish_k_dot3(w, o)) - o" in text, "the mirror is written otherwise")
    return text.replace("w * ((2.0) * burnish_k_dot3(w, o)) - o", "w * ((2.0000005) * burnish_k_dot3(w, o)) - o")


@case("parity.an_edited_technique_differs_in_the_stage_that_shades", tier="nightly")
def edited(bench):
    report = in_place(bench, "major_axis", changed=wider, code=1)
    check({row["first_difference"] for row in report["rows"]} == {"shaded colour"}, f"{report['rows']}")


@case("parity.a_technique_that_cannot_be_used_is_said")
def unusable(bench):
    compiler()
    text = exported(bench, "major_axis")
    broken = text.replace("    return ", "    retrun ", 1)
    shared = exported(bench, "lobe_line").replace("burnish_lobe_line_shared(", "burnish_other(")
    line = broken[:broken.index("    retrun ")].count("\n") + 1
    for content, words, code, needle in ((text, ("--technique", "lobe_line"), 4, "burnish_lobe_line_specular"), (text, (), 2, "--technique"),
                                         (text, ("--technique", "major_axis,mc"), 2, "one technique"),
                                         (text, ("--technique", "major_axis", "--pipeline", "forward"), 2, "--pipeline"),
                                         (broken, ("--technique", "major_axis"), 4, f"line {line}:"),
                                         (text, ("--technique", "auto"), 2, "auto"),
                                         (text.replace("burnish_major_axis_specular(", "burnish_other("), ("--technique", "major_axis"), 4, "burnish_major_axis_specular"),
                                         (text.replace("struct burnish_settings {", "struct burnish_settings { burnish_settings x;"), ("--technique", "major_axis"), 4, "holds itself"),
                                         (text.replace("struct burnish_settings {", "struct burnish_settings {\n float a[N];"), ("--technique", "major_axis"), 4, "number of elements"),
                                         (text.replace("struct burnish_settings {", "struct burnish_settings { // }" + "x" * 1000000 + "\n float a[9999999999];"), ("--technique", "major_axis"), 4, "number of elements"),
                                         ("burnish_major_axis_specular" + " " * 1000000 + "(", ("--technique", "major_axis"), 4, "burnish_settings"),
                                         (shared, ("--technique", "lobe_line"), 4, "burnish_lobe_line_shared"),
                                         (text.replace("struct burnish_settings", "struct burnish_other"), ("--technique", "major_axis"), 4, "burnish_settings"),
                                         (text.replace("precise vec3 n; // shading", "precise vec3 m; // shading"), ("--technique", "major_axis"), 4, "edited.glsl")):
        (bench.folder / "edited.glsl").write_text(content)
        done = bench.run("parity", "builtin:sphere", *words, "--glsl", "edited.glsl")
        if done.code == 77:
            raise Skipped(done.err.strip())
        done.expect(code).expect_one_line(needle)
    bench.run("parity", "builtin:sphere", "--technique", "mc", "--glsl", "missing.glsl").expect(4).expect_one_line("missing.glsl")


@case("export.wrong_options_say_one_line")
def wrong(bench):
    for words, code, needle in ((("glsl", "-o", "a.glsl"), 2, "--technique"), (("glsl", "--technique", "mc"), 2, "--output"),
                                (("glsl", "--technique", "auto", "-o", "a.glsl"), 2, "auto"), (("cg", "--technique", "mc", "-o", "a"), 2, "glsl"), (("three", "--technique", "mc", "-o", "a"), 2, "prefiltered"),
                                (("babylon", "--technique", "filtered_is", "-o", "a"), 2, "prefiltered"),
                                (("glsl", "--technique", "major_axis", "--samples", "65", "-o", "a.glsl"), 2, "64"),
                                (("wgsl", "--technique", "filtered_is", "--samples", "4096", "-o", "a.wgsl"), 2, "2047"),
                                (("hlsl", "--technique", "as_mc", "--samples", "1025", "-o", "a.hlsl"), 2, "4096"),
                                (("babylon", "--ltc", "--technique", "lobe_line", "-o", "a.js"), 2, "--ltc"),
                                (("glsl", "--technique", "mc", "-o", "no/a.glsl"), 7, "no/a.glsl")):
        bench.run("export", *words).expect(code).expect_one_line(needle)
    check("no effect" in bench.run("export", "glsl", "--technique", "bent_normal", "--samples", "5", "-o", "b.glsl").expect(0).err, "samples of a technique that takes none")
    (bench.folder / "b.glsl").unlink()
    check(bench.left_behind() == [], f"left {bench.left_behind()}")
