// What the atlas shows: a way to draw, and a path along which it breaks.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "apps/cli/command.h"
#include "apps/options/animate.h"
#include "apps/options/options.h"

namespace burnish {

enum class AtlasTruth { reference, full, render, doubles, shown }; // as apps/risks/atlas.def has them

struct AtlasEntry {
    const char *id, *group, *breaks;
    const char* words; // of `burnish render`
    bool geometric;
    const char* path; // as --animate takes it; "amount" is what follows a trial's name: builtin:NAME=AMOUNT
    AtlasTruth truth;
    const char* truth_words; // that the truth has besides
    double threshold;
    const char* cure;      // words that help; empty: none is known
    std::string with = {}; // words that what breaks and its cure have besides: a change that is tried
};
const std::vector<AtlasEntry>& atlas_entries(); // in the order of atlas.def
const AtlasEntry* find_entry(const std::string& id);
std::vector<std::string> entry_ids();

// How the atlas is walked. Figures of one walk say nothing of the other's.
struct AtlasWalk {
    const char* name;
    int steps, side;       // of a path; pixels of a picture
    std::uint64_t samples; // a pixel of the reference
    int cure_every = 1;    // steps from one look at the cure to the next; the last is looked at
};
inline constexpr AtlasWalk kQuickWalk{"quick", 7, 64, 256, 2}, kFullWalk{"full", 33, 96, 1024, 1};

// One picture of an entry: options, and what tells scenes and environments apart.
struct AtlasSetting {
    RenderOptions options;
    std::string values; // "anisotropy 0.5": what the path gives
    std::string scene_key, environment_key;
    bool displayed = false; // compared as 8-bit pictures are shown
    bool in_double = false; // by the tile renderer: raster/tile/double_renderer.h
};

enum class AtlasRole { test, cure, truth };
// At s in [0,1], `side` pixels wide and high. Of the truth `samples` a pixel; 0: as the entry's truth needs.
Result<AtlasSetting> setting_of(const AtlasEntry& entry, AtlasRole role, double s, int side, std::uint64_t samples);

// The same, one after another: the table of options takes longer to make than to be read by.
class SettingReader {
  public:
    SettingReader();
    SettingReader(const SettingReader&) = delete;
    Result<AtlasSetting> read(const AtlasEntry& entry, AtlasRole role, double s, int side, std::uint64_t samples);

  private:
    RenderArguments arguments_;
    Command command_; // refers to them
};

// What of models.def an entry is about, by what its options say: "technique bent_normal", "area light ltc", "model ward", "mip filter
// lean".
Result<std::vector<std::string>> covered_by(const AtlasEntry& entry);
std::vector<std::string> to_be_covered(); // all that there is

} // namespace burnish
