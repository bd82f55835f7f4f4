// A draw bead that is replaced by what it does: a force per length of a line that holds the sheet back, and one that lifts it.
#pragma once

#include <memory>

#include "umform/contact/bead_line.hpp"
#include "umform/contact/slide.hpp"

namespace umform {

/// Within a band along the line the tool holds a place back across the line by up to s = restraint W, independent of the pressure, and
/// pushes it away by uplift W; W = hat(d / b) / b has the integral one across the band. The traction is -s phi c: phi, between -1 and
/// 1, is the share of the bound that a way across the line has called up; it follows the way within the elastic slip. eqs. (4.101) to (4.106)
struct Bead {
    double penalty;            // largest traction per way
    double restraint, uplift;  // forces per length
    double half_width, slip;   // of the band; elastic
    double off;                // gap at which the bead does nothing any more
    std::shared_ptr<const BeadLine> line;

    Bead(std::shared_ptr<const BeadLine> line, double half_width, double restraint, double uplift, double slip,
         double off)
        : penalty(0.9375 / half_width * (restraint / slip + 2.0 * uplift / std::min(half_width, off))),
          restraint(restraint), uplift(uplift), half_width(half_width), slip(slip), off(off), line(std::move(line)) {}

    static constexpr bool symmetric = false;
    static constexpr bool follows_places = true;
    /// The multiplier is always zero.
    static constexpr VariableTable table = ContactHistory::table.then({{"held"},
                                                                       {"place", 3},
                                                                       {"share"},
                                                                       {"traction", 3},
                                                                       {"lift", 3},
                                                                       {"stored"},
                                                                       {"slip"},
                                                                       {"work"},
                                                                       {"work of the lift"},
                                                                       {"work above the mean"},
                                                                       {"bound"}});
    enum {
        Held = table["held"],
        Where = table["place"],
        Share = table["share"],
        Traction = table["traction"],
        Lift = table["lift"],
        Stored = table["stored"],
        Slip = table["slip"],
        Work = table["work"],
        LiftWork = table["work of the lift"],
        Above = table["work above the mean"],
        Limit = table["bound"]
    };

    double stiffness(const double*) const { return penalty; }
    double reach(const double*) const { return off; }

    /// The place, at z in the frame of the tool, is beside the band or off the tool.
    void leave(const Vec3& z, const double* state, double* trial) const {
        std::fill(trial + Held, trial + Slip, 0.0);
        trial[Slip] = state[Slip];
        trial[Limit] = 0.0;
        put(trial + Where, z);
        add_work(state, trial, 0.0);
    }

    /// What has happened since the converged state was the work of loads.
    void forget_work(const double* state, double* trial) const {
        trial[Work] = state[Work], trial[LiftWork] = state[LiftWork];
    }

    void put_wanted(const double*, double*) const {}
    void augment(const Place&, const Vec3&, const double*, double*) const {}
    void settle(double*) const {}

    Rubbing rubbing(const double* history) const {
        Vec3 elastic = at(history + Traction);
        const double size = std::sqrt(dot(elastic, elastic));
        for (double& value : elastic) value *= size > 0.0 ? -slip * std::abs(history[Share]) / size : 0.0;
        return {elastic, history[Slip], history[Stored] + history[LiftWork], history[Work], history[Above]};
    }

    bool respond(const Place& place, const double* state, double* trial, Reaction& reaction) const {
        const Vec3 z = place.pose.to_tool(place.x);
        const Facing facing(place);
        const Band band(*this, place, facing, z);
        if (!(band.weight > 0.0)) {
            leave(z, state, trial);
            return false;
        }
        const bool held = state[Held] != 0.0;
        const Place near{place.gap - off, place.x, place.n, place.H, place.pose};  // it touches where the bead begins
        const Slide slide(near, facing, at(state + Where), held);
        const double wanted = (held ? state[Share] : 0.0) + dot(band.c, slide.D) / slip;
        const double share = std::clamp(wanted, -1.0, 1.0);
        const bool slips = share != wanted;
        const double s = restraint * band.weight, p = uplift * band.weight;

        for (int j = 0; j < 3; ++j) {
            double d_share = 0.0;
            for (int k = 0; !slips && k < 3; ++k)
                d_share += (band.dc(k, j) * slide.D[k] + band.c[k] * slide.d(k, j)) / slip;
            const double along = restraint * band.d_weight[j] * share + s * d_share;
            for (int i = 0; i < 3; ++i)
                reaction.K[i][j] = along * band.c[i] + s * share * band.dc(i, j)
                                   - uplift * band.d_weight[j] * facing.n[i] - p * facing.dn(i, j);
        }
        reaction.slipping = slips;
        reaction.pressure = p / facing.scale;
        Vec3& traction = reaction.tangential;
        Vec3 lift;
        for (int i = 0; i < 3; ++i) traction[i] = -s * share * band.c[i], lift[i] = p * facing.n[i];
        trial[Held] = 1.0;
        put(trial + Where, z);
        trial[Share] = share;
        put(trial + Traction, place.pose.turn_back(traction));
        put(trial + Lift, place.pose.turn_back(lift));
        trial[Stored] = 0.5 * s * slip * share * share;
        trial[Slip] = state[Slip] + std::abs(dot(band.c, slide.D));
        double above = 0.0;
        if (held && slips) {
            const Vec3 t_n = at(state + Traction);
            const double before = std::sqrt(dot(t_n, t_n)), irreversible = slip * std::abs(wanted - share);
            const double a = (share - state[Share]) / (wanted - state[Share]);  // of the way, where slip begins
            const double onset = state[Limit] + a * (s - state[Limit]);
            above = 0.5 * (onset - std::copysign(before, state[Share] * share)) * irreversible;
        }
        trial[Limit] = s;
        add_work(state, trial, above);
        return true;
    }

