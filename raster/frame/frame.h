// What every renderer takes and gives: one frame description, one picture. The renderers meet here and nowhere else.
// Pixel (0,0) is the top left one; pixel centres are at .5; clip space is Vulkan's with reversed depth (1 near, 0 far).
#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/column.h"
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
    float tan_half_x = 1.0f, tan_half_y = 1.0f; // perspective; orthographic: half extents in metres
    float znear = 0.01f;                        // metres; the far plane is at infinity (perspective)
    float zfar = 0.0f;                          // orthographic only
};

// The image's aspect ratio decides the horizontal field of view.
// Returns the view of a camera of the scene, which has a node. Errors: ExitCode::usage where no camera has this index.
Result<View> make_view(const Scene& scene, int camera, int width, int height);
View make_view(const glm::vec3& eye, const glm::vec3& target, float fov_y_rad, int width, int height);
struct Framing {                       // how the whole scene is looked at: three quarters, so that a cube shows three faces
    float azimuth_rad = 0.61086524f;   // of the eye: from +Z towards +X
    float elevation_rad = 0.48869219f; // above the horizon
    float fov_y_rad = 0.78539816f;     // vertical field of view
    std::optional<glm::vec3> target;   // in the middle of the picture; without it the scene's outline is
};
// From the nearest place in that direction that has all of the scene in the picture, with a margin.
View auto_frame(const DrawTables& tables, int width, int height, const Framing& framing);
View auto_frame(const DrawTables& tables, int width, int height); // of tests and benchmarks, which keep their pictures: more from the front
// The matrix that the view stands for, for printing (world to Vulkan clip space).
glm::mat4 clip_from_world(const View& view);

inline constexpr int kMaxPictureSide = 16384;                 // pixels
inline constexpr std::int64_t kMaxPictureSamples = 1ll << 28; // width * height * msaa: 2 GiB of depth and triangle ids

struct FrameDesc {
    int width = 1280, height = 720;
    int msaa = 8; // 1, 2, 4, 8, 16
    View view;
    std::string technique = "auto";
    int samples = 16; // for techniques that take samples
#define BN_DESC_number(id, fallback) float id = static_cast<float>(fallback);
#define BN_DESC_whole(id, fallback) std::uint32_t id = fallback;
#define BN_DESC_flag(id, fallback) bool id = (fallback) != 0;
#define BN_DESC_choice(id, fallback) int id = fallback;
#define BN_DESC_lobe(id, fallback) int id = fallback;
#define BN_DESC_way(id, fallback) int id = fallback;
#define BN_DESC_angles(id, fallback) glm::vec2 id##_rad{glm::radians(static_cast<float>(fallback))};
#define BN_PARAMETER(id, kind, option, fallback, least, most, unit, summary, readers) BN_DESC_##kind(id, fallback)
#include "shading/models.def"
    float roughness = -1.0f; // >= 0: alpha_lin of every material
    float anisotropy = 0.0f; // with override_anisotropy: eta of every material, [-1, 1]
    bool override_anisotropy = false;
    int tile_size = 64;          // 32 or 64; never changes the picture
    int texture_anisotropy = 16; // taps along the major axis at most, 1..16
    bool background = true;      // environment behind the scene; otherwise black
    bool triangle_ids = false;   // fill Frame::triangle_ids
    bool profile = false;        // fill Frame::profile, where the renderer can; never changes the picture
    bool stages = false;         // fill Frame::stages, and the triangle ids
    bool layers = false;         // fill Frame::layers; never changes the picture
    bool parts = false;          // fill Frame::parts; never changes the picture
};
// Whether a rasterizer can draw it: sizes, samples, names.
Status check_desc(const FrameDesc& desc);

struct SamplingStats {                // of a renderer that integrates by random samples
    std::uint64_t samples = 0;        // a pixel
    std::uint64_t samples_before = 0; // of them, taken from a checkpoint
    bool resumed = false;             // there was a checkpoint
    bool stopped = false;             // asked to end before all samples were taken
    double relative_error = 0.0;      // half width of the 95 % confidence interval over the mean, averaged over the pixels
    double million_samples_per_second = 0.0;
    std::uint64_t rays = 0;
    double ray_share = 0.0; // of the workers' time, spent in tracing rays
};

struct FrameStats {
    std::uint64_t triangles = 0;                 // of the scene
    std::uint64_t triangles_drawn = 0;           // after culling and clipping
    std::uint64_t visible_fragments = 0;         // (pixel, triangle) pairs shaded
    std::uint64_t background_pixels = 0;         // pixels with at least one uncovered sample
    bool samples_emulated = false;               // one pass a sample, as the device cannot take as many at once
    bool depth_interpolated = false;             // by the device, not by the tile renderer's formula
    double ms = 0.0;                             // wall time of the frame
    double device_ms = 0.0, device_cpu_ms = 0.0; // of a device: from submission to its fence, wall and process time
    SamplingStats sampling;
};

// What a frame went through, for comparisons word by word. Words of floats are their bits.
struct StageRecords {
    Column<std::uint32_t> vertices; // [vertex][kVertexWords]: clip x, y, w, z; snapped x, y, 1/256 pixel; 1/w; depth
    Column<std::uint32_t> depths;   // [pixel][sample]
    // [pixel][sample][kPairWords] (shading/lang/recorded.h), at the first sample of each visible (pixel, triangle) pair: mask of its
    // samples, interpolants, material inputs, colour; all 0 elsewhere. Of a background pair only mask and colour are set.
    Column<std::uint32_t> pairs;
};
inline constexpr int kVertexWords = 8;

