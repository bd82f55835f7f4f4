// Dense L U factors of the columns and rows of a front.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "umform/multifrontal/blas.hpp"
#include "umform/multifrontal/by_halves.hpp"
#include "umform/multifrontal/panel_solve.hpp"

namespace umform::multifrontal {

/// Rows and columns of a front that are eliminated as far as stable pivots are found; see `Indefinite`. Of the columns of a
/// block the pivot is on the diagonal if no entry there is ten times larger, else that entry. L has ones on its diagonal.
class Unsymmetric : ByHalves<Unsymmetric> {
    friend ByHalves<Unsymmetric>;

  public:
    static constexpr double tolerance = 0.01;  // of an entry beside all of its column
    static constexpr double diagonal = 0.1;    // of that on the diagonal beside those that may take its place

    /// `a` has `columns` columns of `rows` rows, `b` the transpose of as many rows beyond those columns.
    Unsymmetric(double* a, double* b, int rows, int columns, std::vector<std::int32_t>& row_order,
                std::vector<std::int32_t>& column_order)
        : a_(a), b_(b), rows_(rows), columns_(columns), beyond_(rows - columns), row_order_(row_order),
          column_order_(column_order) {}

    /// Number of columns that were eliminated. `empty` is a column without entries, or -1: the matrix is singular.
    int run(int& empty) {
        empty = -1;
        done_ = eliminate(0, columns_);
        while (done_ < columns_ && empty < 0)
            if (!search(empty)) break;
        return done_;
    }

    bool exchanged() const { return exchanged_; }

  private:
    double *a_, *b_;
    int rows_, columns_, beyond_, done_ = 0, next_ = 0;  // where the search continues
    bool exchanged_ = false;
    std::vector<std::int32_t>&row_order_, &column_order_;
    std::vector<double> kept_;

    double* at(int i, int j) { return a_ + i + static_cast<std::ptrdiff_t>(j) * rows_; }
    Panels panels() const { return Panels::of_factor(rows_, columns_, false); }
    double* row_beyond(int i) { return b_ + static_cast<std::ptrdiff_t>(i) * beyond_; }

    /// Eliminates a block up to the first column that fails; returns how many.
    int try_block(int begin, int count) {
        double block[panel_width][panel_width];  // [column][row]
        int good = factor_block(begin, count, block);
        const int under = begin + count, height = rows_ - under;
        const std::size_t all = static_cast<std::size_t>(rows_ - begin);
        kept_.resize(count * all);
        for (int k = 0; k < count; ++k) std::copy_n(at(begin, begin + k), all, &kept_[k * all]);
        SmallTriangle triangle;
        for (int i = 0; i < good; ++i) {  // U^T
            std::copy_n(block[i], i, triangle.entry[i]);
            triangle.inverse[i] = 1.0 / block[i][i];
        }
        for (int i = good; i % 4 != 0; ++i) std::fill_n(triangle.entry[i], i, 0.0), triangle.inverse[i] = 1.0;
        solve_rows(triangle, good, at(under, begin), rows_, height);
        good = acceptable(under, begin, good);
        for (int k = 0; k < count; ++k) {
            if (k < good)
                std::copy_n(block[k], count, at(begin, begin + k));
            else
                std::copy_n(&kept_[k * all], all, at(begin, begin + k));
        }
        take_triangle(at(begin, begin), rows_, good, true, triangle);
        solve_rows(triangle, good, row_beyond(begin), beyond_, beyond_);
        if (good < count) update(begin, good, begin + good, begin + count);
        return good;
    }

    /// L U of a square block, whose rows change places; returns the number of columns before one of zeros.
    int factor_block(int begin, int count, double (&block)[panel_width][panel_width]) {
        for (int j = 0; j < count; ++j) std::copy_n(at(begin, begin + j), count, block[j]);
        for (int k = 0; k < count; ++k) {
            double* column = block[k];
            int best = k;
            for (int i = k + 1; i < count; ++i)
                if (std::abs(column[i]) > std::abs(column[best])) best = i;
            if (!(std::abs(column[best]) > 0.0)) return k;
            if (best != k && !(std::abs(column[k]) >= diagonal * std::abs(column[best]))) {
                exchange_rows(begin + k, begin + best);
                for (int j = 0; j < count; ++j) std::swap(block[j][k], block[j][best]);
            }
            const double inverse = 1.0 / column[k];
            for (int i = k + 1; i < count; ++i) column[i] *= inverse;
            for (int j = k + 1; j < count; ++j) {
                const double factor = block[j][k];
                for (int i = k + 1; i < count; ++i) block[j][i] -= column[i] * factor;
            }
        }
        return count;
    }

    /// Number of columns before one with an entry of L that is too large.
    int acceptable(int under, int begin, int count) {
        for (int k = 0; k < count; ++k) {
            double largest = 0.0;
            const double* x = at(under, begin + k);
            bool finite = true;
            for (int i = 0; i < rows_ - under; ++i) largest = std::max(largest, std::abs(x[i])), finite &= x[i] == x[i];
            if (!finite || !(largest <= 1.0 / tolerance)) return k;
        }
        return count;
    }

    /// Columns and rows from `first` to `last` without what `count` pivots from `begin` on contribute.
    void update(int begin, int count, int first, int last) {
        if (count == 0 || first == last) return;
        const int width = last - first, next = begin + count;
        blas().trsm('L', 'L', 'N', 'U', count, width, at(begin, begin), rows_, at(begin, first), rows_);
        blas().gemm('N', 'N', rows_ - next, width, count, -1.0, at(next, begin), rows_, at(begin, first), rows_, 1.0,
                    at(next, first), rows_);
        blas().gemm('N', 'T', beyond_, width, count, -1.0, row_beyond(begin), std::max(1, beyond_), at(first, begin),
                    rows_, 1.0, row_beyond(first), std::max(1, beyond_));
    }

    void exchange_rows(int p, int q) {
        if (p == q) return;
        exchanged_ = true;
        std::swap(row_order_[p], row_order_[q]);
        for (int j = 0; j < columns_; ++j) std::swap(*at(p, j), *at(q, j));
        std::swap_ranges(row_beyond(p), row_beyond(p) + beyond_, row_beyond(q));
    }

    void exchange_columns(int p, int q) {
        if (p == q) return;
        exchanged_ = true;
        std::swap(column_order_[p], column_order_[q]);
        std::swap_ranges(at(0, p), at(0, p) + rows_, at(0, q));
    }

    void exchange(int p, int q) { exchange_rows(p, q), exchange_columns(p, q); }

    /// Looks for a pivot in all columns that are left and eliminates it; false if there is none.
    bool search(int& empty) {
        const int k = done_, left = columns_ - done_;
        for (int tried = 0; tried < left; ++tried) {
            const int c = k + (next_ + tried) % left;
            const double* x = at(0, c);
            double most = 0.0;
            int best = k;
            for (int i = k; i < rows_; ++i)
                if (!(std::abs(x[i]) <= most)) most = std::abs(x[i]);
            for (int i = k; i < columns_; ++i)
                if (std::abs(x[i]) > std::abs(x[best])) best = i;
            if (most == 0.0) return empty = c, false;
            if (!(std::abs(x[best]) >= tolerance * most)) continue;
            next_ = c - k;
            exchange_columns(k, c);
            exchange_rows(k, best);
            const double inverse = 1.0 / *at(k, k);
            for (int i = k + 1; i < rows_; ++i) *at(i, k) *= inverse;
            ++done_;
            update(k, 1, done_, columns_);
            return true;
        }
        return false;
    }
};

}  // namespace umform::multifrontal
