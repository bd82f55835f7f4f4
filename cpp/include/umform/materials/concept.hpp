// What a material law is to the elements: strain and history in, stress, tangent and new history out; and energies.
#pragma once

#include <algorithm>
#include <concepts>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "umform/tensor.hpp"

namespace umform {

/// Energies per reference volume: what is stored in elastic strains, and the plastic work done so far (dissipation, and
/// what hardening keeps). NaN where a law does not know them.
struct Energy {
    double elastic = std::numeric_limits<double>::quiet_NaN();
    double plastic = std::numeric_limits<double>::quiet_NaN();
};

/// A law answers at one point. `E` is the Green-Lagrange strain in a local orthonormal frame, `state` the converged
/// history (never changed), `trial` the new one. It returns false where the strain is outside of its domain.
template <class L>
concept MaterialLaw =
    requires(const L& law, const Voigt& E, const double* state, Voigt& S, Voigt66& CC, double* trial) {
        { L::state_size } -> std::convertible_to<int>;
        { law.respond(E, state, S, CC, trial) } -> std::same_as<bool>;
        { law.initial(trial) } -> std::same_as<void>;
        { law.energy(E, state) } -> std::same_as<Energy>;
    };

/// The law as the elements see it: one virtual call for all points of an element, so that elements and laws are
/// compiled apart from each other.
class Material {
  public:
    virtual ~Material() = default;
    virtual int state_size() const = 0;
    virtual void initial(double* state) const = 0;
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
    int respond(int n, const Voigt* E, const double* state, Voigt* S, Voigt66* CC, double* trial) const override {
        for (int q = 0; q < n; ++q)
            if (!law_.respond(E[q], state + q * Law::state_size, S[q], CC[q], trial + q * Law::state_size)) return q;
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

/// Adds factor * a (x) b to a tangent; a and b hold tensor components (no engineering factors).
inline void add_dyad(Voigt66& CC, double factor, const Voigt& a, const Voigt& b) {
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) CC(i, j) += factor * a[i] * b[j];
}

}  // namespace umform
