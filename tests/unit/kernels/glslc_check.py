"""Compiles a file in the kernel language (kernels *.k.h, assembly *.t.h) as GLSL and checks its SPIR-V. Every operation on reals must
carry NoContraction, and of GLSL's functions only the exact ones are allowed. Otherwise GPU and CPU differ in bits.

usage: glslc_check.py SOURCE_ROOT FILE    exit 77: glslc or spirv-dis is absent
"""
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROUNDED = {"OpFAdd", "OpFSub", "OpFMul", "OpFDiv", "OpFRem", "OpFMod", "OpVectorTimesScalar", "OpMatrixTimesScalar",
           "OpVectorTimesMatrix", "OpMatrixTimesVector", "OpMatrixTimesMatrix", "OpOuterProduct", "OpDot"}
EXACT_FUNCTIONS = {"FAbs", "SAbs", "Floor", "Ceil", "Sqrt", "RoundEven", "UnpackHalf2x16"}
FUNCTION = re.compile(r"^BN_FN\s+(\w+)\s+(\w+)\s*\(([^{;]*)\)\s*\{", re.MULTILINE)
TYPE = re.compile(r"(?:BN_IN|BN_INOUT)\((\w+)\)|(?:const\s+)?(\w+)")


def shader_for(text, include):
    """Returns a compute shader that calls every function in the kernel file, so that none is stripped."""
    calls = []
    for result, name, parameters in FUNCTION.findall(text):
        declarations, arguments = [], []
        for k, parameter in enumerate(p.strip() for p in parameters.split(",") if p.strip()):
            found = TYPE.match(parameter)
            declarations.append(f"{found[1] or found[2]} p{k};")
            arguments.append(f"p{k}")
        call = f"{name}({', '.join(arguments)});"
        calls.append(f"    {{ {' '.join(declarations)} {call if result == 'void' else f'{result} r = {call}'} }}")
    stage = ["#extension GL_EXT_buffer_reference_uvec2 : require"] if include.endswith(".t.h") else ['#include "shading/lang/lang.h"']
    lines = ["#version 460", *stage, f'#include "{include}"', "layout(local_size_x = 1) in;", "void main()", "{", *calls, "}"]
    return "\n".join(lines) + "\n", len(calls)


def compile_shader(root, text, folder):
    source = Path(folder) / "kernel.comp"
    source.write_text(text)
    binary = Path(folder) / "kernel.spv"
    # -w: unneeded `precise` qualifiers cause hundreds of warnings.
    command = ["glslc", "-w", "-O0", "--target-env=vulkan1.3", f"-I{root}", f"-I{folder}", str(source), "-o", str(binary)]
    run = subprocess.run(command, capture_output=True, text=True)
    if run.returncode:
        return None, run.stderr
    return subprocess.run(["spirv-dis", "--raw-id", str(binary)], capture_output=True, text=True, check=True).stdout, ""


def faults_in(assembly):
    """Returns the faults, and the number of operations checked."""
    kept = set(re.findall(r"OpDecorate (%\S+) NoContraction", assembly))
    names = dict(re.findall(r'OpName (%\S+) "([^"(]*)', assembly))
    faults, looked_at, function = [], 0, "?"
    for line in assembly.splitlines():
        begin = re.match(r"\s*(%\S+) = OpFunction ", line)
        if begin:
            function = names.get(begin.group(1), begin.group(1))
        operation = re.match(r"\s*(%\S+) = (Op\w+) ", line)
        if not operation:
            continue
        if operation.group(2) in ROUNDED:
            looked_at += 1
            if operation.group(1) not in kept:
                faults.append(f"{function}: {line.strip()} is not NoContraction: name its value as a real")
        if operation.group(2) == "OpExtInst":
            called = line.split("OpExtInst", 1)[1].split()[2]
            if called not in EXACT_FUNCTIONS:
                faults.append(f"{function}: GLSL's own {called} is not exact: see shading/kernels/math.k.h")
    return faults, looked_at


def check(root, kernel):
    text = Path(kernel).read_text()
    with tempfile.TemporaryDirectory() as folder:
        include = Path(kernel).name
        (Path(folder) / include).write_text(text)
        shader, functions = shader_for(text, include)
        assembly, errors = compile_shader(root, shader, folder)
    if assembly is None:
        return [f"does not compile as GLSL:\n{errors}"], 0, functions
    faults, looked_at = faults_in(assembly)
    return faults, looked_at, functions


def tools_missing():
    missing = [tool for tool in ("glslc", "spirv-dis") if not shutil.which(tool)]
    if missing:
        print("skipped: no", " and no ".join(missing), "here")
    return bool(missing)


def main():
    if tools_missing():
        return 77
    root, kernel = sys.argv[1:3]
    faults, looked_at, functions = check(root, kernel)
    for fault in faults:
        print(f"{kernel}: {fault}")
    print(f"{Path(kernel).name}: {functions} functions, {looked_at} rounded operations, {len(faults)} faults")
    if not functions:
        print("no BN_FN function found")
    return 1 if faults or not functions else 0


if __name__ == "__main__":
    sys.exit(main())
