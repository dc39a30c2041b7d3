// Whole files: reads with a size limit, writes atomically.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/descriptor.h"
#include "core/base/result.h"

namespace burnish {

// Treatment of a symbolic link at the end of a path. `refuse` is for folders where links do not belong and may be an
// attack.
enum class Links { follow, refuse };

// Returns the bytes of a regular file of 1 to `max_bytes` bytes. Anything else (missing, folder, pipe, empty, too
// large, or a refused link) is an Error with ExitCode::bad_input.
Result<std::vector<std::uint8_t>> read_file(const std::string& path, std::uint64_t max_bytes, Links links = Links::follow);

// A regular file that is read part by part, from its begin to its end. Errors are those of read_file().
class FileReader {
  public:
    static Result<FileReader> open(const std::string& path, std::uint64_t max_bytes, Links links = Links::follow);
    std::uint64_t size() const { return size_; }
    Status read(void* to, std::size_t bytes); // fails where fewer bytes are left

  private:
    FileReader(Descriptor file, std::string path, std::uint64_t size) : file_(std::move(file)), path_(std::move(path)), size_(size) {}

    Descriptor file_;
    std::string path_;
    std::uint64_t size_;
};

// Writes a file so that the name `path` only ever shows a complete file. The bytes go to an unnamed file where the file
// system has such files, else to a randomly named one in the folder of `path`. The file gets its name once its bytes
// are on disk. An existing file passes on its permissions. A symbolic link keeps pointing to its target, and devices
// and pipes are written directly; Links::refuse replaces all of them. Also removes the leftovers of killed runs that
// wrote `path`. On failure leaves nothing, and the Error has ExitCode::output_failed.
Status write_file_atomic(const std::string& path, const void* data, std::size_t size, Links links = Links::follow);
// Writes the bytes that `write` puts, part by part, so that memory need not hold them all at once. May call `write` a
// second time where the file system has no unnamed files. `put` returns false once a write has failed, and then ignores
// all further bytes.
using PutBytes = std::function<bool(const void* data, std::size_t size)>;
Status write_file_atomic(const std::string& path, const std::function<void(const PutBytes& put)>& write, Links links = Links::follow);

// A file that is written part by part, and gets its name when it is complete. Without name_it(), nothing is left.
class StreamedFile {
  public:
    // Errors: ExitCode::output_failed, also where `path` is a device or a pipe.
    static Result<StreamedFile> make(const std::string& path);
    StreamedFile(StreamedFile&&) = default;
    ~StreamedFile();
    Status put(const void* data, std::size_t size); // behind the bytes before
    std::string place() const;                      // a path by which libraries open the file while it has no name
    Status name_it();

  private:
    StreamedFile(Descriptor file, std::string path, std::string temporary, std::string target);

    Descriptor file_;                       // its lock tells others that the file is no leftover
    std::string path_, temporary_, target_; // temporary: empty for an unnamed file
};

// Returns the place where a file written to `path` lands: the end of the path's links, which need not exist. Returns
// `path` itself for circular links, devices and pipes.
std::string written_place(const std::string& path);

// A set of files in one folder. Added files lie unnamed, or under temporary names, until name_all() names all of them.
// A new folder appears with all its files at once. In an existing folder, name_all() replaces one file after another;
// links keep pointing, and permissions stay. Nothing is left without name_all(), or where name_all() fails for a new
// folder.
class FileSet {
  public:
    explicit FileSet(const std::string& folder);
    ~FileSet();
    FileSet(const FileSet&) = delete;
    FileSet& operator=(const FileSet&) = delete;
    Status add(const std::string& name, const void* data, std::size_t size);
    Status name_all();

  private:
    struct Added {
        Descriptor file;                     // open: its lock tells others that the file is no leftover
        std::string temporary, name, target; // temporary: empty for an unnamed file; target: empty in a new folder
    };
    int name_in_new_folder();
    int give_name(Added& file, const std::string& place);

    std::string folder_;
    bool is_new_ = false;
    std::vector<Added> added_;
};

// Returns NAME for a temporary file ".NAME.HEX.bntmp" (or ".NAME.PID.N.tmp", the form of version 0.1.0), else "".
std::string name_of_temporary(const std::string& name);

// Removes a temporary file, or a temporary folder with its files, unless a running process writes it. Returns true if
// it is gone.
bool remove_leftover(const std::string& path);

} // namespace burnish
