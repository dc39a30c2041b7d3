// A scene under an environment, made ready once and drawn many times: what the program, its tests and other people's programs draw with.
//
//   Result<Session> opened = Session::open("lamp.glb", "builtin:studio");
//   FrameDesc desc;                                             // 1280x720, 8 samples a pixel
//   desc.view = opened->framed(desc.width, desc.height);
//   Result<Frame> frame = opened->render(desc);                 // frame->color: f32 RGB, linear Rec.709 radiance
//
// No exception leaves a function of this header: what fails is an Error. Parts (SceneData, Environment, DfgTable) never change once they
// are made, so any number of sessions and threads may share them. One session is used by one thread at a time; sessions in different
// threads do not know of each other, and draw the same bits as alone.
#pragma once
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
#include "raster/tile/tile_renderer.h"
#include "raster/vulkan/vulkan_renderer.h"
#include "shading/bake/environment/environment.h"
#include "shading/bake/mip/settings.h"

namespace burnish {

inline constexpr int kDfgSize = 64;     // texels a side of the table of directional albedo
inline constexpr int kDfgSamples = 256; // a texel

// Places of views, tables and lights are metres from scene.origin, which is 0 but for scenes far away (core/scene/origin.h).
struct SceneData { // a scene and what is drawn of it
    std::string name;
    Scene scene; // its world matrices are up to date
    DrawTables tables;
    SceneMips mips; // how levels of its maps are made, and those that were made beforehand
};

// "builtin:NAME" or a path of a .gltf, .glb or .obj file, at a moment of its animation. lights: that are added to those of the
// scene, in world space.
Result<std::shared_ptr<const SceneData>> load_scene_data(const std::string& spec, const Limits& limits,
                                                         const MaterialOverrides& overrides = {}, const MipSettings& mips = {},
                                                         const Moment& moment = {}, const std::vector<AreaLight>& lights = {});
// From a scene made in memory. The limits on pictures, area lights and what instances expand to hold here too. Columns of vertices that are
// left out are filled (core/scene/check_scene.h). Errors: ExitCode::bad_input with the place of the first fault:
// "/primitives/0/indices/17".
Result<std::shared_ptr<const SceneData>> make_scene_data(const std::string& name, Scene scene, const Limits& limits,
                                                         const MipSettings& mips = {});
// "builtin:NAME", a path of an equirectangular picture, or of a .gltf or .glb file with an image-based light.
Result<std::shared_ptr<const Environment>> load_shared_environment(const std::string& spec, const EnvironmentOptions& options,
                                                                   const Limits& limits, const Jobs& jobs);
// What a scene is drawn under where nothing else is asked for: its own file where that has an image-based light, else builtin:studio.
std::string usual_environment(const SceneData& scene);
// The table of directional albedo that pictures are made with: the same bits everywhere, made once a process.
Result<std::shared_ptr<const DfgTable>> standard_dfg(const Jobs& jobs);

// A table of `burnish bake ltc`, in place of the program's own one of its kind. lobe: of frames (shading/models.def); a table of another
// model's lobes is refused, but one of GGX's, which stands for those of all models.
Result<std::shared_ptr<const ltc::ShadingTables>> load_ltc_table(const std::string& path, int lobe);

// Tables of `burnish bake half-vectors` and `brdf-lut`, or folders of them, in place of those that frames make for as_mc.
Result<std::shared_ptr<const PhongFiles>> load_phong_tables(const std::vector<std::string>& paths, const Limits& limits);

// What a renderer draws. All of it is shared.
struct SessionParts {
    std::shared_ptr<const SceneData> scene;
    std::shared_ptr<const Environment> environment;
    std::shared_ptr<const Jobs> jobs;                   // none: all cores the process may use
    std::shared_ptr<const DfgTable> dfg;                // none: standard_dfg()
    std::shared_ptr<const ltc::ShadingTables> ltc = {}; // transformed cosines of area lights; none: the program's own
    std::shared_ptr<const PhongFiles> phong = {};       // tables of as_mc; none: frames make their own
    std::shared_ptr<const DrawTables> turned = {};      // the scene as it stands under an environment that is turned; a session makes them

    // Of parts that a session has: nothing is missing.
    RenderInput input() const
    {
        return {scene->scene, turned ? *turned : scene->tables, *environment, *dfg, *jobs, ltc.get(), phong.get(), scene->mips};
    }
};

enum class Backend { tile, vulkan, reference };

struct SessionOptions {
    Backend backend = Backend::tile;
    Isa isa = best_isa();                 // of tile and reference
    ReferenceOptions reference;           // of reference; its `isa` is the one above
    VulkanOptions vulkan;                 // of vulkan, where no device is given
    std::shared_ptr<VulkanDevice> device; // of vulkan: one that is open already
};

// What opening by names needs besides.
struct OpenOptions {
    int threads = 0; // 0: all cores the process may use
    EnvironmentOptions environment;
    Limits limits;
};

class Session {
  public:
    // Loads, bakes or finds in the cache, and makes the renderer. Without an environment (""): usual_environment(). Errors:
    // ExitCode::bad_input, usage, unavailable.
    static Result<Session> open(const std::string& scene, const std::string& environment, const OpenOptions& open = {},
                                const SessionOptions& options = {});
    // Errors: ExitCode::usage where scene or environment is missing, unavailable, bad_input where a part is faulty or memory is short.
    static Result<Session> make(SessionParts parts, const SessionOptions& options = {});

    Session(Session&&) = default;
    Session& operator=(Session&& other)
    {
        renderer_ = std::move(other.renderer_); // before what it refers to
        parts_ = std::move(other.parts_);
        return *this;
    }

    // What the renderer is given for it: environments are not turned, the world and its cameras are, the other way.
    FrameDesc drawn(const FrameDesc& desc) const;
    // `recycled`: a frame that is not needed any more, whose memory may be used again. Errors: ExitCode::usage, unavailable.
    Result<Frame> render(const FrameDesc& desc, Frame recycled = {});

    const SessionParts& parts() const { return parts_; }
    const Scene& scene() const { return parts_.scene->scene; }
    const DrawTables& tables() const { return parts_.scene->tables; }
    Renderer& renderer() { return *renderer_; }                // draws what drawn() gives; render() asks it
    std::string device() const { return renderer_->device(); } // what runs it: "AMD EPYC (avx512)", ...
    // A view of the whole scene for a picture of this size.
    View framed(int width, int height, const Framing& framing = {}) const { return auto_frame(tables(), width, height, framing); }

  private:
    Session(SessionParts parts, std::unique_ptr<Renderer> renderer) : parts_(std::move(parts)), renderer_(std::move(renderer)) {}
    SessionParts parts_;
    std::unique_ptr<Renderer> renderer_; // refers to what parts_ holds, which moves with it
};

} // namespace burnish
