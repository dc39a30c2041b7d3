// Tables of transformed cosines as arrays of NumPy (.npy): matrices by [alpha][lambda][theta][phi], row by row, from the cosine's space to
// the lobe's. Source: KT, Heitz, Dupuy, Narayanan 2022, "Bringing Linearly Transformed Cosines to Anisotropic GGX".
#pragma once
#include <cstdint>
#include <string>

#include "core/base/result.h"
#include "shading/bake/ltc/table.h"

namespace burnish::ltc {

bool is_npy(const std::uint8_t* data, std::size_t bytes);

// Reads n x n x n x n x 3 x 3 floats or doubles, in C order. Nodes are even in alpha and in the ratio of the widths. Such files hold no
// albedos, so the built-in table's albedos are taken. A mirrored matrix, which has the same density, gets a positive determinant, and a
// matrix without determinant becomes the first-order one. size: required number of nodes along an axis, 0: any. Errors: ExitCode::bad_input
// with the place in the file.
Result<Table> parse_npy(const std::uint8_t* data, std::size_t bytes, const std::string& path, int size);

} // namespace burnish::ltc
