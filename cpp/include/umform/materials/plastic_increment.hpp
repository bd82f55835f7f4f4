// What is known of a plastic increment at a point once its size is: the equation that return maps solve. docs/theory, 3.12
#pragma once

#include <vector>

#include "umform/materials/back_stress.hpp"
#include "umform/materials/hardening.hpp"
#include "umform/materials/rate_factor.hpp"
#include "umform/materials/two_surfaces.hpp"

namespace umform {

/// A modulus that falls with the plastic strain: E / E0 = 1 - fall (1 - exp(-rate p)). eq. (3.76)
struct FallingModulus {
    double fall = 0.0, rate = 0.0;

    template <class Real>
    YieldStress<Real> operator()(Real eqps) const {
        if (fall == 0.0) return {1.0, 0.0};
        const Real decay = exp(-rate * eqps);
        return {1.0 - fall * (1.0 - decay), -fall * rate * decay};
    }
};

/// What all metals have beside their yield function; the moduli are those of the virgin metal.
struct MetalParts {
    double kappa, mu;
    Hardening hardening;
    Chaboche back_stress = {};
    FallingModulus modulus = {};
    TwoSurfaces two_surfaces = {};
    RateFactor rate = {};

    bool associated_only() const { return back_stress.count() == 0 && modulus.fall == 0.0 && !rate.active(); }
};

/// The last converged state of a point, and the elastic strain of its trial state as a deviator.
template <class Real>
struct PlasticStart {
    Deviator<Real> e;
    Real eqps;
    std::array<Deviator<Real>, Chaboche::largest> back_stress;
    Deviator<Real> inner{};  // of the yield surface in the bounding one
    Stagnation<Real> stagnation{0.0, {}, 0.0};
    double step = 0.0;  // of time
};

/// Yield stress with the factor of its rate. eq. (3.122) Not inlined: laws without a rate are faster so.
template <class Real>
[[gnu::noinline]] YieldStress<Real> rated(const RateFactor& rate, const YieldStress<Real>& y, Real dp, double step) {
    const YieldStress<Real> factor = rate(dp, step);
    return {y.value * factor.value, y.slope * factor.value + y.value * factor.slope};
}

/// Of the increment dp, but for two surfaces: k xi + 2 mu dp n(xi) = b with its derivatives by dp. eq. (3.77)
template <class Real>
struct PlasticIncrement {
    Real dp;
    YieldStress<Real> y, ratio;  // yield stress with the factor of its rate, modulus over that of the virgin metal
    BackStress<Real> back;
    Real k, dk, shear, dshear;  // shear: 2 mu
    Deviator<Real> b, db;

    PlasticIncrement(const MetalParts& metal, const PlasticStart<Real>& start, Real increment)
        : dp(increment), y(yield_stress(metal.hardening, start.eqps + increment)),
          ratio(metal.modulus(start.eqps + increment)),
          back(metal.back_stress, start.back_stress, start.eqps, increment) {
        if (metal.rate.active()) y = rated(metal.rate, y, dp, start.step);
        const Real inverse = 1.0 / y.value;
        k = 1.0 + back.a * inverse;
        dk = (back.da - back.a * y.slope * inverse) * inverse;
        shear = 2.0 * metal.mu * ratio.value;
        dshear = 2.0 * metal.mu * ratio.slope;
        for (int i = 0; i < 5; ++i) {
            b[i] = shear * start.e[i] - back.A[i];
            db[i] = dshear * start.e[i] - back.dA[i];
        }
    }
};

/// Where a return map puts the residual, over the stresses, at each state of the first point that its Newton method accepts; null
/// where nobody asks.
using Seen = std::vector<double>*;

/// What a return map finds.
template <class Real>
struct PlasticFlow {
    Mask<Real> plastic, found;  // found: the increment has been solved for, or there is none
    Real dp;
    Deviator<Real> s, xi, n;      // stress, the same less the back stresses, flow direction
    Mat<Real, 5, 5> tangent;      // ds/de
    Deviator<Real> dp_by_strain;  // d(dp)/de
};

}  // namespace umform
