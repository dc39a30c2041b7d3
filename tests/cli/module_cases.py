"""burnish export three, babylon: modules that connect a technique to an engine, beside stand-ins for the engines and in the engines."""

import base64
import functools
import http.server
import json
import math
import os
import pathlib
import re
import shutil
import struct
import subprocess
import threading
import time

from browser import Browser
from compare_cases import png
from export_cases import undefined
from harness import Skipped, case, check
from model_cases import read_pfm
from reference_cases import needs_embree

ROOT = pathlib.Path(__file__).resolve().parents[2]

# The parts of an engine that the modules touch.
THREE = """
export const ShaderChunk = {
  normal_vertex: 'vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );',
  envmap_common_pars_fragment: 'uniform mat3 envMapRotation;',
  lights_physical_pars_fragment: 'struct PhysicalMaterial { vec3 specularColor; vec2 dfg; float alphaT; }; void RE_Direct_RectArea_Physical() {} ' +
    'x += multiScattering * cosineWeightedIrradiance;',
  lights_physical_fragment: 'vec2 anisotropyV = anisotropyMat * normalize( d );\\nmaterial.anisotropy = length( anisotropyV );',
  lights_fragment_maps: 'radiance += getIBLAnisotropyRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );',
};
export class DataTexture { constructor(data, width, height) { Object.assign(this, { data, width, height }); } }
export const ClampToEdgeWrapping = 1, HalfFloatType = 2, LinearFilter = 3, NearestFilter = 4, RGBAFormat = 5, RGFormat = 6, UnsignedByteType = 7;
"""
USE_THREE = """
import { ShaderChunk } from 'three';
import { improveAnisotropy } from './burnish_three.mjs';
const keyOf = function () { return this.onBeforeCompile.toString(); }; // three.js' own
const made = (anisotropy, more) => ({ isMeshPhysicalMaterial: true, anisotropy, onBeforeCompile(shader) { shader.first = true; }, customProgramCacheKey: () => 'own', ...more });
const brushed = made(0.8), plain = made(0), other = made(0.5, { isMeshPhysicalMaterial: false });
const objects = [brushed, [plain, brushed], other].map(material => ({ material }));
const counts = [improveAnisotropy({ isObject3D: true, traverse: visit => objects.forEach(visit) }), improveAnisotropy(brushed), improveAnisotropy([made(1), made(1)], { glTF: false })];
const shader = { uniforms: {}, vertexShader: '#include <normal_vertex>',
  fragmentShader: '#include <lights_physical_pars_fragment>\\n#include <lights_physical_fragment>\\n#include <lights_fragment_maps>' };
brushed.onBeforeCompile(shader);
const twins = ['one', 'two'].map(text => made(1, { onBeforeCompile: new Function('shader', `shader.name = '${text}'`), customProgramCacheKey: keyOf }));
improveAnisotropy([{ isObject3D: true, traverse: visit => twins.forEach(material => visit({ material })) }]);
const apart = twins[0].customProgramCacheKey() !== twins[1].customProgramCacheKey();
const left = made(1), flat = { uniforms: {}, vertexShader: '#include <normal_vertex>', fragmentShader: '' };
improveAnisotropy(left);
let fault = '';
try { left.onBeforeCompile(flat); } catch (error) { fault = error.message; }
const bright = made(1), lit = { uniforms: {}, vertexShader: shader.vertexShader, fragmentShader: '' };
improveAnisotropy(bright, { multipleScattering: true });
Object.assign(lit, { vertexShader: '#include <normal_vertex>', fragmentShader: '#include <lights_physical_pars_fragment>\\n#include <lights_physical_fragment>\\n#include <lights_fragment_maps>' });
bright.onBeforeCompile(lit);
const { data, width, height } = shader.uniforms.burnish_ltc.value, albedo = shader.uniforms.burnish_lobe_albedo.value;
ShaderChunk.envmap_common_pars_fragment = '';
let old = '';
try { improveAnisotropy(made(1)); } catch (error) { old = error.message; }
console.log(JSON.stringify({ counts, fault, old, apart, first: shader.first, key: brushed.customProgramCacheKey(), plain: plain.customProgramCacheKey(), vertex: shader.vertexShader,
  fragment: shader.fragmentShader, bright: lit.fragmentShader, bright_key: bright.customProgramCacheKey(), ltc: [data.length, width, height], albedo: [albedo.data.length, albedo.width, albedo.height] }));
"""
USE_BABYLON = """
import { improveAnisotropy } from './burnish_babylon.mjs';
class MaterialPluginBase {
  constructor(material, name) { material.pluginManager = { getPlugin: asked => asked === name ? this : null }; this.code = this.getCustomCode('fragment'); }
}
class RawTexture { constructor(data, width, height) { Object.assign(this, { data, width, height }); } isReady() { return true; } }
const BABYLON = { MaterialPluginBase, RawTexture, Constants: {} }, scene = {};
const made = isEnabled => ({ anisotropy: { isEnabled }, getScene: () => scene });
const ways = [{}, { glTF: false }, { multipleScattering: true }].map(options => {
  const material = made(true);
  improveAnisotropy(BABYLON, material, options);
  return material.pluginManager.getPlugin('BurnishAnisotropy');
});
const brushed = made(true), plain = made(false), other = {};
const counts = [improveAnisotropy(BABYLON, [brushed, plain, other]), improveAnisotropy(BABYLON, brushed), improveAnisotropy(BABYLON, made(true), { glTF: false })];
let wgsl = '';
try { improveAnisotropy(BABYLON, [{ ...made(true), shaderLanguage: 1 }]); } catch (error) { wgsl = error.message; }
const plugin = brushed.pluginManager.getPlugin('BurnishAnisotropy'), names = [], bound = {};
plugin.getSamplers(names);
plugin.bindForSubMesh({ setTexture: (name, texture) => bound[name] = [texture.data.length, texture.width] });
const found = Object.keys(plugin.code).filter(key => key[0] === '!').map(key => new RegExp(key.slice(1)).test(
  'anisotropicOut=anisotropicBlock(\\nvAnisotropy,\\n#ifdef ANISOTROPIC_TEXTURE\\nmap,\\n#endif\\nviewDirectionW\\n);\\nvec3 finalRadiance=reflectionOut.environmentRadiance.rgb;'));
console.log(JSON.stringify({ counts, names, bound, found, wgsl, vertex: plugin.getCustomCode('vertex'), definitions: plugin.code.CUSTOM_FRAGMENT_DEFINITIONS,
  classes: ways.map(way => way.getClassName()), bright: ways[2].code.CUSTOM_FRAGMENT_DEFINITIONS }));
"""