// Of what a pixel shows at its central sample, the nearest to its centre (central_sample()); all 0 where that shows no triangle. Values are
// those of the (pixel, triangle) pair, where it is shaded. A blended surface counts where its alpha is above a half.
struct PixelLayers {
#define BN_LAYER(type, words, name, channels) float name[words];
#include "shading/layers.def"
};
static_assert(sizeof(PixelLayers) == kLayerWords * sizeof(float));

struct Frame {
    Image color;                        // f32 RGB, linear Rec.709 scene radiance
    Image variance;                     // of `color` as an estimate, by channel; empty where it is none
    Column<std::uint32_t> triangle_ids; // [pixel][sample] global id of the solid triangle seen, kNoTriangle where there is none
    Column<float> through; // [pixel][sample] light that blended surfaces let through, [0,1]; with triangle_ids, empty if nothing blends
    FrameProfile profile;  // empty unless asked for
    StageRecords stages;   // with FrameDesc::stages
    Column<PixelLayers> layers;   // [pixel], with FrameDesc::layers
    std::vector<PixelPart> parts; // with FrameDesc::parts: of all pixels that show more than one thing, by pixel, then by first sample
    FrameStats stats;
};

// A scene made ready for one renderer. Renderers are made once and draw many frames.
class Renderer {
  public:
    virtual ~Renderer() = default;
    Result<Frame> render(const FrameDesc& desc) { return render(desc, Frame{}); }
    // recycled: a frame that is not needed any more, whose memory may be used again.
    virtual Result<Frame> render(const FrameDesc& desc, Frame recycled) = 0;
    virtual std::string device() const = 0; // what runs it: "AMD EPYC (avx512)", ...
};

namespace ltc {
struct ShadingTables;
}
class PhongFiles;
struct SceneMips; // shading/bake/mip/settings.h
extern const SceneMips kBoxMips;

// Everything a renderer needs; the references must outlive it.
struct RenderInput {
    const Scene& scene;
    const DrawTables& tables;
    const Environment& environment;
    const DfgTable& dfg;
    const Jobs& jobs;
    const ltc::ShadingTables* ltc = nullptr; // of area lights; none: ltc::shipped_tables()
    const PhongFiles* phong = nullptr;       // of as_mc's lobes; none: frames make their own
    const SceneMips& mips = kBoxMips;        // how levels of the scene's maps are made
};

enum class Sampling { none, count, grid }; // what a technique makes of FrameDesc::samples: nothing, N samples, n x n

struct TechniqueInfo {
    const char* name;
    const char* summary;
    Sampling sampling;
    int default_samples, most_samples;
    int traits; // sum of those in shading/lang/records.h
};
const std::vector<TechniqueInfo>& techniques();                             // from shading/models.def
const TechniqueInfo* find_technique(const std::string& name);               // also automatic_technique(); null where there is none
const TechniqueInfo& automatic_technique();                                 // "auto": one of techniques() for each material
const TechniqueInfo& technique_of(const FrameDesc& desc, bool anisotropic); // of a material: one of techniques()
int samples_taken(const TechniqueInfo& technique, int samples);             // of `samples` asked for

struct ParameterInfo {            // of techniques
    const char* name;             // the field of FrameDesc, of angles without its _rad
    const char* option;           // "axis-k"; reports write it as axis_k
    double fallback, least, most; // of angles in degrees
    const char* unit;             // of a choice the names
    const char* summary;
    const char* readers;      // beginnings of names of techniques, and "reference"
    float FrameDesc::*number; // all but one are null
    std::uint32_t FrameDesc::*whole;
    bool FrameDesc::*flag;
    int FrameDesc::*choice;
    glm::vec2 FrameDesc::*angles;
    std::string_view kind; // as shading/models.def has it
};
const std::vector<ParameterInfo>& parameters();                                    // from shading/models.def
bool reads(const std::string& technique, const ParameterInfo& parameter);          // whether a technique, or "reference", looks at it
glm::dvec2 parameter_of(const FrameDesc& desc, const ParameterInfo& parameter);    // of angles both, in degrees; else twice the same
std::vector<std::string> choices_of(const ParameterInfo& parameter);               // names, by number; of what is no choice none
void set_parameter(FrameDesc& desc, const ParameterInfo& parameter, double value); // in [least, most]

struct AreaWayInfo { // of finding the light of area lights
    const char* name;
    const char* summary;
};
const std::vector<AreaWayInfo>& area_ways(); // from shading/models.def, by place

struct ModelInfo {
    const char* name;
    const char* summary;
    int lobe, lobe_traits; // its place among lobes and their traits (shading/lang/records.h); -1 where it cannot lie on a surface
};
const std::vector<ModelInfo>& models(); // from shading/models.def
const ModelInfo& lobe_model(int lobe);  // by its place
// Of the frame's lobes: its brdf, or what takes its place where they are tilted, or masked in another way.
int lobe_of(const FrameDesc& desc, bool tilted);
Status check_lobe(const FrameDesc& desc, const TechniqueInfo& technique); // whether the technique takes it; part of check_desc()

// 64-bit hash of size and the bits of every colour word, the same on every machine for the same picture.
std::uint64_t pixel_hash(const Image& image);
std::uint64_t count_not_finite(const Image& image); // pixels with a NaN or Inf channel
// RGBA of a frame drawn with triangle_ids and without background: alpha is the mean coverage of a pixel's samples (1 of a solid triangle,
// 1 - through elsewhere), and colours are associated (multiplied by it), as they are in `color`. through: Frame::through, may be empty.
Image with_coverage(const Image& color, const Column<std::uint32_t>& triangle_ids, const Column<float>& through);

} // namespace burnish
