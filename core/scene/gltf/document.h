// What the parts of the glTF reader share while one file is read. Private to core/scene/gltf*.cpp.
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
#include "core/scene/scene.h"

namespace burnish::gltf {

using Json = nlohmann::json;
using Bytes = std::span<const std::uint8_t>;

// Thrown by any part of the reader, caught by load_gltf only, where it becomes an Error.
struct Failure {
    std::string place;  // JSON path or "byte N"
    std::string reason; // one sentence
};
[[noreturn]] void fail(std::string place, std::string reason);

struct BufferData {
    std::vector<std::uint8_t> own; // of a data URI
    Bytes bytes;                   // exactly byteLength long, or empty where the file stores nothing (a placeholder)
    bool present = false;
};

struct Document {
    std::string file;   // as the user gave it
    std::string folder; // external files lie below it; empty: none are allowed
    bool has_folder = false;
    Limits limits;
    Bytes bytes; // the whole file
    Bytes bin;   // BIN chunk of a GLB
    bool has_bin = false, is_glb = false;
    Json json; // checked against the schema before anything is read from it
    std::vector<BufferData> buffers;
    std::map<std::string, std::vector<std::uint8_t>> buffer_files; // by path without links: external buffers
    std::map<int, std::vector<std::uint8_t>> decoded_views;        // by buffer view: EXT_meshopt_compression, decoded
    std::map<int, std::vector<std::uint8_t>> dense_accessors;      // by accessor: sparse ones, made dense
    std::set<int> finite_accessors;                                // searched for NaN already
    std::uint64_t input_bytes = 0;                                 // the file and its external buffers
    std::uint64_t charged_bytes = 0;                               // decoded so far
    std::map<int, int> scene_images,
        scene_textures;                    // of glTF images and textures in use, their place in the scene
    std::uint64_t texture_bytes = 0;       // decoded images in the scene
    int default_material = kNone;          // in the scene, added for primitives without one
    std::vector<std::size_t> node_sources; // by node of the scene, its glTF node
    std::set<std::string> warned;
    Scene scene;

    void warn(const std::string& line); // once per text, one line each
    // What breaks the specification and can be read all the same: a warning, with --strict a Failure.
    void fault(const std::string& place, const std::string& reason);
    // Counts decoded bytes against --limit-accessor-bytes and against what an honest file of this size can
    // hold.
    void charge(std::uint64_t bytes, const std::string& place);
};

// Any text of a file made fit for one line of output, at most 200 bytes of it.
std::string printable(const std::string& text);

// Reading of members whose type the schema check has already ensured.
std::uint64_t get_uint(const Json& object, const char* key, std::uint64_t fallback);
int get_index(const Json& object, const char* key); // -1 where absent
double get_number(const Json& object, const char* key, double fallback);
std::string get_string(const Json& object, const char* key);
const Json* get_member(const Json& object, const char* key);                      // null where absent
const Json* get_extension(const Json& object, const char* name);                  // null where absent
std::size_t table_size(const Json& json, const char* key);                        // of an array, 0 where absent
std::string quoted(const std::string& name, const char* kind, std::size_t index); // mesh 3 "name"

// Whether a list, its words apart by single spaces, has the word.
bool has_word(std::string_view list, std::string_view word);

} // namespace burnish::gltf
