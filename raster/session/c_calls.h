// Parts that all functions of the C interface share. Each function catches everything and keeps the error of its thread.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "core/base/exception.h"
#include "core/image/colour.h"
#include "core/image/io/image_io.h"
#include "raster/frame/layers.h"
#include "raster/session/burnish.h"
#include "raster/session/c_options.h"

struct burnish_session {
    burnish::Session session;
    bool mirrors = false; // on its floor
};

struct burnish_frame {
    burnish::Frame frame;
    burnish::NamedChannels layered;        // colours, then the layers asked for
    std::vector<std::vector<float>> taken; // layers that were read
    std::vector<std::pair<std::string, int>> names;
    burnish::Tonemap tonemap = burnish::Tonemap::pbr_neutral; // of 8-bit pictures
    burnish::Resolve resolve = burnish::Resolve::linear;
    std::string png;
    std::vector<unsigned char> rgba8;
};

namespace burnish {

// Keeps the error's line for burnish_error(). Returns its exit code.
int fails(const Error& error);

// Calls a function that returns a Status. An exception becomes an error.
template <class Call> int guarded_call(const Call& call)
{
    try {
        const Status status = call();
        return status ? 0 : fails(status.error());
    } catch (...) {
        try {
            return fails(error_of_exception(Error{ExitCode::internal, "", "", "a fault of burnish"}));
        } catch (...) { // no memory for the text
            return static_cast<int>(ExitCode::bad_input);
        }
    }
}

inline Error usage(const std::string& place, const std::string& reason)
{
    return Error{ExitCode::usage, "", place, reason};
}

} // namespace burnish
