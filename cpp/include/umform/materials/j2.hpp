// Finite-strain J2 plasticity in logarithmic elastic strains, written in C = 1 + 2E and the plastic metric Cp^-1.
#pragma once

#include "umform/materials/concept.hpp"
#include "umform/materials/hardening.hpp"
#include "umform/materials/logarithmic_series.hpp"

namespace umform {

/// Multiplicative split, logarithmic elastic strains, associated flow with the exponential map (docs/theory, chapter 3).
/// State: Cp^-1 (Voigt components of a tensor, det = 1) and the accumulated plastic strain eqps.
struct J2 {
    double kappa, mu;
    Hardening hardening;

    static constexpr VariableTable table{{{"Cp_inv", 6}, {"eqps"}}};
    enum { Metric = table["Cp_inv"], Eqps = table["eqps"] };
    static constexpr int size = table.size();
    void initial(double* state) const {
        std::fill_n(state, size, 0.0);
        std::fill_n(state + Metric, 3, 1.0);
    }

    /// Where the trial state is elastic and small there is no eigenproblem to solve: the fast path. Each lane takes the path it
    /// would take alone.
    template <class Real>
    Mask<Real> respond(const Vec<Real, 6>& strain, const Real* state, Vec<Real, 6>& S, Mat<Real, 6, 6>& CC,
                       Real* trial) const {
        const LogarithmicSeries<Real> series(strain, plastic_metric(state));
        const YieldStress<Real> y = yield_stress(hardening, state[Eqps]);
        const Real limit = y.value * (1.0 + plastic_margin);
        const Mask<Real> fast =
            series.small
            & (6.0 * mu * mu * (series.square - series.trace * series.trace * (1.0 / 3.0)) <= limit * limit);
        if (!any(fast)) return respond_by_roots(strain, state, y, S, CC, trial);
        series.respond(kappa - 2.0 / 3.0 * mu, mu, S, CC);
        std::copy_n(state, size, trial);
        if (all(fast)) return fast;
        Vec<Real, 6> S_roots;
        Mat<Real, 6, 6> CC_roots;
        std::array<Real, size> trial_roots;
        const Mask<Real> answered = respond_by_roots(strain, state, y, S_roots, CC_roots, trial_roots.data());
        for (int p = 0; p < 6; ++p) S[p] = select(fast, S[p], S_roots[p]);
        for (int i = 0; i < 36; ++i) CC.a[i] = select(fast, CC.a[i], CC_roots.a[i]);
        for (int k = 0; k < size; ++k) trial[k] = select(fast, trial[k], trial_roots[k]);
        return fast | answered;
    }

    /// The same by principal stretches: for plastic flow and for elastic strains of any size.
    template <class Real>
    Mask<Real> respond_by_roots(const Vec<Real, 6>& strain, const Real* state, const YieldStress<Real>& y,
                                Vec<Real, 6>& S, Mat<Real, 6, 6>& CC, Real* trial) const {
        ElasticStrain<Real> elastic;
        const Mask<Real> positive = elastic.set(strain, state);
        const Return<Real> back = return_map(elastic, state[Eqps], y);
        Vec<Real, 3> tau;
        for (int i = 0; i < 3; ++i)
            tau[i] = kappa * elastic.volumetric + 2.0 * mu * (1.0 - back.b) * elastic.deviator[i];

        // Stress in the eigenbasis. eq. (3.16)
        std::array<Vec<Real, 6>, 3> NN;
        S = Vec<Real, 6>{};
        for (int i = 0; i < 3; ++i) {
            const Real principal = tau[i] / (1.0 + elastic.excess[i]);
            for (int p = 0; p < 6; ++p) {
                const auto [k, l] = voigt_pair[p];
                NN[i][p] = elastic.N(k, i) * elastic.N(l, i);
                S[p] += principal * NN[i][p];
            }
        }
        std::copy_n(state, size, trial);
        if (any(back.plastic)) flow(elastic, back, NN, trial);
        tangent(elastic, back, tau, NN, CC);
        return positive & back.found;
    }

    /// Energy of the logarithmic elastic strains, and the work done against the yield stress. eqs. (3.38), (3.39)
    Energy energy(const Voigt& strain, const double* state) const { return {stored(strain, state), spent(state)}; }

    /// Energy of the logarithmic elastic strains; NaN where C is not positive definite. eq. (3.38)
    template <class Real>
    Real stored(const Vec<Real, 6>& strain, const Real* state) const {
        const LogarithmicSeries<Real> series(strain, plastic_metric(state));
        Real trace = series.trace, square = series.square;
        if (!all(series.small)) {
            ElasticStrain<Real> elastic;
            const Mask<Real> positive = elastic.set(strain, state);
            const Real unknown = std::numeric_limits<double>::quiet_NaN();
            trace = select(series.small, trace, select(positive, elastic.volumetric, unknown));
            square = select(series.small, square, dot(elastic.eps, elastic.eps));
        }
        return 0.5 * kappa * trace * trace + mu * (square - trace * trace * (1.0 / 3.0));
    }

