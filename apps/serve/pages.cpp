#include "apps/serve/pages.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fmt/core.h>
#include <mutex>
#include <nlohmann/json.hpp>
#include <system_error>

#include "apps/cli/field_options.h"
#include "apps/cli/report.h"
#include "apps/options/scene_view.h"
#include "apps/render/stats.h"
#include "apps/serve/drawings.h"
#include "core/base/exception.h"
#include "core/base/version.h"
#include "core/image/image.h"
#include "core/image/magma.h"
#include "core/image/metrics/flip.h"
#include "core/image/metrics/metrics.h"
#include "raster/reference/reference_renderer.h"

namespace burnish {
namespace {

namespace fs = std::filesystem;

// Returns the names and times of the frame's stages, milliseconds summed over threads. Stages without work are left out.
Json stages_json(const FrameProfile& profile)
{
    Json stages = Json::array();
    for (std::size_t i = 0; i < profile.stage_ns.size(); ++i)
        if (profile.stage_ns[i] > 0)
            stages.push_back({{"name", kFrameStageNames[i]}, {"ms", static_cast<double>(profile.stage_ns[i]) * 1e-6}});
    return stages;
}

Json info_of(const DrawRequest& request, const Drawn& drawn, const std::vector<std::string>& further)
{
    const RenderFigures& f = drawn.rendered.figures;
    const auto vec3 = [](const glm::dvec3& v) { return Json::array({v.x, v.y, v.z}); };
    const View& view = drawn.view;
    return {{"hash", hash_text(f.hash)},
            {"command", command_of(request, further)},
            {"width", drawn.rendered.color.width},
            {"height", drawn.rendered.color.height},
            {"frame_ms", f.frame_ms.empty() ? 0.0 : f.frame_ms.back()},
            {"load_ms", f.load_ms},
            {"environment_ms", f.bake_ms},
            {"prepare_ms", f.prepare_ms},
            {"stages", stages_json(drawn.rendered.profile)},
            {"samples", f.frame.sampling.samples},
            {"nan_pixels", f.nan_pixels},
            {"centre", vec3(drawn.centre)},
            {"radius", drawn.radius},
            {"eye", vec3(drawn.origin + glm::dvec3(view.eye))},
            {"forward", vec3(glm::dvec3(view.forward))},
            {"fov", view.orthographic
                        ? Json()
                        : Json(2.0 * std::atan(static_cast<double>(view.tan_half_y)) / static_cast<double>(kRadiansPerDegree))},
            {"warnings", drawn.warnings}};
}

Json json_of_band(const DrawnBand& band)
{
    return {{"width", band.linear.width},    {"rows", band.linear.height},        {"linear", band.linear.channels},
            {"shown", band.shown.channels},  {"triangles", band.stats.triangles}, {"ms", band.stats.ms},
            {"nan_pixels", band.nan_pixels}, {"stage_ns", band.stage_ns}};
}

// Reads the output of json_of_band(), with the pixels of all bands. Errors: ExitCode::usage.
Result<std::vector<DrawnBand>> bands_of(const Json& json, std::span<const std::uint8_t> pixels)
{
    constexpr int kMostSide = 1 << 14;
    std::vector<DrawnBand> bands;
    for (const Json& figures : json) {
        DrawnBand band;
        const int width = figures.at("width"), rows = figures.at("rows");
        const std::pair<Image*, int> images[] = {{&band.linear, figures.at("linear")}, {&band.shown, figures.at("shown")}};
        for (const auto& [image, channels] : images) {
            if (width < 0 || width > kMostSide || rows < 0 || rows > kMostSide || (channels != 0 && channels != 3 && channels != 4))
                return usage_error("bands", "are no bands");
            const PixelType type = image == &band.linear ? PixelType::f32 : PixelType::u8;
            if (std::uint64_t(width) * std::uint64_t(rows) * std::uint64_t(channels) * pixel_type_bytes(type) > pixels.size())
                return usage_error("bands", "have too few pixels");
            *image = make_image(width, rows, channels, type);
            std::memcpy(image->bytes.data(), pixels.data(), image->bytes.size());
            pixels = pixels.subspan(image->bytes.size());
        }
        band.stats.triangles = figures.at("triangles"), band.stats.ms = figures.at("ms");
        band.nan_pixels = figures.at("nan_pixels"), band.stage_ns = figures.at("stage_ns").get<decltype(band.stage_ns)>();
        bands.push_back(std::move(band));
    }
    return bands;
}

} // namespace

class Pages::Answers {
  public:
    Answers(const ServeSetting& setting, ServedLists lists)
        : setting_(setting), lists_(std::make_shared<const ServedLists>(std::move(lists))), drawings_(setting.limits, setting.threads)
    {
    }

    void stop() { drawings_.stop(); }

    void operator()(const HttpRequest& request, HttpResponse& response)
    {
        guard(response, [&] { return route(request, response); });
    }

