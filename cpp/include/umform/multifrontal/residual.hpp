// Products with the matrix as it was given.
#pragma once

#include <algorithm>

#include "structure.hpp"

namespace umform {

/// R = B - K X for columns of length n; of a symmetric matrix the upper triangle is stored.
inline void residual(const Rows& rows, bool symmetric, const double* values, const double* b, const double* x,
                     int columns, double* r) {
    for (int j = 0; j < columns; ++j, b += rows.n, x += rows.n, r += rows.n) {
        std::copy_n(b, rows.n, r);
        for (int i = 0; i < rows.n; ++i) {
            double sum = 0.0;
            const double mine = x[i];
            for (int k = rows.indptr[i]; k < rows.indptr[i + 1]; ++k) {
                const int column = rows.indices[k];
                sum += values[k] * x[column];
                if (symmetric && column != i) r[column] -= values[k] * mine;
            }
            r[i] -= sum;
        }
    }
}

}  // namespace umform
