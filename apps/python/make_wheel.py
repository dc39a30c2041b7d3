#!/usr/bin/env python3
"""Makes a wheel of the Python package with the library in it: one for every Python from 3.9 on, on this kind of machine.

Usage: make_wheel.py --library build/release/raster/session/libburnish.so [--module build/release/burnish_openimageio.so] -o FOLDER

The wheel needs the system's libraries that libburnish.so is linked with. Equal inputs give equal bytes.
"""

import argparse
import base64
import hashlib
import pathlib
import platform
import re
import zipfile

HERE = pathlib.Path(__file__).resolve().parent
WHEN = (1980, 1, 1, 0, 0, 0)  # of every file in the wheel


def digest(data):
    return "sha256=" + base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--library", type=pathlib.Path, required=True)
    parser.add_argument("--module", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    options = parser.parse_args()
    version = re.search(r"project\(burnish.*?VERSION ([\d.]+)", (HERE.parents[1] / "CMakeLists.txt").read_text(), re.S)[1]
    tag = f"py3-none-linux_{platform.machine()}"
    info = f"burnish-{version}.dist-info"
    sources = (path for path in sorted((HERE / "burnish").rglob("*")) if path.suffix in (".py", ".pyi", ".typed"))
    files = {str(path.relative_to(HERE)): path.read_bytes() for path in sources}
    files["burnish/libburnish.so"] = options.library.resolve().read_bytes()
    if options.module:
        files[f"burnish/burnish/{options.module.name}"] = options.module.read_bytes()
    files[f"{info}/METADATA"] = (f"Metadata-Version: 2.1\nName: burnish\nVersion: {version}\nRequires-Python: >=3.9\n"
                                 "Summary: Pictures of brushed metal and other anisotropic materials, drawn on the CPU\n").encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: make_wheel.py\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    record = "".join(f"{name},{digest(data)},{len(data)}\n" for name, data in files.items()) + f"{info}/RECORD,,\n"
    files[f"{info}/RECORD"] = record.encode()
    options.output.mkdir(parents=True, exist_ok=True)
    path = options.output / f"burnish-{version}-{tag}.whl"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as wheel:
        for name, data in files.items():
            entry = zipfile.ZipInfo(name, WHEN)
            entry.external_attr, entry.compress_type = 0o644 << 16, zipfile.ZIP_DEFLATED
            wheel.writestr(entry, data)
    print(path)


if __name__ == "__main__":
    main()
