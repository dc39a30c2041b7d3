#include "core/scene/obj/mtl.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <iterator>
#include <set>
#include <string_view>

#include "core/base/text.h"
#include "core/scene/obj/lines.h"

namespace burnish::obj {
namespace {

constexpr std::size_t kNamedBytes = 40;
constexpr std::size_t kMostSaid = 20; // kinds of warnings
constexpr float kAny = 3.4e38f;

struct ColourStatement {
    std::string_view word;
    std::optional<glm::vec3> MtlMaterial::*to;
    float most;
};
constexpr ColourStatement kColours[] = {
    {"Kd", &MtlMaterial::diffuse, 1.0f}, {"Ks", &MtlMaterial::specular, 1.0f}, {"Ke", &MtlMaterial::emission, kAny}};

struct NumberStatement {
    std::string_view word;
    std::optional<float> MtlMaterial::*to;
    float least, most;
};
constexpr NumberStatement kNumbers[] = {{"Ns", &MtlMaterial::exponent, 0.0f, kAny},
                                        {"d", &MtlMaterial::opacity, 0.0f, 1.0f},
                                        {"Tr", &MtlMaterial::opacity, 0.0f, 1.0f}, // the rest of it
                                        {"Ni", &MtlMaterial::ior, 0.0f, kAny},
                                        {"Pr", &MtlMaterial::roughness, 0.0f, 1.0f},
                                        {"Pm", &MtlMaterial::metallic, 0.0f, 1.0f},
                                        {"Pc", &MtlMaterial::clearcoat, 0.0f, 1.0f},
                                        {"Pcr", &MtlMaterial::clearcoat_roughness, 0.0f, 1.0f},
                                        {"Ps", &MtlMaterial::sheen, 0.0f, 1.0f},
                                        {"aniso", &MtlMaterial::anisotropy, -1.0f, 1.0f},
                                        {"anisor", &MtlMaterial::rotation, -kAny, kAny}};

struct MapStatement {
    std::string_view word;
    MtlMap MtlMaterial::*to;
};
constexpr MapStatement kMaps[] = {
    {"map_Kd", &MtlMaterial::diffuse_map},  {"map_Ke", &MtlMaterial::emission_map}, {"map_Pr", &MtlMaterial::roughness_map},
    {"map_Pm", &MtlMaterial::metallic_map}, {"norm", &MtlMaterial::normal_map},     {"map_d", &MtlMaterial::opacity_map},
    {"map_Ks", &MtlMaterial::specular_map}, {"map_Ns", &MtlMaterial::exponent_map}, {"map_Ps", &MtlMaterial::sheen_map},
    {"bump", &MtlMaterial::bump_map},       {"map_Bump", &MtlMaterial::bump_map},   {"map_bump", &MtlMaterial::bump_map}};

constexpr std::string_view kWithoutEffect[] = {"Ka", "map_Ka", "illum", "sharpness", "Tf", "map_aat"};

struct MapOption {
    std::string_view word;
    int words; // that follow; 0: at most three numbers
};
constexpr MapOption kMapOptions[] = {{"-blendu", 1}, {"-blendv", 1}, {"-cc", 1},     {"-clamp", 1},   {"-mm", 2}, {"-o", 0},
                                     {"-s", 0},      {"-t", 0},      {"-texres", 1}, {"-imfchan", 1}, {"-bm", 0}, {"-type", 1}};
constexpr float kMostScale = 1e6f; // of -s, -o and -bm

template <class Table> auto find(const Table& table, std::string_view word)
{
    return std::find_if(std::begin(table), std::end(table), [&](const auto& row) { return row.word == word; });
}

class MtlParser {
  public:
    MtlParser(const std::string& path, std::string_view text) : path_(path), lines_(text) {}

    MtlLibrary run()
    {
        while (!out_.wrong && lines_.next()) {
            std::string_view rest = lines_.text();
            const std::string_view word = take_word(rest);
            if (!word.empty())
                statement(word, trimmed(rest));
        }
        return std::move(out_);
    }

  private:
    void refuse(const std::string& reason)
    {
        if (!out_.wrong)
            out_.wrong = Error{ExitCode::bad_input, path_, fmt::format("line {}", lines_.number()), reason};
    }
    void warn_once(std::string_view kind, const std::string& text)
    {
        if (said_.size() < kMostSaid && said_.insert(std::string(kind)).second)
            out_.warnings.push_back(fmt::format("{}: line {}: {}", path_, lines_.number(), text));
    }
    static std::string shown(std::string_view word) { return printable(std::string(word), kNamedBytes); }

