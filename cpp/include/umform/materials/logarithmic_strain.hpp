// The logarithmic strain h = ln(C)/2 of a Green-Lagrange strain, and what a law in h is in S and E: stress and tangent through
// the first and second divided differences of the logarithm. docs/theory, 3.9
#pragma once

#include "umform/algebra/tensor.hpp"
#include "umform/materials/remainders.hpp"

namespace umform {

template <class Real>
class LogarithmicStrain {
  public:
    /// Strain with engineering shears.
    Vec<Real, 6> h;

    /// False where C = 1 + 2E is not positive definite. eqs. (3.61)-(3.65)
    Mask<Real> set(const Vec<Real, 6>& strain) {
        Mat<Real, 3, 3> twice = from_voigt(strain, 0.5);
        for (Real& entry : twice.a) entry *= 2.0;
        Mat<Real, 3, 3> N;
        eigen_symmetric(twice, excess_, N);
        Mask<Real> positive = true;
        h = Vec<Real, 6>{};
        for (int i = 0; i < 3; ++i) {
            const auto& x = excess_[i];
            positive = positive & (x > -1.0);
            const Real s = x / (2.0 + x);
            const Real log_stretch = s * (1.0 + s * s * artanh_tail(s * s));
            first_[i] = 1.0 / (1.0 + x);
            for (int p = 0; p < 6; ++p) {
                const auto [k, l] = voigt_pair[p];
                rotation_[i][p] = N(k, i) * N(l, i);
                h[p] += (p < 3 ? 1.0 : 2.0) * log_stretch * rotation_[i][p];
            }
        }
        for (int pair = 0; pair < 3; ++pair) {
            const auto [i, j] = voigt_pair[3 + pair];
            for (int p = 0; p < 6; ++p) {
                const auto [k, l] = voigt_pair[p];
                rotation_[3 + pair][p] = N(k, i) * N(l, j) + N(l, i) * N(k, j);
            }
            const Real inverse = 1.0 / (2.0 + excess_[i] + excess_[j]);
            const Real s = (excess_[j] - excess_[i]) * inverse, tail = artanh_tail(s * s);
            const Real ratio = (1.0 + s * s * tail) * inverse;
            first_[3 + pair] = 2.0 * ratio;
            second_[pair] = {s * tail * inverse * inverse - 0.5 * first_[i] * inverse,
                             -s * tail * inverse * inverse - 0.5 * first_[j] * inverse};
        }
        third_ = of_three();
        return positive;
    }

    /// S = T : P and CC = P^T : C : P + T : L for the stress T and the tangent C = dT/dh. eqs. (3.66), (3.67)
    void pull_back(const Vec<Real, 6>& T, const Mat<Real, 6, 6>& C, bool symmetric, Vec<Real, 6>& S,
                   Mat<Real, 6, 6>& CC) const {
        // In the principal axes: shears of `rotation_` are engineering shears, so stresses take the factors 1/2 and 2.
        Vec<Real, 6> t{}, scaled;
        S = Vec<Real, 6>{};
        for (int d = 0; d < 6; ++d) {
            for (int p = 0; p < 6; ++p) t[d] += (p < 3 ? 1.0 : 2.0) * rotation_[d][p] * T[p];
            if (d >= 3) t[d] *= 0.5;
            scaled[d] = (d < 3 ? 1.0 : 0.5) * first_[d];
            const Real stress = first_[d] * t[d];
            for (int p = 0; p < 6; ++p) S[p] += stress * rotation_[d][p];
        }
        Mat<Real, 6, 6> half, K = curvature(t);
        for (int d = 0; d < 6; ++d)
            for (int q = 0; q < 6; ++q) {
                Real sum = 0.0;
                for (int p = 0; p < 6; ++p) sum += (p < 3 ? 1.0 : 2.0) * rotation_[d][p] * C(p, q);
                half(d, q) = scaled[d] * (q < 3 ? 1.0 : 2.0) * sum;
            }
        for (int d = 0; d < 6; ++d)
            for (int e = symmetric ? d : 0; e < 6; ++e) {
                Real sum = 0.0;
                for (int q = 0; q < 6; ++q) sum += half(d, q) * rotation_[e][q];
                K(d, e) += scaled[e] * sum;
                if (symmetric) K(e, d) = K(d, e);
            }
        for (int d = 0; d < 6; ++d)
            for (int q = 0; q < 6; ++q) {
                Real sum = 0.0;
                for (int e = 0; e < 6; ++e) sum += K(d, e) * rotation_[e][q];
                half(d, q) = sum;
            }
        for (int p = 0; p < 6; ++p)
            for (int q = symmetric ? p : 0; q < 6; ++q) {
                Real sum = 0.0;
                for (int d = 0; d < 6; ++d) sum += rotation_[d][p] * half(d, q);
                CC(p, q) = sum;
                if (symmetric) CC(q, p) = sum;
            }
    }

