"""House rules that a script can check: includes, sizes, words, entries at the root.

Usage: layers.py ROOT. Prints one line a fault; exit code 1 where there is any.
"""

import os
import pathlib
import re
import subprocess
import sys

LAYERS = {"core": 0, "shading": 1, "raster": 2, "apps": 3}  # a layer includes itself and lower layers
EVERYWHERE = ("tests", "bench")                              # they see all layers
RENDERERS = ("tile", "vulkan", "reference")                  # they meet in raster/frame; raster/session sees them all

# The rooms of each layer. A room includes itself and those before it; a room within a room is a room of its own. Tables (*.def) lie
# beside the order: a file that a table names includes the table.
ROOMS = {
    "core": ("wasm", "base", "math", "simd", "jobs", "image", "image/io", "image/metrics", "scene", "scene/builtin", "scene/obj", "scene/mtlx", "scene/gltf", "lab"),
    "shading": ("lang", "kernels", "inputs", "models", "surface", "techniques", "lights", "stages",
                "bake", "bake/environment", "bake/tables", "bake/ltc", "bake/mipnet", "bake/mip", "lab"),
    "raster": ("rays", "frame", "tile", "vulkan", "vulkan/lab", "reference", "session"), # renderers do not include each other, see RENDERERS
    "apps": ("report", "cli", "pieces", "options", "info", "risks", "plan", "render", "serve", "live", "compare", "golden", "export", "wasm", "bake", "chart", "parity", "profile",
             "lab/mip", "lab/train", "lab/atlas", "lab/conform", "lab/plot", "lab/race", "lab/ltc", "lab", "examples"),
}
# Third-party headers and the folders that may include them.
THIRD_PARTY = (
    (r"OpenImageIO/|OpenEXR/|Imath/", ("core/image/io/openimageio_module.cpp",)), # the program would load any library included elsewhere
    (r"(jpeglib|png|zlib)\.h$", ("core/image/io", "tests/unit/image")),
    (r"draco/", ("core/scene/gltf",)),
    (r"pugixml", ("core/scene/mtlx",)),
    (r"meshoptimizer", ("core/scene", "raster/tile", "tests")),
    (r"tbb/|oneapi/", ("core/jobs", "raster/reference")), # the latter: Embree builds its trees with it
    (r".*intrin\.h$|cpuid\.h$", ("core/simd",)),
    (r"vulkan/", ("raster/vulkan", "tests/unit/vulkan")),
    (r"embree", ("raster/reference", "bench")), # bench races rays against the tile renderer
    (r"nlohmann/", ("core", "apps", "tests", "bench")),
    (r"gtest/|gmock/", ("tests", "apps/examples")),
    (r"benchmark/", ("bench",)),
    (r"(ranges|format)$", ()),  # GCC 12 and clang 14 do not agree on them
)

INTERFACE = "shading/lang/interface.glsl" # defines texel pages for all later includes

ROOT_ENTRIES = {"CMakeLists.txt", "CMakePresets.json", "LICENSE", "README.md", "core", "shading", "raster", "apps", "tests", "bench"}
SOURCES = (".h", ".cpp", ".py", ".sh", ".cmake", ".vert", ".frag", ".comp", ".glsl")
TYPE = re.compile(r"(?:struct|class|enum class|union) (\w+)(?: final)?(?: : [^;{]*)? \{")
TICKS = re.compile("rdts" + "c|cntvct" + "_el0")  # core/simd/ticks.h reads them
VAGUE_NAMES = ("utils", "util", "common", "helpers", "helper", "misc")
MAX_LINES, MAX_LINES_SIMD = 600, 900

# Libraries name fields of settings; the program knows which option sets one (apps/cli/field_options.cpp).
LIBRARIES = ("core", "shading", "raster")
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"')
OPTION = re.compile(r"(?<![\w-])--[a-z]")
# Core describes files; mip filters and nets belong to baking.
NOT_OF_CORE = re.compile(r"\b(mipnet|MipFile|MipFilter|MipSettings|SceneMips)\b")

