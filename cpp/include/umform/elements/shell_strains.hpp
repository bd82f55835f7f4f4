// First half of the Gauss loop: assumed and enhanced strains of a solid-shell at its Gauss points, in the local frame.
#pragma once

#include "umform/elements/shell_tables.hpp"
#include "umform/elements/shell_workspace.hpp"

namespace umform {

template <int Nodes, class Real>
class ShellStrains {
  public:
    using Workspace = ShellWorkspace<Nodes, Real>;
    using Nodal = typename Workspace::Nodal;
    using Vectors = std::array<Vec<Real, 3>, 3>;

    ShellStrains(const Technology& technology, const SurfacePoints& surface_points, const ThicknessRule& thickness)
        : tables_(technology, gauss(surface_points), thickness) {}

    int points() const { return tables_.points(); }
    int modes() const { return tables_.modes; }

    /// Strains at the Gauss points in the local frame, with A, dV and the base vectors. The frame follows the `rolling`
    /// direction, if one is given. False where det J of the reference or of the current configuration is not positive
    /// at a Gauss point: the strain alone cannot tell an element that is turned inside out from one that is not. eqs. (1.4), (1.25)
    Mask<Real> strains(const Nodal& X, const Nodal& u, const Real* alpha, const Vec<Real, 3>* rolling,
                       Workspace& w) const {
        for (std::size_t k = 0; k < tables_.places.size(); ++k) {
            w.G[k] = base_of(tables_.places[k].shape, X.data());
            w.h[k] = base_of(tables_.places[k].shape, u.data());
        }
        sample_strains(total(w), w);
        const Vectors G0 = w.G[tables_.centre].at(0.0);
        const Mat<Real, 3, 3> centre_inverse = inverse(columns(G0));
        const Real centre_det = det(columns(G0));
        w.rolled = rolling != nullptr;
        Mask<Real> valid = true;
        for (int q = 0; q < points(); ++q) {
            const int p = q % tables_.surface;
            const double t = tables_.t[q];
            const Vectors G = w.G[p].at(t);
            const Real detJ = det(columns(G));
            valid = valid & (detJ > 0.0) & (det(columns(current(p, t, w))) > 0.0);
            w.dV[q] = detJ * tables_.weight[q];
            w.A[q] = rolling == nullptr ? local_inverse(G) : local_inverse(G, local_frame(G, *rolling));
            Voigt E = assumed_strain(p, t, total(w), w);
            if (tables_.modes > 0) {
                enhanced_directions(q, product(centre_inverse, columns(G)), centre_det / detJ, w);
                add_enhanced_strain(q, alpha, w, E);
            }
            w.E[q] = w.rolled ? to_local_full(w.A[q], E) : to_local(w.A[q], E);
        }
        return valid;
    }

    /// What is quadratic in a correction of the assumed strains at the Gauss points, in convected components. eq. (5.37)
    void quadratic_strains(const Nodal& correction, Workspace& w) const {
        for (std::size_t k = 0; k < tables_.places.size(); ++k)
            w.d[k] = base_of(tables_.places[k].shape, correction.data());
        const auto quadratic = [&w](int place, double t) {
            return [d = w.d[place].at(t)](int component) {
                const auto [i, j] = voigt_pair[component];
                return quadratic_strain(i, j, d);
            };
        };
        sample_strains(quadratic, w);
        for (int q = 0; q < points(); ++q) w.bent[q] = assumed_strain(q % tables_.surface, tables_.t[q], quadratic, w);
    }

    /// Axes of the local frame at all Gauss points, after `strains`.
    void axes(const Vec<Real, 3>* rolling, const Workspace& w, std::vector<Axes<Real>>& out) const {
        out.resize(points());
        for (int q = 0; q < points(); ++q) {
            const Vectors G = w.G[q % tables_.surface].at(tables_.t[q]);
            out[q] = rolling == nullptr ? local_frame(G) : local_frame(G, *rolling);
        }
    }

    /// Size of an element, after `strains`: root of the area of its undeformed mid-surface.
    Real length(const Workspace& w) const {
        Real area = 0.0;
        for (int q = 0; q < points(); ++q) {  // the weights of all layers of a place are 2
            const Vectors G = w.G[q % tables_.surface].at(0.0);
            const Vec<Real, 3> normal = cross(G[0], G[1]);
            area += 0.5 * tables_.weight[q] * sqrt(dot(normal, normal));
        }
        return sqrt(area);
    }

