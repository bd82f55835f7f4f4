// Powers of two that make the rows and columns of a matrix alike in size, where they are not.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "umform/multifrontal/structure.hpp"

namespace umform::multifrontal {

/// What a matrix is multiplied with before its elimination, R A C: exact, since these are powers of two.
struct Scaling {
    std::vector<double> row, column;  // of each equation; empty if the matrix is not scaled
    std::vector<double> size;         // largest entry of each column of what is eliminated

    bool active() const { return !row.empty(); }
    double of(int i, int j) const { return row[i] * column[j]; }
};

namespace detail {

/// Exponent of a number; far below all others for zero and what is too small to have one.
inline int exponent(double x) {
    const int biased = static_cast<int>(std::bit_cast<std::uint64_t>(x) >> 52 & 0x7ffU);
    return biased > 0 ? biased - 1023 : -30000;
}

inline constexpr int no_exponent = -15000;  // anything below is that of a zero
inline constexpr int passes = 12;           // of Ruiz: each halves the exponents that are left, 1000 at first
inline constexpr int balancing_passes = 16;

/// Largest exponents of rows or columns.
class Most {
  public:
    explicit Most(int n) : most_(n) {}
    void clear() { std::fill(most_.begin(), most_.end(), no_exponent); }
    void add(int i, int e) { most_[i] = std::max(most_[i], e); }
    bool any(int i) const { return most_[i] > no_exponent; }
    int operator[](int i) const { return most_[i]; }
    /// Halves the exponents; false if nothing changes.
    bool halve(std::vector<int>& scale) const {
        bool changed = false;
        for (std::size_t i = 0; i < scale.size(); ++i) {
            const int half = any(static_cast<int>(i)) ? most_[i] / 2 : 0;
            scale[i] -= half, changed |= half != 0;
        }
        return changed;
    }

