// St. Venant-Kirchhoff: linear between second Piola-Kirchhoff stress and Green-Lagrange strain. eq. (3.4)
#pragma once

#include "umform/materials/concept.hpp"

namespace umform {

struct SaintVenantKirchhoff {
    double lambda, mu;

    static constexpr VariableTable<0> table{};
    void initial(double*) const {}

    template <class Real>
    Mask<Real> respond(const Vec<Real, 6>& E, const Real*, Vec<Real, 6>& S, Mat<Real, 6, 6>& CC, Real*) const {
        const Real pressure = lambda * (E[0] + E[1] + E[2]);
        CC = Mat<Real, 6, 6>{};
        for (int i = 0; i < 3; ++i) {
            S[i] = pressure + 2.0 * mu * E[i];
            S[i + 3] = mu * E[i + 3];
            for (int j = 0; j < 3; ++j) CC(i, j) = lambda;
            CC(i, i) += 2.0 * mu;
            CC(i + 3, i + 3) = mu;
        }
        return true;
    }

    /// eq. (3.35)
    Energy energy(const Voigt& E, const double*) const {
        const double trace = E[0] + E[1] + E[2];
        const double normal = E[0] * E[0] + E[1] * E[1] + E[2] * E[2];
        const double shear = E[3] * E[3] + E[4] * E[4] + E[5] * E[5];  // of engineering components: 4 E_ij^2
        return {0.5 * lambda * trace * trace + mu * (normal + 0.5 * shear), 0.0};
    }
};

}  // namespace umform
