// `burnish train`: trains nets that make mipmaps.
#include <fmt/core.h>
#include <memory>

#include "apps/cli/command.h"
#include "apps/cli/outputs.h"
#include "apps/cli/report.h"
#include "apps/cli/shared_options.h"
#include "apps/cli/values.h"
#include "apps/lab/train/arguments.h"
#include "apps/pieces/pieces.h"

namespace burnish {
namespace {

constexpr const char* kFooter =
    R"(mip: a cascade of two nets that makes mipmaps of normals and anisotropic widths. Each level looks like level 0 from afar (MIPNet, Gauthier
et al. 2022). Training uses materials made in code: tiles of 32 x 32 texels, lit from random directions at full detail and averaged. Every
level is compared with them as a display shows it. Layout cov starts from a closed form (covariances of normals added to widths) and learns
the rest; paper adds to plain means, as published. A stopped training leaves WEIGHTS.part, or the file of --checkpoint. The same command
continues from it to the same bytes, for every number of threads and every instruction set. --seeds trains several nets, and writes the
one with the lowest mean L1 on the validation materials; that seed alone gives the same bytes.
--evaluate measures weights against closed forms: on families outside the training, on new materials of trained families, and on pictures
with --maps. It prints FLIP, L1 and MSE of shaded levels, times 1000, as means over levels 1 to 5. --validation measures only new materials
of trained families, which serve for choosing weights.

Examples:
  burnish train mip --brdf ggx_aniso -o ggx_aniso.mipnet
  burnish train mip --brdf beckmann --layout paper --size 2x64/2x128 --steps 4000 -o paper.mipnet
  burnish train mip --seeds 8 -o best.mipnet
  burnish train mip --evaluate ggx_aniso.mipnet --maps textures --json figures.json)";

OptionTable train_option_table(TrainArguments& to)
{
    OptionTable table, limits;
    limits.add("", limit_options(to.limits));
    mipnet::TrainOptions& t = to.train;
    table.add("", {{"WHAT", "", "{}", choice(to.what, {"mip"})}});
    table.add("The nets", {{"--brdf", "NAME", "Reflection model that shades the mipmaps: {}",
                            choice(t.shape.lobe, {"ggx_aniso", "beckmann", "ashikhmin_shirley"})},
                           {"--layout", "NAME",
                            "Starting point of the nets: paper (plain means, as published) or cov (covariances of normals added to widths)",
                            choice(t.shape.layout, {"paper", "cov"})},
                           {"--size", "SIZE", "Hidden layers x units of both nets; 2x512/3x1024 is as published, 2x32 has no second net",
                            text(to.size)},
                           {"--footprint", "TEXELS", "Texels along a side of the second net's input, at its finest level: {}",
                            choice(t.shape.far, {"4", "8"})}});
    table.add("Training",
              {{"--steps", "N", "Training steps, each on 32 tiles", integer(t.steps, 1, 100000000)},
               {"--seed", "N", "Seed of all random numbers", integer(t.seed, 0, 1 << 30)},
               {"--seeds", "N", "Nets to train, each by the next seed; the best on the validation materials is written",
                integer(to.seeds, 1, 100000)},
               {"--loss", "NAME", "Loss on differences between shaded pictures: {}", choice(t.loss, {"l1", "l2", "charbonnier"})},
               {"--tone", "NAME", "Radiance in the loss: display (tonemapped) or log (log(1 + x))", choice(t.tone, {"display", "log"})},
               {"--mirrored", "SHARE", "Share of direction pairs near highlights, {}; the others are random", number(t.mirrored, 0.0, 1.0)},
               {"--light", "W", "Weight of a level's error in mean radiance, added to the loss, {}", number(t.light, 0.0, 10.0)},
               {"--levels", "N", "Levels in the loss: 2 use the second net once, 5 use it four times",
                integer(t.levels, 1, mipnet::kTrainedLevels)},
               {"--only-maps", "FOLDER", "Folder of materials to train on instead of those made in code; --maps adds to them",
                folder(to.only_maps)},
               {"--from", "WEIGHTS", "Weights to start from, with the same lobe, layout and size", file(to.from)},
               {"--taught-by", "WEIGHTS", "Weights whose levels are the reference, for the same lobe", file(to.distilled_from)},
               {"--checkpoint", "FILE", "Checkpoint file for unfinished training", file(to.checkpoint), "WEIGHTS.part"}});
    table.add("Measuring",
              {{"--evaluate", "WEIGHTS", "Weights to measure, instead of training", file(to.evaluate)},
               {"--maps", "FOLDER",
                "Further materials, each a folder with normal, roughness and metallic maps: measured with --evaluate, else trained on",
                folder(to.maps)},
               {"--validation", "", "Measure on validation materials only, none of the test materials", flag(to.validation)},
               Option("--json", "FILE", "Figures of every material and level", file(to.json)).is_output()});
    table.add("Pieces, for several processes: a seed, or a material of --evaluate", piece_options(to.pieces));
    table.add("Output", {Option("-o,--output", "FILE", "Weights file to write", file(to.output)).is_output(), quiet_option(to.quiet),
                         verbose_option(to.verbosity), threads_option(to.threads)});
    table.take(limits, "Limits on input",
               {{"--limit-image-side", "Width and height of an input picture"}, {"--limit-file-bytes", "Size of one input file"}});
    return table;
}

