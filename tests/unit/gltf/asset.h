// Small glTF assets for tests, and conditions that every loaded scene must satisfy.
#pragma once
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/limits.h"
#include "core/base/result.h"
#include "core/scene/scene.h"
#include "tests/unit/data.h"
#include "tests/unit/temp_folder.h"

namespace burnish::test {

using ByteVector = std::vector<std::uint8_t>;

template <class T> ByteVector bytes_of(const std::vector<T>& values)
{
    ByteVector bytes(values.size() * sizeof(T));
    if (!bytes.empty())
        std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}
inline ByteVector floats(const std::vector<float>& values)
{
    return bytes_of(values);
}

std::string base64(const ByteVector& bytes);

inline constexpr int kI8 = 5120, kU8 = 5121, kI16 = 5122, kU16 = 5123, kU32 = 5125, kF32 = 5126;

struct Asset {
    ByteVector bin; // a single buffer
    std::vector<std::string> views, accessors;
    std::string attributes; // of the single primitive: members of the JSON object
    std::string primitive;  // further members of the primitive, each after a comma
    std::string node;       // further members of the single node, each after a comma
    std::string more;       // further top-level members, each after a comma
    std::string nodes;      // replaces the nodes and scenes, each after a comma

    // Each function returns the index of the added object. `extra`: members, each after a comma.
    int view(const ByteVector& data, const std::string& extra = "");
    int accessor(const ByteVector& data, int component, const std::string& type, std::size_t count, const std::string& extra = "",
                 const std::string& view_extra = "");
    void attribute(const std::string& name, int accessor);

    std::string json(const std::string& buffer_uri_member) const;
    std::string gltf() const; // the buffer as a data URI
    ByteVector glb() const;
};

// Returns a triangle (0,0,0) (1,0,0) (0,1,0) with positions alone.
Asset triangle();

Result<Scene> load(const Asset& asset, const Limits& limits = {});
Result<Scene> load_text(const std::string& gltf, const Limits& limits = {});
std::string error_of(const Result<Scene>& result); // "place: reason", or "" for success

// Fails the test where a table of the scene is inconsistent: ranges, finiteness, unit vectors.
void expect_sound(const Scene& scene);

ByteVector read_bytes(const std::string& path);

} // namespace burnish::test
