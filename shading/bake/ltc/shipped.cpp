#include "shading/bake/ltc/shipped.h"

#include "core/base/check.h"

namespace burnish::ltc {

const ShadingTable& shipped_table()
{
    static const ShadingTable shipped = [] {
        const Result<Table> table = parse_table(reinterpret_cast<const std::uint8_t*>(kShippedWords), kShippedBytes, "ggx.ltc", 8);
        BN_CHECK(table);
        return ShadingTable{table_texels(*table), table->grid.root_alpha, static_cast<int>(table->grid.basis)};
    }();
    return shipped;
}

} // namespace burnish::ltc