    void statement(std::string_view word, std::string_view rest)
    {
        if (word == "newmtl")
            return begin(rest);
        if (skips_)
            return;
        if (out_.materials.empty())
            return warn_once("before", "statements before the first newmtl are not read");
        MtlMaterial& m = out_.materials.back();
        if (const auto at = find(kColours, word); at != std::end(kColours))
            return colour(*at, rest, m);
        if (const auto at = find(kNumbers, word); at != std::end(kNumbers))
            return number(*at, rest, m);
        if (const auto at = find(kMaps, word); at != std::end(kMaps))
            return map(rest, m.*at->to);
        if (std::find(std::begin(kWithoutEffect), std::end(kWithoutEffect), word) == std::end(kWithoutEffect))
            warn_once("unknown " + std::string(word.substr(0, kNamedBytes)), fmt::format("'{}' is not read", shown(word)));
    }

    void begin(std::string_view name)
    {
        skips_ = !names_.insert(std::string(name)).second;
        if (skips_)
            return warn_once("twice", fmt::format("material '{}' stands here again; the first is used", shown(name)));
        out_.materials.emplace_back();
        out_.materials.back().name = name;
    }

    // Reads at most `most` numbers in front. Returns their count, or -1 after an error. may_end: a word may follow.
    int numbers(std::string_view& text, std::string_view word, std::array<float, 3>& values, bool may_end, int most = 3)
    {
        int count = 0;
        for (std::string_view rest = text; count < most; ++count, text = rest) {
            const std::string_view next = take_word(rest);
            float value = 0.0f;
            const Number read = next.empty() ? Number::none : read_number(next, value);
            if (read == Number::read)
                values[static_cast<std::size_t>(count)] = value;
            else if (next.empty() || (may_end && read == Number::none))
                break;
            else
                return refuse(fmt::format("{}: '{}' is no number", word, shown(next))), -1;
        }
        if (count == 0)
            return refuse(fmt::format("{}: a number is missing", word)), -1;
        return count;
    }

    float within(float value, float least, float most, std::string_view word)
    {
        if (value < least || value > most)
            warn_once(std::string(word) + " range", fmt::format("{} {:g} is taken as {:g}", word, value, std::clamp(value, least, most)));
        return std::clamp(value, least, most);
    }

    void colour(const ColourStatement& statement, std::string_view rest, MtlMaterial& m)
    {
        std::string_view text = rest;
        if (const std::string_view word = take_word(text); word == "spectral" || word == "xyz")
            return warn_once(word, fmt::format("{} {} is not read", statement.word, word));
        std::array<float, 3> rgb{};
        const int count = numbers(rest, statement.word, rgb, false);
        if (count < 0)
            return;
        glm::vec3 value;
        for (int c = 0; c < 3; ++c)
            value[c] = within(rgb[static_cast<std::size_t>(std::min(c, count - 1))], 0.0f, statement.most, statement.word);
        m.*statement.to = value;
    }

    void number(const NumberStatement& statement, std::string_view rest, MtlMaterial& m)
    {
        std::string_view text = rest;
        if (take_word(text) == "-halo")
            rest = text, warn_once("-halo", "-halo is not read");
        std::array<float, 3> values{};
        if (numbers(rest, statement.word, values, false) < 0)
            return;
        const float value = within(values[0], statement.least, statement.most, statement.word);
        m.*statement.to = statement.word == "Tr" ? 1.0f - value : value;
    }

    void map(std::string_view rest, MtlMap& to)
    {
        MtlMap read;
        while (rest.starts_with("-")) {
            std::string_view text = rest;
            const std::string_view word = take_word(text);
            const auto option = find(kMapOptions, word);
            if (option == std::end(kMapOptions))
                break; // a file's name
            std::array<float, 3> values{};
            if (option->words == 0) {
                const int count = numbers(text, word, values, true, word == "-bm" ? 1 : 3);
                if (count < 0)
                    return;
                for (float& value : values)
                    value = within(value, -kMostScale, kMostScale, word);
                if (word == "-s")
                    read.scale = {values[0], count > 1 ? values[1] : 1.0f};
                else if (word == "-o")
                    read.offset = {values[0], count > 1 ? values[1] : 0.0f};
                else if (word == "-bm")
                    read.strength = values[0];
            } else {
                for (int i = 0; i < option->words; ++i)
                    if (const bool on = take_word(text) == "on"; word == "-clamp")
                        read.clamps = on;
            }
            if (word == "-mm" || word == "-t" || word == "-cc" || word == "-imfchan")
                warn_once(word, fmt::format("{} is not read", word));
            rest = trimmed(text);
        }
        read.file = rest;
        if (rest.empty())
            return warn_once("no picture", "a picture's name is missing");
        to = std::move(read);
    }

    const std::string& path_;
    Lines lines_;
    MtlLibrary out_;
    std::set<std::string> said_, names_;
    bool skips_ = false;
};

} // namespace

MtlLibrary parse_mtl(const std::string& path, const std::string& text)
{
    if (text.find('\0') != std::string::npos) {
        MtlLibrary library;
        library.wrong = Error{ExitCode::bad_input, path, "", "holds bytes of 0: no text in UTF-8, perhaps UTF-16"};
        return library;
    }
    return MtlParser(path, text).run();
}

} // namespace burnish::obj
