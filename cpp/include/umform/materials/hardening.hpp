// Yield stress y(eqps), its slope and its integral: separate from the laws, so that every plastic law takes every curve.
#pragma once

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "umform/materials/remainders.hpp"

namespace umform {

template <class Real>
struct YieldStress {
    Real value, slope;
};

/// y = y0 + H e + (y_inf - y0) (1 - exp(-d e)): perfect plasticity, linear and Voce hardening are its special cases. eq. (3.30)
struct LinearVoce {
    double y0, modulus, saturation, rate;

    template <class Real>
    YieldStress<Real> operator()(Real eqps) const {
        const Real decay = exp(-rate * eqps);
        const double range = saturation - y0;
        return {y0 + modulus * eqps + range * (1.0 - decay), modulus + range * rate * decay};
    }
    double work(double eqps) const {
        const double saturating = rate * (saturation - y0) * exp_remainder(-rate * eqps);
        return y0 * eqps + (0.5 * modulus + saturating) * eqps * eqps;
    }
};

/// y = K (e0 + e)^n. eq. (3.31)
struct Swift {
    double strength, offset, exponent;

    template <class Real>
    YieldStress<Real> operator()(Real eqps) const {
        const Real value = strength * pow(offset + eqps, exponent);
        return {value, exponent * value / (offset + eqps)};
    }
    double work(double eqps) const {
        const double power = exponent + 1.0;
        return strength / power * std::pow(offset, power) * std::expm1(power * std::log1p(eqps / offset));
    }
};

/// Linear between the points of a table, constant beyond its end. eq. (3.32)
struct Tabulated {
    std::vector<double> eqps, stress;

    template <class Real>
    YieldStress<Real> operator()(Real e) const {
        return {each(e, [this](double x) { return at(x).value; }), each(e, [this](double x) { return at(x).slope; })};
    }
    double work(double e) const {
        double sum = 0.0;
        for (std::size_t k = 1; k < eqps.size() && eqps[k - 1] < e; ++k) {
            const double end = std::min(e, eqps[k]);
            sum += 0.5 * (stress[k - 1] + at(end).value) * (end - eqps[k - 1]);
        }
        return sum + stress.back() * std::max(e - eqps.back(), 0.0);
    }

  private:
    YieldStress<double> at(double e) const {
        if (e >= eqps.back()) return {stress.back(), 0.0};
        const auto after = std::upper_bound(eqps.begin() + 1, eqps.end() - 1, e) - eqps.begin();
        const double slope = (stress[after] - stress[after - 1]) / (eqps[after] - eqps[after - 1]);
        return {stress[after - 1] + slope * (e - eqps[after - 1]), slope};
    }
};

using Hardening = std::variant<LinearVoce, Swift, Tabulated>;

template <class Real>
YieldStress<Real> yield_stress(const Hardening& hardening, Real eqps) {
    return std::visit([eqps](const auto& curve) { return curve(eqps); }, hardening);
}

/// Integral of the yield stress over the plastic strain from 0: plastic work per reference volume. eqs. (3.39), (3.40)
inline double plastic_work(const Hardening& hardening, double eqps) {
    return std::visit([eqps](const auto& curve) { return curve.work(eqps); }, hardening);
}

}  // namespace umform
