// Results from the pivots of a factorisation: the inertia, the sign of the determinant, how close to singular the matrix is.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "umform/multifrontal/factors.hpp"

namespace umform::multifrontal {

struct Pivots {
    std::vector<double> size;  // [equation] pivot; of a pair the determinant over its largest entry
    int negative = 0;          // of a symmetric matrix its negative eigenvalues
    bool odd = false;          // is the determinant negative?

    explicit Pivots(const Factors& factors) : size(factors.plan().n) {
        const Plan& plan = factors.plan();
        std::vector<std::int32_t> partner(plan.n);  // [row] -> column of the same pivot
        for (int f = 0; f < static_cast<int>(plan.fronts.size()); ++f) {
            const Eliminated& front = factors.front(f);
            for (int t = 0; t < front.done; ++t) {
                const double d = *front.a.at(t, t);
                const int column = factors.column(f, t);
                partner[factors.row(f, t)] = column;
                double& here = size[plan.equation[column]];
                here = factors.kind() == Kind::Positive ? d * d : d;
                if (factors.kind() != Kind::Symmetric || front.below[t] == 0.0) {
                    negative += here < 0.0 ? 1 : 0;
                    continue;
                }
                const double e = front.below[t], g = *front.a.at(t + 1, t + 1);
                const double largest = std::max({std::abs(d), std::abs(e), std::abs(g)});
                const double determinant = (d / largest) * g - (e / largest) * e;
                const int other = factors.column(f, ++t);
                partner[other] = other;
                here = size[plan.equation[other]] = determinant;
                negative += determinant < 0.0 ? 1 : d < 0.0 ? 2 : 0;
            }
        }
        odd = (negative + exchanges(partner)) % 2 == 1;
    }

  private:
    /// Number of exchanges that make a permutation of the identity.
    static int exchanges(std::vector<std::int32_t>& to) {
        int count = 0;
        for (std::size_t k = 0; k < to.size(); ++k)
            while (to[k] != static_cast<std::int32_t>(k)) std::swap(to[k], to[to[k]]), ++count;
        return count;
    }
};

}  // namespace umform::multifrontal
