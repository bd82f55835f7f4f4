// A law of the Green-Lagrange strain asked at a logarithmic strain: what `LogarithmicSpace` does, the other way round.
#pragma once

#include <cmath>

#include "umform/algebra/solve_free.hpp"
#include "umform/materials/concept.hpp"
#include "umform/materials/logarithmic_strain.hpp"

namespace umform {

/// Green-Lagrange strain (exp(2h) - 1) / 2 of a logarithmic strain; engineering shears in both.
inline Voigt green_lagrange(const Voigt& h) {
    Vec3 values;
    Mat3 N;
    eigen_symmetric(from_voigt(h, 0.5), values, N);
    Voigt E{};
    for (int i = 0; i < 3; ++i) {
        const double stretched = 0.5 * std::expm1(2.0 * values[i]);
        for (int p = 0; p < 6; ++p) {
            const auto [k, l] = voigt_pair[p];
            E[p] += (p < 3 ? 1.0 : 2.0) * stretched * N(k, i) * N(l, i);
        }
    }
    return E;
}

/// Stress T conjugate to h and C = dT/dh of one point, from S and dS/dE of the law: S = T : P and dS/dE = P^T : C : P + T : L are
/// solved for T and C. False where the law has no answer. eqs. (3.66), (3.67)
inline bool logarithmic_answer(const Material& law, const Voigt& h, const double* state, Voigt& T, Voigt66& C,
                               double* trial, const Point<double>& point) {
    const Voigt E = green_lagrange(h);
    Voigt S;
    Voigt66 CC;
    LogarithmicStrain<double> strain;
    if (!strain.set(E) || law.respond(1, &E, state, &S, &CC, trial, point) != 1) return false;
    constexpr std::array<bool, 6> all{true, true, true, true, true, true};
    const auto column = [](const Voigt66& M, int j) {
        Voigt c;
        for (int i = 0; i < 6; ++i) c[i] = M(i, j);
        return c;
    };
    Voigt66 A, L;  // S = A T, and T : L
    Voigt pulled;
    for (int j = 0; j < 6; ++j) {
        Voigt unit{};
        unit[j] = 1.0;
        strain.pull_back(unit, Voigt66{}, false, pulled, L);
        for (int i = 0; i < 6; ++i) A(i, j) = pulled[i];
    }
    T = solve_free(A, S, all);
    strain.pull_back(T, Voigt66{}, false, pulled, L);
    Voigt66 half;  // (A^-1 (dS/dE - T : L))^T
    for (int j = 0; j < 6; ++j) {
        Voigt rest = column(CC, j);
        for (int i = 0; i < 6; ++i) rest[i] -= L(i, j);
        const Voigt solved = solve_free(A, rest, all);
        for (int i = 0; i < 6; ++i) half(j, i) = solved[i];
    }
    for (int i = 0; i < 6; ++i) {
        const Voigt row = solve_free(A, column(half, i), all);
        for (int j = 0; j < 6; ++j) C(i, j) = row[j];
    }
    return true;
}

}  // namespace umform