    /// Base vectors of one lane at a Gauss point, after `strains`.
    void base_vectors(int q, int lane, const Workspace& w, std::array<Vec3, 3>& G, std::array<Vec3, 3>& g) const {
        const int place = q % tables_.surface;
        const double t = tables_.t[q];
        const Vectors reference = w.G[place].at(t), now = current(place, t, w);
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) G[i][k] = reference[i][k][lane], g[i][k] = now[i][k][lane];
    }

  protected:
    static Vectors current(int place, double t, const Workspace& w) {
        Vectors g = w.G[place].at(t);
        const Vectors h = w.h[place].at(t);
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) g[i][k] += h[i][k];
        return g;
    }

    const ShellTables<Nodes> tables_;

  private:
    using Voigt = Vec<Real, 6>;

    /// Covariant strains: of place and t a function of the component.
    static auto total(const Workspace& w) {
        return [&w](int place, double t) {
            return [G = w.G[place].at(t), h = w.h[place].at(t)](int component) {
                const auto [i, j] = voigt_pair[component];
                return covariant_strain(i, j, G, h);
            };
        };
    }

    /// Strains at all tying points: at the mid-surface, and of the others the coefficients of their polynomial in t.
    template <class Strain>
    void sample_strains(const Strain& strain, Workspace& w) const {
        for (std::size_t k = 0; k < tables_.mid_samples.size(); ++k)
            w.mid_E[k] = strain(tables_.mid_samples[k].place, 0.0)(tables_.mid_samples[k].component);
        for (std::size_t k = 0; k < tables_.layer_samples.size(); ++k) {
            const auto& [component, place] = tables_.layer_samples[k];
            const Real middle = strain(place, 0.0)(component);
            const Real upper = strain(place, 1.0)(component), lower = strain(place, -1.0)(component);
            w.layer_E[k] = {middle, 0.5 * (upper - lower), 0.5 * (upper + lower) - middle};
        }
    }

    /// Compatible components, and tied ones from their samples. eq. (2.2)
    template <class Strain>
    Voigt assumed_strain(int surface_point, double t, const Strain& strain, const Workspace& w) const {
        const auto compatible = strain(surface_point, t);
        Voigt E{};
        for (int p = 0; p < 6; ++p) {
            if (tables_.row_of[p] < 0) {
                E[p] = compatible(p);
                continue;
            }
            const auto& row = tables_.rows[tables_.row_of[p]];
            for (const auto& [sample, weight] : row.shares[surface_point])
                if (row.at_layer) {
                    const auto& [constant, linear, square] = w.layer_E[sample];
                    E[p] += weight * (constant + t * (linear + t * square));
                } else {
                    E[p] += weight * w.mid_E[sample];
                }
        }
        return E;
    }

    /// (detJ0/detJ) A^T M A with A = J0^-1 J is for each enhanced component a fixed direction. eqs. (2.9), (2.10)
    void enhanced_directions(int q, const Mat<Real, 3, 3>& A, Real ratio, Workspace& w) const {
        Voigt* direction = w.enhanced.data() + q * tables_.enhanced.size();
        for (const int component : tables_.enhanced) {
            const auto [k, l] = voigt_pair[component];
            for (int p = 0; p < 6; ++p) {
                const auto [i, j] = voigt_pair[row_order[p]];
                (*direction)[p] = (i == j ? 0.5 : 1.0) * ratio * (A(k, i) * A(l, j) + A(l, i) * A(k, j));
            }
            ++direction;
        }
    }

    void add_enhanced_strain(int q, const Real* alpha, const Workspace& w, Voigt& E) const {
        const Voigt* direction = w.enhanced.data() + q * tables_.enhanced.size();
        Voigt amount{};
        for (const auto& [component, mode, value] : tables_.entries[q]) amount[component] += value * alpha[mode];
        for (std::size_t c = 0; c < tables_.enhanced.size(); ++c)
            for (int p = 0; p < 6; ++p) E[row_order[p]] += direction[c][p] * amount[c];
    }
};

}  // namespace umform
