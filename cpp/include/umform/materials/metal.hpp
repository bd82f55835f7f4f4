// Small-strain plasticity put together from a yield function, a hardening curve, back stresses and a modulus; in logarithmic space
// a law of finite strain. docs/theory, 3.12
#pragma once

#include "umform/materials/concept.hpp"
#include "umform/materials/general_return.hpp"
#include "umform/materials/quadratic_return.hpp"

namespace umform {

/// State: plastic strain (engineering shears), eqps, and with back stresses or a falling modulus the work done on both and
/// each back stress.
template <class Yield>
struct Metal {
    MetalParts parts;
    Yield yield;
    int state_size;

    static constexpr int state_limit = 8 + 6 * Chaboche::largest;

    Metal(MetalParts metal, Yield function)
        : parts(std::move(metal)), yield(std::move(function)),
          state_size(parts.associated_only() ? 7 : 8 + 6 * parts.back_stress.count()) {}

    std::vector<Quantity> state_names() const {
        std::vector<Quantity> names{{"plastic_strain", 6}, {"eqps", 1}};
        if (!parts.associated_only()) names.push_back({"kinematic_work", 1});
        for (int k = 1; k <= parts.back_stress.count(); ++k) names.push_back({"back_stress_" + std::to_string(k), 6});
        return names;
    }
    void initial(double* state) const { std::fill_n(state, state_size, 0.0); }
    bool symmetric() const { return parts.modulus.fall == 0.0 && !parts.back_stress.recalls(); }

    /// T and C = dT/dh at the strain h. eqs. (3.73)-(3.82)
    template <class Real>
    Mask<Real> respond(const Vec<Real, 6>& h, const Real* state, Vec<Real, 6>& T, Mat<Real, 6, 6>& C,
                       Real* trial) const {
        Vec<Real, 6> elastic;
        for (int p = 0; p < 6; ++p) elastic[p] = h[p] - state[p];
        const Real volume = elastic[0] + elastic[1] + elastic[2];
        const PlasticStart<Real> start = begin(elastic, state);
        const PlasticIncrement<Real> none(parts, start, 0.0);
        Deviator<Real> xi = none.b;
        const Mask<Real> plastic = !(yield.value(xi) <= none.y.value * (1.0 + plastic_margin));

        std::copy_n(state, state_size, trial);
        PlasticFlow<Real> flow;
        Mask<Real> found = true;
        Vec<Real, 6> coupling{};
        YieldStress<Real> ratio = none.ratio;
        if (any(plastic)) {
            flow = return_map(parts, yield, start, plastic);
            found = flow.found;
            keep_elastic(start, none, flow);
            if (parts.modulus.fall != 0.0) {
                ratio = parts.modulus(start.eqps + flow.dp);
                coupling = yield.basis.tensor(flow.dp_by_strain, 1.0);
            }
            commit(start, none.ratio, volume, flow, trial);
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

  private:
    /// As in J2.
    static constexpr double plastic_margin = 1e-10;

    template <class Real>
    PlasticStart<Real> begin(const Vec<Real, 6>& elastic, const Real* state) const {
        PlasticStart<Real> start{yield.basis.components(elastic, 0.5), state[6], {}};
        for (int part = 0; part < parts.back_stress.count(); ++part) {
            Vec<Real, 6> stress;
            std::copy_n(state + 8 + 6 * part, 6, stress.begin());
            start.back_stress[part] = yield.basis.components(stress, 1.0);
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
                const PlasticFlow<Real>& flow, Real* trial) const {
        const Vec<Real, 6> strain = yield.basis.tensor(flow.n, 0.5);
        for (int p = 0; p < 6; ++p) trial[p] += flow.dp * strain[p];
        trial[6] += flow.dp;
        if (parts.associated_only()) return;
        const PlasticIncrement<Real> at(parts, start, flow.dp);
        const Real lost = 0.5 * (ratio_before.value - at.ratio.value);
        const Real share = parts.back_stress.share(start.eqps + flow.dp).value;
        Real square = parts.kappa * volume * volume, work = 0.0;
        for (int i = 0; i < 5; ++i) {
            const Real elastic = start.e[i] - flow.dp * flow.n[i];
            square += 2.0 * parts.mu * elastic * elastic;
        }
        for (int part = 0; part < parts.back_stress.count(); ++part) {
            const auto [modulus, recall] = parts.back_stress.parts[part];
            const Real w = 1.0 / (1.0 + recall * flow.dp), pull = modulus * share * w * flow.dp / (at.k * at.y.value);
            Deviator<Real> alpha;
            for (int i = 0; i < 5; ++i) {
                alpha[i] = w * start.back_stress[part][i] + pull * (flow.s[i] - at.back.A[i]);
                work += 0.5 * (alpha[i] + start.back_stress[part][i]) * flow.n[i];
            }
            const Vec<Real, 6> stress = yield.basis.tensor(alpha, 1.0);
            for (int p = 0; p < 6; ++p)
                trial[8 + 6 * part + p] = select(flow.plastic, stress[p], trial[8 + 6 * part + p]);
        }
        trial[7] += lost * square + work * flow.dp;
    }
};

}  // namespace umform
