#include "tests/unit/adversary/search.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/unit/models/float_error.h"
#include "tests/unit/models/harness.h"

namespace burnish::test {
namespace {

constexpr double kLeast = 1e-12;
constexpr std::size_t kChunk = 4096;

TexelView texels_of(const Domain& d)
{
    return d.texels ? d.texels() : TexelView{};
}

// Returns points [argument][point] from rows of numbers, rounded to floats.
std::vector<double> arguments_of(const Domain& d, const std::vector<double>& numbers)
{
    const std::size_t m = static_cast<std::size_t>(d.numbers), n = numbers.size() / m;
    std::vector<double> in;
    for (std::size_t k = 0; k < n; ++k) {
        const std::vector<double> a = d.make(d, numbers.data() + k * m);
        in.resize(a.size() * n);
        for (std::size_t i = 0; i < a.size(); ++i)
            in[i * n + k] = rounded({a[i], 0, 0})[0];
    }
    return in;
}

std::vector<double> picked(const std::vector<double>& in, std::size_t n, const std::vector<std::size_t>& points)
{
    std::vector<double> out;
    for (std::size_t i = 0; i < in.size() / n; ++i)
        for (const std::size_t k : points)
            out.push_back(in[i * n + k]);
    return out;
}

double unit_of(Unit unit, double reference)
{
    return unit == Unit::whole ? 0x1p-24 : ulp(reference, kLeast);
}

// Results in floats and doubles, and the doubles' movement when each argument moves by a float step, summed.
struct Looked {
    const Kernel& exact;
    TexelView texels;
    std::size_t n;
    const std::vector<double>& in;
    std::vector<double> value, reference;

