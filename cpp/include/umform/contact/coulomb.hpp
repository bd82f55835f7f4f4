// Contact with friction: penalty and multipliers along the normal, return to the bound of friction across it.
#pragma once

#include <memory>

#include "umform/contact/friction.hpp"
#include "umform/contact/slide.hpp"

namespace umform {

/// The tangential traction of the converged state is carried to the place; a way along the tool adds to it with the tangential
/// stiffness; what is more than the bound slips. All that is remembered is in the frame of the tool. eqs. (4.43) to (4.47)
struct Coulomb {
    double penalty;
    double ratio;  // tangential stiffness over penalty
    std::shared_ptr<const FrictionLaw> friction;

    static constexpr bool symmetric = false;
    static constexpr bool follows_places = true;
    static std::vector<Quantity> quantities() {
        return {{"multiplier", 1},
                {"held", 1},
                {"place", 3},
                {"normal", 3},
                {"tangential traction", 3},
                {"tangential multiplier", 3},
                {"change of tangential multiplier", 3},
                {"slip", 1},
                {"friction work", 1}};
    }

    double stiffness() const { return penalty * std::max(1.0, ratio); }
    double reach(const double* trial) const { return trial[Multiplier] / penalty; }

    /// The tool does not hold the place, which is at z in its frame.
    void leave(const Vec3& z, const double* state, double* trial) const {
        std::fill(trial + Held, trial + Change, 0.0);
        put(trial + Where, z);
        trial[Slip] = state[Slip], trial[Work] = state[Work];
    }

    /// Puts the multipliers that were wanted into the history that was read.
    void put_wanted(const double* trial, double* read) const {
        read[Multiplier] = trial[Multiplier];
        put(read + Change, at(trial + Change));
    }

    /// The multipliers wanted have become those of the new history.
    void settle(double* trial) const { put(trial + Change, Vec3{}); }

    Rubbing rubbing(const double* history) const {
        const Vec3 t = at(history + Traction), lambda = at(history + Tangential);
        Vec3 elastic;
        for (int k = 0; k < 3; ++k) elastic[k] = (lambda[k] - t[k]) / tangential_stiffness();
        return {elastic, history[Slip], stored(history), history[Work]};
    }

    /// Lets multipliers carry a traction at a place that is held, as far as it points along the tool. eq. (4.50)
    void augment(const Place& place, const Vec3& t, const double* state, double* trial) const {
        const Facing facing(place);
        const bool held = state[Held] != 0.0;
        const double normal = dot(facing.n, t);
        Vec3 along;
        for (int k = 0; k < 3; ++k) along[k] = t[k] - normal * facing.n[k];
        const Vec3 wanted = carried_back(place.pose, facing, along, at(state + Normal), held);
        for (int k = 0; k < 3; ++k) trial[Change + k] = wanted[k] - (held ? state[Tangential + k] : 0.0);
    }

    bool respond(const Place& place, double weight, const double* state, double* trial, Reaction& reaction) const {
        const double gap = place.gap - trial[Multiplier] / penalty;
        if (!(gap <= 0.0)) {
            leave(place.pose.to_tool(place.x), state, trial);
            return false;
        }
        press(place, -(penalty * gap), weight, state, trial, reaction);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) reaction.K[i][j] += penalty * reaction.by_pressure[i] * place.n[j];
        return true;
    }

    void press(const Place& place, double pressure, double weight, const double* state, double* trial,
               Reaction& reaction) const {
        const Vec3 &n = place.n, z = place.pose.to_tool(place.x);
        const bool held = state[Held] != 0.0;
        const double eps = tangential_stiffness();
        const Facing facing(place);
        const Slide slide(place, facing, at(state + Where), held);
        const Carried before(place.pose, facing, sum(held ? at(state + Traction) : Vec3{}, at(trial + Change)),
                             at(state + Normal), held);
        Vec3 t, m{};
        for (int k = 0; k < 3; ++k) t[k] = before.value[k] - eps * slide.D[k];
        const double size = std::sqrt(dot(t, t));
        const Bound bound = friction->bound(facing.scale * pressure, state[Slip] + slide.length, z);
        const bool slips = size > bound.value;
        const double part = slips ? bound.value / size : 1.0;
        if (slips)
            for (int k = 0; k < 3; ++k) m[k] = t[k] / size, t[k] = bound.value * m[k];

        // At this pressure dt = dt_trial, or m ds + s/|t_trial| (1 - m m^T) dt_trial. eq. (4.47)
        Mat3 dt;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) dt(i, j) = before.d(i, j) - eps * slide.d(i, j);
        if (slips) {
            const Vec3 d_scale = facing.scale == 1.0 ? Vec3{} : product(place.H, facing.n);
            for (int j = 0; j < 3; ++j) {
                const double dp = pressure * d_scale[j];
                const double ds = bound.by_slip * slide.d_length(j) + bound.by_pressure * dp;
                const double along = m[0] * dt(0, j) + m[1] * dt(1, j) + m[2] * dt(2, j);
                for (int i = 0; i < 3; ++i) dt(i, j) = m[i] * ds + part * (dt(i, j) - m[i] * along);
            }
        }
        reaction.slipping = slips;
        reaction.pressure = weight * pressure;
        for (int i = 0; i < 3; ++i) {
            reaction.tangential[i] = weight * t[i];
            reaction.by_pressure[i] = weight * (n[i] + (slips ? bound.by_pressure * facing.scale * m[i] : 0.0));
            for (int j = 0; j < 3; ++j) reaction.K[i][j] = -weight * (pressure * place.H(i, j) + dt(i, j));
        }
        remember(place.pose, facing, z, t, slide, state, trial);
    }

  private:
    /// Where in the history each of the quantities begins.
    enum Part {
        Multiplier = 0,
        Held = 1,
        Where = 2,
        Normal = 5,
        Traction = 8,
        Tangential = 11,
        Change = 14,
        Slip = 17,
        Work = 18
    };

    double tangential_stiffness() const { return ratio * penalty; }
    static Vec3 at(const double* history) { return {history[0], history[1], history[2]}; }
    static void put(double* history, const Vec3& value) { std::copy(value.begin(), value.end(), history); }
    static Vec3 sum(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

    /// Energy of the elastic slip, (t^2 - lambda^2) / (2 stiffness) per area.
    double stored(const double* history) const {
        const Vec3 t = at(history + Traction), lambda = at(history + Tangential);
        return 0.5 * (dot(t, t) - dot(lambda, lambda)) / tangential_stiffness();
    }

    /// The new history. The work of friction is that of the mean traction along the way, less what is stored. eq. (4.49)
    void remember(const Pose& pose, const Facing& facing, const Vec3& z, const Vec3& t, const Slide& slide,
                  const double* state, double* trial) const {
        const bool held = state[Held] != 0.0;
        const Carried t_n(pose, facing, at(state + Traction), at(state + Normal), held);
        const Carried lambda(pose, facing, sum(at(state + Tangential), at(trial + Change)), at(state + Normal), held);
        trial[Held] = 1.0;
        put(trial + Where, z);
        put(trial + Normal, pose.turn_back(facing.n));
        put(trial + Traction, pose.turn_back(t));
        put(trial + Tangential, pose.turn_back(lambda.value));
        double work = 0.0;
        for (int k = 0; k < 3; ++k) work -= 0.5 * ((held ? t_n.value[k] : 0.0) + t[k]) * slide.D[k];
        trial[Slip] = state[Slip] + slide.length;
        trial[Work] = state[Work] + work - (stored(trial) - (held ? stored(state) : 0.0));
    }
};

}  // namespace umform
