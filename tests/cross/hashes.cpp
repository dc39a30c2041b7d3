// Prints hashes of the built-in scenes' small images and bakes, one a line, for one instruction set:
//   burnish_hashes ISA
// Without an argument, prints the available instruction sets.
#include <cstdio>
#include <cstdlib>
#include <string>

#include "core/base/hash.h"
#include "core/scene/builtin/builtin.h"
#include "raster/session/session.h"

namespace burnish {
namespace {

constexpr int kWidth = 48, kHeight = 32;

void print(const std::string& name, std::uint64_t hash)
{
    std::printf("%016llx %s\n", static_cast<unsigned long long>(hash), name.c_str());
}

// Draws a frame and prints its hash. Ends the program if drawing fails.
void draw(Session& session, const std::string& name, FrameDesc desc)
{
    desc.view = session.framed(desc.width, desc.height);
    const Result<Frame> frame = session.render(desc);
    if (!frame) {
        std::fprintf(stderr, "%s: %s\n", name.c_str(), frame.error().line().c_str());
        std::exit(1);
    }
    print(name, pixel_hash(frame->color));
}

FrameDesc small_desc(const std::string& technique, int msaa)
{
    FrameDesc desc;
    desc.width = kWidth, desc.height = kHeight, desc.technique = technique, desc.msaa = msaa;
    return desc;
}

void draw_all(Session& session, const std::string& scene)
{
    for (const int msaa : {1, 4})
        draw(session, scene + " auto " + std::to_string(msaa) + "x", small_desc("auto", msaa));
    for (const TechniqueInfo& technique : techniques()) {
        FrameDesc desc = small_desc(technique.name, 1);
        desc.samples = technique.sampling == Sampling::none ? 1 : 9;
        desc.override_anisotropy = true, desc.anisotropy = -0.7f, desc.roughness = 0.35f;
        draw(session, scene + " " + technique.name, desc);
    }
    FrameDesc tilted = small_desc("mc", 1);
    tilted.samples = 8, tilted.tilt_rad = {0.3f, -0.2f}, tilted.seed = 7;
    draw(session, scene + " tilted", tilted);
    FrameDesc compensated = small_desc("major_axis", 16);
    compensated.energy_compensation = true, compensated.horizon = true, compensated.tile_size = 32;
    draw(session, scene + " compensated 16x", compensated);
    FrameDesc fitted = small_desc("split_isotropic", 2);
    fitted.dfg_fit = true, fitted.background = false;
    draw(session, scene + " fitted", fitted);
}

// Draws every built-in scene once. Every second material of the spheres blends.
bool draw_each(SessionParts parts, const SessionOptions& options)
{
    for (const BuiltinInfo& info : builtin_scenes()) {
        const std::string name = info.name;
        Scene scene = *make_builtin_scene(name);
        for (std::size_t i = 0; i < scene.materials.size() && name == "spheres"; i += 2)
            scene.materials[i].alpha_mode = AlphaMode::blend, scene.materials[i].base_color.a = 0.4f,
            scene.materials[i].double_sided = true;
        Result<std::shared_ptr<const SceneData>> data = make_scene_data(name, std::move(scene), {});
        if (!data)
            return false;
        parts.scene = *data;
        Result<Session> session = Session::make(parts, options);
        if (!session)
            return false;
        draw(*session, name + " 4x", small_desc("auto", 4));
    }
    return true;
}

int run(const std::string& isa_word)
{
    const Result<Isa> isa = parse_isa(isa_word);
    if (!isa) {
        std::fprintf(stderr, "%s\n", isa.error().line().c_str());
        return 2;
    }
    setenv("BN_FORCE_ISA", isa_word.c_str(), 1); // for the bake
    const auto jobs = std::make_shared<const Jobs>(2);
    const auto dfg = std::make_shared<const DfgTable>(bake_dfg(16, 64, *jobs));
    print("dfg", hash_bytes(dfg->pairs.data(), dfg->pairs.size() * sizeof dfg->pairs[0], 0));
    EnvironmentOptions options;
    options.cube_size = 16, options.samples = 16, options.use_cache = false;
    const char* const environments[] = {"builtin:studio", "builtin:sky", "builtin:studio"};
    const char* const scenes[] = {"builtin:teapot", "builtin:spheres", "builtin:plate"};
    for (int i = 0; i < 3; ++i) {
        const auto environment = load_shared_environment(environments[i], options, {}, *jobs);
        const auto scene = load_scene_data(scenes[i], {});
        if (!environment || !scene)
            return 1;
        const CubeMap& cube = (*environment)->specular;
        print(environments[i], hash_bytes(cube.texels.data(), cube.texels.size() * sizeof cube.texels[0], 0));
        SessionOptions of_session;
        of_session.isa = *isa;
        const SessionParts parts = {*scene, *environment, jobs, dfg};
        Result<Session> session = Session::make(parts, of_session);
        if (!session)
            return 1;
        draw_all(*session, scenes[i]);
        if (i == 0 && !draw_each(parts, of_session))
            return 1;
    }
    return 0;
}

} // namespace
} // namespace burnish

int main(int argc, char** argv)
{
    if (argc > 1)
        return burnish::run(argv[1]);
    for (const burnish::Isa isa : burnish::program_isas())
        if (burnish::isa_available(isa))
            std::printf("%s\n", burnish::isa_name(isa));
}
