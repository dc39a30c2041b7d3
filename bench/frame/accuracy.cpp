// Measures the accuracy loss of fewer samples: mean HDR-FLIP against the Monte Carlo reference, on the other workloads'
// sphere.
#include <fmt/format.h>

#include "bench/frame/run.h"
#include "core/base/result.h"
#include "core/image/metrics/flip.h"
#include "raster/reference/reference_renderer.h"
#include "raster/tile/tile_renderer.h"

namespace burnish {
namespace {

constexpr int kWidth = 480, kHeight = 270;
constexpr std::uint64_t kReferenceSamples = 256; // for each pixel: both errors contain their noise
constexpr float kRoughness = 0.3f;
constexpr double kWorse = 0.001; // the aim

double mean_flip(const Image& reference, const Image& test, const Jobs& jobs)
{
    const FlipResult flip = flip_hdr(reference, test, {}, jobs);
    double sum = 0.0;
    for (int i = 0; i < kWidth * kHeight; ++i)
        sum += static_cast<double>(flip.error.f32()[i]);
    return sum / (kWidth * kHeight);
}

} // namespace

Result<std::vector<Row>> accuracy_rows(const RunOptions& options)
{
    if (!reference_available())
        return std::vector<Row>{};
    // Make the scene, the tables and both renderers
    const Jobs jobs(options.subject.threads);
    const Scene scene = make_bench_scene(BenchScene::sphere, 0, kWidth, kHeight);
    const DrawTables tables = make_draw_tables(scene);
    const Result<Environment> environment = load_environment("builtin:studio", {}, Limits{}, jobs);
    BN_TRY(environment);
    const DfgTable dfg = bake_dfg(64, 256, jobs);
    const RenderInput input{scene, tables, *environment, dfg, jobs};
    const std::unique_ptr<Renderer> tile = make_tile_renderer(input, options.subject.isa);
    ReferenceOptions reference_options;
    reference_options.samples = kReferenceSamples, reference_options.isa = options.subject.isa;
    const Result<std::unique_ptr<Renderer>> reference = make_reference_renderer(input, reference_options);
    BN_TRY(reference);

    std::vector<Row> rows;
    // Compare fixed and adaptive sampling with the reference
    for (const float eta : {0.5f, 0.8f}) {
        FrameDesc desc;
        desc.width = kWidth, desc.height = kHeight, desc.msaa = 8;
        desc.view = bench_view(BenchScene::sphere, tables, kWidth, kHeight);
        desc.roughness = kRoughness, desc.override_anisotropy = true, desc.anisotropy = eta;
        const Result<Frame> exact = (*reference)->render(desc);
        BN_TRY(exact);
        double flip[2] = {};
        const char* const techniques[2] = {"major_axis", "major_axis_adaptive"};
        for (int i = 0; i < 2; ++i) {
            desc.technique = techniques[i], desc.samples = 16;
            const Result<Frame> frame = tile->render(desc);
            BN_TRY(frame);
            flip[i] = mean_flip(exact->color, frame->color, jobs);
        }
        const double more = flip[1] - flip[0];
        rows.push_back(
            {"accuracy",
             fmt::format("FLIP, adaptive minus fixed 16, eta {:.1f}", static_cast<double>(eta)),
             "",
             kWorse,
             false,
             {more, more, more},
             fmt::format("{:.4f} and {:.4f}, sphere, {} samples a pixel of the reference", flip[1], flip[0], kReferenceSamples)});
    }
    return rows;
}

} // namespace burnish
