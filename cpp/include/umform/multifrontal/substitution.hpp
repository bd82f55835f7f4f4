// Solution by the factors: forward through the tree, back from its roots.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "umform/multifrontal/factors.hpp"

namespace umform::multifrontal {

/// Solves K X = B for a few columns together: R K C Y = R B, X = C Y with the scales of rows and columns. The right-hand side of a front is changed by its children only, in their order:
/// the same bits for any number of threads.
class Substitution {
  public:
    static constexpr int most_columns = 16;

    Substitution(const Factors& factors, int columns, int threads)
        : factors_(factors), plan_(factors.plan()), columns_(columns), threads_(factors.schedule().solving(threads)),
          memory_(factors.lend((2 * static_cast<std::size_t>(plan_.n) + plan_.rows.size()) * columns)),
          right_(memory_.data()), found_(right_ + static_cast<std::ptrdiff_t>(plan_.n) * columns),
          carried_(found_ + static_cast<std::ptrdiff_t>(plan_.n) * columns), scratch_(threads_) {}

    /// Columns of b and x are `n` long, in the order of the equations.
    void run(const double* b, double* x) {
        const std::size_t n = plan_.n;
        const Scaling& scaling = factors_.scaling();
        const bool scaled = scaling.active();
        for (int j = 0; j < columns_; ++j)
            for (std::size_t i = 0; i < n; ++i)
                right_[j * n + plan_.place[i]] = scaled ? scaling.row[i] * b[j * n + i] : b[j * n + i];
        const OneBlasThread alone;
        factors_.schedule().run(
            plan_, threads_,
            [&](const Schedule::Unit& unit, int thread) {
                for (int f = unit.begin; f <= unit.root; ++f) forward(f, scratch_[thread]);
            },
            [&](int f, int thread) { forward(f, scratch_[thread]); });
        for (int f = static_cast<int>(plan_.fronts.size()) - 1; f >= 0; --f)
            if (factors_.schedule().above[f] != 0) back(f, scratch_[0]);
        factors_.schedule().run_units(threads_, [&](const Schedule::Unit& unit, int thread) {
            for (int f = unit.root; f >= unit.begin; --f) back(f, scratch_[thread]);
        });
        for (int j = 0; j < columns_; ++j)
            for (std::size_t i = 0; i < n; ++i) {
                const double y = found_[j * n + plan_.place[i]];
                x[j * n + i] = scaled ? scaling.column[i] * y : y;
            }
    }

  private:
    struct Scratch {
        std::vector<double> pivots, others;
    };
    const Factors& factors_;
    const Plan& plan_;
    int columns_, threads_;
    Lent memory_;
    double *right_, *found_, *carried_;  // by places; what fronts hand on to their parents
    std::vector<Scratch> scratch_;

    double& right(int place, int j) { return right_[static_cast<std::size_t>(j) * plan_.n + place]; }
    double& found(int place, int j) { return found_[static_cast<std::size_t>(j) * plan_.n + place]; }

    void forward(int f, Scratch& scratch) {
        const Front& planned = plan_.fronts[f];
        const Eliminated& front = factors_.front(f);
        const int u = planned.updates(), p = front.pivots, q = front.done;
        double* hand_on = carried_ + planned.rows * columns_;
        std::fill_n(hand_on, static_cast<std::size_t>(u) * columns_, 0.0);
        for (int k = plan_.children_start[f]; k < plan_.children_start[f + 1]; ++k)
            take_over(plan_.children[k], planned, hand_on);
        std::vector<double>& y = scratch.pivots;
        y.resize(static_cast<std::size_t>(p) * columns_);
        for (int j = 0; j < columns_; ++j)
            for (int t = 0; t < p; ++t) y[j * p + t] = right(factors_.row(f, t), j);
        const char unit = factors_.kind() == Kind::Positive ? 'N' : 'U';
        for (int k = 0, next = 0; k < q; k = next) {
            next = k + front.a.together(k, q - k);
            const int width = next - k, ld = front.a.stride(k);
            double* mine = y.data() + k;
            blas().divide('L', 'N', unit, width, front.a.at(k, k), ld, mine, p, columns_);
            blas().subtract('N', p - next, width, front.a.at(next, k), ld, mine, p, y.data() + next, p, columns_);
            blas().subtract('N', u, width, front.a.at(p, k), ld, mine, p, hand_on, u, columns_);
        }
        if (factors_.kind() == Kind::Symmetric) divide_by_diagonal(front, y.data(), p);
        for (int j = 0; j < columns_; ++j)
            for (int t = 0; t < p; ++t) right(factors_.row(f, t), j) = y[j * p + t];
    }

