// Built-in tables of transformed cosines: shading/bake/ltc/*.ltc, embedded at build time. Also the data that shading reads from these or
// from other tables.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/embedded.h"
#include "shading/bake/ltc/table.h"
#include "shading/lang/records.h"

namespace burnish {
extern const EmbeddedFile kShippedFile, kShippedRoundFile;
}

namespace burnish::ltc {

struct ShadingTables {
    std::vector<std::uint16_t> texels; // table_texels() of the general table, then of the round table
    LtcTableRecord record;
    Model model = Model::ggx; // model of the lobes
};
const ShadingTables& shipped_tables(); // made once a process
const Table& shipped_table();          // the general table
// The general table as a texture of RGBA halves, in rows: table_texels().
inline constexpr int kTextureWidth = 192, kTextureHeight = 88;
std::vector<std::uint16_t> shipped_texture();
// Replaces the built-in table of the same kind with `own`. Errors: another resolution, or another storage in a round table, than shading
// reads. path: the file in the error.
Result<ShadingTables> with_table(const Table& own, const std::string& path);

} // namespace burnish::ltc
