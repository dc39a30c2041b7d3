#include "tests/unit/techniques/kernels.h"
#include "shading/surface/lobe.k.h"
#include "shading/surface/surface.k.h"
#include "shading/techniques/bent_normal.k.h"
#include "shading/techniques/lobe_line.k.h"
#include "shading/techniques/major_axis.k.h"

namespace burnish {
inline namespace BN_ISA_NS {

namespace {

// Every lane gets the same input; the last one gives the result.
real in_lane(double x)
{
    return lit(x);
}
real3 in_lanes3(const double* x)
{
    return vec3_of(lit(x[0]), lit(x[1]), lit(x[2]));
}
double of_lane(real x)
{
#ifdef BN_ORACLE
    return x;
#else
    float lanes[kLanes];
    store(lanes, x);
    return static_cast<double>(lanes[kLanes - 1]);
#endif
}
void of_lanes3(real3 v, double* to)
{
    to[0] = of_lane(v.x), to[1] = of_lane(v.y), to[2] = of_lane(v.z);
}

void major_axis(const double in[8], double out[11])
{
    const real k = in_lane(in[5]);
    real3 o = in_lanes3(in);
    const major_axis_line line = major_axis_setup(o, in_lane(in[3]), in_lane(in[4]), k, in_lane(in[6]), lit(1.0) / in_lane(in[7]));
    const major_axis_ends ends = major_axis_extrema(k_normalize3(o), k * in_lane(in[3]), k * in_lane(in[4]));
    out[0] = of_lane(ends.t_near), out[1] = of_lane(ends.t_far);
    of_lanes3(line.e0, out + 2);
    of_lanes3(line.e1, out + 5);
    out[8] = of_lane(line.radius), out[9] = of_lane(line.extent), out[10] = of_lane(line.width);
}

void direction(const double in[10], double out[3])
{
    const real3 e0 = in_lanes3(in), e1 = in_lanes3(in + 3);
    of_lanes3(k_normalize3(major_axis_direction(major_axis_curve_of(e0, e1 - e0, in_lanes3(in + 6)), in_lane(in[9]))), out);
}

// Of samples, as major_axis_adaptive takes them: one in the middle and a pair a cell.
void grain_count(const double in[8], double out[2])
{
    const major_axis_grain grain = major_axis_grain_of(in_lanes3(in), in_lane(in[3]), in_lane(in[4]), in_lane(in[5]));
    const real first = major_axis_grain_count(grain, in_lane(in[6]), in_lane(in[7]));
    const real count = major_axis_limited_count(grain, in_lane(in[3]), in_lane(in[4]), in_lane(in[5]), in_lane(in[6]), first);
    out[0] = of_lane(count), out[1] = 1.0;
    for (int i = 1; of_lane(major_axis_grain_cell(count, i).weight) > 0.0; ++i)
        out[1] += 2.0;
}

void line(const double in[7], double out[10])
{
    const lobe_line l = lobe_line_of(in_lanes3(in), in_lane(in[3]), in_lane(in[4]));
    const real count = lobe_line_count(l, in_lane(in[5]));
    out[0] = of_lane(l.along.x), out[1] = of_lane(l.along.y), out[2] = of_lane(l.width), out[3] = of_lane(count);
    out[4] = 1.0;
    for (int i = 1; of_lane(lobe_line_cell_of(count, i).weight) > 0.0; ++i)
        out[4] += 2.0 * of_lane(lobe_line_cell_of(count, i).weight);
    const lobe_line_sample s = lobe_line_at(l, in_lane(in[6]));
    of_lanes3(s.direction, out + 5);
    out[8] = of_lane(s.weight), out[9] = of_lane(s.radius);
}

void bent_normal(const double in[5], double out[4])
{
    const real zero = lit(0.0), one = lit(1.0);
    aniso_lobe lobe;
    lobe.u_axis = vec3_of(one, zero, zero), lobe.v_axis = vec3_of(zero, one, zero);
    lobe.sigma_u = in_lane(in[3]), lobe.sigma_v = in_lane(in[4]);
    const bent_ray r = bent_normal_ray(vec3_of(zero, zero, one), in_lanes3(in), lobe);
    of_lanes3(r.direction, out);
    out[3] = of_lane(r.lod);
}

void frame(const double in[10], double out[9])
{
    const surface_frame own = geometric_frame(in_lanes3(in), in_lanes3(in + 3), in_lane(in[6]));
    const surface_frame f = mapped_frame(own, in_lanes3(in + 7), in_lane(in[6]));
    of_lanes3(f.n, out), of_lanes3(f.t, out + 3), of_lanes3(f.b, out + 6);
}

constexpr test::TechniqueKernels kFns = {BN_ISA_NAME, major_axis, direction, grain_count, line, bent_normal, frame};

} // namespace

BN_DEFINE_FNS(test::TechniqueKernels, kFns)

} // namespace BN_ISA_NS
} // namespace burnish
