// Every limit on untrusted input. The option beside a limit raises it.
#pragma once
#include <cstdint>

namespace burnish {

// Sizes in 32 bits cannot overflow below these limits: WebAssembly gets an eighth of them.
inline constexpr int kLessBits = sizeof(void*) < 8 ? 3 : 0;

struct Limits {
    int image_side = 16384;                                    // pixels
    std::uint64_t image_pixels = 1ull << (28 - kLessBits);     // of one image; by default as many as the sides allow
    std::uint64_t texture_bytes = 4ull << (30 - kLessBits);    // one scene's decoded textures
    int json_depth = 64;                                       // nesting
    int node_depth = 256;                                      // scene graph
    std::uint64_t file_bytes = 2ull << (30 - kLessBits);       // one input file
    std::uint64_t input_bytes = 4ull << (30 - kLessBits);      // all files of one scene
    std::uint64_t env_pixels = 64ull << (20 - kLessBits);      // the environment
    std::uint64_t accessor_bytes = 2ull << (30 - kLessBits);   // one scene's decoded accessors
    std::uint64_t data_uri_bytes = 512ull << (20 - kLessBits); // one data URI
    std::uint64_t draw_bytes = 8ull << (30 - kLessBits);       // vertices and triangles with all instances expanded
    int area_lights = 256;                                     // in one scene
    bool strict = false;                                       // refuse every breach of glTF 2.0
    bool uris_outside = false;                                 // external files outside the scene's folder
};

} // namespace burnish
