#include "raster/tile/bins.h"

#include <algorithm>

#include "core/base/check.h"

namespace burnish {

namespace {
// Chunks are large enough that their lists' ends by tile stay few beside their triangles, and many enough to share evenly.
constexpr std::size_t kMinClusters = 16, kMaxChunks = 256;
} // namespace

void Bins::Chunk::make_room()
{
    const auto grow = [](auto& column, std::uint32_t count) {
        column.resize(std::max<std::size_t>(2 * column.size(), count + kGrowRoom));
    };
    if (output.count + kGrowRoom > entries.size()) {
        grow(entries, output.count);
        first_tile.resize(entries.size()), last_tile.resize(entries.size());
    }
    if (output.piece_count + kGrowRoom > pieces.size())
        grow(pieces, output.piece_count);
    output.entries = entries.data(), output.first_tile = first_tile.data(), output.last_tile = last_tile.data();
    output.pieces = pieces.data();
    output.capacity = static_cast<std::uint32_t>(entries.size());
    output.piece_capacity = static_cast<std::uint32_t>(pieces.size());
}

void Bins::Chunk::sort_by_tile(const FrameParams& f)
{
    const std::size_t tiles = static_cast<std::size_t>(f.tiles_x) * static_cast<std::size_t>(f.tiles_y);
    tile_begin.clear();
    tile_begin.resize(tiles + 1);
    const auto each_tile = [&](std::uint32_t i, const auto& visit) {
        const std::uint32_t first = first_tile[i], last = last_tile[i];
        if (first == last) { // most of many
            visit((first >> 16) * static_cast<std::uint32_t>(f.tiles_x) + (first & 0xffff));
            return;
        }
        for (std::uint32_t y = first >> 16; y <= last >> 16; ++y)
            for (std::uint32_t x = first & 0xffff; x <= (last & 0xffff); ++x)
                visit(y * static_cast<std::uint32_t>(f.tiles_x) + x);
    };
    for (std::uint32_t i = 0; i < output.count; ++i)
        each_tile(i, [&](std::uint32_t tile) { ++tile_begin[tile]; });
    std::uint64_t sum = 0;
    for (std::size_t t = 0; t <= tiles; ++t) {
        const std::uint32_t count = tile_begin[t];
        tile_begin[t] = static_cast<std::uint32_t>(sum);
        sum += count;
        BN_CHECK_OP(sum, <=, 0xffffffffu);
    }
    list.resize(sum);
    for (std::uint32_t i = 0; i < output.count; ++i)
        each_tile(i, [&](std::uint32_t tile) { list[tile_begin[tile]++] = entries[i]; });
    for (std::size_t t = tiles; t > 0; --t) // every begin has moved to its end, the next one's begin
        tile_begin[t] = tile_begin[t - 1];
    tile_begin[0] = 0;
}

void Bins::build(const FrameParams& f, const DrawTables& tables, const Visible& visible, const TileFns& fns, const Jobs& jobs,
                 Profiler* profiler)
{
    const TraceSpan span("setup and bin");
    const std::size_t clusters = visible.clusters.size();
    const std::size_t per_chunk = std::max(kMinClusters, (clusters + kMaxChunks - 1) / kMaxChunks);
    used_ = (clusters + per_chunk - 1) / per_chunk;
    while (chunks_.size() < used_)
        chunks_.push_back(std::make_unique<Chunk>());
    jobs.parallel_for(used_, [&](std::size_t i, int worker) {
        ProfiledWork work(profiler, worker);
        Chunk& c = *chunks_[i];
        c.output = {};
        c.output.owner = &c;
        c.output.grow = [](ChunkOutput* self) { static_cast<Chunk*>(self->owner)->make_room(); };
        c.make_room();
        for (std::size_t k = i * per_chunk; k < std::min(clusters, (i + 1) * per_chunk); ++k) {
            const Cluster& cluster = tables.clusters[visible.clusters[k]];
            fns.bin_triangles(f, cluster.first_triangle, cluster.triangle_count, c.output);
            work.count(FrameStage::setup, cluster.triangle_count);
        }
        work.lap(FrameStage::setup);
        c.sort_by_tile(f);
        work.lap(FrameStage::bin);
    });
}

std::size_t Bins::triangles_in(std::size_t tile) const
{
    std::size_t count = 0;
    for (std::size_t i = 0; i < used_; ++i)
        count += chunks_[i]->tile_begin[tile + 1] - chunks_[i]->tile_begin[tile];
    return count;
}

std::size_t Bins::gather_tile(std::size_t tile, std::uint32_t* entries, TriangleSetup* triangles, Column<ClipRecord>& clips) const
{
    std::size_t to = 0, pieces = 0;
    for (std::size_t i = 0; i < used_; ++i) {
        const Chunk& c = *chunks_[i];
        for (std::uint32_t k = c.tile_begin[tile]; k < c.tile_begin[tile + 1]; ++k, ++to) {
            entries[to] = c.list[k];
            if (!(entries[to] & kClippedEntry))
                continue;
            const ClippedPiece& piece = c.pieces[entries[to] & ~kClippedEntry];
            if (pieces == clips.size())
                clips.resize(2 * pieces + kGrowRoom);
            triangles[to] = piece.setup;
            triangles[to].vertex[0] = static_cast<std::int32_t>(pieces);
            clips[pieces++] = piece.record;
        }
    }
    return pieces;
}

std::uint64_t Bins::triangle_count() const
{
    std::uint64_t n = 0;
    for (std::size_t i = 0; i < used_; ++i)
        n += chunks_[i]->output.count;
    return n;
}

} // namespace burnish
