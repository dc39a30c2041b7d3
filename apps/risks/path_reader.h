// Reads pictures on a path: options of `burnish render`, of which some run from one value to another.
#pragma once
#include <string>
#include <vector>

#include "apps/cli/command.h"
#include "apps/options/options.h"

namespace burnish {

struct PicturePath {
    std::string name;                    // for messages
    std::vector<std::string> words;      // options of `burnish render`
    std::string path;                    // in the syntax of --animate; may be empty
    bool geometric = false;              // by equal factors
    std::vector<std::string> fixed = {}; // options that keep their values in `words`
};

struct PicturePlace {
    RenderOptions options;
    std::string values; // the values on the path, such as "anisotropy 0.5"
};

// Reads many places with one option table: making the table takes longer than reading a place.
class PathReader {
  public:
    PathReader();
    PathReader(const PathReader&) = delete;
    Result<PicturePlace> read(const PicturePath& path, double s); // s in [0,1]
    const OptionTable& given() const { return command_.options; } // of the place that was read last

  private:
    RenderArguments arguments_;
    Command command_; // refers to arguments_
};

} // namespace burnish
