// A cascade's two nets as one list of numbers. H_A makes a texel from four. H_B uses sixteen, the four and H_A's result.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "shading/bake/mipnet/mipnet_fns.h"

namespace burnish::mipnet {

struct Hidden { // hidden layers, all with one width
    int layers = 2, width = 32;
    bool operator==(const Hidden&) const = default;
};
struct Shape { // b.layers 0: no H_B, H_A makes every level
    Lobe lobe = Lobe::ggx_aniso;
    Layout layout = Layout::cov;
    Hidden a = {2, 32}, b = {2, 64};
    bool far = false; // H_B also sees the sixty-four texels below: a footprint of 8 x 8
    bool operator==(const Shape&) const = default;
};
inline constexpr int kMostWidth = 4096, kMostHidden = kMostLayers - 1;

Plan plan_of(const Shape& shape);

const char* lobe_name(Lobe lobe); // as in the registry of models
const char* layout_name(Layout layout);
std::string size_name(const Shape& shape); // "2x32/2x64", hidden layers x units of H_A and H_B; "2x32" without H_B
bool read_size(const std::string& name, Shape& to);

// Returns initial numbers: hidden layers uniform within 1 / sqrt(inputs) of 0, output layers 0. So a net starts at its closed form.
std::vector<float> start_weights(const Plan& plan, std::uint64_t seed);

// Returns the numbers with each layer's weights transposed to [input][output].
template <class T> std::vector<T> turned_weights(const Plan& plan, const std::vector<T>& weights)
{
    std::vector<T> turned = weights;
    for (const Dense* d : {&plan.a, &plan.b})
        for (int l = 0; l < d->count; ++l) {
            const std::size_t in = static_cast<std::size_t>(d->width[l]), out = static_cast<std::size_t>(d->width[l + 1]);
            for (std::size_t o = 0; o < out; ++o)
                for (std::size_t f = 0; f < in; ++f)
                    turned[d->weights[l] + f * out + o] = weights[d->weights[l] + o * in + f];
        }
    return turned;
}

// Random numbers, equal everywhere: a counter through a mixing function (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number
// generators").
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    std::uint64_t bits()
    {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
        z = (z ^ z >> 27) * 0x94d049bb133111ebu;
        return z ^ z >> 31;
    }
    double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; } // [0,1)
    double between(double low, double high) { return low + (high - low) * unit(); }
    int below(int count) { return static_cast<int>(unit() * count); }

  private:
    std::uint64_t state_;
};

} // namespace burnish::mipnet