    void draw_part(const HttpRequest& request, HttpResponse& response)
    {
        guard(response, [&]() -> Status {
            const Result<Json> json = request_json(request.body);
            BN_TRY(json);
            const Result<DrawRequest> picture = draw_request_of(json->value("picture", Json()), *lists());
            BN_TRY(picture);
            const Result<DrawnBand> band = drawings_.draw_part(*picture, json->value("from", 0.0), json->value("to", 1.0));
            if (!band && band.error().field == "FrameDesc::window")
                return Error{ExitCode::differ, "", "", "the picture is drawn as a whole"};
            BN_TRY(band);
            response.headers.emplace_back(kPictureHeader, json_text(json_of_band(*band), -1));
            response.type = "application/octet-stream";
            for (const Image* image : {&band->linear, &band->shown})
                response.body.append(reinterpret_cast<const char*>(image->bytes.data()), image->bytes.size());
            return {};
        });
    }

    void kept(const HttpRequest& request, HttpResponse& response)
    {
        guard(response, [&]() -> Status {
            const Result<Json> json = request_json(request.body);
            BN_TRY(json);
            const Result<DrawRequest> picture = draw_request_of(*json, *lists());
            BN_TRY(picture);
            response.status = drawings_.keeps(*picture) ? 200 : 404;
            return {};
        });
    }

    void join(const HttpRequest& request, std::span<const std::uint8_t> pixels, HttpResponse& response)
    {
        guard(response, [&]() -> Status {
            const Result<Json> json = request_json(request.body);
            BN_TRY(json);
            const Result<DrawRequest> picture = draw_request_of(json->value("picture", Json()), *lists());
            BN_TRY(picture);
            Result<std::vector<DrawnBand>> bands = bands_of(json->value("bands", Json::array()), pixels);
            BN_TRY(bands);
            const Result<std::shared_ptr<const Drawn>> drawn = drawings_.join(*picture, std::move(*bands), json->value("ms", 0.0));
            BN_TRY(drawn);
            return this->picture(response, shown_picture(**drawn), info_of(*picture, **drawn, setting_.limit_words), (*drawn)->jobs.get());
        });
    }

  private:
    template <class Work> static void guard(HttpResponse& response, const Work& work)
    {
        try {
            if (const Status done = work(); !done)
                refuse(response, done.error());
        } catch (...) {
            refuse(response, error_of_exception(Error{ExitCode::internal, "", "", "a fault of burnish"}));
        }
    }

    static void answer(HttpResponse& response, const Json& json)
    {
        response.type = "application/json", response.body = json_text(json, -1);
    }

    static void refuse(HttpResponse& response, const Error& error)
    {
        response.status = error.code == ExitCode::differ ? 409 : 400;
        answer(response, {{"error", line_of(error)}});
    }

    Status route(const HttpRequest& request, HttpResponse& response)
    {
        if (request.method == "GET" && request.path == "/lists") {
            answer(response, lists_json());
            return {};
        }
        if (request.method == "GET" && request.path == "/changes") {
            answer(response, {{"changes", setting_.watch ? drawings_.look_for_changes() : 0}, {"lists", setting_.watch ? list_anew() : 0}});
            return {};
        }
        constexpr std::pair<const char*, Status (Answers::*)(const Json&, const HttpRequest&, HttpResponse&)> kPosts[] = {
            {"/draw", &Answers::draw}, {"/difference", &Answers::difference}, {"/save", &Answers::save}};
        for (const auto& [path, work] : kPosts)
            if (request.method == "POST" && request.path == path) {
                const Result<Json> json = request_json(request.body);
                return json ? (this->*work)(*json, request, response) : Status(json.error());
            }
        response.status = 404, response.body = "There is no such page.\n";
        return {};
    }

    std::shared_ptr<const ServedLists> lists() const
    {
        const std::lock_guard lock(listing_);
        return lists_;
    }

    // Lists the files of a served folder. Returns how often the lists have changed. A folder that cannot be read keeps its list.
    std::uint64_t list_anew()
    {
        std::error_code failed;
        if (!fs::is_directory(setting_.target, failed))
            return 0;
        Result<ServedLists> now = served_lists(setting_.target);
        const std::lock_guard lock(listing_);
        if (now && *now != *lists_)
            lists_ = std::make_shared<const ServedLists>(std::move(*now)), ++list_changes_;
        return list_changes_;
    }

    Json lists_json() const
    {
        const auto names = [](const std::vector<ServedFile>& files) {
            Json out = Json::array();
            for (const ServedFile& file : files)
                out.push_back(file.name);
            return out;
        };
        RenderArguments arguments;
        const std::shared_ptr<const ServedLists> now = lists();
        return {{"version", version()},
                {"scenes", names(now->scenes)},
                {"environments", names(now->environments)},
                {"options", served_options(render_option_table(arguments))},
                {"watch", setting_.watch},
                {"save", !setting_.output_folder.empty()},
                {"reference", reference_available()},
                {"most_samples", kMaxPictureSamples}};
    }

    Status picture(HttpResponse& response, const Image& image, const Json& info, const Jobs* jobs = nullptr) const
    {
        Result<std::string> bytes = setting_.encode(image, jobs);
        BN_TRY(bytes);
        response.headers.emplace_back(kPictureHeader, json_text(info, -1));
        response.type = setting_.picture_type, response.body = std::move(*bytes);
        return {};
    }

