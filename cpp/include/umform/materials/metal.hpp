// Small-strain plasticity put together from a yield function, a hardening curve, back stresses and a modulus; in logarithmic space
// a law of finite strain. docs/theory, 3.12
#pragma once

#include "umform/materials/concept.hpp"
#include "umform/materials/general_return.hpp"
#include "umform/materials/metal_history.hpp"
#include "umform/materials/quadratic_return.hpp"

namespace umform {

/// Plastic strains have engineering shears.
template <class Yield>
struct Metal {
    MetalParts parts;
    Yield yield;
    MetalHistory table;

    static constexpr bool has_stages = true;
    static constexpr int state_limit = MetalHistory::largest();

    Metal(MetalParts metal, Yield function) : parts(std::move(metal)), yield(std::move(function)), table(parts) {}

    void initial(double* state) const { std::fill_n(state, table.size(), 0.0); }
    bool symmetric() const { return parts.modulus.fall == 0.0 && !parts.back_stress.recalls(); }

    /// T and C = dT/dh at the strain h after an increment of time. eqs. (3.73)-(3.82)
    template <class Real>
    Mask<Real> respond(const Vec<Real, 6>& h, const Real* state, Vec<Real, 6>& T, Mat<Real, 6, 6>& C, Real* trial,
                       double step) const {
        Vec<Real, 6> elastic;
        for (int p = 0; p < 6; ++p) elastic[p] = h[p] - state[MetalHistory::PlasticStrain + p];
        const Real volume = elastic[0] + elastic[1] + elastic[2];
        const PlasticStart<Real> start = begin(elastic, state, step);
        const PlasticIncrement<Real> none(parts, start, 0.0);
        const Mask<Real> plastic = flows(start, none, step);

        std::copy_n(state, table.size(), trial);
        if (parts.rate.active()) trial[table.overstress] = 0.0;
        PlasticFlow<Real> flow;
        Mask<Real> found = true;
        Vec<Real, 6> coupling{};
        YieldStress<Real> ratio = none.ratio;
        if (any(plastic)) {
            flow = return_map(start, plastic);
            found = flow.found;
            keep_elastic(start, none, flow);
            if (parts.modulus.fall != 0.0) {
                ratio = parts.modulus(start.eqps + flow.dp);
                coupling = yield.basis.tensor(flow.dp_by_strain, 1.0);
            }
            commit(start, none.ratio, volume, flow, state, trial);
        } else {
            flow.tangent = {};
            for (int i = 0; i < 5; ++i) {
                flow.s[i] = none.shear * start.e[i];
                flow.tangent(i, i) = none.shear;
            }
        }
        T = yield.basis.tensor(flow.s, 1.0);
        C = yield.basis.tangent(flow.tangent);
        const Real bulk = parts.kappa * ratio.value, fall = parts.kappa * ratio.slope * volume;
        for (int i = 0; i < 3; ++i) {
            T[i] += bulk * volume;
            for (int q = 0; q < 6; ++q) C(i, q) += (q < 3 ? bulk : Real(0.0)) + fall * coupling[q];
        }
        return found;
    }

    /// eqs. (3.38), (3.39) and (3.83)
    Energy energy(const Voigt& h, const double* state) const {
        Voigt elastic;
        for (int p = 0; p < 6; ++p) elastic[p] = h[p] - state[MetalHistory::PlasticStrain + p];
        const Deviator<double> e = yield.basis.components(elastic, 0.5);
        const double volume = elastic[0] + elastic[1] + elastic[2];
        const double stored = 0.5 * parts.kappa * volume * volume + parts.mu * dot(e, e);
        return {parts.modulus(state[MetalHistory::Eqps]).value * stored,
                plastic_work(parts.hardening, state[MetalHistory::Eqps])
                    + (parts.associated_only() ? 0.0 : state[table.kinematic_work])};
    }

    /// Residuals, over the stresses, at the states that the return map of a point goes through; none where it does not flow.
    std::vector<double> residuals(const Voigt& h, const double* state, double step) const {
        Vec<Lanes, 6> elastic;
        for (int p = 0; p < 6; ++p) elastic[p] = h[p] - state[MetalHistory::PlasticStrain + p];
        const std::vector<Lanes> states(state, state + table.size());
        const PlasticStart<Lanes> start = begin(elastic, states.data(), step);
        LaneMask one = false;
        one.set(0, true);
        one = one & flows(start, PlasticIncrement<Lanes>(parts, start, 0.0), step);
        std::vector<double> found;
        if (any(one)) return_map(start, one, &found);
        return found;
    }

  private:
    /// As in J2.
    static constexpr double plastic_margin = 1e-10;

    bool two_surfaces() const { return parts.two_surfaces.active(); }

    /// Whether the trial state lies outside of the yield surface; a metal with a rate needs time to flow.
    template <class Real>
    Mask<Real> flows(const PlasticStart<Real>& start, const PlasticIncrement<Real>& none, double step) const {
        Deviator<Real> xi;
        for (int i = 0; i < 5; ++i) xi[i] = none.b[i] - start.inner[i];
        if (parts.rate.active() && !(step > 0.0)) return false;
        return !(yield.value(xi) <= none.y.value * (1.0 + plastic_margin));
    }

