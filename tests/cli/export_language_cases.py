"""burnish export essl, hlsl, msl, wgsl: each file runs where its language runs, and gives the words of the file in GLSL."""

import json
import math
import pathlib
import random
import re
import shutil
import struct
import subprocess

from browser import Browser
from harness import Skipped, case, check
from texture_cases import ktx2
from export_cases import OF_GRIDS, TECHNIQUES, compiler, undefined

NAMES = [name for name, _ in TECHNIQUES]
POINTS = 48
FLOATS = 16  # of a point: n, v, tangent, f0, roughness, anisotropy, dfg; the first three become the result

# An environment by sums and products alone, and the call at point `i` of a buffer `at`, in each language.
GLSL_ENVIRONMENT = """vec4 burnish_radiance(int cube, vec3 direction, float lod)
{
    vec3 d = direction * (1.0 / sqrt(direction.x * direction.x + direction.y * direction.y + direction.z * direction.z));
    float near = 1.0 / (1.0 + lod);
    return vec4(1.0 + d.x * near, 0.6 + d.y * d.z * near, 0.2 + d.z * d.z, 1.0) * (cube == 2 ? 2.0 : 1.0);
}
"""
GLSL_POINT = """    burnish_settings f = burnish_usual_settings(256, 9, SAMPLES);
    burnish_shaded_point x = burnish_point_of(f, vec3(AT(0), AT(1), AT(2)), vec3(AT(3), AT(4), AT(5)), vec3(AT(6), AT(7), AT(8)),
                                              vec3(AT(9), AT(10), AT(11)), vec3(1.0), AT(12), AT(13), vec2(AT(14), AT(15)), i);
    vec3 light = burnish_NAME_specular(f, x);
"""
STORE = "".join(f"    at[16 * i + {k}] = light.{'xyz'[k]};\n" for k in range(3))
GLSL = f"""#version 450
layout(local_size_x = 1) in;
layout(std430, set = 0, binding = 0) buffer Points {{ float at[]; }};
TEXT
{GLSL_ENVIRONMENT}
void main()
{{
    int i = int(gl_GlobalInvocationID.x);
{GLSL_POINT}{STORE}}}
"""


def c_like(text):
    return text.replace("vec3(1.0)", "float3(1.0, 1.0, 1.0)").replace("vec4", "float4").replace("vec3", "float3").replace("vec2", "float2")


HLSL = f"""RWStructuredBuffer<float> at : register(u0);
TEXT
{c_like(GLSL_ENVIRONMENT)}
[numthreads(1, 1, 1)]
void main(uint3 id : SV_DispatchThreadID)
{{
    int i = int(id.x);
{c_like(GLSL_POINT)}{STORE}}}
"""
def with_suffixes(text):
    """Returns the text with floats that C++ takes for floats."""
    return re.sub(r"(?<![\w.])(\d+\.\d+)(?!\w)", r"\1f", text)


MSL = f"""struct burnish_environment {{
    float4 radiance(int cube, float3 direction, float lod) const
    {with_suffixes(c_like(GLSL_ENVIRONMENT)).split(")", 1)[1]}
}};
TEXT
kernel void shade(device float* at [[buffer(0)]], uint i [[thread_position_in_grid]])
{{
    burnish_environment env;
{with_suffixes(c_like(GLSL_POINT)).replace("specular(f", "specular(env, f")}{STORE}}}
"""
WGSL = """@group(0) @binding(0) var<storage, read_write> at: array<f32>;
TEXT
fn burnish_radiance(cube: i32, direction: vec3<f32>, lod: f32) -> vec4<f32>
{
    let d = direction * (1.0 / sqrt(direction.x * direction.x + direction.y * direction.y + direction.z * direction.z));
    let near = 1.0 / (1.0 + lod);
    return vec4<f32>(1.0 + d.x * near, 0.6 + d.y * d.z * near, 0.2 + d.z * d.z, 1.0) * select(1.0, 2.0, cube == 2);
}
@compute @workgroup_size(1)
fn main(@builtin(global_invocation_id) id: vec3<u32>)
{
    let i = i32(id.x);
    let f = burnish_usual_settings(256, 9, SAMPLES);
    let x = burnish_point_of(f, vec3<f32>(AT(0), AT(1), AT(2)), vec3<f32>(AT(3), AT(4), AT(5)), vec3<f32>(AT(6), AT(7), AT(8)),
                             vec3<f32>(AT(9), AT(10), AT(11)), vec3<f32>(1.0), AT(12), AT(13), vec2<f32>(AT(14), AT(15)), i);
    let light = burnish_NAME_specular(f, x);
""" + STORE + "}\n"
# One point a pixel: WebGL 2 has no buffers to write.
ESSL = f"""#version 300 es
precision highp float;
precision highp int;
uniform highp sampler2D points;
out vec4 result;
TEXT
{GLSL_ENVIRONMENT}
void main()
{{
    int i = int(gl_FragCoord.x);
{GLSL_POINT}    result = vec4(light, 1.0);
}}
"""