def node(bench, script):
    if not shutil.which("node"):
        raise Skipped("no node: group wasm of apps/packages.txt")
    (bench.folder / "use.mjs").write_text(script)
    done = subprocess.run(["node", "use.mjs"], cwd=bench.folder, capture_output=True, text=True)
    check(done.returncode == 0, done.stderr[:1500])
    return json.loads(done.stdout)


@case("export.three_module_changes_anisotropic_materials_alone")
def three(bench):
    bench.run("export", "three", "--technique", "lobe_line", "-o", "burnish_three.mjs").expect(0)
    package = bench.folder / "node_modules/three"
    package.mkdir(parents=True)
    (package / "package.json").write_text('{"name": "three", "type": "module", "exports": "./index.js"}')
    (package / "index.js").write_text(THREE)
    seen = node(bench, USE_THREE)
    check(seen["counts"] == [1, 0, 2], f"{seen['counts']} materials changed")
    check(seen["first"] and seen["key"].endswith(" own burnish lobe_line 64 true false") and seen["plain"] == "own", f"the material's own functions: {seen['key']}")
    check("determinant" in seen["vertex"], "bitangents do not turn over")
    for word in ("burnish_image_light( geometryViewDir", "burnish_lobe_line_specular(f, x)", "anisotropyV.y = - anisotropyV.y", "burnish_quad_light(", "burnish_kept = mix"):
        check(word in seen["fragment"], f"the shader lacks {word}")
    check("1.0 + 0.0 * material.specularColor *" in seen["fragment"] and "1.0 + 1.0 * material.specularColor *" in seen["bright"] and seen["bright_key"].endswith(" true true"),
          "multiple scattering")
    check("multiScattering" not in seen["fragment"] and "x += vec3( 0.0 );" in seen["fragment"], "the engine's even light stays")
    check("MULTIPLE" not in seen["fragment"], "a place is left open")
    check("@" not in seen["fragment"] and "SPECULAR" not in seen["fragment"] and "`" not in seen["fragment"], "a place is left open")
    check("meshphysical_frag" in seen["fault"] and "envMapRotation" in seen["old"], f"unknown versions say '{seen['fault']}' and '{seen['old']}'")
    check(seen["apart"], "two materials with different code of their own share a program")
    check(seen["ltc"] == [4 * 192 * 88, 192, 88] and seen["albedo"] == [2 * 200 * 200, 200, 200], f"{seen['ltc']} {seen['albedo']}")


