#include "small_files.h"

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace burnish::test {
namespace {

namespace fs = std::filesystem;

void big32(std::string& out, std::uint32_t v)
{
    for (int shift = 24; shift >= 0; shift -= 8)
        out += static_cast<char>(v >> shift & 0xFF);
}

void little(std::string& out, std::uint64_t v, int bytes)
{
    for (int i = 0; i < bytes; ++i)
        out += static_cast<char>(v >> (8 * i) & 0xFF);
}

std::uint32_t crc32(const std::string& text)
{
    std::uint32_t crc = 0xFFFFFFFFu;
    for (const char c : text) {
        crc ^= static_cast<std::uint8_t>(c);
        for (int bit = 0; bit < 8; ++bit)
            crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0u);
    }
    return ~crc;
}

void chunk(std::string& out, const PngChunk& c)
{
    big32(out, static_cast<std::uint32_t>(c.data.size()));
    out += c.type + c.data;
    big32(out, crc32(c.type + c.data));
}

Bytes to_bytes(const std::string& text)
{
    return Bytes(text.begin(), text.end());
}

void attribute(std::string& out, const std::string& name, const std::string& type, const std::string& value)
{
    out += name + '\0' + type + '\0';
    little(out, value.size(), 4);
    out += value;
}

std::string box(const int (&w)[4])
{
    std::string out;
    for (const int v : w)
        little(out, static_cast<std::uint32_t>(v), 4);
    return out;
}

int rows(const ExrPart& part)
{
    return part.data[3] - part.data[1] + 1;
}

std::string exr_header(const ExrPart& part, bool many, int index)
{
    std::string channels, out;
    for (const ExrChannel& c : part.channels) {
        channels += c.name + '\0';
        little(channels, static_cast<std::uint64_t>(c.type), 4);
        little(channels, 0, 4);
        little(channels, static_cast<std::uint64_t>(c.sampling), 4);
        little(channels, static_cast<std::uint64_t>(c.sampling), 4);
    }
    channels += '\0';
    attribute(out, "channels", "chlist", channels);
    attribute(out, "compression", "compression", std::string(1, '\0'));
    attribute(out, "dataWindow", "box2i", box(part.data));
    attribute(out, "displayWindow", "box2i", box(part.display));
    attribute(out, "lineOrder", "lineOrder", std::string(1, '\0'));
    std::string one;
    little(one, std::bit_cast<std::uint32_t>(1.0f), 4);
    attribute(out, "pixelAspectRatio", "float", one);
    attribute(out, "screenWindowCenter", "v2f", std::string(8, '\0'));
    attribute(out, "screenWindowWidth", "float", one);
    for (const ExrAttribute& a : part.attributes)
        attribute(out, a.name, a.type, a.value);
    if (!part.type.empty())
        attribute(out, "type", "string", part.type);
    if (many) {
        std::string count;
        little(count, static_cast<std::uint64_t>(rows(part)), 4);
        attribute(out, "chunkCount", "int", count);
        attribute(out, "name", "string", "part" + std::to_string(index));
    }
    return out + '\0';
}

// Handles normal numbers and zero only.
std::uint16_t half_of(float v)
{
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(v);
    if ((bits & 0x7FFFFFFFu) == 0)
        return static_cast<std::uint16_t>(bits >> 16);
    return static_cast<std::uint16_t>((bits >> 16 & 0x8000u) | (((bits >> 23 & 0xFFu) - 112) << 10) | (bits >> 13 & 0x3FFu));
}

std::string exr_line(const ExrPart& part, int row)
{
    std::string out;
    for (const ExrChannel& c : part.channels)
        for (int x = 0; x <= part.data[2] - part.data[0]; ++x) {
            const float v = c.value + static_cast<float>(x) + 100.0f * static_cast<float>(row);
            if (c.type == 0)
                little(out, static_cast<std::uint64_t>(v), 4);
            else if (c.type == 1)
                little(out, half_of(v), 2);
            else
                little(out, std::bit_cast<std::uint32_t>(v), 4);
        }
    return out;
}

} // namespace

