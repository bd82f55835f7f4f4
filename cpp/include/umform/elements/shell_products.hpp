// Products of the rows of a layer with stress and tangent: forces, stiffness, geometric stiffness.
#pragma once

#include "umform/algebra/condensation.hpp"
#include "umform/elements/shell_rows.hpp"

namespace umform {

template <int Nodes, class Real>
class ShellProducts : public ShellRows<Nodes, Real> {
    using Rows = ShellRows<Nodes, Real>;

  public:
    using Rows::face, Rows::half, Rows::size;
    using typename Rows::Workspace;

    /// `symmetric`: whether the tangent CC of the law is.
    ShellProducts(const Technology& technology, const SurfacePoints& surface_points, const Rule& thickness,
                  bool symmetric)
        : Rows(technology, surface_points, thickness), symmetric_(symmetric) {}

    bool symmetric() const { return symmetric_; }
    Workspace workspace() const { return Workspace(tables_, symmetric_); }

  protected:
    using Rows::first_extra_;
    using Rows::tables_;
    using Voigt = Vec<Real, 6>;
    using Voigt66 = std::array<Voigt, 6>;

    /// Sum over the rows Begin .. End - 1 of B, which are those that are not zero.
    template <int Begin, int End>
    static Real combination(const Voigt& factor, const Real* B, int i) {
        Real sum = factor[Begin] * B[Begin * half + i];
#pragma GCC unroll 6
        for (int p = Begin + 1; p < End; ++p) sum += factor[p] * B[p * half + i];
        return sum;
    }

    /// A few rows of C B together, with their factors in registers.
    template <int Begin, int End, int Rows>
    static void multiply(const Voigt* C, const Real* B, Real* CB) {
        std::array<Voigt, Rows> factors;
        std::copy_n(C, Rows, factors.begin());
        for (int i = 0; i < half; ++i)
#pragma GCC unroll 3
            for (int row = 0; row < Rows; ++row) CB[row * half + i] = combination<Begin, End>(factors[row], B, i);
    }

    /// f += sum_p S_p B_p with B = [M, t M + X].
    template <int FirstExtra>
    static void add_force(const Voigt S, double t, const Real* mean, const Real* extra, Real* f) {
        for (int i = 0; i < half; ++i) {
            const Real of_mean = combination<0, mean_rows>(S, mean, i);
            f[i] += of_mean;
            f[half + i] += t * of_mean + combination<FirstExtra, 6>(S, extra, i);
        }
    }

    /// int B^T C B of a layer: with B = [M, t M + X] and the products P = M^T C M, Q = X^T C M, R = X^T C X it is
    /// [P, .; t P + Q, t^2 P + t (Q + Q^T) + R]. eq. (2.36)
    void add_layer(double t, Workspace& w) const {
        Real *Kmm = w.Kmm.data(), *Kdm = w.Kdm.data(), *Kdd = w.Kdd.data();
        const Real *mean = w.B_mean.data(), *extra = w.B_extra.data() + first_extra_ * half;
        const int shift = first_extra_ * half;
        const RowSet of_mean{tables_.surface, mean_rows, 6 * half, half},
            of_extra{tables_.surface, 6 - first_extra_, 6 * half, half};
        transposed_product<half>(of_mean, mean, w.CB_mean.data(), true, [&](int i, int j, const Tile<Real>& P) {
            add_tile<half>(Kmm, i, j, 1.0, P);
            add_tile<half>(Kdm, i, j, t, P);
            if (i != j) add_transposed_tile<half>(Kdm, i, j, t, P);
            add_tile<half>(Kdd, i, j, t * t, P);
        });
        transposed_product<half>(of_extra, extra, w.CB_mean.data() + shift, false,
                                 [&](int i, int j, const Tile<Real>& Q) {
                                     add_tile<half>(Kdm, i, j, 1.0, Q);
                                     if (i <= j) add_tile<half>(Kdd, i, j, t, Q);
                                     if (i >= j) add_transposed_tile<half>(Kdd, i, j, t, Q);
                                 });
        transposed_product<half>(of_extra, extra, w.CB_extra.data() + shift, true,
                                 [&](int i, int j, const Tile<Real>& R) { add_tile<half>(Kdd, i, j, 1.0, R); });
    }

