// The cache folder: its limit, and the order of removal.
#include "core/base/cache.h"

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <optional>
#include <set>
#include <thread>
#include <unistd.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;

class cache : public testing::Test {
  protected:
    cache() : folder_(fs::path(testing::TempDir()) / ("cache_" + std::to_string(getpid())))
    {
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    ~cache() override { fs::remove_all(folder_); }

    void add(const std::string& name, std::size_t bytes, int minutes_ago)
    {
        std::ofstream(folder_ / name, std::ios::binary) << std::string(bytes, 'x');
        fs::last_write_time(folder_ / name, fs::file_time_type::clock::now() - std::chrono::minutes(minutes_ago));
    }
    std::set<std::string> names() const
    {
        std::set<std::string> found;
        for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
            found.insert(entry.path().filename().string());
        return found;
    }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    fs::path folder_;
};

const std::string kOld = "environment-0000000000000001.bnenv", kMiddle = "reference-00000000000000ab.part",
                  kYoung = "pipelines-fedcba9876543210.bin";

TEST_F(cache, a_file_is_made_by_one_at_a_time)
{
    std::atomic<int> makers = 0, most = 0, waited = 0;
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&] {
            const CacheLock lock(path(kOld), 60.0);
            EXPECT_TRUE(lock.held());
            most = std::max<int>(most, ++makers);
            waited += lock.waited();
            std::this_thread::sleep_for(std::chrono::milliseconds(30));
            --makers;
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(most, 1);
    EXPECT_EQ(waited, 3);
    EXPECT_EQ(names(), std::set<std::string>{"locks"});
}

TEST_F(cache, a_lock_waits_no_longer_than_told_and_for_its_own_file_only)
{
    {
        const CacheLock first(path(kOld), 60.0), other(path(kMiddle), 60.0);
        EXPECT_FALSE(other.waited()) << "another file";
        const CacheLock second(path(kOld), 0.05);
        EXPECT_TRUE(second.waited());
        EXPECT_FALSE(second.held());
    }
    const CacheLock again(path(kOld), 60.0);
    EXPECT_TRUE(again.held());
    EXPECT_FALSE(again.waited());
    const CacheLock nowhere("/proc/no/such/" + kOld, 60.0);
    EXPECT_FALSE(nowhere.held() || nowhere.waited());
}

TEST_F(cache, what_was_not_used_for_longest_goes_first)
{
    add(kYoung, 100, 1);
    add(kOld, 100, 30);
    add(kMiddle, 100, 20);
    prune_cache(folder_.string(), 300, "");
    EXPECT_EQ(names(), (std::set{kOld, kMiddle, kYoung}));
    prune_cache(folder_.string(), 299, "");
    EXPECT_EQ(names(), (std::set{kMiddle, kYoung}));
    add(kOld, 100, 30);
    note_cache_use(path(kOld));
    prune_cache(folder_.string(), 250, "");
    EXPECT_EQ(names(), (std::set{kOld, kYoung}));
    prune_cache(folder_.string(), 0, "");
    EXPECT_EQ(names(), std::set<std::string>{});
}

TEST_F(cache, what_was_just_written_stays_whatever_its_size)
{
    add(kOld, 5000, 30);
    add(kYoung, 100, 1);
    prune_cache(folder_.string(), 1000, path(kOld));
    EXPECT_EQ(names(), std::set{kOld});
}

TEST_F(cache, other_files_neither_count_nor_go)
{
    const std::set<std::string> others = {"notes.txt",
                                          "environment-1.bnenv",
                                          "environment-0000000000000001.part",
                                          "reference-000000000000000G.part",
                                          "reference-.part",
                                          "xreference-0000000000000001.part",
                                          "pipelines-00000000000000012.bin"};
    for (const std::string& name : others)
        add(name, 1000, 60);
    fs::create_directory(folder_ / "reference-00000000000000aa.part");
    add(kOld, 10, 5);
    EXPECT_EQ(cache_use(folder_.string()).files, 1u);
    EXPECT_EQ(cache_use(folder_.string()).bytes, 10u);
    prune_cache(folder_.string(), 0, "");
    std::set<std::string> left = others;
    left.insert("reference-00000000000000aa.part");
    EXPECT_EQ(names(), left);
    EXPECT_EQ(cache_use((folder_ / "none").string()).files, 0u);
    prune_cache((folder_ / "none").string(), 0, "");
}

class Variable { // sets an environment variable for its lifetime
  public:
    Variable(const char* name, const char* value) : name_(name)
    {
        if (const char* before = std::getenv(name))
            before_ = before;
        set(value);
    }
    ~Variable() { set(before_ ? before_->c_str() : nullptr); }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;
    void set(const char* value) const { value ? setenv(name_, value, 1) : unsetenv(name_); }

  private:
    const char* name_;
    std::optional<std::string> before_;
};

TEST_F(cache, limit_is_the_variable_s_or_the_default)
{
    const Variable variable("BURNISH_CACHE_BYTES", nullptr);
    EXPECT_EQ(cache_limit(), kDefaultCacheBytes);
    for (const auto& [text, bytes] :
         {std::pair{"0", 0ull}, {"1234", 1234ull}, {"3K", 3072ull}, {"500M", 500ull << 20}, {"4G", 4ull << 30}}) {
        variable.set(text);
        EXPECT_EQ(cache_limit(), bytes) << text;
    }
    for (const char* text : {"", "-1", "4T", "x", "4GB", "99999999999999999999", "99999999999G", "1 "}) {
        variable.set(text);
        EXPECT_EQ(cache_limit(), kDefaultCacheBytes) << text;
    }
}

TEST_F(cache, folder_is_xdg_s_or_in_the_home)
{
    const Variable xdg("XDG_CACHE_HOME", "/some/where"), home("HOME", "/home/me");
    EXPECT_EQ(cache_folder(), "/some/where/burnish");
    xdg.set("relative");
    EXPECT_EQ(cache_folder(), "/home/me/.cache/burnish");
    xdg.set(nullptr), home.set("");
    EXPECT_EQ(cache_folder(), "");
}

} // namespace
} // namespace burnish
