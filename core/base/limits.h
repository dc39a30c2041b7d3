// Every limit on untrusted input, in one place. Each can be raised by the option named beside it.
#pragma once
#include <cstdint>

namespace burnish {

struct Limits {
    int image_side = 16384;                      // pixels, --limit-image-side
    std::uint64_t image_pixels = 1ull << 28;     // of one picture; as many as the sides allow
    std::uint64_t texture_bytes = 4ull << 30;    // decoded textures of one scene, --limit-texture-bytes
    int json_depth = 64;                         // nesting, --limit-json-depth
    int node_depth = 256;                        // scene graph, --limit-node-depth
    std::uint64_t file_bytes = 2ull << 30;       // one input file, --limit-file-bytes
    std::uint64_t input_bytes = 4ull << 30;      // all files of one scene, --limit-input-bytes
    std::uint64_t env_pixels = 64ull << 20;      // of the environment, --limit-env-pixels
    std::uint64_t accessor_bytes = 2ull << 30;   // decoded accessors of one scene in total, --limit-accessor-bytes
    std::uint64_t data_uri_bytes = 512ull << 20; // one data URI, --limit-data-uri-bytes
    std::uint64_t draw_bytes = 8ull << 30;       // vertices and triangles with every instance expanded, --limit-draw-bytes
    int area_lights = 256;                       // of a scene, --limit-lights
    bool strict = false;                         // refuse what breaks glTF 2.0 in any way, --strict
    bool uris_outside = false;                   // external files outside the scene's folder, --allow-outside-uris
};

} // namespace burnish
