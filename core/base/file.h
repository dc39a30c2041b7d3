// Whole files: reading with a size limit, writing atomically.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/base/descriptor.h"
#include "core/base/result.h"

namespace burnish {

// What a symbolic link at the end of a path is: another name of its target, or, in folders where no link belongs, an intruder.
enum class Links { follow, refuse };

// The bytes of a regular file of 1 to `max_bytes` bytes; anything else (missing, folder, pipe, empty, larger; a link that is refused)
// is an Error with ExitCode::bad_input.
Result<std::vector<std::uint8_t>> read_file(const std::string& path, std::uint64_t max_bytes, Links links = Links::follow);

// Writes a file without a name where the file system has such, else one with a random name in the folder of `path`, and gives it the
// name `path` once its bytes are on the disk: the name only ever shows a complete file. Permissions of a file that was there are kept.
// A symbolic link keeps pointing to its target, and a device or pipe is written directly; with Links::refuse all of them are replaced.
// What killed runs left of earlier writes of `path` is removed. On failure nothing is left and the Error has ExitCode::output_failed.
Status write_file_atomic(const std::string& path, const void* data, std::size_t size, Links links = Links::follow);
// The same of what `write` puts there, one part behind another, so that not all of it need be in memory at once. It is called again
// where the file system has no files without a name. Putting says whether all went well: what is put after it did not goes nowhere.
using PutBytes = std::function<bool(const void* data, std::size_t size)>;
Status write_file_atomic(const std::string& path, const std::function<void(const PutBytes& put)>& write, Links links = Links::follow);

// Where a file that is written to `path` comes to lie: the end of its links, whether or not that is there. `path` itself where they lead
// round in a circle, and for devices and pipes.
std::string written_place(const std::string& path);

// Files that belong together, in one folder: what is added lies there without a name, or under temporary ones, until name_all() gives all
// of them their names. A folder that was not there appears with all of them in it. In one that was, file after file is replaced; links in
// it keep pointing, and permissions are kept. Without name_all(), or where it fails for a new folder, nothing is left.
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
        Descriptor file;                     // open, so that its lock tells others that it is no leftover
        std::string temporary, name, target; // temporary: empty where it has no name yet; target: empty in a new folder
    };
    int name_in_new_folder();
    int give_name(Added& file, const std::string& place);

    std::string folder_;
    bool is_new_ = false;
    std::vector<Added> added_;
};

// The name that `name` is a temporary file of, or empty: ".NAME.HEX.bntmp" (and ".NAME.PID.N.tmp", as version 0.1.0 wrote them).
std::string name_of_temporary(const std::string& name);

// Removes a temporary file, or a temporary folder with its files, unless a living process writes it. True if it is gone.
bool remove_leftover(const std::string& path);

} // namespace burnish
