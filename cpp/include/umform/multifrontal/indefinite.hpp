// Dense L D L^T factors of the columns of a front, with pivots of one and of two columns.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "umform/multifrontal/bunch_kaufman.hpp"
#include "umform/multifrontal/by_halves.hpp"
#include "umform/multifrontal/cholesky.hpp"

namespace umform::multifrontal {

/// Columns of a front that are eliminated as far as stable pivots are found among them; the others are left, updated, behind
/// those. Entries of L stay below 1 / `tolerance`.
///
/// The pivots of a few columns are chosen within their square block, and looked at again when all rows below are known
/// (J. Hogg, E. Ovtchinnikov & J. Scott, A sparse symmetric indefinite direct solver for GPU architectures, ACM TOMS 42
/// (2016) 1-25). What fails is put behind, and tried once more with a search of all rows, column by column (I. S. Duff &
/// J. K. Reid, The multifrontal solution of indefinite sparse symmetric linear equations, ACM TOMS 9 (1983) 302-325).
class Indefinite : ByHalves<Indefinite> {
    friend ByHalves<Indefinite>;

  public:
    static constexpr double tolerance = 0.01;

    /// Lower triangles of `columns` columns of `rows` rows; `below` gets the entry beside the diagonal of each pivot of two
    /// columns, `order` the columns in their order of elimination.
    Indefinite(const DenseColumns& a, int rows, int columns, std::vector<double>& below,
               std::vector<std::int32_t>& order)
        : a_(a), rows_(rows), columns_(columns), below_(below), order_(order) {}

    /// Number of columns that were eliminated. `empty` is a column without entries, or -1: the matrix is singular.
    int run(int& empty) {
        empty = -1;
        below_.assign(columns_, 0.0);
        done_ = eliminate(0, columns_);
        while (done_ < columns_ && empty < 0)
            if (!search(empty)) break;
        return done_;
    }

    bool exchanged() const { return exchanged_; }

  private:
    DenseColumns a_;
    int rows_, columns_, done_ = 0, next_ = 0;  // where the search continues
    bool exchanged_ = false;
    std::vector<double>& below_;
    std::vector<std::int32_t>& order_;
    std::vector<double> scaled_, kept_;

    double* at(int i, int j) { return a_.at(i, j); }
    const Panels& panels() const { return a_.panels; }

    /// Eliminates a block up to the first column that fails; returns how many.
    int try_block(int begin, int count) {
        const int ld = a_.stride(begin);
        BunchKaufman block(at(begin, begin), ld, count);
        for (int k = 0; k < count; ++k)
            if (block.exchange[k] > k) exchange(begin + k, begin + block.exchange[k]);
        const int under = begin + count, height = rows_ - under;
        kept_.resize(static_cast<std::size_t>(count) * (rows_ - begin));
        for (int k = 0; k < count; ++k)
            std::copy_n(at(begin, begin + k), rows_ - begin, &kept_[k * std::size_t(rows_ - begin)]);
        SmallTriangle triangle;
        take_triangle(block.entry[0], panel_width, block.done, true, triangle);
        solve_rows(triangle, block.done, at(under, begin), ld, height);
        int good = 0;
        while (good < block.done) {
            const int size = block.below[good] != 0.0 ? 2 : 1;
            if (!divide(block, good, size, begin, under, height)) break;
            good += size;
        }
        for (int k = 0; k < good; ++k) {
            std::copy(block.entry[k] + k, block.entry[k] + count, at(begin + k, begin + k));
            *at(begin + k, begin + k) = block.diagonal[k];
            below_[begin + k] = block.below[k];
        }
        if (good == count) return count;
        for (int k = good; k < count; ++k)
            std::copy_n(&kept_[k * std::size_t(rows_ - begin) + k], rows_ - begin - k, at(begin + k, begin + k));
        update(begin, good, begin + good, begin + count);
        return good;
    }

    /// Rows of L of a pivot from those of L D; false if an entry is too large.
    bool divide(const BunchKaufman& block, int k, int size, int begin, int under, int height) {
        double* x = at(under, begin + k);
        double largest = 0.0;
        if (size == 1) {
            const double inverse = 1.0 / block.diagonal[k];
            for (int i = 0; i < height; ++i) x[i] *= inverse, largest = std::max(largest, std::abs(x[i]));
        } else {
            double* y = at(under, begin + k + 1);
            const TwoByTwo pivot(block.diagonal[k], block.below[k], block.diagonal[k + 1]);
            for (int i = 0; i < height; ++i) {
                pivot.solve(x[i], y[i]);
                largest = std::max({largest, std::abs(x[i]), std::abs(y[i])});
            }
        }
        return largest <= 1.0 / tolerance;
    }

