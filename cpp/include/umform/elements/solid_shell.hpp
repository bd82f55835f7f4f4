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
        Enhanced::sample_rows(w);
        for (int p = 0; p < tables_.surface; ++p)
            if (first_row_ == 0)
                integrate_column<0>(p, wanted, w);
            else
                integrate_column<first_shear_row>(p, wanted, w);
        if (wanted.tangent) Enhanced::add_geometry(w);
    }

  private:
    using Enhanced::first_row_;
    using Enhanced::symmetric_;
    using Enhanced::tables_;
    using typename Enhanced::Powers;

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

    template <int First>
    void integrate_column(int point, Wanted wanted, Workspace& w) const {
        Enhanced::column_rows(point, w);
        w.clear_column(wanted.tangent);
        for (int q = point; q < tables_.points(); q += tables_.surface) integrate_point(q, wanted, w);
        Enhanced::template add_force<First>(w.stress, w, w.f.data());
        if (tables_.modes > 0) Enhanced::template add_coupling<First>(point, w);
        if (!wanted.tangent) return;
        Enhanced::gather_stress(point, wanted.corrected ? w.foreseen : w.stress, w);
        Enhanced::template add_stiffness<First>(w);
    }

    /// Moments in t of stress and tangent, and the blocks of the enhanced parameters.
    void integrate_point(int q, Wanted wanted, Workspace& w) const {
        Voigt S;
        Voigt66 C;
        convected(q, w, S, C);
        Powers t{1.0};
        for (int k = 1; k < 5; ++k) t[k] = t[k - 1] * tables_.t[q];
        Enhanced::add_moments(1.0, t, S, w.stress);
        if (wanted.tangent) {
            if (wanted.corrected) Enhanced::add_moments(1.0, t, foreseen(S, C, w.bent[q]), w.foreseen);
            for (int k = 0; k < 5; ++k)
                for (int p = 0; p < 6; ++p)
                    for (int c = 0; c < 6; ++c) w.C[k][p][c] += t[k] * C[p][c];
        }
        if (tables_.modes == 0) return;
        if (symmetric_)
            Enhanced::add_enhanced_blocks(q, t, S, C, w);
        else
            Enhanced::add_enhanced_blocks_full(q, t, S, C, w);
    }
};

}  // namespace umform