    /// The same for a law whose tangent is not symmetric: all tiles, and the block mean-director with M^T C X. eq. (2.40)
    void add_layer_full(double t, Workspace& w) const {
        Real *Kmm = w.Kmm.data(), *Kdm = w.Kdm.data(), *Kmd = w.Kmd.data(), *Kdd = w.Kdd.data();
        const int shift = first_extra_ * half;
        const Real *mean = w.B_mean.data(), *extra = w.B_extra.data() + shift;
        const RowSet of_mean{tables_.surface, mean_rows, 6 * half, half},
            of_extra{tables_.surface, 6 - first_extra_, 6 * half, half};
        transposed_product<half>(of_mean, mean, w.CB_mean.data(), false, [&](int i, int j, const Tile<Real>& P) {
            add_tile<half>(Kmm, i, j, 1.0, P);
            add_tile<half>(Kdm, i, j, t, P);
            add_tile<half>(Kmd, i, j, t, P);
            add_tile<half>(Kdd, i, j, t * t, P);
        });
        transposed_product<half>(of_extra, extra, w.CB_mean.data() + shift, false,
                                 [&](int i, int j, const Tile<Real>& Q) {
                                     add_tile<half>(Kdm, i, j, 1.0, Q);
                                     add_tile<half>(Kdd, i, j, t, Q);
                                 });
        transposed_product<half>(of_mean, mean, w.CB_extra.data(), false, [&](int i, int j, const Tile<Real>& Q) {
            add_tile<half>(Kmd, i, j, 1.0, Q);
            add_tile<half>(Kdd, i, j, t, Q);
        });
        transposed_product<half>(of_extra, extra, w.CB_extra.data() + shift, false,
                                 [&](int i, int j, const Tile<Real>& R) { add_tile<half>(Kdd, i, j, 1.0, R); });
    }

    /// Stress moments int t^k S^c dV of every place: compatible components at the Gauss point itself, tied ones at their tying
    /// points, whose t is zero at the mid-surface. eqs. (2.4), (2.37)
    void gather_stress(int point, double t, const Voigt& S, Workspace& w) const {
        const auto gather = [&](int place, int component, double t_place, Real sigma) {
            std::array<Real, 3>& moments = w.moments[place][component];
            moments[0] += sigma;
            moments[1] += t_place * sigma;
            moments[2] += t_place * t_place * sigma;
        };
        for (int p = 0; p < 6; ++p) {
            const int component = row_order[p];
            if (tables_.row_of[component] < 0) {
                gather(point, component, t, S[p]);
                continue;
            }
            const auto& row = tables_.rows[tables_.row_of[component]];
            const auto& samples = row.at_layer ? tables_.layer_samples : tables_.mid_samples;
            for (const auto& [sample, weight] : row.shares[point])
                gather(samples[sample].place, component, row.at_layer ? t : 0.0, weight * S[p]);
        }
    }

    /// Geometric stiffness of all places, the same for the three directions.
    void add_geometry(Workspace& w) const {
        for (std::size_t k = 0; k < tables_.places.size(); ++k) add_geometry_of(static_cast<int>(k), w);
        for (int k = 0; k < 3; ++k)
            for (int a = 0; a < face; ++a)
                for (int b = 0; b < face; ++b) {
                    const int at = (k * face + a) * half + k * face + b, node = a * face + b;
                    w.Kmm[at] += w.geometry_mm[node];
                    w.Kdm[at] += w.geometry_dm[node];
                    w.Kdd[at] += w.geometry_dd[node];
                    if (!symmetric_) w.Kmd[at] += w.geometry_dm[b * face + a];
                }
    }

    /// Geometric stiffness of a place from its stress moments, once for all layers: int S^ij N_a,i N_b,j dV with the derivatives
    /// (N_,1, N_,2, 0) of the mean and (t N_,1, t N_,2, N) of the director. eqs. (2.5), (2.37)
    void add_geometry_of(int index, Workspace& w) const {
        const auto& [N, N1, N2] = tables_.places[index].shape;
        const auto& moments = w.moments[index];
        const auto &s11 = moments[C11], &s22 = moments[C22], &s12 = moments[C12], &s13 = moments[C13],
                   &s23 = moments[C23];
        for (int a = 0; a < face; ++a) {
            const Real mm1 = N1[a] * s11[0] + N2[a] * s12[0], mm2 = N1[a] * s12[0] + N2[a] * s22[0];
            const Real dm1 = N1[a] * s11[1] + N2[a] * s12[1] + N[a] * s13[0],
                       dm2 = N1[a] * s12[1] + N2[a] * s22[1] + N[a] * s23[0];
            const Real dd1 = N1[a] * s11[2] + N2[a] * s12[2] + N[a] * s13[1],
                       dd2 = N1[a] * s12[2] + N2[a] * s22[2] + N[a] * s23[1],
                       dd3 = N1[a] * s13[1] + N2[a] * s23[1] + N[a] * moments[C33][0];
            for (int b = 0; b < face; ++b) {
                w.geometry_mm[a * face + b] += mm1 * N1[b] + mm2 * N2[b];
                w.geometry_dm[a * face + b] += dm1 * N1[b] + dm2 * N2[b];
                w.geometry_dd[a * face + b] += dd1 * N1[b] + dd2 * N2[b] + dd3 * N[b];
            }
        }
    }

    bool symmetric_;  // whether the tangent of the law is
};

}  // namespace umform
