"""The structures of shading/lang/records.h and gpu_records.h have equal layouts in C++ and in the stages' SPIR-V: member offsets, array
strides.
usage: layout_check.py ROOT FOLDER-OF-SPV COMPILER"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import stages
from stages import glslc_check


def members(root, compiler):
    """Returns {structure: [member, ...]} in text order."""
    command = [compiler, "-E", "-P", "-x", "c++", f"-I{root}", Path(root) / "shading/lang/gpu_records.h"]
    text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    found = {}
    for name, body in re.findall(r"struct (\w+) \{(.*?)\};", text, re.DOTALL):
        names = []
        for declaration in body.split(";"):
            words = declaration.split(None, 1)
            if len(words) == 2:
                names += [re.match(r"\w+", part.strip())[0] for part in words[1].split(",")]
        found[name] = names
    return found


def cpp_layout(root, compiler, structures):
    """Returns {(structure, member): offset}, and {(structure, ""): size}, from the compiler."""
    source = ["#include <cstddef>", "#include <cstdio>", '#include "shading/lang/gpu_records.h"', "int main() {", "using namespace burnish;"]
    for name, names in structures.items():
        source += [f'std::printf("{name} {m} %zu\\n", offsetof({name}, {m}));' for m in names]
        source.append(f'std::printf("{name} - %zu\\n", sizeof({name}));')
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "layout.cpp"
        path.write_text("\n".join(source + ["}"]))
        subprocess.run([compiler, "-std=c++20", f"-I{root}", path, "-o", Path(folder) / "layout"], check=True)
        out = subprocess.run([Path(folder) / "layout"], capture_output=True, text=True, check=True).stdout
    layout = {}
    for line in out.splitlines():
        name, member, offset = line.split()
        layout[name, member.removeprefix("-")] = int(offset)
    return layout


def spirv_layout(assembly):
    """Returns {(structure, member): offset} of structures with offsets, and {(structure, ""): stride} of array elements. The block
    BnFrame holds the members of GpuFrame."""
    names = dict(re.findall(r'OpName (%\S+) "(\w+)"', assembly.replace('"BnFrame"', '"GpuFrame"')))
    member = {(t, i): m for t, i, m in re.findall(r'OpMemberName (%\S+) (\d+) "(\w+)"', assembly)}
    layout = {}
    for t, i, offset in re.findall(r"OpMemberDecorate (%\S+) (\d+) Offset (\d+)", assembly):
        if t in names and (t, i) in member:
            layout[names[t], member[t, i]] = int(offset)
    strides = dict(re.findall(r"OpDecorate (%\S+) ArrayStride (\d+)", assembly))
    for array, element in re.findall(r"(%\S+) = OpType(?:Runtime)?Array (%\S+)", assembly):
        if array in strides and element in names:
            layout[names[element], ""] = int(strides[array])
    return layout


def main():
    if glslc_check.tools_missing():
        return 77
    root, folder, compiler = sys.argv[1:4]
    structures = members(root, compiler)
    expected, seen, bad = cpp_layout(root, compiler, structures), set(), 0
    for name in stages.names(root):
        for key, offset in spirv_layout(stages.assembly(folder, name)).items():
            if key[0].startswith("Bn") and offset != 0 and key[1]:  # a block with one structure, or an array of structures
                print(f"{name}: {'.'.join(key)} begins at {offset}")
                bad += 1
            if key[0] not in structures:
                continue
            seen.add(key)
            if expected.get(key) != offset:
                print(f"{name}: {'.'.join(key)} at {offset}, in C++ at {expected.get(key)}")
                bad += 1
    missing = [key for key in expected if key not in seen and key[1] != ""]
    for key in missing:
        print(f"no stage holds {'.'.join(key)}")
    print(f"{len(seen)} offsets and strides of {len(structures)} structures compared, {bad} differ")
    return 1 if bad or missing else 0


if __name__ == "__main__":
    sys.exit(main())