    /// Adds what a child hands on to the right-hand side of the pivots and to what the parent hands on.
    void take_over(int child, const Front& parent, double* hand_on) {
        const Front& planned = plan_.fronts[child];
        const int u = planned.updates(), there = parent.updates();
        const double* from = carried_ + planned.rows * columns_;
        const std::int32_t* seat = plan_.seat.data() + planned.rows;
        for (int j = 0; j < columns_; ++j)
            for (int i = 0; i < u; ++i) {
                const double value = from[static_cast<std::size_t>(j) * u + i];
                if (seat[i] < parent.pivots)
                    right(parent.first + seat[i], j) += value;
                else
                    hand_on[static_cast<std::size_t>(j) * there + seat[i] - parent.pivots] += value;
            }
    }

    void divide_by_diagonal(const Eliminated& front, double* y, int ld) {
        for (int t = 0; t < front.done; ++t) {
            const double d = *front.a.at(t, t);
            if (front.below[t] == 0.0) {
                for (int j = 0; j < columns_; ++j) y[j * ld + t] /= d;
                continue;
            }
            const TwoByTwo pivot(d, front.below[t], *front.a.at(t + 1, t + 1));
            for (int j = 0; j < columns_; ++j) pivot.solve(y[j * ld + t], y[j * ld + t + 1]);
            ++t;
        }
    }

    void back(int f, Scratch& scratch) {
        const Front& planned = plan_.fronts[f];
        const Eliminated& front = factors_.front(f);
        const int p = front.pivots, q = front.done, m = front.size, left = front.left(), order = front.order();
        std::vector<double>&y = scratch.pivots, &z = scratch.others;
        y.resize(static_cast<std::size_t>(q) * columns_), z.resize(static_cast<std::size_t>(order) * columns_);
        for (int j = 0; j < columns_; ++j) {
            for (int t = 0; t < q; ++t) y[j * q + t] = right(factors_.row(f, t), j);
            for (int t = 0; t < left; ++t) z[j * order + t] = found(factors_.column(f, q + t), j);
            for (int t = left; t < order; ++t) z[j * order + t] = found(plan_.rows[planned.rows + t - left], j);
        }
        if (factors_.kind() == Kind::Unsymmetric) {
            blas().subtract('N', q, left, front.a.column(q), m, z.data(), order, y.data(), q, columns_);
            blas().subtract('T', m - p, q, front.b(), std::max(1, m - p), z.data() + left, order, y.data(), q,
                            columns_);
            blas().divide('U', 'N', 'N', q, front.a.data, m, y.data(), q, columns_);
        } else {
            back_by_panels(front, y.data(), z.data());
        }
        for (int j = 0; j < columns_; ++j)
            for (int t = 0; t < q; ++t) found(factors_.column(f, t), j) = y[j * q + t];
    }

    /// y := L11^-T (y - L21^T z), from the last panel of columns to the first.
    void back_by_panels(const Eliminated& front, double* y, const double* z) {
        const int q = front.done, order = front.order();
        const char unit = factors_.kind() == Kind::Positive ? 'N' : 'U';
        for (int end = q, k = 0; end > 0; end = k) {
            k = front.a.begin(end - 1);
            const int width = end - k, ld = front.a.stride(k);
            blas().subtract('T', order, width, front.a.at(q, k), ld, z, order, y + k, q, columns_);
            blas().subtract('T', q - end, width, front.a.at(end, k), ld, y + end, q, y + k, q, columns_);
            blas().divide('L', 'T', unit, width, front.a.at(k, k), ld, y + k, q, columns_);
        }
    }
};

}  // namespace umform::multifrontal
