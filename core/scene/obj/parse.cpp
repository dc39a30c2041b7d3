// Parses Wavefront OBJ (appendix B1 of the Advanced Visualizer manual), and colours after positions, which many
// programs write.
#include "core/scene/obj/parse.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fmt/format.h>
#include <iterator>
#include <set>
#include <string_view>

#include "core/base/text.h"
#include "core/scene/obj/lines.h"

namespace burnish::obj {
namespace {

// Kinds of statements for this reader.
enum class Kind { position, uv, normal, face, group, object, smoothing, material, library, points, curves, ignored };

struct Statement {
    std::string_view word;
    Kind kind;
};
constexpr Statement kStatements[] = {
    {"v", Kind::position},        {"vt", Kind::uv},
    {"vn", Kind::normal},         {"f", Kind::face},
    {"fo", Kind::face},           {"g", Kind::group},
    {"o", Kind::object},          {"s", Kind::smoothing},
    {"usemtl", Kind::material},   {"mtllib", Kind::library},
    {"usemap", Kind::ignored},    {"maplib", Kind::ignored},
    {"p", Kind::points},          {"l", Kind::points},
    {"vp", Kind::curves},         {"cstype", Kind::curves},
    {"deg", Kind::curves},        {"bmat", Kind::curves},
    {"step", Kind::curves},       {"curv", Kind::curves},
    {"curv2", Kind::curves},      {"surf", Kind::curves},
    {"parm", Kind::curves},       {"trim", Kind::curves},
    {"hole", Kind::curves},       {"scrv", Kind::curves},
    {"sp", Kind::curves},         {"end", Kind::curves},
    {"con", Kind::curves},        {"bzp", Kind::curves},
    {"bsp", Kind::curves},        {"cdc", Kind::curves},
    {"cdp", Kind::curves},        {"res", Kind::curves},
    {"mg", Kind::ignored},        {"bevel", Kind::ignored},
    {"c_interp", Kind::ignored},  {"d_interp", Kind::ignored},
    {"lod", Kind::ignored},       {"shadow_obj", Kind::ignored},
    {"trace_obj", Kind::ignored}, {"ctech", Kind::ignored},
    {"stech", Kind::ignored},
};

const Statement* find_statement(std::string_view word)
{
    const auto found = std::find_if(std::begin(kStatements), std::end(kStatements), [&](const Statement& s) { return s.word == word; });
    return found == std::end(kStatements) ? nullptr : found;
}

std::string lower(std::string_view word)
{
    std::string out(word);
    std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return out;
}

constexpr std::size_t kShownBytes = 40; // characters of a word shown in a message

class Parser {
  public:
    Parser(const std::string& path, std::string_view text) : path_(path), lines_(text) {}

    Parsed run()
    {
        while (!parsed_.wrong && lines_.next()) {
            std::string_view rest = lines_.text();
            const std::string_view word = take_word(rest);
            if (!word.empty())
                statement(word, rest);
        }
        if (lines_.painted())
            warn("colours of vertices in #MRGB comments are not read");
        if (bad_colours_)
            parsed_.colours.clear();
        return std::move(parsed_);
    }

  private:
    void refuse(const std::string& reason)
    {
        if (!parsed_.wrong)
            parsed_.wrong = Error{ExitCode::bad_input, path_, fmt::format("line {}", lines_.number()), reason};
    }

    void warn(const std::string& text) { parsed_.warnings.push_back(text); }

    // Warns with the line number, once for each kind.
    void warn_once(const char* kind, const std::string& text)
    {
        if (said_.insert(kind).second)
            warn(fmt::format("line {}: {}", lines_.number(), text));
    }

    static std::string shown(std::string_view word) { return printable(std::string(word), kShownBytes); }

