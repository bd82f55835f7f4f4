// Rows B of the assumed strains over a column of Gauss points, from rows at the tying points.
//
// All rows are polynomials in t, of degree one over the mean of the faces and two over the director: their coefficients are the
// same for all points of a column, and so are the products of rows with each other. eq. (2.35)
#pragma once

#include <algorithm>

#include "umform/elements/shell_strains.hpp"

namespace umform {

/// A row of a column: the strain (its place in `row_order`) and the power of t that it is the coefficient of.
struct PowerRow {
    int strain, power;
};

/// Over the mean: shear strains do not vary, E_33 has none.
inline constexpr std::array<PowerRow, 8> rows_of_mean{{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {0, 1}, {1, 1}, {2, 1}}};
/// Over the director. The first three are zero unless a strain in the plane is tied at the mid-surface.
inline constexpr std::array<PowerRow, 14> rows_of_director{
    {{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}, {0, 1}, {1, 1}, {2, 1}, {3, 1}, {4, 1}, {0, 2}, {1, 2}, {2, 2}}};

template <int Nodes, class Real>
class ShellRows : public ShellStrains<Nodes, Real> {
    using Strains = ShellStrains<Nodes, Real>;

  public:
    static constexpr int face = Nodes / 2, half = 3 * face, size = 2 * half;
    using typename Strains::Vectors;
    using typename Strains::Workspace;

    ShellRows(const Technology& technology, const SurfacePoints& surface_points, const ThicknessRule& thickness)
        : Strains(technology, surface_points, thickness) {
        first_row_ = first_shear_row;
        for (int p = 0; p < first_shear_row; ++p)
            if (tied_at_middle(row_order[p])) first_row_ = 0;
    }

  protected:
    using Strains::current;
    using Strains::tables_;

    bool tied_at_middle(int component) const {
        return tables_.row_of[component] >= 0 && !tables_.rows[tables_.row_of[component]].at_layer;
    }

    /// Rows at all tying points: those of the mid-surface, and of the others the two coefficients.
    void sample_rows(Workspace& w) const {
        Real* row = w.mid_rows.data();
        for (const auto& [component, place] : tables_.mid_samples) {
            strain_row<face>(component, tables_.places[place].shape, current(place, 0.0, w), row, row + half);
            row += size;
        }
        row = w.layer_rows.data();
        for (const auto& [component, place] : tables_.layer_samples) {
            linear_row(component, place, w, row);
            row += 2 * size;
        }
    }

    /// Rows of the column over a point of the surface, in the order of `rows_of_mean` and `rows_of_director`. eq. (2.3)
    void column_rows(int point, Workspace& w) const {
        Real *mean = w.mean_rows.data(), *director = w.director_rows.data();
        for (int p = 0; p < 6; ++p) {
            const int component = row_order[p];
            std::array<Real, 2 * size> row;  // constant: mean, director; linear: mean, director beyond t times the mean
            const bool middle = tied_at_middle(component);
            if (tables_.row_of[component] < 0)
                linear_row(component, point, w, row.data());
            else if (middle)
                interpolate<size>(component, point, w.mid_rows, row.data());
            else
                interpolate<2 * size>(component, point, w.layer_rows, row.data());
            if (middle) std::fill(row.begin() + size, row.end(), Real(0.0));
            const Real *m0 = row.data(), *x0 = m0 + half, *m1 = x0 + half, *x1 = m1 + half;
            const double turns = middle ? 0.0 : 1.0;  // the director of a row of the mid-surface does not vary with t
            if (p < mean_rows) std::copy_n(m0, half, mean + p * half);
            if (p < first_shear_row) std::copy_n(m1, half, mean + (mean_rows + p) * half);
            std::copy_n(x0, half, director + p * half);
            if (p < mean_rows)
                for (int i = 0; i < half; ++i) director[(6 + p) * half + i] = turns * m0[i] + x1[i];
            if (p < first_shear_row) std::copy_n(m1, half, director + (6 + mean_rows + p) * half);
        }
    }

    int first_row_;  // first of `rows_of_director` that is not zero

  private:
    /// The coefficients of a compatible row, [power][mean, director beyond t times the mean].
    static void linear_row(int component, const FaceShape<face>& shape, const Vectors& g, const Vectors& slope,
                           Real* row) {
        strain_row<face>(component, shape, g, row, row + half);
        strain_row<face>(component, shape, slope, row + size, row + size + half);
    }
    void linear_row(int component, int place, const Workspace& w, Real* row) const {
        Vectors slope{};
        for (int i = 0; i < 2; ++i)
            for (int k = 0; k < 3; ++k) slope[i][k] = w.G[place].slope[i][k] + w.h[place].slope[i][k];
        linear_row(component, tables_.places[place].shape, current(place, 0.0, w), slope, row);
    }

    template <int Length>
    void interpolate(int component, int point, const std::vector<Real>& samples, Real* row) const {
        bool first = true;
        for (const auto& [sample, weight] : tables_.rows[tables_.row_of[component]].shares[point]) {
            const Real* of_sample = samples.data() + sample * Length;
            if (first)
                for (int i = 0; i < Length; ++i) row[i] = weight * of_sample[i];
            else
                for (int i = 0; i < Length; ++i) row[i] += weight * of_sample[i];
            first = false;
        }
    }
};

}  // namespace umform
