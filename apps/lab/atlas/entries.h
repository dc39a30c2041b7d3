// Entries of the atlas: a rendering method, and a parameter path along which the method breaks.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/risks/path_reader.h"

namespace burnish {

enum class AtlasReference { reference, full, pattern, render, doubles, shown }; // references of errors: see atlas.def

struct AtlasEntry {
    const char *id, *group, *breaks;
    const char* words; // options of `burnish render`
    bool geometric;
    const char* path; // in the syntax of --animate; "amount" follows a failure scene's name: builtin:NAME=AMOUNT
    AtlasReference reference;
    const char* reference_words; // further options of the reference
    double threshold;
    const char* cure;      // options that help; empty: no cure is known
    std::string with = {}; // further options of the tested picture and its cure: a change under trial
};
const std::vector<AtlasEntry>& atlas_entries(); // in the order of atlas.def
const AtlasEntry* find_entry(const std::string& id);
std::vector<std::string> entry_ids();
// Returns true where the path tracer makes the reference.
constexpr bool is_path_traced(AtlasReference reference)
{
    return reference == AtlasReference::reference || reference == AtlasReference::full || reference == AtlasReference::pattern;
}

// A sampling pattern for the atlas's paths. Figures from two walks cannot be compared.
struct AtlasWalk {
    const char* name;
    int steps, side;       // steps on a path; picture side, pixels
    std::uint64_t samples; // reference samples a pixel
    int cure_every = 1;    // steps between two checks of the cure; the last step is always checked
};
inline constexpr AtlasWalk kQuickWalk{"quick", 7, 64, 256, 2}, kFullWalk{"full", 33, 96, 1024, 1};

// One picture of an entry, with keys for its scene and environment.
struct AtlasSetting : PicturePlace {
    std::string scene_key, environment_key;
    bool displayed = false; // compared as 8-bit display pictures
    bool in_double = false; // by the tile renderer in doubles: raster/tile/twins.h
};

enum class AtlasRole { test, cure, reference };
// Returns the picture at s in [0,1], `side` pixels wide and high. samples: the reference's a pixel; other roles
// ignore it.
Result<AtlasSetting> setting_of(const AtlasEntry& entry, AtlasRole role, double s, int side, std::uint64_t samples);

// Reads many settings with one option table.
class SettingReader {
  public:
    Result<AtlasSetting> read(const AtlasEntry& entry, AtlasRole role, double s, int side, std::uint64_t samples);
    const OptionTable& given() const { return reader_.given(); } // of the setting that was read last

  private:
    PathReader reader_;
};

// Returns the subjects of models.def that an entry covers, from its options: "technique bent_normal", "area light ltc", "model ward",
// "mip
// filter lean".
Result<std::vector<std::string>> covered_by(const AtlasEntry& entry);
std::vector<std::string> to_be_covered(); // every subject

} // namespace burnish
