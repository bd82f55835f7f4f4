// Deviators as five numbers in an orthonormal basis: isotropic elasticity is then 2 mu times the identity, and what is quadratic
// in the deviator can be made diagonal. docs/theory, 3.10
#pragma once

#include <numbers>

#include "umform/algebra/tensor.hpp"

namespace umform {

template <class Real>
using Deviator = Vec<Real, 5>;

/// Two directions of normal components, orthonormal and normal to (1, 1, 1), and the shears times sqrt(2). eq. (3.70)
struct DeviatorBasis {
    std::array<Vec<double, 3>, 2> plane{
        {{0.5 * std::numbers::sqrt2, -0.5 * std::numbers::sqrt2, 0.0},
         {-0.5 * std::numbers::sqrt2 * std::numbers::inv_sqrt3, -0.5 * std::numbers::sqrt2 * std::numbers::inv_sqrt3,
          std::numbers::sqrt2 * std::numbers::inv_sqrt3}}};

    /// `shear` is 1 for stresses, 1/2 for engineering strains.
    template <class Real>
    Deviator<Real> components(const Vec<Real, 6>& tensor, double shear) const {
        Deviator<Real> d;
        for (int a = 0; a < 2; ++a) d[a] = plane[a][0] * tensor[0] + plane[a][1] * tensor[1] + plane[a][2] * tensor[2];
        for (int k = 0; k < 3; ++k) d[2 + k] = shear * std::numbers::sqrt2 * tensor[3 + k];
        return d;
    }

    /// The tensor of given components; `shear` as above.
    template <class Real>
    Vec<Real, 6> tensor(const Deviator<Real>& d, double shear) const {
        Vec<Real, 6> t;
        for (int k = 0; k < 3; ++k) {
            t[k] = plane[0][k] * d[0] + plane[1][k] * d[1];
            t[3 + k] = 0.5 * std::numbers::sqrt2 / shear * d[2 + k];
        }
        return t;
    }

    /// The part of a tangent in Voigt order that is D between deviators of strain and stress.
    template <class Real>
    Mat<Real, 6, 6> tangent(const Mat<Real, 5, 5>& D) const {
        Mat<Real, 5, 6> half;
        for (int i = 0; i < 5; ++i) {
            const Vec<Real, 6> row = tensor(Deviator<Real>{D(i, 0), D(i, 1), D(i, 2), D(i, 3), D(i, 4)}, 1.0);
            for (int q = 0; q < 6; ++q) half(i, q) = row[q];
        }
        Mat<Real, 6, 6> C;
        for (int q = 0; q < 6; ++q) {
            const Vec<Real, 6> column =
                tensor(Deviator<Real>{half(0, q), half(1, q), half(2, q), half(3, q), half(4, q)}, 1.0);
            for (int p = 0; p < 6; ++p) C(p, q) = column[p];
        }
        return C;
    }
};

}  // namespace umform