def points():
    """Returns points on a sphere's front, with lobes of all shapes."""
    of = random.Random(5)
    unit = lambda v: [c / math.sqrt(sum(d * d for d in v)) for c in v]
    values = []
    for _ in range(POINTS):
        n = unit([of.gauss(0, 1) for _ in range(3)])
        v = unit([a + 0.9 * b for a, b in zip(n, unit([of.gauss(0, 1) for _ in range(3)]))])
        side = [of.gauss(0, 1) for _ in range(3)]
        along = sum(a * b for a, b in zip(n, side))
        tangent = unit([s - along * a for s, a in zip(side, n)])
        values += [*n, *v, *tangent, *(of.random() for _ in range(3)), of.uniform(0.05, 1), of.uniform(-0.95, 0.95), of.random(), 0.1 * of.random()]
    return struct.pack(f"<{len(values)}f", *values)


def written(bench, language, names=NAMES):
    for name in names:
        bench.run("export", language, "--technique", name, *(("--samples", "9") if name in OF_GRIDS else ()), "-o", f"{name}.{language}").expect(0)


def source(bench, template, name, language, place="at[16 * i + {}]"):
    """Returns a shader that calls the exported file. place: a point's number {} in the language's words."""
    call = re.sub(r"AT\((\d+)\)", lambda at: place.format(at[1]), template.replace("NAME", name).replace("SAMPLES", "16"))
    return call.replace("TEXT", (bench.folder / f"{name}.{language}").read_text())


def on_lavapipe(bench, text, *compile_words, whole=False, more=b""):
    """Returns the results of a compute shader."""
    compiler()
    runner = pathlib.Path(bench.program).resolve().parent / "tests/unit/vulkan/run_compute"
    if not runner.exists():
        raise Skipped("built without Vulkan")
    (bench.folder / "engine.comp").write_text(text)
    (bench.folder / "points.bin").write_bytes(points() + more)
    done = subprocess.run(["glslc", "-w", "-fshader-stage=compute", *compile_words, bench.folder / "engine.comp", "-o", bench.folder / "engine.spv"],
                          capture_output=True, text=True)
    check(done.returncode == 0, done.stderr[:1500])
    if shutil.which("spirv-opt") and shutil.which("spirv-dis"):
        check(not undefined(bench), "an optimiser finds values that nobody has written")
    done = subprocess.run([runner, bench.folder / "engine.spv", bench.folder / "points.bin", str(POINTS), "lavapipe"], capture_output=True, text=True)
    if done.returncode == 77:
        raise Skipped(done.stderr)
    check(done.returncode == 0, done.stderr)
    values = struct.unpack_from(f"<{POINTS * FLOATS}f", (bench.folder / "points.bin").read_bytes())
    return values if whole else results(values)


MSL_PROGRAM = """#include <cstdio>
int main()
{
    static float at[COUNT];
    std::FILE* file = std::fopen("points.bin", "r+b");
    if (!file || std::fread(at, 4, COUNT, file) != COUNT)
        return 1;
    for (unsigned i = 0; i < POINTS; ++i)
        shade(at, i);
    std::rewind(file);
    return std::fwrite(at, 4, COUNT, file) == COUNT && std::fclose(file) == 0 ? 0 : 1;
}
"""


