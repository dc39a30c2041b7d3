#include "shading/lab/mipnet/training_checkpoint.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/bytes.h"
#include "core/base/hash.h"

namespace burnish::mipnet {
namespace {

constexpr char kTrainMagic[8] = {'b', 'n', 'm', 'i', 'p', 'p', '1', '\n'};

} // namespace

std::vector<std::uint8_t> training_checkpoint_bytes(std::uint64_t key, const Trained& t)
{
    std::vector<std::uint8_t> bytes;
    append_bytes(bytes, kTrainMagic, sizeof kTrainMagic);
    append_bytes(bytes, &key, sizeof key);
    append_bytes(bytes, &t.step, sizeof t.step);
    for (const std::vector<float>* numbers : {&t.numbers, &t.first, &t.second, &t.mean})
        append_bytes(bytes, numbers->data(), numbers->size() * sizeof(float));
    const std::uint64_t hash = hash_bytes(bytes.data(), bytes.size());
    append_bytes(bytes, &hash, sizeof hash);
    return bytes;
}

Status parse_training_checkpoint(const std::vector<std::uint8_t>& bytes, const std::string& path, std::uint64_t key, std::uint64_t steps,
                                 Trained& to)
{
    const auto refuse = [&](const char* reason) { return Error{ExitCode::bad_input, path, "", reason}; };
    const std::size_t each = to.numbers.size() * sizeof(float), head = sizeof kTrainMagic + 16;
    if (bytes.size() < head + 8 || std::memcmp(bytes.data(), kTrainMagic, sizeof kTrainMagic) != 0)
        return refuse("is not what is kept of a training");
    std::uint64_t hash = 0, kept = 0;
    std::memcpy(&hash, bytes.data() + bytes.size() - 8, 8);
    if (hash != hash_bytes(bytes.data(), bytes.size() - 8))
        return refuse("is damaged: its hash is another one");
    std::memcpy(&kept, bytes.data() + sizeof kTrainMagic, 8);
    if (kept != key)
        return refuse("is what is kept of a training with other options");
    if (bytes.size() != head + 4 * each + 8)
        return refuse("is damaged: its size is another one");
    Trained t = to;
    std::memcpy(&t.step, bytes.data() + sizeof kTrainMagic + 8, 8);
    if (t.step > steps)
        return refuse("is damaged: it is further than the whole work");
    const std::uint8_t* at = bytes.data() + head;
    for (std::vector<float>* numbers : {&t.numbers, &t.first, &t.second, &t.mean}) {
        std::memcpy(numbers->data(), at, each);
        at += each;
        if (!std::all_of(numbers->begin(), numbers->end(), [](float x) { return std::isfinite(x); }))
            return refuse("is damaged: it holds what are no numbers");
    }
    if (!std::all_of(t.second.begin(), t.second.end(), [](float x) { return x >= 0.0f; }))
        return refuse("is damaged: it holds a mean square below 0");
    to = std::move(t);
    return {};
}

} // namespace burnish::mipnet
