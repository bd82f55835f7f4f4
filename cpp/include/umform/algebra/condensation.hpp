// Dense algebra of the elements in the lanes: products A^T B by tiles, L D L^T and L U of Kaa for the static condensation.
#pragma once

#include "umform/algebra/tensor.hpp"

namespace umform {

/// Rows of a matrix, in blocks that follow each other at a constant distance.
struct RowSet {
    int blocks, rows;  // rows of a block
    int block_stride, row_stride;
};

/// 3 x 3 entries of a matrix; with three of A and three of B they fit into the sixteen registers of AVX2.
inline constexpr int tile = 3;
template <class Real>
using Tile = Mat<Real, tile, tile>;

/// Forms A^T B tile by tile, in registers over all rows, and hands each to add(i, j, tile), the entries (i.., j..).
/// `upper`: only tiles on and above the diagonal, for products that are known to be symmetric.
template <int Columns, class Real, class Add>
void transposed_product(const RowSet& set, const Real* A, const Real* B, bool upper, const Add& add) {
    static_assert(Columns % tile == 0);
    for (int i = 0; i < Columns; i += tile)
        for (int j = upper ? i : 0; j < Columns; j += tile) {
            Tile<Real> sum;
            for (int block = 0; block < set.blocks; ++block) {
                const Real* a = A + block * set.block_stride + i;
                const Real* b = B + block * set.block_stride + j;
                for (int row = 0; row < set.rows; ++row, a += set.row_stride, b += set.row_stride)
#pragma GCC unroll 3
                    for (int m = 0; m < tile; ++m)
#pragma GCC unroll 3
                        for (int n = 0; n < tile; ++n) sum(m, n) += a[m] * b[n];
            }
            add(i, j, sum);
        }
}

/// M(i.., j..) += factor * tile, for M with `Columns` columns.
template <int Columns, class Real>
void add_tile(Real* M, int i, int j, double factor, const Tile<Real>& values) {
    for (int m = 0; m < tile; ++m)
        for (int n = 0; n < tile; ++n) M[(i + m) * Columns + j + n] += factor * values(m, n);
}

/// M(j.., i..) += factor * tile^T.
template <int Columns, class Real>
void add_transposed_tile(Real* M, int i, int j, double factor, const Tile<Real>& values) {
    for (int n = 0; n < tile; ++n)
        for (int m = 0; m < tile; ++m) M[(j + n) * Columns + i + m] += factor * values(m, n);
}

/// Factorises a symmetric n x n matrix (stored by rows, its lower triangle is read) as L D L^T in place; false on a vanishing
/// pivot. A pivot is measured against its own diagonal entry: membrane and thickness modes of a thin element differ by
/// (l / h)^4.
template <class Real>
Mask<Real> factor_ldlt(Real* A, int n) {
    Mask<Real> regular = true;
    for (int j = 0; j < n; ++j) {
        const Real diagonal = A[j * n + j];
        Real d = diagonal;
        for (int k = 0; k < j; ++k) d -= A[j * n + k] * A[j * n + k] * A[k * n + k];
        regular = regular & (abs(d) > 1e-13 * abs(diagonal));
        A[j * n + j] = d;
        const Real reciprocal = 1.0 / d;
        for (int i = j + 1; i < n; ++i) {
            Real sum = A[i * n + j];
            for (int k = 0; k < j; ++k) sum -= A[i * n + k] * A[j * n + k] * A[k * n + k];
            A[i * n + j] = sum * reciprocal;
        }
    }
    return regular;
}

/// Solves (L D L^T) Y = Y in place for the `columns` columns of Y (stored by rows).
template <class Real>
void solve_ldlt(const Real* LD, int n, Real* Y, int columns) {
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < i; ++k) {
            const Real factor = LD[i * n + k];
            for (int c = 0; c < columns; ++c) Y[i * columns + c] -= factor * Y[k * columns + c];
        }
    for (int i = 0; i < n; ++i) {
        const Real reciprocal = 1.0 / LD[i * n + i];
        for (int c = 0; c < columns; ++c) Y[i * columns + c] *= reciprocal;
    }
    for (int i = n - 1; i >= 0; --i)
        for (int k = i + 1; k < n; ++k) {
            const Real factor = LD[k * n + i];
            for (int c = 0; c < columns; ++c) Y[i * columns + c] -= factor * Y[k * columns + c];
        }
}

/// Factorises an n x n matrix (stored by rows) as L U in place, with ones on the diagonal of L; false on a vanishing pivot, which
/// is measured as in `factor_ldlt`. Rows are not exchanged: that would differ from lane to lane. The matrices of condensation
/// have a positive symmetric part as long as their element is stable, and need none.
template <class Real>
Mask<Real> factor_lu(Real* A, int n) {
    Mask<Real> regular = true;
    for (int i = 0; i < n; ++i) {
        const Real diagonal = A[i * n + i];
        for (int k = 0; k < i; ++k) {
            const Real factor = A[i * n + k] / A[k * n + k];
            A[i * n + k] = factor;
            for (int j = k + 1; j < n; ++j) A[i * n + j] -= factor * A[k * n + j];
        }
        regular = regular & (abs(A[i * n + i]) > 1e-13 * abs(diagonal));
    }
    return regular;
}

/// Solves (L U) Y = Y in place for the `columns` columns of Y (stored by rows).
template <class Real>
void solve_lu(const Real* LU, int n, Real* Y, int columns) {
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < i; ++k)
            for (int c = 0; c < columns; ++c) Y[i * columns + c] -= LU[i * n + k] * Y[k * columns + c];
    for (int i = n - 1; i >= 0; --i) {
        for (int k = i + 1; k < n; ++k)
            for (int c = 0; c < columns; ++c) Y[i * columns + c] -= LU[i * n + k] * Y[k * columns + c];
        const Real reciprocal = 1.0 / LU[i * n + i];
        for (int c = 0; c < columns; ++c) Y[i * columns + c] *= reciprocal;
    }
}

}  // namespace umform
