// The tables of transformed cosines that are part of the program, shading/bake/ltc/*.ltc with their bytes as they were when it was built,
// and what shading reads of them or of others.
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
    std::vector<std::uint16_t> texels; // table_texels() of the table of all lobes, then of that of round ones
    LtcTableRecord record;
    Model model = Model::ggx; // whose lobes they are
};
const ShadingTables& shipped_tables(); // made once a process
const Table& shipped_table();          // of all lobes
// `own` in place of the one of its kind. Of another resolution than shading reads: an Error, whose file is `path`.
Result<ShadingTables> with_table(const Table& own, const std::string& path);

} // namespace burnish::ltc
