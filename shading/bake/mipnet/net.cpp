#include "shading/bake/mipnet/net.h"

#include <charconv>
#include <cmath>
#include <fmt/format.h>

#include "core/base/check.h"

namespace burnish::mipnet {
namespace {

// Numbers of inputs by layout and net: cascade.h
constexpr int kInputs[2][2] = {{20, 105}, {26, 111}};

Dense layers_of(int inputs, const Hidden& hidden, std::size_t& next)
{
    BN_CHECK(hidden.layers >= 1 && hidden.layers <= kMostHidden && hidden.width >= 1 && hidden.width <= kMostWidth);
    Dense d;
    d.count = hidden.layers + 1;
    d.width[0] = inputs;
    for (int l = 0; l < d.count; ++l) {
        d.width[l + 1] = l + 1 < d.count ? hidden.width : kChannels;
        d.weights[l] = next;
        next += static_cast<std::size_t>(d.width[l]) * static_cast<std::size_t>(d.width[l + 1]);
        d.bias[l] = next;
        next += static_cast<std::size_t>(d.width[l + 1]);
    }
    return d;
}

} // namespace

Plan plan_of(const Shape& shape)
{
    const int* inputs = kInputs[static_cast<int>(shape.layout)];
    Plan plan;
    plan.lobe = shape.lobe, plan.layout = shape.layout;
    plan.a = layers_of(inputs[0], shape.a, plan.count);
    if (shape.b.layers > 0)
        plan.b = layers_of(inputs[1] + (shape.far ? 64 * kChannels : 0), shape.b, plan.count), plan.far = shape.far;
    plan.kappa = plan.count;
    plan.count += 2;
    return plan;
}

const char* lobe_name(Lobe lobe)
{
    return lobe == Lobe::ggx_aniso ? "ggx_aniso" : lobe == Lobe::beckmann ? "beckmann" : "ashikhmin_shirley";
}

const char* layout_name(Layout layout)
{
    return layout == Layout::cov ? "cov" : "paper";
}

std::string size_name(const Shape& s)
{
    const std::string a = fmt::format("{}x{}", s.a.layers, s.a.width);
    return s.b.layers == 0 ? a : a + fmt::format("/{}x{}", s.b.layers, s.b.width);
}

bool read_size(const std::string& name, Shape& to)
{
    Hidden read[2] = {{}, {0, 0}};
    const char *at = name.data(), *const end = at + name.size();
    for (int net = 0; net < 2; ++net) {
        int* const numbers[] = {&read[net].layers, &read[net].width};
        for (int i = 0; i < 2; ++i) {
            const std::from_chars_result found = std::from_chars(at, end, *numbers[i]);
            if (found.ec != std::errc() || *numbers[i] < 1 || *numbers[i] > (i == 0 ? kMostHidden : kMostWidth))
                return false;
            at = found.ptr;
            if (i == 0 && (at == end || *at++ != 'x'))
                return false;
        }
        if (at == end)
            break;
        if (net == 1 || *at++ != '/')
            return false;
    }
    to.a = read[0], to.b = read[1];
    return true;
}

std::vector<float> start_weights(const Plan& plan, std::uint64_t seed)
{
    Random random(seed);
    std::vector<float> weights(plan.count, 0.0f);
    for (const Dense* d : {&plan.a, &plan.b})
        for (int l = 0; l + 1 < d->count; ++l) {
            const double most = 1.0 / std::sqrt(static_cast<double>(d->width[l]));
            const std::size_t end = d->bias[l] + static_cast<std::size_t>(d->width[l + 1]);
            for (std::size_t i = d->weights[l]; i < end; ++i)
                weights[i] = static_cast<float>(random.between(-most, most));
        }
    // Best common kappa for all reliefs: about a third of GGX's covariance, more for lobes with shorter tails.
    weights[plan.kappa] = plan.lobe == Lobe::ggx_aniso ? 0.35f : 0.8f;
    return weights;
}

} // namespace burnish::mipnet
