#include "apps/pieces/packed.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/file.h"

namespace burnish {

// A line of JSON with the figures and each file's name and size, then the files.
std::vector<std::uint8_t> pack(const Packed& packed)
{
    nlohmann::json head = {{"figures", packed.json}, {"files", nlohmann::json::array()}};
    for (const PackedFile& file : packed.files)
        head["files"].push_back({{"name", file.name}, {"bytes", file.bytes.size()}});
    const std::string line = head.dump() + "\n";
    std::vector<std::uint8_t> bytes(line.begin(), line.end());
    for (const PackedFile& file : packed.files)
        bytes.insert(bytes.end(), file.bytes.begin(), file.bytes.end());
    return bytes;
}

Result<Packed> unpack(const std::vector<std::uint8_t>& bytes, const std::string& file)
{
    const Error damaged = {ExitCode::bad_input, file, "", "is a damaged piece"};
    const auto end = std::find(bytes.begin(), bytes.end(), '\n');
    const nlohmann::json head = nlohmann::json::parse(bytes.begin(), end, nullptr, false);
    if (end == bytes.end() || !head.is_object() || !head.contains("figures") || !head["figures"].is_string() || !head.contains("files") ||
        !head["files"].is_array())
        return damaged;
    Packed packed;
    packed.json = head["figures"].get<std::string>();
    auto at = end + 1;
    for (const nlohmann::json& row : head["files"]) {
        const bool whole = row.is_object() && row.contains("name") && row["name"].is_string() && row.contains("bytes") &&
                           row["bytes"].is_number_unsigned();
        if (!whole || row["bytes"].get<std::uint64_t>() > static_cast<std::uint64_t>(bytes.end() - at))
            return damaged;
        const auto next = at + row["bytes"].get<std::ptrdiff_t>();
        packed.files.push_back({row["name"].get<std::string>(), {at, next}});
        at = next;
    }
    if (at != bytes.end())
        return damaged;
    return packed;
}

Result<std::vector<std::uint8_t>> take_file(const std::string& path)
{
    Result<std::vector<std::uint8_t>> bytes = read_file(path, std::uint64_t{1} << 34);
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    return bytes;
}

} // namespace burnish
