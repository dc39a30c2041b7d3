// Writes a picture with depth, normals and object numbers as channels of one OpenEXR file.
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
    Result<Session> session = Session::open(argc > 1 ? argv[1] : "builtin:spheres", "");
    if (!session)
        return fails(session.error());
    const std::vector<std::string> names = {"depth", "normal", "object-id"};
    FrameDesc desc;
    desc.width = 160, desc.height = 120;
    desc.view = session->framed(desc.width, desc.height);
    if (const Status asked = ask_for_layers(names, desc); !asked)
        return fails(asked.error());
    const Result<Frame> frame = session->render(desc);
    if (!frame)
        return fails(frame.error());
    const Result<NamedChannels> picture = with_layers(frame->color, *frame, session->tables(), names);
    if (!picture)
        return fails(picture.error());
    for (const std::string& name : picture->names)
        std::printf("%s\n", name.c_str());
    const Status written = write_channels("layers.exr", picture->image, picture->names);
    return written ? 0 : fails(written.error());
}
