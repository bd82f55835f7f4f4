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
#include "umform/quadrature.hpp"
#include "umform/technology.hpp"
#include "umform/topology.hpp"

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
        : surface_(surface_points * surface_points), layers_(thickness.size()) {
        tabulate_gauss_points(gauss(surface_points), thickness);
        tabulate_tying(technology, gauss(surface_points), thickness);
        tabulate_modes(technology, gauss(surface_points), thickness);
    }

    int points() const { return surface_ * layers_; }
    int modes() const { return modes_; }
    const ShellGradient<Nodes>& gradient(int q) const { return gauss_[q]; }

    Workspace workspace() const {
        Workspace w;
        const int q = points(), per_pass = mid_samples_ + layer_samples_, all = mid_samples_ + layers_ * layer_samples_;
        w.E.resize(q), w.S.resize(q), w.T.resize(q), w.CC.resize(q), w.dV.resize(q), w.g.resize(q);
        w.enhanced.resize(q * enhanced_.size());
        w.sample_E.resize(all), w.sample_gi.resize(all), w.sample_gj.resize(all);
        w.sample_B.resize(per_pass * size), w.sample_sigma.resize(per_pass);
        w.Kaa.resize(modes_ * modes_), w.Kad.resize(modes_ * size), w.Kad_raw.resize(modes_ * size),
            w.ra.resize(modes_);
        return w;
    }

    /// First pass: strains at the Gauss points in the local frame, with T, dV and the base vectors. False if inverted.
    bool strains(const Nodal& X, const Nodal& u, const double* alpha, Workspace& w) const {
        for (std::size_t k = 0; k < samples_.size(); ++k) {
            const Sample& sample = samples_[k];
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
        if (modes_ > 0) {
            const Mat3 J0 = jacobian(centre_, X);
            det0 = det(J0);
            J0_inverse = inverse(J0);
        }
        for (int q = 0; q < points(); ++q) {
            std::array<Vec3, 3> G, h;
            for (int i = 0; i < 3; ++i) {
                G[i] = derivative<Nodes>(gauss_[q][i].data(), X.data());
                h[i] = derivative<Nodes>(gauss_[q][i].data(), u.data());
                w.g[q][i] = sum(G[i], h[i]);
            }
            Mat3 J;
            for (int k = 0; k < 3; ++k)
                for (int i = 0; i < 3; ++i) J(k, i) = G[i][k];
            const double detJ = det(J);
            if (!(detJ > 0.0)) return false;
            w.dV[q] = detJ * weight_[q];
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
                if (row_of_[p] < 0) {
                    E[p] = covariant_strain(i, j, G[i], G[j], h[i], h[j]);
                } else {
                    const Row& row = rows_[row_of_[p]];
                    const double* sampled = w.sample_E.data() + first_sample(row, q);
                    for (int k = 0; k < row.count; ++k) E[p] += tying_weight(row, q, k) * sampled[k];
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
        sample_rows(w, 0, mid_samples_, 0);
        for (int layer = 0; layer < layers_; ++layer) {
            sample_rows(w, mid_samples_ + layer * layer_samples_, layer_samples_, mid_samples_);
            for (int p = 0; p < surface_; ++p) integrate_point(layer * surface_ + p, w);
            add_sampled_geometry(w, mid_samples_ + layer * layer_samples_, layer_samples_, mid_samples_);
        }
        add_sampled_geometry(w, 0, mid_samples_, 0);
        for (int k = 0; k < 3; ++k)
            for (int a = 0; a < Nodes; ++a)
                for (int b = a; b < Nodes; ++b)
                    w.K[(k * Nodes + a) * size + k * Nodes + b] += w.K_geometric[a * Nodes + b];
    }

    /// Eliminates the enhanced parameters: K -= Kda Kaa^-1 Kad, f -= Kda Kaa^-1 ra. False if Kaa is singular. eq. (2.18)
    bool condense(Workspace& w) const {
        if (modes_ == 0) return true;
        if (!factor_ldlt(w.Kaa.data(), modes_)) return false;
        w.Kad_raw = w.Kad;
        solve_ldlt(w.Kaa.data(), modes_, w.Kad.data(), size);
        solve_ldlt(w.Kaa.data(), modes_, w.ra.data(), 1);
        add_transposed_product<size>(w.K.data(), w.Kad_raw.data(), w.Kad.data(), modes_, -1.0);
        for (int m = 0; m < modes_; ++m)
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
    struct Sample {
        int component;
        std::array<double, Nodes> Ni, Nj;
    };
    struct Row {
        bool at_layer;
        int first, count;  // samples, counted inside the mid-surface or inside a layer
        int first_weight;  // in tying_weights_, then [surface point][sample]
    };
    struct ModeEntry {
        int component, mode;  // component: position in enhanced_
    };

    static Vec3 sum(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

    double tying_weight(const Row& row, int q, int k) const {
        return tying_weights_[row.first_weight + (q % surface_) * row.count + k];
    }
    int first_sample(const Row& row, int q) const {
        return row.at_layer ? mid_samples_ + (q / surface_) * layer_samples_ + row.first : row.first;
    }
    /// The same among the samples of the mid-surface and of the layer at work.
    int first_sample_of_pass(const Row& row) const { return row.at_layer ? mid_samples_ + row.first : row.first; }

    void tabulate_gauss_points(const Rule& surface, const Rule& thickness) {
        for (int layer = 0; layer < layers_; ++layer)
            for (int is = 0; is < surface.size(); ++is)
                for (int ir = 0; ir < surface.size(); ++ir) {
                    gauss_.push_back(shell_gradient<Nodes>(surface.x[ir], surface.x[is], thickness.x[layer]));
                    weight_.push_back(surface.w[ir] * surface.w[is] * thickness.w[layer]);
                }
        centre_ = shell_gradient<Nodes>(0.0, 0.0, 0.0);
    }

    void tabulate_tying(const Technology& technology, const Rule& surface, const Rule& thickness) {
        row_of_.fill(-1);
        for (const Tying& tying : technology.tying) {
            int& samples = tying.at_layer ? layer_samples_ : mid_samples_;
            const int count = static_cast<int>(tying.r.size() * tying.s.size());
            row_of_[tying.component] = static_cast<int>(rows_.size());
            rows_.push_back({tying.at_layer, samples, count, static_cast<int>(tying_weights_.size())});
            samples += count;
            for (const double s : surface.x)
                for (const double r : surface.x)
                    for (const double ws : lagrange(tying.s, s))
                        for (const double wr : lagrange(tying.r, r)) tying_weights_.push_back(wr * ws);
        }
        add_samples(technology, false, 0.0);
        for (const double t : thickness.x) add_samples(technology, true, t);
    }

    void add_samples(const Technology& technology, bool at_layer, double t) {
        for (const Tying& tying : technology.tying) {
            if (tying.at_layer != at_layer) continue;
            const auto [i, j] = voigt_pair[tying.component];
            for (const double s : tying.s)
                for (const double r : tying.r) {
                    const ShellGradient<Nodes> dN = shell_gradient<Nodes>(r, s, t);
                    samples_.push_back({tying.component, dN[i], dN[j]});
                }
        }
    }

    void tabulate_modes(const Technology& technology, const Rule& surface, const Rule& thickness) {
        modes_ = static_cast<int>(technology.modes.size());
        std::array<int, 6> position;
        position.fill(-1);
        for (const Mode& mode : technology.modes)
            for (const Term& term : mode)
                if (position[term.component] < 0) {
                    position[term.component] = static_cast<int>(enhanced_.size());
                    enhanced_.push_back(term.component);
                }
        for (int m = 0; m < modes_; ++m)
            for (const int component : enhanced_)
                for (const Term& term : technology.modes[m])
                    if (term.component == component
                        && (entries_.empty() || entries_.back().mode != m
                            || entries_.back().component != position[component]))
                        entries_.push_back({position[component], m});
        for (const double t : thickness.x)
            for (const double s : surface.x)
                for (const double r : surface.x)
                    for (const ModeEntry& entry : entries_) {
                        double value = 0.0;
                        for (const Term& term : technology.modes[entry.mode])
                            if (term.component == enhanced_[entry.component]) value += term(r, s, t);
                        mode_values_.push_back(value);
                    }
    }

    /// E += (detJ0/detJ) A^T M A alpha with A = J0^-1 J, for each enhanced component a fixed direction. eq. (2.10)
    void add_enhanced_strain(int q, const Mat3& J, const Mat3& J0_inverse, double ratio, const double* alpha, Voigt& E,
                             Workspace& w) const {
        if (modes_ == 0) return;
        Mat3 A;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                A(i, j) = J0_inverse(i, 0) * J(0, j) + J0_inverse(i, 1) * J(1, j) + J0_inverse(i, 2) * J(2, j);
        const int count = static_cast<int>(enhanced_.size());
        Voigt* direction = w.enhanced.data() + q * count;
        Voigt amount{};
        for (std::size_t e = 0; e < entries_.size(); ++e)
            amount[entries_[e].component] += mode_values_[q * entries_.size() + e] * alpha[entries_[e].mode];
        for (int c = 0; c < count; ++c) {
            const auto [k, l] = voigt_pair[enhanced_[c]];
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
            const Sample& sample = samples_[first + k];
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
            if (row_of_[p] < 0) {
                strain_row(p, gauss_[q][i].data(), gauss_[q][j].data(), w.g[q][i], w.g[q][j], row_B);
                compatible_S(i, j) = compatible_S(j, i) = S[p];
            } else {
                const Row row = rows_[row_of_[p]];
                const int first = first_sample_of_pass(row);
                std::fill_n(row_B, size, 0.0);
                for (int k = 0; k < row.count; ++k) {
                    const double weight = tying_weight(row, q, k);
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
        if (modes_ > 0) add_enhanced_blocks(q, S, C, B.data(), w);
    }

    void add_compatible_geometry(int q, const Mat3& S, Workspace& w) const {
        const ShellGradient<Nodes>& dN = gauss_[q];
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
            const Sample& sample = samples_[first + k];
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
        const int count = static_cast<int>(enhanced_.size());
        const Voigt* direction = w.enhanced.data() + q * count;
        const double* value = mode_values_.data() + q * entries_.size();
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
            for (std::size_t e = 0; e < entries_.size(); ++e) {
                if (entries_[e].component != c) continue;
                const int mode = entries_[e].mode;
                w.ra[mode] += value[e] * dS[c];
#pragma omp simd
                for (int i = 0; i < size; ++i) w.Kad[mode * size + i] += value[e] * dCB[i];
                for (std::size_t other = 0; other < entries_.size(); ++other)
                    w.Kaa[mode * modes_ + entries_[other].mode] +=
                        value[e] * value[other] * dCd[c][entries_[other].component];
            }
        }
    }

    int surface_, layers_, modes_ = 0;
    int mid_samples_ = 0, layer_samples_ = 0;
    std::vector<ShellGradient<Nodes>> gauss_;  // [q]
    std::vector<double> weight_;               // [q]
    ShellGradient<Nodes> centre_;
    std::array<int, 6> row_of_;  // component -> row of the tying rule, or -1
    std::vector<Row> rows_;
    std::vector<double> tying_weights_;
    std::vector<Sample> samples_;      // of the mid-surface, then layer by layer
    std::vector<int> enhanced_;        // enhanced components
    std::vector<ModeEntry> entries_;   // which component of which mode is not zero
    std::vector<double> mode_values_;  // [q][entry]
};

}  // namespace umform
