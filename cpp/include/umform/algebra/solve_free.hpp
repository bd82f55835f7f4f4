// Elimination with row pivots of some of six equations.
#pragma once

#include <array>
#include <cmath>
#include <utility>

#include "umform/algebra/tensor.hpp"

namespace umform {

/// Solves the equations of the free components by elimination with row pivots; zero elsewhere.
inline Voigt solve_free(const Voigt66& C, const Voigt& r, const std::array<bool, 6>& free) {
    std::array<int, 6> of{};
    int n = 0;
    for (int p = 0; p < 6; ++p)
        if (free[p]) of[n++] = p;
    std::array<std::array<double, 7>, 6> A{};
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) A[i][j] = C(of[i], of[j]);
        A[i][n] = r[of[i]];
    }
    for (int k = 0; k < n; ++k) {
        int pivot = k;
        for (int i = k + 1; i < n; ++i)
            if (std::abs(A[i][k]) > std::abs(A[pivot][k])) pivot = i;
        std::swap(A[k], A[pivot]);
        for (int i = k + 1; i < n; ++i) {
            const double factor = A[i][k] / A[k][k];
            for (int j = k; j <= n; ++j) A[i][j] -= factor * A[k][j];
        }
    }
    Voigt x{};
    for (int k = n - 1; k >= 0; --k) {
        double sum = A[k][n];
        for (int j = k + 1; j < n; ++j) sum -= A[k][j] * x[of[j]];
        x[of[k]] = sum / A[k][k];
    }
    return x;
}

}  // namespace umform
