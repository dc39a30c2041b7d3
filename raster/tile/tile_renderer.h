// The tile renderer: SIMD, multithreaded, MSAA. Its pixels are a function of version, scene and options alone.
#pragma once
#include <memory>
#include <string>

#include "raster/frame/frame.h"

namespace burnish {

Isa best_isa();                                   // what this processor and operating system can run, at most BN_FORCE_ISA
bool isa_available(Isa isa);
Result<Isa> parse_isa(const std::string& name);   // "scalar", "avx2", "avx512"
const char* isa_name(Isa isa);

std::unique_ptr<Renderer> make_tile_renderer(const RenderInput& input, Isa isa);

} // namespace burnish
