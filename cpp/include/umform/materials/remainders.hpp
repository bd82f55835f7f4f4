// Remainders of exp and log1p after their first terms, accurate for small strains; and both functions for lanes.
#pragma once

#include <cmath>

#include "umform/algebra/lanes.hpp"

namespace umform {

/// (exp(z) - 1 - z) / z^2, which is 1/2 at z = 0. eq. (3.37)
inline double exp_remainder(double z) {
    if (std::abs(z) > 0.5) return (std::expm1(z) - z) / (z * z);
    double sum = 0.0;
    for (int k = 15; k >= 2; --k) sum = (1.0 + z * sum) / k;  // 1/2! + z/3! + z^2/4! + ...
    return sum;
}

/// x - log(1 + x) for x > -1, of the order x^2/2. With s = x/(2 + x), log(1 + x) = 2 artanh s. eq. (3.36)
inline double log_remainder(double x) {
    const double s = x / (2.0 + x);
    if (std::abs(s) > 0.25) return x - std::log1p(x);
    const double square = s * s;
    double sum = 0.0;
    for (int k = 27; k >= 3; k -= 2) sum = 1.0 / k + square * sum;  // 1/3 + s^2/5 + s^4/7 + ...
    return s * (x - 2.0 * square * sum);
}

/// log(1 + x) / x for x > -1, which is 1 at x = 0: for |x| < 1/16, more than the elastic strains of metals, by its
/// series. eq. (3.42)
template <class Real>
Real log1p_ratio(Real x) {
    const Real s = x / (2.0 + x), square = s * s;
    Real sum = 0.0;
    for (int k = 11; k >= 3; k -= 2) sum = square * (1.0 / k + sum);  // s^2/3 + s^4/5 + ...
    const Real series = (1.0 - s) * (1.0 + sum);                      // 2 / (2 + x) = 1 - s
    const Mask<Real> small = abs(x) < 0.0625;
    if (all(small)) return series;
    return select(small, series, each(x, [](double value) { return std::log1p(value) / value; }));
}

/// (artanh(s)/s - 1) / s^2 of the square of s, which is 1/3 at 0: a ratio of logarithms without a difference. eq. (3.63)
template <class Real>
Real artanh_tail(Real square) {
    Real sum = 1.0 / 37.0;
    for (int k = 35; k >= 3; k -= 2) sum = 1.0 / k + square * sum;
    const Mask<Real> near = square <= 1.0 / 9.0;
    if (all(near)) return sum;
    return select(near, sum, each(square, [](double q) {
                      const double s = std::sqrt(q);
                      return (std::atanh(s) / s - 1.0) / q;
                  }));
}

using std::exp;
using std::expm1;
/// exp(x) - 1 of every lane: for |x| < 1/16 by its series, whose remainder is below 1e-18, else by the library.
inline Lanes expm1(Lanes x) {
    Lanes sum = 1.0;
    for (int k = 10; k >= 2; --k) sum = 1.0 + x * sum * (1.0 / k);
    const Lanes series = x * sum;
    const LaneMask small = abs(x) < 0.0625;
    if (all(small)) return series;
    return select(small, series, each(x, [](double value) { return std::expm1(value); }));
}
inline Lanes exp(Lanes x) {
    const LaneMask small = abs(x) < 0.0625;
    const Lanes series = 1.0 + expm1(select(small, x, 0.0));
    if (all(small)) return series;
    return select(small, series, each(x, [](double value) { return std::exp(value); }));
}

}  // namespace umform
