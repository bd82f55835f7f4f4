// A material point that is led along strains and stresses: each component has its strain prescribed, or its stress.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "umform/materials/concept.hpp"

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

/// Solves the equations of the free components by elimination with row pivots; zero elsewhere.
inline Voigt solve_free(const Voigt66& C, const Voigt& r, const std::array<bool, 6>& free) {
    std::array<int, 6> of{};
    int n = 0;
    for (int p = 0; p < 6; ++p)
        if (free[p]) of[n++] = p;
    std::array<std::array<double, 7>, 6> A{};
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) A[i][j] = C(of[i], of[j]);
        A[i][n] = r[of[i]];
    }
    for (int k = 0; k < n; ++k) {
        int pivot = k;
        for (int i = k + 1; i < n; ++i)
            if (std::abs(A[i][k]) > std::abs(A[pivot][k])) pivot = i;
        std::swap(A[k], A[pivot]);
        for (int i = k + 1; i < n; ++i) {
            const double factor = A[i][k] / A[k][k];
            for (int j = k; j <= n; ++j) A[i][j] -= factor * A[k][j];
        }
    }
    Voigt x{};
    for (int k = n - 1; k >= 0; --k) {
        double sum = A[k][n];
        for (int j = k + 1; j < n; ++j) sum -= A[k][j] * x[of[j]];
        x[of[k]] = sum / A[k][k];
    }
    return x;
}

/// Leads a point of a law of logarithmic strains whose axes are turned against those of the test.
class PointWalk {
  public:
    /// `turn` makes strains in the axes of the sheet of those in the axes of the test (engineering shears).
    PointWalk(const Material& law, const Voigt66& turn) : law_(law), turn_(turn), history_(law.state_size()) {}

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
        double smallest = std::numeric_limits<double>::infinity();
        for (int iteration = 0; iteration < most_iterations; ++iteration) {
            Voigt turned{}, T, stress{}, residual{};
            for (int i = 0; i < 6; ++i)
                for (int j = 0; j < 6; ++j) turned[i] += turn_(i, j) * strain[j];
            Voigt66 C;
            if (law_.respond(1, &turned, at.history.data(), &T, &C, history_.data(), point) != 1) return false;
            double size = 0.0, largest = least_stress;
            for (int i = 0; i < 6; ++i) {
                for (int j = 0; j < 6; ++j) stress[i] += turn_(j, i) * T[j];
                if (free[i]) residual[i] = stress[i] - target.stress[i];
                size = std::max(size, std::abs(residual[i]));
                largest = std::max(largest, std::abs(stress[i]));
                if (!std::isfinite(stress[i])) return false;
            }
            if (size <= tolerance * largest) {
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
    std::vector<double> history_;  // of the increment that is tried
};

}  // namespace umform
