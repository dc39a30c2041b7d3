#include "shading/lab/mipnet/train.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>

#include "core/base/check.h"
#include "core/base/clock.h"
#include "core/base/file.h"
#include "core/base/hash.h"
#include "core/image/image.h"
#include "core/math/scalar_math.h"
#include "core/simd/half.h"
#include "shading/lab/mipnet/training_checkpoint.h"

namespace burnish::mipnet {
namespace {

constexpr double kFirstDecay = 0.9, kSecondDecay = 0.999, kMeanDecay = 0.999, kMostGradient = 1.0;
constexpr int kWarmSteps = 100; // with a growing rate

std::uint64_t training_key(const TrainOptions& o, const TrainingSet& set)
{
    std::string words = fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {} {} {} {:x}", lobe_name(o.shape.lobe),
                                    layout_name(o.shape.layout), size_name(o.shape), o.shape.far, o.steps, o.seed, static_cast<int>(o.loss),
                                    static_cast<int>(o.tone), o.mirrored, o.light, o.levels, o.shards, o.pairs, o.seeds, o.side, set.hash);
    if (o.from)
        words += fmt::format(" {:x}", net_hash(*o.from));
    if (o.distilled_from)
        words += fmt::format(" {:x}", net_hash(*o.distilled_from));
    return hash_bytes(words.data(), words.size());
}

Status keep_training(const TrainOptions& options, std::uint64_t key, const Trained& t)
{
    if (options.checkpoint.empty())
        return {};
    const std::vector<std::uint8_t> bytes = training_checkpoint_bytes(key, t);
    return write_file_atomic(options.checkpoint, bytes.data(), bytes.size());
}

Status go_on_training(const TrainOptions& options, std::uint64_t key, Trained& t)
{
    std::error_code ignored;
    if (options.checkpoint.empty() || !std::filesystem::exists(std::filesystem::symlink_status(options.checkpoint, ignored)))
        return {};
    const Result<std::vector<std::uint8_t>> read = read_file(options.checkpoint, std::uint64_t{1} << 30);
    return read ? parse_training_checkpoint(*read, options.checkpoint, key, static_cast<std::uint64_t>(options.steps), t) : read.error();
}

using Memory = std::vector<std::byte, LineAllocator<std::byte>>;

// Sums over slots in a fixed tree.
double slots_sum(const float* slots)
{
    float part[kSlots];
    std::memcpy(part, slots, sizeof part);
    for (int half = kSlots / 2; half > 0; half /= 2)
        for (int k = 0; k < half; ++k)
            part[k] += part[k + half];
    return static_cast<double>(part[0]);
}

struct Shard {
    std::vector<float> gradient, loss, target_levels[kTrainedLevels];
    Memory memory, target_memory;
};

// Makes target levels for a shard's tiles by another net: planes by level.
void make_targets(const Fns& fns, const Weights& by, const Plan& plan, const Batch& batch, Shard& shard, const void** levels)
{
    const auto planes = [&](int level) { return level == 0 ? batch.texels.data() : shard.target_levels[level - 1].data(); };
    std::size_t n = static_cast<std::size_t>(kSlots) * kTileSide * kTileSide / 4;
    shard.target_memory.resize(fns.forward_bytes(plan, n));
    for (int k = 1; k <= kTrainedLevels; ++k, n /= 4) {
        std::vector<float>& to = shard.target_levels[k - 1];
        to.resize(kChannels * n);
        fns.forward({&plan, by.numbers.data(), n, planes(k - 1), k >= 2 ? planes(k - 2) : nullptr, k >= 3 ? planes(k - 3) : nullptr,
                     to.data(), shard.target_memory.data()});
        levels[k - 1] = to.data();
    }
}

// Takes an Adam step with clipped gradients, and updates the moving average.
void adam(const TrainOptions& o, const std::vector<double>& gradient, Trained& t)
{
    double squares = 0.0;
    for (const double g : gradient)
        squares += g * g;
    const double length = std::sqrt(squares), by = length > kMostGradient ? kMostGradient / length : 1.0;
    const double step = static_cast<double>(t.step) + 1.0;
    if (!std::isfinite(length))
        return; // no usable gradient
    const double warm = std::fmin(1.0, step / kWarmSteps);
    const double rate = o.rate * warm * 0.5 * (1.0 + det_cos(kPi * std::fmin(1.0, (step - 1.0) / o.steps)));
    const double first = 1.0 / (1.0 - det_pow(kFirstDecay, step)), second = 1.0 / (1.0 - det_pow(kSecondDecay, step));
    const double decay = std::fmin(kMeanDecay, step / (step + 9.0));
    for (std::size_t i = 0; i < gradient.size(); ++i) {
        const double g = gradient[i] * by;
        const double m = kFirstDecay * static_cast<double>(t.first[i]) + (1.0 - kFirstDecay) * g;
        const double v = kSecondDecay * static_cast<double>(t.second[i]) + (1.0 - kSecondDecay) * g * g;
        t.first[i] = static_cast<float>(m), t.second[i] = static_cast<float>(v);
        const double moved = static_cast<double>(t.numbers[i]) - rate * (m * first) / (std::sqrt(v * second) + 1e-8);
        t.numbers[i] = static_cast<float>(moved);
        t.mean[i] = static_cast<float>(decay * static_cast<double>(t.mean[i]) + (1.0 - decay) * moved);
    }
}

TrainingSet training_set(const TrainOptions& o, const Jobs& jobs)
{
    TrainingSet set;
    if (!o.only_maps)
        set = make_training_set(o.seeds, o.side, jobs);
    for (const Material& m : o.maps)
        add_material(set, m);
    return set;
}

} // namespace