  private:
    static Vec3 at(const double* history) { return {history[0], history[1], history[2]}; }
    static void put(double* history, const Vec3& value) { std::copy(value.begin(), value.end(), history); }

    /// How a place lies to the line: W and the direction across, along the tool, with their derivatives.
    struct Band {
        double weight = 0.0;
        Vec3 c, d_weight;
        Mat3 dc;  // dc_i/dx_j

        Band(const Bead& bead, const Place& place, const Facing& facing, const Vec3& z) {
            const double fade = std::max(2.0 * place.gap / bead.off - 1.0, 0.0);
            if (!(fade < 1.0)) return;
            const Foot foot = bead.line->foot(z, bead.off);
            if (!foot.within || !(foot.end > 0.0)) return;
            const Vec3 r = place.pose.turn(foot.offset), S = place.pose.turn(foot.along), &n = facing.n;
            const double b = bead.half_width, above = dot(n, r);
            const double w = 1.0 - (dot(r, r) - above * above) / (b * b);
            if (!(w > 0.0)) return;
            const double hat = 0.9375 * w * w, near = 1.0 - fade * fade * (3.0 - 2.0 * fade);
            weight = hat * foot.end * near / b;
            const double d_near = -12.0 * fade * (1.0 - fade) / bead.off;
            for (int j = 0; j < 3; ++j) {
                const double in_line = foot.moves ? S[j] : 0.0;
                double d_above = n[j] - dot(n, S) * in_line;
                for (int k = 0; k < 3; ++k) d_above += facing.dn(k, j) * r[k];
                const double d_square = 2.0 * (r[j] - dot(r, S) * in_line - above * d_above);
                d_weight[j] = (-1.875 * w / (b * b) * d_square * foot.end * near + hat * foot.d_end * in_line * near
                               + hat * foot.end * d_near * place.n[j])
                              / b;
            }
            set_direction(place.pose.turn(foot.tangent), place.pose.turn(foot.turn), foot.moves ? S : Vec3{}, facing);
        }

        /// c = T x n / |T x n| with the tangent T, which turns along S.
        void set_direction(const Vec3& T, const Vec3& turn, const Vec3& S, const Facing& facing) {
            const Vec3 across = cross(T, facing.n);
            const double length = std::sqrt(dot(across, across));
            if (!(length > least)) {
                weight = 0.0;
                return;
            }
            for (int k = 0; k < 3; ++k) c[k] = across[k] / length;
            for (int j = 0; j < 3; ++j) {
                const Vec3 dT{turn[0] * S[j], turn[1] * S[j], turn[2] * S[j]};
                const Vec3 dn{facing.dn(0, j), facing.dn(1, j), facing.dn(2, j)};
                const Vec3 first = cross(dT, facing.n), second = cross(T, dn);
                const Vec3 change{first[0] + second[0], first[1] + second[1], first[2] + second[2]};
                const double in_line = dot(c, change);
                for (int i = 0; i < 3; ++i) dc(i, j) = (change[i] - in_line * c[i]) / length;
            }
        }

        /// Sine of the angle between line and normal; a line that leaves the tool so steeply has no across.
        static constexpr double least = 0.1;
    };

    /// Work of both tractions by their mean along the way in the frame of the tool, less what is stored, and what the mean misses.
    /// eqs. (4.106), (4.220)
    /// Not inlined: places near the tool and far from it get the same bits.
    [[gnu::noinline]] void add_work(const double* state, double* trial, double above) const {
        double across = above, up = 0.0;
        for (int k = 0; k < 3; ++k) {
            const double way = trial[Where + k] - state[Where + k];
            across -= 0.5 * (state[Traction + k] + trial[Traction + k]) * way;
            up -= 0.5 * (state[Lift + k] + trial[Lift + k]) * way;
        }
        trial[Work] = state[Work] + across - (trial[Stored] - state[Stored]);
        trial[LiftWork] = state[LiftWork] + up;
        trial[Above] = state[Above] + above;
    }
};

}  // namespace umform
