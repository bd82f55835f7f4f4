// Yld2004-18p of Barlat et al. (2005) for even exponents, as a polynomial in invariants: no eigenvalues, no branches. Hosford's
// function and Yld91 are special cases. docs/theory, 3.11
#pragma once

#include "umform/materials/deviator.hpp"

namespace umform {

/// A linear map of the deviator whose plane of symmetry is the sheet. eq. (3.84)
struct StressTransform {
    std::array<Vec<double, 2>, 3> normal;  // normal components from the two of the basis
    Vec<double, 3> shear;                  // 12, 23, 13 from the shears of the basis

    /// Coefficients c12, c13, c21, c23, c31, c32 of the normal components and those of the shears 12, 23, 13.
    static StressTransform of(const DeviatorBasis& basis, const std::array<double, 9>& c) {
        const Mat3 rows{{0.0, -c[0], -c[1], -c[2], 0.0, -c[3], -c[4], -c[5], 0.0}};
        StressTransform map{};
        for (int i = 0; i < 3; ++i) {
            for (int a = 0; a < 2; ++a)
                for (int k = 0; k < 3; ++k) map.normal[i][a] += rows(i, k) * basis.plane[a][k];
            map.shear[i] = 0.5 * std::numbers::sqrt2 * c[6 + i];
        }
        return map;
    }
};

/// Invariants of a transformed deviator, their derivatives by the deviator, and the polynomials that power sums need. eq. (3.86)
template <class Real>
struct TransformedStress {
    static constexpr int most = 20;  // largest exponent

    const StressTransform& map;
    Vec<Real, 3> n, s;  // normal components; shears 12, 23, 13
    Vec<Real, 3> e;     // invariants
    std::array<Real, most + 1> p, h, g;
    std::array<Deviator<Real>, 3> de;

    TransformedStress(const StressTransform& transform, const Deviator<Real>& x, int exponent) : map(transform) {
        for (int i = 0; i < 3; ++i) {
            n[i] = map.normal[i][0] * x[0] + map.normal[i][1] * x[1];
            s[i] = map.shear[i] * x[2 + i];
        }
        const Vec<Real, 3> cofactor{n[1] * n[2] - s[1] * s[1], n[0] * n[2] - s[2] * s[2], n[0] * n[1] - s[0] * s[0]};
        const Vec<Real, 3> turned{s[1] * s[2] - n[2] * s[0], s[0] * s[2] - n[0] * s[1], s[0] * s[1] - n[1] * s[2]};
        e = {n[0] + n[1] + n[2], cofactor[0] + cofactor[1] + cofactor[2],
             n[0] * cofactor[0] + s[0] * turned[0] + s[2] * turned[2]};
        p[0] = 3.0, h[0] = g[0] = 1.0;
        for (int k = 1; k <= exponent; ++k) {
            h[k] = e[0] * h[k - 1], g[k] = e[0] * g[k - 1];
            if (k > 1) h[k] -= e[1] * h[k - 2], g[k] -= e[1] * g[k - 2];
            if (k > 2) h[k] += e[2] * h[k - 3], g[k] += e[2] * g[k - 3];
            g[k] += h[k];
        }
        p[1] = e[0];
        p[2] = e[0] * e[0] - 2.0 * e[1];
        for (int k = 3; k <= exponent; ++k) p[k] = e[0] * p[k - 1] - e[1] * p[k - 2] + e[2] * p[k - 3];
        de[0] = back({1.0, 1.0, 1.0}, {0.0, 0.0, 0.0});
        de[1] = back({n[1] + n[2], n[0] + n[2], n[0] + n[1]}, {-2.0 * s[0], -2.0 * s[1], -2.0 * s[2]});
        de[2] = back(cofactor, {2.0 * turned[0], 2.0 * turned[1], 2.0 * turned[2]});
    }

    /// Gradient by the deviator from that by the transformed components.
    Deviator<Real> back(const Vec<Real, 3>& normal, const Vec<Real, 3>& shear) const {
        Deviator<Real> d{0.0, 0.0, 0.0, 0.0, 0.0};
        for (int i = 0; i < 3; ++i) {
            for (int a = 0; a < 2; ++a) d[a] += map.normal[i][a] * normal[i];
            d[2 + i] = map.shear[i] * shear[i];
        }
        return d;
    }

