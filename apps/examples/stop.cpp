// Stops a long picture from another thread. The picture's progress is printed.
#include <burnish/burnish.hpp>
#include <chrono>
#include <cstdio>
#include <thread>

using namespace burnish;

int main()
{
    OpenOptions open;
    open.environment.cube_size = 32, open.environment.samples = 16, open.environment.use_cache = false; // a quick bake
    Result<Session> session = Session::open("builtin:teapot", "builtin:studio", open);
    if (!session)
        return static_cast<int>(session.error().code);
    FrameDesc desc;
    desc.width = 4096, desc.height = 4096;
    desc.technique = "mc", desc.samples = 1024;
    desc.view = session->framed(desc.width, desc.height);
    std::stop_source stop;
    const auto tell = [](const std::string& work, double done) { std::printf("%s: %g\n", work.c_str(), done); };
    const Controlled controlled({stop.get_token(), tell});
    std::jthread other([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(300));
        stop.request_stop();
    });
    const Result<Frame> frame = session->render(desc); // ExitCode::stopped after stop.request_stop() in another thread
    return !frame && frame.error().code == ExitCode::stopped ? 0 : 1;
}
