// The one Gauss loop, whose first half is shell_strains.hpp: residual and tangent of a solid-shell with assumed strains by tying
// and enhanced strains.
//
// Everything is done in convected components; only the material sees a local orthonormal frame. Every strain component
// is linear in sampled covariant strains, so that strain, its row B and its constant Hessian use the same weights:
//   E_a = sum_T w_T E_a(T),  B_a = sum_T w_T B_a(T),  K_geo = sum_T sigma_T Hessian_a(T), sigma_T = int w_T S^a dV.
// The scalar type is a parameter: `Lanes` for as many elements at once. Degrees of freedom are the mean and the half
// difference of the faces ("director", strain_rows.hpp) until K and f leave.
#pragma once

#include <algorithm>

#include "umform/algebra/condensation.hpp"
#include "umform/elements/shell_strains.hpp"

namespace umform {

/// What `SolidShell::integrate` forms beside the residual.
struct Wanted {
    bool tangent;    // else what the residual of condensed elements needs, and nothing more
    bool corrected;  // the geometric stiffness of the foreseen stress
};

template <int Nodes, class Real>
class SolidShell : public ShellStrains<Nodes, Real> {
    using Strains = ShellStrains<Nodes, Real>;
    using Strains::current;
    using Strains::tables_;
    using Voigt = Vec<Real, 6>;
    using Voigt66 = std::array<Voigt, 6>;

  public:
    static constexpr int face = Nodes / 2, half = 3 * face, size = 2 * half;
    using typename Strains::Vectors;
    using typename Strains::Workspace;

    SolidShell(const Technology& technology, int surface_points, const Rule& thickness)
        : Strains(technology, surface_points, thickness) {
        first_extra_ = first_shear_row;
        for (int p = 0; p < first_shear_row; ++p)
            if (tied_at_middle(row_order[p])) first_extra_ = 0;
    }

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
            if (wanted.tangent) add_layer(t, w);
        }
        if (wanted.tangent) add_geometry(w);
    }

    /// Eliminates the enhanced parameters: K -= Kda Kaa^-1 Kad, f -= Kda Kaa^-1 ra. False where Kaa is singular.
    /// eq. (2.18) Without a tangent K and Kad stay as they are.
    Mask<Real> condense(bool tangent, Workspace& w) const {
        if (tables_.modes == 0) return true;
        const Mask<Real> regular = factor_ldlt(w.Kaa.data(), tables_.modes);
        w.Kad_raw = w.Kad;
        solve_ldlt(w.Kaa.data(), tables_.modes, w.ra.data(), 1);
        for (int m = 0; m < tables_.modes; ++m)
            for (int i = 0; i < size; ++i) w.f[i] -= w.Kad_raw[m * size + i] * w.ra[m];
        if (tangent) condense_tangent(w);
        return regular;
    }

  private:
    void condense_tangent(Workspace& w) const {
        solve_ldlt(w.Kaa.data(), tables_.modes, w.Kad.data(), size);
        const RowSet all{1, tables_.modes, 0, size};
        const Real *raw = w.Kad_raw.data(), *solved = w.Kad.data();
        const auto subtract = [](std::vector<Real>& K) {
            return [&K](int i, int j, const Tile<Real>& sum) { add_tile<half>(K.data(), i, j, -1.0, sum); };
        };
        transposed_product<half>(all, raw, solved, true, subtract(w.Kmm));
        transposed_product<half>(all, raw + half, solved, false, subtract(w.Kdm));
        transposed_product<half>(all, raw + half, solved + half, true, subtract(w.Kdd));
    }

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

    /// Convected stress and tangent of a Gauss point, times dV, in `row_order`. eq. (1.17)
    static void convected(int q, const Workspace& w, Voigt& S, Voigt66& C) {
        const Mat<Real, 3, 3> A = w.A[q];
        const Real dV = w.dV[q];
        Voigt66 columns;
        Voigt row;
        for (int c = 0; c < 6; ++c) to_contravariant(A, w.CC[q].a.data() + c, 6, columns[c].data());
        for (int p = 0; p < 6; ++p) {
            to_contravariant(A, columns[0].data() + row_order[p], 6, row.data());
            for (int c = 0; c < 6; ++c) C[p][c] = row[row_order[c]] * dV;
        }
        to_contravariant(A, w.S[q].data(), 1, row.data());
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
        add_force<FirstExtra>(S, t, mean, extra, w.f.data());
        if (wanted.tangent) {
            for (int p = 0; p < 6; p += 2) multiply<0, mean_rows, 2>(C.data() + p, mean, CB_mean + p * half);
            for (int p = FirstExtra; p < 6; p += 3)
                multiply<FirstExtra, 6, 3>(C.data() + p, extra, CB_extra + p * half);
        }
        if (tables_.modes > 0) add_enhanced_blocks<FirstExtra>(q, t, S, C, mean, extra, w);
    }

    /// Sum over the rows Begin .. End - 1 of B, which are those that are not zero.
    template <int Begin, int End>
    static Real combination(const Voigt& factor, const Real* B, int i) {
        Real sum = factor[Begin] * B[Begin * half + i];
#pragma GCC unroll 6
        for (int p = Begin + 1; p < End; ++p) sum += factor[p] * B[p * half + i];
        return sum;
    }

    /// A few rows of C B at once, with their factors in registers.
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

    /// Kaa (lower triangle), Kad and ra. eqs. (2.15), (2.16)
    template <int FirstExtra>
    void add_enhanced_blocks(int q, double t, const Voigt& S, const Voigt66& C, const Real* mean, const Real* extra,
                             Workspace& w) const {
        const int count = static_cast<int>(tables_.enhanced.size());
        const Voigt* direction = w.enhanced.data() + q * count;
        const double* value = tables_.mode_values.data() + q * tables_.entries.size();
        for (int c = 0; c < count; ++c) {
            Voigt Cd;
            for (int p = 0; p < 6; ++p) Cd[p] = dot(direction[c], C[p]);
            std::array<Real, 6> dCd;
            for (int other = 0; other < count; ++other) dCd[other] = dot(direction[other], Cd);
            const Real dS = dot(direction[c], S);
            std::array<Real, size> dCB{};
            add_force<FirstExtra>(Cd, t, mean, extra, dCB.data());
            for (std::size_t e = 0; e < tables_.entries.size(); ++e) {
                if (tables_.entries[e].component != c) continue;
                const int mode = tables_.entries[e].mode;
                w.ra[mode] += value[e] * dS;
                for (int i = 0; i < size; ++i) w.Kad[mode * size + i] += value[e] * dCB[i];
                for (std::size_t other = 0; other < tables_.entries.size(); ++other)
                    if (tables_.entries[other].mode <= mode)
                        w.Kaa[mode * tables_.modes + tables_.entries[other].mode] +=
                            value[e] * value[other] * dCd[tables_.entries[other].component];
            }
        }
    }

    int first_extra_;  // first of the rows that the director has a share of its own in
};

}  // namespace umform
