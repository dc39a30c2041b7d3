// Draws a scene from four sides, then with its first mesh turned. The environment is made once.
#include <burnish/burnish.hpp>
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>

using namespace burnish;

int fails(const Error& error)
{
    std::fprintf(stderr, "%s\n", error.line().c_str());
    return static_cast<int>(error.code);
}

int main(int argc, char** argv)
{
    OpenOptions open;
    open.environment.cube_size = 32; // small, for a quick bake
    open.environment.samples = 16;
    open.environment.use_cache = false;
    Result<Session> session = Session::open(argc > 1 ? argv[1] : "builtin:teapot", "builtin:studio", open);
    if (!session)
        return fails(session.error());
    FrameDesc desc;
    desc.width = 96, desc.height = 64;
    desc.technique = "major_axis_weighted";
    const glm::vec3 middle = 0.5f * (session->tables().bounds_min + session->tables().bounds_max);
    const float away = 1.5f * glm::length(session->tables().bounds_max - session->tables().bounds_min);
    const glm::vec3 sides[] = {{0, 0, 1}, {1, 0, 0}, {0, 0, -1}, {-1, 0, 0}};
    for (int i = 0; i < 4; ++i) {
        desc.view = make_view(middle + sides[i] * away, middle, 0.6f, desc.width, desc.height);
        const Result<Frame> frame = session->render(desc);
        if (!frame)
            return fails(frame.error());
        const std::string path = "side" + std::to_string(i) + ".exr";
        if (const Status written = write_image(path, frame->color); !written)
            return fails(written.error());
        std::printf("%016llx\n", static_cast<unsigned long long>(pixel_hash(frame->color)));
    }
    // Turn the first node with a mesh. Textures and environment stay
    SceneChanges changes;
    for (std::size_t i = 0; i < session->scene().nodes.size() && changes.nodes.empty(); ++i)
        if (const Node& node = session->scene().nodes[i]; node.mesh != kNone)
            changes.nodes.emplace_back(static_cast<std::int32_t>(i), glm::rotate(node.local, glm::radians(40.0f), glm::vec3(0, 1, 0)));
    if (const Status changed = session->change(changes); !changed)
        return fails(changed.error());
    const Result<Frame> frame = session->render(desc);
    if (!frame)
        return fails(frame.error());
    std::printf("%016llx\n", static_cast<unsigned long long>(pixel_hash(frame->color)));
}