@case("export.babylon_module_changes_anisotropic_materials_alone")
def babylon(bench):
    bench.run("export", "babylon", "--technique", "major_axis", "-o", "burnish_babylon.mjs").expect(0)
    seen = node(bench, USE_BABYLON)
    check(seen["counts"] == [1, 0, 1], f"{seen['counts']} materials changed")
    check(seen["names"] == ["burnish_lobe_albedo"] and seen["bound"] == {"burnish_lobe_albedo": [80000, 200]}, f"{seen['bound']}")
    check(seen["found"] == [True, True] and seen["vertex"] is None, f"places in the engine's shader: {seen['found']}")
    check(len(set(seen["classes"])) == 3, f"materials with other shaders share a class: {seen['classes']}")
    check("1.0 + f0 * 0.0 *" in seen["definitions"] and "1.0 + f0 * 1.0 *" in seen["bright"] and "MULTIPLE" not in seen["bright"], "multiple scattering")
    check("forceGLSL" in seen["wgsl"], f"a material in WGSL says '{seen['wgsl']}'")
    check("burnish_major_axis_specular(f, x)" in seen["definitions"] and "@" not in seen["definitions"], "a place is left open")
    check("//" not in seen["definitions"].split("const int burnish_levels")[0], "a comment, whose semicolons the engine takes for ends of statements")


def project(bench, engine):
    """Copies an example project into the case's folder, and writes its modules as npm does before `start`."""
    folder = bench.folder / engine
    shutil.copytree(ROOT / "apps/examples" / engine, folder)
    for command in json.loads((folder / "package.json").read_text())["scripts"]["prestart"].split(" && "):
        words = command.split()
        check(words[0] == "burnish" and words[-2] == "-o", f"{words}")
        bench.run(*words[1:-1], folder / words[-1]).expect(0)
    return folder


@case("export.example_projects_write_the_module_that_they_import")
def projects(bench):
    for engine in ("three", "babylon"):
        folder = project(bench, engine)
        modules = re.findall(r"import\('./(burnish_\w+\.js)'\)", (folder / "main.js").read_text())
        check(len(modules) == (2 if engine == "three" else 1), f"{engine}: {modules}")
        check(all((folder / module).is_file() for module in modules), f"{engine}: main.js imports a module that `prestart` does not write")
        check('src="main.js"' in (folder / "index.html").read_text(), f"{engine}: the page has no main.js")


