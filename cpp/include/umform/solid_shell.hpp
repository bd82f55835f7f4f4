// The one Gauss loop: assumed strains by tying, enhanced strains, material, residual and tangent of a solid-shell.
//
// Everything is done in convected components; only the material sees a local orthonormal frame. Every strain component
// is linear in sampled covariant strains, so that strain, its row B and its constant Hessian use the same weights:
//   E_a = sum_T w_T E_a(T),  B_a = sum_T w_T B_a(T),  K_geo = sum_T sigma_T Hessian_a(T), sigma_T = int w_T S^a dV.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "umform/condensation.hpp"
#include "umform/kinematics.hpp"
#include "umform/materials/concept.hpp"
#include "umform/shell_tables.hpp"

namespace umform {

template <int Nodes>
class SolidShell {
  public:
    static constexpr int size = 3 * Nodes;
    /// Values at the nodes of an element by direction: v[direction * Nodes + node].
    using Nodal = std::array<double, size>;

    /// Everything that one thread needs to work on one element; nothing is allocated after construction.
    struct Workspace {
        // Strain at the Gauss points.
        std::vector<Voigt> E, S;             // [q] in the local frame
        std::vector<Voigt66> T, CC;          // [q]
        std::vector<double> dV;              // [q]
        std::vector<Energy> energy;          // [q]
        std::vector<Voigt> enhanced;         // [q][component] covariant direction of an enhanced component
        std::vector<std::array<Vec3, 3>> g;  // [q] current base vectors
        // Tying samples: of the mid-surface, then of each layer.
        std::vector<double> sample_E;
        std::vector<Vec3> sample_gi, sample_gj;
        std::vector<double> sample_B;      // [sample of mid-surface and one layer][size]
        std::vector<double> sample_sigma;  // [sample of mid-surface and one layer]
        // Results.
        alignas(64) std::array<double, static_cast<std::size_t>(size) * size> K;  // upper triangle
        alignas(64) std::array<double, static_cast<std::size_t>(Nodes) * Nodes> K_geometric;
        Nodal f;
        // Enhanced parameters: after `condense`, Kad holds Kaa^-1 Kad and ra holds Kaa^-1 ra.
        std::vector<double> Kaa, Kad, Kad_raw, ra;
    };

    SolidShell(const Technology& technology, int surface_points, const Rule& thickness)
        : tables_(technology, gauss(surface_points), thickness) {}

    int points() const { return tables_.points(); }
    int modes() const { return tables_.modes; }
    const ShellGradient<Nodes>& gradient(int q) const { return tables_.gauss[q]; }

    Workspace workspace() const {
        Workspace w;
        const int q = points(), per_pass = tables_.mid_samples + tables_.layer_samples,
                  all = tables_.mid_samples + tables_.layers * tables_.layer_samples;
        w.E.resize(q), w.S.resize(q), w.T.resize(q), w.CC.resize(q), w.dV.resize(q), w.g.resize(q), w.energy.resize(q);
        w.enhanced.resize(q * tables_.enhanced.size());
        w.sample_E.resize(all), w.sample_gi.resize(all), w.sample_gj.resize(all);
        w.sample_B.resize(per_pass * size), w.sample_sigma.resize(per_pass);
        w.Kaa.resize(tables_.modes * tables_.modes), w.Kad.resize(tables_.modes * size),
            w.Kad_raw.resize(tables_.modes * size), w.ra.resize(tables_.modes);
        return w;
    }

