// Draws a brushed square, made of arrays, under the built-in sky.
#include <burnish/burnish.hpp>
#include <cstdio>

using namespace burnish;

int fails(const Error& error)
{
    std::fprintf(stderr, "%s\n", error.line().c_str());
    return static_cast<int>(error.code);
}

int main()
{
    const glm::vec3 positions[] = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
    const glm::vec2 coordinates[] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
    const std::uint32_t triangles[] = {0, 1, 2, 0, 2, 3};
    MeshInput square;
    square.positions = positions, square.coordinates = coordinates, square.triangles = triangles; // normals are made
    square.material.metallic = 1.0f, square.material.roughness = 0.4f, square.material.anisotropy_strength = 0.8f;
    Scene scene;
    if (const auto node = add_mesh(scene, square); !node)
        return fails(node.error());
    const auto data = make_scene_data("square", std::move(scene), Limits());
    if (!data)
        return fails(data.error());
    SessionParts parts;
    parts.scene = *data, parts.jobs = std::make_shared<const Jobs>(0);
    const auto sky = load_shared_environment("builtin:sky", EnvironmentOptions(), Limits(), *parts.jobs);
    if (!sky)
        return fails(sky.error());
    parts.environment = *sky;
    Result<Session> session = Session::make(std::move(parts));
    if (!session)
        return fails(session.error());
    FrameDesc desc;
    desc.width = 160, desc.height = 120;
    desc.parts = true; // for clean edges of bright things
    desc.view = session->framed(desc.width, desc.height);
    const Result<Frame> frame = session->render(desc);
    if (!frame)
        return fails(frame.error());
    const Status written =
        write_image("square.png", tonemap_to_srgb8(frame->color, Tonemap::pbr_neutral, 0.0f, frame->parts, Resolve::display));
    return written ? 0 : fails(written.error());
}
