// Session: a scene under an environment, prepared once and drawn many times. The program, its tests and other programs draw with sessions.
//
//   Result<Session> opened = Session::open("lamp.glb", "builtin:studio");
//   FrameDesc desc;                                             // 1280x720, 8 samples a pixel
//   desc.view = opened->framed(desc.width, desc.height);
//   Result<Frame> frame = opened->render(desc);                 // frame->color: f32 RGB, linear Rec.709 radiance
//
// No function in this header throws; a failure is an Error. Parts (SceneData, Environment, DfgTable) never change after their creation, so
// any number of sessions and threads may share them. One thread at a time may use a session. Sessions in different threads are independent
// and draw the same bits as a session alone.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/jobs/jobs.h"
#include "core/scene/draw_tables.h"
#include "core/scene/material_overrides.h"
#include "core/scene/scene.h"
#include "raster/frame/frame.h"
#include "raster/reference/reference_renderer.h"
#include "raster/session/floor.h"
#include "raster/tile/tile_renderer.h"
#include "raster/vulkan/vulkan_renderer.h"
#include "shading/bake/environment/environment.h"
#include "shading/bake/mip/settings.h"

namespace burnish {

inline constexpr int kDfgSize = 64;     // side of the directional albedo table, texels
inline constexpr int kDfgSamples = 256; // samples per texel

// Positions in views, tables and lights are metres from scene.origin. The origin is 0 except for scenes far away (core/scene/origin.h).
struct SceneData { // a scene and its draw tables
    std::string name;
    Scene scene; // world matrices are up to date
    DrawTables tables;
    SceneMips mips;                // how levels of its maps are made, and those that were made beforehand
    Column<float> visibility = {}; // of the sky from the tables' first vertices, which it darkens; empty: none (lay_floor())
    MipSettings asked = {};        // what mips were made by
};

// "builtin:NAME" or a path of a .gltf, .glb or .obj file, at a moment of its animation. lights: that are added to the scene's
// lights, in world space. floor: that is laid under the scene. jobs: threads that decode pictures; null: the calling thread alone.
Result<std::shared_ptr<const SceneData>> load_scene_data(const std::string& spec, const Limits& limits,
                                                         const MaterialOverrides& overrides = {}, const MipSettings& mips = {},
                                                         const Moment& moment = {}, const std::vector<AreaLight>& lights = {},
                                                         const FloorSettings& floor = {}, const Jobs* jobs = nullptr);
// From a scene made in memory. The limits on pictures, area lights and what instances expand to hold here too. Columns of vertices that are
// left out are filled (core/scene/check_scene.h). Errors: ExitCode::bad_input with the place of the first fault:
// "/primitives/0/indices/17". A mesh without triangles or without an area, and a scene that draws nothing, are faults too.
Result<std::shared_ptr<const SceneData>> make_scene_data(const std::string& name, Scene scene, const Limits& limits,
                                                         const MipSettings& mips = {});
// "builtin:NAME", a path of an equirectangular picture, or of a .gltf or .glb file with an image-based light.
Result<std::shared_ptr<const Environment>> load_shared_environment(const std::string& spec, const EnvironmentOptions& options,
                                                                   const Limits& limits, const Jobs& jobs);
// Returns the default environment of a scene: the scene's file if that has an image-based light, else builtin:studio.
std::string default_environment(const SceneData& scene);
// Returns the default directional albedo table. The table has the same bits on every machine and is made once a process.
Result<std::shared_ptr<const DfgTable>> standard_dfg(const Jobs& jobs);

// Reads a table made by `burnish bake ltc`, which replaces the built-in table for its lobe model. lobe: the frames' lobe
// (shading/models.def). A table for another model than the lobe's is refused. A GGX table fits every model.
Result<std::shared_ptr<const ltc::ShadingTables>> load_ltc_table(const std::string& path, int lobe);

// Reads tables made by `burnish bake half-vectors` and `brdf-lut`, or folders of such tables. They replace the tables that frames make for
// as_mc.
Result<std::shared_ptr<const PhongFiles>> load_phong_tables(const std::vector<std::string>& paths, const Limits& limits);

// Input of a renderer. All parts are shared.
struct SessionParts {
    std::shared_ptr<const SceneData> scene;
    std::shared_ptr<const Environment> environment;
    std::shared_ptr<const Jobs> jobs;                   // null: all cores the process may use
    std::shared_ptr<const DfgTable> dfg;                // null: standard_dfg()
    std::shared_ptr<const ltc::ShadingTables> ltc = {}; // linearly transformed cosines for area lights; null: the built-in tables
    std::shared_ptr<const PhongFiles> phong = {};       // tables for as_mc; null: frames make them
    std::shared_ptr<const DrawTables> turned = {};      // draw tables turned against a rotated environment; a session makes them