Status check_arguments(TrainArguments& a, const OptionTable& given)
{
    if (a.evaluate.empty() == a.output.empty())
        return usage_error("-o", "is needed, or --evaluate, and not both");
    if (a.evaluate.empty())
        for (const char* option : {"--validation", "--json"})
            if (given.given(option))
                return usage_error(option, "needs --evaluate WEIGHTS");
    if (!a.evaluate.empty())
        for (const char* option : {"--brdf", "--layout", "--size", "--footprint", "--steps", "--seed", "--seeds", "--loss", "--tone",
                                   "--mirrored", "--light", "--levels", "--only-maps", "--from", "--taught-by", "--checkpoint"})
            if (given.given(option))
                return usage_error(option, "says how nets are trained, and those of --evaluate are trained already");
    BN_TRY(check_piece_options(a.pieces));
    if (any_pieces(a.pieces) && given.given("--checkpoint"))
        return usage_error("--checkpoint", "is no option of pieces, which keep theirs beside them");
    if (!mipnet::read_size(a.size, a.train.shape))
        return usage_error("--size", fmt::format("'{}' is not of the kind 2x32/2x64: 1 to {} layers of 1 to {} units", a.size,
                                                 mipnet::kMostHidden, mipnet::kMostWidth));
    if (a.train.shape.far && a.train.shape.b.layers == 0)
        return usage_error("--footprint", "is the second net's, and --size " + a.size + " has none");
    if (!a.maps.empty() && !a.only_maps.empty())
        return usage_error("--only-maps", "and --maps: one of them");
    if (a.validation && !a.maps.empty())
        return usage_error("--maps", "are for reports, --validation is for what is chosen");
    if (a.output == "-")
        return usage_error("-o", "weights are no text for standard output");
    if (!a.json.empty())
        BN_TRY(check_text_path("--json", a.json, {a.evaluate}));
    if (a.output.empty())
        return {};
    BN_TRY(check_text_path("-o", a.output, {}));
    return check_text_path("--checkpoint", a.train.checkpoint, {});
}

int run_train(TrainArguments& a, const OptionTable& given)
{
    if (a.train.checkpoint = a.checkpoint; a.checkpoint.empty())
        a.train.checkpoint = a.output + ".part";
    if (const Status checked = check_arguments(a, given); !checked)
        return fail(checked.error());
    Report report(a.quiet, a.verbosity);
    return a.evaluate.empty() ? run_training(a, report) : run_evaluation(a, given, report);
}

} // namespace

Command train_command()
{
    auto arguments = std::make_shared<TrainArguments>();
    return {"train", "Train and measure neural nets that make mipmaps", train_option_table(*arguments), kFooter,
            [arguments](OptionTable& given) { return run_train(*arguments, given); }};
}

} // namespace burnish
