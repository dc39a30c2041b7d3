#include "shading/bake/ltc/shipped.h"

#include <fmt/format.h>

#include "core/base/check.h"

namespace burnish::ltc {
namespace {

const Table& shipped(bool round)
{
    const auto read = [](const EmbeddedFile& file, const char* name, int size) {
        const Result<Table> table = parse_table(reinterpret_cast<const std::uint8_t*>(file.bytes), file.size, name, size);
        BN_CHECK(table);
        return *table;
    };
    static const Table all = read(kShippedFile, "ggx.ltc", kShadingSize);
    static const Table of_round = read(kShippedRoundFile, "ggx_round.ltc", kShadingRoundSize);
    return round ? of_round : all;
}

ShadingTables joined(const Table& all, const Table& round)
{
    ShadingTables tables;
    tables.texels = table_texels(all);
    const std::vector<std::uint16_t> more = table_texels(round);
    const Grid& grid = all.grid;
    tables.record = {grid.root_alpha, static_cast<int>(grid.basis),
                     grid.over_alpha, grid.inverse,
                     grid.sizes()[2], static_cast<int>(tables.texels.size() / 4)};
    tables.texels.insert(tables.texels.end(), more.begin(), more.end());
    return tables;
}

} // namespace

const Table& shipped_table()
{
    return shipped(false);
}

const ShadingTables& shipped_tables()
{
    static const ShadingTables tables = joined(shipped(false), shipped(true));
    return tables;
}

Result<ShadingTables> with_table(const Table& own, const std::string& path)
{
    const int size = own.grid.round ? kShadingRoundSize : kShadingSize;
    if (own.grid.size != size)
        return Error{ExitCode::bad_input, path, "byte 12",
                     fmt::format("has {} nodes along an axis; shading reads tables of {}, round ones of {}", own.grid.size, kShadingSize,
                                 kShadingRoundSize)};
    if (own.grid.round && (own.grid.basis != Basis::tangent || own.grid.over_alpha || own.grid.inverse || !own.grid.root_alpha))
        return Error{ExitCode::bad_input, path, "byte 16", "is a round table whose matrices are held in another way than shading reads"};
    ShadingTables tables = own.grid.round ? joined(shipped(false), own) : joined(own, shipped(true));
    tables.model = own.model();
    return tables;
}

std::vector<std::uint16_t> shipped_texture()
{
    const std::vector<std::uint16_t>& all = shipped_tables().texels;
    constexpr std::size_t kCount = std::size_t{4} * kTextureWidth * kTextureHeight;
    BN_CHECK_OP(static_cast<std::size_t>(shipped_tables().record.round_first) * 4, ==, kCount);
    return {all.begin(), all.begin() + kCount};
}

} // namespace burnish::ltc
