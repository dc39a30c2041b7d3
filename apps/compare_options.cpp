#include "apps/command.h"
#include "apps/compare_options.h"

#include <cstdlib>
#include <fmt/format.h>

#include "apps/parse.h"
#include "apps/report.h"
#include "raster/tile/tile_renderer.h"

namespace burnish {
namespace {

constexpr std::int64_t kMaxThreads = 1024;
constexpr double kMaxExposure = 64.0; // stops either way, as of `burnish render`

constexpr const char* kFooter =
    R"(8- and 16-bit pictures are sRGB and compared by LDR-FLIP; float pictures (exr, hdr, pfm) are linear and compared
by HDR-FLIP. Without a --fail option the exit code says only whether the pictures could be compared.

Exit codes: 0 compared, 1 differ by more than a --fail option or the z-test allows, 2 wrong option, 3 size or channels
do not match, 4 unreadable picture, 6 NaN or Inf in a picture, 7 output not written.

Examples:
  burnish compare reference.png test.png
  burnish compare reference.exr test.exr --metric flip-hdr,rel-mse --json -
  burnish compare reference.png test.png --error-map error.png --html report.html
  burnish compare reference.exr test.exr --fail-flip 0.02 --fail-max 0.5
  burnish compare mean.exr test.exr --variance variance.exr --significance 0.01)";

void add_figures(CLI::App& app, CompareArguments& to)
{
    const auto option = [&app](const char* name, std::string& text, const char* help, const char* type) {
        app.add_option(name, text, help)->type_name(type)->group("Figures");
    };
    option("--metric", to.metric,
           "Any of flip or flip-hdr, mse, rel-mse, psnr, ssim, max, by commas (all that suit the pictures)",
           "NAMES");
    option("--ppd", to.ppd, "FLIP: pixels per degree of the observer's visual field (67.02)", "N");
    option("--tonemapper", to.tonemapper, "HDR-FLIP: aces, reinhard or hable (aces)", "NAME");
    option("--start-exposure", to.start_exposure, "HDR-FLIP: lowest exposure (found in the reference)", "EV");
    option("--stop-exposure", to.stop_exposure, "HDR-FLIP: highest exposure (found in the reference)", "EV");
    option("--exposures", to.exposures, "HDR-FLIP: number of exposures (one a stop)", "N");
    app.add_option("--variance", to.plain.variances,
                   "Variance of the reference's pixel means, given again of the test's: a z-test of every pixel")
        ->type_name("FILE")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->expected(1)
        ->group("Figures");
    option("--significance", to.significance, "z-test: probability that equal pictures are told apart (0.01)",
           "P");
}

void add_outputs(CLI::App& app, CompareArguments& to)
{
    app.add_option("--json", to.plain.json, "Write the figures; - is standard output")
        ->type_name("FILE")
        ->group("Output");
    app.add_option("--html", to.plain.html, "Write a page with both pictures, the error map and the figures")
        ->type_name("FILE")
        ->group("Output");
    app.add_option("--error-map", to.plain.error_map,
                   "Write FLIP's errors: colours of magma, or floats (exr, hdr, pfm)")
        ->type_name("FILE")
        ->group("Output");
    app.add_flag("-q,--quiet", to.plain.quiet, "Print errors only")->group("Output");
    app.add_flag("-v,--verbose", to.plain.verbosity, "Print more")->group("Output");
}

void add_failures(CLI::App& app, CompareArguments& to)
{
    const auto option = [&app](const char* name, std::string& text, const char* help, const char* type) {
        app.add_option(name, text, help)->type_name(type)->group("Failing (exit code 1)");
    };
    option("--fail-flip", to.fail_flip, "Fail where FLIP's mean is more", "MEAN");
    option("--fail-max", to.fail_max, "Fail where the largest difference of a channel is more", "V");
    option("--fail-fraction", to.fail_fraction, "Fail where more of the pixels differ", "F");
    option("--fail-z", to.fail_z, "Fail where the z-test rejects more of the pixels (0)", "F");
}

void add_machine(CLI::App& app, CompareArguments& to)
{
    const auto option = [&app](const char* name, std::string& text, const char* help, const char* type,
                               const char* group) {
        app.add_option(name, text, help)->type_name(type)->group(group);
    };
    option("-t,--threads", to.threads, "Worker threads (all cores); never changes a figure", "N", "Machine");
    option("--isa", to.isa, "scalar, avx2 or avx512 (the best one); never changes a figure", "NAME",
           "Machine");
    constexpr const char* kLimits = "Limits on input";
    option("--limit-image-side", to.limit_image_side, "Width and height of a picture (16384)", "PIXELS",
           kLimits);
    option("--limit-texture-bytes", to.limit_texture_bytes, "Decoded pixels of one picture (4G)", "BYTES",
           kLimits);
    option("--limit-file-bytes", to.limit_file_bytes, "Size of one file (2G)", "BYTES", kLimits);
}

// Reads options one after another and remembers the first that is wrong; empty texts leave the default alone.
class Checker {
  public:
    template <class T>
    void number(const std::string& option, const std::string& text, double low, double high, T& into)
    {
        if (!text.empty())
            take(parse_number(option, text, low, high), into);
    }
    template <class T>
    void integer(const std::string& option, const std::string& text, std::int64_t low, std::int64_t high,
                 T& into)
    {
        if (!text.empty())
            take(parse_integer(option, text, low, high), into);
    }
    void bytes(const std::string& option, const std::string& text, std::uint64_t& into)
    {
        if (!text.empty())
            take(parse_bytes(option, text), into);
    }
    void refuse(const Error& error)
    {
        if (status)
            status = error;
    }

    Status status;

