"""In every stage each operation on reals carries NoContraction, and only exact GLSL functions are used. usage: spirv_check.py ROOT
FOLDER-OF-SPV"""
import sys

import stages
from stages import glslc_check

INTEGER_FUNCTIONS = {"FindILsb"}  # exact by nature
DEVICE_FUNCTIONS = {"InterpolateAtOffset"}  # set by the rasterizer, like interpolation at pixel centres


def main():
    if glslc_check.tools_missing():
        return 77
    (root, folder), bad, operations = sys.argv[1:3], 0, 0
    glslc_check.EXACT_FUNCTIONS |= INTEGER_FUNCTIONS | DEVICE_FUNCTIONS
    for name in stages.names(root):
        stages.validate(folder, name)
        if name.startswith(stages.LAB):  # separate text with other bits
            continue
        faults, looked_at = glslc_check.faults_in(stages.assembly(folder, name))
        operations += looked_at
        for fault in faults:
            print(f"{name}: {fault}")
        bad += len(faults)
        print(f"{name}: {looked_at} rounded operations, {len(faults)} faults")
    if operations < 1000:
        print("hardly anything was looked at")
        return 1
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
