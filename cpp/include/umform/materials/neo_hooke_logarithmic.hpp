// Compressible neo-Hooke, logarithmic form. eqs. (3.5), (3.6)
#pragma once

#include "umform/materials/right_cauchy_green.hpp"

namespace umform {

/// W = mu/2 (I1 - 3) - mu ln J + lambda/2 ln^2 J. eqs. (3.5), (3.6)
struct NeoHookeLogarithmic {
    double lambda, mu;

    static constexpr VariableTable<0> table{};
    void initial(double*) const {}

    template <class Real>
    Mask<Real> respond(const Vec<Real, 6>& E, const Real*, Vec<Real, 6>& S, Mat<Real, 6, 6>& CC, Real*) const {
        RightCauchyGreen<Real> C;
        const Mask<Real> positive = C.set(E);
        const Real pressure = 0.5 * lambda * C.log_det;
        for (int p = 0; p < 6; ++p) {
            const auto [i, j] = voigt_pair[p];
            S[p] = mu * C.one_minus_inverse(i, j) + pressure * C.inverse(i, j);
        }
        C.tangent(lambda, 2.0 * (mu - pressure), CC);
        return positive;
    }

    /// eq. (3.36)
    Energy energy(const Voigt& E, const double*) const {
        RightCauchyGreen<double> C;
        if (!C.set(E)) return {};
        return {mu * C.isochoric() + 0.125 * lambda * C.log_det * C.log_det, 0.0};
    }
};

}  // namespace umform
