// What a material law is to the elements: strain and history in, stress, tangent and new history out; and energies.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "umform/algebra/tensor.hpp"

namespace umform {

/// Energies per reference volume: what is stored in elastic strains, and the plastic work done so far (dissipation, and
/// what hardening keeps). NaN where a law does not know them.
struct Energy {
    double elastic = std::numeric_limits<double>::quiet_NaN();
    double plastic = std::numeric_limits<double>::quiet_NaN();
};

/// A law answers at one point of a few elements, one a lane. `E` is the Green-Lagrange strain in a local orthonormal frame,
/// `state` the converged history (never changed), `trial` the new one. False where the strain is outside of its domain.
template <class L>
concept MaterialLaw = requires(const L& law, const Vec<Lanes, 6>& E, const Lanes* state, Vec<Lanes, 6>& S,
                               Mat<Lanes, 6, 6>& CC, Lanes* trial, const Voigt& strain, double* history) {
    { L::state_size } -> std::convertible_to<int>;
    { law.respond(E, state, S, CC, trial) } -> std::same_as<LaneMask>;
    { law.initial(history) } -> std::same_as<void>;
    { law.energy(strain, history) } -> std::same_as<Energy>;
};

/// Where the histories of the elements in the lanes begin, [lane][n][state_size].
using LaneStates = std::array<const double*, lane_count>;
using LaneTrials = std::array<double*, lane_count>;

/// The law as the elements see it: one virtual call for all points of the elements in the lanes, so that elements and laws
/// are compiled apart from each other.
class Material {
  public:
    virtual ~Material() = default;
    virtual int state_size() const = 0;
    virtual void initial(double* state) const = 0;
    /// Answers at the n points of the elements in the lanes of `wanted`; arrays are [n]. Returns which of them have an
    /// answer at every point.
    virtual LaneMask respond(int n, LaneMask wanted, const Vec<Lanes, 6>* E, const LaneStates& state, Vec<Lanes, 6>* S,
                             Mat<Lanes, 6, 6>* CC, const LaneTrials& trial) const = 0;
    /// Answers at n points; arrays are [n][6], [n][state_size], [n][36]. Returns the index of the first point that
    /// fails, or n.
    virtual int respond(int n, const Voigt* E, const double* state, Voigt* S, Voigt66* CC, double* trial) const = 0;
    /// Energies at n points whose history `state` belongs to the strain (it has been committed).
    virtual void energy(int n, const Voigt* E, const double* state, Energy* energies) const = 0;
};

template <MaterialLaw Law>
class MaterialOf final : public Material {
  public:
    explicit MaterialOf(Law law) : law_(std::move(law)) {}
    int state_size() const override { return Law::state_size; }
    void initial(double* state) const override { law_.initial(state); }
    LaneMask respond(int n, LaneMask wanted, const Vec<Lanes, 6>* E, const LaneStates& state, Vec<Lanes, 6>* S,
                     Mat<Lanes, 6, 6>* CC, const LaneTrials& trial) const override {
        std::array<Lanes, Law::state_size> before, after;
        for (int q = 0; q < n; ++q) {
            for (int k = 0; k < Law::state_size; ++k)
                before[k] = by_lane([&](int lane) { return state[lane][q * Law::state_size + k]; });
            wanted = wanted & law_.respond(E[q], before.data(), S[q], CC[q], after.data());
            for (int lane = 0; lane < lane_count; ++lane)
                for (int k = 0; k < Law::state_size; ++k) trial[lane][q * Law::state_size + k] = after[k][lane];
        }
        return wanted;
    }
    int respond(int n, const Voigt* E, const double* state, Voigt* S, Voigt66* CC, double* trial) const override {
        for (int first = 0; first < n; first += lane_count) {  // points instead of elements in the lanes
            const auto point = [&](int lane) { return std::min(first + lane, n - 1); };
            Vec<Lanes, 6> strain, stress;
            Mat<Lanes, 6, 6> tangent;
            LaneStates before;
            LaneTrials after;
            for (int p = 0; p < 6; ++p) strain[p] = by_lane([&](int lane) { return E[point(lane)][p]; });
            for (int lane = 0; lane < lane_count; ++lane) {
                before[lane] = state + point(lane) * Law::state_size;
                after[lane] = trial + point(lane) * Law::state_size;
            }
            const LaneMask answered = respond(1, true, &strain, before, &stress, &tangent, after);
            for (int q = first; q < std::min(first + lane_count, n); ++q) {
                if (!answered[q - first]) return q;
                for (int p = 0; p < 6; ++p) S[q][p] = stress[p][q - first];
                for (int i = 0; i < 36; ++i) CC[q].a[i] = tangent.a[i][q - first];
            }
        }
        return n;
    }
    void energy(int n, const Voigt* E, const double* state, Energy* energies) const override {
        for (int q = 0; q < n; ++q) energies[q] = law_.energy(E[q], state + q * Law::state_size);
    }

  private:
    Law law_;
};

/// A law from any function of arrays, a user's own for instance.
class MaterialFromFunction final : public Material {
  public:
    /// n, E [n][6], state [n][state_size] -> S [n][6], CC [n][36], trial [n][state_size]; the index of the first point
    /// that fails, or n.
    using Function = std::function<int(int, const Voigt*, const double*, Voigt*, Voigt66*, double*)>;

    /// n, E [n][6], state [n][state_size] -> energies [n]; may be empty, if they are not known.
    using EnergyFunction = std::function<void(int, const Voigt*, const double*, Energy*)>;

    MaterialFromFunction(Function function, std::vector<double> initial, EnergyFunction energy)
        : function_(std::move(function)), initial_(std::move(initial)), energy_(std::move(energy)) {}
    int state_size() const override { return static_cast<int>(initial_.size()); }
    void initial(double* state) const override { std::copy(initial_.begin(), initial_.end(), state); }
    LaneMask respond(int n, LaneMask wanted, const Vec<Lanes, 6>* E, const LaneStates& state, Vec<Lanes, 6>* S,
                     Mat<Lanes, 6, 6>* CC, const LaneTrials& trial) const override {
        std::vector<Voigt> strain(n), stress(n);
        std::vector<Voigt66> tangent(n);
        LaneMask answered = wanted;
        for (int lane = 0; lane < lane_count; ++lane) {  // one call an element
            if (!wanted[lane]) continue;
            for (int q = 0; q < n; ++q)
                for (int p = 0; p < 6; ++p) strain[q][p] = E[q][p][lane];
            answered.set(lane,
                         function_(n, strain.data(), state[lane], stress.data(), tangent.data(), trial[lane]) == n);
            for (int q = 0; q < n; ++q) {
                for (int p = 0; p < 6; ++p) S[q][p].set(lane, stress[q][p]);
                for (int i = 0; i < 36; ++i) CC[q].a[i].set(lane, tangent[q].a[i]);
            }
        }
        return answered;
    }
    int respond(int n, const Voigt* E, const double* state, Voigt* S, Voigt66* CC, double* trial) const override {
        return function_(n, E, state, S, CC, trial);
    }
    void energy(int n, const Voigt* E, const double* state, Energy* energies) const override {
        std::fill_n(energies, n, Energy{});
        if (energy_) energy_(n, E, state, energies);
    }

  private:
    Function function_;
    std::vector<double> initial_;
    EnergyFunction energy_;
};

}  // namespace umform
