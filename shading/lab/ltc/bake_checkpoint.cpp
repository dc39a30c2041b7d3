#include "shading/lab/ltc/bake_checkpoint.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/bytes.h"
#include "core/base/hash.h"

namespace burnish::ltc {
namespace {

constexpr char kPartMagic[8] = {'b', 'n', 'l', 't', 'c', 'p', '1', '\n'};

bool all_finite(const std::vector<Matrix>& matrices)
{
    return std::all_of(matrices.begin(), matrices.end(),
                       [](const Matrix& m) { return std::all_of(m.begin(), m.end(), [](double x) { return std::isfinite(x); }); });
}

} // namespace

std::size_t chains_of(const Grid& grid)
{
    return grid.nodes() / static_cast<std::size_t>(grid.size);
}

std::vector<std::uint8_t> bake_checkpoint_bytes(std::uint64_t key, const BakeProgress& p)
{
    std::vector<std::uint8_t> bytes;
    const std::uint64_t words[] = {key, p.chains, p.steps, p.state.entries.empty() ? 0u : 1u};
    const double numbers[] = {p.state.cost, p.state.mu, p.cost_before};
    append_bytes(bytes, kPartMagic, sizeof kPartMagic);
    append_bytes(bytes, words, sizeof words);
    append_bytes(bytes, numbers, sizeof numbers);
    append_bytes(bytes, p.l1.data(), p.l1.size() * sizeof(double));
    append_bytes(bytes, p.nodes.data(), p.nodes.size() * sizeof(Matrix));
    append_bytes(bytes, p.state.entries.data(), p.state.entries.size() * sizeof(Matrix));
    const std::uint64_t hash = hash_bytes(bytes.data(), bytes.size());
    append_bytes(bytes, &hash, sizeof hash);
    return bytes;
}

Status parse_bake_checkpoint(const std::vector<std::uint8_t>& bytes, const std::string& path, std::uint64_t key, std::uint64_t steps,
                             BakeProgress& to)
{
    const auto refuse = [&](const char* reason) { return Error{ExitCode::bad_input, path, "", reason}; };
    std::uint64_t words[4], hash = 0;
    double numbers[3];
    const std::size_t head = sizeof kPartMagic + sizeof words + sizeof numbers, nodes = to.nodes.size();
    const std::size_t fitted = nodes * (sizeof(double) + sizeof(Matrix));
    if (bytes.size() < head + sizeof hash || std::memcmp(bytes.data(), kPartMagic, sizeof kPartMagic) != 0)
        return refuse("is not what is kept of a table");
    std::memcpy(words, bytes.data() + sizeof kPartMagic, sizeof words);
    std::memcpy(numbers, bytes.data() + sizeof kPartMagic + sizeof words, sizeof numbers);
    std::memcpy(&hash, bytes.data() + bytes.size() - sizeof hash, sizeof hash);
    if (hash != hash_bytes(bytes.data(), bytes.size() - sizeof hash))
        return refuse("is damaged: its hash is another one");
    if (words[0] != key)
        return refuse("is what is kept of a table of other options");
    const bool begun = words[3] == 1;
    if (bytes.size() != head + fitted + (begun ? nodes * sizeof(Matrix) : 0) + sizeof hash)
        return refuse("is damaged: its size is another one");
    BakeProgress p = to;
    p.chains = words[1], p.steps = words[2];
    p.state.cost = numbers[0], p.state.mu = numbers[1], p.cost_before = numbers[2];
    const std::uint8_t* at = bytes.data() + head;
    std::memcpy(p.l1.data(), at, nodes * sizeof(double));
    std::memcpy(p.nodes.data(), at + nodes * sizeof(double), nodes * sizeof(Matrix));
    if (begun) {
        p.state.entries.resize(nodes);
        std::memcpy(p.state.entries.data(), at + fitted, nodes * sizeof(Matrix));
    }
    if (p.chains > p.all_chains || p.steps > steps || (begun && p.chains < p.all_chains) || (!begun && p.steps > 0))
        return refuse("is damaged: it is further than the whole work");
    const auto is_error = [](double x) { return std::isfinite(x) && x >= 0.0; };
    const bool rated = std::all_of(std::begin(numbers), std::end(numbers), is_error);
    if (!rated || !all_finite(p.nodes) || !all_finite(p.state.entries) || !std::all_of(p.l1.begin(), p.l1.end(), is_error))
        return refuse("is damaged: it holds what are no numbers");
    to = std::move(p);
    return {};
}

} // namespace burnish::ltc
