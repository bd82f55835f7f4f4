// Static condensation of the enhanced parameters: dense L D L^T of Kaa and the rank update of the element matrix.
#pragma once

#include <cmath>

namespace umform {

/// K(upper) += sign * A^T B for A, B of m rows, where A^T B is known to be symmetric; only j >= i is formed
/// (in blocks of four rows, which a vector unit likes; entries below the diagonal inside a block are not meaningful).
template <int Size>
void add_transposed_product(double* K, const double* A, const double* B, int m, double sign) {
    constexpr int step = 4;
    int i = 0;
    for (; i + step <= Size; i += step) {
        double* K0 = K + i * Size;
        double* K1 = K0 + Size;
        double* K2 = K1 + Size;
        double* K3 = K2 + Size;
        int row = 0;
        for (; row + 3 <= m; row += 3) {  // three rows at a time: fewer passes over K
            const double* A0 = A + row * Size + i;
            const double* A1 = A0 + Size;
            const double* A2 = A1 + Size;
            const double* B0 = B + row * Size;
            const double* B1 = B0 + Size;
            const double* B2 = B1 + Size;
            const double a00 = sign * A0[0], a01 = sign * A0[1], a02 = sign * A0[2], a03 = sign * A0[3];
            const double a10 = sign * A1[0], a11 = sign * A1[1], a12 = sign * A1[2], a13 = sign * A1[3];
            const double a20 = sign * A2[0], a21 = sign * A2[1], a22 = sign * A2[2], a23 = sign * A2[3];
#pragma omp simd
            for (int j = i; j < Size; ++j) {
                K0[j] += a00 * B0[j] + a10 * B1[j] + a20 * B2[j];
                K1[j] += a01 * B0[j] + a11 * B1[j] + a21 * B2[j];
                K2[j] += a02 * B0[j] + a12 * B1[j] + a22 * B2[j];
                K3[j] += a03 * B0[j] + a13 * B1[j] + a23 * B2[j];
            }
        }
        for (; row < m; ++row) {
            const double* A0 = A + row * Size + i;
            const double* B0 = B + row * Size;
            const double a0 = sign * A0[0], a1 = sign * A0[1], a2 = sign * A0[2], a3 = sign * A0[3];
#pragma omp simd
            for (int j = i; j < Size; ++j) {
                K0[j] += a0 * B0[j];
                K1[j] += a1 * B0[j];
                K2[j] += a2 * B0[j];
                K3[j] += a3 * B0[j];
            }
        }
    }
    for (; i < Size; ++i)
        for (int row = 0; row < m; ++row) {
            const double a = sign * A[row * Size + i];
#pragma omp simd
            for (int j = i; j < Size; ++j) K[i * Size + j] += a * B[row * Size + j];
        }
}

/// Factorises a symmetric n x n matrix (stored by rows, full) as L D L^T in place; false on a vanishing pivot. A pivot
/// is measured against its own diagonal entry: membrane and thickness modes of a thin element differ by (l / h)^4.
inline bool factor_ldlt(double* A, int n) {
    for (int j = 0; j < n; ++j) {
        const double diagonal = A[j * n + j];
        double d = diagonal;
        for (int k = 0; k < j; ++k) d -= A[j * n + k] * A[j * n + k] * A[k * n + k];
        if (!(std::abs(d) > 1e-13 * std::abs(diagonal))) return false;
        A[j * n + j] = d;
        for (int i = j + 1; i < n; ++i) {
            double sum = A[i * n + j];
            for (int k = 0; k < j; ++k) sum -= A[i * n + k] * A[j * n + k] * A[k * n + k];
            A[i * n + j] = sum / d;
        }
    }
    return true;
}

/// Solves (L D L^T) Y = Y in place for the `columns` columns of Y (stored by rows).
inline void solve_ldlt(const double* LD, int n, double* Y, int columns) {
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < i; ++k) {
            const double factor = LD[i * n + k];
#pragma omp simd
            for (int c = 0; c < columns; ++c) Y[i * columns + c] -= factor * Y[k * columns + c];
        }
    for (int i = 0; i < n; ++i) {
        const double factor = 1.0 / LD[i * n + i];
#pragma omp simd
        for (int c = 0; c < columns; ++c) Y[i * columns + c] *= factor;
    }
    for (int i = n - 1; i >= 0; --i)
        for (int k = i + 1; k < n; ++k) {
            const double factor = LD[k * n + i];
#pragma omp simd
            for (int c = 0; c < columns; ++c) Y[i * columns + c] -= factor * Y[k * columns + c];
        }
}

}  // namespace umform