    /// First pass: strains at the Gauss points in the local frame, with T, dV and the base vectors. False if inverted.
    bool strains(const Nodal& X, const Nodal& u, const double* alpha, Workspace& w) const {
        for (std::size_t k = 0; k < tables_.samples.size(); ++k) {
            const auto& sample = tables_.samples[k];
            const Vec3 Gi = derivative<Nodes>(sample.Ni.data(), X.data()),
                       hi = derivative<Nodes>(sample.Ni.data(), u.data());
            const Vec3 Gj = derivative<Nodes>(sample.Nj.data(), X.data()),
                       hj = derivative<Nodes>(sample.Nj.data(), u.data());
            const auto [i, j] = voigt_pair[sample.component];
            w.sample_E[k] = covariant_strain(i, j, Gi, Gj, hi, hj);
            w.sample_gi[k] = sum(Gi, hi);
            w.sample_gj[k] = sum(Gj, hj);
        }
        Mat3 J0_inverse;
        double det0 = 1.0;
        if (tables_.modes > 0) {
            const Mat3 J0 = jacobian(tables_.centre, X);
            det0 = det(J0);
            J0_inverse = inverse(J0);
        }
        for (int q = 0; q < points(); ++q) {
            std::array<Vec3, 3> G, h;
            for (int i = 0; i < 3; ++i) {
                G[i] = derivative<Nodes>(tables_.gauss[q][i].data(), X.data());
                h[i] = derivative<Nodes>(tables_.gauss[q][i].data(), u.data());
                w.g[q][i] = sum(G[i], h[i]);
            }
            Mat3 J;
            for (int k = 0; k < 3; ++k)
                for (int i = 0; i < 3; ++i) J(k, i) = G[i][k];
            const double detJ = det(J);
            if (!(detJ > 0.0)) return false;
            w.dV[q] = detJ * tables_.weight[q];
            const Mat3 contravariant = inverse(J);
            const std::array<Vec3, 3> frame = local_frame(G);
            Mat3 Jinv;
            for (int i = 0; i < 3; ++i)
                for (int k = 0; k < 3; ++k)
                    Jinv(i, k) = contravariant(i, 0) * frame[k][0] + contravariant(i, 1) * frame[k][1]
                                 + contravariant(i, 2) * frame[k][2];
            w.T[q] = strain_transform(Jinv);

            Voigt E{};
            for (int p = 0; p < 6; ++p) {
                const auto [i, j] = voigt_pair[p];
                if (tables_.row_of[p] < 0) {
                    E[p] = covariant_strain(i, j, G[i], G[j], h[i], h[j]);
                } else {
                    const auto& row = tables_.rows[tables_.row_of[p]];
                    const double* sampled = w.sample_E.data() + tables_.first_sample(row, q);
                    for (int k = 0; k < row.count; ++k) E[p] += tables_.tying_weight(row, q, k) * sampled[k];
                }
            }
            add_enhanced_strain(q, J, J0_inverse, det0 / detJ, alpha, E, w);
            for (int p = 0; p < 6; ++p) {
                double value = 0.0;
                for (int c = 0; c < 6; ++c) value += w.T[q](p, c) * E[c];
                w.E[q][p] = value;
            }
        }
        return true;
    }

    /// Second pass: residual f, tangent K (upper triangle) and the blocks of the enhanced parameters from S and CC.
    void integrate(Workspace& w) const {
        w.f.fill(0.0), w.K.fill(0.0), w.K_geometric.fill(0.0);
        std::fill(w.Kaa.begin(), w.Kaa.end(), 0.0);
        std::fill(w.Kad.begin(), w.Kad.end(), 0.0);
        std::fill(w.ra.begin(), w.ra.end(), 0.0);
        std::fill(w.sample_sigma.begin(), w.sample_sigma.end(), 0.0);
        sample_rows(w, 0, tables_.mid_samples, 0);
        for (int layer = 0; layer < tables_.layers; ++layer) {
            sample_rows(w, tables_.mid_samples + layer * tables_.layer_samples, tables_.layer_samples,
                        tables_.mid_samples);
            for (int p = 0; p < tables_.surface; ++p) integrate_point(layer * tables_.surface + p, w);
            add_sampled_geometry(w, tables_.mid_samples + layer * tables_.layer_samples, tables_.layer_samples,
                                 tables_.mid_samples);
        }
        add_sampled_geometry(w, 0, tables_.mid_samples, 0);
        for (int k = 0; k < 3; ++k)
            for (int a = 0; a < Nodes; ++a)
                for (int b = a; b < Nodes; ++b)
                    w.K[(k * Nodes + a) * size + k * Nodes + b] += w.K_geometric[a * Nodes + b];
    }

    /// Eliminates the enhanced parameters: K -= Kda Kaa^-1 Kad, f -= Kda Kaa^-1 ra. False if Kaa is singular. eq. (2.18)
    bool condense(Workspace& w) const {
        if (tables_.modes == 0) return true;
        if (!factor_ldlt(w.Kaa.data(), tables_.modes)) return false;
        w.Kad_raw = w.Kad;
        solve_ldlt(w.Kaa.data(), tables_.modes, w.Kad.data(), size);
        solve_ldlt(w.Kaa.data(), tables_.modes, w.ra.data(), 1);
        add_transposed_product<size>(w.K.data(), w.Kad_raw.data(), w.Kad.data(), tables_.modes, -1.0);
        for (int m = 0; m < tables_.modes; ++m)
            for (int i = 0; i < size; ++i) w.f[i] -= w.Kad_raw[m * size + i] * w.ra[m];
        return true;
    }

