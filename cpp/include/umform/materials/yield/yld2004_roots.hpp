// Yld2004-18p for exponents that are not even, by principal values. docs/theory, 3.11
#pragma once

#include "umform/materials/yield/yld2004.hpp"

namespace umform {

/// Principal values of a transformed deviator and what they change by: E_ik = N_i . dS . N_k.
template <class Real>
struct PrincipalStress {
    Vec<Real, 3> value;
    std::array<Deviator<Real>, 3> diagonal, mixed;  // E_ii; E_12, E_23, E_13

    PrincipalStress(const StressTransform& map, const Deviator<Real>& x) {
        Vec<Real, 6> stress;
        for (int i = 0; i < 3; ++i) {
            stress[i] = map.normal[i][0] * x[0] + map.normal[i][1] * x[1];
            stress[3 + i] = map.shear[i] * x[2 + i];
        }
        Mat<Real, 3, 3> N;
        eigen_symmetric(from_voigt(stress, 1.0), value, N);
        const auto component = [&](int i, int k) {
            Deviator<Real> d{0.0, 0.0, 0.0, 0.0, 0.0};
            for (int n = 0; n < 3; ++n) {
                const auto [p, q] = voigt_pair[3 + n];
                for (int a = 0; a < 2; ++a) d[a] += map.normal[n][a] * N(n, i) * N(n, k);
                d[2 + n] = map.shear[n] * (N(p, i) * N(q, k) + N(q, i) * N(p, k));
            }
            return d;
        };
        for (int n = 0; n < 3; ++n) {
            const auto [i, k] = voigt_pair[3 + n];
            diagonal[n] = component(n, n);
            mixed[n] = component(i, k);
        }
    }
};

class Yld2004Roots {
  public:
    DeviatorBasis basis;

    Yld2004Roots(double exponent, const std::array<double, 9>& first, const std::array<double, 9>& second)
        : exponent_(exponent), first_(StressTransform::of(basis, first)), second_(StressTransform::of(basis, second)) {}

    template <class Real>
    Real value(const Deviator<Real>& xi) const {
        Real phi;
        Deviator<Real> n;
        gradient(xi, phi, n);
        return phi;
    }

    template <class Real>
    void gradient(const Deviator<Real>& xi, Real& phi, Deviator<Real>& n) const {
        Mat<Real, 5, 5> N;
        derivatives(xi, phi, n, N);
    }

    /// phi, its gradient and its Hessian. eqs. (3.88), (3.99)
    template <class Real>
    void derivatives(const Deviator<Real>& xi, Real& phi, Deviator<Real>& n, Mat<Real, 5, 5>& N) const {
        const Real square = dot(xi, xi), size = sqrt(select(square > 0.0, square, 1.0)), inverse = 1.0 / size;
        Deviator<Real> unit;
        for (int i = 0; i < 5; ++i) unit[i] = xi[i] * inverse;
        const std::array<PrincipalStress<Real>, 2> S{PrincipalStress<Real>(first_, unit),
                                                     PrincipalStress<Real>(second_, unit)};
        // Derivatives of the sum by the principal values of both.
        Real sum = 0.0;
        std::array<Vec<Real, 3>, 2> first{}, second{};
        Mat<Real, 3, 3> cross;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const Real d = S[0].value[i] - S[1].value[j], power = pow(abs(d), exponent_ - 2.0);
                const Real slope = exponent_ * power * d, curvature = exponent_ * (exponent_ - 1.0) * power;
                sum += power * d * d;
                first[0][i] += slope;
                first[1][j] -= slope;
                second[0][i] += curvature;
                second[1][j] += curvature;
                cross(i, j) = -curvature;
            }
        const Real sigma = pow(0.25 * sum, 1.0 / exponent_), scale = sigma / (exponent_ * sum);
        Mat<Real, 5, 5> H;
        n = Deviator<Real>{0.0, 0.0, 0.0, 0.0, 0.0};
        for (int side = 0; side < 2; ++side) {
            const PrincipalStress<Real>& own = S[side];
            for (int i = 0; i < 3; ++i) {
                for (int p = 0; p < 5; ++p) n[p] += scale * first[side][i] * own.diagonal[i][p];
                add(second[side][i], own.diagonal[i], own.diagonal[i], H);
                const auto [k, l] = voigt_pair[3 + i];
                add(2.0
                        * turning(own.value[k], own.value[l], first[side][k], first[side][l],
                                  0.5 * (second[side][k] + second[side][l])),
                    own.mixed[i], own.mixed[i], H);
            }
        }
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                add(cross(i, j), S[0].diagonal[i], S[1].diagonal[j], H);
                add(cross(i, j), S[1].diagonal[j], S[0].diagonal[i], H);
            }
        const Real rank_one = (exponent_ - 1.0) / sigma;
        for (int p = 0; p < 5; ++p)
            for (int q = p; q < 5; ++q)
                N(p, q) = N(q, p) = inverse * (0.5 * scale * (H(p, q) + H(q, p)) - rank_one * n[p] * n[q]);
        phi = size * sigma;
    }

  private:
    /// (f_k - f_l) / (v_k - v_l), whose limit is the mean of the second derivatives; values are of the order one.
    template <class Real>
    static Real turning(Real v_k, Real v_l, Real f_k, Real f_l, Real limit) {
        const Mask<Real> close = abs(v_k - v_l) < 1e-5;
        return select(close, limit, (f_k - f_l) / select(close, 1.0, v_k - v_l));
    }

    template <class Real>
    static void add(Real factor, const Deviator<Real>& a, const Deviator<Real>& b, Mat<Real, 5, 5>& H) {
        for (int p = 0; p < 5; ++p)
            for (int q = 0; q < 5; ++q) H(p, q) += factor * a[p] * b[q];
    }

    double exponent_;
    StressTransform first_, second_;
};

}  // namespace umform
