// Dense Cholesky factors of the columns of a front.
#pragma once

#include <cmath>
#include <cstddef>

#include "umform/multifrontal/blas.hpp"
#include "umform/multifrontal/panel_solve.hpp"
#include "umform/multifrontal/panels.hpp"

namespace umform::multifrontal {

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

/// Columns from `first` to `last` of a front without what `count` others from `begin` on contribute: C -= A B^T on and below
/// the diagonal. b(row, column, ld) are rows of B from `row` on.
template <class Other>
void update_columns(const DenseColumns& a, int rows, int begin, int count, int first, int last, const Other& b) {
    for (int j = first, width = 0; j < last; j += width) {
        width = a.together(j, last - j);
        for (int k = begin, some = 0; k < begin + count; k += some) {
            some = a.together(k, begin + count - k);
            int ldb = 0;
            const double* other = b(j, k, ldb);
            update_lower(rows - j, width, some, a.at(j, k), a.stride(k), other, ldb, a.at(j, j), a.stride(j));
        }
    }
}

/// L of columns of a front: L11 L11^T = A11, L21 = A21 L11^-T. Returns the place of the first pivot that is not positive, or -1.
/// Halves of the columns follow each other, so that nearly all work is in products.
inline int cholesky(const DenseColumns& a, int rows, int begin, int count) {
    if (count <= panel_width) {
        const int failed = detail::narrow_cholesky(a.at(begin, begin), a.stride(begin), rows - begin, count);
        return failed < 0 ? -1 : begin + failed;
    }
    const int left = a.panels.half(begin, count), next = begin + left;
    const int failed = cholesky(a, rows, begin, left);
    if (failed >= 0) return failed;
    update_columns(a, rows, begin, left, next, begin + count, [&](int row, int column, int& ld) {
        ld = a.stride(column);
        return a.at(row, column);
    });
    return cholesky(a, rows, next, count - left);
}

}  // namespace umform::multifrontal
