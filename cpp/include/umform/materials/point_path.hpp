// A material point that is led along strains and stresses: each component has its strain prescribed, or its stress.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "umform/algebra/solve_free.hpp"
#include "umform/materials/concept.hpp"
#include "umform/materials/logarithmic_answer.hpp"

namespace umform {

/// Where a point is: strain and stress in the axes of the test, history.
struct PointState {
    Voigt strain{}, stress{};
    std::vector<double> history;
};

/// What a row of a path prescribes; a component without a strain (NaN) has its stress prescribed.
struct PointTarget {
    Voigt strain, stress;
    double step;  // of time
};

/// Leads a point of a law along logarithmic strains; its axes are turned against those of the test.
class PointWalk {
  public:
    /// `turn` makes strains in the axes of the sheet of those in the axes of the test (engineering shears). `finite`: the law is one of
    /// the Green-Lagrange strain.
    PointWalk(const Material& law, const Voigt66& turn, bool finite = false)
        : law_(law), turn_(turn), finite_(finite), history_(law.state_size()) {}

    /// Advance to the target, with bisection if Newton's method fails; false if it cannot be reached.
    bool reach(PointState& at, const PointTarget& target, int cuts = 0) {
        if (newton(at, target)) return true;
        if (cuts == most_cuts) return false;
        PointTarget half = target;
        half.step *= 0.5;
        for (int p = 0; p < 6; ++p) {
            half.strain[p] = 0.5 * (at.strain[p] + target.strain[p]);
            half.stress[p] = 0.5 * (at.stress[p] + target.stress[p]);
        }
        PointTarget rest = target;
        rest.step = half.step;
        return reach(at, half, cuts + 1) && reach(at, rest, cuts + 1);
    }

  private:
    static constexpr int most_iterations = 60, most_cuts = 12;
    static constexpr double tolerance = 1e-11, least_stress = 1e-6, most_growth = 1e3;
    /// What remains of a stress that vanishes is the round-off of stiffness times strain.
    static constexpr double round_off = 16.0 * std::numeric_limits<double>::epsilon();

    /// The largest entry.
    static double norm(const auto& entries) {
        double largest = 0.0;
        for (const double entry : entries) largest = std::max(largest, std::abs(entry));
        return largest;
    }

    bool respond(const Voigt& strain, const double* state, Voigt& T, Voigt66& C, const Point<double>& point) {
        if (finite_) return logarithmic_answer(law_, strain, state, T, C, history_.data(), point);
        return law_.respond(1, &strain, state, &T, &C, history_.data(), point) == 1;
    }

    /// One increment; leaves the point where it is if that fails.
    bool newton(PointState& at, const PointTarget& target) {
        std::array<bool, 6> free{};
        Voigt strain = target.strain;
        for (int p = 0; p < 6; ++p) {
            free[p] = std::isnan(target.strain[p]);
            if (free[p]) strain[p] = at.strain[p];
        }
        Point<double> point;
        point.step = target.step;
        double smallest = std::numeric_limits<double>::infinity(), rest = 0.0;
        for (int iteration = 0; iteration < most_iterations; ++iteration) {
            Voigt turned{}, T, stress{}, residual{};
            for (int i = 0; i < 6; ++i)
                for (int j = 0; j < 6; ++j) turned[i] += turn_(i, j) * strain[j];
            Voigt66 C;
            if (!respond(turned, at.history.data(), T, C, point)) return false;
            double size = 0.0, largest = least_stress;
            if (iteration == 0) rest = round_off * norm(C.a) * norm(strain);  // not of an iterate that runs away
            for (int i = 0; i < 6; ++i) {
                for (int j = 0; j < 6; ++j) stress[i] += turn_(j, i) * T[j];
                if (free[i]) residual[i] = stress[i] - target.stress[i];
                size = std::max(size, std::abs(residual[i]));
                largest = std::max(largest, std::abs(stress[i]));
                if (!std::isfinite(stress[i])) return false;
            }
            if (size <= std::max(tolerance * largest, rest)) {
                at.strain = strain;
                at.stress = stress;
                at.history = history_;
                return true;
            }
            if (size > most_growth * smallest) return false;
            smallest = std::min(smallest, size);
            const Voigt change = solve_free(in_test_axes(C), residual, free);
            for (int p = 0; p < 6; ++p) strain[p] -= change[p];
        }
        return false;
    }

    /// Tangent in the axes of the test.
    Voigt66 in_test_axes(const Voigt66& C) const {
        Voigt66 half{}, turned{};
        for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 6; ++j)
                for (int k = 0; k < 6; ++k) half(i, j) += C(i, k) * turn_(k, j);
        for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 6; ++j)
                for (int k = 0; k < 6; ++k) turned(i, j) += turn_(k, i) * half(k, j);
        return turned;
    }

    const Material& law_;
    Voigt66 turn_;
    bool finite_;
    std::vector<double> history_;  // of the increment that is tried
};

}  // namespace umform