    void statement(std::string_view word, std::string_view rest)
    {
        const Statement* known = find_statement(word);
        if (!known) {
            const Statement* meant = find_statement(lower(word));
            if (meant && meant->kind <= Kind::library)
                return refuse(fmt::format("'{}' is no statement, which is written '{}'", shown(word), meant->word));
            return warn_once("unknown", fmt::format("'{}' is not read", shown(word)));
        }
        const std::string_view numbers = rest.substr(0, rest.find('#')); // a comment may follow a number without a blank
        switch (known->kind) {
        case Kind::position:
            return position(numbers);
        case Kind::uv:
            return uv(numbers);
        case Kind::normal:
            return normal(numbers);
        case Kind::face:
            return polygon(numbers);
        case Kind::group:
            return begin(take_word(rest));
        case Kind::object:
            return begin(trimmed(rest));
        case Kind::smoothing:
            return smoothing(numbers);
        case Kind::material:
            return wear(trimmed(rest));
        case Kind::library:
            parsed_.libraries.emplace_back(trimmed(rest));
            return;
        case Kind::points:
            return warn_once("points", "points and lines are not drawn");
        case Kind::curves:
            return warn_once("curves", fmt::format("curves and surfaces are not drawn ({})", word));
        case Kind::ignored:
            return; // statements about refining and showing polygons
        }
    }

    // Reads all numbers of a statement, and returns their count or 0 after an error. `what` and `nth` name the
    // statement in errors.
    std::size_t numbers(std::string_view text, const char* what, std::size_t nth, std::array<float, 7>& values)
    {
        std::size_t count = 0;
        for (std::string_view word = take_word(text); !word.empty(); word = take_word(text), ++count) {
            if (count == values.size())
                return refuse(fmt::format("{} {}: more than {} numbers", what, nth, values.size())), 0;
            const Number read = read_number(word, values[count]);
            if (read == Number::too_large)
                return refuse(fmt::format("{} {}: '{}' is no number that a float holds", what, nth, shown(word))), 0;
            if (read == Number::none)
                return refuse(fmt::format("{} {}: '{}' is no number{}", what, nth, shown(word),
                                          word.find(',') != std::string_view::npos ? "; decimals follow a point" : "")),
                       0;
        }
        return count;
    }

    void position(std::string_view text)
    {
        std::array<float, 7> v{};
        const std::size_t nth = parsed_.positions.size() / 3 + 1, count = numbers(text, "position", nth, v);
        if (parsed_.wrong)
            return;
        if (count != 3 && count != 4 && count != 6)
            return refuse(fmt::format("position {}: {} numbers in place of 3, 4 (with a weight) or 6 (with a colour)", nth, count));
        if (count == 4 && v[3] != 1.0f)
            warn_once("weights", "weights of positions are not read: they count for curves and surfaces only");
        parsed_.positions.insert(parsed_.positions.end(), v.begin(), v.begin() + 3);
        if (count == 6)
            colour({v[3], v[4], v[5]});
        else if (!parsed_.colours.empty())
            parsed_.colours.resize(parsed_.positions.size(), 1.0f);
    }

    void colour(const std::array<float, 3>& rgb)
    {
        if (std::any_of(rgb.begin(), rgb.end(), [](float c) { return !(c >= 0.0f && c <= 1.0f); })) {
            warn_once("colours", "colours of vertices lie outside 0 to 1 and are not read");
            bad_colours_ = true;
        }
        if (bad_colours_)
            return;
        parsed_.colours.resize(parsed_.positions.size() - 3, 1.0f);
        parsed_.colours.insert(parsed_.colours.end(), rgb.begin(), rgb.end());
    }

    void uv(std::string_view text)
    {
        std::array<float, 7> v{};
        const std::size_t nth = parsed_.uvs.size() / 2 + 1, count = numbers(text, "texture coordinate", nth, v);
        if (parsed_.wrong)
            return;
        if (count < 1 || count > 3)
            return refuse(fmt::format("texture coordinate {}: {} numbers in place of 1 to 3", nth, count));
        parsed_.uvs.insert(parsed_.uvs.end(), v.begin(), v.begin() + 2); // a one-dimensional coordinate has v = 0
    }

