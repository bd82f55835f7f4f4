// St. Venant-Kirchhoff: linear between second Piola-Kirchhoff stress and Green-Lagrange strain. eq. (3.4)
#pragma once

#include "umform/materials/concept.hpp"

namespace umform {

struct SaintVenantKirchhoff {
    double lambda, mu;

    static constexpr int state_size = 0;
    void initial(double*) const {}

    bool respond(const Voigt& E, const double*, Voigt& S, Voigt66& CC, double*) const {
        const double pressure = lambda * (E[0] + E[1] + E[2]);
        CC = Voigt66{};
        for (int i = 0; i < 3; ++i) {
            S[i] = pressure + 2.0 * mu * E[i];
            S[i + 3] = mu * E[i + 3];
            for (int j = 0; j < 3; ++j) CC(i, j) = lambda;
            CC(i, i) += 2.0 * mu;
            CC(i + 3, i + 3) = mu;
        }
        return true;
    }
};

}  // namespace umform