    /// Work done against the yield stress. eq. (3.39)
    double spent(const double* state) const { return plastic_work(hardening, state[Eqps]); }

  private:
    /// A converged plastic point lies on the yield surface up to round-off. Without this margin chance would make it plastic
    /// or elastic in the first tangent of an increment, and the patchwork wakes the modes of the elements.
    static constexpr double plastic_margin = 1e-10;
    static constexpr int max_iterations = 100;  // of the return map

    template <class Real>
    static Vec<Real, 6> plastic_metric(const Real* state) {
        Vec<Real, 6> Cp_inv;
        std::copy_n(state + Metric, 6, Cp_inv.begin());
        return Cp_inv;
    }

    /// Principal elastic stretches: C N_i = l_i^2 Cp N_i with Cp^-1 = L L^T, N = L V, from the eigenproblem of
    /// L^T C L - 1, so that small strains keep their digits. eqs. (3.12)-(3.14)
    template <class Real>
    struct ElasticStrain {
        Mat<Real, 3, 3> N;
        Vec<Real, 3> excess;  // l_i^2 - 1
        Vec<Real, 3> eps, deviator;
        Real volumetric;

        /// False where C is not positive definite.
        Mask<Real> set(const Vec<Real, 6>& strain, const Real* state) {
            Mat<Real, 3, 3> L, V;
            Mask<Real> positive = cholesky(from_voigt(plastic_metric(state), 1.0), L);
            eigen_symmetric(elastic_metric_excess(from_voigt(strain, 0.5), L), excess, V);
            for (int i = 0; i < 3; ++i) {
                positive = positive & (excess[i] > -1.0);
                eps[i] = 0.5 * excess[i] * log1p_ratio(excess[i]);
                for (int k = 0; k < 3; ++k) {
                    N(k, i) = L(k, 0) * V(0, i);
                    for (int j = 1; j <= k; ++j) N(k, i) += L(k, j) * V(j, i);
                }
            }
            volumetric = eps[0] + eps[1] + eps[2];
            for (int i = 0; i < 3; ++i) deviator[i] = eps[i] - volumetric * (1.0 / 3.0);
            return positive;
        }

        /// L^T C L - 1 = L^T (2E) L + (L^T L - 1).
        static Mat<Real, 3, 3> elastic_metric_excess(const Mat<Real, 3, 3>& E, const Mat<Real, 3, 3>& L) {
            Mat<Real, 3, 3> EL, A;
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    for (int k = j; k < 3; ++k) EL(i, j) += 2.0 * E(i, k) * L(k, j);
            for (int i = 0; i < 3; ++i)
                for (int j = i; j < 3; ++j) {
                    Real sum = i == j ? -1.0 : 0.0;
                    for (int k = j; k < 3; ++k) sum += L(k, i) * L(k, j);
                    for (int k = i; k < 3; ++k) sum += L(k, i) * EL(k, j);
                    A(i, j) = A(j, i) = sum;
                }
            return A;
        }
    };

    /// What the return map finds: dev eps_elastic = (1 - b) dev eps.
    template <class Real>
    struct Return {
        Mask<Real> plastic, found;  // found: the increment has been solved for, or there is none
        Real dgam, b, slope;
        Real square;  // dev eps : dev eps
    };

    /// Return map on the Kirchhoff stress. eqs. (3.15), (3.17)-(3.20)
    template <class Real>
    Return<Real> return_map(const ElasticStrain<Real>& elastic, Real eqps, YieldStress<Real> y) const {
        const Real square = dot(elastic.deviator, elastic.deviator);
        const Real q_trial = std::sqrt(6.0) * mu * sqrt(square);
        const Mask<Real> plastic = !(q_trial <= y.value * (1.0 + plastic_margin));  // also if y is not a number
        if (!any(plastic)) return {plastic, true, 0.0, 0.0, y.slope, square};
        Real dgam = 0.0;
        const Mask<Real> found = plastic_increment(plastic, q_trial, eqps, y, dgam);
        return {plastic, found, dgam, select(plastic, 3.0 * mu * dgam / q_trial, 0.0), y.slope, square};
    }