def as_cpp(bench, text, more=b""):
    """Returns the results of a Metal function, compiled as C++."""
    builder = next(filter(shutil.which, ("clang++", "c++")), None)
    if not builder:
        raise Skipped("no C++ compiler")
    (bench.folder / "engine.metal").write_text(text)
    (bench.folder / "engine.cpp").write_text(MSL_PROGRAM.replace("POINTS", str(POINTS)).replace("COUNT", str(POINTS * FLOATS + len(more) // 4)))
    (bench.folder / "points.bin").write_bytes(points() + more)
    done = subprocess.run([builder, "-std=c++17", "-O1", "-ffp-contract=off", "-Wno-unknown-attributes", "-Wno-attributes", "-include", pathlib.Path(__file__).parent / "msl_shim.h", "-include", "engine.metal",
                           "engine.cpp", "-o", "engine"], cwd=bench.folder, capture_output=True, text=True)
    check(done.returncode == 0, done.stderr[:1500])
    check(subprocess.run(["./engine"], cwd=bench.folder).returncode == 0, "the program fails")
    return results(struct.unpack_from(f"<{POINTS * FLOATS}f", (bench.folder / "points.bin").read_bytes()))


def results(values):
    return [values[FLOATS * i + k] for i in range(POINTS) for k in range(3)]


def same_words(name, found, expected):
    check(all(math.isfinite(v) for v in expected) and len(set(expected)) > POINTS, f"{name}: points that prove nothing")
    other = [i for i, (a, b) in enumerate(zip(found, expected)) if a != b]
    check(not other, f"{name}: {len(other)} of {len(expected)} words differ, the first {found[other[0]] if other else 0} for {expected[other[0]] if other else 0}")


GLSL_PLACE = GLSL.replace(GLSL_POINT + STORE, """    vec4 p = burnish_albedo_place(vec3(AT(0), AT(1), AT(2)), vec3(AT(3), AT(4), AT(5)), vec3(AT(6), AT(7), AT(8)), AT(12), AT(13));
    at[16 * i] = p.x; at[16 * i + 1] = p.y; at[16 * i + 2] = p.z; at[16 * i + 3] = p.w;
""")


def albedo_by_sampling(o, alpha_x, alpha_y, count=2500, seen=lambda i: True):
    """Returns the mean of masking, over directions that are seen, over visible GGX normals (Heitz 2018, "Sampling the GGX Distribution of Visible Normals")."""
    unit = lambda v: [c / math.sqrt(sum(d * d for d in v)) for c in v]
    smith = lambda w: 0.5 * (math.sqrt(1 + ((alpha_x * w[0]) ** 2 + (alpha_y * w[1]) ** 2) / max(w[2] ** 2, 1e-12)) - 1)
    v = unit([alpha_x * o[0], alpha_y * o[1], o[2]])
    flat = math.hypot(v[0], v[1])
    t = [-v[1] / flat, v[0] / flat, 0.0] if flat > 1e-9 else [1.0, 0.0, 0.0]
    b = [v[1] * t[2] - v[2] * t[1], v[2] * t[0] - v[0] * t[2], v[0] * t[1] - v[1] * t[0]]
    total = 0.0
    for k in range(count):
        radius, angle = math.sqrt((k + 0.5) / count), 2 * math.pi * (k * 0.6180339887498949 % 1)
        p, q = radius * math.cos(angle), radius * math.sin(angle)
        q = (1 - 0.5 * (1 + v[2])) * math.sqrt(max(1 - p * p, 0)) + 0.5 * (1 + v[2]) * q
        up = math.sqrt(max(1 - p * p - q * q, 0))
        n = [p * t[c] + q * b[c] + up * v[c] for c in range(3)]
        h = unit([alpha_x * n[0], alpha_y * n[1], max(n[2], 1e-6)])
        d = sum(x * y for x, y in zip(o, h))
        i = [2 * d * h[c] - o[c] for c in range(3)]
        if i[2] > 0 and seen(i):
            total += (1 + smith(o)) / (1 + smith(o) + smith(i))
    return total / count


# A quad about each point: o +- s, o +- t. The table lies behind the points.
QUAD = """    vec3 o = vec3(AT(0), AT(1), AT(2)) + vec3(AT(6), AT(7), AT(8)) * 0.25;
    vec3 s = vec3(0.5, -0.4, 0.3);
    vec3 t = vec3(-0.2, 0.4, 0.6);
    vec3 light = burnish_quad_light(x, o + s, o + t, o - s, o - t, vec3(2.0, 1.0, 0.5), true);
"""
TABLE = POINTS * FLOATS
TEXEL = f"return vec4(at[{TABLE} + 4 * k], at[{TABLE + 1} + 4 * k], at[{TABLE + 2} + 4 * k], at[{TABLE + 3} + 4 * k]);"
SPECULAR = "    vec3 light = burnish_NAME_specular(f, x);\n"
GLSL_QUAD = GLSL.replace(SPECULAR, QUAD).replace("void main", f"vec4 burnish_ltc_texel(int k) {{ {TEXEL} }}\nvoid main")
HLSL_QUAD = HLSL.replace(c_like(SPECULAR), c_like(QUAD)).replace("[numthreads", f"float4 burnish_ltc_texel(int k) {{ {c_like(TEXEL)} }}\n[numthreads")
MSL_QUAD = MSL.replace("    float3 light = burnish_NAME_specular(env, f, x);\n", with_suffixes(c_like(QUAD)).replace("light(x", "light(env, x")).replace(
    "float4 radiance", f"device float* at;\n    float4 ltc_texel(int k) const {{ {c_like(TEXEL)} }}\n    float4 radiance").replace(
    "burnish_environment env;", "burnish_environment env;\n    env.at = at;")
WGSL_QUAD = WGSL.replace("    let light = burnish_NAME_specular(f, x);\n", re.sub(r"vec3 (\w) =", r"let \1 =", QUAD).replace("vec3 light", "let light").replace("vec3(", "vec3<f32>(")).replace(
    "@compute", f"fn burnish_ltc_texel(k: i32) -> vec4<f32> {{ {TEXEL.replace('vec4(', 'vec4<f32>(')} }}\n@compute")


def ltc_table(bench):
    bench.run("bake", "environment", "builtin:studio", "--env-size", "16", "--env-samples", "16", "--textures", "ktx2", "--texels", "float", "-q", "-o", "tables").expect(0)
    return struct.pack(f"<{4 * 192 * 88}f", *ktx2(bench.folder / "tables/ltc.ktx2")[1][0])


@case("export.quad_light_is_that_of_sampled_lobes", budget=30)
def quad_light(bench):
    """Sums sampled lobes in Python for each point. No cheaper test holds the values of an exported quad light."""
    table = ltc_table(bench)
    for language in ("glsl", "hlsl", "msl"):
        bench.run("export", language, "--ltc", "--technique", "bent_normal", "-o", f"bent_normal.{language}").expect(0)
    expected = on_lavapipe(bench, source(bench, GLSL_QUAD, "bent_normal", "glsl"), more=table)
    same_words("hlsl", on_lavapipe(bench, source(bench, HLSL_QUAD, "bent_normal", "hlsl"), "-x", "hlsl", "-fentry-point=main", more=table), expected)
    same_words("msl", as_cpp(bench, source(bench, MSL_QUAD, "bent_normal", "msl"), table), expected)
    values = struct.unpack(f"<{POINTS * FLOATS}f", points())
    dot = lambda a, b: sum(c * d for c, d in zip(a, b))
    cross = lambda a, b: [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    worst, lit = 0.0, 0
    for i in range(POINTS):
        n, v, tangent, roughness, anisotropy, f0 = (values[16 * i + a:16 * i + b] for a, b in ((0, 3), (3, 6), (6, 9), (12, 13), (13, 14), (9, 12)))
        frame = [tangent, cross(n, tangent), n]
        eye = [dot(axis, v) for axis in frame]
        alpha = roughness[0] ** 2
        if eye[2] < 0.3 or not 0.05 < alpha < 0.4:
            continue
        o, s, t = [a + 0.25 * b for a, b in zip(n, tangent)], (0.5, -0.4, 0.3), (-0.2, 0.4, 0.6)
        corners = [[dot(axis, [a + sign * b for a, b in zip(o, side)]) for axis in frame] for sign, side in ((1, s), (1, t), (-1, s), (-1, t))]

        def seen(wi):
            sides = [dot(wi, cross(corners[k], corners[(k + 1) % 4])) > 0 for k in range(4)]
            return all(sides) or not any(sides)

        share = albedo_by_sampling(eye, alpha * (1 + anisotropy[0]), alpha * (1 - anisotropy[0]), seen=seen)
        # Fresnel adds to f0: compare the channel with the largest
        found = expected[3 * i] / 2.0
        low, high = share * f0[0], share * f0[0] + (1 - f0[0]) * share
        worst, lit = max(worst, low - found, found - high), lit + (share > 0.1)
    check(lit > 4 and worst < 0.05, f"{lit} lit points, off by {worst}")


@case("export.quad_light_of_every_technique_reads_nothing_undefined", tier="nightly")
def quad_light_undefined(bench):
    for name in NAMES:
        for language, template, words in (("glsl", GLSL_QUAD, ()), ("hlsl", HLSL_QUAD, ("-x", "hlsl", "-fentry-point=main"))):
            bench.run("export", language, "--ltc", "--technique", name, *(("--samples", "9") if name in OF_GRIDS else ()), "-o", f"{name}.{language}").expect(0)
            reads_nothing_undefined(bench, f"{name}, {language}", source(bench, template, name, language), "-fshader-stage=compute", *words)


@case("export.quad_light_draws_in_webgpu", budget=10)
def quad_light_in_webgpu(bench):
    table = ltc_table(bench)
    for language in ("glsl", "wgsl"):
        bench.run("export", language, "--ltc", "--technique", "bent_normal", "-o", f"bent_normal.{language}").expect(0)
    expected = on_lavapipe(bench, source(bench, GLSL_QUAD, "bent_normal", "glsl"), more=table)
    with Browser(bench.folder, webgl=True) as browser:
        near("wgsl", in_browser(bench, browser, RUN_WEBGPU, source(bench, WGSL_QUAD, "bent_normal", "wgsl"), table), expected)


@case("export.albedo_place_finds_the_albedo_of_two_widths", budget=20)
def albedo(bench):
    """Sums sampled lobes in Python for each point."""
    bench.run("bake", "environment", "builtin:studio", "--env-size", "16", "--env-samples", "16", "--textures", "ktx2", "--texels", "float", "-q", "-o", "baked").expect(0)
    tiles = ktx2(bench.folder / "baked/lobe_albedo.ktx2")[1][0]
    written(bench, "glsl", ["bent_normal"])
    places, values = on_lavapipe(bench, source(bench, GLSL_PLACE, "bent_normal", "glsl"), whole=True), struct.unpack(f"<{POINTS * FLOATS}f", points())
    worst, losses = 0.0, 0
    for i in range(POINTS):
        n, v, tangent, roughness, anisotropy = (values[16 * i + a:16 * i + b] for a, b in ((0, 3), (3, 6), (6, 9), (12, 13), (13, 14)))
        x, y, z, w = places[16 * i:16 * i + 4]
        dot = lambda a, b: sum(c * d for c, d in zip(a, b))
        across = [n[1] * tangent[2] - n[2] * tangent[1], n[2] * tangent[0] - n[0] * tangent[2], n[0] * tangent[1] - n[1] * tangent[0]]
        o = [dot(tangent, v), dot(across, v), dot(n, v)]
        if o[2] < 0.2 or roughness[0] < 0.2:
            continue

        def fetch(u, t):  # bilinear
            a, b = u * 200 - 0.5, t * 200 - 0.5
            c, r = min(int(a), 198), min(int(b), 198)
            texel = lambda c, r: tiles[2 * (200 * r + c)] + tiles[2 * (200 * r + c) + 1]
            top, below = (texel(c, row) * (1 - a + c) + texel(c + 1, row) * (a - c) for row in (r, r + 1))
            return top * (1 - b + r) + below * (b - r)

        found = (fetch(x, y) * (1 - z) + fetch(x + 0.1, y) * z) * (1 - w) + (fetch(x, y + 0.1) * (1 - z) + fetch(x + 0.1, y + 0.1) * z) * w
        alpha = roughness[0] ** 2
        expected = albedo_by_sampling(o, alpha * (1 + anisotropy[0]), alpha * (1 - anisotropy[0]))
        worst, losses = max(worst, abs(found - expected)), losses + (expected < 0.9)
    check(losses > 8 and worst < 0.02, f"{losses} lobes that lose light, off by {worst}")


# Runs shaders on the points that the page holds. WebGL 2 draws a pixel for each point.
RUN_WEBGL = """async function run(shader) {
    const canvas = document.createElement("canvas");
    const gl = canvas.getContext("webgl2");
    if (!gl || !gl.getExtension("EXT_color_buffer_float"))
        return {skipped: "no WebGL 2 with float targets"};
    const made = (kind, text) => {
        const one = gl.createShader(kind);
        gl.shaderSource(one, text);
        gl.compileShader(one);
        return one;
    };
    const program = gl.createProgram();
    gl.attachShader(program, made(gl.VERTEX_SHADER, `#version 300 es
        void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }`));
    const fragment = made(gl.FRAGMENT_SHADER, shader);
    gl.attachShader(program, fragment);
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS))
        return {error: gl.getShaderInfoLog(fragment) + gl.getProgramInfoLog(program)};
    const texture = (width, values) => {
        const one = gl.createTexture();
        gl.bindTexture(gl.TEXTURE_2D, one);
        gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32F, width, 1);
        if (values)
            gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, 1, gl.RGBA, gl.FLOAT, values);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
        gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
        return one;
    };
    const count = points.length / 16, target = texture(count);
    gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
    texture(4 * count, points);
    gl.useProgram(program);
    gl.viewport(0, 0, count, 1);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const out = new Float32Array(4 * count);
    gl.readPixels(0, 0, count, 1, gl.RGBA, gl.FLOAT, out);
    return {values: Array.from(out).filter((_, i) => i % 4 != 3), error: gl.getError() ? "WebGL failed" : ""};
}
"""
RUN_WEBGPU = """async function run(shader) {
    const adapter = navigator.gpu && await navigator.gpu.requestAdapter();
    if (!adapter)
        return {skipped: "no WebGPU"};
    const device = await adapter.requestDevice();
    const module = device.createShaderModule({code: shader});
    const faults = (await module.getCompilationInfo()).messages.filter(m => m.type == "error");
    if (faults.length)
        return {error: faults.map(m => m.lineNum + ": " + m.message).join("\\n")};
    const pipeline = await device.createComputePipelineAsync({layout: "auto", compute: {module}});
    const buffer = (usage, mapped) => device.createBuffer({size: points.byteLength, usage, mappedAtCreation: mapped});
    const values = buffer(GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_SRC, true), out = buffer(GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST);
    new Float32Array(values.getMappedRange()).set(points);
    values.unmap();
    const encoder = device.createCommandEncoder(), pass = encoder.beginComputePass();
    pass.setPipeline(pipeline);
    pass.setBindGroup(0, device.createBindGroup({layout: pipeline.getBindGroupLayout(0), entries: [{binding: 0, resource: {buffer: values}}]}));
    pass.dispatchWorkgroups(COUNT);
    pass.end();
    encoder.copyBufferToBuffer(values, 0, out, 0, points.byteLength);
    device.queue.submit([encoder.finish()]);
    await out.mapAsync(GPUMapMode.READ);
    return {values: Array.from(new Float32Array(out.getMappedRange())).slice(0, 16 * COUNT).filter((_, i) => i % 16 < 3)};
}
""".replace("COUNT", str(POINTS))


def in_browser(bench, browser, script, text, more=b""):
    """Returns the results of a shader in a page."""
    values = list(struct.unpack(f"<{POINTS * FLOATS + len(more) // 4}f", points() + more))
    page = bench.folder / "page.html"
    page.write_text(f"<!doctype html><title>shader</title><script>const points = new Float32Array({values}), shader = {json.dumps(text)};\n{script}</script>")
    browser.open(page)
    found = browser.value("run(shader)")
    if found.get("skipped"):
        raise Skipped(found["skipped"])
    check(not found.get("error"), str(found.get("error"))[:1500])
    return found["values"]


def near(name, found, expected):
    """Checks results of a device that rounds division and roots in its own way."""
    far = max(abs(a - b) / max(abs(b), 0.05) for a, b in zip(found, expected))
    check(len(found) == len(expected) and far < 2e-5, f"{name}: off by {far}")


SOME = ["lobe_line", "filtered_is", "major_axis_adaptive"]


def words(bench, names, language, results_of):
    """Compares an exported language with GLSL on lavapipe, by techniques."""
    written(bench, "glsl", names), written(bench, language, names)
    for name in names:
        same_words(name, results_of(name), on_lavapipe(bench, source(bench, GLSL, name, "glsl")))


def hlsl_words(bench, names):
    words(bench, names, "hlsl", lambda name: on_lavapipe(bench, source(bench, HLSL, name, "hlsl"), "-x", "hlsl", "-fentry-point=main"))


def spirv_cross_words(bench, names):
    """Compares the file in GLSL with its SPIR-V as HLSL by spirv-cross, the way of engines that keep SPIR-V."""
    if not shutil.which("spirv-cross"):
        raise Skipped("no spirv-cross")
    written(bench, "glsl", names)
    for name in names:
        expected = on_lavapipe(bench, source(bench, GLSL, name, "glsl"))
        text = subprocess.run(["spirv-cross", "--hlsl", "--shader-model", "60", bench.folder / "engine.spv"], capture_output=True, text=True, check=True).stdout
        check("RWByteAddressBuffer" in text, f"{name}: spirv-cross writes no HLSL")
        same_words(name, on_lavapipe(bench, text, "-x", "hlsl", "-fentry-point=main"), expected)


def msl_words(bench, names):  # no Metal compiler is at hand
    words(bench, names, "msl", lambda name: as_cpp(bench, source(bench, MSL, name, "msl")))


def in_pages(bench, names, language, script, template, *place):
    with Browser(bench.folder, webgl=True) as browser:
        written(bench, "glsl", names), written(bench, language, names)
        for name in names:
            near(name, in_browser(bench, browser, script, source(bench, template, name, language, *place)),
                 on_lavapipe(bench, source(bench, GLSL, name, "glsl")))


def reads_nothing_undefined(bench, name, text, *compile_words):
    """Compiles a shader, optimises it, and looks for values that nobody has written."""
    compiler()
    if not (shutil.which("spirv-opt") and shutil.which("spirv-dis")):
        raise Skipped("no spirv-opt, or no spirv-dis")
    (bench.folder / "engine.glsl").write_text(text)
    done = subprocess.run(["glslc", "-w", *compile_words, bench.folder / "engine.glsl", "-o", bench.folder / "engine.spv"], capture_output=True, text=True)
    check(done.returncode == 0, f"{name}: {done.stderr[:1500]}")
    check(not undefined(bench), f"{name} reads undefined values")


# glslc compiles ES from 3.10 on.
OF_ES = ("-fshader-stage=fragment", "--target-env=opengl", "-std=310es", "-fauto-bind-uniforms", "-fauto-map-locations")


def essl_pages(bench, names):
    written(bench, "essl", names)
    for name in names:
        text = source(bench, ESSL, name, "essl", "texelFetch(points, ivec2(4 * i + {0} / 4, 0), 0)[{0} % 4]")
        reads_nothing_undefined(bench, name, text.replace("#version 300 es", "#version 310 es"), *OF_ES)
    in_pages(bench, names, "essl", RUN_WEBGL, ESSL, "texelFetch(points, ivec2(4 * i + {0} / 4, 0), 0)[{0} % 4]")


def wgsl_pages(bench, names):
    in_pages(bench, names, "wgsl", RUN_WEBGPU, WGSL)


def in_two_tiers(claim, run):
    """Registers run(bench, techniques) for some techniques in check, and for all nightly."""
    @case(f"export.{claim}", budget=12)
    def for_some(bench):
        """Compiles shaders in two languages for each of some techniques."""
        run(bench, SOME)

    case(f"export.{claim}_by_every_technique", tier="nightly")(lambda bench: run(bench, NAMES))


for claim, run in (("hlsl_gives_the_words_of_glsl", hlsl_words), ("hlsl_by_spirv_cross_gives_the_words_of_glsl", spirv_cross_words),
                   ("msl_as_cpp_gives_the_words_of_glsl", msl_words), ("essl_draws_in_webgl_2", essl_pages), ("wgsl_draws_in_webgpu", wgsl_pages)):
    in_two_tiers(claim, run)
