// Contact whose pressure follows from the gap by a law of a user; across the normal it is that of a law of umform.
#pragma once

#include <memory>
#include <vector>

#include "umform/contact/concept.hpp"
#include "umform/contact/normal_law.hpp"

namespace umform {

/// `Across` is Penalty or Coulomb: its `press` answers at a pressure that is given. Its penalty is a measure of the stiffness; what it is over
/// that of the beginning scales the pressures, for continuation from a soft tool. eqs. (4.280), (4.282)
template <class Across>
struct OwnPressure : Across {
    std::shared_ptr<const NormalLaw> normal;
    double nominal;

    OwnPressure(Across across, std::shared_ptr<const NormalLaw> law)
        : Across(std::move(across)), normal(std::move(law)), nominal(this->penalty) {}

    double scale() const { return this->penalty / nominal; }
    double reach(const double*) const { return normal->reach(); }

    bool respond(const Place& place, const double* state, double* trial, Reaction& reaction) const {
        const Places places{&place.gap, &place.x, &place.n, &place.H, &place.pose};
        respond_all(1, places, {state, trial, 0, 0}, &reaction);
        return reaction.held;
    }

    /// All places of a facet: one call of the law. K has the part -dp/dg dt/dp (x) n.
    void respond_all(int count, const Places& places, const HistoryRows& rows, Reaction* reactions) const {
        std::vector<double> gap, pressure, slope;
        for (int q = 0; q < count; ++q)
            if (places.gap[q] <= normal->reach()) gap.push_back(places.gap[q]);
        pressure.resize(gap.size()), slope.resize(gap.size());
        normal->pressures(static_cast<int>(gap.size()), gap.data(), pressure.data(), slope.data());
        int held = 0;
        for (int q = 0; q < count; ++q) {
            const Place place = places[q];
            const double* state = rows.state + q * rows.size;
            double* trial = rows.trial + q * rows.size;
            Reaction& reaction = reactions[q];
            reaction.held = place.gap <= normal->reach();
            if (!reaction.held) {
                if constexpr (Across::follows_places) this->leave(place.pose.to_tool(place.x), state, trial);
                continue;
            }
            const double p = scale() * pressure[held], dp = scale() * slope[held];
            ++held;
            this->press(place, p, state, trial, reaction);
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) reaction.K[i][j] -= dp * reaction.by_pressure[i] * place.n[j];
        }
    }
};

}  // namespace umform