    Status draw(const Json& json, const HttpRequest& asked, HttpResponse& response)
    {
        const Result<DrawRequest> request = draw_request_of(json, *lists());
        BN_TRY(request);
        const Result<std::shared_ptr<const Drawn>> drawn = drawings_.draw(*request, {true, asked.gone});
        BN_TRY(drawn);
        return picture(response, shown_picture(**drawn), info_of(*request, **drawn, setting_.limit_words), (*drawn)->jobs.get());
    }

    // Draws both pictures. Returns HDR-FLIP of the second.
    Result<FlipResult> flip_of(const Json& json, const HttpRequest& asked)
    {
        std::shared_ptr<const Drawn> both[2];
        for (int i = 0; i < 2; ++i) {
            const Result<DrawRequest> request =
                draw_request_of(json.is_object() ? json.value(i ? "test" : "reference", Json()) : Json(), *lists());
            BN_TRY(request);
            const Result<std::shared_ptr<const Drawn>> drawn = drawings_.draw(*request, {false, asked.gone});
            BN_TRY(drawn);
            both[i] = *drawn;
        }
        const Image &a = both[0]->rendered.color, &b = both[1]->rendered.color;
        if (a.width != b.width || a.height != b.height)
            return usage_error("test", "has another size");
        if (not_finite_pixels(a, b))
            return Error{ExitCode::not_finite, "", "", "pixels are NaN or Inf"};
        const Jobs jobs(setting_.threads);
        return flip_hdr(a, b, FlipOptions(), jobs);
    }

    // Answers with the error map of the second picture.
    Status difference(const Json& json, const HttpRequest& asked, HttpResponse& response)
    {
        const Result<FlipResult> flip = flip_of(json, asked);
        BN_TRY(flip);
        const ErrorSummary summary = summarise_errors(flip->error);
        return picture(response, magma_map(flip->error), {{"flip_mean", summary.mean}, {"flip_p99", summary.p99}});
    }

    // Saves a picture, a reference, or the error map of two pictures: as colours in .png, as FLIP in .exr.
    Status save(const Json& json, const HttpRequest& asked, HttpResponse& response)
    {
        if (setting_.output_folder.empty())
            return usage_error("save", "needs `burnish serve -o FOLDER`");
        std::string extension = ".png";
        if (const auto given = json.find("extension"); given != json.end())
            extension = *given == ".exr" ? ".exr" : *given == ".png" ? ".png" : "";
        if (extension.empty())
            return usage_error("extension", "is neither .png nor .exr");
        if (json.contains("test")) {
            const Result<FlipResult> flip = flip_of(json, asked);
            BN_TRY(flip);
            return save_as(extension, response, [&](const std::string& path) {
                return write_image(path, extension == ".png" ? magma_map(flip->error) : flip->error);
            });
        }
        const Result<DrawRequest> request = draw_request_of(json, *lists());
        BN_TRY(request);
        const Result<std::shared_ptr<const Drawn>> drawn = drawings_.draw(*request, {false, asked.gone});
        BN_TRY(drawn);
        return save_as(extension, response,
                       [&](const std::string& path) { return write_rendered(path, (*drawn)->rendered, (*drawn)->options); });
    }

    // Calls write(path) with the folder's next free name.
    template <class Write> Status save_as(const std::string& extension, HttpResponse& response, const Write& write)
    {
        const std::lock_guard lock(saving_);
        std::error_code ignored;
        for (int number = 1; number <= 9999; ++number) {
            const std::string path = (fs::path(setting_.output_folder) / fmt::format("picture-{:04d}{}", number, extension)).string();
            if (fs::exists(fs::symlink_status(path, ignored)))
                continue;
            BN_TRY(write(path));
            answer(response, {{"path", path}});
            return {};
        }
        return Error{ExitCode::output_failed, setting_.output_folder, "", "holds 9999 pictures"};
    }

    const ServeSetting& setting_;
    mutable std::mutex listing_;
    std::shared_ptr<const ServedLists> lists_; // under listing_
    std::uint64_t list_changes_ = 0;           // under listing_
    Drawings drawings_;
    std::mutex saving_;
};

Pages::Pages(const ServeSetting& setting, ServedLists lists) : answers_(std::make_unique<Answers>(setting, std::move(lists))) {}
Pages::~Pages() = default;

void Pages::answer(const HttpRequest& request, HttpResponse& response)
{
    (*answers_)(request, response);
}

void Pages::draw_part(const HttpRequest& request, HttpResponse& response)
{
    answers_->draw_part(request, response);
}

void Pages::kept(const HttpRequest& request, HttpResponse& response)
{
    answers_->kept(request, response);
}

void Pages::join(const HttpRequest& request, std::span<const std::uint8_t> pixels, HttpResponse& response)
{
    answers_->join(request, pixels, response);
}

void Pages::stop()
{
    answers_->stop();
}

} // namespace burnish
