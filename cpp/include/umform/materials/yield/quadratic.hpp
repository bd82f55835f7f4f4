// Yield functions whose square is quadratic in the stress: von Mises and Hill (1948). docs/theory, 3.11
#pragma once

#include "umform/materials/deviator.hpp"

namespace umform {

/// phi^2 = sum_i m_i xi_i^2 in the basis in which it is diagonal. eq. (3.72)
struct QuadraticYield {
    DeviatorBasis basis;
    Vec<double, 5> m;

    /// phi^2 = F (s22 - s33)^2 + G (s33 - s11)^2 + H (s11 - s22)^2 + 2 L s23^2 + 2 M s13^2 + 2 N s12^2. eq. (3.71)
    static QuadraticYield hill(double F, double G, double H, double L, double M, double N) {
        QuadraticYield yield;
        const std::array<Vec<double, 3>, 2> plane = yield.basis.plane;
        const auto form = [&](int a, int b) {
            const Vec<double, 3>&u = plane[a], &v = plane[b];
            return F * (u[1] - u[2]) * (v[1] - v[2]) + G * (u[2] - u[0]) * (v[2] - v[0])
                   + H * (u[0] - u[1]) * (v[0] - v[1]);
        };
        const double angle = 0.5 * std::atan2(2.0 * form(0, 1), form(0, 0) - form(1, 1));
        const double c = std::cos(angle), s = std::sin(angle);
        for (int k = 0; k < 3; ++k) {
            yield.basis.plane[0][k] = c * plane[0][k] + s * plane[1][k];
            yield.basis.plane[1][k] = c * plane[1][k] - s * plane[0][k];
        }
        yield.m = {c * c * form(0, 0) + 2.0 * c * s * form(0, 1) + s * s * form(1, 1),
                   s * s * form(0, 0) - 2.0 * c * s * form(0, 1) + c * c * form(1, 1), N, L, M};
        return yield;
    }

    template <class Real>
    Real value(const Deviator<Real>& xi) const {
        Real square = 0.0;
        for (int i = 0; i < 5; ++i) square += m[i] * xi[i] * xi[i];
        return sqrt(square);
    }

    template <class Real>
    void derivatives(const Deviator<Real>& xi, Real& phi, Deviator<Real>& n, Mat<Real, 5, 5>& N) const {
        gradient(xi, phi, n);
        const Real inverse = 1.0 / phi;
        for (int i = 0; i < 5; ++i)
            for (int j = 0; j < 5; ++j) N(i, j) = inverse * ((i == j ? m[i] : 0.0) - n[i] * n[j]);
    }

    template <class Real>
    void gradient(const Deviator<Real>& xi, Real& phi, Deviator<Real>& n) const {
        phi = value(xi);
        for (int i = 0; i < 5; ++i) n[i] = m[i] * xi[i] / phi;
    }
};

}  // namespace umform