def brushed_balls(path):
    """Writes the balls of the example projects as glTF."""
    across, down, words = 96, 64, {"P": [], "T": [], "U": [], "I": []}
    for j in range(down + 1):
        for i in range(across + 1):
            turn, height = 2 * math.pi * i / across, math.pi * j / down
            words["P"] += [-math.cos(turn) * math.sin(height), math.cos(height), math.sin(turn) * math.sin(height)]
            words["T"] += [math.sin(turn), 0, math.cos(turn), 1]
            words["U"] += [i / across, j / down]
    for j in range(down):
        for b in range(j * (across + 1), j * (across + 1) + across):
            c = b + across + 1
            words["I"] += ([b + 1, b, c + 1] if j else []) + ([b, c, c + 1] if j < down - 1 else [])
    count, views, accessors, data = len(words["U"]) // 2, [], [], b""
    for name, kind in (("P", "VEC3"), ("T", "VEC4"), ("U", "VEC2"), ("I", "SCALAR")):
        part = struct.pack(f"<{len(words[name])}{'I' if name == 'I' else 'f'}", *words[name])
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(part)})
        accessors.append({"bufferView": len(views) - 1, "componentType": 5125 if name == "I" else 5126, "type": kind,
                          "count": len(words[name]) if name == "I" else count, **({"min": [-1, -1, -1], "max": [1, 1, 1]} if name == "P" else {})})
        data += part
    linear = lambda code: [((int(code[k:k + 2], 16) / 255 + 0.055) / 1.055) ** 2.4 for k in (0, 2, 4)]  # all codes are above the straight part
    materials = [{"pbrMetallicRoughness": {"baseColorFactor": linear(code) + [1], "metallicFactor": 1, "roughnessFactor": 0.3},
                  "extensions": {"KHR_materials_anisotropy": {"anisotropyStrength": 0.8, "anisotropyRotation": turn}}}
                 for code, turn in (("e8e4dc", 0), ("e6a35c", math.pi / 2), ("d8b060", math.pi / 4))]
    mesh = {"attributes": {"POSITION": 0, "NORMAL": 0, "TANGENT": 1, "TEXCOORD_0": 2}, "indices": 3}
    path.write_text(json.dumps({"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_anisotropy"], "bufferViews": views, "accessors": accessors,
                                "buffers": [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
                                "materials": materials, "meshes": [{"primitives": [{**mesh, "material": i}]} for i in range(3)], "scene": 0,
                                "nodes": [{"mesh": i, "translation": [2.3 * (i - 1), 0, 0]} for i in range(3)], "scenes": [{"nodes": [0, 1, 2]}]}))


def screenshots(bench, folder):
    """Opens the project's page. Returns its balls with the module and without it."""
    class Quiet(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_):
            pass

    (bench.folder / "profile").mkdir(exist_ok=True)
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=folder)) as host:
        threading.Thread(target=host.serve_forever, daemon=True).start()
        with Browser(bench.folder, webgl=True) as browser:
            browser.size(900, 420)
            browser.visit(f"http://127.0.0.1:{host.server_address[1]}/index.html")
            browser.until("document.documentElement.dataset.drawn === 'yes'", 120.0)
            said = browser.value("document.getElementById('state').textContent")
            browser.value("for (const part of document.querySelectorAll('label, #state')) part.style.display = 'none'")
            time.sleep(2.0)
            browser.screenshot(folder / "with.png")
            browser.value("document.getElementById('improved').click()")
            time.sleep(4.0)
            browser.screenshot(folder / "without.png")
            check(said == "3 materials improved" and not browser.faults, f"{said}; {browser.faults}")
        host.shutdown()
    return [folder / "with.png", folder / "without.png"]