    /// The new history of plastic points: Cp^-1 = sum_i exp(2 eps_elastic_i) / l_i^2 N_i (x) N_i with
    /// eps_elastic = eps - b dev eps and l_i^2 = exp(2 eps_i). eqs. (3.20), (3.21)
    template <class Real>
    static void flow(const ElasticStrain<Real>& elastic, const Return<Real>& back,
                     const std::array<Vec<Real, 6>, 3>& NN, Real* trial) {
        Vec<Real, 6> Cp_inv{};
        for (int i = 0; i < 3; ++i) {
            const Real metric = exp(-2.0 * back.b * elastic.deviator[i]);
            for (int p = 0; p < 6; ++p) Cp_inv[p] += metric * NN[i][p];
        }
        for (int p = 0; p < 6; ++p) trial[Metric + p] = select(back.plastic, Cp_inv[p], trial[Metric + p]);
        trial[Eqps] += back.dgam;
    }

    /// Solves q_trial - 3 mu dgam - y(eqps + dgam) = 0 where `open` by Newton's method kept inside a bracket; y at the end.
    /// False where it finds no solution: the curve is too steep for the number of iterations, or not a number.
    template <class Real>
    Mask<Real> plastic_increment(Mask<Real> open, Real q_trial, Real eqps, YieldStress<Real>& y, Real& dgam) const {
        Real low = 0.0, high = q_trial * (1.0 / (3.0 * mu));
        dgam = 0.0;
        for (int iteration = 0; iteration < max_iterations; ++iteration) {
            const Real f = q_trial - 3.0 * mu * dgam - y.value;
            low = select(f > 0.0, dgam, low);
            high = select(f > 0.0, high, dgam);
            open = open & !(abs(f) <= 1e-15 * q_trial);
            if (!any(open)) break;
            Real next = dgam + f / (3.0 * mu + y.slope);
            next = select((next > low) & (next < high), next, 0.5 * (low + high));
            open = open & !((next == dgam) & (f == f));  // nothing is left between the ends of the bracket
            dgam = select(open, next, dgam);
            y = yield_stress(hardening, eqps + dgam);
        }
        return !open;
    }

    /// Principal moduli c_ij = d tau_i / d eps_j and the spectral form of CC. eqs. (3.22)-(3.25)
    template <class Real>
    void tangent(const ElasticStrain<Real>& elastic, const Return<Real>& back, const Vec<Real, 3>& tau,
                 const std::array<Vec<Real, 6>, 3>& NN, Mat<Real, 6, 6>& CC) const {
        const auto& [N, excess, eps, deviator, volumetric] = elastic;
        const Real shear = 2.0 * mu * (1.0 - back.b);
        const Real flow =
            select(back.plastic, 2.0 * mu * (3.0 * mu / (3.0 * mu + back.slope) - back.b) / back.square, 0.0);
        Vec<Real, 3> l2_inverse;
        for (int i = 0; i < 3; ++i) l2_inverse[i] = 1.0 / (1.0 + excess[i]);
        // CC = sum_d left_d (x) right_d; all of it is symmetric.
        std::array<Vec<Real, 6>, 6> left, right;
        for (int i = 0; i < 3; ++i) {
            left[i] = NN[i], right[i] = Vec<Real, 6>{};
            for (int j = 0; j < 3; ++j) {
                const Real c = kappa + shear * (i == j ? 2.0 / 3.0 : -1.0 / 3.0) - flow * deviator[i] * deviator[j]
                               - (i == j ? 2.0 * tau[i] : 0.0);
                const Real factor = c * l2_inverse[i] * l2_inverse[j];
                for (int p = 0; p < 6; ++p) right[i][p] += factor * NN[j][p];
            }
        }
        for (int pair = 0; pair < 3; ++pair) {
            const auto [i, j] = voigt_pair[3 + pair];
            // k_ij = (S_j - S_i) / (l_j^2 - l_i^2) without a difference of stresses: tau_j - tau_i = shear (eps_j - eps_i)
            // and eps_j - eps_i = log1p(d)/2 with d = l_j^2/l_i^2 - 1, exact for close and for equal roots. eq. (3.27)
            const Real d = (excess[j] - excess[i]) * l2_inverse[i];
            const Real k = (0.5 * shear * log1p_ratio(d) - tau[i]) * l2_inverse[i] * l2_inverse[j];
            for (int p = 0; p < 6; ++p) {
                const auto [m, n] = voigt_pair[p];
                left[3 + pair][p] = N(m, i) * N(n, j) + N(n, i) * N(m, j);
                right[3 + pair][p] = k * left[3 + pair][p];
            }
        }
        for (int p = 0; p < 6; ++p)
            for (int q = p; q < 6; ++q) {
                Real sum = left[0][p] * right[0][q];
                for (int dyad = 1; dyad < 6; ++dyad) sum += left[dyad][p] * right[dyad][q];
                CC(p, q) = CC(q, p) = sum;
            }
    }
};

}  // namespace umform
