// Products with the matrix as it was given.
#pragma once

#include <algorithm>
#include <cmath>

#include "umform/multifrontal/structure.hpp"

namespace umform::multifrontal {

/// R = B - f(K) X for columns of length n, f of each entry; of a symmetric matrix the upper triangle is stored.
template <class Entry>
void subtract_product(const Rows& rows, bool symmetric, const double* values, const double* b, const double* x,
                      int columns, double* r, const Entry& f) {
    for (int j = 0; j < columns; ++j, b += rows.n, x += rows.n, r += rows.n) {
        std::copy_n(b, rows.n, r);
        for (int i = 0; i < rows.n; ++i) {
            double sum = 0.0;
            const double mine = x[i];
            for (int k = rows.indptr[i]; k < rows.indptr[i + 1]; ++k) {
                const int column = rows.indices[k];
                sum += f(values[k]) * x[column];
                if (symmetric && column != i) r[column] -= f(values[k]) * mine;
            }
            r[i] -= sum;
        }
    }
}

/// R = B - K X.
inline void residual(const Rows& rows, bool symmetric, const double* values, const double* b, const double* x,
                     int columns, double* r) {
    subtract_product(rows, symmetric, values, b, x, columns, r, [](double value) { return value; });
}

/// r = b - |K| x.
inline void residual_of_magnitudes(const Rows& rows, bool symmetric, const double* values, const double* b,
                                   const double* x, double* r) {
    subtract_product(rows, symmetric, values, b, x, 1, r, [](double value) { return std::abs(value); });
}

}  // namespace umform::multifrontal
