// The yield stress rises with the rate of plastic flow: a factor over the time of the increment. docs/theory, 3.14
#pragma once

#include "umform/materials/hardening.hpp"

namespace umform {

/// Of the plastic strain rate dp / step: Cowper and Symonds 1 + (rate / reference)^power, Johnson and Cook
/// 1 + C ln(rate / reference), one below the reference. eqs. (3.120), (3.121)
struct RateFactor {
    enum class Kind : char { None, CowperSymonds, JohnsonCook };
    Kind kind = Kind::None;
    double reference = 0.0;  // strain rate
    double strength = 0.0;   // power, or C

    bool active() const { return kind != Kind::None; }

    /// With its derivative by dp, which is infinite at dp = 0: it is taken beside it.
    template <class Real>
    YieldStress<Real> operator()(Real dp, double step) const {
        constexpr double beside_zero = 1e-300;
        const Real d = select(dp > beside_zero, dp, beside_zero), ratio = d / (reference * step);
        if (kind == Kind::CowperSymonds) {
            const Real over = pow(ratio, strength);
            return {1.0 + over, strength * over / d};
        }
        const Real beyond = select(ratio > 1.0, ratio, 1.0);
        const Real logarithm = each(beyond, [](double value) { return std::log(value); });
        return {1.0 + strength * logarithm, select(ratio > 1.0, strength / d, 0.0)};
    }

    /// The increment at which it is 1 + over: an upper bound of one that starts so far over the yield stress. eq. (3.123)
    template <class Real>
    Real reach(Real over, double step) const {
        const Real ratio = kind == Kind::CowperSymonds ? pow(over, 1.0 / strength) : exp(over * (1.0 / strength));
        return reference * step * ratio;
    }
};

/// Newton's step along the logarithm of a positive number where it falls, so that it stays positive. eq. (3.124)
template <class Real>
[[gnu::noinline]] Real step_positive(Real value, Real change) {
    return select(change < 0.0, value * exp(select(change < 0.0, change / value, 0.0)), value + change);
}

}  // namespace umform
