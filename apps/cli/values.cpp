#include "apps/cli/values.h"

#include <algorithm>
#include <fmt/core.h>

#include "apps/cli/report.h"
#include "apps/cli/suggest.h"
#include "core/math/scalar_math.h"
#include "core/scene/builtin/builtin.h"
#include "raster/frame/frame.h"
#include "shading/lang/records.h"

namespace burnish {
namespace {

using Texts = std::vector<std::string>;
using Put = std::function<Status(const std::string& option, const std::string& text)>;

Value make(ValueKind kind, Put put, std::function<std::string()> get)
{
    Value value;
    value.kind = kind;
    value.set = [put = std::move(put)](const std::string& option, const Texts& texts) { return put(option, texts.back()); };
    value.get = std::move(get);
    return value;
}

// Parses with `parse` and passes the value to `use`.
template <class T, class Parse, class Use> Put reading(Parse parse, Use use)
{
    return [parse, use](const std::string& option, const std::string& text) -> Status {
        const Result<T> value = parse(option, text);
        BN_TRY(value);
        use(*value);
        return {};
    };
}

// Parses two numbers with a comma between, each in [low, high].
Result<glm::vec2> parse_angles(const std::string& option, const std::string& written, const glm::dvec2& low, const glm::dvec2& high)
{
    const std::size_t comma = written.find(',');
    if (comma == std::string::npos || comma == 0 || comma + 1 == written.size())
        return usage_error(option, fmt::format("expected two angles such as 20,0, got '{}'", written));
    const Result<double> x = parse_number(option, written.substr(0, comma), low.x, high.x);
    BN_TRY(x);
    const Result<double> y = parse_number(option, written.substr(comma + 1), low.y, high.y);
    BN_TRY(y);
    return glm::vec2(static_cast<float>(*x), static_cast<float>(*y));
}

Error not_one_of(const std::string& option, const std::string& text, const Texts& names)
{
    return usage_error(option, fmt::format("'{}' is not one of {}{}", text, join(names), did_you_mean(text, names)));
}

bool contains(const Texts& names, const std::string& text)
{
    return std::find(names.begin(), names.end(), text) != names.end();
}

std::string joined(const Texts& texts)
{
    std::string all;
    for (const std::string& text : texts)
        all += (all.empty() ? "" : ",") + text;
    return all;
}

constexpr const char* kBuiltin = "builtin:";

Texts names_of(const std::vector<BuiltinInfo>& infos)
{
    Texts names;
    for (const BuiltinInfo& info : infos)
        names.push_back(kBuiltin + std::string(info.name));
    return names;
}

// Returns true for the builtin:NAME=AMOUNT of a parametric scene.
bool is_parametric_scene(const std::string& text)
{
    return std::any_of(parametric_scenes().begin(), parametric_scenes().end(), [&](const ParametricScene& scene) {
        return text.substr(0, text.find('=')) == std::string(kBuiltin) + scene.info.name;
    });
}

Value path_value(std::string& to, ValueKind kind)
{
    return make(
        kind, [&to](const std::string&, const std::string& text) { return to = text, Status(); }, [&to] { return to; });
}

// Several values: each is a path, or one of the names if it begins like them.
Value paths_value(Texts& to, const Texts& names, bool parametric = false)
{
    Value value;
    value.kind = ValueKind::file, value.repeated = true, value.names = names;
    value.set = [&to, names, parametric](const std::string& option, const Texts& texts) -> Status {
        for (const std::string& text : texts)
            if (!names.empty() && text.rfind(kBuiltin, 0) == 0 && !contains(names, text) && !(parametric && is_parametric_scene(text)))
                return not_one_of(option, text, names);
        to = texts;
        return {};
    };
    value.get = [&to] { return joined(to); };
    return value;
}

Value builtin_or_path(std::string& to, const Texts& names, bool parametric)
{
    Value value = path_value(to, ValueKind::file);
    value.names = names;
    value.set = [&to, names, parametric](const std::string& option, const Texts& texts) -> Status {
        if (texts.back().rfind(kBuiltin, 0) == 0 && !contains(names, texts.back()) && !(parametric && is_parametric_scene(texts.back())))
            return not_one_of(option, texts.back(), names);
        to = texts.back();
        return {};
    };
    return value;
}

std::string bytes_text(std::uint64_t bytes)
{
    for (const auto& [shift, unit] : {std::pair{30u, 'G'}, {20u, 'M'}, {10u, 'K'}})
        if (bytes != 0 && bytes % (std::uint64_t{1} << shift) == 0)
            return fmt::format("{}{}", bytes >> shift, unit);
    return std::to_string(bytes);
}

Texts number_names(const std::vector<int>& numbers)
{
    Texts names;
    for (const int number : numbers)
        names.push_back(std::to_string(number));
    return names;
}

} // namespace

namespace value_detail {

Value integer(std::int64_t low, std::int64_t high, std::function<void(std::int64_t)> put, std::function<Integer()> get)
{
    const auto parse = [low, high](const std::string& option, const std::string& text) { return parse_integer(option, text, low, high); };
    Value value = make(ValueKind::integer, reading<std::int64_t>(parse, std::move(put)), [get = std::move(get)] {
        const Integer held = get();
        return held ? std::to_string(*held) : std::string();
    });
    value.low = static_cast<double>(low), value.high = static_cast<double>(high);
    return value;
}

Value number(double low, double high, std::function<void(double)> put, std::function<Number()> get)
{
    const auto parse = [low, high](const std::string& option, const std::string& text) { return parse_number(option, text, low, high); };
    Value value = make(ValueKind::number, reading<double>(parse, std::move(put)), [get = std::move(get)] {
        const Number held = get();
        return held ? fmt::format("{:g}", *held) : std::string();
    });
    value.low = low, value.high = high;
    return value;
}

Value name(Texts names, std::function<void(std::size_t)> put, std::function<std::size_t()> get)
{
    Value value = make(
        ValueKind::name,
        [names, put = std::move(put)](const std::string& option, const std::string& text) -> Status {
            const auto found = std::find(names.begin(), names.end(), text);
            if (found == names.end())
                return not_one_of(option, text, names);
            put(static_cast<std::size_t>(found - names.begin()));
            return {};
        },
        [names, get = std::move(get)] {
            const std::size_t at = get();
            return at < names.size() ? names[at] : std::string();
        });
    value.names = std::move(names);
    return value;
}

} // namespace value_detail

Value hinted(Value value, Hints hints)
{
    value.set = [set = std::move(value.set), hints = std::move(hints)](const std::string& option, const Texts& texts) {
        Status done = set(option, texts);
        for (const auto& [word, hint] : hints)
            if (!done && texts.back() == word) {
                Error error = done.error();
                error.reason += "; " + hint;
                return Status(std::move(error));
            }
        return done;
    };
    return value;
}

Value flag(bool& to, bool becomes)
{
    return make(
        ValueKind::flag, [&to, becomes](const std::string&, const std::string&) { return to = becomes, Status(); },
        [&to, becomes] { return to == becomes ? std::string("yes") : std::string(); });
}

Value count(int& to)
{
    Value value;
    value.kind = ValueKind::count;
    value.set = [&to](const std::string&, const Texts& texts) { return to = static_cast<int>(texts.size()), Status(); };
    value.get = [&to] { return std::to_string(to); };
    return value;
}

Value bytes(std::uint64_t& to)
{
    return make(ValueKind::bytes, reading<std::uint64_t>(parse_bytes, [&to](std::uint64_t value) { to = value; }),
                [&to] { return bytes_text(to); });
}

Value picture_size(PictureSize& to)
{
    return make(ValueKind::size, reading<PictureSize>(parse_picture_size, [&to](const PictureSize& size) { to = size; }),
                [&to] { return to.width ? fmt::format("{}x{}", to.width, to.height) : std::string(); });
}

namespace {

// unit: stored value for one degree.
Value angles_in(glm::vec2& to, double low, double high, float unit)
{
    Value value = make(ValueKind::vector,
                       reading<glm::vec2>(
                           [=](const std::string& option, const std::string& written) {
                               return parse_angles(option, written, {low, low}, {high, high});
                           },
                           [&to, unit](const glm::vec2& read) { to = read * unit; }),
                       [&to, unit] { return fmt::format("{:g},{:g}", to.x / unit, to.y / unit); });
    value.low = low, value.high = high;
    return value;
}

} // namespace

Value angles(glm::vec2& to, double low, double high)
{
    return angles_in(to, low, high, 1.0f);
}

Value angles_rad(glm::vec2& to, double low, double high)
{
    return angles_in(to, low, high, static_cast<float>(kPi / 180.0));
}

Value direction(std::optional<glm::vec2>& to)
{
    return make(ValueKind::vector,
                reading<glm::vec2>(
                    [](const std::string& option, const std::string& written) {
                        return parse_angles(option, written, {-360.0, -90.0}, {360.0, 90.0});
                    },
                    [&to](const glm::vec2& read) { to = read; }),
                [&to] { return to ? fmt::format("{:g},{:g}", to->x, to->y) : std::string(); });
}

Value point(std::optional<glm::vec3>& to)
{
    return make(ValueKind::vector, reading<glm::vec3>(parse_vec3, [&to](const glm::vec3& value) { to = value; }),
                [&to] { return to ? fmt::format("{:g},{:g},{:g}", to->x, to->y, to->z) : std::string(); });
}

Value place(std::optional<glm::dvec3>& to)
{
    return make(ValueKind::vector, reading<glm::dvec3>(parse_dvec3, [&to](const glm::dvec3& value) { to = value; }),
                [&to] { return to ? fmt::format("{:.12g},{:.12g},{:.12g}", to->x, to->y, to->z) : std::string(); });
}

Value colour(std::optional<glm::vec3>& to)
{
    const auto parse = [](const std::string& option, const std::string& written) -> Result<glm::vec3> {
        const Result<glm::vec3> read = parse_vec3(option, written);
        if (read && (glm::any(glm::lessThan(*read, glm::vec3(0.0f))) || glm::any(glm::greaterThan(*read, glm::vec3(1.0f)))))
            return usage_error(option, fmt::format("'{}' is not within 0..1", written));
        return read;
    };
    return make(ValueKind::vector, reading<glm::vec3>(parse, [&to](const glm::vec3& value) { to = value; }),
                [&to] { return to ? fmt::format("{:g},{:g},{:g}", to->x, to->y, to->z) : std::string(); });
}

Value text(std::string& to)
{
    return path_value(to, ValueKind::text);
}

Value texts(Texts& to)
{
    Value value;
    value.kind = ValueKind::text, value.repeated = true;
    value.set = [&to](const std::string&, const Texts& given) -> Status {
        to = given;
        return {};
    };
    value.get = [] { return std::string(); };
    return value;
}

Value file(std::string& to)
{
    return path_value(to, ValueKind::file);
}

Value folder(std::string& to)
{
    return path_value(to, ValueKind::folder);
}

Value files(Texts& to)
{
    return paths_value(to, {});
}

Value scene(std::string& to)
{
    return builtin_or_path(to, names_of(builtin_scenes()), true);
}

Value scenes(Texts& to)
{
    return paths_value(to, names_of(builtin_scenes()), true);
}

Value environment(std::string& to)
{
    return builtin_or_path(to, names_of(builtin_environments()), false);
}

Value environments(Texts& to)
{
    return paths_value(to, names_of(builtin_environments()));
}

Value area_lights(std::vector<AreaLight>& to)
{
    Value value;
    value.kind = ValueKind::text, value.repeated = true;
    value.set = [&to](const std::string& option, const Texts& texts) -> Status {
        std::vector<AreaLight> lights;
        for (const std::string& text : texts) {
            const Result<AreaLight> light = parse_area_light(option, text);
            BN_TRY(light);
            lights.push_back(*light);
        }
        to = std::move(lights);
        return {};
    };
    value.get = [] { return std::string(); };
    return value;
}

Value extracted_lights(int& to)
{
    Texts names = {"auto", "off"};
    for (int n = 0; n <= kMaxExtractedLights; ++n)
        names.push_back(std::to_string(n));
    const auto put = [&to](std::size_t i) { to = i == 0 ? kMaxExtractedLights : i == 1 ? 0 : static_cast<int>(i) - 2; };
    return value_detail::name(names, put, [&to] { return to == kMaxExtractedLights ? 0 : static_cast<std::size_t>(to) + 2; });
}

Value choices(Texts& to, Texts names)
{
    Value value = make(
        ValueKind::names,
        [&to, names](const std::string& option, const std::string& written) -> Status {
            const Texts parts = split(written, ',');
            for (const std::string& part : parts)
                if (part.empty())
                    return usage_error(option, "holds an empty entry");
                else if (!names.empty() && !contains(names, part))
                    return not_one_of(option, part, names);
            to = parts;
            return {};
        },
        [&to] { return joined(to); });
    value.names = std::move(names);
    return value;
}

Value choices(std::vector<int>& to, const std::vector<int>& numbers)
{
    const Texts names = number_names(numbers);
    Value value = make(
        ValueKind::names,
        [&to, names](const std::string& option, const std::string& written) -> Status {
            Texts parts;
            BN_TRY(choices(parts, names).set(option, {written}));
            to.clear();
            for (const std::string& part : parts)
                to.push_back(std::stoi(part));
            return {};
        },
        [&to] { return joined(number_names(to)); });
    value.names = names;
    return value;
}

Value choice(int& to, const std::vector<int>& numbers)
{
    return value_detail::name(
        number_names(numbers), [&to, numbers](std::size_t i) { to = numbers[i]; },
        [&to, numbers] { return static_cast<std::size_t>(std::find(numbers.begin(), numbers.end(), to) - numbers.begin()); });
}

Value techniques_value(Texts& to)
{
    Value value =
        make(ValueKind::names,
             reading<Texts>([](const std::string& option, const std::string& written) { return parse_techniques(written, option); },
                            [&to](const Texts& names) { to = names; }),
             [&to] { return to.size() == techniques().size() ? std::string("all") : joined(to); });
    value.names = {"all"};
    for (const std::string& name : technique_names())
        value.names.push_back(name);
    return value;
}

} // namespace burnish