# The example's balls by WebGPU, into a target: browsers without a window show no canvas of WebGPU.
NODE_PAGE = """<!DOCTYPE html><title>node</title><link rel="icon" href="data:,">
<script type="importmap">{ "imports": { "three/webgpu": "./node_modules/three/build/three.webgpu.js", "three/tsl": "./node_modules/three/build/three.tsl.js" } }</script>
<script type="module">
import * as THREE from 'three/webgpu';
import { height, studio, width } from './studio.js';
import { improveAnisotropy } from './burnish_three_node.js';
window.draw = async improve => {
  const renderer = new THREE.WebGPURenderer(), wide = 900, high = 420;
  await renderer.init();
  if (!renderer.backend.isWebGPUBackend)
    return 'no WebGPU';
  renderer.setSize(wide, high);
  const picture = new THREE.DataTexture(studio(), width, height, THREE.RGBAFormat, THREE.FloatType), balls = new THREE.Group(), scene = new THREE.Scene();
  picture.magFilter = picture.minFilter = THREE.LinearFilter;
  picture.mapping = THREE.EquirectangularReflectionMapping;
  picture.needsUpdate = true;
  scene.environment = new THREE.PMREMGenerator(renderer).fromEquirectangular(picture).texture;
  for (let i = 0; i < 3; ++i) {
    const shape = new THREE.SphereGeometry(1, 96, 64);
    shape.computeTangents();
    const metal = new THREE.MeshPhysicalMaterial({ color: [0xe8e4dc, 0xe6a35c, 0xd8b060][i], metalness: 1, roughness: 0.3, anisotropy: 0.8 });
    metal.anisotropyRotation = [0, Math.PI / 2, Math.PI / 4][i];
    const ball = new THREE.Mesh(shape, metal);
    ball.position.x = 2.3 * (i - 1);
    balls.add(ball);
  }
  scene.add(balls);
  const count = improve ? improveAnisotropy(balls, { environment: scene.environment }) : 3;
  const sphere = new THREE.Box3().setFromObject(scene).getBoundingSphere(new THREE.Sphere());
  const camera = new THREE.PerspectiveCamera(30, wide / high, sphere.radius / 100, sphere.radius * 100);
  camera.position.copy(sphere.center).add(new THREE.Vector3(0, 0.25, 1).normalize().multiplyScalar(sphere.radius * 2.2));
  camera.lookAt(sphere.center);
  const target = new THREE.RenderTarget(wide, high, { type: THREE.FloatType });
  renderer.setRenderTarget(target);
  await renderer.renderAsync(scene, camera);
  window.pixels = await renderer.readRenderTargetPixelsAsync(target, 0, 0, wide, high);
  return `${count} materials`;
};
</script>
"""


def node_pictures(bench, folder):
    """Returns the balls with the node and without it."""
    class Quiet(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_):
            pass

    (folder / "node.html").write_text(NODE_PAGE)
    (bench.folder / "profile").mkdir(exist_ok=True)
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=folder)) as host:
        threading.Thread(target=host.serve_forever, daemon=True).start()
        with Browser(bench.folder, webgl=True) as browser:
            browser.visit(f"http://127.0.0.1:{host.server_address[1]}/node.html")
            browser.until("Boolean(window.draw)", 60.0)
            for name, improve in (("with", "true"), ("without", "false")):
                said = browser.value(f"draw({improve})")
                if said == "no WebGPU":
                    raise Skipped(said)
                check(said == "3 materials", f"{said}; {browser.faults}")
                rows = [browser.value(f"Array.from(pixels.subarray({3600 * y}, {3600 * y + 3600}))") for y in range(420)]
                (folder / f"{name}.pfm").write_bytes(b"PF\n900 420\n-1.0\n" + b"".join(
                    struct.pack("<2700f", *(row[4 * x + c] for x in range(900) for c in range(3))) for row in reversed(rows)))
        host.shutdown()
    return [folder / "with.pfm", folder / "without.pfm"]


def shown_over_black(linear, to):
    """Writes floats as a picture of 8 bits without alpha, as screenshots are."""
    width, height, values = read_pfm(linear)
    codes = [round(255 * (12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055)) for v in (min(max(v, 0.0), 1.0) for v in values)]
    to.write_bytes(png(width, height, lambda x, y: codes[3 * ((height - 1 - y) * width + x):3 * ((height - 1 - y) * width + x) + 3]))


