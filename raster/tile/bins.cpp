#include "raster/tile/bins.h"

#include <algorithm>
#include <cstdlib>

#include "core/base/check.h"

namespace burnish {

namespace {
// Tiles in one row that a large triangle may touch, by the sides of its edges. A diagonal sliver touches few tiles in its bounding box.
class TileRows {
  public:
    TileRows(const FrameParams& f, const std::int32_t x[3], const std::int32_t y[3])
    {
        const std::int64_t area = std::int64_t{x[1] - x[0]} * (y[2] - y[0]) - std::int64_t{x[2] - x[0]} * (y[1] - y[0]);
        const std::int64_t side = f.tile_step * kSubpixel / 16, rim = f.tile_rim * kSubpixel / 16; // units: see TileTriangle
        for (int i = 0; i < 3; ++i) {
            const int p = (i + 1) % 3, q = (i + 2) % 3, sign = area > 0 ? 1 : -1;
            const std::int64_t a = sign * std::int64_t{y[p] - y[q]}, b = sign * std::int64_t{x[q] - x[p]};
            const bool top_left = a > 0 || (a == 0 && b > 0);
            const std::int64_t at = a * (-f.center_x - x[p]) + b * (-f.center_y - y[p]) - (top_left ? 0 : 1);
            greatest_[i] =
                (at >> 4) + (std::max<std::int64_t>(a, 0) + std::max<std::int64_t>(b, 0)) * (side - 1) + (std::abs(a) + std::abs(b)) * rim;
            step_x_[i] = a * side, step_y_[i] = b * side;
        }
    }
    // Narrows [first, last], tiles in row `y`.
    void narrow(std::int64_t y, std::int64_t& first, std::int64_t& last) const
    {
        for (int i = 0; i < 3; ++i) {
            const std::int64_t at = greatest_[i] + y * step_y_[i]; // x must satisfy at + x * step_x_ >= 0
            if (step_x_[i] > 0 && at < 0)
                first = std::max(first, (-at + step_x_[i] - 1) / step_x_[i]);
            else if (step_x_[i] < 0)
                last = at < 0 ? -1 : std::min(last, at / -step_x_[i]);
            else if (step_x_[i] == 0 && at < 0)
                last = -1;
        }
    }

