#include "core/scene/gltf/buffers.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <string_view>

#include "core/scene/gltf/compress.h"
#include "core/scene/gltf/container.h"

namespace burnish::gltf {

namespace {

bool is_alpha(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

// Returns the URI's scheme by RFC 3986: a letter, then letters, digits, "+", "-", "."; then a colon.
std::string_view uri_scheme(std::string_view uri)
{
    std::size_t n = 0;
    while (n < uri.size() && (is_alpha(uri[n]) || (n > 0 && (is_digit(uri[n]) || uri[n] == '+' || uri[n] == '-' || uri[n] == '.'))))
        ++n;
    return n > 0 && n < uri.size() && uri[n] == ':' ? uri.substr(0, n) : std::string_view();
}

int hex_value(char c)
{
    return is_digit(c) ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

std::string percent_decode(const std::string& uri, const std::string& place)
{
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] != '%') {
            text += uri[i];
            continue;
        }
        const int high = i + 2 < uri.size() ? hex_value(uri[i + 1]) : -1;
        const int low = i + 2 < uri.size() ? hex_value(uri[i + 2]) : -1;
        if (high < 0 || low < 0)
            fail(place, "a % in the URI is not followed by two hex digits");
        text += static_cast<char>(high * 16 + low);
        i += 2;
    }
    if (text.find('\0') != std::string::npos)
        fail(place, "the URI holds a zero byte");
    return text;
}

void check_below_folder(const std::string& path, const std::string& place)
{
    const char* const kRule = ": files must lie below the scene's folder (Limits::uris_outside)";
    if (path.front() == '/' || path.front() == '\\')
        fail(place, "absolute path " + printable(path) + kRule);
    std::string_view rest = path;
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find_first_of("/\\"), rest.size());
        if (rest.substr(0, end) == "..")
            fail(place, "path " + printable(path) + " leads upwards" + kRule);
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
}

std::string resolve_file_uri(const Document& doc, const std::string& uri, const std::string& place)
{
    if (const std::string_view scheme = uri_scheme(uri); !scheme.empty())
        fail(place, fmt::format("URI scheme \"{}\" is not supported, only files and data URIs", scheme));
    const std::string path = percent_decode(uri, place);
    if (path.empty())
        fail(place, "the URI is empty");
    if (!doc.has_folder)
        fail(place, "external file " + printable(path) + " is named by a scene that lies in no folder");
    if (!doc.limits.uris_outside)
        check_below_folder(path, place);
    return path.front() == '/' || doc.folder.empty() ? path : doc.folder + "/" + path;
}

int base64_value(char c)
{
    return c >= 'A' && c <= 'Z'   ? c - 'A'
           : c >= 'a' && c <= 'z' ? c - 'a' + 26
           : is_digit(c)          ? c - '0' + 52
           : c == '+'             ? 62
           : c == '/'             ? 63
                                  : -1;
}

// Decodes base64 by RFC 4648 section 4, strictly: padded, without other characters.
std::vector<std::uint8_t> base64_decode(std::string_view text, const std::string& place)
{
    if (text.size() % 4 != 0)
        fail(place, "the base64 text's length is not a multiple of 4");
    std::size_t pad = 0;
    while (pad < 2 && pad < text.size() && text[text.size() - 1 - pad] == '=')
        ++pad;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(text.size() / 4 * 3);
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const int value = i + pad >= text.size() ? 0 : base64_value(text[i]);
        if (value < 0)
            fail(place, fmt::format("character {} of the base64 text is not base64", i));
        group = group << 6 | static_cast<std::uint32_t>(value);
        if (i % 4 == 3) {
            for (int shift = 16; shift >= 0; shift -= 8)
                bytes.push_back(static_cast<std::uint8_t>(group >> shift));
            group = 0;
        }
    }
    bytes.erase(bytes.end() - static_cast<std::ptrdiff_t>(pad), bytes.end());
    return bytes;
}

bool is_data(const std::string& uri)
{
    return uri.compare(0, 5, "data:") == 0;
}

std::vector<std::uint8_t> decode_data_uri(const Document& doc, const std::string& uri, const std::string& place)
{
    const std::string_view text = uri;
    const std::size_t comma = text.find(',');
    constexpr std::string_view kEnding = ";base64";
    if (comma == std::string_view::npos || comma < kEnding.size() || text.substr(comma - kEnding.size(), kEnding.size()) != kEnding)
        fail(place, "the data URI is not base64");
    const std::string_view data = text.substr(comma + 1);
    if (data.size() / 4 * 3 > doc.limits.data_uri_bytes)
        fail(place, fmt::format("the data URI holds more than {} bytes (Limits::data_uri_bytes)", doc.limits.data_uri_bytes));
    return base64_decode(data, place);
}

// Returns a file's path without links, so that all names of a file agree. The path must lie below the scene's folder,
// itself without links.
std::string canonical_path(const Document& doc, const std::string& path, const std::string& place)
{
    namespace fs = std::filesystem;
    std::error_code failed;
    const fs::path file = fs::canonical(path, failed);
    if (failed)
        fail(place, printable(path) + " cannot be opened: " + failed.message());
    const fs::path folder = fs::canonical(doc.folder.empty() ? "." : doc.folder, failed);
    const bool below = !failed && std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
    if (!below && !doc.limits.uris_outside)
        fail(place, "path " + printable(path) + " leads through a link out of the scene's folder (Limits::uris_outside)");
    return file.string();
}

