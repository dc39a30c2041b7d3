// What the three renderers know of a frame, one text for C++ and GLSL: structures of 32-bit scalars and arrays of them, which std430 and
// C++ lay out alike. raster/frame/frame_record.h fills them. Pointers of C++ and places in buffers of a device are not in them.
#ifndef BN_RECORDS_H
#define BN_RECORDS_H

#ifdef __cplusplus
namespace burnish {
#endif

const int kMaxSamples = 16; // a pixel
const int kMaxKeyLights = 8;
const int kLobeSliceSize = 24; // texels along n.v of a table of one lobe's albedo; half as many along the azimuth
const int kTextureSlots = 0    // a material
#define BN_SLOT(slot, at, texture, encoding, power) +1
#include "core/scene/material.def"
    ;

// The sub-pixel grid: x right, y down, from the integer centre pixel of the image.
const int kSubpixel = 256;      // units a pixel
const int kGuardBand = 1 << 22; // |x|, |y| of any snapped vertex stay below this
// Whole triangles stay well inside the band, clipping cuts between that and its edge: so a vertex that one triangle keeps is never cut
// by its neighbour, and both see it at the same place.
const int kWholeBand = kGuardBand / 16 * 15, kCutBand = kGuardBand / 32 * 31;
const int kNeedsClip = -(1 << 30);                             // in place of a snapped x: behind the near plane or out of the guard band
const int kClipPlanes = 5, kMostCorners = 3 + kClipPlanes + 1; // near and guard band; of a clipped triangle, and one to spare
const int kFrontFacing = 1, kClipped = 2;                      // bits of a triangle's info, below its material

#define BN_ALPHA_MODE(name, at) const int kAlpha_##name = at;
#include "core/scene/material.def"

// Traits of techniques (shading/models.def).
const int kTestsHorizon = 1;    // asks of every sample if it lies above the surface's horizon; the others fade
const int kSamplesLobe = 2;     // samples the lobe itself; others are scaled by how its albedo differs from the usual one's
const int kTakesRoundLobes = 4; // takes every lobe for a round one of the same roughness; lights do so then too
const int kReadsBox = 8;        // reads the box-filtered chain of the environment
const int kGgxGrid = 16;        // its grid's slopes are a GGX lobe's; otherwise a Beckmann lobe's
const int kSharesSamples = 32;  // with the fragments of the 2x2 quad: see shared_line.k.h
const int kAutoRound = 64;      // what `auto` takes for materials without a grain
const int kAutoGrain = 128;     // and for the others

const int kRefracts = 256;  // follows light through materials that let it; others draw them opaque
const int kPhongGrid = 512; // its grid is of points of an Ashikhmin-Shirley lobe, as many as there are samples

const int kFrameGramSchmidt = 0, kFrameQuaternion = 1, kFrameNormalOnly = 2, kFrameOff = 3; // FrameDesc::frame_map
const int kReliefInTexture = 0, kReliefOnSurface = 1;                                       // FrameDesc::pom_metric
const int kPhongBlock = 6;                              // of GridSample: 16 floats, four values of four sets each
const int kLeastReliefSteps = 8, kMostReliefSteps = 32; // down to the deepest place: straight from above, and at grazing angles
const int kFresnelSchlick = 0, kFresnelConductor = 1, kFresnelDielectric = 2; // FrameDesc::fresnel

// Traits of lobes (shading/models.def), and what the words of their lines mean.
const int kLobeOfAll = 1;    // the usual one
const int kLobeOfRound = 2;  // in its place, what lights meet on materials without a grain, and where a technique takes round lobes
const int kLobeOfTilted = 4; // in its place, where lobes are tilted
const int kPunctualOnly = 8; // has no albedo: nothing but punctual lights meets it
const int kLies_round = 16, kLies_level = 32, kLies_surface = 64, kLies_thread = 128;
const int kSeparableOfAll = 1024, kSeparableOfTilted = 2048; // in the usual one's place and the tilted one's, where masking is separable
const int kLobeOfPhong = 4096;                               // Ashikhmin and Shirley's, which MaterialRecord::phong_slice is of
const int kNormals_ggx = 256, kNormals_own = 512;
const int kLobeCount = 0
#define BN_LOBE(id, at, type, lies, normals, traits, made_of) +1
#include "shading/models.def"
    ;

const int kMostFacets = 16; // of a material, see MaterialRecord::facet
const int kKeptKnots = 4;   // cosines of the eye, see MaterialRecord::kept

// What a material's textures hold of slopes: nothing; moments of those that a map of tilts or normals has; of those and of the lobe; what
// the frame does not want to see.
const int kNoMoments = 0, kMomentsOfTilt = 1, kMomentsOfAll = 2, kMomentsUnseen = 3;
const float kSlopeScale = 16.0f, kMomentScale = 256.0f; // of means and second moments in texels
const int kAreaWays = 0                                 // of finding the light of area lights
#define BN_AREA_LIGHTS(id, at, name, summary) +1
#include "shading/models.def"
    ;
#define BN_AREA_LIGHTS(id, at, name, summary) const int kAreaWay_##id = at;
#include "shading/models.def"
#define BN_AREA_SHAPE(name, at, least, most, what) const int kArea_##name = at;
#include "core/scene/area_light.def"
const int kMostAreaCorners = 16;
const float kLightPictureSpread = 0.8f; // of a texel of a level of a light's picture: standard deviation, texels of that level
const int kLightPictureTaps = 8;        // in a row, of a fetch from levels

struct ViewRecord { // Renderer's View in plain numbers
    float eye[3], right[3], up[3], forward[3];
    float inv_tan_x, inv_tan_y; // perspective: 1/tan of the half angles; orthographic: 1/half extents
    float znear, inv_depth;     // inv_depth: 1/(far - near), orthographic only
    float zfar;
    int orthographic;
};

struct SamplePattern { // Vulkan's standard sample locations in sub-pixel units (1/256 pixel) from the pixel's top left corner
    int count;
    int x[kMaxSamples], y[kMaxSamples];
    int x16[kMaxSamples], y16[kMaxSamples]; // the same in units of 16, which all of them are multiples of
    int min_x, max_x, min_y, max_y;
};

struct CubeRecord { // 0 levels: there is no such cube
    int size, levels;
    float scale; // of every texel
};

struct KeyLightRecord {                       // an evenly bright ellipse on the sky (KeyLight in shading/bake/environment)
    float direction[3], axis_u[3], axis_v[3]; // unit; half axes, as tangents
    float radiance[3], irradiance[3];         // of the ellipse; on a surface that faces it
};

struct LtcTableRecord { // what shading must know of a table of transformed cosines (shading/bake/ltc/grid.h)
    int root_alpha, basis, over_alpha, inverse, alphas;
    int round_first; // the texel that the table of round lobes begins at
};

// Flags are 0 or 1.
struct FrameRecord {
    ViewRecord view;
    int width, height, msaa;
    int center_x, center_y;        // sub-pixel units; added to a snapped position it counts from the image's top left corner
    float half_width, half_height; // pixels
    SamplePattern pattern;
    CubeRecord specular, irradiance; // without key lights
    CubeRecord whole;                // the environment with them; where there are none, `specular`
    CubeRecord box;                  // box-filtered chain, without them; only for techniques that ask for it
    int key_light_count;
    KeyLightRecord key_lights[kMaxKeyLights];
    int grid_count;                 // samples of filtered importance sampling
    int dfg_size, lobe_albedo_size; // tables of directional albedo
    int light_count;
    int area_light_count; // 0 where the frame wants none of their light
    LtcTableRecord ltc;
    int positions;    // something asks where visible points lie
    int layer_sample; // of a pixel, that its layers are drawn of: kLayerWords of each; -1: none are
    int background, samples, texture_taps;
    int joins_round; // round lobes are drawn by another technique than brushed ones, which go over to it as they become round
#define BN_RECORD_number(id) float id;
#define BN_RECORD_whole(id) int id;
#define BN_RECORD_flag(id) int id;
#define BN_RECORD_choice(id) int id;
#define BN_RECORD_lobe(id) int id;
#define BN_RECORD_angles(id) // with each material's own, in its record
#define BN_RECORD_way(id) int id;
#define BN_PARAMETER(id, kind, option, fallback, least, most, unit, summary, readers) BN_RECORD_##kind(id)
#include "shading/models.def"
    int lobe, lobe_traits;   // of the frame's lobes: its place in shading/models.def
    int override_anisotropy; // by `anisotropy`, the eta of every material
    float anisotropy;
};

#define BN_FIELD_number(name) float name;
#define BN_FIELD_vec2(name) float name[2];
#define BN_FIELD_vec3(name) float name[3];
#define BN_FIELD_vec4(name) float name[4];
#define BN_FIELD_flag(name) int name;

struct LightRecord { // DrawTables' PunctualLight in plain numbers
#define BN_LIGHT_FIELD(kind, name, initial) BN_FIELD_##kind(name)
#include "core/scene/light.def"
};

struct AreaLightRecord { // PlacedAreaLight in plain numbers
#define BN_AREA_FIELD(kind, name, initial) BN_FIELD_##kind(name)
#include "core/scene/area_light.def"
    int shape, corners; // kArea_quad...; how many points
    int picture;        // of its texture, place among the frame's textures; -1: it has none
    float mean[3];      // of the picture
    float points[3 * kMostAreaCorners];
};

struct TextureBinding {
    int texture; // -1: not used
    int uv_set;
    float transform[6]; // u' = t0 u + t2 v + t4, v' = t1 u + t3 v + t5
};

struct MaterialRecord { // Material in plain numbers, and what follows from them; emissive: times its strength
#define BN_FACTOR(kind, name, fallback, path, least, most) BN_FIELD_##kind(name)
#define BN_FLAG(kind, name, path) BN_FIELD_flag(name)
#define BN_CHOICE(type, name, words, path) int name; // kAlpha_opaque...
#include "core/scene/material.def"
    float dielectric_f0[3], dielectric_f90; // from ior and specular
    float grain[2];                         // cosine and sine of anisotropy_rotation
    int textured, uses_color, anisotropic;
    int tilted;                      // against its surface: of tilt and the frame's
    float tilt_cos[2], tilt_sin[2];  // of their sum
    float tilt_slope[2];             // its mean slopes, along tangent and bitangent
    int tilt_mapped, moments;        // a texture has slopes; kNoMoments...
    float level_gain;                // of a mip filter's levels: what normals of taps differ by, times this, widens lobes; else -1
    int relief;                      // the alpha of its normal map holds heights, which the frame wants to see
    float relief_depth;              // of height 0, lengths of texture coordinates
    int emitter;                     // of core/scene's Material: whether it shows an area light
    int conductor;                   // it has an index of its own: conductor_eta, conductor_k
    int roughness_fixed;             // by an override: the texture gives metalness only
    int technique, technique_traits; // its place in shading/models.def; of what is unlit no traits
    int refracts;                    // it lets light through, and its technique follows that
    int coated;                      // it has a clear coat, here or there
    int lights_lobe;                 // what punctual lights meet: its place in shading/models.def
    float brushed;          // brushed_part() of its factors where the technique shares samples; else, or where slopes widen lobes, 1
    int albedo_slice;       // of a lobe whose two widths are everywhere the same: its first pair; else -1
    int phong_slice;        // of the Ashikhmin-Shirley lobe of these widths, where the technique samples it or it is compensated; else -1
    int frame_map;          // the frame's, or where its textures hold a mip filter's lobes kFrameQuaternion, which they are made for
    int phong_set;          // of the same lobe's half vectors: the first sample of its own grid; -1: made by fragment
    int keeps;              // alpha of its normal map's levels is the share of light that facets keep, see bake/mip/kept_light.h
    float kept[kKeptKnots]; // loss of light by the eye's cosine .1, .4, .7, 1 as multiples of what levels hold
    int facets;             // groups of normals that its surface is made of from afar, see bake/mip/facets.h
    float facets_from;      // share of light that facets lose there
    float facet[4 * kMostFacets];  // x, y, weight, spread of each
    float facets_kept[kKeptKnots]; // share of light that the map keeps, over what its groups keep; by the eye's cosine as `kept`
    float groups_kept[kKeptKnots]; // share that its groups keep
    TextureBinding textures[kTextureSlots];
};

#ifdef __cplusplus
}
#endif

#endif
