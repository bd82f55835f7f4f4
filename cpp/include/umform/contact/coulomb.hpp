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
    double ratio;    // tangential stiffness over penalty of a place that the tool did not hold
    double allowed;  // elastic slip at the bound
    std::shared_ptr<const FrictionLaw> friction;

    static constexpr bool symmetric = false;
    static constexpr bool follows_places = true;
    static constexpr VariableTable table = ContactHistory::table.then({{"held"},
                                                                       {"place", 3},
                                                                       {"normal", 3},
                                                                       {"tangential traction", 3},
                                                                       {"tangential multiplier", 3},
                                                                       {"change of tangential multiplier", 3},
                                                                       {"slip"},
                                                                       {"friction work"},
                                                                       {"tangential stiffness"},
                                                                       {"friction work above the mean"},
                                                                       {"bound"}});
    enum {
        Multiplier = table["multiplier"],
        Held = table["held"],
        Where = table["place"],
        Normal = table["normal"],
        Traction = table["tangential traction"],
        Tangential = table["tangential multiplier"],
        Change = table["change of tangential multiplier"],
        Slip = table["slip"],
        Work = table["friction work"],
        Stiffness = table["tangential stiffness"],
        Above = table["friction work above the mean"],
        Limit = table["bound"]
    };

    double stiffness(const double* history) const { return std::max(penalty, history[Stiffness]); }
    double reach(const double* trial) const { return trial[Multiplier] / penalty; }

    /// The point is out of contact, at z in the frame of the tool.
    void leave(const Vec3& z, const double* state, double* trial) const {
        std::fill(trial + Held, trial + Change, 0.0);
        trial[Limit] = 0.0;
        put(trial + Where, z);
        trial[Slip] = state[Slip];
        trial[Stiffness] = ratio * penalty;
        add_work(state, trial, 0.0);
    }

    /// Resets the work of friction to that of the converged state: loads did the work since then.
    void forget_work(const double* state, double* trial) const { trial[Work] = state[Work]; }

    /// Writes the requested multipliers to the input history.
    void put_wanted(const double* trial, double* read) const {
        read[Multiplier] = trial[Multiplier];
        put(read + Change, at(trial + Change));
    }

    /// The requested multipliers are now those of the new history.
    void settle(double* trial) const { put(trial + Change, Vec3{}); }

    Rubbing rubbing(const double* history) const {
        const Vec3 t = at(history + Traction), lambda = at(history + Tangential);
        Vec3 elastic;
        for (int k = 0; k < 3; ++k) elastic[k] = (lambda[k] - t[k]) / tangential_stiffness(history);
        return {elastic, history[Slip], stored(history), history[Work], history[Above], tangential_stiffness(history)};
    }

    /// Requests the tangential part of a traction as the tangential multiplier. eq. (4.50)
    void augment(const Place& place, const Vec3& t, const double* state, double* trial) const {
        const Facing facing(place);
        const bool held = state[Held] != 0.0;
        const double normal = dot(facing.n, t);
        Vec3 along;
        for (int k = 0; k < 3; ++k) along[k] = t[k] - normal * facing.n[k];
        const Vec3 wanted = carried_back(place.pose, facing, along, at(state + Normal), held);
        for (int k = 0; k < 3; ++k) trial[Change + k] = wanted[k] - (held ? state[Tangential + k] : 0.0);
    }

    bool respond(const Place& place, const double* state, double* trial, Reaction& reaction) const {
        const double gap = place.gap - trial[Multiplier] / penalty;
        if (!(gap <= 0.0)) {
            leave(place.pose.to_tool(place.x), state, trial);
            return false;
        }
        press(place, -(penalty * gap), state, trial, reaction);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) reaction.K[i][j] += penalty * reaction.by_pressure[i] * place.n[j];
        return true;
    }

    void press(const Place& place, double pressure, const double* state, double* trial, Reaction& reaction) const {
        const Vec3 &n = place.n, z = place.pose.to_tool(place.x);
        const bool held = state[Held] != 0.0;
        const Facing facing(place);
        const Slide slide(place, facing, at(state + Where), held);
        const Carried before(place.pose, facing, sum(held ? at(state + Traction) : Vec3{}, at(trial + Change)),
                             at(state + Normal), held);
        const Bound bound = friction->bound(facing.scale * pressure, state[Slip] + slide.length, z);
        // Never softer than before, so that none of it gives energy back; the mean over the increment. eqs. (4.174), (4.242)
        const double eps_n = tangential_stiffness(state);
        const bool stiffens = bound.value > eps_n * allowed;
        const double mean = held ? 0.5 : 1.0;  // one that touches has no stiffness before
        const double eps_end = stiffens ? bound.value / allowed : eps_n, eps = eps_n + mean * (eps_end - eps_n);
        Vec3 trial_t, t, m{};
        for (int k = 0; k < 3; ++k) t[k] = trial_t[k] = before.value[k] - eps * slide.D[k];
        const double size = std::sqrt(dot(t, t));
        const bool slips = size > bound.value * (1.0 + round_off);
        const double part = slips ? bound.value / size : 1.0;
        if (slips)
            for (int k = 0; k < 3; ++k) m[k] = t[k] / size, t[k] = bound.value * m[k];

        // dt = dt_trial, or m ds + s/|t_trial| (1 - m m^T) dt_trial, at this pressure and by it. eq. (4.47)
        Vec3 d_stiff{}, by_pressure{};
        if (stiffens)
            for (int k = 0; k < 3; ++k) d_stiff[k] = -mean * slide.D[k] / allowed;
        const Vec3 d_scale = facing.scale == 1.0 ? Vec3{} : product(place.H, facing.n);
        const double s_of_p = bound.by_pressure * facing.scale;
        const auto returned = [&](const Vec3& d_trial, double ds) {
            Vec3 d = d_trial;
            if (!slips) return d;
            const double along = dot(m, d_trial);
            for (int k = 0; k < 3; ++k) d[k] = m[k] * ds + part * (d_trial[k] - m[k] * along);
            return d;
        };
        Mat3 dt;
        for (int j = 0; j < 3; ++j) {
            const double ds = bound.by_slip * slide.d_length(j) + bound.by_pressure * pressure * d_scale[j];
            Vec3 d_trial;
            for (int i = 0; i < 3; ++i) d_trial[i] = before.d(i, j) - eps * slide.d(i, j) + d_stiff[i] * ds;
            const Vec3 column = returned(d_trial, ds);
            for (int i = 0; i < 3; ++i) dt(i, j) = column[i];
        }
        for (int k = 0; k < 3; ++k) by_pressure[k] = d_stiff[k] * s_of_p;
        by_pressure = returned(by_pressure, s_of_p);
        reaction.slipping = slips;
        reaction.pressure = pressure;
        for (int i = 0; i < 3; ++i) {
            reaction.tangential[i] = t[i];
            reaction.by_pressure[i] = n[i] + by_pressure[i];
            for (int j = 0; j < 3; ++j) reaction.K[i][j] = -(pressure * place.H(i, j) + dt(i, j));
        }
        trial[Stiffness] = eps_end;
        trial[Limit] = bound.value;
        double above = 0.0;
        if (held && slips) {
            const Vec3 t_n = Carried(place.pose, facing, at(state + Traction), at(state + Normal), true).value;
            above = 0.5 * (onset(t_n, state[Limit], trial_t, bound.value) - dot(t_n, m)) * (size - bound.value) / eps;
        }
        remember(place.pose, facing, z, t, slide.length, above, state, trial);
    }

  private:
    /// A traction that a converged state left at its bound, and that has been carried since, differs from it by so much. eq. (4.180)
    static constexpr double round_off = 1e-12;

    double tangential_stiffness(const double* history) const {
        return history[Held] != 0.0 ? history[Stiffness] : ratio * penalty;
    }
    static Vec3 at(const double* history) { return {history[0], history[1], history[2]}; }
    static void put(double* history, const Vec3& value) { std::copy(value.begin(), value.end(), history); }
    static Vec3 sum(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

    /// Energy of the elastic slip, (t^2 - lambda^2) / (2 stiffness) per area.
    double stored(const double* history) const {
        const Vec3 t = at(history + Traction), lambda = at(history + Tangential);
        return 0.5 * (dot(t, t) - dot(lambda, lambda)) / tangential_stiffness(history);
    }

    /// Bound at which slip begins: on the way from t_n within its bound s_n to t beyond its bound s, both of which change linearly, the
    /// root a in [0, 1] of |t_n + a (t - t_n)| = s_n + a (s - s_n). eq. (4.220)
    static double onset(const Vec3& t_n, double s_n, const Vec3& t, double s) {
        const Vec3 dt{t[0] - t_n[0], t[1] - t_n[1], t[2] - t_n[2]};
        const double ds = s - s_n, A = dot(dt, dt) - ds * ds, B = s_n * ds - dot(t_n, dt),
                     C = s_n * s_n - dot(t_n, t_n);
        const double root = std::sqrt(std::max(B * B + A * C, 0.0));
        const double a = B > 0.0 ? (B + root) / A : root > B ? C / (root - B) : 0.0;
        return s_n + std::clamp(a, 0.0, 1.0) * ds;
    }

    /// The new history.
    void remember(const Pose& pose, const Facing& facing, const Vec3& z, const Vec3& t, double length, double above,
                  const double* state, double* trial) const {
        const bool held = state[Held] != 0.0;
        const Carried lambda(pose, facing, sum(at(state + Tangential), at(trial + Change)), at(state + Normal), held);
        trial[Held] = 1.0;
        put(trial + Where, z);
        put(trial + Normal, pose.turn_back(facing.n));
        put(trial + Traction, pose.turn_back(t));
        put(trial + Tangential, pose.turn_back(lambda.value));
        trial[Slip] = state[Slip] + length;
        add_work(state, trial, above);
    }

    /// Work of the mean traction along the way in the frame of the tool, whether it holds the place at both ends or at one, less
    /// what is stored; and what the mean misses. eqs. (4.49), (4.220)
    /// Not inlined: places near the tool and far from it get the same bits.
    [[gnu::noinline]] void add_work(const double* state, double* trial, double above) const {
        double work = above - stored(trial) + stored(state);
        for (int k = 0; k < 3; ++k)
            work -= 0.5 * (state[Traction + k] + trial[Traction + k]) * (trial[Where + k] - state[Where + k]);
        trial[Work] = state[Work] + work;
        trial[Above] = state[Above] + above;
    }
};

}  // namespace umform
