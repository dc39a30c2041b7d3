#!/usr/bin/env python3
"""Writes burnish/__init__.pyi: types, defaults and meanings of every keyword, for editors and type checkers.

Usage: make_stubs.py [--library FILE] [--output FILE]    (burnish/__init__.pyi beside this script; - prints)

Meanings come from the library, by burnish.options(). Types and defaults come from the tables below, and from the tables that the library is
made with: shading/models.def, shading/layers.def and core/scene/material.def.
"""

import argparse
import os
import pathlib
import re
import sys
import textwrap

sys.dont_write_bytecode = True
HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
WIDTH = 140
EVERY, DRAWS, TRACES = ("render", "reference"), ("render",), ("reference",)
LOADS, SCENES, LIGHTS = ("load",), ("load", "meshes"), ("load", "meshes", "set_environment")

# Options that are no parameters of techniques: type, default, the functions that read them. Defaults come from FrameDesc, OpenOptions and
# ReferenceOptions; None leaves an option unset.
OPTIONS = {
    "width": ("int", "1280", EVERY), "height": ("int", "720", EVERY), "msaa": ("Literal[1, 2, 4, 8, 16]", "8", DRAWS),
    "technique": ("Technique", '"auto"', DRAWS), "samples": ("int | None", "None", DRAWS), "roughness": ("float | None", "None", EVERY),
    "anisotropy": ("float | None", "None", EVERY), "background": ("bool", "True", EVERY), "texture_anisotropy": ("int", "16", EVERY),
    "eye": ("Vector3 | None", "None", EVERY), "target": ("Vector3 | None", "None", EVERY), "orbit": ("Vector2 | None", "None", EVERY),
    "fov": ("float | None", "None", EVERY), "zoom": ("float", "1.0", EVERY), "camera": ("int | str | None", "None", EVERY),
    "shadows": ('Literal["off", "ratio", "on"]', '"off"', DRAWS), "shadow_samples": ("int", "16", DRAWS),
    "layers": ("Sequence[Layer]", "()", DRAWS), "aov": ("Sequence[Layer]", "()", DRAWS),
    "resolve": ('Literal["linear", "display", "weighted"]', '"display"', DRAWS),
    "reference_mode": ('Literal["direct", "shadowed", "path"]', '"direct"', TRACES), "bounces": ("int", "8", TRACES),
    "reference_textures": ('Literal["footprint", "full"]', '"footprint"', TRACES), "target_error": ("float | None", "None", TRACES),
    "threads": ("int", "0", SCENES), "floor": ('Literal["off", "shadow", "stage", "mirror"]', '"off"', LOADS), "light": ("str | Sequence[str]", "()", SCENES), "time": ("float | None", "None", LOADS),
    "animation": ("int", "0", LOADS), "variant": ("str | None", "None", LOADS), "f0": ("Vector3 | None", "None", LOADS), "mip_filter": ("MipFilter", '"box"', LOADS),
    "mip_kappa": ("float", "0.7", LOADS), "mip_gain": ('Literal["off", "on"]', '"off"', LOADS),
    "fallback": ('Literal["auto", "off"]', '"auto"', LOADS), "couple": ('Literal["none", "albedo"]', '"none"', LOADS),
    "color_kernel": ('Literal["box", "kaiser"]', '"box"', LOADS), "env_size": ("Literal[16, 32, 64, 128, 256, 512, 1024, 2048]", "512", LIGHTS),
    "env_samples": ("int", "1024", LIGHTS), "env_rotation": ("float", "0.0", LIGHTS), "env_exposure": ("float", "0.0", LIGHTS),
    "key_lights": ('int | Literal["auto", "off"]', '"auto"', LIGHTS), "cache": ("bool", "True", LIGHTS),
}
KINDS = {"number": "float", "vec2": "Vector2", "vec3": "Vector3", "vec4": "Vector4"}


