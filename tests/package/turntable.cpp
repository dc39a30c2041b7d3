// Draws a scene from four sides through the installed library.
#include <core/image/io/image_io.h>
#include <cstdio>
#include <raster/session/session.h>

int main(int argc, char** argv)
{
    using namespace burnish;
    OpenOptions open;
    open.environment.cube_size = 32; // small, for a quick bake
    open.environment.samples = 16;
    open.environment.use_cache = false;
    Result<Session> session = Session::open(argc > 1 ? argv[1] : "builtin:teapot", "builtin:studio", open);
    if (!session) {
        std::fprintf(stderr, "%s\n", session.error().line().c_str());
        return static_cast<int>(session.error().code);
    }
    FrameDesc desc;
    desc.width = 96, desc.height = 64;
    desc.technique = "major_axis_weighted";
    const glm::vec3 middle = 0.5f * (session->tables().bounds_min + session->tables().bounds_max);
    const float away = 1.5f * glm::length(session->tables().bounds_max - session->tables().bounds_min);
    const glm::vec3 sides[] = {{0, 0, 1}, {1, 0, 0}, {0, 0, -1}, {-1, 0, 0}};
    for (int i = 0; i < 4; ++i) {
        desc.view = make_view(middle + sides[i] * away, middle, 0.6f, desc.width, desc.height);
        const Result<Frame> frame = session->render(desc);
        if (!frame || !write_image("side" + std::to_string(i) + ".exr", frame->color))
            return 1;
        std::printf("%016llx\n", static_cast<unsigned long long>(pixel_hash(frame->color)));
    }
}
