// Prints how far two techniques are apart, as HDR-FLIP.
#include <burnish/burnish.hpp>
#include <cstdio>

using namespace burnish;

int fails(const Error& error)
{
    std::fprintf(stderr, "%s\n", error.line().c_str());
    return static_cast<int>(error.code);
}

int main(int argc, char** argv)
{
    Result<Session> session = Session::open("builtin:plate", "");
    if (!session)
        return fails(session.error());
    FrameDesc desc;
    desc.width = 160, desc.height = 120;
    desc.view = session->framed(desc.width, desc.height);
    Image pictures[2];
    for (int i = 0; i < 2; ++i) {
        desc.technique = argc > i + 1 ? argv[i + 1] : i ? "bent_normal" : "lobe_line";
        Result<Frame> frame = session->render(desc);
        if (!frame)
            return fails(frame.error());
        pictures[i] = std::move(frame->color);
    }
    const FlipResult flip = flip_hdr(pictures[0], pictures[1], FlipOptions(), *session->parts().jobs);
    std::printf("%.6f\n", summarise_errors(flip.error).mean);
}