    /// Adds w2 d2e_2 + w3 d2e_3.
    void add_curvature(Real w2, Real w3, Mat<Real, 5, 5>& N) const {
        for (int a = 0; a < 2; ++a)
            for (int b = 0; b < 2; ++b)
                for (int i = 0; i < 3; ++i)
                    for (int j = 0; j < 3; ++j)
                        if (i != j) N(a, b) += map.normal[i][a] * map.normal[j][b] * (w2 + w3 * n[3 - i - j]);
        for (int k = 0; k < 3; ++k) {
            const int other = (k + 2) % 3;  // the normal that shear k leaves alone: 12 -> 3, 23 -> 1, 13 -> 2
            const Real factor = -2.0 * map.shear[k];
            N(2 + k, 2 + k) += factor * map.shear[k] * (w2 + w3 * n[other]);
            for (int a = 0; a < 2; ++a) {
                const Real mixed = factor * map.normal[other][a] * w3 * s[k];
                N(a, 2 + k) += mixed;
                N(2 + k, a) += mixed;
            }
            for (int l = 0; l < 3; ++l)
                if (l != k) N(2 + k, 2 + l) -= factor * map.shear[l] * w3 * s[3 - k - l];
        }
    }
};

/// Of the exponent `Fixed`, whose loops are then known to the compiler; of any even one if that is 0.
template <int Fixed>
class Yld2004 {
  public:
    DeviatorBasis basis;

    /// Coefficients in the order of StressTransform; an even exponent.
    Yld2004(int exponent, const std::array<double, 9>& first, const std::array<double, 9>& second)
        : exponent_(exponent), first_(StressTransform::of(basis, first)), second_(StressTransform::of(basis, second)) {
        double binomial = 1.0;
        for (int k = 0; k <= exponent; ++k) {
            weight_[k] = k % 2 == 0 ? binomial : -binomial;
            binomial *= static_cast<double>(exponent - k) / (k + 1);
        }
    }

    template <class Real>
    Real value(const Deviator<Real>& xi) const {
        const Real size = length(xi);
        const Deviator<Real> unit = over(xi, size);
        const TransformedStress<Real> a(first_, unit, exponent()), b(second_, unit, exponent());
        return size * root(polynomial(a, b));
    }

    template <class Real>
    void gradient(const Deviator<Real>& xi, Real& phi, Deviator<Real>& n) const {
        Mat<Real, 5, 5> N;
        derivatives(xi, phi, n, N);
    }

    /// phi, its gradient and its Hessian. eqs. (3.85)-(3.88)
    template <class Real>
    void derivatives(const Deviator<Real>& xi, Real& phi, Deviator<Real>& n, Mat<Real, 5, 5>& N) const {
        const Real size = length(xi);
        const Deviator<Real> unit = over(xi, size);
        const TransformedStress<Real> a(first_, unit, exponent()), b(second_, unit, exponent());
        const Real sum = polynomial(a, b), sigma = root(sum);
        const Weights<Real> w = weights(a, b);
        const std::array<const Deviator<Real>*, 6> de{&a.de[0], &a.de[1], &a.de[2], &b.de[0], &b.de[1], &b.de[2]};
        const Real scale = sigma / (exponent() * sum);
        std::array<Deviator<Real>, 6> half;
        n = Deviator<Real>{0.0, 0.0, 0.0, 0.0, 0.0};
        // Shears do not change the traces, the invariants 0 and 3.
        for (int r = 0; r < 6; ++r)
            for (int i = 0; i < 5; ++i) {
                Real total = 0.0;
                for (int q = 0; q < 6; ++q)
                    if (i < 2 || q % 3 != 0) total += w.second(r, q) * (*de[q])[i];
                half[r][i] = total;
            }
        Mat<Real, 5, 5> curvature;
        for (int i = 0; i < 5; ++i) {
            for (int r = 0; r < 6; ++r)
                if (i < 2 || r % 3 != 0) n[i] += w.first[r] * (*de[r])[i];
            n[i] *= scale;
            for (int j = i; j < 5; ++j) {
                Real total = 0.0;
                for (int r = 0; r < 6; ++r)
                    if (i < 2 || r % 3 != 0) total += (*de[r])[i] * half[r][j];
                curvature(i, j) = curvature(j, i) = total;
            }
        }
        a.add_curvature(w.first[1], w.first[2], curvature);
        b.add_curvature(w.first[4], w.first[5], curvature);
        const Real inverse = 1.0 / size, rank_one = (exponent() - 1.0) / sigma;
        for (int i = 0; i < 5; ++i)
            for (int j = 0; j < 5; ++j) N(i, j) = inverse * (scale * curvature(i, j) - rank_one * n[i] * n[j]);
        phi = size * sigma;
    }