def literal(names):
    return "Literal[" + ", ".join(f'"{name}"' for name in names) + "]"


def lines_of(file, macro):
    """Returns the arguments of a table's lines: BN_MACRO(argument, ...)."""
    text = (ROOT / file).read_text()
    calls = re.findall(rf"^{macro}\(((?:\"[^\"]*\"|[^\"()]|\([^()]*\))*)\)", text, re.M)
    split = [[argument.strip().strip('"') for argument in re.findall(r'(?:"[^"]*"|[^",])+', call)] for call in calls]
    return [arguments for arguments in split if len(arguments) > 2]


def reference_reads(readers=""):
    """Returns True if the readers of a BN_PARAMETER line include the reference."""
    return not readers or readers.startswith("all but ") != ("reference" in readers.split())


def parameters():
    """Returns {option: (type, default, functions, range)} of the parameters of techniques."""
    ways = [name for _, _, name, *_ in lines_of("shading/models.def", "BN_AREA_LIGHTS")]
    lobes = [line[0] for line in lines_of("shading/models.def", "BN_LOBE")]
    table = {}
    for _, kind, option, fallback, least, most, unit, _, *readers in lines_of("shading/models.def", "BN_PARAMETER"):
        name = option.replace("-", "_")
        choices = {"way": ways, "lobe": lobes, "choice": unit.split("|")}.get(kind, [])
        shown = {"number": "float", "whole": "int", "flag": "bool", "angles": "Vector2"}.get(kind) or literal(choices)
        plain = {"flag": str(fallback != "0"), "angles": "(0.0, 0.0)", "number": fallback}.get(kind, fallback)
        default = f'"{choices[int(fallback)]}"' if choices else plain
        bounds = f"{least} to {most}" if kind in ("number", "whole") else ""
        functions = EVERY if reference_reads(*readers) else DRAWS
        table[name] = shown, default, functions, bounds
    return table


def keywords(burnish):
    """Returns [(name, type, default, functions, meaning)] of all options."""
    table = parameters()
    found = []
    for name, meaning in burnish.options().items():
        if name in OPTIONS:
            (shown, default, functions), bounds = OPTIONS[name], ""
        else:
            shown, default, functions, bounds = table[name]
        plain = re.sub(r"(?<=\d)\.0\b", "", bounds)
        found_bounds = re.search(rf"(?<![\d.]){re.escape(plain)}(?![\d.]*\d)", meaning)
        meaning += f". {plain}" if bounds and not found_bounds else ""
        found.append((name, shown, default, functions, meaning))
    left = (set(OPTIONS) | set(table)) - {name for name, *_ in found}
    if left:
        raise SystemExit(f"make_stubs.py: the library lacks {sorted(left)}")
    return found


def notes_of_factors():
    """Returns {factor: what the comments of the materials' table say of it}."""
    notes = {}
    head = r"\w+(?:, \w+)*: "
    for names, text in re.findall(rf"^// ({head})(.*(?:\n// (?!{head}).*)*)", (ROOT / "core/scene/material.def").read_text(), re.M):
        plain = text.replace("\n// ", " ").replace(" (see --tilt)", "").rstrip(".")
        notes.update({name: plain[0].upper() + plain[1:] for name in names[:-2].split(", ")})
    return notes


def factors():
    """Returns [(name, type, default, (), meaning)] of the materials' keywords."""
    notes, found = notes_of_factors(), []
    for kind, name, fallback, path, least, most in lines_of("core/scene/material.def", "BN_FACTOR"):
        number = repr(float(fallback.rstrip("f")))
        # burnish.meshes() begins with a material that is no metal.
        default = "0.0" if name == "metallic" else number if kind == "number" else "(" + ", ".join([number] * int(kind[3])) + ")"
        bounds = "any number" if "kAny" in least else f"{least} or more" if most == "kAny" else f"{float(least):g} to {float(most):g}"
        found.append((name, KINDS[kind], default, (), ". ".join(filter(None, (bounds, gltf_place(path), notes.get(name))))))
    return found + [(name, "bool", "False", (), ". ".join(filter(None, (gltf_place(path), notes.get(name)))))
                    for _, name, path in lines_of("core/scene/material.def", "BN_FLAG")]


