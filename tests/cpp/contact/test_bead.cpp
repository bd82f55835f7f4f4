// An equivalent draw bead at one place: the works of restraint and lift, and what they are in few increments.
#include "check.hpp"
#include "umform/contact/bead.hpp"

using namespace umform;

namespace {

constexpr int numbers = Bead::table.size();
constexpr double restraint = 30.0, uplift = 12.0, half_width = 2.0, slip = 0.01, off = 0.5;

/// A line along y on the plane z = 0 of a tool in any pose, and a place that goes about it.
struct Rig {
    Bead bead{std::make_shared<BeadLine>(std::vector<Vec3>{{0.0, -9.0, 0.0}, {0.0, 9.0, 0.0}}, false, half_width),
              half_width,
              restraint,
              uplift,
              slip,
              off};
    double state[numbers]{};

    explicit Rig(const Vec3& from) { bead.leave(from, state, state); }

    Reaction at(const Vec3& z, const Pose& pose = {}) {
        const Vec3 n = pose.turn(Vec3{0.0, 0.0, 1.0}), x = pose.to_space(z);
        double trial[numbers]{};
        Reaction reaction{};
        reaction.held = bead.respond({z[2], x, n, Mat3{}, pose}, state, trial, reaction);
        std::copy_n(trial, numbers, state);
        return reaction;
    }
    void draw(double from, double to, int increments) {
        for (int i = 1; i <= increments; ++i) at({from + (to - from) * i / increments, 0.0, 0.0});
    }
};

/// W where the band is fully active.
double weight(double x) {
    const double w = 1.0 - x * x / (half_width * half_width);
    return w > 0.0 ? 0.9375 * w * w / half_width : 0.0;
}

/// Drawn across the whole band it costs the restraint times the way, whether the place is in the band at the end or not.
void check_across() {
    double errors[2];
    for (const int i : {0, 1}) {
        Rig rig({-3.0, 0.0, 0.0});
        rig.draw(-3.0, 3.0, i == 0 ? 20 : 40);
        CHECK(rig.state[Bead::Held] == 0.0 && rig.state[Bead::Stored] == 0.0);
        CHECK_NEAR(rig.state[Bead::LiftWork], 0.0, 1e-14);
        errors[i] = std::abs(rig.state[Bead::Work] - restraint);
    }
    CHECK(errors[0] < 2e-3 * restraint && errors[1] < 0.5 * errors[0]);
}

/// In the middle of the band: the bound times the way less the elastic slip, in one increment or in many; and back.
void check_within() {
    for (const int increments : {1, 4}) {
        Rig rig({0.2, 0.0, 0.0});
        rig.at({0.2, 0.0, 0.0});
        rig.draw(0.2, -0.2, increments);
        rig.draw(-0.2, 0.2, 1);
        CHECK_NEAR(rig.state[Bead::Slip], 0.8, 1e-14);
        CHECK_NEAR(rig.state[Bead::Share] * rig.state[Bead::Share], 1.0, 0.0);
        CHECK_NEAR(rig.state[Bead::Stored], 0.5 * restraint * weight(0.2) * slip, 1e-14);
        // It begins to slip an elastic slip from the start, under the bound there, and goes on by the mean of both ends.
        const double s = restraint * weight(0.2), s1 = restraint * weight(increments == 1 ? 0.2 : 0.1);
        const double s0 = s + slip * increments / 0.4 * (s1 - s);
        const double rest = 0.1 * (s1 + restraint * weight(0.0)) + 0.05 * (s1 + s) - 0.5 * slip * (s - s1);
        const double there = increments == 1 ? s * (0.4 - slip) : 0.5 * (s0 + s1) * (0.1 - slip) + rest;
        CHECK_NEAR(rig.state[Bead::Work], there + s * (0.4 - 2.0 * slip), 1e-13);
        CHECK_NEAR(rig.state[Bead::Above], 0.5 * s0 * (0.4 / increments - slip) + s * (0.4 - 2.0 * slip), 1e-13);
    }
    // One that comes from above is held back from the gap on at which the bead begins: here on half of its way.
    Rig closing({0.2, 0.0, off + 0.1});
    closing.at({0.195, 0.0, off - 0.1});
    CHECK_NEAR(std::abs(closing.state[Bead::Share]), 0.25, 1e-14);
    Rig free({0.2, 0.0, 0.0});  // along the line nothing holds
    free.at({0.2, 0.0, 0.0}), free.at({0.2, 3.0, 0.0});
    CHECK(free.state[Bead::Work] == 0.0 && free.state[Bead::Slip] == 0.0);
}

/// The elastic slip is the part of the way that comes back: it grows with the way up to the allowed one.
void check_elastic_slip() {
    Rig rig({0.2, 0.0, 0.0});
    const auto elastic = [&rig] {
        const Vec3 slipped = rig.bead.rubbing(rig.state).elastic_slip;
        return std::sqrt(dot(slipped, slipped));
    };
    rig.at({0.2, 0.0, 0.0});
    CHECK(elastic() == 0.0);
    rig.at({0.2 - 0.3 * slip, 0.0, 0.0});
    CHECK_NEAR(elastic(), 0.3 * slip, 1e-14);
    rig.at({0.0, 0.0, 0.0});
    CHECK_NEAR(elastic(), slip, 1e-14);
}

/// A tool that carries the place along does no work; one that moves below it does what the place would do.
void check_moving_tool() {
    Rig carried({0.2, 0.0, 0.0}), drawn({0.2, 0.0, 0.0});
    Pose away;
    away.Q = Mat3{{std::cos(0.7), 0.0, std::sin(0.7), 0.0, 1.0, 0.0, -std::sin(0.7), 0.0, std::cos(0.7)}};
    away.c = {3.0, -2.0, 1.0};
    for (Rig* rig : {&carried, &drawn}) rig->at({0.2, 0.0, 0.0}), rig->at({-0.1, 0.0, 0.0});
    const double before = carried.state[Bead::Work];
    carried.at({-0.1, 0.0, 0.0}, away);
    CHECK_NEAR(carried.state[Bead::Work], before, 1e-13);
    CHECK_NEAR(carried.state[Bead::LiftWork], 0.0, 1e-13);
    carried.at({-0.2, 0.0, 0.1}, away), drawn.at({-0.2, 0.0, 0.1});
    CHECK_NEAR(carried.state[Bead::Work], drawn.state[Bead::Work], 1e-13);
    CHECK_NEAR(carried.state[Bead::LiftWork], drawn.state[Bead::LiftWork], 1e-13);
    CHECK(drawn.state[Bead::Work] > before && drawn.state[Bead::LiftWork] < 0.0);
}

/// Closing puts the work of the lift in, opening gives it back; loads in the place of the tool leave all works.
void check_lift() {
    Rig rig({0.0, 0.0, 0.6});
    for (int i = 1; i <= 60; ++i) rig.at({0.0, 0.0, 0.6 - 0.01 * i});
    // To the mean of the fade from half to a quarter of the thickness, which is that of a straight line.
    CHECK_NEAR(rig.state[Bead::LiftWork], uplift * weight(0.0) * 0.375, 1e-4);
    CHECK(rig.state[Bead::Work] == 0.0 && rig.bead.rubbing(rig.state).stored == rig.state[Bead::LiftWork]);
    double gone[numbers]{};
    rig.bead.leave({0.0, 0.0, 0.6}, rig.state, gone);
    CHECK_NEAR(gone[Bead::LiftWork], rig.state[Bead::LiftWork] - 0.5 * uplift * weight(0.0) * 0.6, 1e-14);
    rig.bead.forget_work(rig.state, gone);
    CHECK(gone[Bead::LiftWork] == rig.state[Bead::LiftWork] && gone[Bead::Work] == rig.state[Bead::Work]);
}

}  // namespace

int main() {
    check_across();
    check_within();
    check_elastic_slip();
    check_moving_tool();
    check_lift();
    return report("contact bead");
}
