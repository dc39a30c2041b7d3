// Shared parts of the model tests: models with settings, directions, random numbers, integrals over directions.
#pragma once
#include <array>
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "tests/unit/models/model_fns.h"

namespace burnish::test {

using Vec = std::array<double, 3>;

Vec operator+(Vec a, Vec b);
Vec operator*(Vec a, double s);
double dot(Vec a, Vec b);
Vec unit(Vec a);
Vec direction(double theta, double phi);
Vec rounded(Vec a); // rounded to float

enum Traits : unsigned {
    kNoTraits = 0,
    kReciprocal = 1, // eval(wo, wi) = eval(wi, wo)
    kEnergy = 2,     // albedo at most 1
    kBounded = 4,    // weights at most 1
    kHalf = 8,       // samples come from half vectors and half_pdf exists
    kBothSides = 16, // transmits
};

struct Setting {
    std::vector<double> params;
    std::array<double, 2> widths; // of a GGX lobe that covers the model's lobe; 0 where no integral resolves it
    bool integrable() const { return widths[0] > 0; }
};

struct ModelCase {
    const char* name;
    unsigned traits;
    std::vector<Setting> settings;
};
inline void PrintTo(const ModelCase& model, std::ostream* out) // gtest would print bytes, including addresses
{
    *out << model.name;
}
const std::vector<ModelCase>& model_cases();
const ModelCase& model_case(const std::string& name);
ModelFns fns_of(const IsaFns& isa, const ModelCase& model);

class Random { // splitmix64
  public:
    explicit Random(std::uint64_t seed) : state(seed) {}
    double next();    // [0,1), a float
    Vec hemisphere(); // uniform, floats
  private:
    std::uint64_t state;
};

// Arguments of ModelFns for many pairs.
class Batch {
  public:
    Batch(const std::vector<double>& params, std::size_t count);
    void set(std::size_t k, Vec wo, Vec other);
    Vec wo(std::size_t k) const;
    std::vector<double> run(const Kernel& kernel) const;
    const std::vector<double>& arguments() const { return in; }
    int size() const { return static_cast<int>(n); }

  private:
    std::size_t n;
    std::vector<double> in;
};

// Maps the unit square to directions wi: through a GGX lobe for models with half vectors, else uniform over the (hemi)sphere.
struct Chart {
    Vec wo;
    bool half;
    double steepest; // uniform: largest angle to the normal, rad
    std::array<double, 2> widths;

    struct Point {
        Vec wi, h;
        double per_wi,
            per_h; // d wi / d(square), d h / d(square), sr; per_wi is 0 where wo does not reflect to wi
    };
    Point at(double u, double v) const;
    std::array<double, 2> of(Vec wi) const; // inverse of `at`: the square's point for wi
};
Chart chart_of(const ModelCase& model, const Setting& setting, Vec wo);

enum class Integrand { albedo, pdf, half_pdf };
// Integrates with the midpoint rule on grid x grid points, on the widest instruction set.
double integral(const ModelCase& model, const Setting& setting, Vec wo, Integrand what, int grid);

// Returns the unit views for testing a model, including downward views for transmitting models.
std::vector<Vec> views(const ModelCase& model);

} // namespace burnish::test
