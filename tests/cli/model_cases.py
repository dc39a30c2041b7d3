"""Every model of the test data renders: no NaN, a visible object, equal pixels from scalar code."""

import struct

from harness import SMALL, case, check, data_files, words_of


def read_pfm(path):
    """Returns rows of floats in file order."""
    with open(path, "rb") as file:
        kind, size, scale = file.readline().strip(), file.readline().split(), float(file.readline())
        width, height = int(size[0]), int(size[1])
        check(kind == b"PF", f"{path}: not an RGB PFM")
        values = struct.unpack(("<" if scale < 0 else ">") + "f" * (width * height * 3), file.read())
    return width, height, values


def add_data_cases(data):
    for name, path in data_files(data, "models", (".glb", ".gltf")).items():

        def run(bench, path=path):
            figures = bench.figures(path, *SMALL, "--no-background", "-o", "model.pfm")
            check(figures["nan_pixels"] == 0, f"{figures['nan_pixels']} pixels are not finite")
            check(figures["triangles"] > 0 and figures["visible_fragments"] > 500, f"nothing to see: {figures}")
            width, height, values = read_pfm(bench.folder / "model.pfm")
            lit = sum(1 for i in range(0, len(values), 3) if max(values[i : i + 3]) > 1e-4)
            share = lit / (width * height)
            check(share > 0.02, f"only {100 * share:.1f} % of the pixels are lit")
            check(min(values) >= 0.0, f"negative radiance {min(values)}")
            scalar = bench.figures(path, *SMALL, "--no-background", "--isa", "scalar", "--threads", "1")
            check(scalar["pixel_hash"] == figures["pixel_hash"], "scalar code gives other pixels")

        case("models.render_finite_and_lit." + words_of(name))(run)
