// Any small-strain law at finite strain: it is evaluated with logarithmic strains. docs/theory, 3.9
#pragma once

#include <cstdint>

#include "umform/materials/concept.hpp"
#include "umform/materials/logarithmic_strain.hpp"

namespace umform {

class LogarithmicSpace final : public Material {
  public:
    explicit LogarithmicSpace(std::shared_ptr<const Material> law) : law_(std::move(law)) {}

    std::vector<HistoryVariable> history_variables() const override { return law_->history_variables(); }
    int state_size() const override { return law_->state_size(); }
    void initial(double* state) const override { law_->initial(state); }
    bool symmetric() const override { return law_->symmetric(); }
    bool sees_points() const override { return law_->sees_points(); }
    std::uint64_t staged_returns() const override { return law_->staged_returns(); }

    LaneMask respond(int n, LaneMask wanted, const Vec<Lanes, 6>* E, const LaneStates& state, Vec<Lanes, 6>* S,
                     Mat<Lanes, 6, 6>* CC, const LaneTrials& trial, const LanePoints& points) const override {
        std::array<LogarithmicStrain<Lanes>, chunk> strains;
        std::array<Vec<Lanes, 6>, chunk> h, T;
        std::array<Mat<Lanes, 6, 6>, chunk> C;
        for (int first = 0; first < n; first += chunk) {
            const int count = std::min(chunk, n - first);
            for (int q = 0; q < count; ++q) {
                const LaneMask positive = strains[q].set(E[first + q]);
                wanted = wanted & positive;
                // A failed lane is evaluated at zero strain, which is valid for every law. Unused lanes repeat others.
                for (int p = 0; p < 6; ++p) h[q][p] = select(positive, strains[q].h[p], 0.0);
            }
            LaneStates before = state;
            LaneTrials after = trial;
            LanePoints here = points;
            for (int lane = 0; lane < lane_count; ++lane) {
                before[lane] += first * law_->state_size();
                after[lane] += first * law_->state_size();
            }
            if (here.axes != nullptr) here.axes += first;
            wanted = wanted & law_->respond(count, wanted, h.data(), before, T.data(), C.data(), after, here);
            for (int q = 0; q < count; ++q) strains[q].pull_back(T[q], C[q], symmetric(), S[first + q], CC[first + q]);
        }
        return wanted;
    }

    int respond(int n, const Voigt* E, const double* state, Voigt* S, Voigt66* CC, double* trial,
                const Point<double>& point) const override {
        std::vector<LogarithmicStrain<double>> strains(n);
        std::vector<Voigt> h(n), T(n);
        std::vector<Voigt66> C(n);
        for (int q = 0; q < n; ++q) {
            if (!strains[q].set(E[q])) return q;
            h[q] = strains[q].h;
        }
        const int done = law_->respond(n, h.data(), state, T.data(), C.data(), trial, point);
        for (int q = 0; q < done; ++q) strains[q].pull_back(T[q], C[q], symmetric(), S[q], CC[q]);
        return done;
    }

    void energy(int n, const Voigt* E, const double* state, Energy* energies, std::int32_t cell) const override {
        for (int q = 0; q < n; ++q) {
            LogarithmicStrain<double> strain;
            energies[q] = {};
            if (strain.set(E[q])) law_->energy(1, &strain.h, state + q * state_size(), energies + q, cell);
        }
    }

  private:
    static constexpr int chunk = 8;  // points that are held at a time: their arrays stay in the cache

    std::shared_ptr<const Material> law_;
};

}  // namespace umform
