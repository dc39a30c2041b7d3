// Records that all three renderers read: the frame, its lights and materials. One text for C++ and GLSL: structs and arrays
// with 32-bit scalars, which std430 and C++ lay out alike. raster/frame/frame_record.h fills them. They hold neither C++
// pointers nor places in device buffers.
#ifndef BN_RECORDS_H
#define BN_RECORDS_H

#ifdef __cplusplus
namespace burnish {
#endif

const int kMaxSamples = 16; // samples per pixel
const int kMaxExtractedLights = 8;
const int kLobeSliceSize = 24; // texels along n.v in one lobe's albedo table; half as many along the azimuth
const int kTextureSlots = 0    // per material
#define BN_SLOT(slot, at, texture, encoding, power) +1
#include "core/scene/material.def"
    ;

// The sub-pixel grid: x right, y down, origin at the image's integer centre pixel.
const int kSubpixel = 256;      // units per pixel
const int kGuardBand = 1 << 22; // any snapped vertex's bound on |x|, |y|
// Unclipped triangles stay inside kWholeBand; clipping cuts at kCutBand, between kWholeBand and the guard band's edge. So
// no triangle cuts a vertex that its neighbour keeps, and both see the vertex at one place.
const int kWholeBand = kGuardBand / 16 * 15, kCutBand = kGuardBand / 32 * 31;
const int kNeedsClip = -(1 << 30);                             // replaces a snapped x: behind the near plane or outside the guard band
const int kClipPlanes = 5, kMostCorners = 3 + kClipPlanes + 1; // near plane and guard band; a clipped triangle's corners, and one spare
const int kFrontFacing = 1, kClipped = 2;                      // bits in a triangle's info, below its material

#define BN_ALPHA_MODE(name, at) const int kAlpha_##name = at;
#include "core/scene/material.def"

// Technique traits (shading/models.def).
const int kTestsHorizon = 1;    // tests every sample against the surface's horizon; other techniques fade
const int kSamplesLobe = 2;     // samples the lobe itself; other techniques are scaled by its albedo over the default lobe's
const int kTakesRoundLobes = 4; // treats every lobe as round with the same roughness; lights then do so too
const int kReadsBox = 8;        // reads the environment's box-filtered mip chain
const int kGgxGrid = 16;        // its grid holds GGX slopes; otherwise Beckmann slopes
const int kSharesSamples = 32;  // shares samples with the pixels around, see shared_samples.k.h
const int kAutomatic = 64;      // `auto` takes this technique
const int kRoundAlone = 128;    // shares no samples on materials without anisotropy

const int kSamplesInterface = 256; // samples both sides of transmissive surfaces; others fetch transmitted light once
const int kPhongGrid = 512;        // its grid holds an Ashikhmin-Shirley lobe's half vectors, as many as samples

const int kFrameGramSchmidt = 0, kFrameQuaternion = 1, kFrameNormalOnly = 2, kFrameOff = 3; // FrameDesc::frame_map
const int kParallaxInTexture = 0, kParallaxOnSurface = 1;                                   // FrameDesc::pom_metric
const int kPhongBlock = 6; // GridSamples in a block: 16 floats, four values for each of four sets, with padding
const int kLeastParallaxSteps = 8, kMostParallaxSteps = 32; // steps to the deepest place: seen from straight above, and at grazing angles
const int kFresnelSchlick = 0, kFresnelConductor = 1, kFresnelDielectric = 2; // FrameDesc::fresnel

// Lobe traits (shading/models.def), and the words in the lobes' lines.
const int kDefaultLobe = 1;  // the default lobe
const int kRoundLobe = 2;    // replaces it for lights, on materials without a grain and where a technique treats lobes as round
const int kTiltedLobe = 4;   // replaces the default lobe where lobes are tilted
const int kPunctualOnly = 8; // has no albedo: only punctual lights use it
const int kLies_round = 16, kLies_level = 32, kLies_surface = 64, kLies_thread = 128;
const int kSeparableLobe = 1024, kSeparableTiltedLobe = 2048; // replace the default and the tilted lobe under separable masking
const int kPhongLobe = 4096;                                  // the Ashikhmin-Shirley lobe, see MaterialRecord::phong_slice
const int kBroadLobe = 8192; // covers the hemisphere, and leans away from the mirror direction: lights/broad.t.h
const int kNormals_ggx = 256, kNormals_own = 512;
const int kLobeCount = 0
#define BN_LOBE(id, at, type, lies, normals, traits, made_of) +1
#include "shading/models.def"
    ;
#define BN_LOBE(id, at, type, lies, normals, traits, made_of) const int kLobe_##id = at;
#include "shading/models.def"

const int kCoatings = 0 // layers above a material's own lobe
#define BN_COATING(id, at, strength, lobe) +1
#include "shading/coatings.def"
    ;
#define BN_COATING(id, at, strength, lobe) const int kCoating_##id = at;
#include "shading/coatings.def"

const int kMostFacets = 32; // per material, see MaterialRecord::facet
const int kKeptKnots = 4;   // view cosines, see MaterialRecord::kept

// Slope moments in a material's textures: none; a tilt or normal map's moments alone; the map's and the lobe's moments;
// moments that the frame ignores.
const int kNoMoments = 0, kMomentsOfTilt = 1, kMomentsOfAll = 2, kMomentsUnseen = 3;
const float kSlopeScale = 16.0f, kMomentScale = 256.0f; // factors on means and on second moments in texels
const int kAreaWays = 0                                 // methods for area lights
#define BN_AREA_LIGHTS(id, at, name, summary) +1
#include "shading/models.def"
    ;
#define BN_AREA_LIGHTS(id, at, name, summary) const int kAreaWay_##id = at;
#include "shading/models.def"
#define BN_AREA_SHAPE(name, at, least, most, what) const int kArea_##name = at;
#include "core/scene/area_light.def"
const int kMostAreaCorners = 16;
const float kLightPictureSpread = 0.8f; // blur in each level of a light's picture: standard deviation, in that level's texels
const int kLightPictureTaps = 8;        // taps along one fetch's footprint in the levels

struct ViewRecord { // the renderer's View as plain numbers
    float eye[3], right[3], up[3], forward[3];
    float inv_tan_x, inv_tan_y; // perspective: 1/tan of the half angles; orthographic: 1/half extents
    float znear, inv_depth;     // inv_depth: 1/(far - near), orthographic only
    float zfar;
    int orthographic;
};

struct SamplePattern { // Vulkan's standard sample locations in sub-pixel units (1/256 pixel) from the pixel's top left corner
    int count;
    int x[kMaxSamples], y[kMaxSamples];
    int x16[kMaxSamples], y16[kMaxSamples]; // the same locations in 1/16 pixel; all are multiples of that
    int min_x, max_x, min_y, max_y;
};

struct CubeRecord { // 0 levels: no cube
    int size, levels;
    float scale; // factor on every texel
};

struct ExtractedLightRecord {                 // an evenly bright ellipse on the sky (ExtractedLight in shading/bake/environment)
    float direction[3], axis_u[3], axis_v[3]; // unit direction; half axes, as tangents
    float radiance[3], irradiance[3];         // the ellipse's radiance; irradiance on a surface that faces the ellipse
};

struct LtcTableRecord { // an LTC table's layout (shading/bake/ltc/grid.h)
    int root_alpha, basis, over_alpha, inverse, alphas;
    int round_first; // the first texel in the table for round lobes
};

// The frame. Flags are 0 or 1.
struct FrameRecord {
    ViewRecord view;
    int width, height, msaa;
    int center_x, center_y;        // sub-pixel units; snapped position + center counts from the image's top left corner
    float half_width, half_height; // half the picture, pixels
    int left, top, picture_width;  // the image's first pixel in the picture, 0 unless it is a window of the picture; the picture's width
    float middle_x, middle_y;      // where snapped positions are 0, from -1 to 1 over the picture, y down; 0 up to kMaxPictureSide
    SamplePattern pattern;
    CubeRecord specular, irradiance; // without extracted lights
    CubeRecord whole;                // the environment with extracted lights; equals `specular` where there are none
    CubeRecord box;                  // box-filtered mip chain without extracted lights; only for techniques that read it
    int extracted_light_count;
    ExtractedLightRecord extracted_lights[kMaxExtractedLights];
    int grid_count;                 // samples in the grid
    int dfg_size, lobe_albedo_size; // the directional albedo tables' sizes
    int light_count;
    int area_light_count; // 0 where the frame ignores area lights
    LtcTableRecord ltc;
    int positions;    // something reads the visible points' positions
    int layer_sample; // the pixel sample that layers are drawn from; -1: no layers
    int background, texture_taps;
    int behind; // texture of what lies behind transmissive bodies, its inverse depths are the next one; -1: none
#define BN_RECORD_number(id) float id;
#define BN_RECORD_whole(id) int id;
#define BN_RECORD_flag(id) int id;
#define BN_RECORD_choice(id) int id;
#define BN_RECORD_lobe(id) int id;
#define BN_RECORD_angles(id) // none: derived values are in MaterialRecord
#define BN_RECORD_way(id) int id;
#define BN_PARAMETER(id, kind, option, fallback, least, most, unit, summary, readers) BN_RECORD_##kind(id)
#include "shading/models.def"
    int lobe, lobe_traits;   // the frame's lobe: its index in shading/models.def and its traits
    int override_anisotropy; // `anisotropy` replaces every material's eta
    float anisotropy;
};

#define BN_FIELD_number(name) float name;
#define BN_FIELD_vec2(name) float name[2];
#define BN_FIELD_vec3(name) float name[3];
#define BN_FIELD_vec4(name) float name[4];
#define BN_FIELD_flag(name) int name;

struct LightRecord { // DrawTables' PunctualLight as plain numbers
#define BN_LIGHT_FIELD(kind, name, initial) BN_FIELD_##kind(name)
#include "core/scene/light.def"
};

struct AreaLightRecord { // PlacedAreaLight as plain numbers
#define BN_AREA_FIELD(kind, name, initial) BN_FIELD_##kind(name)
#include "core/scene/area_light.def"
    int shape, corners; // kArea_quad...; number of points
    int picture;        // index of its picture among the frame's textures; -1: none
    float mean[3];      // the picture's mean colour
    float points[3 * kMostAreaCorners];
};

struct TextureBinding {
    int texture; // -1: unused
    int uv_set;
    float transform[6]; // u' = t0 u + t2 v + t4, v' = t1 u + t3 v + t5
};

struct MaterialRecord { // Material as plain numbers, with derived values; emissive includes emissive strength
#define BN_FACTOR(kind, name, fallback, path, least, most) BN_FIELD_##kind(name)
#define BN_FLAG(kind, name, path) BN_FIELD_flag(name)
#define BN_CHOICE(type, name, words, path) int name; // kAlpha_opaque...
#include "core/scene/material.def"
    float dielectric_f0[3], dielectric_f90; // derived from ior and specular
    float clearcoat_f0;                     // derived from clearcoat_ior
    float grain[2];                         // anisotropy_rotation's cosine and sine
    int textured, uses_color, anisotropic;
    int tilted;                      // the lobe tilts against its surface, by the material's tilt or the frame's
    float tilt_cos[2], tilt_sin[2];  // for the summed tilt angles
    float tilt_slope[2];             // the summed tilt's mean slopes, along tangent and bitangent
    int tilt_mapped, moments;        // a texture holds slopes; kNoMoments...
    float level_gain;                // how much the normals' spread between taps widens lobes, by mip filter; -1: unfiltered
    int coat_spread;                 // the alpha in the coat's normal map widens the coat's lobe
    int parallax;                    // the normal map's alpha holds heights, and the frame uses them
    float parallax_depth;            // depth at height 0, in texture-coordinate lengths
    int emitter;                     // as in core/scene's Material: the area light that it shows, if any
    int conductor;                   // has its own complex index: conductor_eta, conductor_k
    int roughness_fixed;             // by an override: the texture gives metalness only
    int technique, technique_traits; // technique index in shading/models.def; no traits for unlit materials
    int samples;                     // of the technique; techniques on a grid read grid_count
    int refracts;                    // transmits light
    int film;                        // lies under a thin film in some place
    int thin;                        // an open mesh: light passes a pane without thickness
    float body_extent;               // metres through the body, along the normal; 0: thin
    float body_roundness;            // of the body: 0 a plate, 1 a ball
    float body_decay[3];             // log2 of the light's share left after a metre inside
    int hidden;                      // left out of the frame
    int coatings;                    // bit i: has coating i of shading/coatings.def in some place
    int lights_lobe;                 // the lobe for punctual lights, an index in shading/models.def
    float anisotropy_blend; // anisotropy_blend_of() of its factors where lobe_line's albedo fades; 1 elsewhere and where slopes widen
                            // lobes
    int albedo_slice;       // the albedo slice's first pair for a lobe with constant widths; else -1
    int phong_slice; // the same for the Ashikhmin-Shirley lobe, where the technique samples this lobe or the frame compensates it; else -1
    int frame_map;   // the frame's; kFrameQuaternion where textures hold a mip filter's lobes, which are made for it
    int phong_set;   // the first sample in the grid for this lobe's half vectors; -1: each fragment computes its own
    int keeps;       // the alpha of normal-map levels is the share of light that facets keep, see bake/mip/kept_light.h
    float kept[kKeptKnots];        // light loss at view cosines .1, .4, .7, 1, as multiples of the levels' value
    int facets;                    // normal groups that replace the map from afar, see bake/mip/facets.h
    float facets_from;             // light share that facets lose there
    float facet[4 * kMostFacets];  // x, y, weight, spread of each
    float facets_kept[kKeptKnots]; // light share that the map keeps over the share that its groups keep, by view cosine as `kept`
    float groups_kept[kKeptKnots]; // light share that its groups keep
    TextureBinding textures[kTextureSlots];
};

#ifdef __cplusplus
}
#endif

#endif
