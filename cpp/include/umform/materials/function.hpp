// A law from any function of arrays, a user's own for instance.
#pragma once

#include <functional>
#include <vector>

#include "umform/materials/concept.hpp"

namespace umform {

/// Arguments of a function: n points of one element.
struct FunctionArguments {
    int n;
    const Voigt* E;            // [n]
    const double* state;       // [n][state_size]
    const Axes<double>* axes;  // [n], or null if it does not need its points
    double size, step;
    std::int32_t cell;  // number of the element, or -1 outside of elements
};

/// What it is to fill: arrays are [n], the new history [n][state_size].
struct FunctionAnswer {
    Voigt* S;
    Voigt66* CC;
    double* trial;
};

class MaterialFromFunction final : public Material {
  public:
    /// Returns the index of the first point that fails, or n.
    using Function = std::function<int(const FunctionArguments&, const FunctionAnswer&)>;
    /// n, E [n], state [n][state_size], number of the element -> energies [n]; may be empty, if they are not known.
    using EnergyFunction = std::function<void(int, const Voigt*, const double*, Energy*, std::int32_t)>;

    struct Traits {
        std::vector<HistoryVariable> state;
        std::vector<double> initial;
        bool symmetric = true, sees_points = false;
    };

    MaterialFromFunction(Function function, Traits traits, EnergyFunction energy)
        : function_(std::move(function)), traits_(std::move(traits)), energy_(std::move(energy)) {}

    std::vector<HistoryVariable> history_variables() const override { return traits_.state; }
    int state_size() const override { return static_cast<int>(traits_.initial.size()); }
    void initial(double* state) const override { std::copy(traits_.initial.begin(), traits_.initial.end(), state); }
    bool symmetric() const override { return traits_.symmetric; }
    bool sees_points() const override { return traits_.sees_points; }

    LaneMask respond(int n, LaneMask wanted, const Vec<Lanes, 6>* E, const LaneStates& state, Vec<Lanes, 6>* S,
                     Mat<Lanes, 6, 6>* CC, const LaneTrials& trial, const LanePoints& points) const override {
        std::vector<Voigt> strain(n), stress(n);
        std::vector<Voigt66> tangent(n);
        std::vector<Axes<double>> axes(traits_.sees_points ? n : 0);
        LaneMask answered = wanted;
        for (int lane = 0; lane < lane_count; ++lane) {  // one call an element
            if (!wanted[lane]) continue;
            for (int q = 0; q < n; ++q)
                for (int p = 0; p < 6; ++p) strain[q][p] = E[q][p][lane];
            for (std::size_t q = 0; q < axes.size(); ++q)
                for (int i = 0; i < 3; ++i)
                    for (int k = 0; k < 3; ++k) axes[q][i][k] = points.axes[q][i][k][lane];
            const FunctionArguments at{
                n,           strain.data(),    state[lane], axes.empty() ? nullptr : axes.data(), points.size[lane],
                points.step, points.cell[lane]};
            answered.set(lane, function_(at, {stress.data(), tangent.data(), trial[lane]}) == n);
            for (int q = 0; q < n; ++q) {
                for (int p = 0; p < 6; ++p) S[q][p].set(lane, stress[q][p]);
                for (int i = 0; i < 36; ++i) CC[q].a[i].set(lane, tangent[q].a[i]);
            }
        }
        return answered;
    }

    int respond(int n, const Voigt* E, const double* state, Voigt* S, Voigt66* CC, double* trial,
                const Point<double>& point) const override {
        const std::vector<Axes<double>> axes(traits_.sees_points ? n : 0, point.axes);
        const Axes<double>* given = traits_.sees_points ? axes.data() : nullptr;
        return function_({n, E, state, given, point.size, point.step, -1}, {S, CC, trial});
    }

    void energy(int n, const Voigt* E, const double* state, Energy* energies, std::int32_t cell) const override {
        std::fill_n(energies, n, Energy{});
        if (energy_) energy_(n, E, state, energies, cell);
    }

  private:
    Function function_;
    Traits traits_;
    EnergyFunction energy_;
};

}  // namespace umform
