// The options of `--backend reference`.
#pragma once
#include "apps/option_reader.h"
#include "apps/render_options.h"

namespace burnish {

void read_reference(const RenderArguments& in, OptionReader& reader, RenderOptions& out);

} // namespace burnish
