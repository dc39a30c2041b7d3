"""The shaders of raster/vulkan/stages.txt as the program was built with them, disassembled."""
import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "kernels"))
import glslc_check  # noqa: E402


def lines(root):
    for line in (Path(root) / "raster/vulkan/stages.txt").read_text().splitlines():
        if re.match("[a-z]", line):
            yield line.split()[:2]  # name, file


def validate(folder, name):
    subprocess.run(["spirv-val", "--target-env", "vulkan1.3", Path(folder) / f"{name}.spv"], check=True)


def assembly(folder, name):
    return subprocess.run(["spirv-dis", Path(folder) / f"{name}.spv"], capture_output=True, text=True, check=True).stdout