  private:
    /// Derivatives of the polynomial by the invariants of both stresses.
    template <class Real>
    struct Weights {
        Vec<Real, 6> first;
        Mat<Real, 6, 6> second;
    };

    template <class Real>
    static Real length(const Deviator<Real>& xi) {
        const Real square = dot(xi, xi);
        return sqrt(select(square > 0.0, square, 1.0));
    }
    template <class Real>
    static Deviator<Real> over(const Deviator<Real>& xi, Real size) {
        const Real inverse = 1.0 / size;
        Deviator<Real> unit;
        for (int i = 0; i < 5; ++i) unit[i] = xi[i] * inverse;
        return unit;
    }

    /// sum_ij (S'_i - S''_j)^a. eq. (3.85)
    template <class Real>
    Real polynomial(const TransformedStress<Real>& a, const TransformedStress<Real>& b) const {
        Real sum = 0.0;
        for (int k = 0; k <= exponent(); ++k) sum += weight_[k] * a.p[k] * b.p[exponent() - k];
        return sum;
    }

    /// (x/4)^(1/a), by square roots as far as they go.
    template <class Real>
    Real root(Real x) const {
        Real result = 0.25 * x;
        int left = exponent();
        for (; left % 2 == 0; left /= 2) result = sqrt(result);
        return left == 1 ? result : pow(result, 1.0 / left);
    }

    /// eq. (3.87)
    template <class Real>
    Weights<Real> weights(const TransformedStress<Real>& a, const TransformedStress<Real>& b) const {
        Weights<Real> w;
        const int n = exponent();
        for (int side = 0; side < 2; ++side) {
            const auto& own = side == 0 ? a : b;
            const auto& other = side == 0 ? b : a;
            std::array<Real, TransformedStress<Real>::most + 1> scaled;
            for (int k = 1; k <= n; ++k) scaled[k] = (weight_[k] * k) * other.p[n - k];
            for (int r = 1; r <= 3; ++r) {
                Real sum = 0.0;
                for (int k = r; k <= n; ++k) sum += scaled[k] * own.h[k - r];
                w.first[3 * side + r - 1] = r % 2 == 1 ? sum : -sum;
            }
            std::array<Real, 7> by_order;
            for (int order = 2; order <= 6; ++order) {
                Real sum = 0.0;
                for (int k = order; k <= n; ++k) sum += scaled[k] * own.g[k - order];
                by_order[order] = order % 2 == 0 ? sum : -sum;
            }
            for (int r = 0; r < 3; ++r)
                for (int q = 0; q < 3; ++q) w.second(3 * side + r, 3 * side + q) = by_order[r + q + 2];
        }
        for (int r = 1; r <= 3; ++r) {
            std::array<Real, TransformedStress<Real>::most + 1> scaled;
            for (int k = r; k < n; ++k) scaled[k] = (weight_[k] * (k * (n - k))) * a.h[k - r];
            for (int q = 1; q <= 3; ++q) {
                Real sum = 0.0;
                for (int k = r; k <= n - q; ++k) sum += scaled[k] * b.h[n - k - q];
                w.second(r - 1, q + 2) = w.second(q + 2, r - 1) = (r + q) % 2 == 0 ? sum : -sum;
            }
        }
        return w;
    }

    int exponent() const { return Fixed > 0 ? Fixed : exponent_; }

    int exponent_;
    StressTransform first_, second_;
    std::array<double, TransformedStress<double>::most + 1> weight_{};
};

}  // namespace umform