def light_factors():
    """Returns [(name, type, default, (), meaning)] of the lights' keywords."""
    units = {"intensity": "candela, or lux of directional lights", "range": "metres", "inner_cone": "radians", "outer_cone": "radians"}
    return [(name, f"{KINDS[kind]} | None", "None", (), ". ".join(filter(None, (gltf_place(path), units.get(name)))))
            for kind, name, _, path, *_ in lines_of("core/scene/light.def", "BN_LIGHT_FACTOR")]


def gltf_place(path):
    return f"glTF: {path[1:].replace('extensions/', '')}"


def signature(entries, indent):
    """Returns a line for each parameter, and several for one with many names."""
    lines = []
    for name, shown, default, *_ in entries:
        line = f"{indent}{name}: {shown} = {default},"
        if len(line) > WIDTH:
            inner = textwrap.wrap(shown[len("Literal[") : -1] + ",", WIDTH - len(indent) - 4)
            line = "\n".join([f"{indent}{name}: Literal[", *(f"{indent}    {part}" for part in inner), f"{indent}] = {default},"])
        lines.append(line + "\n")
    return "".join(lines)


def meanings(entries, indent):
    """Returns the lines of a docstring: each name with its meaning."""
    wrapped = (textwrap.wrap(f"{name}: {meaning.rstrip('., ')}.", WIDTH - len(indent), subsequent_indent="    ", break_on_hyphens=False)
               for name, *_, meaning in entries)
    return "".join(f"{indent}{line}\n" for lines in wrapped for line in lines)


def stub(burnish):
    """Returns the text of __init__.pyi."""
    every, layers = keywords(burnish), [line[2] for line in lines_of("shading/layers.def", "BN_LAYER")] + ["object-id", "material-id"]
    parts = {"TECHNIQUES": literal(["auto", *burnish.techniques()]), "LAYERS": literal(layers),
             "FILTERS": literal([line[2] for line in lines_of("shading/models.def", "BN_MIP_FILTER")])}
    for function in ("load", "meshes", "render", "reference", "set_environment"):
        parts[function.upper()] = [entry for entry in every if function in entry[3]]
    parts["FACTORS"] = factors()
    parts["LIGHT"] = light_factors()
    parts["MATERIAL"] = [(name, f"{shown} | None", "None") for name, shown, *_ in parts["FACTORS"]]
    for place, indent in (("LOAD", 4), ("MESHES", 4), ("RENDER", 8), ("REFERENCE", 8), ("FACTORS", 8), ("LIGHT", 8)):
        parts[place + "_MEANINGS"] = meanings(parts[place], " " * indent)
    for place, indent in (("LOAD", 4), ("MESHES", 4), ("RENDER", 8), ("REFERENCE", 8), ("FACTORS", 8), ("LIGHT", 8), ("MATERIAL", 8),
                          ("SET_ENVIRONMENT", 8)):
        parts[place] = signature(parts[place], " " * indent)
    return re.sub(r"^ *@(\w+)@\n|@(\w+)@", lambda at: parts[at[1] or at[2]], (HERE / "stub.in").read_text(), flags=re.M)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--library", help="libburnish.so; otherwise where the package finds it")
    parser.add_argument("-o", "--output", default=str(HERE / "burnish/__init__.pyi"))
    options = parser.parse_args()
    if options.library:
        os.environ["BURNISH_LIBRARY"] = options.library
    sys.path.insert(0, str(HERE))
    import burnish

    text = stub(burnish)
    if options.output == "-":
        sys.stdout.write(text)
    else:
        pathlib.Path(options.output).write_text(text)


if __name__ == "__main__":
    main()
