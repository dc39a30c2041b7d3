#include "core/scene/gltf/container.h"

#include <cstring>
#include <fmt/format.h>

#include "core/base/file.h"

namespace burnish::gltf {

namespace {

constexpr std::uint32_t kMagic = 0x46546c67; // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4e4f534a;
constexpr std::uint32_t kBinChunk = 0x004e4942;
constexpr std::uint64_t kHeaderBytes = 12, kChunkHeaderBytes = 8;
// Bound on JSON values relative to the file size limit: a parsed value takes some 100 bytes, more than its text.
constexpr std::uint64_t kFileBytesPerValue = 256;

std::string at_byte(std::uint64_t offset)
{
    return fmt::format("byte {}", offset);
}

std::uint32_t read_u32(Bytes bytes, std::uint64_t offset)
{
    const std::uint8_t* p = bytes.data() + offset; // little-endian in the file
    return static_cast<std::uint32_t>(p[0]) | static_cast<std::uint32_t>(p[1]) << 8 | static_cast<std::uint32_t>(p[2]) << 16 |
           static_cast<std::uint32_t>(p[3]) << 24;
}

// Checks depth and number of values in the text, before a parser allocates anything.
void check_json_text(const char* text, std::uint64_t size, std::uint64_t first_byte, const Limits& limits)
{
    const std::uint64_t most_values = limits.file_bytes / kFileBytesPerValue + 1024;
    std::uint64_t values = 0;
    int depth = 0;
    bool in_string = false;
    for (std::uint64_t i = 0; i < size; ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\')
                ++i;
            else if (c == '"')
                in_string = false;
            continue;
        }
        if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            if (++depth > limits.json_depth)
                fail(at_byte(first_byte + i), fmt::format("JSON is nested deeper than {} (Limits::json_depth)", limits.json_depth));
        } else if (c == '}' || c == ']') {
            --depth;
        }
        values += c == ',' || c == '{' || c == '[';
        if (values > most_values)
            fail(at_byte(first_byte + i), fmt::format("JSON holds more than {} values (grows with Limits::file_bytes)", most_values));
    }
}

// Returns the parser's message without its error number and position, which the error's place already gives.
std::string parser_words(const char* what)
{
    std::string words = what;
    const std::size_t column = words.find("column ");
    const std::size_t colon = column == std::string::npos ? words.find("] ") : words.find(": ", column);
    if (colon != std::string::npos)
        words = words.substr(colon + 2);
    return printable(words);
}

Json parse_json(const char* text, std::uint64_t size, std::uint64_t first_byte, const Limits& limits)
{
    check_json_text(text, size, first_byte, limits);
    Json json;
    try {
        json = Json::parse(text, text + size);
    } catch (const Json::parse_error& e) {
        fail(at_byte(first_byte + (e.byte ? e.byte - 1 : 0)), "JSON is malformed: " + parser_words(e.what()));
    } catch (const Json::exception& e) {
        fail(at_byte(first_byte), "JSON is malformed: " + parser_words(e.what()));
    }
    if (!json.is_object())
        fail(at_byte(first_byte), "the JSON text is not an object");
    return json;
}

struct Chunk {
    std::uint32_t type = 0;
    std::uint64_t begin = 0, length = 0; // of its data, in the file
};

Chunk read_chunk(Bytes bytes, std::uint64_t offset)
{
    if (bytes.size() - offset < kChunkHeaderBytes)
        fail(at_byte(offset), "the file ends inside a GLB chunk header");
    const Chunk chunk{read_u32(bytes, offset + 4), offset + kChunkHeaderBytes, read_u32(bytes, offset)};
    if (chunk.length > bytes.size() - chunk.begin)
        fail(at_byte(offset),
             fmt::format("the GLB chunk says {} bytes, {} are left in the file", chunk.length, bytes.size() - chunk.begin));
    if (chunk.length % 4 != 0)
        fail(at_byte(offset), fmt::format("the GLB chunk's length {} is not a multiple of 4", chunk.length));
    return chunk;
}

void parse_glb(Document& doc)
{
    const Bytes bytes = doc.bytes;
    // Check the GLB header
    if (bytes.size() < kHeaderBytes)
        fail(at_byte(bytes.size()), "the file ends inside the GLB header");
    if (const std::uint32_t version = read_u32(bytes, 4); version != 2)
        fail(at_byte(4), fmt::format("GLB version {} is not supported, only 2", version));
    if (const std::uint32_t length = read_u32(bytes, 8); length != bytes.size())
        fail(at_byte(8), fmt::format("the GLB header says {} bytes, the file has {}", length, bytes.size()));
    // Walk the chunks: JSON first, BIN second, others ignored
    Chunk json;
    std::uint64_t offset = kHeaderBytes;
    for (int i = 0; i == 0 || offset < bytes.size(); ++i) {
        const Chunk chunk = read_chunk(bytes, offset);
        if ((chunk.type == kJsonChunk) != (i == 0))
            fail(at_byte(offset), i == 0 ? "the first GLB chunk is not JSON" : "a second JSON chunk in the GLB");
        if (chunk.type == kJsonChunk) {
            json = chunk;
        } else if (chunk.type == kBinChunk) {
            if (chunk.length == 0)
                doc.fault(at_byte(offset), "the BIN chunk is empty");
            if (i != 1)
                fail(at_byte(offset), "the BIN chunk is not the second chunk of the GLB");
            doc.bin = bytes.subspan(chunk.begin, chunk.length);
            doc.has_bin = true;
        }
        offset = chunk.begin + chunk.length;
    }
    // Parse the JSON chunk
    const char* text = reinterpret_cast<const char*>(bytes.data() + json.begin);
    doc.json = parse_json(text, json.length, json.begin, doc.limits);
}

} // namespace

std::vector<std::uint8_t> read_file_bytes(const std::string& path, std::uint64_t limit, const std::string& place)
{
    Result<std::vector<std::uint8_t>> bytes = read_file(path, limit);
    if (!bytes) // the Error itself names the scene's file; any other file is named here
        fail(place, (place.empty() ? "" : printable(path) + " ") + printable(bytes.error().reason));
    return std::move(*bytes);
}

void parse_container(Document& doc)
{
    const Bytes bytes = doc.bytes;
    if (bytes.empty())
        fail(at_byte(0), "the file is empty");
    if (bytes.size() >= 4 && read_u32(bytes, 0) == kMagic) {
        doc.is_glb = true;
        return parse_glb(doc);
    }
    std::uint64_t first = bytes.size() >= 3 && bytes[0] == 0xef && bytes[1] == 0xbb && bytes[2] == 0xbf ? 3 : 0;
    if (first > 0)
        doc.fault(at_byte(0), "a byte order mark stands before the JSON text; skipped");
    while (first < bytes.size() && std::strchr(" \t\r\n", bytes[first]) && bytes[first] != 0)
        ++first;
    if (first == bytes.size() || bytes[first] != '{')
        fail(at_byte(first), "neither glTF JSON nor GLB");
    doc.json = parse_json(reinterpret_cast<const char*>(bytes.data()) + first, bytes.size() - first, first, doc.limits);
}

} // namespace burnish::gltf
