// A run's result folder: a run replaces the earlier one's files when its own are whole.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "apps/pieces/share.h"
#include "core/base/descriptor.h"
#include "core/base/result.h"

namespace burnish {

inline constexpr const char* kResultFolders[] = {"pictures", "goldens", "shown", "logs"}; // within the result folder

// Returns true for "FOLDER/NAME" with one of these folders.
bool is_result_file(const std::string& path);

// The marker in a result folder.
struct ResultOrigin {
    Share shard;
    std::string manifest;             // manifest_hash() over its rows
    std::vector<std::string> words{}; // a shard command's words, without the shard and its folder; else empty
};
Result<ResultOrigin> origin_of_results(const std::string& folder);

// Files in the making. They lie in a folder within the earlier results' folder, and are removed with this object unless taken over.
class NewResults {
  public:
    explicit NewResults(const std::string& results) : results_(results), folder_(results + "/.new"), old_(results + "/.old") {}
    NewResults(const NewResults&) = delete;
    NewResults& operator=(const NewResults&) = delete;
    ~NewResults();

    // Makes the folders. Refuses a result folder with other programs' files, one that holds an input, and one into which another run
    // writes.
    Status make(const std::vector<std::string>& inputs, const ResultOrigin& origin);
    const std::string& folder() const { return folder_; }
    Status take_over(); // moves the files into the earlier ones' place

  private:
    Status move_all();

    std::string results_, folder_, old_;
    Descriptor lock_; // on `results_`; one run at a time
    bool made_ = false;
};

} // namespace burnish