    /// Columns from `first` to `last` without what `count` pivots from `begin` on contribute: C -= L (L D)^T.
    void update(int begin, int count, int first, int last) {
        if (count == 0 || first == last) return;
        scale_rows(begin, count, first, last - first, scaled_);
        update_columns(a_, rows_, begin, count, first, last, [&](int row, int column, int& ld) {
            ld = last - first;
            return &scaled_[static_cast<std::size_t>(column - begin) * ld + (row - first)];
        });
    }

  public:
    /// L D of rows from `first` on.
    void scale_rows(int begin, int count, int first, int height, std::vector<double>& out) {
        out.resize(static_cast<std::size_t>(count) * height);
        for (int k = 0; k < count;) {
            const double *x = at(first, begin + k), d = *at(begin + k, begin + k), e = below_[begin + k];
            double* to = &out[static_cast<std::size_t>(k) * height];
            if (e == 0.0) {
                for (int i = 0; i < height; ++i) to[i] = d * x[i];
                ++k;
                continue;
            }
            const double *y = at(first, begin + k + 1), f = *at(begin + k + 1, begin + k + 1);
            for (int i = 0; i < height; ++i) to[i] = d * x[i] + e * y[i], to[height + i] = e * x[i] + f * y[i];
            k += 2;
        }
    }

  private:
    /// Exchanges two columns with their rows.
    void exchange(int p, int q) {
        if (p == q) return;
        if (p > q) std::swap(p, q);
        exchanged_ = true;
        std::swap(order_[p], order_[q]);
        a_.for_row(p, 0, p, [&, across = q - p](double& entry, int) { std::swap(entry, *(&entry + across)); });
        std::swap(*at(p, p), *at(q, q));
        double* column = a_.column(p);
        a_.for_row(q, p + 1, q, [&](double& entry, int k) { std::swap(entry, column[k]); });
        std::swap_ranges(column + q + 1, column + rows_, at(q, q) + 1);
    }

    /// Entry of the rest of the matrix, which is stored below the diagonal.
    double rest(int i, int j) { return i > j ? *at(i, j) : *at(j, i); }

    /// Largest entry beside the diagonal in a column, leaving out a row; `where` is that among columns that may be pivots.
    double largest(int column, int except, int& where) {
        double most = 0.0, among = -1.0;
        where = -1;
        for (int i = done_; i < rows_; ++i) {
            if (i == column || i == except) continue;
            const double here = std::abs(i < columns_ || i > column ? rest(i, column) : *at(i, column));
            if (!(here <= most)) most = here;
            if (i < columns_ && here > among) among = here, where = i;
        }
        return most;
    }

    /// Looks for a pivot in all columns that are left and eliminates it; false if there is none.
    bool search(int& empty) {
        const int left = columns_ - done_;
        for (int k = 0; k < left; ++k) {
            const int c = done_ + (next_ + k) % left;
            int r = -1;
            const double most = largest(c, -1, r), d = *at(c, c);
            if (d == 0.0 && most == 0.0) return empty = c, false;
            if (std::abs(d) >= tolerance * most && d != 0.0) {
                next_ = c - done_;
                exchange(c, done_);
                eliminate_one();
                return true;
            }
            if (r < 0 || rest(c, r) == 0.0) continue;
            int unused = -1;
            const TwoByTwo pivot(d, rest(c, r), *at(r, r));
            double x = largest(c, r, unused), y = largest(r, c, unused);
            if (!pivot.bounded(x, y, 1.0 / tolerance)) continue;
            next_ = c - done_;
            exchange(c, done_);
            exchange(r == done_ ? c : r, done_ + 1);
            eliminate_two();
            return true;
        }
        return false;
    }

    void eliminate_one() {
        const int k = done_++;
        const double inverse = 1.0 / *at(k, k);
        for (int i = k + 1; i < rows_; ++i) *at(i, k) *= inverse;
        below_[k] = 0.0;
        update(k, 1, k + 1, columns_);
    }

    void eliminate_two() {
        const int k = done_;
        done_ += 2;
        below_[k] = *at(k + 1, k), below_[k + 1] = 0.0;
        const TwoByTwo pivot(*at(k, k), below_[k], *at(k + 1, k + 1));
        *at(k + 1, k) = 0.0;
        for (int i = k + 2; i < rows_; ++i) pivot.solve(*at(i, k), *at(i, k + 1));
        update(k, 2, k + 2, columns_);
    }
};

}  // namespace umform::multifrontal
