#include "core/image/io/jpeg_watch.h"

#include <atomic>

#include "core/base/check.h"
#include "core/base/hash.h"

namespace burnish {
namespace {

std::atomic<JpegWatch*> watch_now = nullptr;

} // namespace

JpegWatch::JpegWatch()
{
    JpegWatch* none = nullptr;
    BN_CHECK(watch_now.compare_exchange_strong(none, this));
}

JpegWatch::~JpegWatch()
{
    watch_now = nullptr;
}

void note_jpeg(const ImageBytes& file, const Image& image)
{
    JpegWatch* const watch = watch_now;
    if (!watch)
        return;
    const std::uint64_t hash = hash_bytes(file.data, file.size, 0);
    const std::lock_guard lock(watch->mutex_);
    watch->images_.emplace(hash, image);
}

} // namespace burnish
