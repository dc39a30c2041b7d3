#include "apps/reference_options.h"

#include <utility>

#include "core/image/image_io.h"

namespace burnish {
namespace {

constexpr std::int64_t kMaxBounces = 1000;

constexpr std::pair<const char*, ReferenceMode> kModes[] = {
    {"direct", ReferenceMode::direct}, {"shadowed", ReferenceMode::shadowed}, {"path", ReferenceMode::path}};
constexpr std::pair<const char*, ReferenceStrategy> kStrategies[] = {
    {"mis", ReferenceStrategy::mis}, {"brdf", ReferenceStrategy::brdf}, {"light", ReferenceStrategy::light}};

template <class Table, class T>
void read_name(const std::string& option, const std::string& text, const Table& table, OptionReader& reader, T& into)
{
    if (text.empty())
        return;
    std::vector<std::string> names;
    for (const auto& [name, value] : table) {
        names.emplace_back(name);
        if (text == name) {
            into = value;
            return;
        }
    }
    reader.refuse(usage_error(option, fmt::format("'{}' is not one of {}", text, join(names))));
}

// What only the reference understands is a mistake elsewhere, and what it does not look at deserves a word.
void check_other_backend(const RenderArguments& in, OptionReader& reader)
{
    const std::pair<const char*, const std::string&> only_here[] = {
        {"--reference-mode", in.reference_mode}, {"--reference-strategy", in.reference_strategy}, {"--bounces", in.bounces},
        {"--target-error", in.target_error},     {"--checkpoint", in.checkpoint},                 {"--variance", in.variance}};
    for (const auto& [option, text] : only_here)
        if (!text.empty())
            reader.refuse(usage_error(option, "needs --backend reference"));
}

} // namespace

void read_reference(const RenderArguments& in, OptionReader& reader, RenderOptions& out)
{
    if (out.backend != "reference")
        return check_other_backend(in, reader);
    if (!reference_available())
        return reader.refuse(Error{ExitCode::unavailable, "", "--backend", "this program was built without Embree 3, which 'reference' needs"});
    ReferenceOptions& r = out.reference;
    read_name("--reference-mode", in.reference_mode, kModes, reader, r.mode);
    read_name("--reference-strategy", in.reference_strategy, kStrategies, reader, r.strategy);
    for (const auto& [name, value] : kModes)
        if (value == r.mode)
            out.reference_mode_name = name;
    reader.integer("--bounces", in.bounces, 0, kMaxBounces, r.bounces);
    if (!in.bounces.empty() && r.mode != ReferenceMode::path)
        reader.refuse(usage_error("--bounces", "needs --reference-mode path"));
    reader.integer("--samples", in.samples, 1, static_cast<std::int64_t>(kMaxReferenceSamples), r.samples);
    const std::uint64_t whole = (r.samples + kPassSamples - 1) / kPassSamples * kPassSamples;
    if (whole != r.samples && !in.samples.empty())
        out.warnings.push_back(fmt::format("--samples {}: the reference takes {}, in passes of {}", r.samples, whole, kPassSamples));
    r.samples = whole;
    float target = 0.0f;
    reader.number("--target-error", in.target_error, 1e-6, 1.0, target);
    r.target_error = static_cast<double>(target);
    if (in.checkpoint == "-")
        reader.refuse(usage_error("--checkpoint", "must be a file: it is read, too"));
    r.checkpoint = in.checkpoint;
    out.variance_file = in.variance;
    if (!in.variance.empty() && !stores_floats(in.variance))
        reader.refuse(usage_error("--variance", "must be .exr, .hdr or .pfm: the numbers are no colours"));
    if (!in.variance.empty() && r.samples < 2 * kPassSamples)
        reader.refuse(usage_error("--variance", fmt::format("needs --samples of at least {}", 2 * kPassSamples)));
    if (out.frames != 1)
        reader.refuse(usage_error("--frames", "the reference renders one"));
    if (!in.technique.empty())
        out.warnings.push_back("--technique is not looked at: the reference integrates");
    r.isa = out.isa;
    r.quiet = out.quiet;
}

} // namespace burnish
