// Pictures of an LTC table, for --preview.
#pragma once
#include "apps/bake/preview.h"
#include "shading/bake/ltc/table.h"

namespace burnish {

// Draws "m00" to "m22", "nD", "fD": each entry from its minimum to its maximum. Rows are theta and, within theta, phi; columns are alpha
// and, within alpha, lambda.
Preview preview_of_ltc(const ltc::Table& table);
Preview names_of_ltc(); // names of preview_of_ltc() without pictures, before a table exists

} // namespace burnish