  private:
    std::int64_t greatest_[3], step_x_[3], step_y_[3]; // greatest edge values in a tile; steps by tile
};

// Chunks are large enough that their per-tile ends stay few beside their triangles, and many enough to share evenly.
constexpr std::size_t kMinClusters = 16, kChunks = 64, kChunksAThread = 4;
} // namespace

void Bins::Chunk::make_room()
{
    // Grows a column, and keeps its first elements. Pages that nothing writes stay untouched.
    const auto grow = [](auto& column, std::size_t kept, std::size_t size) {
        column.resize_for_overwrite(kept);
        column.resize_for_overwrite(size);
    };
    const auto more = [](std::size_t size, std::uint32_t count) { return std::max<std::size_t>(2 * size, count + kGrowRoom); };
    if (output.count + kGrowRoom > entries.size()) {
        const std::size_t size = more(entries.size(), output.count);
        grow(entries, output.count, size), grow(runs, output.run_count, size);
    }
    if (output.piece_count + kGrowRoom > pieces.size())
        grow(pieces, output.piece_count, more(pieces.size(), output.piece_count));
    output.entries = entries.data(), output.runs = runs.data(), output.pieces = pieces.data();
    output.capacity = static_cast<std::uint32_t>(entries.size());
    output.piece_capacity = static_cast<std::uint32_t>(pieces.size());
}

void Bins::Chunk::sort_by_tile(const FrameParams& f)
{
    // Describe the edges of large triangles
    const auto rows_of = [&](std::uint32_t entry) {
        if (entry & kClippedEntry) {
            const TriangleSetup& piece = pieces[entry & ~kClippedEntry].setup;
            return TileRows(f, piece.x, piece.y);
        }
        std::int32_t x[3], y[3];
        for (std::size_t k = 0; k < 3; ++k) {
            const SnappedVertex& v = f.vertices[f.indices[3 * std::size_t{entry} + k]];
            x[k] = v.x, y[k] = v.y;
        }
        return TileRows(f, x, y);
    };
    const std::size_t tiles = static_cast<std::size_t>(f.tiles_x) * static_cast<std::size_t>(f.tiles_y);
    tile_begin.clear();
    tile_begin.resize(tiles + 1);
    const std::uint32_t row = static_cast<std::uint32_t>(f.tiles_x);
    // Calls visit(tile, first entry, entries). Entries are consecutive within a tile.
    const auto each_tile = [&](const auto& visit) {
        std::uint32_t end = 0;
        for (std::uint32_t k = 0; k < output.run_count; ++k) {
            const TileRun& run = runs[k];
            const std::uint32_t begin = end, x0 = run.first_tile & 0xffff, x1 = run.last_tile & 0xffff;
            const std::uint32_t y0 = run.first_tile >> 16, y1 = run.last_tile >> 16;
            end += run.count;
            const std::uint32_t kFew = 6; // skip the edge tests for fewer tiles
            if ((x1 - x0 + 1) * (y1 - y0 + 1) < kFew || x0 == x1 || y0 == y1) {
                for (std::uint32_t y = y0; y <= y1; ++y)
                    for (std::uint32_t x = x0; x <= x1; ++x)
                        visit(y * row + x, begin, run.count);
                continue;
            }
            for (std::uint32_t i = begin; i < end; ++i) {
                const TileRows rows = rows_of(entries[i]);
                for (std::uint32_t y = y0; y <= y1; ++y) {
                    std::int64_t from = x0, to = x1;
                    rows.narrow(y, from, to);
                    for (std::int64_t x = from; x <= to; ++x)
                        visit(y * row + static_cast<std::uint32_t>(x), i, 1);
                }
            }
        }
    };
    // Count entries per tile, sum the counts, then copy the entries
    each_tile([&](std::uint32_t tile, std::uint32_t, std::uint32_t n) { tile_begin[tile] += n; });
    std::uint64_t sum = 0;
    for (std::size_t t = 0; t <= tiles; ++t) {
        const std::uint32_t count = tile_begin[t];
        tile_begin[t] = static_cast<std::uint32_t>(sum);
        sum += count;
        BN_CHECK_OP(sum, <=, 0xffffffffu);
    }
    list.resize_for_overwrite(0);
    list.resize_for_overwrite(sum);
    each_tile([&](std::uint32_t tile, std::uint32_t from, std::uint32_t n) {
        std::copy_n(entries.data() + from, n, list.data() + tile_begin[tile]);
        tile_begin[tile] += n;
    });
    for (std::size_t t = tiles; t > 0; --t) // every begin has moved to its end, which is the next begin
        tile_begin[t] = tile_begin[t - 1];
    tile_begin[0] = 0;
}

void Bins::build(const FrameParams& f, const DrawTables& tables, const Visible& visible, const TileFns& fns, const Jobs& jobs,
                 Profiler* profiler)
{
    const TraceSpan span("setup and bin");
    const std::size_t clusters = visible.clusters.size();
    const std::size_t most = std::max(kChunks, kChunksAThread * static_cast<std::size_t>(jobs.threads()));
    const std::size_t per_chunk = std::max(kMinClusters, (clusters + most - 1) / most);
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

void Bins::Chunk::sort_by_part(const FrameParams& frame, const FrameParams& parts, const std::vector<std::uint32_t>& tiles,
                               const TileFns& fns)
{
    constexpr std::uint32_t kSide = TilePart::kSide, kParts = kSide * kSide;
    part_begin.clear(), part_list.clear();
    part_begin.push_back(0);
    std::uint32_t end = 0;
    for (const std::uint32_t tile : tiles) {
        const std::uint32_t* const of_tile = list.data() + tile_begin[tile];
        const std::uint32_t count = tile_begin[tile + 1] - tile_begin[tile];
        const int left = static_cast<int>(tile) % frame.tiles_x * frame.tile_step,
                  top = static_cast<int>(tile) / frame.tiles_x * frame.tile_step;
        if (first_part.size() < count + kColumnPad)
            first_part.resize(count + kColumnPad), last_part.resize(count + kColumnPad);
        fns.touch_tiles(parts, left, top, of_tile, count, first_part.data(), last_part.data());
        const auto each_part = [&](const auto& visit) {
            for (std::uint32_t i = 0; i < count; ++i) {
                const std::uint32_t first = first_part[i], last = last_part[i];
                for (std::uint32_t y = first >> 16; y <= last >> 16; ++y)
                    for (std::uint32_t x = first & 0xffff; x <= (last & 0xffff); ++x)
                        visit(i, y * kSide + x);
            }
        };
        std::uint32_t at[kParts] = {};
        each_part([&](std::uint32_t, std::uint32_t part) { ++at[part]; });
        for (std::uint32_t part = 0; part < kParts; ++part) {
            const std::uint32_t begin = end;
            end += at[part];
            part_begin.push_back(end);
            at[part] = begin;
        }
        part_list.resize(end);
        each_part([&](std::uint32_t i, std::uint32_t part) { part_list[at[part]++] = of_tile[i]; });
    }
}

void Bins::cut(const FrameParams& frame, const FrameParams& parts, const std::vector<std::uint32_t>& tiles, const TileFns& fns,
               const Jobs& jobs)
{
    if (!tiles.empty())
        jobs.parallel_for(used_, [&](std::size_t i, int) { chunks_[i]->sort_by_part(frame, parts, tiles, fns); });
}

std::vector<std::uint32_t> Bins::triangles_by_tile(std::size_t tiles) const
{
    std::vector<std::uint32_t> counts(tiles);
    for (std::size_t i = 0; i < used_; ++i) {
        const std::uint32_t* begin = chunks_[i]->tile_begin.data();
        for (std::size_t t = 0; t < tiles; ++t)
            counts[t] += begin[t + 1] - begin[t];
    }
    return counts;
}

std::span<const std::uint32_t> Bins::Chunk::entries_of(const TilePart& part) const
{
    const bool whole = part.cut < 0;
    const std::uint32_t* begin =
        whole ? tile_begin.data() + part.tile : part_begin.data() + part.cut * TilePart::kSide * TilePart::kSide + part.part;
    return {(whole ? list.data() : part_list.data()) + begin[0], begin[1] - begin[0]};
}

std::size_t Bins::triangles_in(const TilePart& part) const
{
    std::size_t count = 0;
    for (std::size_t i = 0; i < used_; ++i)
        count += chunks_[i]->entries_of(part).size();
    return count;
}

std::size_t Bins::gather(const TilePart& part, std::uint32_t* entries, TriangleSetup* triangles, Column<ClipRecord>& clips) const
{
    std::size_t to = 0, pieces = 0;
    for (std::size_t i = 0; i < used_; ++i) {
        const std::span<const std::uint32_t> of_chunk = chunks_[i]->entries_of(part);
        if (chunks_[i]->output.piece_count == 0) {
            std::copy(of_chunk.begin(), of_chunk.end(), entries + to);
            to += of_chunk.size();
            continue;
        }
        for (const std::uint32_t entry : of_chunk) {
            const std::size_t at = to++;
            entries[at] = entry;
            if (!(entry & kClippedEntry))
                continue;
            const ClippedPiece& piece = chunks_[i]->pieces[entry & ~kClippedEntry];
            if (pieces == clips.size())
                clips.resize(2 * pieces + kGrowRoom);
            triangles[at] = piece.setup;
            triangles[at].vertex[0] = static_cast<std::int32_t>(pieces);
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
