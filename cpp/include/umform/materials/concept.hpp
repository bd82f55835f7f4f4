// What a material law is to the elements: strain and history in, stress, tangent and new history out; and energies.
// A law of a user, from any function of arrays, is in function.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <concepts>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "umform/assembly/history.hpp"
#include "umform/materials/point.hpp"
#include "umform/materials/staged_returns.hpp"

namespace umform {

/// Energies per reference volume: what is stored in elastic strains, and the plastic work done so far (dissipation, and
/// what hardening keeps). NaN where a law does not know them.
struct Energy {
    double elastic = std::numeric_limits<double>::quiet_NaN();
    double plastic = std::numeric_limits<double>::quiet_NaN();
};

/// A law answers at one point of a few elements, one a lane. `E` is the Green-Lagrange strain in a local orthonormal frame,
/// `state` the converged history (never changed), `trial` the new one. False where it has no answer: the strain is outside of
/// its domain, or its equations could not be solved. Its `table` has the parts of the history: a VariableTable, or
/// one that depends on the parts of the law.
template <class L>
concept MaterialLaw =
    requires(const L& law, const Vec<Lanes, 6>& E, const Lanes* state, Vec<Lanes, 6>& S, Mat<Lanes, 6, 6>& CC,
             Lanes* trial, const Voigt& strain, double* history, const Point<Lanes>& point) {
        { law.table.size() } -> std::same_as<int>;
        { law.table.list() } -> std::same_as<std::vector<HistoryVariable>>;
        requires requires {
            { law.respond(E, state, S, CC, trial) } -> std::same_as<LaneMask>;
        } || requires {
            { law.respond(E, state, S, CC, trial, point) } -> std::same_as<LaneMask>;
        } || requires {
            { law.respond(E, state, S, CC, trial, point.step) } -> std::same_as<LaneMask>;
        };
        { law.initial(history) } -> std::same_as<void>;
        { law.energy(strain, history) } -> std::same_as<Energy>;
    };

/// A law that takes its point as a last argument: it sees the axes of the sheet, the size of the element and the step.
template <class L>
concept SeesPoint =
    requires(const L& law, const Vec<Lanes, 6>& E, const Lanes* state, Vec<Lanes, 6>& S, Mat<Lanes, 6, 6>& CC,
             Lanes* trial, const Point<Lanes>& point) { law.respond(E, state, S, CC, trial, point); };

/// A law that takes the increment of time as a last argument.
template <class L>
concept SeesStep =
    requires(const L& law, const Vec<Lanes, 6>& E, const Lanes* state, Vec<Lanes, 6>& S, Mat<Lanes, 6, 6>& CC,
             Lanes* trial, double step) { law.respond(E, state, S, CC, trial, step); };

/// A law that answers for its elastic energy at one point a lane, apart from its plastic work.
template <class L>
concept StoresInLanes = requires(const L& law, const Vec<Lanes, 6>& E, const Lanes* state, const double* history) {
    { law.stored(E, state) } -> std::same_as<Lanes>;
    { law.spent(history) } -> std::same_as<double>;
};

/// A law whose tangent is not symmetric says so by a member function `symmetric`.
template <class L>
bool has_symmetric_tangent(const L& law) {
    if constexpr (requires { law.symmetric(); })
        return law.symmetric();
    else
        return true;
}

/// Numbers that the history of a point may have at most: a law whose size depends on its parts says so by `state_limit`.
template <class L>
constexpr int state_limit() {
    if constexpr (requires { L::state_limit; })
        return L::state_limit;
    else
        return L::table.size();
}

/// Where the histories of the elements in the lanes begin, [lane][n][state_size].
using LaneStates = std::array<const double*, lane_count>;
using LaneTrials = std::array<double*, lane_count>;

/// The law as the elements see it: one virtual call for all points of the elements in the lanes, so that elements and laws
/// are compiled apart from each other.
class Material {
  public:
    virtual ~Material() = default;
    /// The parts of the history of a point, in their order.
    virtual std::vector<HistoryVariable> history_variables() const = 0;
    virtual int state_size() const = 0;
    virtual void initial(double* state) const = 0;
    /// Whether dS/dE is symmetric at any strain.
    virtual bool symmetric() const = 0;
    /// Whether it needs its points: the axes are formed only for laws that do.
    virtual bool sees_points() const = 0;
    /// Answers at the n points of the elements in the lanes of `wanted`; arrays are [n]. Returns which of them have an
    /// answer at every point.
    virtual LaneMask respond(int n, LaneMask wanted, const Vec<Lanes, 6>* E, const LaneStates& state, Vec<Lanes, 6>* S,
                             Mat<Lanes, 6, 6>* CC, const LaneTrials& trial, const LanePoints& points) const = 0;
    /// Answers at n points with the same context; arrays are [n][6], [n][state_size], [n][36]. Returns the index of the
    /// first point that fails, or n.
    virtual int respond(int n, const Voigt* E, const double* state, Voigt* S, Voigt66* CC, double* trial,
                        const Point<double>& point) const = 0;
    /// Energies at n points whose history `state` belongs to the strain (it has been committed); `cell` is the number of their
    /// element for messages, or -1.
    virtual void energy(int n, const Voigt* E, const double* state, Energy* energies, std::int32_t cell) const = 0;
    /// Points at which its return map has gone through stages so far.
    virtual std::uint64_t staged_returns() const { return 0; }
};

/// A law at all points of elements. If its return map may go through stages, it says so by a static member `has_stages`.
template <MaterialLaw Law>
class MaterialOf final : public Material {
  public:
    explicit MaterialOf(Law law) : law_(std::move(law)) {}
    std::vector<HistoryVariable> history_variables() const override { return law_.table.list(); }
    int state_size() const override { return law_.table.size(); }
    void initial(double* state) const override { law_.initial(state); }
    bool symmetric() const override { return has_symmetric_tangent(law_); }
    bool sees_points() const override { return SeesPoint<Law>; }

