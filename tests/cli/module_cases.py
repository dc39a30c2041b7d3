"""burnish export three, babylon: modules that connect a technique to an engine, beside stand-ins for the engines and in the engines."""

import json
import os
import pathlib
import shutil
import subprocess

from harness import Skipped, case, check

ROOT = pathlib.Path(__file__).resolve().parents[2]

# The parts of an engine that the modules touch.
THREE = """
export const ShaderChunk = {
  normal_vertex: 'vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );',
  envmap_common_pars_fragment: 'uniform mat3 envMapRotation;',
  lights_physical_pars_fragment: 'struct PhysicalMaterial { vec3 specularColor; vec2 dfg; float alphaT; }; void RE_Direct_RectArea_Physical() {}',
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
const { data, width, height } = shader.uniforms.burnish_ltc.value, albedo = shader.uniforms.burnish_lobe_albedo.value;
ShaderChunk.envmap_common_pars_fragment = '';
let old = '';
try { improveAnisotropy(made(1)); } catch (error) { old = error.message; }
console.log(JSON.stringify({ counts, fault, old, apart, first: shader.first, key: brushed.customProgramCacheKey(), plain: plain.customProgramCacheKey(), vertex: shader.vertexShader,
  fragment: shader.fragmentShader, ltc: [data.length, width, height], albedo: [albedo.data.length, albedo.width, albedo.height] }));
"""
USE_BABYLON = """
import { improveAnisotropy } from './burnish_babylon.mjs';
class MaterialPluginBase {
  constructor(material, name) { material.pluginManager = { getPlugin: asked => asked === name ? this : null }; this.code = this.getCustomCode('fragment'); }
}
class RawTexture { constructor(data, width, height) { Object.assign(this, { data, width, height }); } isReady() { return true; } }
const BABYLON = { MaterialPluginBase, RawTexture, Constants: {} }, scene = {};
const made = isEnabled => ({ anisotropy: { isEnabled }, getScene: () => scene });
const brushed = made(true), plain = made(false), other = {};
const counts = [improveAnisotropy(BABYLON, [brushed, plain, other]), improveAnisotropy(BABYLON, brushed), improveAnisotropy(BABYLON, made(true), { glTF: false })];
let wgsl = '';
try { improveAnisotropy(BABYLON, [{ ...made(true), shaderLanguage: 1 }]); } catch (error) { wgsl = error.message; }
const plugin = brushed.pluginManager.getPlugin('BurnishAnisotropy'), names = [], bound = {};
plugin.getSamplers(names);
plugin.bindForSubMesh({ setTexture: (name, texture) => bound[name] = [texture.data.length, texture.width] });
const found = Object.keys(plugin.code).filter(key => key[0] === '!').map(key => new RegExp(key.slice(1)).test(
  'anisotropicOut=anisotropicBlock(\\nvAnisotropy,\\n#ifdef ANISOTROPIC_TEXTURE\\nmap,\\n#endif\\nviewDirectionW\\n);\\nvec3 finalRadiance=reflectionOut.environmentRadiance.rgb;'));
console.log(JSON.stringify({ counts, names, bound, found, wgsl, vertex: plugin.getCustomCode('vertex'), definitions: plugin.code.CUSTOM_FRAGMENT_DEFINITIONS }));
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
    check(seen["first"] and seen["key"].endswith(" own burnish lobe_line 64 true") and seen["plain"] == "own", f"the material's own functions: {seen['key']}")
    check("determinant" in seen["vertex"], "bitangents do not turn over")
    for word in ("burnish_image_light( geometryViewDir", "burnish_lobe_line_specular(f, x)", "anisotropyV.y = - anisotropyV.y", "burnish_quad_light(", "burnish_kept = mix"):
        check(word in seen["fragment"], f"the shader lacks {word}")
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
    check("forceGLSL" in seen["wgsl"], f"a material in WGSL says '{seen['wgsl']}'")
    check("burnish_major_axis_specular(f, x)" in seen["definitions"] and "@" not in seen["definitions"], "a place is left open")
    check("//" not in seen["definitions"].split("const int burnish_levels")[0], "a comment, whose semicolons the engine takes for ends of statements")


@case("export.modules_bring_engines_nearer_to_the_truth", tier="nightly")
def nearer(bench):
    engines = os.environ.get("BURNISH_ENGINES", "")
    if not engines:
        raise Skipped("no engines: BURNISH_ENGINES is to name a folder with node_modules that holds three, babylonjs and babylonjs-loaders")
    done = subprocess.run(["python3", "-B", ROOT / "bench/lab/conform.py", "--program", bench.program, "--engines", engines, "--work", bench.folder / "work",
                           "--only", "three,babylon", "--modules", "lobe_line:64", "--json", bench.folder / "rows.json"], capture_output=True, text=True)
    check(done.returncode == 0, done.stderr[-1500:])
    for row in json.loads((bench.folder / "rows.json").read_text()):
        before, after = row["flip_to_truth"]["as_it_is"], row["flip_to_truth"]["module"]
        for scene in ("rotation_0", "rotation_30", "rotation_90", "smooth", "direction_map", "own_tangents", "no_tangents", "mirrored_node", "minified", "coat"):
            check(after[scene] < 0.5 * before[scene], f"{row['engine']}, {scene}: {before[scene]:.3f} before, {after[scene]:.3f} with the module")
        for scene in ("mirror", "round", "lamp"):
            check(abs(after[scene] - before[scene]) < 1e-6, f"{row['engine']}, {scene}: changed")
