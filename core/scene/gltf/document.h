// Shared state of the glTF reader while it reads one file. Private to core/scene/gltf.
#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/limits.h"
#include "core/jobs/jobs.h"
#include "core/scene/scene.h"

namespace burnish::gltf {

using Json = nlohmann::json;
using Bytes = std::span<const std::uint8_t>;

// Thrown by any part of the reader. guarded() in gltf.cpp catches it and makes an Error.
struct Failure {
    std::string place;  // JSON path or "byte N"
    std::string reason; // one sentence
};
[[noreturn]] void fail(std::string place, std::string reason);

struct BufferData {
    std::vector<std::uint8_t> own; // bytes of a data URI
    Bytes bytes;                   // exactly byteLength long; empty for a placeholder without stored bytes
    bool present = false;
};

struct DecodedImage {
    Image image;
    std::vector<std::string> warnings; // of PictureNotes
};

struct Document {
    std::string file;   // as the user gave it
    std::string folder; // external files lie below it; empty: external files are refused
    bool has_folder = false;
    Limits limits;
    const Jobs* jobs = nullptr; // null: the calling thread alone
    Bytes bytes;                // the whole file
    Bytes bin;                  // BIN chunk of a GLB
    bool has_bin = false, is_glb = false;
    Json json; // checked against the schema before any read
    std::vector<BufferData> buffers;
    std::map<std::string, std::vector<std::uint8_t>> buffer_files; // by path without links: external buffers
    std::map<int, std::vector<std::uint8_t>> decoded_views;        // by buffer view: decoded EXT_meshopt_compression
    std::map<int, std::vector<std::uint8_t>> dense_accessors;      // by accessor: sparse accessors made dense
    std::set<int> finite_accessors;                                // already searched for NaN
    std::uint64_t input_bytes = 0;                                 // the file and its external buffers
    std::uint64_t charged_bytes = 0;                               // decoded so far
    std::map<int, std::vector<std::uint8_t>> image_files;          // by image: encoded bytes that lie in no buffer, until they are decoded
    std::map<int, DecodedImage> decoded_images;                    // by image: decoded, and not in the scene yet
    std::map<int, int> scene_images,
        scene_textures;                    // scene indices of the glTF images and textures in use
    std::uint64_t texture_bytes = 0;       // decoded images in the scene
    int default_material = kNone;          // scene index; added for primitives without a material
    std::vector<std::size_t> node_sources; // glTF node of each scene node
    std::set<std::string> warned;
    Scene scene;

    void warn(const std::string& line); // once for each text, one line each
    // Reports a breach of the specification that can be repaired: a warning, or a Failure with Limits::strict.
    void fault(const std::string& place, const std::string& reason);
    // Counts decoded bytes against Limits::accessor_bytes, and against the most that an honest file of this size can
    // hold.
    void charge(std::uint64_t bytes, const std::string& place);
};

// Returns text from a file as one printable line with at most 200 bytes.
std::string printable(const std::string& text);

// Getters for members whose types the schema check has ensured.
std::uint64_t get_uint(const Json& object, const char* key, std::uint64_t fallback);
int get_index(const Json& object, const char* key); // -1 where absent
double get_number(const Json& object, const char* key, double fallback);
std::string get_string(const Json& object, const char* key);
const Json* get_member(const Json& object, const char* key);                      // null where absent
const Json* get_extension(const Json& object, const char* name);                  // null where absent
std::size_t table_size(const Json& json, const char* key);                        // array length, 0 where absent
std::string quoted(const std::string& name, const char* kind, std::size_t index); // returns mesh 3 "name"

// Returns true where `word` is in `list`, a list of words with single spaces.
bool has_word(std::string_view list, std::string_view word);

} // namespace burnish::gltf
