// Compressible neo-Hooke, power form. eqs. (3.7), (3.8)
#pragma once

#include "umform/materials/right_cauchy_green.hpp"

namespace umform {

/// W = c (I1 - 3) + c/beta (I3^-beta - 1) with c = mu/2, beta = nu/(1 - 2 nu). eqs. (3.7), (3.8)
struct NeoHookePower {
    double mu, beta;

    static constexpr VariableTable<0> table{};
    void initial(double*) const {}

    template <class Real>
    Mask<Real> respond(const Vec<Real, 6>& E, const Real*, Vec<Real, 6>& S, Mat<Real, 6, 6>& CC, Real*) const {
        RightCauchyGreen<Real> C;
        const Mask<Real> positive = C.set(E);
        const Real one_minus_power = -expm1(-beta * C.log_det);  // 1 - I3^-beta
        const Real power = 1.0 - one_minus_power;
        for (int p = 0; p < 6; ++p) {
            const auto [i, j] = voigt_pair[p];
            S[p] = mu * (C.one_minus_inverse(i, j) + one_minus_power * C.inverse(i, j));
        }
        C.tangent(2.0 * mu * beta * power, 2.0 * mu * power, CC);
        return positive;
    }

    /// eq. (3.37)
    Energy energy(const Voigt& E, const double*) const {
        RightCauchyGreen<double> C;
        if (!C.set(E)) return {};
        const double volumetric = 0.5 * beta * C.log_det * C.log_det * exp_remainder(-beta * C.log_det);
        return {mu * (C.isochoric() + volumetric), 0.0};
    }
};

}  // namespace umform
