// @TECHNIQUE@ in Babylon.js: image light of PBR materials with anisotropy. From burnish @VERSION@ (Apache License 2.0).
//
//     import { improveAnisotropy } from './burnish_babylon.js';
//     improveAnisotropy(BABYLON, scene.materials);
//
// Takes the namespace with MaterialPluginBase, RawTexture and Constants, and a material or an array of materials. Returns the number of
// materials changed; call it before the first frame, and again for what you load or clone later. Reads the prefiltered cube that Babylon.js
// keeps (scene.environmentTexture), and leaves materials without anisotropy alone. Works with shaders in GLSL, as in WebGL 2. Throws for
// materials in WGSL. Options:
//   glTF  true for models with texture coordinates that grow downwards, as in glTF files; else false. Default true.
//   multipleScattering  true adds light of the environment that leaves a lobe after several bounces, as the engine does for round lobes;
//         false is glTF's lobe. Default false.

// Directional albedo of lobes with two widths: the texture lobe_albedo of `burnish bake environment`, in 8 bits.
const albedo = Uint8Array.from(atob('@ALBEDO@'), c => c.charCodeAt(0));

const technique = /* glsl */`
#if defined(ANISOTROPIC) && defined(REFLECTION) && defined(REFLECTIONMAP_3D) && defined(LODBASEDMICROSFURACE)
@SHADER@
const int burnish_levels = 9;
vec4 burnish_radiance(int cube, vec3 direction, float lod)
{
    vec3 coordinates = vec3(reflectionMatrix * vec4(direction, 0.0));
#ifdef INVERTCUBICMAP
    coordinates.y *= -1.0;
#endif
#ifdef REFLECTIONMAP_OPPOSITEZ
    coordinates.z *= -1.0;
#endif
    float roughness = max(lod / float(burnish_levels - 1), 1e-3);
#ifdef LINEARSPECULARREFLECTION
    float level = getLinearLodFromRoughness(vReflectionMicrosurfaceInfos.x, roughness);
#else
    float level = log2(vReflectionMicrosurfaceInfos.x * roughness * roughness);
#endif
    vec4 light = sampleReflectionLod(reflectionSampler, coordinates, max(level * vReflectionMicrosurfaceInfos.y + vReflectionMicrosurfaceInfos.z, 0.0));
#ifdef RGBDREFLECTION
    light.rgb = fromRGBD(light);
#endif
#ifdef GAMMAREFLECTION
    light.rgb = toLinearSpace(light.rgb);
#endif
    return vec4(light.rgb * vReflectionInfos.x * vReflectionColor.rgb, 1.0);
}
uniform sampler2D burnish_lobe_albedo;
// Returns radiance that the engine will multiply by reflectance. reflectance: of a round lobe, with multiple scattering.
vec3 burnish_image_light(vec3 v, vec3 n, vec3 grain, vec2 widths, float kept, vec3 f0, vec3 f90, vec3 reflectance)
{
    // Where a pixel holds many directions, its widths follow from the mean covariance
    vec2 squares = widths * widths;
    float middle = 0.5 * (squares.x + squares.y), apart = 0.5 * (squares.x - squares.y) * kept;
    widths = vec2(sqrt(middle + apart), sqrt(middle - apart));
    float mean = max(0.5 * (widths.x + widths.y), 1e-4), roughness = sqrt(mean), anisotropy = clamp((widths.x - widths.y) / (2.0 * mean), -0.999, 0.999);
    vec3 tangent = grain - n * dot(n, grain);
    tangent = dot(tangent, tangent) > 1e-6 ? normalize(tangent) : normalize(cross(n, abs(n.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
    vec4 at = burnish_albedo_place(n, v, tangent, roughness, anisotropy);
    vec2 dfg = mix(mix(textureLod(burnish_lobe_albedo, at.xy, 0.0).rg, textureLod(burnish_lobe_albedo, at.xy + vec2(0.1, 0.0), 0.0).rg, at.z),
                   mix(textureLod(burnish_lobe_albedo, at.xy + vec2(0.0, 0.1), 0.0).rg, textureLod(burnish_lobe_albedo, at.xy + vec2(0.1), 0.0).rg, at.z), at.w);
    burnish_settings f = burnish_usual_settings(256, burnish_levels, @SAMPLES@);
    burnish_shaded_point x = burnish_point_of(f, n, v, tangent, f0, f90, roughness, anisotropy, dfg, 0);
    vec3 light = burnish_@TECHNIQUE@_specular(f, x);
    light *= 1.0 + f0 * MULTIPLE * (1.0 / max(dfg.x + dfg.y, 1e-3) - 1.0);
    return light / max(reflectance, vec3(1e-4));
}
#endif
`;

