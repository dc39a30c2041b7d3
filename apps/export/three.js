// @TECHNIQUE@ in three.js: image light and area lights on MeshPhysicalMaterial with anisotropy. From burnish @VERSION@ (Apache License 2.0).
//
//     import { improveAnisotropy } from './burnish_three.js';
//     improveAnisotropy(scene);
//
// Takes a material, an object with all below it, or an array of these. Returns the number of materials changed; call it before the first
// frame, and again for what you load or clone later. Reads the prefiltered environment that three.js makes (scene.environment). Rectangular
// area lights need RectAreaLightUniformsLib, as ever. Leaves materials without anisotropy alone. Options:
//   glTF  true for models with texture coordinates that grow downwards, as in glTF files; else false. Default true.
//   multipleScattering  true adds light of the environment that leaves a lobe after several bounces, as the engine does for round lobes;
//         false is glTF's lobe. Default false.
// Works with WebGLRenderer; tried with releases 170 and 187. Throws where the shaders of your version are not known.
import { ClampToEdgeWrapping, DataTexture, HalfFloatType, LinearFilter, NearestFilter, RGBAFormat, RGFormat, ShaderChunk, UnsignedByteType } from 'three';

// Directional albedo of lobes with two widths: the texture lobe_albedo of `burnish bake environment`, in 8 bits.
const albedo = Uint8Array.from(atob('@ALBEDO@'), c => c.charCodeAt(0));
const albedoTexture = new DataTexture(albedo, 200, 200, RGFormat, UnsignedByteType);
albedoTexture.minFilter = albedoTexture.magFilter = LinearFilter;
albedoTexture.wrapS = albedoTexture.wrapT = ClampToEdgeWrapping;
albedoTexture.needsUpdate = true;

// Transformed cosines of anisotropic lobes: the texture ltc of `burnish bake environment`.
const ltc = Uint8Array.from(atob('@LTC@'), c => c.charCodeAt(0));
const ltcTexture = new DataTexture(new Uint16Array(ltc.buffer), 192, 88, RGBAFormat, HalfFloatType);
ltcTexture.minFilter = ltcTexture.magFilter = NearestFilter;
ltcTexture.needsUpdate = true;

const technique = /* glsl */`
#if defined( USE_ANISOTROPY )
@SHADER@
#endif
`;