# Each word is written in two pieces, so that this file does not hold it.
FORBIDDEN = (
    (re.compile("ffast" + "-math|Of" + r"ast\b|ffp-con" + "tract=(?!off)"), "arithmetic that is not the same everywhere"),
    (re.compile(r"_mm\w*_(rc" + "p|rsq" + "rt)|vrc" + "p|vrsq" + "rt"), "approximate reciprocals: processors differ"),
    (re.compile("/wo" + "rk/"), "a path of one machine"),
    (re.compile(r"\bTO" + r"DO\b|\bFIX" + r"ME\b|#if " + r"0\b"), "unfinished or dead code"),
)


def listed(root):
    """Returns the repository's files, and untracked files in its folders that could be added. The root may also hold users' images.
    Without git, returns everything except build folders."""
    def files(*which):
        done = subprocess.run(["git", "-C", str(root), "ls-files", "-z", *which], capture_output=True, check=True)
        return [pathlib.PurePosixPath(os.fsdecode(name)) for name in done.stdout.split(b"\0") if name]

    try:
        paths = files("--cached") + [path for path in files("--others", "--exclude-standard") if len(path.parts) > 1]
    except (OSError, subprocess.CalledProcessError):
        paths = [pathlib.PurePosixPath(path.relative_to(root)) for path in root.rglob("*") if path.is_file()]
        paths = [path for path in paths if path.parts[0] not in ("build", "out", ".git")]
    return sorted(path for path in paths if (root / path).is_file())


def lies_in(path, folders):
    return any(path.is_relative_to(folder) for folder in folders)


def room_of(path):
    """The innermost room that a file of a layer lies in, or None."""
    inside = str(path.parent).partition("/")[2]
    within = [room for room in ROOMS[path.parts[0]] if inside == room or inside.startswith(room + "/")]
    return max(within, key=len, default=None)


def is_kernel(path):
    """Returns True for text in the kernel language, which C++ and GLSL read."""
    return path.parts[0] == "shading" and path.name.endswith((".k.h", ".t.h"))


def check_include(path, quoted, name, files):
    """Yields the faults of one #include line."""
    top = path.parts[0]
    for pattern, folders in THIRD_PARTY:
        if re.match(pattern, name) and not lies_in(path, folders):
            yield f"<{name}> belongs to {' and '.join(folders) or 'nobody'}"
    if not quoted:
        return
    target = pathlib.PurePosixPath(name)
    if top in EVERYWHERE and path.parent / target in files:
        target = path.parent / target # tests may include a neighbour
    if target not in files:
        yield f'"{name}" is not a file of the project, seen from its root'
        return
    other = target.parts[0]
    if top in LAYERS and LAYERS.get(other, 99) > LAYERS[top]:
        yield f'{top} includes "{name}", which lies above it'
    if top == other and top in ROOMS and target.suffix != ".def":
        mine, theirs, order = room_of(path), room_of(target), ROOMS[top]
        if mine and theirs and order.index(theirs) > order.index(mine):
            yield f'{top}/{mine} includes "{name}", which comes after it in the order of rooms'
    if "lab" in target.parts and "lab" not in path.parts:
        yield f'includes "{name}" of a laboratory, which no file outside laboratories knows'
    if is_kernel(path) and not (lies_in(target, ("shading/lang", "shading/inputs")) or is_kernel(target) or target.match("shading/*.def")):
        yield f'a kernel includes "{name}"'
    if top == other == "raster" and len(path.parts) > 2 and len(target.parts) > 2:
        mine, theirs = path.parts[1], target.parts[1]
        if mine != theirs and mine in RENDERERS and theirs in RENDERERS:
            yield f'{mine} includes "{name}": renderers meet in raster/frame'
        if mine not in (*RENDERERS, "session") and theirs in RENDERERS:
            yield f'raster/{mine} includes "{name}" of a single renderer'
        if theirs == "session" != mine:
            yield f'raster/{mine} includes "{name}", which lies above it'


def is_stage(path):
    """Returns True for a shader's entry; *.glsl beside it are parts."""
    return path.parent == pathlib.PurePosixPath("shading/stages") and path.suffix != ".glsl"


