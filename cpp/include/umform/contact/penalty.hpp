// Frictionless contact by penalty and multipliers.
#pragma once

#include "umform/contact/concept.hpp"

namespace umform {

/// Pressure <multiplier - penalty * gap>. The multiplier is the pressure at zero penetration, zero or more.
struct Penalty {
    double penalty;

    static constexpr bool symmetric = true, follows_places = false;
    static constexpr VariableTable table = ContactHistory::table;

    double stiffness(const double*) const { return penalty; }
    double reach(const double* trial) const { return trial[ContactHistory::Multiplier] / penalty; }

    /// A place is held where its gap less multiplier over penalty, g~, is not positive (a tool that just touches can hold):
    /// traction -penalty g~ n, K = penalty (n n^T + g~ H). eqs. (4.6), (4.10), (4.33)
    bool respond(const Place& place, const double*, const double* trial, Reaction& reaction) const {
        if (!(gap(place, trial) <= 0.0)) return false;
        hold(place, trial, reaction);
        return true;
    }

    /// The same at any gap.
    void hold(const Place& place, const double* trial, Reaction& reaction) const {
        const double g = gap(place, trial);
        reaction.slipping = false;
        reaction.pressure = -(penalty * g);
        reaction.tangential = {0.0, 0.0, 0.0};
        for (int k = 0; k < 3; ++k)
            for (int l = 0; l < 3; ++l)
                reaction.K[k][l] = penalty * std::fma(place.n[k], place.n[l], g * place.H(k, l));
    }

    /// Traction p n, which turns with the place by -p H.
    void press(const Place& place, double pressure, const double*, double*, Reaction& reaction) const {
        reaction.slipping = false;
        reaction.pressure = pressure;
        reaction.tangential = {0.0, 0.0, 0.0};
        for (int k = 0; k < 3; ++k) {
            reaction.by_pressure[k] = place.n[k];
            for (int l = 0; l < 3; ++l) reaction.K[k][l] = -pressure * place.H(k, l);
        }
    }

  private:
    double gap(const Place& place, const double* trial) const { return place.gap - reach(trial); }
};

}  // namespace umform
