// Every renderer's input and output: one frame description, one picture. The renderers meet here and nowhere else.
// Pixel (0,0) is the top left one. Pixel centres are at .5. Clip space is Vulkan's with reversed depth (1 near, 0 far).
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/column.h"
#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/image/colour.h"
#include "core/image/image.h"
#include "core/jobs/jobs.h"
#include "core/scene/draw_tables.h"
#include "core/scene/scene.h"
#include "core/simd/dispatch.h"
#include "raster/frame/profile.h"
#include "shading/bake/environment/environment.h"
#include "shading/lang/recorded.h"

namespace burnish {

struct View {                                                            // a resolved camera
    glm::vec3 eye{0.0f}, right{1, 0, 0}, up{0, 1, 0}, forward{0, 0, -1}; // orthonormal, world space
    bool orthographic = false;
    float tan_half_x = 1.0f, tan_half_y = 1.0f; // for the half angles; orthographic: half extents in metres
    float znear = 0.01f;                        // metres; the far plane is at infinity (perspective)
    float zfar = 0.0f;                          // orthographic only
};

// Returns the view through a scene camera, which must have a node. The image's aspect ratio decides the horizontal field of view. Errors:
// ExitCode::usage if no camera has this index.
Result<View> make_view(const Scene& scene, int camera, int width, int height);
View make_view(const glm::vec3& eye, const glm::vec3& target, float fov_y_rad, int width, int height);
struct Framing {                       // the default view's direction: three quarters, so that a cube shows three faces
    float azimuth_rad = 0.61086524f;   // direction to the eye, from +Z towards +X
    float elevation_rad = 0.48869219f; // above the horizon
    float fov_y_rad = 0.78539816f;     // vertical field of view
    std::optional<glm::vec3> target;   // the picture's centre; if empty, the scene's outline is centred
};
// Returns the view from the nearest place in this direction that shows the whole scene with a margin.
View auto_frame(const DrawTables& tables, int width, int height, const Framing& framing);
View auto_frame(const DrawTables& tables, int width, int height); // fixed view for tests and benchmarks: more from the front
// Returns the view's matrix from world to Vulkan clip space, for printing.
glm::mat4 clip_from_world(const View& view);

inline constexpr int kMaxPictureSide = 16384; // pixels
inline constexpr int kMaxSampleBits = 28 - kLessBits;
inline constexpr std::int64_t kMaxPictureSamples = 1ll << kMaxSampleBits; // width * height * msaa: 2 GiB for depth and triangle ids

// The picture window that a frame draws. Pixels have the bits that they have where a frame draws the whole picture.
struct PictureWindow {
    int picture_width = 0, picture_height = 0; // pixels, at most kMaxWindowedSide; 0: the frame is the whole picture
    int left = 0, top = 0;                     // the frame's first pixel in the picture, multiples of kWindowStep
};
inline constexpr int kMaxWindowedSide = 65536, kWindowStep = 8; // pixels
// A picture with a longer side than kMaxPictureSide consists of cells. Snapped positions count from a cell's middle, so a window
// reaches beyond one cell by kWindowStep at most.
inline constexpr int kWindowCell = 16384; // pixels
int window_cell(int first, int size);     // for a window's side

struct MaterialTechnique { // of one material
    std::string technique = "auto";
    int samples = 16; // for techniques that take samples
};

struct FrameDesc {
    int width = 1280, height = 720;
    int msaa = 8; // 1, 2, 4, 8, 16
    View view;    // for the whole picture
    PictureWindow window;
    std::string technique = "auto";
    int samples = 16; // for techniques that take samples; `burnish render` takes TechniqueInfo::default_samples
    // The scene materials' techniques and samples, by index, in place of the two fields above; empty: those for all. A technique that
    // reads the box-filtered environment cannot be one of them.
    std::vector<MaterialTechnique> by_material;
    // Technique options (shading/models.def). raster/frame/choices.h names the numbers in fields that choose.
#define BN_DESC_number(id, fallback) float id = static_cast<float>(fallback);
#define BN_DESC_whole(id, fallback) std::uint32_t id = fallback;
#define BN_DESC_flag(id, fallback) bool id = (fallback) != 0;
#define BN_DESC_choice(id, fallback) int id = fallback;
#define BN_DESC_lobe(id, fallback) int id = fallback;
#define BN_DESC_way(id, fallback) int id = fallback;
#define BN_DESC_angles(id, fallback) glm::vec2 id##_rad{glm::radians(static_cast<float>(fallback))};
#define BN_PARAMETER(id, kind, option, fallback, least, most, unit, summary, readers) BN_DESC_##kind(id, fallback)
#include "shading/models.def"
    float roughness = -1.0f; // >= 0: every material's roughness
    float anisotropy = 0.0f; // every material's eta, [-1, 1], if override_anisotropy is set
    bool override_anisotropy = false;
    int tile_size = 64;          // 32 or 64; never changes the picture
    int texture_anisotropy = 16; // most taps along the major axis, 1..16
    bool lamps = true;           // light by punctual lights and extracted lights; area_way decides on area lights
    bool background = true;      // draw the environment behind the scene; otherwise black
    bool opaque_only = false;    // leave out surfaces that blend or transmit light, and open area lights
    bool triangle_ids = false;   // fill Frame::triangle_ids
    bool profile = false;        // fill Frame::profile if the renderer can; never changes the picture
    bool stages = false;         // fill Frame::stages and Frame::triangle_ids
    bool layers = false;         // fill Frame::layers; never changes the picture
    bool parts = false;          // fill Frame::parts; never changes the picture
};
// Checks that a rasterizer can draw the description: sizes, samples, names.
Status check_desc(const FrameDesc& desc);
// Returns the picture's size. The frame shows this picture, or its window.
inline int picture_width(const FrameDesc& desc)
{
    return desc.window.picture_width > 0 ? desc.window.picture_width : desc.width;
}
inline int picture_height(const FrameDesc& desc)
{
    return desc.window.picture_width > 0 ? desc.window.picture_height : desc.height;
}

struct SamplingStats {                // for renderers that integrate by random samples
    std::uint64_t samples = 0;        // per pixel
    std::uint64_t samples_before = 0; // among `samples`, from a checkpoint
    bool resumed = false;             // a checkpoint was found
    bool stopped = false;             // the caller asked to end before all samples were taken
    double relative_error = 0.0;      // the 95 % confidence interval's half width, relative to the mean, averaged over pixels
    double million_samples_per_second = 0.0;
    std::uint64_t rays = 0;
    double ray_share = 0.0; // the workers' time share for tracing rays
};

struct FrameStats {
    std::uint64_t triangles = 0;                 // in the scene
    std::uint64_t triangles_drawn = 0;           // after culling and clipping
    std::uint64_t visible_fragments = 0;         // (pixel, triangle) pairs shaded
    std::uint64_t background_pixels = 0;         // pixels with at least one uncovered sample
    bool samples_emulated = false;               // one pass per sample, because the device lacks this sample count
    bool depth_interpolated = false;             // depth comes from the device, not from the tile renderer's formula
    double ms = 0.0;                             // the frame's wall time
    double device_ms = 0.0, device_cpu_ms = 0.0; // from submission to the device's fence: wall and process time
    SamplingStats sampling;
};

// A frame's intermediate values, for comparisons word by word. Floats are stored as their bits.
struct StageRecords {
    Column<std::uint32_t> vertices; // [vertex][kVertexWords]: clip x, y, w, z; snapped x, y, 1/256 pixel; 1/w; depth
    Column<std::uint32_t> depths;   // [pixel][sample]
    // [pixel][sample][kPairWords] (shading/lang/recorded.h), at each visible (pixel, triangle) pair's first sample: sample mask,
    // interpolants, material inputs, colour. All 0 elsewhere. A background pair sets only mask and colour.
    Column<std::uint32_t> pairs;
};
inline constexpr int kVertexWords = 8;

// The surface's layers at a pixel's central sample, the nearest to its centre (central_sample()). All 0 if the sample shows no triangle.
// Values come from the (pixel, triangle) pair, at the point where the pair is shaded. A blended surface counts if its alpha exceeds a
// half.
template <int words> struct LayerValue {
    using value = float[words];
};
template <> struct LayerValue<1> {
    using value = float;
};
struct PixelLayers {
#define BN_LAYER(type, words, name, channels) LayerValue<words>::value name;
#include "shading/layers.def"
};
static_assert(sizeof(PixelLayers) == kLayerWords * sizeof(float));

struct Frame {
    Image color;                        // f32 RGB, linear Rec.709 scene radiance
    Image variance;                     // variance of `color` as an estimate, per channel; empty if `color` is not an estimate
    Column<std::uint32_t> triangle_ids; // [pixel][sample] the visible solid triangle's global id, else kNoTriangle
    Column<float> through;        // [pixel][sample] blended surfaces' transmittance, [0,1]; with triangle_ids; empty if nothing blends
    FrameProfile profile;         // empty unless asked for
    StageRecords stages;          // with FrameDesc::stages
    Column<PixelLayers> layers;   // [pixel], with FrameDesc::layers
    std::vector<PixelPart> parts; // with FrameDesc::parts: for pixels with more than one part, by pixel, then by first sample
    FrameStats stats;
};

// A scene prepared for one renderer. A renderer is made once and draws many frames.
class Renderer {
  public:
    virtual ~Renderer() = default;
    Result<Frame> render(const FrameDesc& desc) { return render(desc, Frame{}); }
    // recycled: an old frame whose memory may be reused.
    virtual Result<Frame> render(const FrameDesc& desc, Frame recycled) = 0;
    virtual std::string device() const = 0; // the device's name: "AMD EPYC (avx512)", ...
};

namespace ltc {
struct ShadingTables;
}
class PhongFiles;
struct SceneMips;    // shading/bake/mip/settings.h
struct PyramidCache; // raster/frame/pyramids.h
extern const SceneMips kBoxMips;

// Everything that a renderer needs. The references must outlive the renderer.
struct RenderInput {
    const Scene& scene;
    const DrawTables& tables;
    const Environment& environment;
    const DfgTable& dfg;
    const Jobs& jobs;
    const ltc::ShadingTables* ltc = nullptr; // for area lights; none: ltc::shipped_tables()
    const PhongFiles* phong = nullptr;       // for as_mc's lobes; none: frames make their own
    const SceneMips& mips = kBoxMips;        // how levels for the scene's maps are made
    PyramidCache* pyramids = nullptr;        // texture pyramids from an earlier renderer for the same scene, and from this one
};

enum class Sampling { none, count, grid }; // FrameDesc::samples' meaning for a technique: unused, N samples, n x n samples

struct TechniqueInfo {
    const char* name;
    const char* summary;
    Sampling sampling;
    int default_samples, most_samples;
    int traits; // summed traits from shading/lang/records.h
};
const std::vector<TechniqueInfo>& techniques();               // from shading/models.def
const TechniqueInfo* find_technique(const std::string& name); // accepts automatic_technique() too; null if unknown
const TechniqueInfo& automatic_technique();                   // "auto": stands for chosen_technique()
const TechniqueInfo& chosen_technique();                      // among techniques()
const TechniqueInfo& technique_of(const FrameDesc& desc);     // resolves "auto"
const TechniqueInfo& technique_of(const FrameDesc& desc, std::size_t material);
int samples_of(const FrameDesc& desc, std::size_t material);        // its technique's
int traits_for(const TechniqueInfo& technique, bool anisotropic);   // traits on a material with or without anisotropy
int effective_samples(const TechniqueInfo& technique, int samples); // from the requested `samples`

struct ParameterInfo {            // a technique parameter
    const char* name;             // the field of FrameDesc; angles lack the suffix _rad
    const char* option;           // "axis-k"; reports write it as axis_k
    double fallback, least, most; // angles in degrees
    const char* unit;             // a choice lists its names here
    const char* summary;
    const char* readers;      // techniques that read it, and "reference", as in shading/models.def
    float FrameDesc::*number; // exactly one of these members is not null
    std::uint32_t FrameDesc::*whole;
    bool FrameDesc::*flag;
    int FrameDesc::*choice;
    glm::vec2 FrameDesc::*angles;
    std::string_view kind; // as in shading/models.def
};
const std::vector<ParameterInfo>& parameters();                                 // from shading/models.def
bool reads(const std::string& technique, const ParameterInfo& parameter);       // true if a technique, or "reference", reads it
glm::dvec2 parameter_of(const FrameDesc& desc, const ParameterInfo& parameter); // angles: both, in degrees; else the value twice
std::vector<std::string> choices_of(const ParameterInfo& parameter);            // names by number; empty unless a choice
// Sets a number, a choice by its place, or both angles, degrees. Errors: ExitCode::usage outside [least, most], with the field.
Status set_parameter(FrameDesc& desc, const ParameterInfo& parameter, double value);
// Sets a parameter by its option's name and a text: set_parameter(desc, "brdf", "beckmann"), "tilt" to "10,0" (degrees), flags to "true".
// Errors: ExitCode::usage with the field, or with an unknown name as place.
Status set_parameter(FrameDesc& desc, const std::string& name, const std::string& value);

struct AreaWayInfo { // a method for area lights
    const char* name;
    const char* summary;
};
const std::vector<AreaWayInfo>& area_ways(); // from shading/models.def, in order

struct ModelInfo {
    const char* name;
    const char* summary;
    int lobe, lobe_traits; // its lobe's index and traits (shading/lang/records.h); -1 if it cannot lie on a surface
};
const std::vector<ModelInfo>& models(); // from shading/models.def
const ModelInfo& lobe_model(int lobe);  // by lobe index
// Returns the frame's lobe: the chosen brdf, or its substitute if lobes are tilted or use separable masking.
int lobe_of(const FrameDesc& desc, bool tilted);
Status check_lobe(const FrameDesc& desc, const TechniqueInfo& technique); // checks that the technique takes the lobe; part of check_desc()

// Returns a 64-bit hash over the size and every colour word's bits. Equal pictures have equal hashes on every machine.
std::uint64_t pixel_hash(const Image& image);
std::uint64_t count_not_finite(const Image& image); // counts pixels with a NaN or Inf channel; an empty image has none
// Returns a frame as RGBA. The frame must be drawn with triangle_ids and without background. Alpha is a pixel's mean coverage over its
// samples (1 under a solid triangle, 1 - through elsewhere). Colours are associated (multiplied by alpha), as in `color`. through:
// Frame::through, may be empty.
Image with_coverage(const Image& color, const Column<std::uint32_t>& triangle_ids, const Column<float>& through);

} // namespace burnish