    template <class Real>
    PlasticFlow<Real> return_map(const PlasticStart<Real>& start, Mask<Real> plastic, Seen seen = nullptr) const {
        if constexpr (std::is_same_v<Yield, QuadraticYield>)
            if (!two_surfaces()) return quadratic_return_map(parts, yield, start, plastic, seen);
        return general_return_map(parts, yield, start, plastic, seen);
    }

    template <class Real>
    PlasticStart<Real> begin(const Vec<Real, 6>& elastic, const Real* state, double step) const {
        PlasticStart<Real> start{yield.basis.components(elastic, 0.5), state[MetalHistory::Eqps], {}};
        start.step = step;
        const auto deviator = [&](int at) {
            Vec<Real, 6> stress;
            std::copy_n(state + at, 6, stress.begin());
            return yield.basis.components(stress, 1.0);
        };
        for (int part = 0; part < parts.back_stress.count(); ++part)
            start.back_stress[part] = deviator(table.back_stress[part]);
        if (two_surfaces()) {
            start.inner = deviator(table.inner_back_stress);
            start.stagnation = {state[table.bounding_growth], deviator(table.stagnation_centre),
                                state[table.stagnation_radius]};
        }
        return start;
    }

    /// Lanes that do not flow among others that do.
    template <class Real>
    static void keep_elastic(const PlasticStart<Real>& start, const PlasticIncrement<Real>& none,
                             PlasticFlow<Real>& flow) {
        if (all(flow.plastic)) return;
        flow.dp = select(flow.plastic, flow.dp, 0.0);
        for (int i = 0; i < 5; ++i) {
            flow.s[i] = select(flow.plastic, flow.s[i], none.shear * start.e[i]);
            flow.n[i] = select(flow.plastic, flow.n[i], 0.0);
            flow.dp_by_strain[i] = select(flow.plastic, flow.dp_by_strain[i], 0.0);
            for (int j = 0; j < 5; ++j)
                flow.tangent(i, j) = select(flow.plastic, flow.tangent(i, j), i == j ? none.shear : Real(0.0));
        }
    }

    /// The new history. Back stresses move along xi, which is s less their sum. eqs. (3.74), (3.82), (3.83)
    template <class Real>
    void commit(const PlasticStart<Real>& start, const YieldStress<Real>& ratio_before, Real volume,
                const PlasticFlow<Real>& flow, const Real* state, Real* trial) const {
        const Vec<Real, 6> strain = yield.basis.tensor(flow.n, 0.5);
        for (int p = 0; p < 6; ++p) trial[MetalHistory::PlasticStrain + p] += flow.dp * strain[p];
        trial[MetalHistory::Eqps] += flow.dp;
        if (parts.associated_only()) return;
        const PlasticIncrement<Real> at(parts, start, flow.dp);
        const Real lost = 0.5 * (ratio_before.value - at.ratio.value);
        const Real share = parts.back_stress.share(start.eqps + flow.dp).value;
        const auto keep = [&](const Deviator<Real>& d, int place) {
            const Vec<Real, 6> stress = yield.basis.tensor(d, 1.0);
            for (int p = 0; p < 6; ++p) trial[place + p] = select(flow.plastic, stress[p], trial[place + p]);
        };
        Real square = parts.kappa * volume * volume, work = 0.0;
        for (int i = 0; i < 5; ++i) {
            const Real elastic = start.e[i] - flow.dp * flow.n[i];
            square += 2.0 * parts.mu * elastic * elastic;
        }
        Deviator<Real> alpha{};
        for (int part = 0; part < parts.back_stress.count(); ++part) {
            const auto [modulus, recall] = parts.back_stress.parts[part];
            const Real w = 1.0 / (1.0 + recall * flow.dp), pull = modulus * share * w * flow.dp / at.y.value;
            for (int i = 0; i < 5; ++i) {
                alpha[i] = w * start.back_stress[part][i] + pull * flow.xi[i];
                work += 0.5 * (alpha[i] + start.back_stress[part][i]) * flow.n[i];
            }
            keep(alpha, table.back_stress[part]);
        }
        if (two_surfaces()) {  // alpha is that of the bounding surface
            const InnerBackStress<Real> inner(parts.two_surfaces, start.stagnation.grown, start.inner, flow.xi,
                                              flow.dp);
            for (int i = 0; i < 5; ++i) work += 0.5 * (inner.alpha[i] + start.inner[i]) * flow.n[i];
            Stagnation<Real> stagnation = start.stagnation;
            stagnation.follow(parts.two_surfaces, start.back_stress[0], alpha, flow.dp);
            keep(inner.alpha, table.inner_back_stress);
            keep(stagnation.centre, table.stagnation_centre);
            Real &grown = trial[table.bounding_growth], &radius = trial[table.stagnation_radius];
            grown = select(flow.plastic, stagnation.grown, grown);
            radius = select(flow.plastic, stagnation.radius, radius);
        }
        if (parts.rate.active()) {  // eq. (3.125)
            Real& over = trial[table.overstress];
            over = select(flow.plastic, at.y.value - yield_stress(parts.hardening, start.eqps + flow.dp).value, 0.0);
            work += 0.5 * (state[table.overstress] + over);
        }
        trial[table.kinematic_work] += lost * square + work * flow.dp;
    }
};

}  // namespace umform
