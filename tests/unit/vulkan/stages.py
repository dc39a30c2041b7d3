"""The shaders of raster/vulkan/stages.txt, compiled and disassembled."""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "kernels"))
import glslc_check  # noqa: E402


def lines(root):
    for line in (Path(root) / "raster/vulkan/stages.txt").read_text().splitlines():
        if re.match("[a-z]", line):
            name, file, *defines = line.split()
            yield name, file, defines


def assembly(root, file, defines):
    with tempfile.TemporaryDirectory() as folder:
        binary = Path(folder) / "stage.spv"
        subprocess.run(["glslc", "-w", "--target-env=vulkan1.3", f"-I{root}", *defines, Path(root) / "shading/stages" / file, "-o", binary], check=True)
        subprocess.run(["spirv-val", "--target-env", "vulkan1.3", binary], check=True)
        return subprocess.run(["spirv-dis", binary], capture_output=True, text=True, check=True).stdout
