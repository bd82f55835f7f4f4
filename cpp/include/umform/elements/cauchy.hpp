// Cauchy stress of a point from its second Piola-Kirchhoff stress, and both in global axes.
#pragma once

#include "umform/algebra/tensor.hpp"

namespace umform {

/// V f(values) V^T for the square root or its inverse, of a tensor 1 + A with the eigenvalues and eigenvectors of A.
template <class Real>
Mat<Real, 3, 3> root_of(const Mat<Real, 3, 3>& A, bool inverse, Real& determinant) {
    Vec<Real, 3> values;
    Mat<Real, 3, 3> V, root;
    eigen_symmetric(A, values, V);
    determinant = 1.0;
    for (int k = 0; k < 3; ++k) {
        const Real stretch = sqrt(1.0 + values[k]), factor = inverse ? 1.0 / stretch : stretch;
        determinant = determinant * factor;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) root(i, j) += factor * V(i, k) * V(j, k);
    }
    return root;
}

/// A T A^T.
template <class Real>
Mat<Real, 3, 3> turned(const Mat<Real, 3, 3>& A, const Mat<Real, 3, 3>& T) {
    const Mat<Real, 3, 3> AT = product(A, T);
    Mat<Real, 3, 3> both;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) both(i, j) = AT(i, 0) * A(j, 0) + AT(i, 1) * A(j, 1) + AT(i, 2) * A(j, 2);
    return both;
}

template <class Real>
Vec<Real, 6> to_voigt(const Mat<Real, 3, 3>& T) {
    Vec<Real, 6> voigt;
    for (int p = 0; p < 6; ++p) voigt[p] = T(voigt_pair[p][0], voigt_pair[p][1]);
    return voigt;
}

/// Equivalent stress of von Mises.
template <class Real>
Real von_mises(const Vec<Real, 6>& stress) {
    const Real a = stress[0] - stress[1], b = stress[1] - stress[2], c = stress[2] - stress[0];
    return sqrt(0.5 * (a * a + b * b + c * c)
                + 3.0 * (stress[3] * stress[3] + stress[4] * stress[4] + stress[5] * stress[5]));
}

template <class Real>
struct Stresses {
    Vec<Real, 6> cauchy_local, cauchy, pk2;  // but for the first in global axes
};

/// Cauchy stress U S U / det U with U^2 = 1 + 2E in the local frame, whose axes are the rows of `frame`; the same turned with the
/// rotation of the polar decomposition of F; and S in global axes. eqs. (3.33), (3.34)
template <class Real>
Stresses<Real> stresses(const Vec<Real, 6>& E, const Vec<Real, 6>& S, const Mat<Real, 3, 3>& frame,
                        const Mat<Real, 3, 3>& F) {
    Real volume, unused;
    Mat<Real, 3, 3> twice = from_voigt(E, 0.5);
    for (Real& entry : twice.a) entry *= 2.0;
    const Mat<Real, 3, 3> U = root_of(twice, false, volume);
    Mat<Real, 3, 3> cauchy = turned(U, from_voigt(S, 1.0));
    for (Real& entry : cauchy.a) entry *= 1.0 / volume;

    Mat<Real, 3, 3> excess;  // F^T F - 1
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            excess(i, j) = F(0, i) * F(0, j) + F(1, i) * F(1, j) + F(2, i) * F(2, j) - (i == j ? 1.0 : 0.0);
    const Mat<Real, 3, 3> R = product(F, root_of(excess, true, unused));
    Mat<Real, 3, 3> axes;  // frame^T
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) axes(i, j) = frame(j, i);
    return {to_voigt(cauchy), to_voigt(turned(product(R, axes), cauchy)), to_voigt(turned(axes, from_voigt(S, 1.0)))};
}

}  // namespace umform
