// Yoshida and Uemori (2002): a yield surface of constant size inside a bounding surface, and stagnation of its growth.
// docs/theory, 3.13
#pragma once

#include "umform/materials/deviator.hpp"

namespace umform {

/// The centre of the bounding surface is the first back stress of Chaboche with C = m b, gamma = m; the yield stress is constant.
struct TwoSurfaces {
    double pull = 0.0;                                     // C; 0 for none
    double size = 0.0, growth = 0.0, rate = 0.0, h = 0.0;  // B, Rsat, m, h
    double yield_stress = 0.0;                             // Y

    bool active() const { return pull > 0.0; }
};

/// Von Mises' norm of a deviator.
template <class Real>
Real mises_norm(const Deviator<Real>& d) {
    return sqrt(1.5 * dot(d, d));
}

/// Where the yield surface is in the bounding one, alpha* = rho z with z = alpha*_n + (C a / Y) dp xi, and its derivatives.
/// eqs. (3.95), (3.96)
template <class Real>
struct InnerBackStress {
    Deviator<Real> alpha, by_dp;
    Real identity, rank_one;  // dalpha*/dxi = identity 1 + rank_one z (x) z
    Deviator<Real> z;

    InnerBackStress(const TwoSurfaces& law, Real grown, const Deviator<Real>& before, const Deviator<Real>& xi,
                    Real dp) {
        const Real a = law.size + grown - law.yield_stress, pull = law.pull * a * (1.0 / law.yield_stress);
        for (int i = 0; i < 5; ++i) z[i] = before[i] + pull * dp * xi[i];
        const Real norm = mises_norm(z), floor = 1e-10 * law.yield_stress;
        const Real m = select(norm > floor, norm, floor);
        const Real by_root = law.pull * sqrt(a), q = by_root * dp, root = sqrt(q * q + 4.0 * m);
        const Real u = 2.0 * m / (q + root), rho = u * u / m;
        const Real by_norm = (2.0 * u / root - rho) / m, along = 1.5 * pull * dot(z, xi) / m;
        identity = pull * dp * rho;
        rank_one = pull * dp * by_norm * 1.5 / m;
        for (int i = 0; i < 5; ++i) {
            alpha[i] = rho * z[i];
            by_dp[i] = rho * pull * xi[i] + z[i] * (by_norm * along - 2.0 * rho / root * by_root);
        }
    }
};

/// What remembers where the bounding surface has grown.
template <class Real>
struct Stagnation {
    Real grown;             // R
    Deviator<Real> centre;  // q
    Real radius;            // r

    /// Behind an increment that moves the bounding surface from `before` to `beta`. eqs. (3.97), (3.98)
    void follow(const TwoSurfaces& law, const Deviator<Real>& before, const Deviator<Real>& beta, Real dp) {
        Deviator<Real> from, to;
        for (int i = 0; i < 5; ++i) from[i] = before[i] - centre[i], to[i] = beta[i] - centre[i];
        const Real start = mises_norm(from), end = mises_norm(to);
        const Mask<Real> grows = end > radius;
        const Real outside = select(end > start, (end - radius) / select(end > start, end - start, 1.0), 1.0);
        const Real way = select(grows, law.rate * dp * select(outside < 1.0, outside, 1.0), 0.0);
        grown = (grown + way * law.growth) / (1.0 + way);
        const Real wider = select(grows, radius + law.h * (end - radius), radius);
        const Real keep = select(grows, wider / select(grows, end, 1.0), 0.0);
        for (int i = 0; i < 5; ++i) centre[i] = select(grows, beta[i] - keep * to[i], centre[i]);
        radius = wider;
    }
};

}  // namespace umform
