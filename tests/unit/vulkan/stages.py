"""The built program's shaders from raster/vulkan/stages.txt, disassembled; shaders of raster/vulkan/lab are the laboratory's."""
import array
import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "kernels"))
import glslc_check  # noqa: E402


LAB = "lab/"


def names(root):
    """Names of all shaders, with their folder below raster/vulkan."""
    for folder in ("", LAB):
        for line in (Path(root) / "raster/vulkan" / folder / "stages.txt").read_text().splitlines():
            if re.match("[a-z]", line):
                yield folder + line.split()[0]


def without_names(module):
    """Removes OpName and OpMemberName, which slow spirv-val down thirty times."""
    words = array.array("I", module)
    kept, at = words[:5], 5
    while at < len(words):
        end = at + (words[at] >> 16)
        if words[at] & 0xFFFF not in (5, 6):
            kept += words[at:end]
        at = end
    return kept.tobytes()


def validate(folder, name):
    module = without_names((Path(folder) / f"{name}.spv").read_bytes())
    subprocess.run(["spirv-val", "--target-env", "vulkan1.3", "-"], input=module, check=True)


def assembly(folder, name):
    return subprocess.run(["spirv-dis", "--raw-id", Path(folder) / f"{name}.spv"], capture_output=True, text=True, check=True).stdout