def guarded(path, lines):
    """Returns True if a header is guarded. GLSL has no #pragma once, so files for GLSL need a macro."""
    glsl = is_kernel(path) or lies_in(path, ("shading/lang", "shading/inputs"))
    text = "\n".join(lines)
    return "#pragma once" in text or (glsl and re.search(r"#ifndef (\w+)\n#define \1", text))


def check_source(path, lines, files):
    top = path.parts[0]
    if path.suffix == ".h" and not guarded(path, lines):
        yield 1, "can be included twice"
    first = is_stage(path)
    for number, line in enumerate(lines, 1):
        include = re.match(r'\s*#\s*include\s*(["<])([^">]+)[">]', line)
        if include and first and include[2] != INTERFACE:
            yield number, f'a stage includes "{include[2]}" before "{INTERFACE}": it would find no texels'
        first = first and not include
        if include and (top in LAYERS or top in EVERYWHERE):
            for fault in check_include(path, include[1] == '"', include[2], files):
                yield number, fault
        if TICKS.search(line) and path != pathlib.PurePosixPath("core/simd/ticks.h"):
            yield number, "reads the processor's counter: ticks() does"
    if top in ROOMS and path.suffix in (".h", ".cpp") and not room_of(path):
        yield 0, "lies in no room that has a place in the order"
    limit = MAX_LINES_SIMD if path.is_relative_to("core/simd") else MAX_LINES
    if len(lines) > limit:
        yield limit, f"{len(lines)} lines, more than {limit}"


def types_of(path, lines):
    """Yields line and name of each type that a product's file defines for the whole program. Lanes define theirs once an instruction set."""
    if path.parts[0] not in LAYERS or path.suffix not in (".h", ".cpp") or lies_in(path, ("core/simd", "shading/lang")) or "_absent" in path.stem:
        return
    nameless, space = False, ""
    for number, line in enumerate(lines, 1):
        opened = re.match(r"namespace ([\w:]+) \{", line)
        if opened:
            space = opened[1] + "::"
        elif line == "namespace {":
            nameless = True
        elif nameless and line.startswith("}") and not line.startswith("};"):
            nameless = not re.match(r"} // namespace$", line)
        found = None if nameless else TYPE.match(line)
        if found:
            yield number, space + found[1]


def check_words(path, lines):
    """Yields faults of words and names in libraries."""
    top = path.parts[0]
    for number, line in enumerate(lines, 1):
        if top in LIBRARIES and path.suffix in (".h", ".cpp", ".def") and not line.lstrip().startswith("//"):
            for literal in LITERAL.findall(line):
                if OPTION.search(literal):
                    yield number, f'says "{literal}": a library names the field, the program its option'
        if top == "core" and path.suffix in (".h", ".cpp", ".def") and NOT_OF_CORE.search(line):
            yield number, f"core names {NOT_OF_CORE.search(line)[0]}, which lies above it"


def faults(root):
    paths = listed(root)
    files, types = set(paths), {}
    for entry in sorted({path.parts[0] for path in paths}):
        if entry not in ROOT_ENTRIES and not entry.startswith("."):
            yield entry, 0, "does not belong at the root"
    for path in paths:
        if path.stem.split(".")[0].lower() in VAGUE_NAMES:
            yield path, 0, "a name that says nothing"
        data = (root / path).read_bytes()
        if b"\0" in data[:8192]:
            continue
        lines = data.decode("utf-8", "replace").splitlines()
        for number, line in enumerate(lines, 1):
            for pattern, why in FORBIDDEN:
                if pattern.search(line):
                    yield path, number, f"'{pattern.search(line)[0]}': {why}"
        for number, name in types_of(path, lines):
            other = types.setdefault(name, path)
            if other != path:
                yield path, number, f"{name} is a type of {other} too: functions of both would have one name"
        if path.suffix in SOURCES or path.suffix == ".def":
            for number, fault in (*check_source(path, lines, files), *check_words(path, lines)):
                yield path, number, fault


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    found = list(faults(root))
    for path, number, fault in found:
        print(f"{path}:{number}: {fault}")
    print(f"{len(found)} faults")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
