// @TECHNIQUE@ in three.js' renderer on WebGPU: image light of materials with anisotropy. From burnish @VERSION@ (Apache License 2.0).
//
//     import { improveAnisotropy } from './burnish_three_node.js';
//     improveAnisotropy(scene, { environment });
//
// Another option, multipleScattering: true, adds light of the environment that leaves a lobe after several bounces, as the engine does for round
// lobes. Default false: glTF's lobe.
// Takes an object with all below it, or an array of these. environment: the texture that PMREMGenerator made, as in scene.environment. Replaces
// each MeshPhysicalMaterial and MeshPhysicalNodeMaterial with anisotropy by a node material with the technique, and returns their number. Call it
// again for what you load later; an object keeps its first environment. Others stay: materials with an environment of their own, with sheen, with
// iridescence or with retroreflection, and classes derived from these. Meshes need tangents. Lamps and area lights stay the engine's. Works with
// WebGPURenderer on WebGPU; tried with release 187. Throws for an environment that PMREMGenerator did not make.
import { ClampToEdgeWrapping, DataTexture, LinearFilter, MeshPhysicalNodeMaterial, PhysicalLightingModel, RGFormat, UnsignedByteType } from 'three/webgpu';
import { alphaT, anisotropyT, cameraWorldMatrix, cubeTexture, float, materialEnvIntensity, materialEnvRotation, normalView, positionViewDirection, roughness,
         sampler, specularColorBlended, specularF90, texture, vec2, vec3, wgsl, wgslFn } from 'three/tsl';

// Directional albedo of lobes with two widths: the texture lobe_albedo of `burnish bake environment`, in 8 bits.
const albedo = Uint8Array.from(atob('@ALBEDO@'), c => c.charCodeAt(0));
const albedoTexture = new DataTexture(albedo, 200, 200, RGFormat, UnsignedByteType);
albedoTexture.minFilter = albedoTexture.magFilter = LinearFilter;
albedoTexture.wrapS = albedoTexture.wrapT = ClampToEdgeWrapping;
albedoTexture.needsUpdate = true;

const technique = wgsl(/* wgsl */`
@SHADER@
const burnish_levels = 9;
// Cubes of three.js on WebGPU run the other way along x.
fn burnish_radiance(burnish_cube: texture_cube<f32>, burnish_taps: sampler, cube: i32, direction: vec3<f32>, lod: f32) -> vec4<f32> {
    let rough = clamp(lod / f32(burnish_levels - 1), 0.0, 1.0);
    let level = f32(textureNumLevels(burnish_cube) - 1u) * rough * (2.0 - rough);
    return textureSampleLevel(burnish_cube, burnish_taps, vec3<f32>(-direction.x, direction.yz), level);
}
`);

// Returns the light of the environment from the lobe. multiple: share of the light that leaves it after several bounces. widths: along the grain and across.
const imageLight = wgslFn(/* wgsl */`
fn burnish_image_light(cube: texture_cube<f32>, taps: sampler, albedo: texture_2d<f32>, albedo_taps: sampler, n: vec3<f32>, v: vec3<f32>, grain: vec3<f32>,
                       widths: vec2<f32>, f0: vec3<f32>, f90: vec3<f32>, multiple: f32) -> vec3<f32> {
    let mean = max(0.5 * (widths.x + widths.y), 1e-4);
    let rough = sqrt(mean);
    let anisotropy = clamp((widths.x - widths.y) / (2.0 * mean), -0.999, 0.999);
    let along = grain - n * dot(n, grain);
    let other = cross(n, select(vec3<f32>(0.0, 1.0, 0.0), vec3<f32>(1.0, 0.0, 0.0), abs(n.x) < 0.5));
    let tangent = normalize(select(other, along, dot(along, along) > 1e-6));
    let at = burnish_albedo_place(n, v, tangent, rough, anisotropy);
    let corner = textureSampleLevel(albedo, albedo_taps, at.xy, 0.0).rg;
    let right = textureSampleLevel(albedo, albedo_taps, at.xy + vec2<f32>(0.1, 0.0), 0.0).rg;
    let below = textureSampleLevel(albedo, albedo_taps, at.xy + vec2<f32>(0.0, 0.1), 0.0).rg;
    let opposite = textureSampleLevel(albedo, albedo_taps, at.xy + vec2<f32>(0.1, 0.1), 0.0).rg;
    let dfg = mix(mix(corner, right, at.z), mix(below, opposite, at.z), at.w);
    let f = burnish_usual_settings(256, burnish_levels, @SAMPLES@);
    let x = burnish_point_of(f, n, v, tangent, f0, f90, rough, anisotropy, dfg, 0);
    return burnish_@TECHNIQUE@_specular(cube, taps, f, x) * (1.0 + f0 * multiple * (1.0 / max(dfg.x + dfg.y, 1e-3) - 1.0));
}
`, [technique]);