Result<std::optional<Weights>> train(const TrainOptions& options, const Jobs& jobs)
{
    const Fns& fns = pick<Fns>(options.isa);
    const StepFns& steps = pick<StepFns>(options.isa);
    const Plan plan = plan_of(options.shape);
    const TrainingSet set = training_set(options, jobs);
    const std::uint64_t key = training_key(options, set);
    Trained t;
    t.numbers = options.from ? options.from->numbers : start_weights(plan, options.seed);
    const Plan target_plan = options.distilled_from ? plan_of(options.distilled_from->shape) : Plan{};
    BN_CHECK(t.numbers.size() == plan.count && options.levels >= 1 && options.levels <= kTrainedLevels);
    t.mean = t.numbers;
    t.first.assign(plan.count, 0.0f), t.second.assign(plan.count, 0.0f);
    BN_TRY(go_on_training(options, key, t));
    std::vector<Shard> shards(static_cast<std::size_t>(options.shards));
    for (Shard& shard : shards) {
        shard.loss.resize(kTrainedLevels * kSlots);
        shard.memory.resize(steps.bytes(plan, options.pairs));
    }
    double level_weight[kTrainedLevels] = {};
    std::fill_n(level_weight, options.levels, 1.0 / options.levels);
    std::vector<double> gradient(plan.count);
    double saved_ms = wall_ms();
    while (t.step < static_cast<std::uint64_t>(options.steps)) {
        // Compute the shards' gradients
        const std::vector<float> turned = turned_weights(plan, t.numbers);
        jobs.parallel_for(shards.size(), [&](std::size_t s, int) {
            Shard& shard = shards[s];
            const std::uint64_t words[] = {options.seed, t.step, s};
            const Batch batch = make_batch(set, hash_bytes(words, sizeof words), options.pairs, options.mirrored);
            shard.gradient.assign(plan.count * kSlots, 0.0f);
            const void* target_levels[kTrainedLevels] = {};
            if (options.distilled_from)
                make_targets(fns, *options.distilled_from, target_plan, batch, shard, target_levels);
            steps.step({&plan, t.numbers.data(), turned.data(), batch.texels.data(), batch.tiles.data(), batch.pairs.data(), options.pairs,
                        level_weight, shard.gradient.data(), shard.loss.data(), shard.memory.data(), options.loss, options.tone,
                        options.distilled_from ? target_levels : nullptr, static_cast<float>(options.light)});
        });
        // Average over shards
        double loss = 0.0;
        for (std::size_t i = 0; i < plan.count; ++i) {
            gradient[i] = 0.0;
            for (const Shard& shard : shards)
                gradient[i] += slots_sum(&shard.gradient[i * kSlots]) / options.shards;
        }
        for (const Shard& shard : shards)
            for (std::size_t k = 0; k < kTrainedLevels; ++k)
                loss += slots_sum(&shard.loss[k * kSlots]) / options.shards;
        // Step, report, and write checkpoints
        adam(options, gradient, t);
        ++t.step;
        if (options.advance)
            options.advance(static_cast<int>(t.step), loss);
        const bool stopped = options.stop && options.stop->load();
        if (stopped || wall_ms() - saved_ms > 1000.0 * options.checkpoint_seconds) {
            BN_TRY(keep_training(options, key, t));
            saved_ms = wall_ms();
        }
        if (stopped)
            return std::optional<Weights>();
    }
    BN_TRY(keep_training(options, key, t)); // a caller that trains several nets may stop before it uses this one
    // Round the average to halves
    Weights w;
    w.shape = options.shape, w.seed = options.seed, w.steps = t.step, w.data = set.hash;
    w.families = options.only_maps ? std::string() : trained_families(), w.command = options.command;
    w.numbers = t.mean;
    for (float& number : w.numbers)
        number = half_to_float(float_to_half(number));
    return std::optional(std::move(w));
}

} // namespace burnish::mipnet
