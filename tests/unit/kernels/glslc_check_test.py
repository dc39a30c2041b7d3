"""glslc_check.py finds planted faults. usage: glslc_check_test.py SOURCE_ROOT"""
import sys
import tempfile
from pathlib import Path

import glslc_check

GOOD = "BN_FN real good(real a, real3 b) { real3 c = b * a + b; return sqrt(c.x) * a + c.y; }\n"
BAD = {
    "float without precise": ("BN_FN float bad(float a) { return a * a + a; }\n", "NoContraction"),
    "GLSL's own function": ("BN_FN real bad(real a) { return pow(a, a); }\n", "Pow"),
    "GLSL's own dot": ("BN_FN float bad(vec3 a) { return dot(a, a); }\n", "OpDot"),
    "no GLSL": ("BN_FN real bad(const real& a) { return a; }\n", "does not compile"),
}


def main():
    if glslc_check.tools_missing():
        return 77
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        kernel = Path(folder) / "case.k.h"
        kernel.write_text(GOOD)
        faults, looked_at, functions = glslc_check.check(sys.argv[1], kernel)
        if faults or functions != 1 or looked_at < 4:
            print("good kernel:", faults, looked_at, functions)
            failures += 1
        for name, (text, expected) in BAD.items():
            kernel.write_text(GOOD + text)
            faults, _, _ = glslc_check.check(sys.argv[1], kernel)
            if not any(expected in fault for fault in faults):
                print(f"{name}: expected a fault that names {expected}, got {faults}")
                failures += 1
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
