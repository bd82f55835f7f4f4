// Residual and tangent of a solid-shell with assumed strains by tying and enhanced strains: the Gauss loop. Its first half is
// shell_strains.hpp; rows B, products of rows and enhanced strains are in separate files.
//
// Everything is done in convected components; only the material sees a local orthonormal frame. Every strain component
// is linear in sampled covariant strains, so that strain, its row B and its constant Hessian use the same weights:
//   E_a = sum_T w_T E_a(T),  B_a = sum_T w_T B_a(T),  K_geo = sum_T sigma_T Hessian_a(T), sigma_T = int w_T S^a dV.
// The scalar type is a parameter: `Lanes` for several elements at the same time. Degrees of freedom are the mean and the half
// difference of the faces ("director", strain_rows.hpp) until K and f leave.
#pragma once

#include "umform/elements/shell_enhanced.hpp"

namespace umform {

/// What `SolidShell::integrate` forms beside the residual.
struct Wanted {
    bool tangent;    // else what the residual of condensed elements needs, and nothing more
    bool corrected;  // the geometric stiffness of the foreseen stress
};

template <int Nodes, class Real>
class SolidShell : public ShellEnhanced<Nodes, Real> {
    using Enhanced = ShellEnhanced<Nodes, Real>;
    using typename Enhanced::Voigt, typename Enhanced::Voigt66;

  public:
    using Enhanced::Enhanced, Enhanced::half;
    using typename Enhanced::Workspace;

    /// Residual f, tangent and the blocks of the enhanced parameters from S and CC. With the strains that `quadratic_strains`
    /// found in the last correction, the geometric stiffness takes the stress that this correction foresaw. eq. (5.39)
    /// The residual has the same bits with and without a tangent.
    void integrate(Wanted wanted, Workspace& w) const {
        w.clear(wanted.tangent);
        mid_surface_rows(w);
        for (int layer = 0; layer < tables_.layers; ++layer) {
            const double t = tables_.t[layer];
            sample_rows(tables_.layer_samples, t, w, w.layer_rows);
            for (int p = 0; p < tables_.surface; ++p) {
                point_rows(p, t, w);
                const int q = layer * tables_.surface + p;
                if (first_extra_ == first_shear_row)
                    integrate_point<first_shear_row>(q, p, t, wanted, w);
                else
                    integrate_point<0>(q, p, t, wanted, w);
            }
            if (!wanted.tangent) continue;
            if (symmetric_)
                add_layer(t, w);
            else
                add_layer_full(t, w);
        }
        if (wanted.tangent) add_geometry(w);
    }

  private:
    using Enhanced::add_geometry;
    using Enhanced::add_layer;
    using Enhanced::add_layer_full;
    using Enhanced::first_extra_;
    using Enhanced::gather_stress;
    using Enhanced::mid_surface_rows;
    using Enhanced::point_rows;
    using Enhanced::sample_rows;
    using Enhanced::symmetric_;
    using Enhanced::tables_;

    /// Convected stress and tangent of a Gauss point, times dV, in `row_order`. eq. (1.17)
    static void convected(int q, const Workspace& w, Voigt& S, Voigt66& C) {
        if (w.rolled)
            convected_by([&](const Real* T, int stride, Real* out) { to_contravariant_full(w.A[q], T, stride, out); },
                         q, w, S, C);
        else
            convected_by([A = w.A[q]](const Real* T, int stride, Real* out) { to_contravariant(A, T, stride, out); }, q,
                         w, S, C);
    }

    template <class Map>
    static void convected_by(const Map& map, int q, const Workspace& w, Voigt& S, Voigt66& C) {
        const Real dV = w.dV[q];
        Voigt66 columns;
        Voigt row;
        for (int c = 0; c < 6; ++c) map(w.CC[q].a.data() + c, 6, columns[c].data());
        for (int p = 0; p < 6; ++p) {
            map(columns[0].data() + row_order[p], 6, row.data());
            for (int c = 0; c < 6; ++c) C[p][c] = row[row_order[c]] * dV;
        }
        map(w.S[q].data(), 1, row.data());
        for (int p = 0; p < 6; ++p) S[p] = row[row_order[p]] * dV;
    }

    /// The stress that the last correction foresaw, from the linear part of its strains: S - C : quadratic part. eq. (5.38)
    static Voigt foreseen(const Voigt& S, const Voigt66& C, const Voigt& quadratic) {
        Voigt linear;
        for (int p = 0; p < 6; ++p) {
            linear[p] = S[p];
            for (int c = 0; c < 6; ++c) linear[p] -= C[p][c] * quadratic[row_order[c]];
        }
        return linear;
    }

    template <int FirstExtra>
    void integrate_point(int q, int point, double t, Wanted wanted, Workspace& w) const {
        Voigt S;
        Voigt66 C;
        convected(q, w, S, C);
        if (wanted.tangent) gather_stress(point, t, wanted.corrected ? foreseen(S, C, w.bent[q]) : S, w);

        const int first = point * 6 * half;
        const Real *mean = w.B_mean.data() + first, *extra = w.B_extra.data() + first;
        Real *CB_mean = w.CB_mean.data() + first, *CB_extra = w.CB_extra.data() + first;
        Enhanced::template add_force<FirstExtra>(S, t, mean, extra, w.f.data());
        if (wanted.tangent) {
            for (int p = 0; p < 6; p += 2)
                Enhanced::template multiply<0, mean_rows, 2>(C.data() + p, mean, CB_mean + p * half);
            for (int p = FirstExtra; p < 6; p += 3)
                Enhanced::template multiply<FirstExtra, 6, 3>(C.data() + p, extra, CB_extra + p * half);
            if (!symmetric_ && FirstExtra > 0) Enhanced::template multiply<FirstExtra, 6, 3>(C.data(), extra, CB_extra);
        }
        if (tables_.modes == 0) return;
        if (symmetric_)
            Enhanced::template add_enhanced_blocks<FirstExtra>(q, t, S, C, mean, extra, w);
        else
            Enhanced::template add_enhanced_blocks_full<FirstExtra>(q, t, S, C, mean, extra, w);
    }
};

}  // namespace umform
