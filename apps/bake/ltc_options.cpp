#include "apps/bake/ltc_options.h"

#include "apps/cli/values.h"

namespace burnish {

std::vector<Option> ltc_options(LtcArguments& to)
{
    return {{"--resolution", "N", "Nodes along each axis of the table, {}", integer(to.resolution, 3, 128), "8, isotropic 64"},
            {"--isotropic", "", "Make a table for round lobes alone, with nodes along theta and alpha", flag(to.isotropic)},
            {"--steps", "N", "Steps of the fit of all entries together, {}; 0 fits each node alone", integer(to.steps, 0, 100)},
            {"--samples", "N", "Lobes in each cell for the fit of all entries, {}", integer(to.samples, 1, 64)},
            {"--fit", "NAME", "Distance that each node's fit minimizes: {} (sliced Wasserstein)", choice(to.norm, {"l1", "l3", "sw"})},
            {"--interpolate", "NAME",
             "Entries to store and interpolate: mirror (matrix relative to the mirror direction), matrix, or inverse",
             choice(to.interpolate, {"mirror", "matrix", "inverse"})},
            {"--no-align", "", "Leave each matrix's rotation as its fit found it, without alignment to its neighbours", flag(to.unaligned)},
            {"--no-symmetry", "", "Fit every node without symmetry constraints", flag(to.unsymmetric)},
            {"--lobes", "N", "Cosines fitted to a lobe in --report, {}; 2 also fits the sum of two where one errs by 0.3 or more",
             choice(to.cosines, std::vector<int>{1, 2})},
            {"--half", "", "Store entries as half floats", flag(to.half)},
            {"--table", "FILE", "Table to measure, instead of making one", file(to.table)},
            {"--report", "FOLDER", "Folder for measurements of the table: quality.json, and charts of quality and resolutions",
             folder(to.report)}};
}

} // namespace burnish
