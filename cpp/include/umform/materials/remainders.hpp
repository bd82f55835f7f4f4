// What is left of exp and log1p behind their linear terms, to all digits: energies at small strains are made of it.
#pragma once

#include <cmath>

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

}  // namespace umform
