#include "apps/pieces/words.h"

#include <algorithm>
#include <iterator>

namespace burnish {
namespace {

// An option that changes no file of a job, and whether a value follows.
struct PieceWord {
    const char* name;
    bool takes_value;
};
constexpr PieceWord kPieceWords[] = {{"--pieces", false}, {"--piece", true},  {"--shard", true},
                                     {"--take", false},   {"--merge", false}, {"--work", true}};
constexpr PieceWord kMachineWords[] = {{"--quiet", false}, {"--verbose", false}, {"--threads", true}, {"-t", true}, {"--isa", true}};

// Returns the number of a command's words that letters in one word take: -q, -v, -t4, -qt 4. 0: it holds others.
std::size_t letters_of_machine(const std::string& word)
{
    const std::size_t rest = word.size() > 1 && word[0] == '-' ? word.find_first_not_of("qv", 1) : 0;
    if (rest == 0 || (rest != std::string::npos && word[rest] != 't'))
        return 0;
    if (rest == std::string::npos)
        return 1;
    if (rest + 1 == word.size())
        return 2; // the number is the next word
    return word.find_first_not_of("0123456789", rest + 1) == std::string::npos ? 1 : 0;
}

template <std::size_t N> std::vector<std::string> without(const PieceWord (&dropped)[N], const std::vector<std::string>& words)
{
    std::vector<std::string> kept;
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string name = words[i].substr(0, words[i].find('='));
        const auto* const found = std::find_if(std::begin(dropped), std::end(dropped), [&](const PieceWord& w) { return name == w.name; });
        if (found == std::end(dropped))
            kept.push_back(words[i]);
        else if (found->takes_value && words[i] == name)
            ++i;
    }
    return kept;
}

} // namespace

std::string shell_words(const std::vector<std::string>& words)
{
    constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,/:@%";
    std::string line;
    for (const std::string& word : words) {
        line += line.empty() ? "" : " ";
        if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) {
            line += word;
            continue;
        }
        line += "'";
        for (const char c : word)
            line += c == '\'' ? std::string("'\\''") : std::string(1, c);
        line += "'";
    }
    return line;
}

std::vector<std::string> without_pieces(const std::vector<std::string>& words)
{
    return without(kPieceWords, words);
}

std::vector<std::string> job_words(const std::vector<std::string>& words)
{
    const std::vector<std::string> all = without(kMachineWords, without_pieces(words));
    std::vector<std::string> kept;
    for (std::size_t i = 0; i < all.size();)
        if (const std::size_t taken = letters_of_machine(all[i]); taken > 0)
            i += taken;
        else
            kept.push_back(all[i++]);
    return kept;
}

} // namespace burnish
