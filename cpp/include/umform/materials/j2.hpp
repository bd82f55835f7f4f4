// Finite-strain J2 plasticity in logarithmic elastic strains, written in C = 1 + 2E and the plastic metric Cp^-1.
#pragma once

#include "umform/materials/concept.hpp"
#include "umform/materials/hardening.hpp"

namespace umform {

/// Multiplicative split, logarithmic elastic strains, associated flow with the exponential map (docs/theory, chapter 3).
/// State: Cp^-1 (Voigt components of a tensor, det = 1) and the accumulated plastic strain eqps.
struct J2 {
    double kappa, mu;
    Hardening hardening;

    static constexpr int state_size = 7;
    void initial(double* state) const { std::copy_n(std::array<double, 7>{1, 1, 1, 0, 0, 0, 0}.begin(), 7, state); }

    bool respond(const Voigt& strain, const double* state, Voigt& S, Voigt66& CC, double* trial) const {
        // 1. Principal elastic trial stretches.
        ElasticStrain elastic;
        if (!elastic.set(strain, state)) return false;
        const auto& [L, V, excess, eps, deviator, volumetric] = elastic;

        // 2. Return map on the Kirchhoff stress. eqs. (3.15)-(3.20)
        const double norm = std::sqrt(dot(deviator, deviator));
        const double q_trial = std::sqrt(1.5) * 2.0 * mu * norm;
        const double eqps = state[6];
        YieldStress y = yield_stress(hardening, eqps);
        // A converged plastic point lies on the yield surface up to round-off. Without this margin chance would make it
        // plastic or elastic in the first tangent of an increment, and the patchwork wakes the modes of the elements.
        const bool plastic = q_trial > y.value * (1.0 + 1e-10);
        double dgam = 0.0;
        if (plastic) dgam = plastic_increment(q_trial, eqps, y);
        const double b = plastic ? 3.0 * mu * dgam / q_trial : 0.0;
        Vec3 tau;
        for (int i = 0; i < 3; ++i) tau[i] = kappa * volumetric + 2.0 * mu * (1.0 - b) * deviator[i];

        // 3. Stress and plastic metric in the eigenbasis. eqs. (3.16), (3.21)
        std::array<Voigt, 3> NN;
        Mat3 N;
        for (int k = 0; k < 3; ++k)
            for (int i = 0; i < 3; ++i) {
                double sum = 0.0;
                for (int j = 0; j <= k; ++j) sum += L(k, j) * V(j, i);
                N(k, i) = sum;
            }
        Vec3 l2;
        S = Voigt{};
        Voigt Cp_inv{};
        for (int i = 0; i < 3; ++i) {
            l2[i] = 1.0 + excess[i];
            const double eps_elastic = eps[i] - b * deviator[i];
            const double new_metric = plastic ? std::exp(2.0 * eps_elastic) / l2[i] : 0.0;
            for (int p = 0; p < 6; ++p) {
                const auto [k, l] = voigt_pair[p];
                NN[i][p] = N(k, i) * N(l, i);
                S[p] += tau[i] / l2[i] * NN[i][p];
                Cp_inv[p] += new_metric * NN[i][p];
            }
        }
        std::copy_n(plastic ? Cp_inv.data() : state, 6, trial);
        trial[6] = eqps + dgam;

        tangent(plastic, b, norm, y.slope, deviator, tau, l2, excess, N, NN, CC);
        return true;
    }

    /// Energy of the logarithmic elastic strains, and the work done against the yield stress. eqs. (3.38), (3.39)
    Energy energy(const Voigt& strain, const double* state) const {
        double trace, square;  // tr eps and eps : eps
        if (!small_elastic_strain(strain, state, trace, square)) {
            ElasticStrain elastic;
            if (!elastic.set(strain, state)) return {};
            trace = elastic.volumetric;
            square = dot(elastic.eps, elastic.eps);
        }
        return {0.5 * kappa * trace * trace + mu * (square - trace * trace / 3.0), plastic_work(hardening, state[6])};
    }

  private:
    /// Principal elastic stretches: C N_i = l_i^2 Cp N_i with Cp^-1 = L L^T, N = L V, from the eigenproblem of
    /// L^T C L - 1, so that small strains keep their digits. eqs. (3.12)-(3.14)
    struct ElasticStrain {
        Mat3 L, V;
        Vec3 excess;  // l_i^2 - 1
        Vec3 eps, deviator;
        double volumetric;

        /// False if C is not positive definite.
        bool set(const Voigt& strain, const double* Cp_inv) {
            Voigt metric;
            std::copy_n(Cp_inv, 6, metric.begin());
            if (!cholesky(from_voigt(metric, 1.0), L)) return false;
            eigen_symmetric(elastic_metric_excess(from_voigt(strain, 0.5), L), excess, V);
            for (int i = 0; i < 3; ++i) {
                if (!(excess[i] > -1.0)) return false;
                eps[i] = 0.5 * std::log1p(excess[i]);
            }
            volumetric = eps[0] + eps[1] + eps[2];
            for (int i = 0; i < 3; ++i) deviator[i] = eps[i] - volumetric / 3.0;
            return true;
        }