    LaneMask respond(int n, LaneMask wanted, const Vec<Lanes, 6>* E, const LaneStates& state, Vec<Lanes, 6>* S,
                     Mat<Lanes, 6, 6>* CC, const LaneTrials& trial, const LanePoints& points) const override {
        std::array<Lanes, state_limit<Law>()> before, after;
        const int size = law_.table.size();
        [[maybe_unused]] const LaneMask asked = wanted;
        for (int q = 0; q < n; ++q) {
            for (int k = 0; k < size; ++k) before[k] = by_lane([&](int lane) { return state[lane][q * size + k]; });
            if constexpr (SeesPoint<Law>)
                wanted = wanted
                         & law_.respond(E[q], before.data(), S[q], CC[q], after.data(),
                                        Point<Lanes>{points.axes[q], points.size, points.step});
            else if constexpr (SeesStep<Law>)
                wanted = wanted & law_.respond(E[q], before.data(), S[q], CC[q], after.data(), points.step);
            else
                wanted = wanted & law_.respond(E[q], before.data(), S[q], CC[q], after.data());
            if constexpr (requires { Law::has_stages; })
                if (const int count = take_stages(asked)) staged_.fetch_add(count, std::memory_order_relaxed);
            for (int lane = 0; lane < lane_count; ++lane)
                for (int k = 0; k < size; ++k) trial[lane][q * size + k] = after[k][lane];
        }
        return wanted;
    }

    std::uint64_t staged_returns() const override { return staged_.load(); }

    int respond(int n, const Voigt* E, const double* state, Voigt* S, Voigt66* CC, double* trial,
                const Point<double>& context) const override {
        Axes<Lanes> axes;
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) axes[i][k] = context.axes[i][k];
        const LanePoints points{{}, &axes, context.size, context.step};
        for (int first = 0; first < n; first += lane_count) {  // points instead of elements in the lanes
            const auto point = [&](int lane) { return std::min(first + lane, n - 1); };
            Vec<Lanes, 6> strain, stress;
            Mat<Lanes, 6, 6> tangent;
            LaneStates before;
            LaneTrials after;
            for (int p = 0; p < 6; ++p) strain[p] = by_lane([&](int lane) { return E[point(lane)][p]; });
            for (int lane = 0; lane < lane_count; ++lane) {
                before[lane] = state + point(lane) * law_.table.size();
                after[lane] = trial + point(lane) * law_.table.size();
            }
            LaneMask asked = false;
            for (int lane = 0; lane < std::min(lane_count, n - first); ++lane) asked.set(lane, true);
            const LaneMask answered = respond(1, asked, &strain, before, &stress, &tangent, after, points);
            for (int q = first; q < std::min(first + lane_count, n); ++q) {
                if (!answered[q - first]) return q;
                for (int p = 0; p < 6; ++p) S[q][p] = stress[p][q - first];
                for (int i = 0; i < 36; ++i) CC[q].a[i] = tangent.a[i][q - first];
            }
        }
        return n;
    }

    void energy(int n, const Voigt* E, const double* state, Energy* energies, std::int32_t) const override {
        const auto history = [&](int q) { return state + q * law_.table.size(); };
        if constexpr (!StoresInLanes<Law>) {
            for (int q = 0; q < n; ++q) energies[q] = law_.energy(E[q], history(q));
        } else {
            for (int first = 0; first < n; first += lane_count) {  // points instead of elements in the lanes
                const auto point = [&](int lane) { return std::min(first + lane, n - 1); };
                Vec<Lanes, 6> strain;
                std::array<Lanes, state_limit<Law>()> here;
                for (int p = 0; p < 6; ++p) strain[p] = by_lane([&](int lane) { return E[point(lane)][p]; });
                for (int k = 0; k < law_.table.size(); ++k)
                    here[k] = by_lane([&](int lane) { return history(point(lane))[k]; });
                const Lanes stored = law_.stored(strain, here.data());
                for (int q = first; q < std::min(first + lane_count, n); ++q)
                    energies[q] = {stored[q - first], law_.spent(history(q))};
            }
        }
    }

  private:
    Law law_;
    mutable std::atomic<std::uint64_t> staged_{0};  // threads add to it, in any order
};

}  // namespace umform