// The engine's fetch, and the technique in the engine's words. All directions are in view space.
const call = /* glsl */`
#if defined( USE_ANISOTROPY )
const int burnish_levels = 9;
vec4 burnish_radiance(int cube, vec3 direction, float lod)
{
#if defined( USE_ENVMAP ) && ( defined( ENVMAP_TYPE_PMREM ) || defined( ENVMAP_TYPE_CUBE_UV ) )
    vec3 world = envMapRotation * normalize((vec4(direction, 0.0) * viewMatrix).xyz);
    float roughness = lod / float(burnish_levels - 1);
#if defined( ENVMAP_TYPE_PMREM )
    return textureLod(envMap, world, roughnessToMip(roughness)) * envMapIntensity;
#else
    return textureCubeUV(envMap, world, roughness) * envMapIntensity;
#endif
#else
    return vec4(0.0);
#endif
}
uniform sampler2D burnish_lobe_albedo;
float burnish_kept = 1.0; // length of the mean double-angle direction within the pixel
uniform highp sampler2D burnish_ltc;
vec4 burnish_ltc_texel(int at)
{
    return texelFetch(burnish_ltc, ivec2(at % 192, at / 192), 0);
}
// Returns the point of a material, and its lobe's directional albedo.
burnish_shaded_point burnish_point_in_three(vec3 v, vec3 n, PhysicalMaterial material, out float albedo)
{
    float across = max(material.roughness * material.roughness, 1e-4), along = max(material.alphaT, across);
    // Where a pixel holds many directions, its widths follow from the mean covariance
    float middle = 0.5 * (along * along + across * across), apart = 0.5 * (along * along - across * across) * burnish_kept;
    along = sqrt(middle + apart), across = sqrt(middle - apart);
    float mean = 0.5 * (along + across), roughness = sqrt(mean), anisotropy = (along - across) / (along + across);
    vec3 tangent = material.anisotropyT - n * dot(n, material.anisotropyT);
    tangent = dot(tangent, tangent) > 1e-6 ? normalize(tangent) : normalize(cross(n, abs(n.x) < 0.5 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
    vec4 at = burnish_albedo_place(n, v, tangent, roughness, anisotropy);
    vec2 dfg = mix(mix(textureLod(burnish_lobe_albedo, at.xy, 0.0).rg, textureLod(burnish_lobe_albedo, at.xy + vec2(0.1, 0.0), 0.0).rg, at.z),
                   mix(textureLod(burnish_lobe_albedo, at.xy + vec2(0.0, 0.1), 0.0).rg, textureLod(burnish_lobe_albedo, at.xy + vec2(0.1), 0.0).rg, at.z), at.w);
    albedo = max(dfg.x + dfg.y, 1e-3);
    burnish_settings f = burnish_usual_settings(256, burnish_levels, @SAMPLES@);
    return burnish_point_of(f, n, v, tangent, material.SPECULAR, vec3(material.specularF90), roughness, anisotropy, dfg, 0);
}
// Returns radiance that the engine will multiply by the reflectance of a round lobe.
vec3 burnish_image_light(vec3 v, vec3 n, PhysicalMaterial material)
{
    vec2 round_dfg = DFG;
    float albedo;
    burnish_settings f = burnish_usual_settings(256, burnish_levels, @SAMPLES@);
    burnish_shaded_point x = burnish_point_in_three(v, n, material, albedo);
    vec3 light = burnish_@TECHNIQUE@_specular(f, x) * (1.0 + MULTIPLE * material.SPECULAR * (1.0 / albedo - 1.0));
    return light / max(material.SPECULAR * round_dfg.x + vec3(material.specularF90) * round_dfg.y, vec3(1e-4));
}
#if NUM_RECT_AREA_LIGHTS > 0
// Takes the diffuse part and the coat from the engine.
void burnish_rect_area(const in RectAreaLight light, const in vec3 position, const in vec3 n, const in vec3 v, const in vec3 coat_normal,
                       const in PhysicalMaterial material, inout ReflectedLight reflectedLight)
{
    ReflectedLight engine = ReflectedLight(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
    RE_Direct_RectArea_Physical(light, position, n, v, coat_normal, material, engine);
    vec3 middle = light.position - position;
    float albedo;
    reflectedLight.directDiffuse += engine.directDiffuse;
    reflectedLight.directSpecular += burnish_quad_light(burnish_point_in_three(v, n, material, albedo), middle + light.halfWidth - light.halfHeight,
        middle - light.halfWidth - light.halfHeight, middle - light.halfWidth + light.halfHeight, middle + light.halfWidth + light.halfHeight,
        light.color, false);
}
#undef RE_Direct_RectArea
#define RE_Direct_RectArea burnish_rect_area
#endif
#endif
`;

function replaced(text, old, by, place) {
  if (!text.includes(old))
    throw new Error(`burnish: ${place} of three.js holds no '${old}': an unknown version, or changed by other code`);
  return text.replace(old, by);
}

// Throws at once where a frame would fail later.
function checkVersion() {
  for (const [chunk, word] of [['envmap_common_pars_fragment', 'envMapRotation'], ['lights_physical_pars_fragment', 'alphaT'],
                               ['lights_physical_pars_fragment', 'RE_Direct_RectArea_Physical'],
                               ['lights_physical_pars_fragment', ShaderChunk.lights_physical_pars_fragment?.includes('vec2 dfg;') ? 'dfg' : 'vec2 DFGApprox(']])
    replaced(ShaderChunk[chunk] ?? '', word, word, chunk);
  patchedVertex('#include <normal_vertex>');
  patchedFragment('#include <lights_fragment_maps> #include <lights_physical_fragment> #include <lights_physical_pars_fragment>', true, true);
}

// A bitangent turns over with a mirroring node, and has the sign that glTF gives it.
function patchedVertex(text) {
  const chunk = replaced(ShaderChunk.normal_vertex, 'vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );', `
		float burnish_turn = determinant( mat3( modelViewMatrix ) );
		#ifdef USE_INSTANCING
			burnish_turn *= determinant( mat3( instanceMatrix ) );
		#endif
		#ifdef USE_BATCHING
			burnish_turn *= determinant( mat3( batchingMatrix ) );
		#endif
		vBitangent = normalize( cross( vNormal, vTangent ) * ( burnish_turn < 0.0 ? - tangent.w : tangent.w ) );`, 'normal_vertex');
  return replaced(text, '#include <normal_vertex>', chunk, 'meshphysical_vert');
}

