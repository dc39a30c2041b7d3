// Files in a piece: whole, or refused.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "apps/pieces/packed.h"
#include "apps/pieces/pieces.h"
#include "tests/unit/temp_folder.h"

namespace burnish::test {
namespace {

const Packed kPacked = {"{\"a\": 1}\n", {{"one.png", {1, 2, 3}}, {"", {}}, {"two \n.png", {10, 10}}}};

TEST(packed, gives_back_what_it_took)
{
    const Result<Packed> back = unpack(pack(kPacked), "p");
    ASSERT_TRUE(back) << back.error().line();
    EXPECT_EQ(back->json, kPacked.json);
    ASSERT_EQ(back->files.size(), kPacked.files.size());
    for (std::size_t i = 0; i < kPacked.files.size(); ++i) {
        EXPECT_EQ(back->files[i].name, kPacked.files[i].name);
        EXPECT_EQ(back->files[i].bytes, kPacked.files[i].bytes);
    }
}

TEST(packed, refuses_cut_and_foreign_bytes)
{
    const std::vector<std::uint8_t> whole = pack(kPacked);
    for (std::size_t size = 0; size < whole.size(); ++size)
        EXPECT_FALSE(unpack({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)}, "p"));
    for (const std::string text :
         {"\n", "[]\n", "{}\n", "{\"figures\":1,\"files\":[]}\n", "{\"figures\":\"\",\"files\":[{\"name\":\"a\",\"bytes\":-1}]}\n",
          "{\"figures\":\"\",\"files\":[1]}\n", "{\"figures\":\"\",\"files\":[]}\nx"})
        EXPECT_FALSE(unpack({text.begin(), text.end()}, "p")) << text;
}

TEST(pieces, are_refused_by_name_when_damaged_or_another_s)
{
    const TempFolder folder;
    const std::string file = folder.path("a.piece"), key = piece_key("a");
    ASSERT_TRUE(write_piece(file, key, {1, 2, 3}));
    const Result<std::vector<std::uint8_t>> back = read_piece(file, key);
    ASSERT_TRUE(back) << back.error().line();
    EXPECT_EQ(*back, (std::vector<std::uint8_t>{1, 2, 3}));
    std::ifstream in(file, std::ios::binary);
    const std::string whole((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    const auto reason = [&](const std::string& bytes, const std::string& wanted) {
        std::ofstream(file, std::ios::binary) << bytes;
        const Result<std::vector<std::uint8_t>> read = read_piece(file, wanted);
        return read ? std::string() : read.error().line();
    };
    EXPECT_NE(reason(whole, piece_key("b")).find("is piece " + key), std::string::npos);
    EXPECT_NE(reason(whole.substr(0, whole.size() - 1), key).find("damaged"), std::string::npos);
    EXPECT_NE(reason(whole + "x", key).find("damaged"), std::string::npos);
    EXPECT_NE(reason("other", key).find("no"), std::string::npos);
    std::string older = whole;
    older.replace(8, older.find('\n') - 8, "0.0.1");
    EXPECT_NE(reason(older, key).find("burnish 0.0.1"), std::string::npos);
}

} // namespace
} // namespace burnish::test