// The engine's lighting, with the technique's light in place of its one fetch.
class Lighting extends PhysicalLightingModel {
  // The engine adds multiple scattering as even light; the lobe may add its own. The sum, which diffuse light goes without, stays.
  computeMultiscattering(single, multiple, ...rest) {
    super.computeMultiscattering(single, multiple, ...rest);
    single.addAssign(multiple);
    multiple.assign(vec3(0));
  }

  indirectSpecular(builder) {
    const { radiance, reflectedLight } = builder.context, { cube } = builder.material.burnish;
    radiance.assign(vec3(0));
    super.indirectSpecular(builder);
    const world = direction => materialEnvRotation.mul(direction.transformDirection(cameraWorldMatrix));
    const across = roughness.mul(roughness).max(1e-4);
    const light = imageLight({
      cube, taps: sampler(cube), albedo: texture(albedoTexture), albedo_taps: sampler(texture(albedoTexture)),
      n: world(normalView), v: world(positionViewDirection), grain: world(anisotropyT), widths: vec2(alphaT.max(across), across),
      f0: specularColorBlended, f90: vec3(specularF90), multiple: float(builder.material.burnish.multipleScattering ? 1 : 0),
    });
    reflectedLight.indirectSpecular.addAssign(light.mul(materialEnvIntensity));
  }
}

// A material whose lighting model is the one above.
class BurnishMaterial extends MeshPhysicalNodeMaterial {
  setupLightingModel() {
    return new Lighting(this.useClearcoat, this.useSheen, this.useIridescence, this.useAnisotropy, this.useTransmission, this.useDispersion,
                        this.useRetroreflection, this.useDiffuseRoughness);
  }

  copy(source) {
    super.copy(source);
    this.burnish = source.burnish;
    return this;
  }

  // Materials with one environment share a program.
  customProgramCacheKey() {
    return `${super.customProgramCacheKey()} burnish ${this.burnish?.cube.value.uuid} ${this.burnish?.multipleScattering}`;
  }
}

const known = [new WeakMap(), new WeakMap()]; // by multipleScattering, material, then environment

function improved(material, environment, multipleScattering) {
  const physical = material.type === 'MeshPhysicalMaterial' || material.constructor === MeshPhysicalNodeMaterial;
  if (!physical || !(material.anisotropy > 0 || material.anisotropyNode) || material.envMap || material.envNode || material.sheen > 0 ||
      material.sheenNode || material.iridescence > 0 || material.iridescenceNode || material.retroreflectivity > 0)
    return material;
  const same = known[Number(multipleScattering)], of = same.get(material) ?? new WeakMap();
  same.set(material, of);
  if (of.has(environment))
    return of.get(environment);
  const made = new BurnishMaterial();
  for (const key in material)
    if (key in made && !['type', 'uuid', 'id', 'version'].includes(key) && typeof material[key] !== 'function' && !key.startsWith('is'))
      made[key] = material[key];
  made.burnish = { cube: cubeTexture(environment), multipleScattering };
  of.set(environment, made);
  return made;
}

export function improveAnisotropy(target, { environment, multipleScattering = false } = {}) {
  if (!environment?.isPMREMTexture)
    throw new Error('burnish: environment is no texture of PMREMGenerator');
  const changed = new Set();
  const each = material => {
    const made = improved(material, environment, multipleScattering);
    if (made !== material)
      changed.add(made);
    return made;
  };
  for (const one of [target].flat())
    one.traverse(object => {
      if (object.material)
        object.material = Array.isArray(object.material) ? object.material.map(each) : each(object.material);
    });
  return changed.size;
}
