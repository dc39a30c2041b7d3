#include "core/scene/pictures_ahead.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <filesystem>
#include <optional>
#include <set>
#include <system_error>

#include "core/base/exception.h"
#include "core/jobs/control.h"
#include "core/jobs/jobs.h"

namespace burnish {
namespace {

struct PictureFile {
    std::string path;
    bool colours;
    std::uint64_t bytes;
};

Result<Image> read_now(const std::string& path, bool colours, const Limits& limits, PictureNotes& notes, const HasRoom& room = {})
{
    return colours ? read_colours(path, limits, notes, room) : read_image(path, limits, &notes, room);
}

// Returns each picture once, the largest file first. Leaves out files that cannot be seen, and those beyond Limits::input_bytes.
std::vector<PictureFile> files_of_pictures(const std::vector<PicturesAhead::Wanted>& pictures, const Limits& limits)
{
    std::vector<PictureFile> files;
    std::set<std::pair<std::string, bool>> seen;
    for (const PicturesAhead::Wanted& picture : pictures) {
        std::error_code failed;
        if (!seen.insert({picture.path, picture.colours}).second)
            continue;
        if (const std::uint64_t bytes = std::filesystem::file_size(picture.path, failed); !failed)
            files.push_back({picture.path, picture.colours, bytes});
    }
    std::stable_sort(files.begin(), files.end(), [](const PictureFile& a, const PictureFile& b) { return a.bytes > b.bytes; });
    std::uint64_t left = limits.input_bytes;
    std::erase_if(files, [&](const PictureFile& file) {
        const bool fits = file.bytes <= left;
        left -= fits ? file.bytes : 0;
        return !fits;
    });
    return files;
}

} // namespace

PicturesAhead::PicturesAhead(const std::vector<Wanted>& pictures, const Limits& limits, const Jobs* jobs)
{
    if (!jobs || jobs->threads() < 2 || pictures.size() < 2)
        return;
    const std::vector<PictureFile> files = files_of_pictures(pictures, limits);
    if (files.size() < 2)
        return;
    std::vector<std::optional<Held>> decoded(files.size());
    std::atomic<std::uint64_t> taken = 0;
    const auto decode_at = [&](std::size_t i, int) {
        Held picture;
        const HasRoom room = [&](std::uint64_t bytes) {
            taken -= picture.bytes; // of a decoder that gave up before
            picture.bytes = bytes;
            return taken.fetch_add(bytes) + bytes <= limits.texture_bytes;
        };
        try {
            Result<Image> image = read_now(files[i].path, files[i].colours, limits, picture.notes, room);
            if (image) {
                picture.image = std::move(*image);
                decoded[i] = std::move(picture);
                return;
            }
        } catch (const std::exception&) { // read() meets it again
        }
        taken -= picture.bytes;
    };
    try {
        jobs->parallel_for(files.size(), decode_at);
    } catch (const Stopped&) { // read() reports it
    }
    for (std::size_t i = 0; i < files.size(); ++i)
        if (decoded[i])
            held_.emplace(std::pair(files[i].path, files[i].colours), std::move(*decoded[i]));
}

Result<Image> PicturesAhead::read(const std::string& path, bool colours, const Limits& rest, PictureNotes& notes)
{
    if (stop_here().stop_requested())
        return Error{ExitCode::stopped, path, "", "stopped"};
    if (auto held = held_.extract(std::pair(path, colours)); held && held.mapped().bytes <= rest.texture_bytes) {
        notes = std::move(held.mapped().notes);
        return std::move(held.mapped().image);
    }
    return read_now(path, colours, rest, notes);
}

} // namespace burnish