@case("export.example_projects_draw_near_the_reference", tier="nightly")
def near_the_reference(bench):
    needs_embree(bench)
    engines = os.environ.get("BURNISH_ENGINES", "")
    if not engines:
        raise Skipped("no engines: BURNISH_ENGINES is to name a folder with node_modules that holds three, babylonjs and babylonjs-loaders")
    brushed_balls(bench.folder / "balls.gltf")
    sky = project(bench, "babylon") / "studio.js"
    shutil.copy(sky, bench.folder / "studio.mjs")
    node(bench, "import { studio_file } from './studio.mjs'; import { writeFileSync } from 'fs';\n"
                "writeFileSync('studio.hdr', Buffer.from(await studio_file().arrayBuffer())); console.log('1');")
    far = 2.2 * math.sqrt(3.3 ** 2 + 2) / math.sqrt(1 + 0.25 ** 2)  # where main.js puts the camera
    bench.run("render", "balls.gltf", "--env", "studio.hdr", "--eye", f"0,{0.25 * far},{far}", "--target", "0,0,0", "--fov", "30", "--size", "900x420",
              "--no-background", "--tonemap", "none", "--backend", "reference", "--samples", "256", "-o", "reference.pfm", "-q", timeout=600).expect(0)
    shown_over_black(bench.folder / "reference.pfm", bench.folder / "reference.png")
    for engine, pictures_of in (("babylon", screenshots), ("three", screenshots), ("three", node_pictures)):
        folder = bench.folder / engine if (bench.folder / engine).exists() else project(bench, engine)
        if not (folder / "node_modules").exists():
            (folder / "node_modules").symlink_to(pathlib.Path(engines).resolve() / "node_modules")
        flips = []
        for picture in pictures_of(bench, folder):
            bench.run("compare", "reference.png" if pictures_of == screenshots else "reference.pfm", picture, "--json", "c.json", "-q")
            flips.append(json.loads((bench.folder / "c.json").read_text())["flip_mean"])
        name = f"{engine}, {pictures_of.__name__}"
        print(f"{name}: FLIP {flips[1]:.3f} without the module, {flips[0]:.3f} with it")
        check(flips[0] < 0.05 and flips[0] < 0.3 * flips[1], f"{name}: FLIP {flips[1]:.3f} without the module, {flips[0]:.3f} with it")


BEVY = """struct VertexOutput { @builtin(position) position: vec4<f32>, @location(0) world_tangent: vec4<f32> };
struct FragmentOutput { @location(0) color: vec4<f32> };
struct Material { base_color: vec4<f32>, perceptual_roughness: f32, metallic: f32, reflectance: f32 };
struct View { exposure: f32 };
@group(0) @binding(0) var<uniform> view: View;
struct PbrInput { N: vec3<f32>, V: vec3<f32>, diffuse_occlusion: vec3<f32>, material: Material };
fn pbr_input_from_standard_material(in: VertexOutput, is_front: bool) -> PbrInput {
    return PbrInput(in.position.xyz, in.position.zyx, vec3<f32>(1.0), Material(in.position, 0.4, 1.0, 0.5));
}
fn alpha_discard(material: Material, color: vec4<f32>) -> vec4<f32> { return color; }
fn apply_pbr_lighting(input: PbrInput) -> vec4<f32> { return input.material.base_color; }
fn main_pass_post_lighting_processing(input: PbrInput, color: vec4<f32>) -> vec4<f32> { return color; }
"""
COMPILE = """async function run() {
    const adapter = navigator.gpu && await navigator.gpu.requestAdapter();
    if (!adapter)
        return {skipped: "no WebGPU"};
    const device = await adapter.requestDevice();
    const faults = (await device.createShaderModule({code: shader}).getCompilationInfo()).messages.filter(m => m.type == "error");
    return {error: faults.map(m => m.lineNum + ": " + m.message).join("\\n")};
}"""


