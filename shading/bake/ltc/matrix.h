// 3x3 matrices in double for fits of linearly transformed cosines. They use only + - * / and roots, so every compiler gives the same bits.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>

namespace burnish::ltc {

struct Vec {
    double x, y, z;
};

// Row-major, element (row, column) at 3 row + column. For a transformed cosine: from the cosine's space to the lobe's.
using Matrix = std::array<double, 9>;

inline double dot(const Vec& a, const Vec& b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline Vec cross(const Vec& a, const Vec& b)
{
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline Vec scaled(const Vec& a, double s)
{
    return {a.x * s, a.y * s, a.z * s};
}

inline Vec unit(const Vec& a)
{
    return scaled(a, 1.0 / std::sqrt(dot(a, a)));
}

inline Vec operator*(const Matrix& m, const Vec& v)
{
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[3] * v.x + m[4] * v.y + m[5] * v.z, m[6] * v.x + m[7] * v.y + m[8] * v.z};
}

inline Matrix operator*(const Matrix& a, const Matrix& b)
{
    Matrix m;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            m[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
    return m;
}

inline double determinant(const Matrix& m)
{
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
}

inline Matrix inverse(const Matrix& m)
{
    const double s = 1.0 / determinant(m);
    return {(m[4] * m[8] - m[5] * m[7]) * s, (m[2] * m[7] - m[1] * m[8]) * s, (m[1] * m[5] - m[2] * m[4]) * s,
            (m[5] * m[6] - m[3] * m[8]) * s, (m[0] * m[8] - m[2] * m[6]) * s, (m[2] * m[3] - m[0] * m[5]) * s,
            (m[3] * m[7] - m[4] * m[6]) * s, (m[1] * m[6] - m[0] * m[7]) * s, (m[0] * m[4] - m[1] * m[3]) * s};
}

// Scales a matrix to a unit third column, the scale for interpolation. The density does not change.
inline Matrix with_unit_axis(const Matrix& m)
{
    const double s = 1.0 / std::sqrt(m[2] * m[2] + m[5] * m[5] + m[8] * m[8]);
    Matrix r;
    for (std::size_t e = 0; e < 9; ++e)
        r[e] = m[e] * s;
    return r;
}

// Returns P M P, where P exchanges x and y: the lobe mirrored at the plane between the axes, with its gauge mirrored too.
inline Matrix with_axes_exchanged(const Matrix& m)
{
    return {m[4], m[3], m[5], m[1], m[0], m[2], m[7], m[6], m[8]};
}

} // namespace burnish::ltc