std::string store(const std::string& raw)
{
    std::string out = "\x78\x01\x01";
    little(out, raw.size(), 2);
    little(out, ~raw.size() & 0xFFFF, 2);
    out += raw;
    std::uint32_t a = 1, b = 0;
    for (const char c : raw) {
        a = (a + static_cast<std::uint8_t>(c)) % 65521;
        b = (b + a) % 65521;
    }
    big32(out, b << 16 | a);
    return out;
}

Bytes make_png(int width, int height, int depth, int colour_type, const std::string& raw, const std::vector<PngChunk>& extra)
{
    std::string header;
    big32(header, static_cast<std::uint32_t>(width));
    big32(header, static_cast<std::uint32_t>(height));
    header += {static_cast<char>(depth), static_cast<char>(colour_type), 0, 0, 0};
    std::string out = "\x89PNG\r\n\x1a\n";
    chunk(out, {"IHDR", header});
    for (const PngChunk& c : extra)
        chunk(out, c);
    std::string filtered;
    const std::size_t row = raw.size() / static_cast<std::size_t>(height);
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
        filtered += '\0' + raw.substr(y * row, row);
    chunk(out, {"IDAT", store(filtered)});
    chunk(out, {"IEND", ""});
    return to_bytes(out);
}

Bytes make_exr(const std::vector<ExrPart>& parts)
{
    const bool many = parts.size() > 1;
    const bool deep = std::any_of(parts.begin(), parts.end(), [](const ExrPart& p) { return p.type == "deepscanline"; });
    std::string out = "\x76\x2f\x31\x01";
    little(out, 2u | (many ? 0x1000u : 0u) | (deep ? 0x800u : 0u), 4);
    for (std::size_t i = 0; i < parts.size(); ++i)
        out += exr_header(parts[i], many, static_cast<int>(i));
    if (many)
        out += '\0';
    std::size_t table = 0;
    for (const ExrPart& part : parts)
        table += static_cast<std::size_t>(rows(part)) * 8;
    std::string offsets, chunks;
    const std::size_t start = out.size() + table;
    for (std::size_t i = 0; i < parts.size(); ++i)
        for (int y = 0; y < rows(parts[i]); ++y) {
            little(offsets, start + chunks.size(), 8);
            if (parts[i].type == "deepscanline")
                continue;
            if (many)
                little(chunks, i, 4);
            const std::string line = exr_line(parts[i], y);
            little(chunks, static_cast<std::uint32_t>(parts[i].data[1] + y), 4);
            little(chunks, line.size(), 4);
            chunks += line;
        }
    return to_bytes(out + offsets + chunks);
}

std::string floats(const std::vector<float>& values)
{
    std::string out;
    for (const float v : values)
        little(out, std::bit_cast<std::uint32_t>(v), 4);
    return out;
}

Bytes make_hdr(const std::string& resolution, const Bytes& rgbe, const std::string& lines)
{
    Bytes out = to_bytes("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + lines + "\n" + resolution + "\n");
    out.insert(out.end(), rgbe.begin(), rgbe.end());
    return out;
}

std::string temporary_folder()
{
    struct Folders {
        std::vector<fs::path> paths;
        ~Folders()
        {
            std::error_code ignored;
            for (const fs::path& path : paths)
                fs::remove_all(path, ignored);
        }
    };
    static Folders folders;
    std::string name = (fs::temp_directory_path() / "burnish_image_XXXXXX").string();
    if (!mkdtemp(name.data()))
        std::abort();
    folders.paths.emplace_back(name);
    return name;
}

Bytes bytes_of(const std::string& path)
{
    std::ifstream file(path, std::ios::binary);
    return Bytes(std::istreambuf_iterator<char>(file), {});
}

void put(const std::string& path, const Bytes& bytes)
{
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

std::vector<std::string> names_in(const std::string& folder)
{
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

} // namespace burnish::test