function patchedFragment(text, glTF, multipleScattering) {
  const specular = ShaderChunk.lights_physical_pars_fragment.includes('specularColorBlended') ? 'specularColorBlended' : 'specularColor';
  const kept = ShaderChunk.lights_physical_pars_fragment.includes('vec2 dfg;');
  const dfg = kept ? 'material.dfg' : 'DFGApprox( n, v, material.roughness )';
  // The engine adds multiple scattering of a round lobe as even light. The lobe may add its own.
  const physical = replaced(ShaderChunk.lights_physical_pars_fragment, 'multiScattering * cosineWeightedIrradiance', 'vec3( 0.0 )',
                            'lights_physical_pars_fragment');
  const maps = replaced(ShaderChunk.lights_fragment_maps,
    'getIBLAnisotropyRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy )',
    'burnish_image_light( geometryViewDir, geometryNormal, material )', 'lights_fragment_maps');
  let lobe = replaced(ShaderChunk.lights_physical_fragment, 'material.anisotropy = length( anisotropyV );',
    `${glTF ? '#ifndef USE_TANGENT\n\tanisotropyV.y = - anisotropyV.y;\n\t#endif\n\t' : ''}material.anisotropy = length( anisotropyV );`, 'lights_physical_fragment');
  // Mip levels hold mean directions, whose length tells how far the directions of a minified pixel lie apart
  lobe = replaced(lobe, 'vec2 anisotropyV = anisotropyMat', `vec2 burnish_direction = 2.0 * anisotropyPolar.rg - 1.0;
	vec2 burnish_step = max( abs( dFdx( vAnisotropyMapUv ) ), abs( dFdy( vAnisotropyMapUv ) ) ) * vec2( textureSize( anisotropyMap, 0 ) );
	burnish_kept = mix( 1.0, min( pow2( dot( burnish_direction, burnish_direction ) ), 1.0 ), clamp( log2( max( burnish_step.x, burnish_step.y ) ), 0.0, 1.0 ) );
	vec2 anisotropyV = anisotropyMat`, 'lights_physical_fragment');
  text = replaced(text, '#include <lights_fragment_maps>', maps, 'meshphysical_frag');
  text = replaced(text, '#include <lights_physical_fragment>', lobe, 'meshphysical_frag');
  // The material's struct is declared behind the environment's functions
  return replaced(text, '#include <lights_physical_pars_fragment>',
    physical + '\n' + technique + call.replaceAll('SPECULAR', specular).replace('DFG', dfg).replace('MULTIPLE', multipleScattering ? '1.0' : '0.0'),
    'meshphysical_frag');
}

const changed = new WeakSet();

function change(material, glTF, multipleScattering) {
  if (!material.isMeshPhysicalMaterial || !material.anisotropy || changed.has(material))
    return 0;
  changed.add(material);
  const before = material.onBeforeCompile, key = material.customProgramCacheKey;
  material.onBeforeCompile = function (shader, renderer) {
    before.call(this, shader, renderer);
    shader.uniforms.burnish_lobe_albedo = { value: albedoTexture };
    shader.uniforms.burnish_ltc = { value: ltcTexture };
    shader.vertexShader = patchedVertex(shader.vertexShader);
    shader.fragmentShader = patchedFragment(shader.fragmentShader, glTF, multipleScattering);
  };
  material.customProgramCacheKey = function () {
    return `${before} ${key.call(this)} burnish @TECHNIQUE@ @SAMPLES@ ${glTF} ${multipleScattering}`;
  };
  material.needsUpdate = true;
  return 1;
}

export function improveAnisotropy(target, { glTF = true, multipleScattering = false } = {}) {
  checkVersion();
  let count = 0;
  const each = material => count += change(material, glTF, multipleScattering);
  for (const one of [target].flat()) {
    if (one.isObject3D)
      one.traverse(object => [object.material ?? []].flat().forEach(each));
    else
      each(one);
  }
  return count;
}
