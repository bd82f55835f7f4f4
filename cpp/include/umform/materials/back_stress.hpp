// Back stresses of Chaboche, each with linear hardening and recall, by backward Euler. docs/theory, 3.12
#pragma once

#include <algorithm>
#include <vector>

#include "umform/materials/deviator.hpp"
#include "umform/materials/hardening.hpp"

namespace umform {

/// d alpha_i = C_i f (xi / phi) dp - gamma_i alpha_i dp with xi = s - sum alpha_i; all moduli may grow or fall with the plastic
/// strain, f = 1 + (first - 1) exp(-rate p). eq. (3.74)
struct Chaboche {
    struct Part {
        double modulus, recall;
    };
    static constexpr int largest = 4;
    std::vector<Part> parts;
    double first = 1.0, rate = 0.0;

    int count() const { return static_cast<int>(parts.size()); }
    template <class Real>
    YieldStress<Real> share(Real eqps) const {
        if (first == 1.0) return {1.0, 0.0};
        const Real decay = (first - 1.0) * exp(-rate * eqps);
        return {1.0 + decay, -rate * decay};
    }
    bool recalls() const {
        return std::any_of(parts.begin(), parts.end(), [](const Part& part) { return part.recall > 0.0; });
    }
};

/// Sum of the back stresses after a plastic increment, a xi / y + A, and the derivatives of a and A. eq. (3.75)
template <class Real>
struct BackStress {
    Real a, da;
    Deviator<Real> A{}, dA{};

    BackStress(const Chaboche& law, const std::array<Deviator<Real>, Chaboche::largest>& before, Real eqps, Real dp) {
        a = da = 0.0;
        const YieldStress<Real> share = law.share(eqps + dp);
        for (int k = 0; k < law.count(); ++k) {
            const auto [modulus, recall] = law.parts[k];
            const Real w = 1.0 / (1.0 + recall * dp);
            a += modulus * share.value * w * dp;
            da += modulus * w * (share.value * w + share.slope * dp);
            for (int i = 0; i < 5; ++i) {
                A[i] += w * before[k][i];
                dA[i] -= recall * w * w * before[k][i];
            }
        }
    }
};

}  // namespace umform
