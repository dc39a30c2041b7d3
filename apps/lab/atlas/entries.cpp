#include "apps/lab/atlas/entries.h"

#include <cstdlib>
#include <fmt/core.h>

#include "apps/cli/parse.h"
#include "apps/options/animate.h"
#include "shading/bake/mip/levels.h"
#include "shading/lang/records.h"

namespace burnish {
namespace {

constexpr bool straight = false, geometric = true; // kinds of atlas.def and risks.def

// Paths of the rules of `burnish render --risks`.
namespace rules {
struct RulePath {
    const char* words;
    bool geometric;
    const char* path;
};
#define BN_RISK(entry, measure, change, readers, says, words, kind, path) constexpr RulePath entry{words, kind, path};
#include "apps/risks/risks.def"
} // namespace rules

// Splits at blanks. Values contain no blanks.
std::vector<std::string> words_of(const std::string& text)
{
    std::vector<std::string> words = split(text, ' ');
    std::erase(words, "");
    return words;
}

constexpr const char* kAmount =
    "amount="; // of a path, and of a role's words: it follows a failure scene's name (core/lab/failure_scenes.cpp)

bool is_amount(const std::string& word)
{
    return word.rfind(kAmount, 0) == 0;
}

// Returns the entry's path without its amount, which is no option.
std::string path_of_options(const AtlasEntry& entry)
{
    std::string text;
    for (const std::string& part : split(entry.path, ','))
        if (!is_amount(part))
            text += (text.empty() ? "" : ",") + part;
    return text;
}

// Returns a role's options beyond the entry's own.
std::vector<std::string> own_words(const AtlasEntry& entry, AtlasRole role, std::uint64_t samples)
{
    if (role != AtlasRole::reference)
        return words_of(role == AtlasRole::cure ? fmt::format("{} {}", entry.with, entry.cure) : entry.with);
    std::vector<std::string> words = words_of(entry.reference_words);
    if (is_path_traced(entry.reference))
        for (const std::string& word : words_of(fmt::format("--backend reference --samples {} --reference-textures {}", samples,
                                                            entry.reference == AtlasReference::full ? "full" : "footprint")))
            words.push_back(word);
    return words;
}

// Makes the keys: the values of options that a scene is read by, and of environment options.
void set_keys(const OptionTable& table, const std::vector<std::string>& words, AtlasSetting& out)
{
    for (const Option& option : table.options()) {
        if (option.group == "Environment")
            out.environment_key += option.value.get() + " ";
        else if (option.positional() || changes_scene(option))
            out.scene_key += option.value.get() + " ";
    }
    for (std::size_t i = 0; i + 1 < words.size(); ++i)
        if (words[i] == "--light")
            out.scene_key += words[i + 1] + " ";
}

// Returns the amount as text, such as "0.01". Empty if neither the path nor the options have an amount.
std::string amount_at(const AtlasEntry& entry, const std::vector<std::string>& own, double s)
{
    for (const std::string& word : own)
        if (is_amount(word))
            return word.substr(std::string(kAmount).size());
    for (const std::string& part : split(entry.path, ','))
        if (is_amount(part)) {
            const std::string ends = part.substr(std::string(kAmount).size());
            OptionPath path{"amount", {std::atof(ends.c_str())}, {std::atof(ends.c_str() + ends.find(':') + 1)}, false, entry.geometric};
            return value_at(path, s);
        }
    return "";
}

// Keeps the last scene word (it begins with "builtin:") and appends the amount. Removes the other scenes and amount words.
void settle_scene(std::vector<std::string>& words, const std::string& amount)
{
    const auto is_scene = [&](std::size_t i) { return words[i].rfind("builtin:", 0) == 0 && (i == 0 || words[i - 1].rfind("--", 0) != 0); };
    std::string scene;
    std::vector<std::string> rest;
    for (std::size_t i = 0; i < words.size(); ++i)
        if (is_scene(i))
            scene = words[i];
        else if (!is_amount(words[i]))
            rest.push_back(words[i]);
    if (!scene.empty())
        rest.insert(rest.begin(), amount.empty() ? scene : scene + "=" + amount);
    words = std::move(rest);
}

const char* lobe_of_frame(const FrameDesc& frame)
{
    return lobe_model(lobe_of(frame, frame.tilt_rad != glm::vec2(0.0f))).name;
}

} // namespace

const std::vector<AtlasEntry>& atlas_entries()
{
    static const std::vector<AtlasEntry> entries = {
#define BN_ATLAS(id, group, breaks, words, kind, path, reference, reference_words, threshold, cure)                                        \
    {#id, #group, breaks, words, kind, path, AtlasReference::reference, reference_words, threshold, cure},
#define BN_ATLAS_OF_RULE(id, group, breaks, reference, reference_words, threshold, cure)                                                   \
    BN_ATLAS(id, group, breaks, rules::id.words, rules::id.geometric, rules::id.path, reference, reference_words, threshold, cure)
#include "apps/lab/atlas/atlas.def"
    };
    return entries;
}

const AtlasEntry* find_entry(const std::string& id)
{
    for (const AtlasEntry& entry : atlas_entries())
        if (id == entry.id)
            return &entry;
    return nullptr;
}

std::vector<std::string> entry_ids()
{
    std::vector<std::string> ids;
    for (const AtlasEntry& entry : atlas_entries())
        ids.emplace_back(entry.id);
    return ids;
}

Result<AtlasSetting> setting_of(const AtlasEntry& entry, AtlasRole role, double s, int side, std::uint64_t samples)
{
    return SettingReader().read(entry, role, s, side, samples);
}

Result<AtlasSetting> SettingReader::read(const AtlasEntry& entry, AtlasRole role, double s, int side, std::uint64_t samples)
{
    const std::vector<std::string> own = own_words(entry, role, samples);
    std::vector<std::string> words = words_of(fmt::format("{0} --size {1}x{1} --no-background -q", entry.words, side));
    words.insert(words.end(), own.begin(), own.end());
    const std::string amount = amount_at(entry, own, s);
    settle_scene(words, amount);
    Result<PicturePlace> place = reader_.read({entry.id, words, path_of_options(entry), entry.geometric, own}, s); // a role's words stay
    BN_TRY(place);
    AtlasSetting out;
    static_cast<PicturePlace&>(out) = std::move(*place);
    if (!amount.empty())
        out.values = fmt::format("amount {}{}{}", amount, out.values.empty() ? "" : ", ", out.values);
    out.in_double = role == AtlasRole::reference && entry.reference == AtlasReference::doubles;
    out.displayed = entry.reference == AtlasReference::shown;
    set_keys(given(), words, out);
    return out;
}

Result<std::vector<std::string>> covered_by(const AtlasEntry& entry)
{
    const Result<AtlasSetting> setting = setting_of(entry, AtlasRole::test, 1.0, 64, 0);
    BN_TRY(setting);
    const RenderOptions& o = setting->options;
    const std::string words = fmt::format(" {} ", entry.words);
    std::vector<std::string> covered = {fmt::format("technique {}", o.frame.technique)};
    if (std::string(entry.group) == "area_lights")
        covered.push_back(fmt::format("area light {}", area_ways()[static_cast<std::size_t>(o.frame.area_way)].name));
    if (words.find(" --mip-filter ") != std::string::npos)
        covered.push_back(fmt::format("mip filter {}", mip_filters()[static_cast<std::size_t>(o.mips.filter)].name));
    covered.push_back(fmt::format("model {}", lobe_of_frame(o.frame)));
    return covered;
}

std::vector<std::string> to_be_covered()
{
    std::vector<std::string> all;
    for (const MipFilterInfo& filter : mip_filters())
        all.push_back(fmt::format("mip filter {}", filter.name));
    for (const TechniqueInfo& technique : techniques())
        all.push_back(fmt::format("technique {}", technique.name));
    for (const AreaWayInfo& way : area_ways())
        all.push_back(fmt::format("area light {}", way.name));
    for (const ModelInfo& model : models())
        if (model.lobe >= 0 && !(model.lobe_traits & kPunctualOnly)) // such models see no light through which a lobe shows
            all.push_back(fmt::format("model {}", model.name));
    return all;
}

} // namespace burnish
