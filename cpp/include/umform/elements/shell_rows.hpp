// Rows B of the assumed strains at the Gauss points of a layer, from rows at the tying points.
#pragma once

#include <algorithm>

#include "umform/elements/shell_strains.hpp"

namespace umform {

template <int Nodes, class Real>
class ShellRows : public ShellStrains<Nodes, Real> {
    using Strains = ShellStrains<Nodes, Real>;

  public:
    static constexpr int face = Nodes / 2, half = 3 * face, size = 2 * half;
    using typename Strains::Vectors;
    using typename Strains::Workspace;

    ShellRows(const Technology& technology, const SurfacePoints& surface_points, const Rule& thickness)
        : Strains(technology, surface_points, thickness) {
        first_extra_ = first_shear_row;
        for (int p = 0; p < first_shear_row; ++p)
            if (tied_at_middle(row_order[p])) first_extra_ = 0;
    }

  protected:
    using Strains::current;
    using Strains::tables_;

    bool tied_at_middle(int component) const {
        return tables_.row_of[component] >= 0 && !tables_.rows[tables_.row_of[component]].at_layer;
    }

    void sample_rows(const std::vector<typename ShellTables<Nodes>::Sample>& samples, double t, const Workspace& w,
                     std::vector<Real>& rows) const {
        Real* row = rows.data();
        for (const auto& [component, place] : samples) {
            strain_row<face>(component, tables_.places[place].shape, current(place, t, w), row, row + half);
            row += size;
        }
    }

    /// Rows tied at the mid-surface are the same for all layers: they are formed once. eq. (2.3)
    void mid_surface_rows(Workspace& w) const {
        sample_rows(tables_.mid_samples, 0.0, w, w.mid_rows);
        for (int p = 0; p < 6; ++p)
            if (tied_at_middle(row_order[p]))
                for (int point = 0; point < tables_.surface; ++point)
                    for (const int offset : {0, half})
                        interpolate(row_order[p], point, w.mid_rows, offset,
                                    w.tied_rows.data() + (point * 6 + p) * size + offset);
    }

    /// `row` of `half` entries, which begin at `offset` in the rows of the samples.
    void interpolate(int component, int point, const std::vector<Real>& samples, int offset, Real* row) const {
        bool first = true;
        for (const auto& [sample, weight] : tables_.rows[tables_.row_of[component]].shares[point]) {
            const Real* of_sample = samples.data() + sample * size + offset;
            if (first)
                for (int i = 0; i < half; ++i) row[i] = weight * of_sample[i];
            else
                for (int i = 0; i < half; ++i) row[i] += weight * of_sample[i];
            first = false;
        }
    }

    /// The six rows at a point of a layer, in `row_order`: over the mean, and what the director takes beyond t times that.
    void point_rows(int point, double t, Workspace& w) const {
        const Vectors g = current(point, t, w);
        for (int p = 0; p < 6; ++p) {
            const int component = row_order[p];
            Real *mean = w.B_mean.data() + (point * 6 + p) * half, *extra = w.B_extra.data() + (point * 6 + p) * half;
            if (tables_.row_of[component] < 0) {
                strain_row<face>(component, tables_.places[point].shape, g, mean, extra);
            } else if (tied_at_middle(component)) {  // the director of a row of the mid-surface does not go with t
                const Real* tied = w.tied_rows.data() + (point * 6 + p) * size;
                for (int i = 0; i < half; ++i) mean[i] = tied[i], extra[i] = tied[half + i] - t * tied[i];
            } else {
                interpolate(component, point, w.layer_rows, 0, mean);
                if (p >= first_extra_) interpolate(component, point, w.layer_rows, half, extra);
            }
        }
    }

    int first_extra_;  // first row with an additional term of the director
};

}  // namespace umform
