// The right Cauchy-Green tensor of the neo-Hookean laws, and the tangent that they share: a C^-1 (x) C^-1 + b I_{C^-1}.
#pragma once

#include "umform/materials/concept.hpp"
#include "umform/materials/remainders.hpp"

namespace umform {

/// The invariants of C = 1 + 2E that both forms of neo-Hooke need, formed without cancellation for small strains. eqs. (3.9), (3.10)
template <class Real>
struct RightCauchyGreen {
    Mat<Real, 3, 3> inverse;            // C^-1
    Mat<Real, 3, 3> one_minus_inverse;  // 1 - C^-1 = 2 C^-1 E
    Real det_minus_one;                 // I3 - 1
    Real higher;                        // the terms of I3 - 1 that are not linear in E
    Real log_det;                       // ln I3

    /// False where C is not positive definite.
    Mask<Real> set(const Vec<Real, 6>& strain) {
        const Mat<Real, 3, 3> E = from_voigt(strain, 0.5);
        Mat<Real, 3, 3> C;
        for (int i = 0; i < 9; ++i) C.a[i] = 2.0 * E.a[i];
        for (int i = 0; i < 3; ++i) C(i, i) += 1.0;
        const Real minor = C(0, 0) * C(1, 1) - C(0, 1) * C(0, 1);
        const Real trace = E(0, 0) + E(1, 1) + E(2, 2);
        Real second = 0.0;
        for (const auto& [i, j] : {std::pair{0, 1}, {1, 2}, {0, 2}}) second += E(i, i) * E(j, j) - E(i, j) * E(i, j);
        higher = 4.0 * second + 8.0 * det(E);
        det_minus_one = 2.0 * trace + higher;
        const Mask<Real> positive = (C(0, 0) > 0.0) & (minor > 0.0) & (det_minus_one > -1.0);
        log_det = det_minus_one * log1p_ratio(det_minus_one);
        inverse = umform::inverse(C);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                Real sum = 0.0;
                for (int k = 0; k < 3; ++k) sum += inverse(i, k) * E(k, j) + E(i, k) * inverse(k, j);
                one_minus_inverse(i, j) = sum;
            }
        return positive;
    }

    /// (I1 - 3) / 2 - ln J, of second order in E. eq. (3.36)
    Real isochoric() const { return 0.5 * (log_remainder(det_minus_one) - higher); }

    /// CC = a C^-1 (x) C^-1 + b I_{C^-1} with I_ijkl = (C^-1_ik C^-1_jl + C^-1_il C^-1_jk) / 2.
    void tangent(Real a, Real b, Mat<Real, 6, 6>& CC) const {
        for (int p = 0; p < 6; ++p)
            for (int q = 0; q < 6; ++q) {
                const auto [i, j] = voigt_pair[p];
                const auto [k, l] = voigt_pair[q];
                CC(p, q) = a * inverse(i, j) * inverse(k, l)
                           + 0.5 * b * (inverse(i, k) * inverse(j, l) + inverse(i, l) * inverse(j, k));
            }
    }
};

}  // namespace umform
