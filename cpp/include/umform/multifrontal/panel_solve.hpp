// Rows times the inverse of a small triangular matrix: what is too narrow for BLAS.
#pragma once

#include <algorithm>

#include "umform/algebra/lanes.hpp"

namespace umform::multifrontal {

/// Columns up to which the kernels below are used; wider blocks are halved.
inline constexpr int panel_width = 32;

/// Lower triangular matrix of few columns, kept by rows with the inverse of its diagonal.
struct SmallTriangle {
    double entry[panel_width][panel_width];
    double inverse[panel_width];
};

namespace detail {

using Vector [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;
inline constexpr int deep = 8;  // rows that are processed together

/// Copies up to eight numbers; all of them by registers, which a loop of the compiler's own choice does not do.
inline void copy_rows(const double* from, int count, double* to) {
    if (count == deep) {
        for (int h = 0; h < 2; ++h)
            *reinterpret_cast<Vector*>(to + 4 * h) = *reinterpret_cast<const Vector*>(from + 4 * h);
        return;
    }
    for (int i = 0; i < count; ++i) to[i] = from[i];
}

}  // namespace detail

/// X := X L^-T for rows of X in the columns of a matrix: each row goes through the columns of L one after the other. Eight
/// rows together, four columns in registers.
inline void solve_rows(const SmallTriangle& lower, int width, double* x, int ld, int rows) {
    using detail::Vector;
    constexpr int deep = detail::deep;
    alignas(32) double buffer[panel_width][deep] = {};
    for (int first = 0; first < rows; first += deep) {
        const int count = std::min(deep, rows - first);
        for (int j = 0; j < width; ++j)
            detail::copy_rows(x + first + static_cast<std::ptrdiff_t>(j) * ld, count, buffer[j]);
        for (int j = 0; j < width; j += 4) {
            Lanes::Vector sum[4][2];
            for (int b = 0; b < 4; ++b)
                for (int h = 0; h < 2; ++h) sum[b][h] = *reinterpret_cast<const Vector*>(&buffer[j + b][4 * h]);
            for (int k = 0; k < j; ++k) {
                const Lanes::Vector low = *reinterpret_cast<const Vector*>(&buffer[k][0]);
                const Lanes::Vector high = *reinterpret_cast<const Vector*>(&buffer[k][4]);
                for (int b = 0; b < 4; ++b) {
                    const double factor = lower.entry[j + b][k];
                    sum[b][0] -= low * factor, sum[b][1] -= high * factor;
                }
            }
            for (int b = 0; b < 4; ++b) {
                for (int a = 0; a < b; ++a)
                    for (int h = 0; h < 2; ++h) sum[b][h] -= sum[a][h] * lower.entry[j + b][j + a];
                for (int h = 0; h < 2; ++h) {
                    sum[b][h] *= lower.inverse[j + b];
                    *reinterpret_cast<Vector*>(&buffer[j + b][4 * h]) = sum[b][h];
                }
            }
        }
        for (int j = 0; j < width; ++j)
            detail::copy_rows(buffer[j], count, x + first + static_cast<std::ptrdiff_t>(j) * ld);
    }
}

/// Takes over a lower triangle of `width` columns, with ones on the diagonal if `unit`; rows up to the next multiple of four
/// are those of the unit matrix.
inline void take_triangle(const double* a, int ld, int width, bool unit, SmallTriangle& out) {
    for (int i = 0; i < width; ++i) {
        for (int j = 0; j < i; ++j) out.entry[i][j] = a[i + static_cast<std::ptrdiff_t>(j) * ld];
        out.inverse[i] = unit ? 1.0 : 1.0 / a[i + static_cast<std::ptrdiff_t>(i) * ld];
    }
    for (int i = width; i % 4 != 0; ++i) {
        std::fill_n(out.entry[i], i, 0.0);
        out.inverse[i] = 1.0;
    }
}

}  // namespace umform::multifrontal
