// Dense Cholesky factors of the columns of a front.
#pragma once

#include <cmath>
#include <cstddef>

#include "blas.hpp"
#include "panel_solve.hpp"

namespace umform {

namespace detail {

/// Factors of few columns; the place of the first pivot that is not positive, or -1.
inline int narrow_cholesky(double* a, int ld, int rows, int columns) {
    for (int j = 0; j < columns; ++j) {
        double* column = a + static_cast<std::ptrdiff_t>(j) * ld;
        for (int k = 0; k < j; ++k) {
            const double* before = a + static_cast<std::ptrdiff_t>(k) * ld;
            const double factor = before[j];
            for (int i = j; i < columns; ++i) column[i] -= factor * before[i];
        }
        if (!(column[j] > 0.0)) return j;
        const double root = std::sqrt(column[j]), inverse = 1.0 / root;
        column[j] = root;
        for (int i = j + 1; i < columns; ++i) column[i] *= inverse;
    }
    SmallTriangle triangle;
    take_triangle(a, ld, columns, false, triangle);
    solve_rows(triangle, columns, a + columns, ld, rows - columns);
    return -1;
}

}  // namespace detail

/// Columns of a block in which a lower triangle is updated: less above the diagonal is wasted in narrow ones.
inline constexpr int block_width = 64;

/// C -= A B^T on and below the diagonal of C, of n columns and `rows` rows; A has k columns, B is the first n rows of its kind.
inline void update_lower(int rows, int n, int k, const double* a, int lda, const double* b, int ldb, double* c,
                         int ldc) {
    for (int j = 0; j < n; j += block_width) {
        const int width = std::min(block_width, n - j);
        blas().gemm('N', 'T', rows - j, width, k, -1.0, a + j, lda, b + j, ldb, 1.0,
                    c + j + static_cast<std::ptrdiff_t>(j) * ldc, ldc);
    }
}

/// L of the first columns of a front: L11 L11^T = A11, L21 = A21 L11^-T. Returns the place of the first pivot that is not
/// positive, or -1. Halves of the columns follow each other, so that nearly all work is in products.
inline int cholesky(double* a, int ld, int rows, int columns) {
    if (columns <= panel_width) return detail::narrow_cholesky(a, ld, rows, columns);
    const int left = (columns / 2 + 15) / 16 * 16, right = columns - left;
    int failed = cholesky(a, ld, rows, left);
    if (failed >= 0) return failed;
    double* rest = a + left + static_cast<std::ptrdiff_t>(left) * ld;
    update_lower(rows - left, right, left, a + left, ld, a + left, ld, rest, ld);
    failed = cholesky(rest, ld, rows - left, right);
    return failed < 0 ? -1 : left + failed;
}

}  // namespace umform
