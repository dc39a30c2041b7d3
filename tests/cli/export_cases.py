"""burnish export glsl: techniques as files for other engines, compiled alone, and compared word for word in place of the program's text."""

import pathlib
import re
import shutil
import subprocess

from harness import Skipped, case, check
from parity_cases import ROOT, check_equal, compile_stages, parity

MODELS = (ROOT / "shading/models.def").read_text()
TECHNIQUES = re.findall(r"^BN_TECHNIQUE\((\w+), (\w+)", MODELS, re.MULTILINE)
OF_GRIDS = re.findall(r"^BN_TECHNIQUE\((\w+),(?: grid,|[^\n]*kPhongGrid)", MODELS, re.MULTILINE)
FETCHES = ("cube_desc", "cube_sum", "cube_sum_levels", "cube_terms", "cube_sum_begin", "cube_sum_levels_at", "cube_sum_add", "cube_sum_value",
           "cube_terms_begin", "cube_terms_add", "cube_terms_add_level", "cube_terms_value")


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


def members(text, struct, to, source):
    """Returns statements that fill a struct of the file from one of the program."""
    body = re.search(rf"struct burnish_{struct} \{{(.*?)\n\}};", re.sub(r"//[^\n]*", "", text), re.DOTALL)[1]
    lines = []
    for declaration in filter(None, (d.strip() for d in body.split(";"))):
        *kind, names = declaration.replace("precise ", "").split(maxsplit=1)
        for name in (n.strip() for n in names.split(",")):
            field, size = re.fullmatch(r"(\w+)(?:\[(\d+)\])?", name).groups()
            if (struct, field) == ("settings", "samples"):
                continue  # for point_of() alone: the program's points have theirs
            if kind[0].startswith("burnish_"):
                lines += members(text, kind[0][len("burnish_"):], f"{to}.{field}", f"{source}.{field}")
            else:
                lines += [f"{to}.{field}{at} = {source}.{field}{at};" for at in ([f"[{i}]" for i in range(int(size))] if size else [""])]
    return lines


def in_place(text, name):
    """Returns GLSL that calls the file's functions in place of the program's."""
    hooks = ["#define BURNISH_OWN_FETCHES"] + [f"#define burnish_{fetch} {fetch}" for fetch in FETCHES]
    hooks += [f"#define burnish_{cube}(f) {cube}(0)" for cube in ("prefiltered_env", "mip_env", "full_env")]
    hooks += ["#define burnish_grid_sample(f, i) grid_sample(0, i)", "#define burnish_grid_of_four(f, i, set) grid_of_four(0, i, set)", "#define burnish_fetched cube_sample",
              "#define burnish_fetched_level cube_sample_level"]
    code = hooks + [text]
    for function, result, struct, parameter, source in (("program_settings", "settings", "settings", "", "frame"),
                                                        ("program_point", "shaded_point", "shaded_point", "shaded_point x", "x")):
        code += [f"burnish_{result} {function}({parameter})", "{", f"burnish_{result} r;", *members(text, struct, "r", source), "return r;", "}"]
    code.append(f"#define {name}_specular(f, x) burnish_{name}_specular(program_settings(), program_point(x))")
    if f"burnish_{name}_shared" in text:
        code += ["shared_sample_record program_record(burnish_shared_sample_record x)", "{", "shared_sample_record r;", *members(text, "shared_sample_record", "r", "x"), "return r;", "}",
                 f"#define {name}_shared(f, x, o) program_record(burnish_{name}_shared(program_settings(), program_point(x), o))"]
    return "\n".join(code) + "\n"


def own_names(text, name):
    """Returns the text with unique function names, so that the files of all techniques fit in one shader."""
    return re.sub(r"\b(burnish_|program_)", rf"{name}_\1", text)


def compare_exported(bench, names, changed=lambda text: text, code=0):
    compiler()
    source, shaders = bench.folder / "source", bench.folder / "shaders"
    shutil.copytree(ROOT / "shading", source / "shading", ignore=shutil.ignore_patterns("bake"))
    (source / "core/scene").mkdir(parents=True)
    for table in (ROOT / "core/scene").glob("*.def"):
        shutil.copy(table, source / "core/scene")
    shaders.mkdir()
    built = list((pathlib.Path(bench.program).resolve().parent / "raster/vulkan").glob("*.spv"))
    for file in built:
        shutil.copy(file, shaders)
    if not built:
        compile_stages(ROOT, shaders)
    path = source / "shading/lang/techniques.h"
    text = path.read_text()
    place = "real3 technique_specular(frame_ref f, technique_ref technique"
    check(text.count(place) == 1, f"techniques.h does not hold '{place}' any more")
    own = "".join(own_names(in_place(changed(exported(bench, name)), name), name) for name in names)
    path.write_text(text.replace(place, own + place))
    compile_stages(source, shaders, "shade")
    words = ("builtin:teapot", "builtin:plate", "--size", "96x64", "--technique", ",".join(names), "--msaa", "1", "--shaders", shaders)
    also = [("--tilt", "8,4", "--energy-compensation", "--axis-k", "1.5", "--samples", "9")] if code == 0 else []
    return parity(bench, *words, also=also, code=code, timeout=600.0)


# Uses one shader for all, since a driver takes seconds to compile each.
@case("export.files_give_the_program_s_words", tier="nightly")
def gives_the_program_s_words(bench):
    names = [name for name, _ in TECHNIQUES]
    report = compare_exported(bench, names)
    check_equal(report)
    for also in {row["also"] for row in report["rows"]}:
        check({row["technique"] for row in report["rows"] if row["also"] == also} == set(names), "a technique is missing")
    check(len(report["rows"]) == 2 * 2 * len(names), f"{len(report['rows'])} rows")


@case("export.another_word_in_the_file_is_seen", tier="nightly")
def seen(bench):
    def wider(text):
        check("w * ((2.0) * burnish_k_dot3(w, o)) - o" in text, "the mirror is written otherwise")
        return text.replace("w * ((2.0) * burnish_k_dot3(w, o)) - o", "w * ((2.0000005) * burnish_k_dot3(w, o)) - o")

    report = compare_exported(bench, ["major_axis"], wider, code=1)
    check({row["first_difference"] for row in report["rows"]} == {"shaded colour"}, f"{report['rows']}")


@case("export.wrong_options_say_one_line")
def wrong(bench):
    for words, code, needle in ((("glsl", "-o", "a.glsl"), 2, "--technique"), (("glsl", "--technique", "mc"), 2, "--output"),
                                (("glsl", "--technique", "auto", "-o", "a.glsl"), 2, "auto"), (("cg", "--technique", "mc", "-o", "a"), 2, "glsl"), (("three", "--technique", "mc", "-o", "a"), 2, "prefiltered"),
                                (("babylon", "--technique", "filtered_is", "-o", "a"), 2, "prefiltered"),
                                (("glsl", "--technique", "major_axis", "--samples", "65", "-o", "a.glsl"), 2, "64"),
                                (("glsl", "--technique", "mc", "-o", "no/a.glsl"), 7, "no/a.glsl")):
        bench.run("export", *words).expect(code).expect_one_line(needle)
    check(bench.left_behind() == [], f"left {bench.left_behind()}")
