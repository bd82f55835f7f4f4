// Products of the rows of a column with stress and tangent: forces, stiffness, geometric stiffness.
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
    ShellProducts(const Technology& technology, const SurfacePoints& surface_points, const ThicknessRule& thickness,
                  bool symmetric)
        : Rows(technology, surface_points, thickness), symmetric_(symmetric) {}

    bool symmetric() const { return symmetric_; }
    Workspace workspace() const { return Workspace(tables_, symmetric_); }

  protected:
    using Rows::first_row_;
    using Rows::tables_;
    using Voigt = Vec<Real, 6>;
    using Voigt66 = std::array<Voigt, 6>;

    /// Moments in t of a stress, or of a row of the tangent, over a column: [power].
    using Moments = std::array<Voigt, 3>;

    /// Sum over the rows Begin .. End - 1 of B.
    template <int Begin, int End>
    static Real combination(const Real* factor, const Real* B, int i) {
        Real sum = factor[Begin] * B[Begin * half + i];
#pragma GCC unroll 14
        for (int p = Begin + 1; p < End; ++p) sum += factor[p] * B[p * half + i];
        return sum;
    }

    template <std::size_t Count>
    static std::array<Real, Count> factors(const std::array<PowerRow, Count>& rows, const Moments& of) {
        std::array<Real, Count> out;
        for (std::size_t i = 0; i < Count; ++i) out[i] = of[rows[i].power][rows[i].strain];
        return out;
    }

    /// f += int B^T S dV over a column, from the moments of S.
    template <int First>
    static void add_force(const Moments& S, const Workspace& w, Real* f) {
        const auto of_mean = factors(rows_of_mean, S);
        const auto of_director = factors(rows_of_director, S);
        const Real *mean = w.mean_rows.data(), *director = w.director_rows.data();
        for (int i = 0; i < half; ++i) {
            f[i] += combination<0, of_mean.size()>(of_mean.data(), mean, i);
            f[half + i] += combination<First, of_director.size()>(of_director.data(), director, i);
        }
    }

    /// Rows C B of the rows `left`, with the moments of C over the column: two together, with their factors in registers.
    template <int Begin, std::size_t Left, std::size_t Count>
    static void multiply(int first, const std::array<PowerRow, Left>& left, const std::array<PowerRow, Count>& rows,
                         const std::array<Voigt66, 5>& C, const Real* B, Real* CB) {
        for (int k = first; k < static_cast<int>(Left); k += 2) {
            const int two = std::min<int>(k + 1, Left - 1);
            std::array<Real, Count> a, b;
            for (int j = Begin; j < static_cast<int>(Count); ++j) {
                a[j] = C[left[k].power + rows[j].power][left[k].strain][rows[j].strain];
                b[j] = C[left[two].power + rows[j].power][left[two].strain][rows[j].strain];
            }
            for (int i = 0; i < half; ++i) {
                CB[k * half + i] = combination<Begin, Count>(a.data(), B, i);
                CB[two * half + i] = combination<Begin, Count>(b.data(), B, i);
            }
        }
    }

    /// int B^T C B over a column, once for all of its points. eq. (2.36)
    template <int First>
    void add_stiffness(Workspace& w) const {
        constexpr int of_mean = rows_of_mean.size(), of_director = rows_of_director.size();
        const Real *mean = w.mean_rows.data(), *director = w.director_rows.data();
        const RowSet left{1, of_mean, 0, half}, right{1, of_director - First, 0, half};
        Real *Kmm = w.Kmm.data(), *Kdm = w.Kdm.data(), *Kdd = w.Kdd.data(), *product = w.product.data();
        const auto add_to = [](Real* K) {
            return [K](int i, int j, const Tile<Real>& sum) { add_tile<half>(K, i, j, 1.0, sum); };
        };
        multiply<0>(0, rows_of_mean, rows_of_mean, w.C, mean, product);
        transposed_product<half>(left, mean, product, symmetric_, add_to(Kmm));
        if (!symmetric_) {
            multiply<0>(First, rows_of_director, rows_of_mean, w.C, mean, product);
            transposed_product<half>(right, director + First * half, product + First * half, false, add_to(Kdm));
        }
        multiply<First>(0, rows_of_mean, rows_of_director, w.C, director, product);
        transposed_product<half>(left, mean, product, false, [&](int i, int j, const Tile<Real>& sum) {
            if (symmetric_)
                add_transposed_tile<half>(Kdm, i, j, 1.0, sum);
            else
                add_tile<half>(w.Kmd.data(), i, j, 1.0, sum);
        });
        multiply<First>(First, rows_of_director, rows_of_director, w.C, director, product);
        transposed_product<half>(right, director + First * half, product + First * half, symmetric_, add_to(Kdd));
    }

    /// Stress moments int t^k S^c dV of every place from those of a column: compatible components at the Gauss point itself, tied
    /// ones at their tying points, whose t is zero at the mid-surface. eqs. (2.4), (2.37)
    void gather_stress(int point, const Moments& S, Workspace& w) const {
        for (int p = 0; p < 6; ++p) {
            const int component = row_order[p];
            if (tables_.row_of[component] < 0) {
                for (int k = 0; k < 3; ++k) w.moments[point][component][k] += S[k][p];
                continue;
            }
            const auto& row = tables_.rows[tables_.row_of[component]];
            const auto& samples = row.at_layer ? tables_.layer_samples : tables_.mid_samples;
            for (const auto& [sample, weight] : row.shares[point])
                for (int k = 0; k < (row.at_layer ? 3 : 1); ++k)
                    w.moments[samples[sample].place][component][k] += weight * S[k][p];
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
