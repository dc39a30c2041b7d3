// A table of transformed cosines as a file and in memory.
//
// The file, little-endian: 8 bytes "bnltc01\n"; uint32 version (2), nodes along an axis, flags, channels (11), Grid::beyond, 0; the
// entries; uint64 xxHash64 of all before. Flags: kRootAlpha, kOverAlpha, kRound, kInverse and the basis as Grid has them; kHalf; what the
// table was made with (BakeOptions). Entries go by theta, phi, alpha, lambda, the last one fastest; each holds the matrix row by row, then
// nD and fD, as float32 or, with kHalf, as IEEE halves (both to nearest even). See Grid for where nodes lie and for what of a matrix is
// held; its third column is a unit vector. The matrix takes the cosine's space to the lobe's. nD: directional albedo of the lobe where
// Fresnel is 1; fD: where it is (1 - v.h)^5: reflectance is f0 nD + (f90 - f0) fD.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "shading/bake/ltc/grid.h"

namespace burnish::ltc {

inline constexpr std::uint32_t kTableVersion = 2, kRootAlpha = 1, kHalf = 2, kBasisShift = 2, kBasisMask = 3u << kBasisShift,
                               kOverAlpha = 16, kRound = 32, kInverse = 64;
// What a table was made with: BakeOptions::norm, what was left out, and the lobes' Model.
inline constexpr std::uint32_t kNormShift = 8, kNormMask = 3u << kNormShift, kUnaligned = 1u << 10, kUnsymmetric = 1u << 11,
                               kLobeShift = 12, kLobeMask = 3u << kLobeShift;
inline constexpr std::size_t kChannels = 11;
inline constexpr int kLeastSize = 2, kMostSize = 32, kMostRoundSize = 256;

struct Table {
    Grid grid;
    std::uint32_t made = 0;     // flags of what it was made with
    std::vector<float> entries; // [theta][phi][alpha][lambda][kChannels]
    Model model() const { return static_cast<Model>((made & kLobeMask) >> kLobeShift); }
};

// Rounded to what the file holds, so that what is measured is what is shipped.
Table make_table(const Grid& grid, const std::vector<Matrix>& entries, const std::vector<Albedo>& albedos, std::uint32_t made = 0);

struct Looked {
    Matrix m; // of a lobe, its third column nearly unit
    double all, grazing;
};
Looked lookup(const Table& table, const Place& place);

// What shading/lights/ltc_table.k.h reads of a table: planes of RGBA halves by [theta][phi][alpha][lambda], which hold the channels in turn
// and a 0. It has 8 nodes along an axis. Of a round table, of 64: m00, m11, m20, m02; m22, nD, fD, 0.
inline constexpr int kShadingSize = 8, kShadingRoundSize = 64;
std::vector<std::uint16_t> table_texels(const Table& table);

std::vector<std::uint8_t> table_bytes(const Table& table, bool half = false);

// `size`: nodes along an axis that are asked for, 0: any. What is damaged, not finite or without a positive determinant is refused.
Result<Table> parse_table(const std::uint8_t* data, std::size_t bytes, const std::string& path, int size);
Result<Table> read_table(const std::string& path, int size);
Status write_table(const std::string& path, const Table& table, bool half = false);

} // namespace burnish::ltc