  private:
    /// T : L in the principal axes, of stress components t there. eq. (3.67)
    Mat<Real, 6, 6> curvature(const Vec<Real, 6>& t) const {
        Mat<Real, 6, 6> L;
        for (int k = 0; k < 3; ++k)
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) {
                    const int a = voigt_index[i][k], b = voigt_index[j][k];
                    const double factor = 8.0 * (i == k ? 1.0 : 0.5) * (j == k ? 1.0 : 0.5);
                    L(a, b) += factor * difference(i, k, j) * t[voigt_index[i][j]];
                }
        return L;
    }

    /// Second divided difference of ln(x)/2 over three principal values.
    Real difference(int i, int j, int k) const {
        if (i == j && j == k) return -0.25 * first_[i] * first_[i];
        if (i != j && j != k && i != k) return third_;
        const int twice = i == j || i == k ? i : j, once = i == j ? k : (i == k ? j : i);
        return second_[voigt_index[twice][once] - 3][twice == voigt_pair[voigt_index[twice][once]][0] ? 0 : 1];
    }

    /// That of all three: the quotient over the pair that is farthest apart, and where they meet a series about their mean.
    /// eq. (3.65)
    Real of_three() const {
        const auto& [x, y, z] = excess_;
        const Real xy = abs(x - y), yz = abs(y - z), xz = abs(x - z);
        const Real f_xy = 0.5 * first_[3], f_yz = 0.5 * first_[4], f_xz = 0.5 * first_[5];
        const Mask<Real> first = (xy >= yz) & (xy >= xz), last = yz >= xz;
        const Real spread = select(first, xy, select(last, yz, xz));
        const Real mean = (x + y + z) * (1.0 / 3.0), inverse = 1.0 / (1.0 + mean);
        const Mask<Real> close = spread * inverse < 0.02;
        const Vec<Real, 3> d{(x - mean) * inverse, (y - mean) * inverse, (z - mean) * inverse};
        const Real e2 = d[0] * d[1] + d[1] * d[2] + d[0] * d[2], e3 = d[0] * d[1] * d[2];
        Vec<Real, 3> power{0.0, 0.0, 1.0};  // h_(n-2), h_(n-1), h_n of the complete homogeneous polynomials
        Real series = -0.25;
        for (int n = 1; n <= 9; ++n) {
            power = {power[1], power[2], e3 * power[0] - e2 * power[1]};
            series += (n % 2 == 0 ? -0.5 : 0.5) / (n + 2) * power[2];
        }
        const Real rise = select(first, f_xz - f_yz, select(last, f_xy - f_xz, f_xy - f_yz));
        const Real run = select(first, x - y, select(last, y - z, x - z));
        return select(close, series * inverse * inverse, rise / select(close, 1.0, run));
    }

    Vec<Real, 3> excess_;                   // eigenvalues of 2E
    std::array<Vec<Real, 6>, 6> rotation_;  // engineering strain in the principal axes from that in the frame
    Vec<Real, 6> first_;                    // 2 f[i, j]
    std::array<Vec<Real, 2>, 3> second_;    // f[i, i, j] and f[i, j, j] of each pair
    Real third_;                            // f[1, 2, 3]
};

}  // namespace umform