    // Returns the renderer's input. The session must have filled every part that is needed.
    RenderInput input() const
    {
        return {scene->scene, turned ? *turned : scene->tables, *environment, *dfg, *jobs, ltc.get(), phong.get(), scene->mips};
    }
};

enum class Backend { tile, vulkan, reference };

struct SessionOptions {
    Backend backend = Backend::tile;
    Isa isa = best_isa();                 // for tile and reference
    ReferenceOptions reference;           // for reference; `isa` above replaces its `isa`
    VulkanOptions vulkan;                 // for vulkan without a given device
    std::shared_ptr<VulkanDevice> device; // for vulkan: an open device
};

// Further options for opening a session by names.
struct OpenOptions {
    int threads = 0; // 0: all cores the process may use
    EnvironmentOptions environment;
    Limits limits;
};

// Changes to a scene between frames, by indices into its tables.
struct SceneChanges {
    std::vector<std::pair<std::int32_t, glm::mat4>> nodes = {};         // Node::local
    std::vector<std::pair<std::int32_t, Material>> materials = {};      // with other factors and the same maps
    std::vector<std::pair<std::int32_t, std::int32_t>> primitives = {}; // Primitive::material
    std::vector<std::pair<std::int32_t, Light>> lights = {};            // punctual lights
    std::shared_ptr<const Environment> environment = {};                // null: stays
};

class Session {
  public:
    // Loads the scene, loads or bakes the environment or finds it in the cache, and makes the renderer. An empty environment means
    // default_environment(). Errors: ExitCode::bad_input, usage, unavailable.
    static Result<Session> open(const std::string& scene, const std::string& environment, const OpenOptions& open = {},
                                const SessionOptions& options = {});
    // Makes a session from parts. Errors: ExitCode::usage if scene or environment is missing, unavailable, bad_input if a part is faulty
    // or memory is short.
    static Result<Session> make(SessionParts parts, const SessionOptions& options = {});

    Session(Session&&) = default;
    Session& operator=(Session&& other)
    {
        renderer_ = std::move(other.renderer_); // first, because the renderer refers to the parts
        parts_ = std::move(other.parts_), options_ = std::move(other.options_), pyramids_ = std::move(other.pyramids_);
        return *this;
    }

    // Returns the description that the renderer gets. Environments stay in place; the world and the view turn the other way.
    FrameDesc drawn(const FrameDesc& desc) const;
    // Draws a frame. recycled: an old frame whose memory may be reused. Errors: ExitCode::usage, unavailable; not_finite where a pixel is
    // NaN or Inf, for instance by a light of 3e38.
    Result<Frame> render(const FrameDesc& desc, Frame recycled = {});
    // Draws a frame like render(), but returns pixels that are NaN or Inf too, for callers that show these.
    Result<Frame> render_any(const FrameDesc& desc, Frame recycled = {});

    // Changes the scene for the following frames. Texture levels, tables and the bake of the environment stay; draw tables are made anew.
    // Frames have the bits of a new session of the changed scene with the same origin. Copies the scene first where others share it. A
    // failure changes nothing. Errors: ExitCode::bad_input with the place ("/nodes/7/local"); usage where a change needs a new session.
    // Such are other maps, levels made beforehand, nodes and materials above a floor, and shapes of area lights. Skins stay as they were
    // read. References into scene() and tables() see the changes.
    Status change(SceneChanges changes);

    // These functions need a session that was not moved to another object.
    const SessionParts& parts() const { return parts_; }
    const Scene& scene() const { return parts_.scene->scene; }
    const DrawTables& tables() const { return parts_.scene->tables; }
    Renderer& renderer() { return *renderer_; }                // draws descriptions from drawn(); render_any() calls it
    std::string device() const { return renderer_->device(); } // the device's name: "AMD EPYC (avx512)", ...
    // Returns a view that shows the whole scene, for a picture with this size.
    View framed(int width, int height, const Framing& framing = {}) const { return auto_frame(tables(), width, height, framing); }

  private:
    Session(SessionParts parts, SessionOptions options, std::shared_ptr<PyramidCache> pyramids, std::unique_ptr<Renderer> renderer)
        : parts_(std::move(parts)), options_(std::move(options)), pyramids_(std::move(pyramids)), renderer_(std::move(renderer))
    {
    }
    static Result<Session> make_with(SessionParts parts, SessionOptions options, std::shared_ptr<PyramidCache> pyramids);

    SessionParts parts_;
    SessionOptions options_;
    std::shared_ptr<PyramidCache> pyramids_; // of this session's renderers alone
    std::unique_ptr<Renderer> renderer_;     // refers to parts_' contents, which stay in place when a session moves
};

} // namespace burnish
