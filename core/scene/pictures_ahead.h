// Pictures of materials that all threads decode before their reader asks for them.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image/io/image_io.h"

namespace burnish {

// A reader that asks here has the pictures, warnings and errors of one thread, in the same order.
class PicturesAhead {
  public:
    struct Wanted {
        std::string path;
        bool colours = false; // as read_colours() reads them, else as read_image()
    };

    PicturesAhead() = default; // holds none

    // Reads and decodes pictures on all threads: each once, the largest file first. Holds those that Limits::texture_bytes has room for,
    // and leaves faults to read(). Does nothing with one thread, or for fewer than two pictures. List only what the reader will ask for.
    // limits: texture_bytes is what the scene leaves; files in memory stay within input_bytes. jobs: null for the calling thread alone.
    PicturesAhead(const std::vector<Wanted>& pictures, const Limits& limits, const Jobs* jobs);

    // Hands out the held picture, or reads the picture now where none is held or fits. rest: the limits above with the texture bytes that
    // are left now. Errors: read_image()'s; ExitCode::stopped where the caller's work is to stop.
    Result<Image> read(const std::string& path, bool colours, const Limits& rest, PictureNotes& notes);

  private:
    struct Held {
        Image image;
        PictureNotes notes;
        std::uint64_t bytes = 0; // the most that decoding asked room for
    };
    std::map<std::pair<std::string, bool>, Held> held_; // by path, and whether colours were read
};

} // namespace burnish