// The engine's radiance, and the technique's in its place.
const place = 'vec3 finalRadiance=reflectionOut\\.environmentRadiance\\.rgb;';
const call = /* glsl */`
#if defined(ANISOTROPIC) && defined(REFLECTIONMAP_3D) && defined(LODBASEDMICROSFURACE)
#ifdef ENVIRONMENTBRDF
vec3 burnishReflectance = getReflectanceFromBRDFLookup(clearcoatOut.specularEnvironmentR0, specularEnvironmentR90, environmentBrdf);
#else
vec3 burnishReflectance = getReflectanceFromAnalyticalBRDFLookup_Jones(NdotV, clearcoatOut.specularEnvironmentR0, specularEnvironmentR90, sqrt(microSurface));
#endif
#if defined(ENVIRONMENTBRDF) && defined(MS_BRDF_ENERGY_CONSERVATION)
burnishReflectance *= getEnergyConservationFactor(clearcoatOut.specularEnvironmentR0, environmentBrdf);
#endif
float burnishKept = 1.0; // length of the mean double-angle direction within the pixel
#ifdef ANISOTROPIC_TEXTURE
vec2 burnishDirection = 2.0 * anisotropyMapData.rg - 1.0, burnishStep = max(abs(dFdx(vAnisotropyUV)), abs(dFdy(vAnisotropyUV))) * vec2(textureSize(anisotropySampler, 0));
burnishKept = mix(1.0, min(square(dot(burnishDirection, burnishDirection)), 1.0), clamp(log2(max(burnishStep.x, burnishStep.y)), 0.0, 1.0));
#endif
vec3 finalRadiance = burnish_image_light(viewDirectionW, normalW, anisotropicOut.anisotropicTangent, getAnisotropicRoughness(alphaG, anisotropicOut.anisotropy),
                                         burnishKept, clearcoatOut.specularEnvironmentR0, specularEnvironmentR90, burnishReflectance);
#else
vec3 finalRadiance = reflectionOut.environmentRadiance.rgb;
#endif
`;

// Tangents made from texture coordinates get the handedness that glTF gives them. A bump map brings its own signs.
const tangents = 'anisotropicOut=anisotropicBlock\\(([^;]*)\\);';
const flipped = /* glsl */`
anisotropicOut=anisotropicBlock($1);
#if !defined(TANGENT) && !defined(BUMP)
{
    vec3 burnishAlong = normalize(TBN[0]);
    anisotropicOut.anisotropicTangent = 2.0 * dot(anisotropicOut.anisotropicTangent, burnishAlong) * burnishAlong - anisotropicOut.anisotropicTangent;
    anisotropicOut.anisotropicBitangent = normalize(cross(normalize(TBN[2]), anisotropicOut.anisotropicTangent));
}
#endif
`;

const textures = new WeakMap(); // by scene

function albedoTexture(BABYLON, scene) {
  if (!textures.has(scene)) {
    const { TEXTUREFORMAT_RG, TEXTURETYPE_UNSIGNED_BYTE, TEXTURE_BILINEAR_SAMPLINGMODE } = BABYLON.Constants;
    const texture = new BABYLON.RawTexture(albedo, 200, 200, TEXTUREFORMAT_RG, scene, false, false, TEXTURE_BILINEAR_SAMPLINGMODE, TEXTURETYPE_UNSIGNED_BYTE);
    texture.wrapU = texture.wrapV = BABYLON.Constants.TEXTURE_CLAMP_ADDRESSMODE;
    textures.set(scene, texture);
  }
  return textures.get(scene);
}

// The base class asks for code before the constructor ends.
function pluginClass(BABYLON, glTF, multipleScattering) {
  return class BurnishAnisotropy extends BABYLON.MaterialPluginBase {
    constructor(material) {
      super(material, 'BurnishAnisotropy', 200, {}, true, true);
      this.texture = albedoTexture(BABYLON, material.getScene());
    }
    getClassName() { // materials with equal names share a compiled shader
      return `BurnishAnisotropy${glTF ? 'OfGltf' : ''}${multipleScattering ? 'Multiple' : ''}`;
    }
    getSamplers(samplers) {
      samplers.push('burnish_lobe_albedo');
    }
    bindForSubMesh(buffer) {
      buffer.setTexture('burnish_lobe_albedo', this.texture);
    }
    isReadyForSubMesh() {
      return this.texture.isReady();
    }
    getCustomCode(kind) {
      if (kind !== 'fragment')
        return null;
      return { CUSTOM_FRAGMENT_DEFINITIONS: technique.replace('MULTIPLE', multipleScattering ? '1.0' : '0.0'), ['!' + place]: call, ...(glTF ? { ['!' + tangents]: flipped } : {}) };
    }
  };
}

export function improveAnisotropy(BABYLON, materials, { glTF = true, multipleScattering = false } = {}) {
  const Plugin = pluginClass(BABYLON, glTF, multipleScattering);
  let count = 0;
  const list = [materials].flat();
  if (list.some(material => material.anisotropy?.isEnabled && material.shaderLanguage))
    throw new Error('burnish: a material has shaders in WGSL, and this module is in GLSL (forceGLSL makes such materials)');
  for (const material of list) {
    if (!material.anisotropy?.isEnabled || material.pluginManager?.getPlugin('BurnishAnisotropy'))
      continue;
    new Plugin(material);
    ++count;
  }
  return count;
}