// Reads a file and counts its bytes against the input limit.
std::vector<std::uint8_t> read_counted(Document& doc, const std::string& file, const std::string& path, const std::string& place)
{
    const std::uint64_t left = doc.limits.input_bytes - std::min(doc.limits.input_bytes, doc.input_bytes);
    std::error_code failed;
    const std::uint64_t size = std::filesystem::file_size(file, failed);
    if (!failed && size > left)
        fail(place, fmt::format("the scene's files hold more than {} bytes (Limits::input_bytes)", doc.limits.input_bytes));
    std::vector<std::uint8_t> bytes = read_file_bytes(file, std::min(doc.limits.file_bytes, left), place);
    doc.scene.files.push_back(path);
    doc.input_bytes += bytes.size();
    return bytes;
}

// Reads a buffer's file once for all buffers that name it.
Bytes read_once(Document& doc, const std::string& uri, const std::string& place)
{
    const std::string path = resolve_file_uri(doc, uri, place), file = canonical_path(doc, path, place);
    const auto [it, is_new] = doc.buffer_files.try_emplace(file);
    if (is_new)
        it->second = read_counted(doc, file, path, place);
    return it->second;
}

void load_buffer(Document& doc, std::size_t i, std::map<std::string_view, std::size_t>& loaded)
{
    const Json& json = doc.json["buffers"][i];
    const std::string place = fmt::format("/buffers/{}", i);
    BufferData& buffer = doc.buffers[i];
    if (const Json* meshopt = get_extension(json, "EXT_meshopt_compression"); meshopt && meshopt->value("fallback", false))
        return; // the bytes are for readers without the extension
    // Find the bytes: a URI, or the GLB's chunk
    if (json.contains("uri")) {
        const std::string& uri = json["uri"].get_ref<const std::string&>();
        const auto [it, is_new] = loaded.insert({uri, i});
        if (is_new) {
            buffer.bytes = is_data(uri) ? buffer.own = decode_data_uri(doc, uri, place + "/uri") : read_once(doc, uri, place + "/uri");
        } else {
            buffer.bytes = doc.buffers[it->second].bytes;
        }
    } else if (i == 0 && doc.has_bin) {
        buffer.bytes = doc.bin;
    } else {
        return;
    }
    // Check the declared length
    const std::uint64_t length = get_uint(json, "byteLength", 0);
    if (buffer.bytes.size() < length)
        fail(place + "/byteLength", fmt::format("says {} bytes, only {} are there", length, buffer.bytes.size()));
    if (buffer.bytes.size() > length && json.contains("uri") && is_data(json["uri"].get_ref<const std::string&>()))
        doc.fault(place + "/byteLength", fmt::format("says {} bytes, and the data URI holds {}", length, buffer.bytes.size()));
    buffer.bytes = buffer.bytes.first(length);
    buffer.present = true;
}

} // namespace

Bytes read_uri(Document& doc, const std::string& uri, const std::string& place, std::vector<std::uint8_t>& own)
{
    if (is_data(uri))
        return own = decode_data_uri(doc, uri, place);
    const std::string path = resolve_file_uri(doc, uri, place), file = canonical_path(doc, path, place);
    if (const auto cached = doc.buffer_files.find(file); cached != doc.buffer_files.end())
        return cached->second;
    return own = read_counted(doc, file, path, place);
}

Bytes buffer_slice(const Document& doc, int buffer, std::uint64_t offset, std::uint64_t length, const std::string& place)
{
    const BufferData& data = doc.buffers[static_cast<std::size_t>(buffer)];
    if (!data.present)
        fail(place, fmt::format("needs bytes of buffer {}, which holds none", buffer));
    if (offset > data.bytes.size() || length > data.bytes.size() - offset)
        fail(place, fmt::format("bytes {} + {} reach past the end of buffer {} with {} bytes", offset, length, buffer, data.bytes.size()));
    return data.bytes.subspan(offset, length);
}

Bytes view_bytes(Document& doc, int view)
{
    const Json& json = doc.json["bufferViews"][static_cast<std::size_t>(view)];
    const std::string place = fmt::format("/bufferViews/{}", view);
    if (const Json* meshopt = get_extension(json, "EXT_meshopt_compression")) {
        const auto [it, is_new] = doc.decoded_views.try_emplace(view);
        if (is_new)
            it->second = decode_meshopt(doc, *meshopt, place);
        return it->second;
    }
    return buffer_slice(doc, get_index(json, "buffer"), get_uint(json, "byteOffset", 0), get_uint(json, "byteLength", 0), place);
}

void load_buffers(Document& doc)
{
    doc.buffers.resize(table_size(doc.json, "buffers"));
    std::map<std::string_view, std::size_t> loaded; // by URI: a file named twice is read once
    for (std::size_t i = 0; i < doc.buffers.size(); ++i)
        load_buffer(doc, i, loaded);
    for (std::size_t i = 0; i < table_size(doc.json, "bufferViews"); ++i) {
        const Json& view = doc.json["bufferViews"][i];
        const std::string place = fmt::format("/bufferViews/{}", i);
        if (const Json* meshopt = get_extension(view, "EXT_meshopt_compression"))
            check_meshopt(doc, view, *meshopt, place);
        else
            view_bytes(doc, static_cast<int>(i));
    }
}

} // namespace burnish::gltf
