#include "core/image/io/image_stream.h"

#include <utility>

#include "core/base/exception.h"
#include "core/base/file.h"
#include "core/image/io/image_io.h"
#include "core/image/io/image_library.h"
#include "core/image/io/png_write.h"

namespace burnish {
namespace {

// Rows that a picture still lacks.
class RowsLeft {
  public:
    RowsLeft(std::string path, const StreamedPicture& picture) : path_(std::move(path)), width_(picture.width), left_(picture.height) {}
    Status take(const Image& rows)
    {
        if (rows.width != width_ || rows.height > left_)
            return error("the rows are not those of the picture");
        left_ -= rows.height;
        return {};
    }
    Status end() const { return left_ == 0 ? Status() : error("the last rows are missing"); }

  private:
    Error error(const std::string& reason) const { return {ExitCode::output_failed, path_, "", reason}; }

    std::string path_;
    int width_, left_;
};

class PngStream final : public ImageStream {
  public:
    PngStream(StreamedFile file, PngEncoder encoder, RowsLeft left)
        : file_(std::move(file)), encoder_(std::move(encoder)), left_(std::move(left))
    {
    }
    Status put(const Result<std::vector<std::uint8_t>>& bytes)
    {
        BN_TRY(bytes);
        return file_.put(bytes->data(), bytes->size());
    }
    Status begin(const StreamedPicture& picture) { return put(encoder_.begin(picture.width, picture.height, picture.channels)); }
    Status add(const Image& rows) override
    {
        BN_TRY(left_.take(rows));
        return put(encoder_.rows(rows));
    }
    Status finish() override
    {
        BN_TRY(left_.end());
        BN_TRY(put(encoder_.end()));
        return file_.name_it();
    }

  private:
    StreamedFile file_;
    PngEncoder encoder_;
    RowsLeft left_;
};

class ExrStream final : public ImageStream {
  public:
    ExrStream(StreamedFile file, std::unique_ptr<RowWriter> rows, RowsLeft left)
        : file_(std::move(file)), rows_(std::move(rows)), left_(std::move(left))
    {
    }
    Status add(const Image& rows) override
    {
        BN_TRY(left_.take(rows));
        return rows_->add(rows);
    }
    Status finish() override
    {
        BN_TRY(left_.end());
        BN_TRY(rows_->finish());
        return file_.name_it();
    }

  private:
    StreamedFile file_;
    std::unique_ptr<RowWriter> rows_; // ends before the file
    RowsLeft left_;
};

} // namespace

bool writes_rows(const std::string& path)
{
    return stores_channels(path) || is_png(path);
}

Result<std::unique_ptr<ImageStream>> open_image_stream(const std::string& path, const StreamedPicture& picture)
{
    if (!writes_rows(path))
        return Error{ExitCode::output_failed, path, "", "this format is not written by rows (exr, png)"};
    try {
        Result<StreamedFile> file = StreamedFile::make(path);
        BN_TRY(file);
        if (!stores_channels(path)) {
            auto stream = std::make_unique<PngStream>(std::move(*file), PngEncoder(path), RowsLeft(path, picture));
            BN_TRY(stream->begin(picture));
            return std::unique_ptr<ImageStream>(std::move(stream));
        }
        const Result<const ImageLibrary*> library = image_library(path);
        BN_TRY(library);
        Result<std::unique_ptr<RowWriter>> rows = (*library)->write_rows(path, file->place(), picture);
        BN_TRY(rows);
        return std::unique_ptr<ImageStream>(std::make_unique<ExrStream>(std::move(*file), std::move(*rows), RowsLeft(path, picture)));
    } catch (...) {
        return error_of_exception({ExitCode::output_failed, path, "", "the image cannot be encoded"});
    }
}

} // namespace burnish