@case("export.shaders_for_engines_on_webgpu_compile", budget=15)
def on_webgpu(bench):
    """A browser compiles the shaders of three modules."""
    for what in ("three-node", "bevy"):
        bench.run("export", what, "--technique", "lobe_line", "-o", what).expect(0)
    module = (bench.folder / "three-node").read_text()
    texts = re.findall(r"/\* wgsl \*/`(.*?)`", module, re.S)
    check(len(texts) == 2 and "@" not in re.sub(r"@(TECHNIQUE|SAMPLES)@", "@", texts[1]), "places are left, or parts are missing")
    bevy = re.sub(r"#import .*?\n}\n", BEVY, (bench.folder / "bevy").read_text(), flags=re.S)
    check("#import" not in bevy and "FragmentOutput {" in bevy and "* view.exposure" in bevy, "the stand-ins are not in place")
    choose = lambda first: re.sub(r"#ifdef VERTEX_TANGENTS\n(.*?)#else\n(.*?)#endif\n", lambda m: m[1 if first else 2], bevy, flags=re.S)
    with Browser(bench.folder, webgl=True) as browser:
        for name, text in (("three-node", "\n".join(texts)), ("bevy", choose(True)), ("bevy without tangents", choose(False))):
            page = bench.folder / "page.html"
            page.write_text(f"<!doctype html><title>shader</title><script>const shader = {json.dumps(text)};\n{COMPILE}</script>")
            browser.open(page)
            found = browser.value("run()")
            if found.get("skipped"):
                raise Skipped(found["skipped"])
            check(not found["error"], f"{name}: {found['error'][:1500]}")


# Godot's declarations for fragment(), and the words that GLSL has not.
GODOT = """#version 310 es
precision highp float;
precision highp int;
vec3 NORMAL, VIEW, TANGENT, BINORMAL, ALBEDO;
vec2 UV;
mat4 INV_VIEW_MATRIX;
float METALLIC, ROUGHNESS, ANISOTROPY;
vec4 RADIANCE;
"""
GODOT_MAIN = """layout(location = 0) out vec4 seen;
void main()
{
    vec4 at = gl_FragCoord;
    NORMAL = at.xyz, VIEW = at.yzx, TANGENT = at.zxy, BINORMAL = at.xxy, ALBEDO = at.yyz, UV = at.xy, INV_VIEW_MATRIX = mat4(at.x);
    METALLIC = ROUGHNESS = ANISOTROPY = at.w;
    fragment();
    seen = RADIANCE;
}
"""


@case("export.shader_for_godot_compiles_as_glsl")
def godot(bench):
    if not shutil.which("glslc"):
        raise Skipped("no glslc here")
    bench.run("export", "godot", "--technique", "lobe_line", "-o", "burnish.gdshader").expect(0)
    text = (bench.folder / "burnish.gdshader").read_text()
    check(text.count("shader_type spatial;") == 1 and "precise" not in text, "no shader of Godot")
    # Godot has no declarations of functions, and no parameter or variable with the name of a uniform
    check(not re.findall(r"^\w+ \w+\([^{}]*\);", text, re.M), f"{re.findall(r'^.*[)];', text, re.M)}")
    uniforms = re.findall(r"^uniform \w+ (\w+)", text, re.M)
    declared = set(re.findall(r"\b(?:float|int|uint|bool|vec[234]|mat[234]|burnish_\w+) (\w+)(?=[ ,;)=\[])", re.sub(r"^uniform.*", "", text, flags=re.M)))
    check(len(uniforms) == 11 and not declared & set(uniforms), f"{declared & set(uniforms)}")
    first = lambda word: text.index(word)
    check(first("vec4 burnish_radiance(int") < first("burnish_radiance(cube."), "the engine's function stands behind its first call")
    text = re.sub(r"^uniform (\w+) (\w+)[^;]*;", r"uniform highp \1 \2;", text.replace("shader_type spatial;", ""), flags=re.M)
    (bench.folder / "burnish.frag").write_text(GODOT + text + GODOT_MAIN)
    done = subprocess.run(["glslc", "-w", "--target-env=opengl", "-fauto-map-locations", "-fauto-bind-uniforms", bench.folder / "burnish.frag", "-o", bench.folder / "engine.spv"],
                          capture_output=True, text=True)
    check(done.returncode == 0, done.stderr[:1500])
    if shutil.which("spirv-opt") and shutil.which("spirv-dis"):
        check(not undefined(bench), "an optimiser finds values that nobody has written")