  private:
    std::vector<int> most_;
};

/// First exponents of rows that are `alone`, with no neighbour whose exponent is known: those of eq. (5.76), by conjugate
/// gradients with the diagonal as preconditioner.
template <class Visit>
void start_from_means(const Visit& visit, const std::vector<char>& alone, std::vector<int>& d) {
    constexpr int most_steps = 100;
    constexpr double enough = 1e-4;  // of the gradient: exponents are whole
    const std::size_t n = d.size();
    std::vector<double> x(n, 0.0), r(n, 0.0), p(n, 0.0), product(n), count(n, 0.0);
    const auto each = [&](const auto& take) {
        visit([&](int i, int j, int e) {
            if (e > no_exponent && i != j && (alone[i] != 0 || alone[j] != 0)) take(i, j, e);
        });
    };
    each([&](int i, int j, int e) {
        const double sum = e + d[i] + d[j];
        r[i] -= sum, r[j] -= sum, ++count[i], ++count[j];
    });
    const auto inner = [&](const std::vector<double>& a, const std::vector<double>& b) {
        double sum = 0.0;
        for (std::size_t i = 0; i < n; ++i)
            if (alone[i] != 0 && count[i] > 0.0) sum += a[i] * b[i] / count[i];
        return sum;
    };
    double square = inner(r, r);
    const double first = square;
    for (std::size_t i = 0; i < n; ++i) p[i] = alone[i] != 0 && count[i] > 0.0 ? r[i] / count[i] : 0.0;
    for (int step = 0; step < most_steps && square > enough * enough * first; ++step) {
        std::fill(product.begin(), product.end(), 0.0);
        each([&](int i, int j, int) {
            const double sum = p[i] + p[j];
            product[i] += sum, product[j] += sum;
        });
        double curvature = 0.0;
        for (std::size_t i = 0; i < n; ++i) curvature += p[i] * product[i];
        if (!(curvature > 0.0)) break;
        const double length = square / curvature;
        for (std::size_t i = 0; i < n; ++i) x[i] += length * p[i], r[i] -= length * product[i];
        const double before = square;
        square = inner(r, r);
        for (std::size_t i = 0; i < n; ++i)
            p[i] = alone[i] != 0 && count[i] > 0.0 ? r[i] / count[i] + square / before * p[i] : 0.0;
    }
    for (std::size_t i = 0; i < n; ++i)
        if (alone[i] != 0) d[i] += static_cast<int>(std::lround(x[i]));
}

/// First exponents of D A D: those that make the diagonal one. A row without a diagonal, or with one that is tiny beside what
/// most of its entries need, follows its neighbours; where they know no better, all entries are made alike in the mean.
/// Whether there was a row that knew no better.
template <class Visit>
bool start_from_diagonal(const Visit& visit, std::vector<int>& d) {
    constexpr int tiny = 20;
    const int n = static_cast<int>(d.size());
    std::vector<std::int32_t> entries(n, 0), above(n, 0);
    std::vector<char> kept(n, 0);
    visit([&](int i, int j, int e) {
        if (i == j && e > no_exponent) d[i] = -(e >> 1), kept[i] = 1;
    });
    visit([&](int i, int j, int e) {
        if (i == j || e < no_exponent || kept[i] == 0 || kept[j] == 0) return;
        const int large = e + d[i] + d[j] > tiny ? 1 : 0;
        ++entries[i], ++entries[j], above[i] += large, above[j] += large;
    });
    for (int i = 0; i < n; ++i)
        if (2 * above[i] > entries[i]) kept[i] = 0;
    Most most(n);
    most.clear();
    visit([&](int i, int j, int e) {
        if (kept[i] == 0 && kept[j] != 0) most.add(i, e + d[j]);
        if (kept[j] == 0 && kept[i] != 0) most.add(j, e + d[i]);
    });
    std::vector<char> alone(n, 0);
    bool any = false;
    for (int i = 0; i < n; ++i)
        if (kept[i] == 0) d[i] = most.any(i) ? -most[i] : 0, alone[i] = most.any(i) ? 0 : 1, any |= alone[i] != 0;
    if (any) start_from_means(visit, alone, d);
    return any;
}

/// Exponents d of D A D, eq. (5.51): D. Ruiz, A scaling algorithm to equilibrate both rows and columns norms in matrices,
/// RAL-TR-2001-034.
/// `visit` calls a function with the row, the column and the exponent of each entry.
/// Whether a row had neither a diagonal nor a neighbour with one.
template <class Visit>
bool equilibrate(const Visit& visit, std::vector<int>& d) {
    Most most(static_cast<int>(d.size()));
    const bool any = start_from_diagonal(visit, d);
    for (int pass = 0; pass < passes; ++pass) {
        most.clear();
        visit([&](int i, int j, int e) {
            const int here = e + d[i] + d[j];
            most.add(i, here), most.add(j, here);
        });
        if (!most.halve(d)) break;
    }
    return any;
}

/// The exponents of two entries opposite to each other.
struct Opposite {
    std::int32_t i, j;
    std::int16_t upper, lower;  // of (i, j) and (j, i), i <= j
};

inline std::vector<Opposite> opposites(const Rows& rows, const double* values) {
    const Columns columns(rows);
    std::vector<Opposite> pairs;
    pairs.reserve(columns.row.size() / 2 + rows.n);
    const int end = std::numeric_limits<int>::max();
    const auto none = static_cast<std::int16_t>(exponent(0.0));
    for (int i = 0; i < rows.n; ++i) {
        const auto* first = rows.indices + rows.indptr[i];
        int k = static_cast<int>(std::lower_bound(first, rows.indices + rows.indptr[i + 1], i) - rows.indices);
        const auto above = columns.row.begin() + columns.start[i];
        int l = static_cast<int>(std::lower_bound(above, columns.row.begin() + columns.start[i + 1], i)
                                 - columns.row.begin());
        while (k < rows.indptr[i + 1] || l < columns.start[i + 1]) {
            const int right = k < rows.indptr[i + 1] ? rows.indices[k] : end;
            const int below = l < columns.start[i + 1] ? columns.row[l] : end;
            Opposite pair{i, std::min(right, below), none, none};
            if (right == pair.j) pair.upper = static_cast<std::int16_t>(exponent(values[k++]));
            if (below == pair.j) pair.lower = static_cast<std::int16_t>(exponent(values[columns.entry[l++]]));
            pairs.push_back(pair);
        }
    }
    return pairs;
}

/// Exponents of R A C for a pattern that is symmetric, or nearly.
///
/// Rows and columns on their own could be made alike by Ruiz with the diagonal left tiny: large scales on one side of a line
/// and small ones on the other fit as well. Therefore R = D T and C = D / T: D makes the geometric means of opposite entries
/// alike, of which the diagonal is one, and T balances them (B. N. Parlett & C. Reinsch, Balancing a matrix for calculation
/// of eigenvalues and eigenvectors, Numer. Math. 13 (1969) 293-304). What has no opposite is left to Ruiz. A matrix of which not
/// all rows have a diagonal, or a neighbour with one, begins with rows and columns that make all entries alike in the mean.
class TwoSided {
  public:
    std::vector<int> row, column;

    TwoSided(const Rows& rows, const double* values)
        : row(rows.n, 0), column(rows.n, 0), pairs_(opposites(rows, values)), rows_(rows.n), columns_(rows.n) {
        if (means())
            apart(rows, values);
        else
            balance();
        finish();
    }

  private:
    std::vector<Opposite> pairs_;
    Most rows_, columns_;