        /// L^T C L - 1 = L^T (2E) L + (L^T L - 1).
        static Mat3 elastic_metric_excess(const Mat3& E, const Mat3& L) {
            Mat3 EL, A;
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    for (int k = j; k < 3; ++k) EL(i, j) += 2.0 * E(i, k) * L(k, j);
            for (int i = 0; i < 3; ++i)
                for (int j = i; j < 3; ++j) {
                    double sum = i == j ? -1.0 : 0.0;
                    for (int k = j; k < 3; ++k) sum += L(k, i) * L(k, j);
                    for (int k = i; k < 3; ++k) sum += L(k, i) * EL(k, j);
                    A(i, j) = A(j, i) = sum;
                }
            return A;
        }
    };

    /// tr eps and eps : eps from the invariants of D = C Cp^-1 - 1, whose roots are l_i^2 - 1; no eigenproblem is solved.
    /// False where |D| > 0.03, which metals do not reach: there the series is too short. eq. (3.41)
    static bool small_elastic_strain(const Voigt& strain, const double* Cp_inv, double& trace, double& square) {
        Voigt metric;
        std::copy_n(Cp_inv, 6, metric.begin());
        const Mat3 E = from_voigt(strain, 0.5), P = from_voigt(metric, 1.0);
        Mat3 D = P;
        for (int i = 0; i < 3; ++i) {
            D(i, i) -= 1.0;
            for (int j = 0; j < 3; ++j)
                for (int k = 0; k < 3; ++k) D(i, j) += 2.0 * E(i, k) * P(k, j);
        }
        const double first = D(0, 0) + D(1, 1) + D(2, 2), third = det(D);
        double squares = 0.0;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) squares += D(i, j) * D(j, i);
        if (!(squares < 9e-4)) return false;
        const double second = 0.5 * (first * first - squares);
        trace = 0.5 * std::log1p(first + second + third);
        // log^2(1 + d) = sum_k (-1)^k (2/k) (1 + 1/2 + ... + 1/(k - 1)) d^k; sums of powers of the roots by Newton's identities.
        Vec3 powers{3.0, first, squares};  // sum of d_i^(k-2), d_i^(k-1), d_i^k
        double sum = squares, harmonic = 1.0;
        for (int k = 3; k <= 12; ++k) {
            harmonic += 1.0 / (k - 1);
            powers = {powers[1], powers[2], first * powers[2] - second * powers[1] + third * powers[0]};
            sum += (k % 2 == 0 ? 2.0 : -2.0) / k * harmonic * powers[2];
        }
        square = 0.25 * sum;
        return true;
    }

    /// Solves q_trial - 3 mu dgam - y(eqps + dgam) = 0 by Newton's method kept inside a bracket.
    double plastic_increment(double q_trial, double eqps, YieldStress& y) const {
        double low = 0.0, high = q_trial / (3.0 * mu), dgam = 0.0;
        for (int iteration = 0; iteration < 100; ++iteration) {
            const double f = q_trial - 3.0 * mu * dgam - y.value;
            if (f > 0.0)
                low = dgam;
            else
                high = dgam;
            if (std::abs(f) <= 1e-15 * q_trial) break;
            double next = dgam + f / (3.0 * mu + y.slope);
            if (!(next > low && next < high)) next = 0.5 * (low + high);
            const bool settled = next == dgam;
            dgam = next;
            y = yield_stress(hardening, eqps + dgam);
            if (settled) break;
        }
        return dgam;
    }

    /// Steps 4 and 5: principal moduli c_ij = d tau_i / d eps_j and the spectral form of CC. eqs. (3.22)-(3.25)
    void tangent(bool plastic, double b, double norm, double slope, const Vec3& deviator, const Vec3& tau,
                 const Vec3& l2, const Vec3& excess, const Mat3& N, const std::array<Voigt, 3>& NN, Voigt66& CC) const {
        const double shear = 2.0 * mu * (1.0 - b);
        const double flow = plastic ? 2.0 * mu * (3.0 * mu / (3.0 * mu + slope) - b) / (norm * norm) : 0.0;
        CC = Voigt66{};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const double delta = i == j ? 1.0 : 0.0;
                const double c = kappa + shear * (delta - 1.0 / 3.0) - flow * deviator[i] * deviator[j];
                add_dyad(CC, (c - 2.0 * tau[i] * delta) / (l2[i] * l2[j]), NN[i], NN[j]);
            }
        for (const auto& [i, j] : {std::pair{0, 1}, {1, 2}, {0, 2}}) {
            // k_ij = (S_j - S_i) / (l_j^2 - l_i^2) without a difference of stresses: tau_j - tau_i = shear (eps_j - eps_i)
            // and eps_j - eps_i = log1p(d)/2 with d = l_j^2/l_i^2 - 1, exact for close and for equal roots. eq. (3.27)
            const double d = (excess[j] - excess[i]) / l2[i];
            const double log_ratio = d == 0.0 ? 1.0 : std::log1p(d) / d;
            const double k = (0.5 * shear * log_ratio - tau[i]) / (l2[i] * l2[j]);
            Voigt w;
            for (int p = 0; p < 6; ++p) {
                const auto [m, n] = voigt_pair[p];
                w[p] = N(m, i) * N(n, j) + N(n, i) * N(m, j);
            }
            add_dyad(CC, k, w, w);
        }
    }
};

}  // namespace umform