  private:
    template <class Value, class T> static void assign(const Value& value, T& into)
    {
        into = static_cast<T>(value);
    }
    template <class Value, class T> static void assign(const Value& value, std::optional<T>& into)
    {
        into = static_cast<T>(value);
    }
    template <class Value, class T> void take(const Result<Value>& value, T& into)
    {
        if (value)
            assign(*value, into);
        else
            refuse(value.error());
    }
};

void check_metrics(const std::string& text, Checker& checker, CompareOptions& out)
{
    if (text.empty())
        return;
    Metrics metrics;
    const std::pair<const char*, bool Metrics::*> known[] = {
        {"flip", &Metrics::flip},       {"flip-hdr", &Metrics::flip_hdr}, {"mse", &Metrics::mse},
        {"rel-mse", &Metrics::rel_mse}, {"psnr", &Metrics::psnr},         {"ssim", &Metrics::ssim},
        {"max", &Metrics::max}};
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t comma = std::min(text.find(',', at), text.size());
        const std::string name = text.substr(at, comma - at);
        bool found = false;
        for (const auto& [metric, member] : known)
            if (name == metric)
                found = metrics.*member = true;
        if (!found)
            checker.refuse(usage_error(
                "--metric",
                fmt::format("'{}' is not one of flip, flip-hdr, mse, rel-mse, psnr, ssim, max", name)));
        at = comma + 1;
    }
    if (metrics.flip && metrics.flip_hdr)
        checker.refuse(
            usage_error("--metric", "flip and flip-hdr are two readings of the same pictures: choose one"));
    out.metrics = metrics;
}

void check_flip(const CompareArguments& in, Checker& checker, FlipOptions& out)
{
    checker.number("--ppd", in.ppd, static_cast<double>(kMinPpd), static_cast<double>(kMaxPpd), out.ppd);
    checker.number("--start-exposure", in.start_exposure, -kMaxExposure, kMaxExposure, out.start_ev);
    checker.number("--stop-exposure", in.stop_exposure, -kMaxExposure, kMaxExposure, out.stop_ev);
    checker.integer("--exposures", in.exposures, 1, kMaxFlipExposures, out.exposures);
    if (out.start_ev && out.stop_ev && *out.start_ev > *out.stop_ev)
        checker.refuse(usage_error("--stop-exposure", "is below --start-exposure"));
    if (in.tonemapper.empty())
        return;
    if (const Result<FlipTonemap> tonemap = parse_flip_tonemap(in.tonemapper))
        out.tonemap = *tonemap;
    else
        checker.refuse(usage_error("--tonemapper",
                                   fmt::format("'{}' is not one of aces, reinhard, hable", in.tonemapper)));
}

void check_machine(const CompareArguments& in, Checker& checker, CompareOptions& out)
{
    checker.integer("--threads", in.threads, 1, kMaxThreads, out.threads);
    checker.integer("--limit-image-side", in.limit_image_side, 1, 1 << 30, out.limits.image_side);
    checker.bytes("--limit-texture-bytes", in.limit_texture_bytes, out.limits.texture_bytes);
    checker.bytes("--limit-file-bytes", in.limit_file_bytes, out.limits.file_bytes);
    if (const char* forced = std::getenv("BN_FORCE_ISA"); forced && !parse_isa(forced))
        return checker.refuse(
            usage_error("BN_FORCE_ISA", fmt::format("'{}' is not one of scalar, avx2, avx512", forced)));
    out.flip.isa = static_cast<int>(best_isa());
    if (in.isa.empty())
        return;
    const Result<Isa> isa = parse_isa(in.isa);
    if (!isa)
        return checker.refuse(
            usage_error("--isa", fmt::format("'{}' is not one of scalar, avx2, avx512", in.isa)));
    if (!isa_available(*isa))
        return checker.refuse(
            Error{ExitCode::unavailable, "", "--isa",
                  fmt::format("this machine cannot run {}, at most {}", in.isa, isa_name(best_isa()))});
    out.flip.isa = static_cast<int>(*isa);
}

} // namespace

void add_compare_options(CLI::App& app, CompareArguments& arguments)
{
    app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    app.add_option("REFERENCE", arguments.plain.reference, "What the picture should be")->required();
    app.add_option("TEST", arguments.plain.test, "What it is")->required();
    add_figures(app, arguments);
    add_failures(app, arguments);
    add_outputs(app, arguments);
    add_machine(app, arguments);
    refuse_empty_values(app);
    app.footer(kFooter);
}

Result<CompareOptions> check_compare_options(const CompareArguments& in)
{
    CompareOptions out = in.plain;
    Checker checker;
    check_metrics(in.metric, checker, out);
    check_flip(in, checker, out.flip);
    check_machine(in, checker, out);
    checker.number("--fail-flip", in.fail_flip, 0.0, 1.0, out.fail_flip);
    checker.number("--fail-max", in.fail_max, 0.0, 1e38, out.fail_max);
    checker.number("--fail-fraction", in.fail_fraction, 0.0, 1.0, out.fail_fraction);
    checker.number("--fail-z", in.fail_z, 0.0, 1.0, out.fail_z);
    checker.number("--significance", in.significance, 1e-9, 0.5, out.significance);
    if (out.variances.size() > 2)
        checker.refuse(
            usage_error("--variance", "is given more than twice: once for REFERENCE, once for TEST"));
    if (out.variances.empty() && !(in.significance.empty() && in.fail_z.empty()))
        checker.refuse(
            usage_error(in.significance.empty() ? "--fail-z" : "--significance", "needs --variance"));
    if (!checker.status)
        return checker.status.error();
    return out;
}

} // namespace burnish