    bool means() {
        const bool unknown = equilibrate(
            [&](const auto& add) {
                for (const Opposite& p : pairs_)
                    if (std::min(p.upper, p.lower) > no_exponent) add(p.i, p.j, (p.upper + p.lower) >> 1);
            },
            row);
        column = row;
        return unknown;
    }

    void apart(const Rows& rows, const double* values) {
        const int n = rows.n;
        std::vector<int> both(2 * static_cast<std::size_t>(n), 0);
        start_from_means(
            [&](const auto& add) {
                for (int i = 0; i < n; ++i)
                    for (int k = rows.indptr[i]; k < rows.indptr[i + 1]; ++k)
                        add(i, n + rows.indices[k], exponent(values[k]));
            },
            std::vector<char>(both.size(), 1), both);
        row.assign(both.begin(), both.begin() + n), column.assign(both.begin() + n, both.end());
    }

    void measure(bool with_diagonal) {
        rows_.clear(), columns_.clear();
        for (const Opposite& p : pairs_) {
            if (p.i == p.j && !with_diagonal) continue;
            const int upper = p.upper + row[p.i] + column[p.j], lower = p.lower + row[p.j] + column[p.i];
            rows_.add(p.i, upper), columns_.add(p.j, upper);
            if (p.i != p.j) rows_.add(p.j, lower), columns_.add(p.i, lower);
        }
    }

    /// Half of the change that would make a row as large as its column, eq. (5.52): neighbours move at the same time.
    void balance() {
        for (int pass = 0; pass < balancing_passes; ++pass) {
            measure(false);
            bool changed = false;
            for (int i = 0; i < static_cast<int>(row.size()); ++i) {
                if (!rows_.any(i) || !columns_.any(i)) continue;
                const int change = static_cast<int>(std::lround((columns_[i] - rows_[i]) / 4.0));
                row[i] += change, column[i] -= change, changed |= change != 0;
            }
            if (!changed) return;
        }
    }

    void finish() {
        for (int pass = 0; pass < passes; ++pass) {
            measure(true);
            const bool of_rows = rows_.halve(row), of_columns = columns_.halve(column);
            if (!of_rows && !of_columns) return;
        }
    }
};

inline std::vector<double> powers(const std::vector<int>& exponents) {
    std::vector<double> out(exponents.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::ldexp(1.0, std::clamp(exponents[i], -500, 500));
    return out;
}

/// Largest entries of rows and columns.
struct Sizes {
    std::vector<double> row, column;

    Sizes(const Rows& rows, bool symmetric, const double* values, const Scaling& scaling)
        : row(symmetric ? 0 : rows.n, 0.0), column(rows.n, 0.0) {
        std::vector<double>& across = symmetric ? column : row;
        const bool scaled = scaling.active();
        for (int i = 0; i < rows.n; ++i) {
            double most = across[i];
            for (int k = rows.indptr[i]; k < rows.indptr[i + 1]; ++k) {
                const int j = rows.indices[k];
                const double here = std::abs(scaled ? values[k] * scaling.of(i, j) : values[k]);
                column[j] = std::max(column[j], here);
                most = std::max(most, here);
            }
            across[i] = std::max(across[i], most);
        }
    }

    /// Are all within a factor?
    bool alike(double factor) const {
        double least = std::numeric_limits<double>::max(), most = 0.0;
        for (const auto* sizes : {&row, &column})
            for (const double size : *sizes) {
                most = std::max(most, size);
                if (size > 0.0) least = std::min(least, size);
            }
        return most <= least * factor;
    }
};

}  // namespace detail

/// Rows and columns that differ by less than this are left as they are: pivots beside entries that are so much larger lose
/// nothing, and the tangents of sheets stay below, with contact too.
inline constexpr double alike = 1 << 12;

/// Scaling of a matrix; of a symmetric one the upper triangle is stored.
inline Scaling equilibrated(const Rows& rows, bool symmetric, const double* values) {
    Scaling scaling;
    detail::Sizes sizes(rows, symmetric, values, scaling);
    if (!sizes.alike(alike)) {
        if (symmetric) {
            std::vector<int> d(rows.n, 0);
            detail::equilibrate(
                [&](const auto& add) {
                    for (int i = 0; i < rows.n; ++i)
                        for (int k = rows.indptr[i]; k < rows.indptr[i + 1]; ++k)
                            add(i, rows.indices[k], detail::exponent(values[k]));
                },
                d);
            scaling.row = scaling.column = detail::powers(d);
        } else {
            const detail::TwoSided both(rows, values);
            scaling.row = detail::powers(both.row), scaling.column = detail::powers(both.column);
        }
        sizes = detail::Sizes(rows, symmetric, values, scaling);
    }
    scaling.size = std::move(sizes.column);
    return scaling;
}

}  // namespace umform::multifrontal
