// Small-strain plasticity put together from a yield function, a hardening curve, back stresses and a modulus; in logarithmic space
// a law of finite strain. docs/theory, 3.12
#pragma once

#include "umform/materials/concept.hpp"
#include "umform/materials/general_return.hpp"
#include "umform/materials/quadratic_return.hpp"

namespace umform {

/// State: plastic strain (engineering shears), eqps, and with back stresses, a falling modulus or a rate the work done on them,
/// each back stress, and the overstress.
template <class Yield>
struct Metal {
    MetalParts parts;
    Yield yield;
    int state_size;

    static constexpr bool has_stages = true;
    static constexpr int surface_size = 14;  // alpha*, R, q, r
    static constexpr int state_limit = 8 + 6 * Chaboche::largest + surface_size + 1;

    Metal(MetalParts metal, Yield function)
        : parts(std::move(metal)), yield(std::move(function)),
          state_size(parts.associated_only() ? 7 : overstress_at() + (parts.rate.active() ? 1 : 0)) {}

    std::vector<Quantity> state_names() const {
        std::vector<Quantity> names{{"plastic_strain", 6}, {"eqps", 1}};
        if (!parts.associated_only()) names.push_back({"kinematic_work", 1});
        for (int k = 1; k <= parts.back_stress.count(); ++k) names.push_back({"back_stress_" + std::to_string(k), 6});
        if (two_surfaces())
            names.insert(
                names.end(),
                {{"inner_back_stress", 6}, {"bounding_growth", 1}, {"stagnation_centre", 6}, {"stagnation_radius", 1}});
        if (parts.rate.active()) names.push_back({"overstress", 1});
        return names;
    }
    void initial(double* state) const { std::fill_n(state, state_size, 0.0); }
    bool symmetric() const { return parts.modulus.fall == 0.0 && !parts.back_stress.recalls(); }

    /// T and C = dT/dh at the strain h after an increment of time. eqs. (3.73)-(3.82)
    template <class Real>
    Mask<Real> respond(const Vec<Real, 6>& h, const Real* state, Vec<Real, 6>& T, Mat<Real, 6, 6>& C, Real* trial,
                       double step) const {
        Vec<Real, 6> elastic;
        for (int p = 0; p < 6; ++p) elastic[p] = h[p] - state[p];
        const Real volume = elastic[0] + elastic[1] + elastic[2];
        const PlasticStart<Real> start = begin(elastic, state, step);
        const PlasticIncrement<Real> none(parts, start, 0.0);
        const Mask<Real> plastic = flows(start, none, step);

        std::copy_n(state, state_size, trial);
        if (parts.rate.active()) trial[overstress_at()] = 0.0;
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
        for (int p = 0; p < 6; ++p) elastic[p] = h[p] - state[p];
        const Deviator<double> e = yield.basis.components(elastic, 0.5);
        const double volume = elastic[0] + elastic[1] + elastic[2];
        const double stored = 0.5 * parts.kappa * volume * volume + parts.mu * dot(e, e);
        return {parts.modulus(state[6]).value * stored,
                plastic_work(parts.hardening, state[6]) + (parts.associated_only() ? 0.0 : state[7])};
    }

    /// Residuals, over the stresses, at the states that the return map of a point goes through; none where it does not flow.
    std::vector<double> residuals(const Voigt& h, const double* state, double step) const {
        Vec<Lanes, 6> elastic;
        for (int p = 0; p < 6; ++p) elastic[p] = h[p] - state[p];
        const std::vector<Lanes> states(state, state + state_size);
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
    /// Where the history of two surfaces begins.
    int surfaces_at() const { return 8 + 6 * parts.back_stress.count(); }
    /// Where the overstress of a rate is, the last of the history.
    int overstress_at() const { return surfaces_at() + (two_surfaces() ? surface_size : 0); }

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
        PlasticStart<Real> start{yield.basis.components(elastic, 0.5), state[6], {}};
        start.step = step;
        const auto deviator = [&](int at) {
            Vec<Real, 6> stress;
            std::copy_n(state + at, 6, stress.begin());
            return yield.basis.components(stress, 1.0);
        };
        for (int part = 0; part < parts.back_stress.count(); ++part) start.back_stress[part] = deviator(8 + 6 * part);
        if (two_surfaces()) {
            const int at = surfaces_at();
            start.inner = deviator(at);
            start.stagnation = {state[at + 6], deviator(at + 7), state[at + 13]};
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
        for (int p = 0; p < 6; ++p) trial[p] += flow.dp * strain[p];
        trial[6] += flow.dp;
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
            keep(alpha, 8 + 6 * part);
        }
        if (two_surfaces()) {  // alpha is that of the bounding surface
            const InnerBackStress<Real> inner(parts.two_surfaces, start.stagnation.grown, start.inner, flow.xi,
                                              flow.dp);
            for (int i = 0; i < 5; ++i) work += 0.5 * (inner.alpha[i] + start.inner[i]) * flow.n[i];
            Stagnation<Real> stagnation = start.stagnation;
            stagnation.follow(parts.two_surfaces, start.back_stress[0], alpha, flow.dp);
            const int place = surfaces_at();
            keep(inner.alpha, place);
            keep(stagnation.centre, place + 7);
            trial[place + 6] = select(flow.plastic, stagnation.grown, trial[place + 6]);
            trial[place + 13] = select(flow.plastic, stagnation.radius, trial[place + 13]);
        }
        if (parts.rate.active()) {  // eq. (3.125)
            Real& over = trial[overstress_at()];
            over = select(flow.plastic, at.y.value - yield_stress(parts.hardening, start.eqps + flow.dp).value, 0.0);
            work += 0.5 * (state[overstress_at()] + over);
        }
        trial[7] += lost * square + work * flow.dp;
    }
};

}  // namespace umform
