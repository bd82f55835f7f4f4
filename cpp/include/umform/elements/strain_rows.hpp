// Strain rows of a solid-shell in the mean and the half difference of the displacements of its two faces.
//
// u(r, s, t) = u_mean(r, s) + t u_director(r, s), so that all that depends on (r, s) is the same for every layer, and the rows
// of all in-plane strains have one half only: the director takes t times what the mean takes. eqs. (2.34)-(2.36)
#pragma once

#include "umform/elements/kinematics.hpp"
#include "umform/elements/topology.hpp"

namespace umform {

/// Order of the strains in the loops: those without an additional term of the director come first, E_33, which has
/// nothing in the mean, comes last.
inline constexpr std::array<int, 6> row_order{C11, C22, C12, C13, C23, C33};
inline constexpr int mean_rows = 5, first_shear_row = 3;

/// Derivatives of a field at a place (r, s) of the surface: those of a layer t are mean + t slope, and director. eq. (2.34)
template <class Real>
struct Base {
    std::array<Vec<Real, 3>, 2> mean, slope;
    Vec<Real, 3> director;

    std::array<Vec<Real, 3>, 3> at(double t) const {
        std::array<Vec<Real, 3>, 3> layer;
        for (int k = 0; k < 3; ++k) {
            for (int i = 0; i < 2; ++i) layer[i][k] = mean[i][k] + t * slope[i][k];
            layer[2][k] = director[k];
        }
        return layer;
    }
};

/// `field` holds the mean by direction, then the director.
template <int Face, class Real>
Base<Real> base_of(const FaceShape<Face>& shape, const Real* field) {
    const Real* director = field + 3 * Face;
    return {{derivative<Face>(shape.Nr.data(), field), derivative<Face>(shape.Ns.data(), field)},
            {derivative<Face>(shape.Nr.data(), director), derivative<Face>(shape.Ns.data(), director)},
            derivative<Face>(shape.N.data(), director)};
}

/// Row of a strain component at a place and a layer t: over the mean, and what the director takes beyond t times that.
/// Entries direction * Face + node. eqs. (2.35), (2.36)
template <int Face, class Real>
void strain_row(int component, const FaceShape<Face>& shape, const std::array<Vec<Real, 3>, 3> g, Real* mean,
                Real* extra) {
    const std::array<const double*, 2> dN{shape.Nr.data(), shape.Ns.data()};
    const auto [i, j] = voigt_pair[component];
    for (int k = 0; k < 3; ++k)
        for (int a = 0; a < Face; ++a) {
            const int at = k * Face + a;
            if (component == C33) {
                mean[at] = 0.0;
                extra[at] = shape.N[a] * g[2][k];
            } else if (j == 2) {
                mean[at] = dN[i][a] * g[2][k];
                extra[at] = shape.N[a] * g[i][k];
            } else {
                mean[at] = i == j ? dN[i][a] * g[i][k] : dN[i][a] * g[j][k] + dN[j][a] * g[i][k];
                extra[at] = 0.0;
            }
        }
}

}  // namespace umform