    /// Base vectors G_i (columns) at the natural point with the shape gradient dN.
    static Mat3 jacobian(const ShellGradient<Nodes>& dN, const Nodal& X) {
        Mat3 J;
        for (int i = 0; i < 3; ++i) {
            const Vec3 G = derivative<Nodes>(dN[i].data(), X.data());
            for (int k = 0; k < 3; ++k) J(k, i) = G[k];
        }
        return J;
    }

  private:
    static Vec3 sum(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

    /// E += (detJ0/detJ) A^T M A alpha with A = J0^-1 J, for each enhanced component a fixed direction. eq. (2.10)
    void add_enhanced_strain(int q, const Mat3& J, const Mat3& J0_inverse, double ratio, const double* alpha, Voigt& E,
                             Workspace& w) const {
        if (tables_.modes == 0) return;
        Mat3 A;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                A(i, j) = J0_inverse(i, 0) * J(0, j) + J0_inverse(i, 1) * J(1, j) + J0_inverse(i, 2) * J(2, j);
        const int count = static_cast<int>(tables_.enhanced.size());
        Voigt* direction = w.enhanced.data() + q * count;
        Voigt amount{};
        for (std::size_t e = 0; e < tables_.entries.size(); ++e)
            amount[tables_.entries[e].component] +=
                tables_.mode_values[q * tables_.entries.size() + e] * alpha[tables_.entries[e].mode];
        for (int c = 0; c < count; ++c) {
            const auto [k, l] = voigt_pair[tables_.enhanced[c]];
            for (int p = 0; p < 6; ++p) {
                const auto [i, j] = voigt_pair[p];
                double value = 0.5 * (A(k, i) * A(l, j) + A(l, i) * A(k, j));
                if (p >= 3) value *= 2.0;
                direction[c][p] = ratio * value;
                E[p] += direction[c][p] * amount[c];
            }
        }
    }

    /// Row of a strain component: N_i[a] g_j + N_j[a] g_i for shears, N_i[a] g_i for stretches. eq. (1.10)
    static void strain_row(int component, const double* Ni, const double* Nj, const Vec3& gi, const Vec3& gj,
                           double* B) {
        for (int k = 0; k < 3; ++k) {
            if (component < 3) {
#pragma omp simd
                for (int a = 0; a < Nodes; ++a) B[k * Nodes + a] = Ni[a] * gi[k];
            } else {
#pragma omp simd
                for (int a = 0; a < Nodes; ++a) B[k * Nodes + a] = Ni[a] * gj[k] + Nj[a] * gi[k];
            }
        }
    }

    void sample_rows(Workspace& w, int first, int count, int slot) const {
        for (int k = 0; k < count; ++k) {
            const auto& sample = tables_.samples[first + k];
            strain_row(sample.component, sample.Ni.data(), sample.Nj.data(), w.sample_gi[first + k],
                       w.sample_gj[first + k], w.sample_B.data() + (slot + k) * size);
        }
    }

    void integrate_point(int q, Workspace& w) const {
        alignas(64) std::array<double, 6 * size> B, CB;
        const Voigt66& T = w.T[q];
        const double dV = w.dV[q];

        // Convected stress and tangent, times dV: S = T^T S_local, C = T^T CC T. eq. (1.17)
        Voigt S{};
        Voigt66 CT{}, C{};
        for (int p = 0; p < 6; ++p)
            for (int c = 0; c < 6; ++c) {
                S[c] += T(p, c) * w.S[q][p] * dV;
                for (int k = 0; k < 6; ++k) CT(p, k) += w.CC[q](p, c) * T(c, k);
            }
        for (int p = 0; p < 6; ++p)
            for (int c = 0; c < 6; ++c)
                for (int k = 0; k < 6; ++k) C(c, k) += T(p, c) * dV * CT(p, k);

        Mat3 compatible_S;  // the part of S that meets compatible strains
        for (int p = 0; p < 6; ++p) {
            const auto [i, j] = voigt_pair[p];
            double* row_B = B.data() + p * size;
            if (tables_.row_of[p] < 0) {
                strain_row(p, tables_.gauss[q][i].data(), tables_.gauss[q][j].data(), w.g[q][i], w.g[q][j], row_B);
                compatible_S(i, j) = compatible_S(j, i) = S[p];
            } else {
                const auto& row = tables_.rows[tables_.row_of[p]];
                const int first = tables_.first_sample_of_pass(row);
                std::fill_n(row_B, size, 0.0);
                for (int k = 0; k < row.count; ++k) {
                    const double weight = tables_.tying_weight(row, q, k);
                    const double* sample = w.sample_B.data() + (first + k) * size;
                    w.sample_sigma[first + k] += weight * S[p];
#pragma omp simd
                    for (int i2 = 0; i2 < size; ++i2) row_B[i2] += weight * sample[i2];
                }
            }
        }
        for (int p = 0; p < 6; ++p) {
            double* row_CB = CB.data() + p * size;
#pragma omp simd
            for (int i = 0; i < size; ++i) {
                row_CB[i] = C(p, 0) * B[i] + C(p, 1) * B[size + i] + C(p, 2) * B[2 * size + i]
                            + C(p, 3) * B[3 * size + i] + C(p, 4) * B[4 * size + i] + C(p, 5) * B[5 * size + i];
            }
        }
#pragma omp simd
        for (int i = 0; i < size; ++i)
            w.f[i] += S[0] * B[i] + S[1] * B[size + i] + S[2] * B[2 * size + i] + S[3] * B[3 * size + i]
                      + S[4] * B[4 * size + i] + S[5] * B[5 * size + i];
        add_transposed_product<size>(w.K.data(), B.data(), CB.data(), 6, 1.0);
        add_compatible_geometry(q, compatible_S, w);
        if (tables_.modes > 0) add_enhanced_blocks(q, S, C, B.data(), w);
    }

    void add_compatible_geometry(int q, const Mat3& S, Workspace& w) const {
        const ShellGradient<Nodes>& dN = tables_.gauss[q];
        for (int i = 0; i < 3; ++i) {
            alignas(64) std::array<double, Nodes> SN;
#pragma omp simd
            for (int b = 0; b < Nodes; ++b) SN[b] = S(i, 0) * dN[0][b] + S(i, 1) * dN[1][b] + S(i, 2) * dN[2][b];
            for (int a = 0; a < Nodes; ++a)
#pragma omp simd
                for (int b = 0; b < Nodes; ++b) w.K_geometric[a * Nodes + b] += dN[i][a] * SN[b];
        }
    }

    void add_sampled_geometry(Workspace& w, int first, int count, int slot) const {
        for (int k = 0; k < count; ++k) {
            const auto& sample = tables_.samples[first + k];
            const double sigma = w.sample_sigma[slot + k];
            w.sample_sigma[slot + k] = 0.0;
            for (int a = 0; a < Nodes; ++a) {
                const double Ni = sigma * sample.Ni[a], Nj = sample.component < 3 ? 0.0 : sigma * sample.Nj[a];
#pragma omp simd
                for (int b = 0; b < Nodes; ++b) w.K_geometric[a * Nodes + b] += Ni * sample.Nj[b] + Nj * sample.Ni[b];
            }
        }
    }

    void add_enhanced_blocks(int q, const Voigt& S, const Voigt66& C, const double* B, Workspace& w) const {
        const int count = static_cast<int>(tables_.enhanced.size());
        const Voigt* direction = w.enhanced.data() + q * count;
        const double* value = tables_.mode_values.data() + q * tables_.entries.size();
        std::array<Voigt, 6> Cd;  // C d of each enhanced component
        std::array<std::array<double, 6>, 6> dCd;
        std::array<double, 6> dS;
        for (int c = 0; c < count; ++c) {
            for (int p = 0; p < 6; ++p) {
                double sum = 0.0;
                for (int k = 0; k < 6; ++k) sum += C(p, k) * direction[c][k];
                Cd[c][p] = sum;
            }
            for (int other = 0; other <= c; ++other) dCd[c][other] = dCd[other][c] = dot(direction[other], Cd[c]);
            dS[c] = dot(direction[c], S);
        }
        for (int c = 0; c < count; ++c) {
            alignas(64) std::array<double, size> dCB;
#pragma omp simd
            for (int i = 0; i < size; ++i)
                dCB[i] = Cd[c][0] * B[i] + Cd[c][1] * B[size + i] + Cd[c][2] * B[2 * size + i]
                         + Cd[c][3] * B[3 * size + i] + Cd[c][4] * B[4 * size + i] + Cd[c][5] * B[5 * size + i];
            for (std::size_t e = 0; e < tables_.entries.size(); ++e) {
                if (tables_.entries[e].component != c) continue;
                const int mode = tables_.entries[e].mode;
                w.ra[mode] += value[e] * dS[c];
#pragma omp simd
                for (int i = 0; i < size; ++i) w.Kad[mode * size + i] += value[e] * dCB[i];
                for (std::size_t other = 0; other < tables_.entries.size(); ++other)
                    w.Kaa[mode * tables_.modes + tables_.entries[other].mode] +=
                        value[e] * value[other] * dCd[c][tables_.entries[other].component];
            }
        }
    }

    const ShellTables<Nodes> tables_;
};

}  // namespace umform
