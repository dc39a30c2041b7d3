// The tables of transformed cosines that are part of the program, shading/bake/ltc/*.ltc with their bytes as they were when it was built,
// and what shading reads of them or of others.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "shading/bake/ltc/table.h"
#include "shading/lang/records.h"

namespace burnish::ltc {

extern const std::uint32_t kShippedWords[], kShippedRoundWords[]; // of the files, little-endian
extern const std::size_t kShippedBytes, kShippedRoundBytes;       // multiples of 4

struct ShadingTables {
    std::vector<std::uint16_t> texels; // table_texels() of the table of all lobes, then of that of round ones
    LtcTableRecord record;
};
const ShadingTables& shipped_tables(); // made once a process
// `own` in place of the one of its kind. Of another resolution than shading reads: an Error, whose file is `path`.
Result<ShadingTables> with_table(const Table& own, const std::string& path);

} // namespace burnish::ltc