    void normal(std::string_view text)
    {
        std::array<float, 7> v{};
        const std::size_t nth = parsed_.normals.size() / 3 + 1, count = numbers(text, "normal", nth, v);
        if (parsed_.wrong)
            return;
        if (count != 3)
            return refuse(fmt::format("normal {}: {} numbers in place of 3", nth, count));
        parsed_.normals.insert(parsed_.normals.end(), v.begin(), v.begin() + 3);
    }

    void begin(std::string_view called)
    {
        name_ = called;
        new_group_ = true;
    }

    void wear(std::string_view material)
    {
        new_group_ = new_group_ || material != material_;
        material_ = material;
    }

    // Sets the smoothing group: "off" is 0, "on" is 1. Anything else that is not a group number warns and counts as 1.
    void smoothing(std::string_view text)
    {
        const std::string_view word = take_word(text);
        std::int64_t number = 1;
        if (word == "off" || word == "null")
            number = 0;
        else if (word != "on" && (read_index(word, number) != Number::read || number < 0 || number >= kUnsaid))
            warn_once("smoothing", fmt::format("'{}' is no smoothing group; taken as 1", shown(word))), number = 1;
        smoothing_ = static_cast<std::uint32_t>(number);
    }

    void polygon(std::string_view text)
    {
        ++polygons_;
        if (new_group_)
            parsed_.groups.push_back({name_, material_, {}, {}});
        new_group_ = false;
        Group& group = parsed_.groups.back();
        std::uint32_t count = 0;
        for (std::string_view word = take_word(text); !word.empty(); word = take_word(text), ++count) {
            Corner c{-1, -1, -1, smoothing_};
            if (!corner(word, c))
                return;
            group.corners.push_back(c);
        }
        if (count < 3)
            return refuse(fmt::format("face {}: has fewer than three corners", polygons_));
        group.counts.push_back(count);
    }

    // Reads "position", "position/uv", "position//normal" or "position/uv/normal". Trailing parts may be empty.
    bool corner(std::string_view word, Corner& to)
    {
        const std::string_view whole = word;
        std::int64_t* const parts[] = {&to.position, &to.uv, &to.normal};
        const char* const kNames[] = {"positions", "texture coordinates", "normals"};
        const std::size_t counts[] = {parsed_.positions.size() / 3, parsed_.uvs.size() / 2, parsed_.normals.size() / 3};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t end = std::min(word.find('/'), word.size());
            const std::string_view part = word.substr(0, end);
            if ((i == 0 || !part.empty()) && !index(part, whole, counts[i], kNames[i], *parts[i]))
                return false;
            if (end == word.size())
                return true;
            word.remove_prefix(end + 1);
        }
        refuse(fmt::format("face {}: '{}' has more than three indices", polygons_, shown(whole)));
        return false;
    }

    // Resolves an index: from 1, or backwards from the vertices so far, from -1. `at` counts from 0.
    bool index(std::string_view part, std::string_view whole, std::size_t count, const char* what, std::int64_t& at)
    {
        std::int64_t written = 0;
        const Number read = read_index(part, written);
        const std::int64_t have = static_cast<std::int64_t>(count);
        at = written > 0 ? written - 1 : have + written;
        if (read == Number::none)
            refuse(fmt::format("face {}: '{}' is no index", polygons_, shown(whole)));
        else if (read == Number::too_large || at < 0 || at >= have)
            refuse(fmt::format("face {}: index {} of {} {} that came before it", polygons_, shown(part), have, what));
        return !parsed_.wrong;
    }

    const std::string& path_;
    Lines lines_;
    Parsed parsed_;
    std::string name_, material_;
    std::set<std::string> said_;
    std::uint64_t polygons_ = 0;
    std::uint32_t smoothing_ = kUnsaid;
    bool new_group_ = true, bad_colours_ = false;
};

} // namespace

Parsed parse(const std::string& path, const std::string& text)
{
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
        Parsed parsed;
        parsed.wrong = Error{ExitCode::bad_input, path, "byte 0", "is UTF-16 text; OBJ files are ASCII or UTF-8"};
        return parsed;
    }
    return Parser(path, text).run();
}

} // namespace burnish::obj