    Looked(const Domain& d, const std::vector<double>& points)
        : exact(kernel(oracle_fns(), d.kernel.c_str())), texels(texels_of(d)), n(points.size() / static_cast<std::size_t>(exact.inputs)),
          in(points), value(run(kernel(fast_fns(), d.kernel.c_str()), points, texels)), reference(run(exact, points, texels))
    {
    }
    double error(std::size_t at) const
    {
        if (!std::isfinite(value[at]) && std::isfinite(reference[at]))
            return std::numeric_limits<double>::infinity();
        return std::isfinite(reference[at]) ? std::abs(value[at] - reference[at]) : 0.0;
    }
    // Returns the error in units alone, an upper bound of the score, since sway lowers the score.
    double most(const Judged& j, std::size_t k) const
    {
        double largest = 0.0;
        for (int c = j.first; c < j.first + j.count; ++c) {
            const std::size_t at = static_cast<std::size_t>(c) * n + k;
            largest = std::max(largest, error(at) / unit_of(j.unit, reference[at]));
        }
        return largest;
    }
    bool left_out(const Domain& d, std::size_t k) const
    {
        const std::size_t at = static_cast<std::size_t>(std::max(d.same, 0)) * n + k;
        return d.same >= 0 && value[at] != reference[at];
    }
};

std::vector<double> sway_of_each(const Looked& l, const std::vector<std::size_t>& points)
{
    const std::size_t n = points.size(), results = static_cast<std::size_t>(l.exact.outputs);
    const std::vector<double> in = picked(l.in, l.n, points), reference = picked(l.reference, l.n, points);
    std::vector<double> sum(results * n);
    for (std::size_t i = 0; i < in.size() / n; ++i) {
        std::vector<double> far(results * n);
        for (const double step : {-0x1p-23, 0x1p-23}) {
            std::vector<double> nudged = in;
            for (std::size_t k = 0; k < n; ++k)
                nudged[i * n + k] *= 1.0 + step;
            const std::vector<double> moved = run(l.exact, nudged, l.texels);
            for (std::size_t at = 0; at < far.size(); ++at)
                far[at] = std::max(far[at], std::abs(moved[at] - reference[at]));
        }
        for (std::size_t at = 0; at < far.size(); ++at)
            sum[at] += std::isfinite(far[at]) ? far[at] : 0.0;
    }
    return sum;
}

// Returns the scores of points that may exceed `least`, and 0 for the others.
std::vector<Worst> scores(const Domain& d, const Judged& j, const std::vector<double>& in, const std::vector<double>& least)
{
    const Looked l(d, in);
    std::vector<Worst> out(l.n);
    std::vector<std::size_t> asked;
    for (std::size_t k = 0; k < l.n; ++k)
        if (!l.left_out(d, k) && l.most(j, k) > least[k])
            asked.push_back(k);
    if (asked.empty())
        return out;
    const std::vector<double> sway = sway_of_each(l, asked);
    for (std::size_t p = 0; p < asked.size(); ++p) {
        const std::size_t k = asked[p];
        for (int c = j.first; c < j.first + j.count; ++c) {
            const std::size_t at = static_cast<std::size_t>(c) * l.n + k;
            const double unit = unit_of(j.unit, l.reference[at]), error = l.error(at),
                         score = error / (unit + sway[static_cast<std::size_t>(c) * asked.size() + p]);
            if (score > out[k].score)
                out[k] = {score, error / unit, error, {}};
        }
        out[k].in = picked(in, l.n, {k});
    }
    return out;
}

struct Start {
    double score;
    std::vector<double> numbers;
};
bool worse(const Start& a, const Start& b)
{
    return a.score > b.score;
}

Worst climbed(const Domain& d, const Judged& j, std::vector<Start> starts)
{
    Worst worst;
    const std::size_t m = static_cast<std::size_t>(d.numbers);
    for (int bits = 2; bits <= 44 && !starts.empty(); bits += 2)
        for (std::size_t c = 0; c < m; ++c)
            for (const double step : {std::ldexp(1.0, -bits), -std::ldexp(1.0, -bits)}) {
                std::vector<double> numbers, least;
                for (const Start& s : starts) {
                    numbers.insert(numbers.end(), s.numbers.begin(), s.numbers.end());
                    double& x = numbers[numbers.size() - m + c];
                    x = x + step - std::floor(x + step);
                    least.push_back(s.score);
                }
                const std::vector<Worst> found = scores(d, j, arguments_of(d, numbers), least);
                for (std::size_t k = 0; k < starts.size(); ++k)
                    if (found[k].score > starts[k].score) {
                        starts[k] = {found[k].score, std::vector<double>(numbers.begin() + static_cast<std::ptrdiff_t>(k * m),
                                                                         numbers.begin() + static_cast<std::ptrdiff_t>((k + 1) * m))};
                        if (found[k].score > worst.score)
                            worst = found[k];
                    }
            }
    return worst;
}

} // namespace

std::vector<Worst> errors_at(const Domain& d, const Judged& j, const std::vector<double>& in)
{
    const std::size_t n = in.size() / static_cast<std::size_t>(kernel(oracle_fns(), d.kernel.c_str()).inputs);
    return scores(d, j, in, std::vector<double>(n, 0.0));
}

std::vector<Worst> search(const Domain& d, double count, std::uint64_t seed)
{
    const std::size_t climbers = static_cast<std::size_t>(std::clamp(count / 4000.0, 25.0, 1000.0)),
                      m = static_cast<std::size_t>(d.numbers);
    std::vector<std::vector<Start>> worst(d.judged.size()); // heaps with the smallest on top
    std::vector<Worst> out(d.judged.size());
    Random random(seed);
    for (double drawn = 0.0; drawn < count; drawn += static_cast<double>(kChunk)) {
        std::vector<double> numbers(kChunk * m);
        for (double& x : numbers)
            x = random.next() + 0x1p-24 * random.next();
        const std::vector<double> in = arguments_of(d, numbers);
        for (std::size_t r = 0; r < worst.size(); ++r) {
            std::vector<Start>& heap = worst[r];
            const double least = heap.size() < climbers ? 0.0 : heap.front().score;
            const std::vector<Worst> found = scores(d, d.judged[r], in, std::vector<double>(kChunk, least));
            for (std::size_t k = 0; k < kChunk; ++k) {
                if (found[k].score > out[r].score)
                    out[r] = found[k];
                if (found[k].score <= (heap.size() < climbers ? 0.0 : heap.front().score))
                    continue;
                heap.push_back({found[k].score, std::vector<double>(numbers.begin() + static_cast<std::ptrdiff_t>(k * m),
                                                                    numbers.begin() + static_cast<std::ptrdiff_t>((k + 1) * m))});
                std::push_heap(heap.begin(), heap.end(), worse);
                if (heap.size() > climbers)
                    std::pop_heap(heap.begin(), heap.end(), worse), heap.pop_back();
            }
        }
    }
    for (std::size_t r = 0; r < worst.size(); ++r) {
        Worst top = climbed(d, d.judged[r], worst[r]);
        if (top.score > out[r].score)
            out[r] = std::move(top);
    }
    return out;
}

} // namespace burnish::test
