// Element technology is data: which strains are tied where, and which are enhanced by what.
#pragma once

#include <vector>

#include "umform/algebra/tensor.hpp"
#include "umform/elements/quadrature.hpp"

namespace umform {

/// One row of an assumed-strain rule: the covariant `component` is sampled at the grid r x s and interpolated with the
/// Lagrange polynomials of the abscissae; at the layer t of the Gauss point, or at the mid-surface. eq. (2.2)
struct Tying {
    int component;
    std::vector<double> r, s;
    bool at_layer;
};

/// A polynomial  factor * r^a s^b P_c(t)  in one covariant component (P_c: Legendre polynomial).
struct Polynomial {
    int component;
    double factor;
    int a, b, c;

    /// Minus the mean of P_c under the rule. eq. (2.48)
    double operator()(double r, double s, double t, double mean) const {
        return factor * std::pow(r, a) * std::pow(s, b) * (legendre(c, t).value - mean);
    }
};

/// One enhanced mode, a sum of polynomials: a column of M(r, s, t). eq. (2.10)
using Mode = std::vector<Polynomial>;

/// An element of the catalogue; components without a tying row are compatible.
struct Technology {
    std::vector<Tying> tying;
    std::vector<Mode> modes;
};

/// Weights of the Lagrange polynomials of the abscissae at x. eq. (2.1)
inline std::vector<double> lagrange(const std::vector<double>& abscissae, double x) {
    std::vector<double> weights(abscissae.size(), 1.0);
    for (std::size_t i = 0; i < abscissae.size(); ++i)
        for (std::size_t j = 0; j < abscissae.size(); ++j)
            if (i != j) weights[i] *= (x - abscissae[j]) / (abscissae[i] - abscissae[j]);
    return weights;
}

}  // namespace umform
