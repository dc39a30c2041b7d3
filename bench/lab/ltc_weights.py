#!/usr/bin/env python3
"""Measures the error of area lights by transformed cosines under texture filters.

Usage: ltc_weights.py --program build/release/burnish [--bits N]

Draws quads about seeded points by the exported GLSL on lavapipe with float weights between the table's nodes, as the file has them. Then with
weights in steps of 2^-N (8), as texture units of GPUs filter. Then by the sampler of headless Chromium's WebGL 2: the table's texels as a 3D
texture of 8 x 11 x 192 (lambda, alpha, phi behind theta behind plane), two trilinear fetches a plane, mixed along theta. Prints the differences
relative to the light. Exit code: 0 measured; 2 something could not be run.
"""

import argparse
import pathlib
import re
import statistics
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/cli"))
import export_language_cases as cases  # noqa: E402
import harness  # noqa: E402
from browser import Browser  # noqa: E402

# The look-up by a sampler, in place of burnish_ltc_channels().
BY_SAMPLER = """burnish_texel_planes burnish_ltc_channels(burnish_ltc_table table, burnish_ltc_cell c)
{
    int nodes = c.first, l = nodes % 8, k = nodes / 8 % 11, j = nodes / 88 % 8, i = nodes / 704;
    vec2 at = (vec2(float(l) + c.u_lambda, float(k) + c.u_alpha) + 0.5) / vec2(8.0, 11.0);
    burnish_texel_planes r;
    for (int plane = 0; plane < 3; ++plane) {
        float z = float(64 * plane + 8 * i + j) + c.u_phi + 0.5;
        r.plane[plane] = mix(texture(ltc, vec3(at, z / 192.0)), texture(ltc, vec3(at, (z + 8.0) / 192.0)), c.u_theta);
    }
    return r;
}
"""
UPLOAD = """    if (!gl.getExtension("OES_texture_float_linear"))
        return {skipped: "no linear filter of floats"};
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_3D, gl.createTexture());
    gl.texStorage3D(gl.TEXTURE_3D, 1, gl.RGBA32F, 8, 11, 192);
    gl.texSubImage3D(gl.TEXTURE_3D, 0, 0, 0, 0, 8, 11, 192, gl.RGBA, gl.FLOAT, points.subarray(16 * count));
    for (const which of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
        gl.texParameteri(gl.TEXTURE_3D, which, gl.LINEAR);
    for (const which of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R])
        gl.texParameteri(gl.TEXTURE_3D, which, gl.CLAMP_TO_EDGE);
    gl.activeTexture(gl.TEXTURE0);
    gl.useProgram(program);
    gl.uniform1i(gl.getUniformLocation(program, "ltc"), 1);
"""


def in_page(bench, table, by_sampler):
    """Returns the quads' light in WebGL 2."""
    text = cases.source(bench, cases.ESSL.replace(cases.SPECULAR, cases.QUAD), "bent_normal", "essl", "texelFetch(points, ivec2(4 * i + {0} / 4, 0), 0)[{0} % 4]")
    text = text.replace("out vec4 result;\n", "uniform highp sampler3D ltc;\nout vec4 result;\n")
    if by_sampler:
        text, found = re.subn(r"burnish_texel_planes burnish_ltc_channels\(.*?\n\}\n", lambda _: BY_SAMPLER, text, flags=re.DOTALL)
        if found != 1:
            raise SystemExit("ltc_weights.py: the exported text has another look-up")
    text = text.replace("void main", "vec4 burnish_ltc_texel(int k) { return texelFetch(ltc, ivec3(k % 8, k / 8 % 11, k / 88), 0); }\nvoid main")
    for mark in ("count = points.length / 16,", "texture(4 * count, points);"):
        if cases.RUN_WEBGL.count(mark) != 1:
            raise SystemExit("ltc_weights.py: the page's script is another")
    script = cases.RUN_WEBGL.replace("count = points.length / 16,", f"count = {cases.POINTS},").replace("texture(4 * count, points);", "texture(4 * count, points.subarray(0, 16 * count));\n" + UPLOAD)
    with Browser(bench.folder, webgl=True) as browser:
        return cases.in_browser(bench, browser, script, text, table)


def tell(name, exact, other):
    off = sorted(abs(a - b) / a for a, b in zip(exact[::3], other[::3]) if a > 1e-4)
    print(f"{name}: {len(off)} quads, relative difference: median {statistics.median(off):.2e}, 99 % {off[int(0.99 * len(off))]:.2e}, worst {off[-1]:.2e}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    parser.add_argument("--bits", type=int, default=8)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        bench = harness.Bench(str(pathlib.Path(given.program).resolve()), "", [ROOT / "tests/data"], folder, False)
        bench.open("ltc_weights")
        try:
            table = cases.ltc_table(bench)
            bench.run("export", "glsl", "--ltc", "--technique", "bent_normal", "-o", "bent_normal.glsl").expect(0)
            text = cases.source(bench, cases.GLSL_QUAD, "bent_normal", "glsl")
            mark = "    c.u_lambda = lambda_at - float(l);\n"
            if text.count(mark) != 1:
                raise SystemExit("ltc_weights.py: the exported text has other weights")
            steps = "".join(f"    c.u_{axis} = floor(c.u_{axis} * {2.0 ** given.bits} + 0.5) / {2.0 ** given.bits};\n" for axis in ("theta", "phi", "alpha", "lambda"))
            exact = cases.on_lavapipe(bench, text, more=table)
            stepped = cases.on_lavapipe(bench, text.replace(mark, mark + steps), more=table)
            bench.run("export", "essl", "--ltc", "--technique", "bent_normal", "-o", "bent_normal.essl").expect(0)
            fetched, filtered = (in_page(bench, table, by_sampler) for by_sampler in (False, True))
        except (harness.Skipped, harness.Failed) as reason:
            print(reason, file=sys.stderr)
            return 2
    tell(f"weights of {given.bits} bits", exact, stepped)
    tell("WebGL 2, texels fetched one by one", exact, fetched)
    tell("WebGL 2, the sampler's filter", exact, filtered)
    return 0


if __name__ == "__main__":
    sys.exit(main())
