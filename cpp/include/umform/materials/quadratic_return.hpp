// The return map of quadratic yield functions: one scalar equation inside a bracket, for strain increments of any size.
// docs/theory, 3.12
#pragma once

#include <algorithm>

#include "umform/materials/plastic_increment.hpp"
#include "umform/materials/yield/quadratic.hpp"

namespace umform {

/// xi(dp) = b / (k + 2 mu m dp / y) in the basis of the yield function, and its derivative by dp. eq. (3.78)
template <class Real>
struct QuadraticReturn : PlasticIncrement<Real> {
    Deviator<Real> inverse, xi, dxi;
    Real phi, dphi;

    QuadraticReturn(const MetalParts& metal, const QuadraticYield& yield, const PlasticStart<Real>& start, Real dp)
        : PlasticIncrement<Real>(metal, start, dp) {
        const auto& [value, slope] = this->y;
        const Real per_yield = 1.0 / value;
        const Real way = this->shear * dp * per_yield;
        const Real dway = (this->shear + this->dshear * dp - way * slope) * per_yield;
        Real square = 0.0, change = 0.0;
        for (int i = 0; i < 5; ++i) {
            inverse[i] = 1.0 / (this->k + way * yield.m[i]);
            xi[i] = this->b[i] * inverse[i];
            dxi[i] = (this->db[i] - xi[i] * (this->dk + dway * yield.m[i])) * inverse[i];
            square += yield.m[i] * xi[i] * xi[i];
            change += yield.m[i] * xi[i] * dxi[i];
        }
        phi = sqrt(square);
        dphi = change / select(phi > 0.0, phi, 1.0);
    }
};

/// Solves y/phi - 1 = 0, nearly linear in dp, where `open`, by Newton's method kept inside a bracket. eq. (3.79)
template <class Real>
PlasticFlow<Real> quadratic_return_map(const MetalParts& metal, const QuadraticYield& yield,
                                       const PlasticStart<Real>& start, Mask<Real> plastic, Seen seen = nullptr) {
    constexpr int most_iterations = 100;
    Real dp = 0.0;
    QuadraticReturn<Real> at(metal, yield, start, dp);
    const double least = metal.mu * (1.0 - metal.modulus.fall) * *std::min_element(yield.m.begin(), yield.m.end());
    Real reach = yield.value(start.e) * (2.0 * metal.mu);
    for (int part = 0; part < metal.back_stress.count(); ++part) reach += yield.value(start.back_stress[part]);
    Real low = 0.0, high = reach * (0.5 / least);
    Mask<Real> open = plastic;
    const bool rated = metal.rate.active();
    if (rated) {  // eqs. (3.123), (3.124)
        const Real over = select(plastic, at.phi / at.y.value - 1.0, 1.0), most = metal.rate.reach(over, start.step);
        dp = select(plastic, select(most < high, most, high), 0.0);
    }
    const Real tolerance = 1e-15 * select(at.phi > at.y.value, at.phi / at.y.value, 1.0);
    if (rated) at = QuadraticReturn<Real>(metal, yield, start, dp);
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        const Real phi = select(at.phi > 0.0, at.phi, 1e-300);
        const Real r = at.y.value / phi - 1.0;
        if (seen) seen->push_back(std::abs(leading(r)));
        low = select(r < 0.0, dp, low);
        high = select(r < 0.0, high, dp);
        open = open & !(abs(r) <= tolerance);
        if (!any(open)) break;
        const Real slope = (at.y.slope - at.y.value * at.dphi / phi) / phi;
        Real next = rated ? step_positive(dp, -r / slope) : dp - r / slope;
        const Real middle = rated ? sqrt(select(low > 0.0, low, 1e-3 * high) * high) : 0.5 * (low + high);
        next = select((next > low) & (next < high), next, middle);
        open = open & !((next == dp) & (r == r));  // nothing is left between the ends of the bracket
        dp = select(open, next, dp);
        at = QuadraticReturn<Real>(metal, yield, start, dp);
    }

    // eqs. (3.80), (3.81)
    PlasticFlow<Real> flow;
    flow.xi = at.xi;
    flow.plastic = plastic;
    flow.found = !open;
    flow.dp = dp;
    const Real phi = select(plastic, at.phi, 1.0);
    Deviator<Real> along;
    Real rate = at.y.slope;
    for (int i = 0; i < 5; ++i) {
        flow.n[i] = yield.m[i] * at.xi[i] / phi;
        rate -= flow.n[i] * at.dxi[i];
        flow.s[i] = at.k * at.xi[i] + at.back.A[i];
        along[i] = at.k * at.dxi[i] + at.dk * at.xi[i] + at.back.dA[i];
    }
    const Real by_strain = at.shear / select(plastic, rate, 1.0);
    for (int j = 0; j < 5; ++j) {
        flow.dp_by_strain[j] = by_strain * flow.n[j] * at.inverse[j];
        for (int i = 0; i < 5; ++i)
            flow.tangent(i, j) = along[i] * flow.dp_by_strain[j] + (i == j ? at.k * at.shear * at.inverse[i] : 0.0);
    }
    return flow;
}

}  // namespace umform
