// A table of transformed cosines in memory and as a file.
//
// The file, little-endian: 8 bytes "bnltc01\n"; uint32 version (2), nodes along an axis, flags, channels (11), Grid::beyond, 0; the
// entries; uint64 xxHash64 of all bytes before. Flags: kRootAlpha, kOverAlpha, kRound, kInverse and the basis as in Grid; kHalf; options of
// the bake (BakeOptions). Entries are ordered by theta, phi, alpha, lambda, the last one fastest. An entry holds the matrix row by row,
// then nD and fD, as float32 or, with kHalf, as IEEE halves (both rounded to nearest even). Grid tells where nodes lie and how a matrix is
// stored; its third column is a unit vector. The matrix takes the cosine's space to the lobe's. nD: the lobe's directional albedo with
// Fresnel 1; fD: with Fresnel (1 - v.h)^5. Reflectance is f0 nD + (f90 - f0) fD.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "shading/bake/ltc/grid.h"

namespace burnish::ltc {

inline constexpr std::uint32_t kTableVersion = 2, kRootAlpha = 1, kHalf = 2, kBasisShift = 2, kBasisMask = 3u << kBasisShift,
                               kOverAlpha = 16, kRound = 32, kInverse = 64;
// Options of the bake: BakeOptions::norm, omitted steps, and the lobes' Model.
inline constexpr std::uint32_t kNormShift = 8, kNormMask = 3u << kNormShift, kUnaligned = 1u << 10, kUnsymmetric = 1u << 11,
                               kLobeShift = 12, kLobeMask = 3u << kLobeShift;
inline constexpr std::size_t kChannels = 11;
inline constexpr int kLeastSize = 2, kMostSize = 32, kMostRoundSize = 256;

struct Table {
    Grid grid;
    std::uint32_t made = 0;     // option flags of the bake
    std::vector<float> entries; // [theta][phi][alpha][lambda][kChannels]
    Model model() const { return static_cast<Model>((made & kLobeMask) >> kLobeShift); }
};

// Makes a table, rounded to the file's precision, so that measurements apply to shipped tables.
Table make_table(const Grid& grid, const std::vector<Matrix>& entries, const std::vector<Albedo>& albedos, std::uint32_t made = 0);

struct Looked {
    Matrix m; // of a lobe, third column nearly unit
    double all, grazing;
};
Looked lookup(const Table& table, const Place& place);

// Converts a table for shading/lights/ltc_table.k.h: planes of RGBA halves by [theta][phi][alpha][lambda], which hold the channels in turn
// and a 0. The table must have 8 nodes along an axis. A round table has 64, and channels m00, m11, m20, m02; m22, nD, fD, 0.
inline constexpr int kShadingSize = 8, kShadingRoundSize = 64;
std::vector<std::uint16_t> table_texels(const Table& table);

std::vector<std::uint8_t> table_bytes(const Table& table, bool half = false);

// Parses a table, or an array of NumPy (npy.h). size: required number of nodes along an axis, 0: any. Of tables, refuses damage, values
// that are not finite, and matrices without positive determinant.
Result<Table> parse_table(const std::uint8_t* data, std::size_t bytes, const std::string& path, int size);
Result<Table> read_table(const std::string& path, int size);
Status write_table(const std::string& path, const Table& table, bool half = false);

} // namespace burnish::ltc
