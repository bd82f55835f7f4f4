// Hooke's law in logarithmic strains without an eigenproblem, for the elastic strains of metals: S and CC from the invariants
// of D = Cp^-1 C - 1 by series that end at round-off. docs/theory, 3.8
#pragma once

#include <algorithm>

#include "umform/algebra/tensor.hpp"
#include "umform/materials/remainders.hpp"

namespace umform {

template <class Real>
struct LogarithmicSeries {
    using Tensor = Mat<Real, 3, 3>;

    /// Terms of the series, which give all digits where D : D^T is below the square of `largest`. eq. (3.44)
    static constexpr int terms = 11;
    static constexpr double largest = 0.015;

    Mask<Real> small;
    Real trace;   // tr eps
    Real square;  // eps : eps

    /// Invariants and energies at the strain for the plastic metric P = Cp^-1. eqs. (3.41), (3.43)
    LogarithmicSeries(const Vec<Real, 6>& strain, const Vec<Real, 6>& Cp_inv) : P_(from_voigt(Cp_inv, 1.0)) {
        const Tensor E = from_voigt(strain, 0.5), PE = product(P_, E);
        Tensor D = P_;
        for (int i = 0; i < 3; ++i) D(i, i) -= 1.0;
        for (int i = 0; i < 9; ++i) D.a[i] += 2.0 * PE.a[i];
        P1_ = product(D, P_);
        P2_ = product(D, P1_);
        C_ = E;
        for (int i = 0; i < 9; ++i) C_.a[i] *= 2.0;
        for (int i = 0; i < 3; ++i) C_(i, i) += 1.0;

        Real squares = 0.0;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) squares += D(i, j) * D(j, i);
        e_ = {D(0, 0) + D(1, 1) + D(2, 2), 0.0, det(D)};
        e_[1] = 0.5 * (e_[0] * e_[0] - squares);
        small = squares < largest * largest;
        const Real det_minus_one = e_[0] + e_[1] + e_[2];
        trace = 0.5 * det_minus_one * log1p_ratio(det_minus_one);
        Vec<Real, 3> power{3.0, e_[0], squares};  // tr D^(k-2), tr D^(k-1), tr D^k
        square = 0.25 * squares;
        for (int k = 3; k <= terms + 1; ++k) {
            power = {power[1], power[2], e_[0] * power[2] - e_[1] * power[1] + e_[2] * power[0]};
            square += weight(k) / (2.0 * k) * power[2];
        }
    }

    /// S = 2 dW/dC and CC = 4 d^2 W/dC^2 for W = lambda/2 (tr eps)^2 + mu eps : eps. eqs. (3.45), (3.46)
    void respond(double lambda, double mu, Vec<Real, 6>& S, Mat<Real, 6, 6>& CC) const {
        // a_j = (-1)^(j-1) sum_k v_k h_(k-j) and b_m = (-1)^m sum_k v_k g_(k-m). eq. (3.44)
        std::array<Real, terms> h, g;
        for (int n = 0; n < terms; ++n) {
            h[n] = n == 0 ? 1.0 : e_[0] * h[n - 1];
            g[n] = n == 0 ? 1.0 : e_[0] * g[n - 1];
            if (n > 1) h[n] -= e_[1] * h[n - 2], g[n] -= e_[1] * g[n - 2];
            if (n > 2) h[n] += e_[2] * h[n - 3], g[n] += e_[2] * g[n - 3];
            if (n > 0) g[n] += h[n];
        }
        const auto sum = [](const std::array<Real, terms>& series, int shift) {
            Real total = 0.0;
            for (int k = terms; k >= std::max(2, shift); --k)
                if (k - shift < terms) total += 0.5 * weight(k) * series[k - shift];
            return total;
        };
        const Real a1 = sum(h, 1), a2 = -sum(h, 2), a3 = sum(h, 3);
        const Real b2 = sum(g, 2), b3 = -sum(g, 3), b4 = sum(g, 4), b5 = -sum(g, 5), b6 = sum(g, 6);

        // In the basis P, D P, D^2 P: de_j/dC, and what is second order in dC.
        const Real I = e_[0], II = e_[1], zero = 0.0;
        const std::array<Vec<Real, 3>, 3> G{{{1.0, zero, zero}, {I, -1.0, zero}, {II, -I, 1.0}}};
        const Mat<Real, 3, 3> b{{b2, b3, b4, b3, b4, b5, b4, b5, b6}};
        Mat<Real, 3, 3> m{};
        for (int r = 0; r < 3; ++r)
            for (int s = 0; s < 3; ++s)
                for (int i = r; i < 3; ++i)
                    for (int j = s; j < 3; ++j) m(r, s) += b(i, j) * G[i][r] * G[j][s];
        const Real c = a2 + I * a3;
        m(0, 0) += c;
        m(0, 1) -= a3;
        m(1, 0) -= a3;
        const Vec<Real, 3> stress{a1 + I * a2 + II * a3, -(a2 + I * a3), a3};

        const Tensor C_inv = inverse(C_);
        std::array<Vec<Real, 6>, 4> left, right;
        for (int p = 0; p < 6; ++p) {
            const auto [i, j] = voigt_pair[p];
            left[0][p] = P_(i, j), left[1][p] = P1_(i, j), left[2][p] = P2_(i, j), left[3][p] = C_inv(i, j);
            for (int r = 0; r < 3; ++r)
                right[r][p] = 4.0 * mu * (m(r, 0) * left[0][p] + m(r, 1) * left[1][p] + m(r, 2) * left[2][p]);
            right[3][p] = lambda * left[3][p];
            S[p] = lambda * trace * left[3][p]
                   + 2.0 * mu * (stress[0] * left[0][p] + stress[1] * left[1][p] + stress[2] * left[2][p]);
        }
        // The products (A dC B + B dC A) / 2: P with N = -c P + 2 a_3 D P, and C^-1 with itself.
        Tensor N;
        for (int i = 0; i < 9; ++i) N.a[i] = mu * (2.0 * a3 * P1_.a[i] - c * P_.a[i]);
        const Real volumetric = -lambda * trace;
        for (int p = 0; p < 6; ++p)
            for (int q = p; q < 6; ++q) {
                const auto [i, j] = voigt_pair[p];
                const auto [k, l] = voigt_pair[q];
                Real entry = P_(i, k) * N(j, l) + P_(i, l) * N(j, k) + N(i, k) * P_(j, l) + N(i, l) * P_(j, k);
                entry += volumetric * (C_inv(i, k) * C_inv(j, l) + C_inv(i, l) * C_inv(j, k));
                for (int dyad = 0; dyad < 4; ++dyad) entry += left[dyad][p] * right[dyad][q];
                CC(p, q) = CC(q, p) = entry;
            }
    }

  private:
    /// v_k = (-1)^k (1 + 1/2 + ... + 1/(k-1)).
    static constexpr double weight(int k) {
        double harmonic = 0.0;
        for (int i = 1; i < k; ++i) harmonic += 1.0 / i;
        return k % 2 == 0 ? harmonic : -harmonic;
    }

    Tensor P_, P1_, P2_, C_;  // P, D P, D^2 P, C
    Vec<Real, 3> e_;          // invariants of D
};

}  // namespace umform
