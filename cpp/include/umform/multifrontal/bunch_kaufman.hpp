// L D L^T of a small block with the pivots of Bunch and Kaufman.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "umform/multifrontal/panel_solve.hpp"

namespace umform::multifrontal {

/// A pivot of two columns, [a b; b c], with b not small beside a and c: nothing overflows where the entries do not.
struct TwoByTwo {
    double a, c, b, scale;  // a and c as parts of b

    TwoByTwo(double first, double beside, double last)
        : a(first / beside), c(last / beside), b(beside), scale(1.0 / (a * c - 1.0) / b) {}

    /// (x, y) := (x, y) [a b; b c]^-1
    void solve(double& x, double& y) const {
        const double first = (c * x - y) * scale;
        y = (a * y - x) * scale;
        x = first;
    }

    /// Do rows with entries up to x and y give entries of L up to a limit? No, if anything is not finite.
    bool bounded(double x, double y, double limit) const {
        return std::abs(scale) * std::max(std::abs(c) * x + y, std::abs(a) * y + x) <= limit;
    }
};

/// (J. R. Bunch & L. Kaufman, Some stable methods for calculating inertia and solving symmetric linear systems, Math. Comp. 31
/// (1977) 163-179)
struct BunchKaufman {
    double entry[panel_width][panel_width];  // [column][row]: L below ones, which are not stored
    double diagonal[panel_width], below[panel_width];
    int exchange[panel_width];  // column that each has changed places with, before its elimination
    int done = 0;               // columns eliminated; less than all if only zeros remain

    BunchKaufman(const double* a, int ld, int size) {
        for (int j = 0; j < size; ++j) {
            std::copy_n(a + j + static_cast<std::ptrdiff_t>(j) * ld, size - j, entry[j] + j);
            exchange[j] = j, below[j] = 0.0;
        }
        while (done < size && step(size)) {
        }
    }

  private:
    bool step(int n) {
        const double alpha = 0.6403882032022076;  // (1 + sqrt(17)) / 8
        const int k = done;
        int r = k;
        const double here = std::abs(entry[k][k]), most = largest(k, n, r);
        if (!(std::max(here, most) > 0.0)) return false;
        if (here >= alpha * most) return one(n);
        int unused = 0;
        const double across = largest(r, n, unused), there = std::abs(entry[r][r]);
        if (here * across >= alpha * most * most) return one(n);
        if (there >= alpha * across) {
            swap(k, r, n);
            return one(n);
        }
        swap(k + 1, r, n);
        return two(n);
    }

    /// Largest entry beside the diagonal in a column of the rest, and its row.
    double largest(int column, int n, int& row) const {
        double most = 0.0;
        for (int i = done; i < n; ++i) {
            if (i == column) continue;
            const double here = std::abs(i > column ? entry[column][i] : entry[i][column]);
            if (here > most) most = here, row = i;
        }
        return most;
    }

    void swap(int p, int q, int n) {
        exchange[p] = q;
        if (p == q) return;
        for (int j = 0; j < p; ++j) std::swap(entry[j][p], entry[j][q]);
        std::swap(entry[p][p], entry[q][q]);
        for (int k = p + 1; k < q; ++k) std::swap(entry[p][k], entry[k][q]);
        for (int i = q + 1; i < n; ++i) std::swap(entry[p][i], entry[q][i]);
    }

    bool one(int n) {
        const int k = done++;
        diagonal[k] = entry[k][k];
        const double inverse = 1.0 / diagonal[k];
        for (int j = k + 1; j < n; ++j) {
            const double factor = entry[k][j] * inverse;
            for (int i = j; i < n; ++i) entry[j][i] -= entry[k][i] * factor;
        }
        for (int i = k + 1; i < n; ++i) entry[k][i] *= inverse;
        return true;
    }

    bool two(int n) {
        const int k = done;
        done += 2;
        diagonal[k] = entry[k][k], diagonal[k + 1] = entry[k + 1][k + 1], below[k] = entry[k][k + 1];
        entry[k][k + 1] = 0.0;
        const TwoByTwo pivot(diagonal[k], below[k], diagonal[k + 1]);
        for (int j = k + 2; j < n; ++j) {
            double x = entry[k][j], y = entry[k + 1][j];
            pivot.solve(x, y);
            for (int i = j; i < n; ++i) entry[j][i] -= entry[k][i] * x + entry[k + 1][i] * y;
            entry[k][j] = x, entry[k + 1][j] = y;
        }
        return true;
    }
};

}  // namespace umform::multifrontal
