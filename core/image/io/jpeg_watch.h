// Keeps decoded JPEG images, for readers with another decoder.
#pragma once
#include <cstdint>
#include <map>
#include <mutex>

#include "core/image/image.h"
#include "core/image/io/guard.h"

namespace burnish {

// Keeps every JPEG image that any thread decodes while the object lives. One object lives at a time.
class JpegWatch {
  public:
    JpegWatch();
    ~JpegWatch();
    JpegWatch(const JpegWatch&) = delete;
    JpegWatch& operator=(const JpegWatch&) = delete;

    // Returns the images by hash_bytes() of their files. Expects that no thread decodes now.
    const std::map<std::uint64_t, Image>& images() const { return images_; }

  private:
    friend void note_jpeg(const ImageBytes& file, const Image& image);
    std::mutex mutex_;
    std::map<std::uint64_t, Image> images_{}; // under mutex_
};

void note_jpeg(const ImageBytes& file, const Image& image); // called by the reader for each JPEG image

} // namespace burnish
