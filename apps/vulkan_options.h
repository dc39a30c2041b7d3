// The options of `--backend vulkan`.
#pragma once
#include "apps/option_reader.h"
#include "apps/render_options.h"

namespace burnish {

void read_vulkan(const RenderArguments& in, OptionReader& reader, RenderOptions& out);

} // namespace burnish
