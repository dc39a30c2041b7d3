#include "core/scene/gltf/document.h"

#include <fmt/format.h>

#include "core/base/text.h"

namespace burnish::gltf {

namespace {

constexpr std::size_t kMaxWarnings = 200; // a broken exporter repeats itself
// Bounds on memory for a small hostile file: an honest file stores a vertex in at least a few bytes.
constexpr std::uint64_t kFreeBytes = 256ull << 20;
constexpr std::uint64_t kExpansion = 1024; // decoded bytes for each input byte

} // namespace

void fail(std::string place, std::string reason)
{
    throw Failure{std::move(place), std::move(reason)};
}

std::string printable(const std::string& text)
{
    return burnish::printable(text, 200);
}

void Document::warn(const std::string& line)
{
    if (scene.warnings.size() > kMaxWarnings || !warned.insert(line).second)
        return;
    scene.warnings.push_back(scene.warnings.size() == kMaxWarnings ? "further warnings are left out" : line);
}

void Document::fault(const std::string& place, const std::string& reason)
{
    if (limits.strict)
        fail(place, reason + " (Limits::strict)");
    warn(place + ": " + reason);
}

void Document::charge(std::uint64_t more, const std::string& place)
{
    const std::uint64_t plausible = kFreeBytes + kExpansion * input_bytes;
    if (more > UINT64_MAX - charged_bytes)
        fail(place, "the decoded size overflows");
    charged_bytes += more;
    if (charged_bytes > limits.accessor_bytes)
        fail(place, fmt::format("the scene's vertex data needs more than {} bytes (Limits::accessor_bytes)", limits.accessor_bytes));
    if (charged_bytes > plausible)
        fail(place, fmt::format("the scene's vertex data needs more than {} bytes, which is out of proportion to the "
                                "{} bytes of input",
                                plausible, input_bytes));
}

std::uint64_t get_uint(const Json& object, const char* key, std::uint64_t fallback)
{
    const auto it = object.find(key);
    return it == object.end() ? fallback : it->get<std::uint64_t>();
}

int get_index(const Json& object, const char* key)
{
    const auto it = object.find(key);
    return it == object.end() ? -1 : it->get<int>();
}

double get_number(const Json& object, const char* key, double fallback)
{
    const auto it = object.find(key);
    return it == object.end() ? fallback : it->get<double>();
}

std::string get_string(const Json& object, const char* key)
{
    const auto it = object.find(key);
    return it == object.end() || !it->is_string() ? std::string() : it->get<std::string>();
}

const Json* get_member(const Json& object, const char* key)
{
    const auto it = object.find(key);
    return it == object.end() ? nullptr : &*it;
}

const Json* get_extension(const Json& object, const char* name)
{
    const auto extensions = object.find("extensions");
    if (extensions == object.end() || !extensions->is_object())
        return nullptr;
    const auto it = extensions->find(name);
    return it == extensions->end() || !it->is_object() ? nullptr : &*it;
}

std::size_t table_size(const Json& json, const char* key)
{
    const auto it = json.find(key);
    return it == json.end() ? 0 : it->size();
}

std::string quoted(const std::string& name, const char* kind, std::size_t index)
{
    return name.empty() ? fmt::format("{} {}", kind, index) : fmt::format("{} \"{}\"", kind, printable(name));
}

bool has_word(std::string_view list, std::string_view word)
{
    while (!list.empty() && !word.empty()) {
        const std::size_t end = std::min(list.find(' '), list.size());
        if (list.substr(0, end) == word)
            return true;
        list.remove_prefix(std::min(end + 1, list.size()));
    }
    return false;
}

} // namespace burnish::gltf
