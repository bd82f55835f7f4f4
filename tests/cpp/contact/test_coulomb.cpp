// Friction at one place: stick, slip, first touch, a tool that moves, what is remembered, and tangents by differences.
#include <numbers>

#include "check.hpp"
#include "umform/contact/coulomb.hpp"

using namespace umform;

namespace {

constexpr int numbers = Coulomb::table.size();

Coulomb law(double mu = 0.3) {
    auto friction = std::make_shared<CoulombFriction>();
    friction->pressure = {0.0}, friction->mu = {mu};
    return {50.0, 0.4, 0.05, friction};
}

/// A ball of radius 2 about the origin.
struct Ball {
    Vec3 n;
    Mat3 H;
    double gap;

    explicit Ball(const Vec3& x) {
        const double length = std::sqrt(dot(x, x));
        gap = length - 2.0;
        for (int k = 0; k < 3; ++k) n[k] = x[k] / length;
        for (int k = 0; k < 3; ++k)
            for (int l = 0; l < 3; ++l) H(k, l) = ((k == l ? 1.0 : 0.0) - n[k] * n[l]) / length;
    }
};

double square(const Vec3& a) { return dot(a, a); }

Reaction at(const Coulomb& law, const Vec3& x, const double* state, double* trial) {
    const Ball ball(x);
    const Pose pose;
    Reaction reaction{};
    reaction.held = law.respond({ball.gap, x, ball.n, ball.H, pose}, state, trial, reaction);
    return reaction;
}

Vec3 traction(const Coulomb& law, const Vec3& x, const double* state) {
    double trial[numbers]{};
    return at(law, x, state, trial).traction(Ball(x).n);
}

void check_tangent(const Coulomb& law, const Vec3& x, const double* state, bool slips) {
    double trial[numbers]{};
    const Reaction reaction = at(law, x, state, trial);
    CHECK(reaction.held && reaction.slipping == slips);
    for (int j = 0; j < 3; ++j) {
        Vec3 ahead = x, behind = x;
        ahead[j] += 1e-6, behind[j] -= 1e-6;
        const Vec3 t = traction(law, ahead, state), s = traction(law, behind, state);
        for (int i = 0; i < 3; ++i) CHECK_NEAR(reaction.K[i][j], -(t[i] - s[i]) / 2e-6, 2e-7);
    }
}

void check_states() {
    const Coulomb rubbing = law();
    double state[numbers]{}, held[numbers]{}, after[numbers]{};
    rubbing.leave({0.0, 0.0, 2.3}, state, state);
    CHECK_NEAR(state[Coulomb::Where + 2], 2.3, 0.0);

    // First touch: of a way of 0.4 down and 0.04 aside, 0.0484 along the tool there, a quarter is in the tool.
    const Vec3 touched{0.04, 0.0, 1.9};
    const Reaction first = at(rubbing, touched, state, held);
    CHECK(first.held && !first.slipping);
    const double stiffness = 0.3 * first.pressure / 0.05;  // of the bound over the elastic slip that is allowed
    CHECK(stiffness > 50.0 * 0.4);
    CHECK(held[Coulomb::Stiffness] == stiffness);
    CHECK_NEAR(first.tangential[0], -stiffness * 0.25 * 0.0484, 1e-3);
    check_tangent(rubbing, touched, state, false);
    // The work is that of half of the traction on the whole way along the tool, not of what follows the touch; a part is stored.
    const Vec3 all{0.04, 0.0, -0.4};
    CHECK_NEAR(held[Coulomb::Work],
               -0.5 * dot(first.tangential, all) - square(first.tangential) / (2.0 * held[Coulomb::Stiffness]), 1e-15);

    // It sticks, then slips: the traction is at its bound, against the way.
    check_tangent(rubbing, {0.06, 0.01, 1.9}, held, false);
    check_tangent(rubbing, {0.30, 0.10, 1.88}, held, true);
    const Reaction slip = at(rubbing, {0.30, 0.10, 1.88}, held, after);
    CHECK_NEAR(std::sqrt(dot(slip.tangential, slip.tangential)), 0.3 * slip.pressure, 1e-13);
    CHECK_NEAR(dot(slip.tangential, Ball({0.30, 0.10, 1.88}).n), 0.0, 1e-14);
    CHECK(slip.tangential[0] < 0.0 && slip.tangential[1] < 0.0);
    CHECK(
        after[Coulomb::Work]
        > held[Coulomb::Work]);  // friction has cost work: that of the mean traction along the way, less what is stored
    const double stored = (dot(slip.tangential, slip.tangential) / after[Coulomb::Stiffness]
                           - dot(first.tangential, first.tangential) / held[Coulomb::Stiffness])
                          / 2.0;
    const Vec3 x = {0.30, 0.10, 1.88}, way{0.26, 0.10, -0.02};
    const Vec3 n = Ball(x).n,
               t_n = Carried(Pose{}, Facing({0.0, x, n, Ball(x).H, Pose{}}), first.tangential, Ball(touched).n, true)
                         .value;
    // It begins to slip where the traction reaches the bound, which falls on the way: that much more than the mean.
    const double s = std::sqrt(square(slip.tangential)), s_n = 0.3 * first.pressure;
    const double mean_stiffness = 0.5 * (held[Coulomb::Stiffness] + after[Coulomb::Stiffness]);
    CHECK_NEAR(after[Coulomb::Limit], s, 1e-14);
    Vec3 D, trial;
    for (int k = 0; k < 3; ++k) D[k] = way[k] - n[k] * dot(n, way), trial[k] = t_n[k] - mean_stiffness * D[k];
    const double irreversible = (std::sqrt(square(trial)) - s) / mean_stiffness;
    double low = 0.0, high = 1.0;  // where it begins, by bisection
    for (int i = 0; i < 60; ++i) {
        const double a = 0.5 * (low + high);
        Vec3 t;
        for (int k = 0; k < 3; ++k) t[k] = (1.0 - a) * t_n[k] + a * trial[k];
        (std::sqrt(square(t)) > s_n + a * (s - s_n) ? high : low) = a;
    }
    const double onset = s_n + low * (s - s_n);
    CHECK(onset > 1.01 * s && onset < 0.995 * s_n);
    const double above = 0.5 * (onset - dot(t_n, slip.tangential) / s) * irreversible;
    CHECK(above > 0.1 * after[Coulomb::Work]);
    const double mean = -0.5 * (dot(first.tangential, way) + dot(slip.tangential, way));
    CHECK_NEAR(after[Coulomb::Work], held[Coulomb::Work] + mean + above - stored, 1e-12);
    CHECK_NEAR(after[Coulomb::Above], above, 1e-12);
    CHECK_NEAR(after[Coulomb::Slip], held[Coulomb::Slip] + std::sqrt(square(D)), 1e-14);

    // At rest nothing moves, and the tangent sticks.
    double again[numbers]{};
    const Reaction rest = at(rubbing, {0.30, 0.10, 1.88}, after, again);
    CHECK(!rest.slipping);
    for (int k = 0; k < 3; ++k) CHECK_NEAR(rest.tangential[k], slip.tangential[k], 1e-14);
    CHECK_NEAR(again[Coulomb::Work], after[Coulomb::Work], 1e-15);

    // It lets go: what is left is the place, the distance slid and the work.
    double gone[numbers]{};
    CHECK(!at(rubbing, {0.30, 0.10, 2.1}, after, gone).held);
    CHECK(gone[Coulomb::Held] == 0.0 && gone[Coulomb::Traction] == 0.0 && gone[Coulomb::Slip] == after[Coulomb::Slip]
          && gone[Coulomb::Above] == after[Coulomb::Above] && gone[Coulomb::Limit] == 0.0);
    CHECK(gone[Coulomb::Stiffness] == 50.0 * 0.4);  // as of a place that was never held
    // Half of the traction that it had still works on the way, and what was stored is lost to it.
    CHECK_NEAR(gone[Coulomb::Work],
               after[Coulomb::Work] - 0.5 * slip.tangential[2] * 0.22
                   + square(slip.tangential) / (2.0 * after[Coulomb::Stiffness]),
               1e-14);
    // Loads that replace the tool do that work, and take what was stored.
    rubbing.leave({0.3, 0.1, 2.1}, after, gone);
    rubbing.forget_work(after, gone);
    CHECK(gone[Coulomb::Work] == after[Coulomb::Work] && rubbing.rubbing(gone).stored == 0.0);
}

/// A tool that is flat, under a pressure of 5 or another one, in any pose.
struct Flat {
    Coulomb rubbing = law();
    double state[numbers]{};

    Reaction at(double x, double y, double pressure = 5.0, const Pose& pose = {}) {
        const Vec3 n = pose.turn(Vec3{0.0, 0.0, 1.0}), place = pose.to_space({x, y, -pressure / 50.0});
        const Mat3 H{};
        double trial[numbers]{};
        std::copy_n(state + Coulomb::Change, 3, trial + Coulomb::Change);
        Reaction reaction{};
        reaction.held = rubbing.respond({-pressure / 50.0, place, n, H, pose}, state, trial, reaction);
        CHECK(reaction.held);
        rubbing.settle(trial);
        std::copy_n(trial, numbers, state);
        return reaction;
    }
    double slip() const { return state[Coulomb::Slip]; }
    double work() const { return state[Coulomb::Work]; }
};

/// Under a constant pressure the work is the bound times the way less the elastic slip, in few increments or in many.
void check_slides() {
    const double bound = 1.5, elastic = 0.05;  // 0.3 of the pressure, which it reaches within the slip that is allowed
    for (const int increments : {1, 2, 7, 30}) {
        Flat flat;
        flat.at(0.0, 0.0);
        for (int i = 1; i <= increments; ++i) flat.at(0.6 * i / increments, 0.8 * i / increments);
        CHECK_NEAR(flat.work(), bound * (1.0 - elastic), 1e-14);
        CHECK_NEAR(flat.slip(), 1.0, 1e-14);
        flat.at(0.3, 0.4);  // back: it sticks for twice the elastic slip
        CHECK_NEAR(flat.work(), bound * (1.0 - elastic) + bound * (0.5 - 2.0 * elastic), 1e-14);
        CHECK_NEAR(flat.slip(), 1.5, 1e-14);
    }
    // A pressure that grows while it slides on: the mean traction is the right one.
    Flat growing;
    growing.at(0.0, 0.0), growing.at(1.0, 0.0);
    const double before = growing.work(), stored = bound * elastic / 2.0;
    growing.at(2.0, 0.0, 10.0);
    CHECK_NEAR(growing.work(), before + 1.5 * bound - (2.0 * stored - stored), 1e-14);
    CHECK_NEAR(growing.state[Coulomb::Above], 0.5 * bound * (1.0 - elastic),
               1e-14);  // all of it from the beginning of the slide
    // One that falls below the traction while it sticks: it slips at the mean of both.
    Flat falling;
    falling.at(0.0, 0.0, 10.0), falling.at(0.04, 0.0, 10.0);
    CHECK_NEAR(falling.work(), 0.0, 1e-15);
    falling.at(0.04, 0.0, 5.0);
    CHECK(falling.state[Coulomb::Above] == 0.0);
    CHECK(falling.state[Coulomb::Stiffness] == 60.0);  // the stiffness stays that of the largest bound
    // One that falls in proportion to the way, before it slips and while it does: exact, in few increments or in many.
    for (const int increments : {1, 2, 7, 30}) {
        Flat both;
        both.at(0.0, 0.0, 10.0);
        for (int i = 1; i <= increments; ++i) both.at(0.5 * i / increments, 0.0, 10.0 - 5.0 * i / increments);
        const double onset = 3.0 / 63.0;  // where 60 x = 3 - 3 x
        const double exact = 30.0 * onset * onset + 3.0 * (0.5 - onset) - 1.5 * (0.25 - onset * onset);
        CHECK_NEAR(both.work(), exact - 1.5 * 1.5 / 120.0, 1e-14);
        Flat back;
        back.at(0.0, 0.0, 10.0), back.at(1.0, 0.0, 10.0);
        const double there = back.work(), turn = 6.0 / 63.0;  // where 60 x - 3 = 3 - 3 x
        for (int i = 1; i <= increments; ++i) back.at(1.0 - 0.5 * i / increments, 0.0, 10.0 - 5.0 * i / increments);
        const double elastic_part = 30.0 * turn * turn - 3.0 * turn + (9.0 - 2.25) / 120.0;
        const double slid = 3.0 * (0.5 - turn) - 1.5 * (0.25 - turn * turn);
        CHECK_NEAR(back.work(), there + elastic_part + slid, 1e-13);
    }
}

/// A pressure that grows while it sticks, or until it slips and on, or as it turns back: second order in the increment.
void check_order() {
    const auto work = [](double far, double turns, int increments) {
        Flat flat;
        flat.at(0.0, 0.0);
        for (int i = 1; i <= increments; ++i) {
            const double part = static_cast<double>(i) / increments;
            flat.at(far * (turns > 0.0 ? std::sin(turns * part) : part), 0.0, 5.0 * (1.0 + part));
        }
        return flat.work();
    };
    // Exact, dt = 30 (1 + x / L) dx and s = 1.5 (1 + x / L) for a way L, which is half an elastic slip, or ten of them.
    const auto up_to = [](double L, double x) { return 15.0 * x * x + 5.0 * x * x * x / L; };
    const double stuck = 0.025, t = 45.0 * stuck, x = 0.5 * (std::sqrt(101.0) - 9.0) / 10.0;
    const double sticks = up_to(stuck, stuck) - t * t / 120.0;
    const double slips = up_to(0.5, x) + 1.5 * (0.5 - x) + 1.5 * (0.25 - x * x) - 0.075;
    for (const int increments : {16, 32, 64}) {
        CHECK_NEAR((work(stuck, 0.0, increments) - sticks) / (work(stuck, 0.0, 2 * increments) - sticks), 4.0, 0.01);
        CHECK_NEAR((work(0.5, 0.0, increments) - slips) / (work(0.5, 0.0, 2 * increments) - slips), 4.0, 0.3);
    }
    CHECK_NEAR(work(0.5, 0.0, 8), slips, 1.2e-3 * slips);  // 3.7e-3 with the stiffness of the end
    const double turned = work(0.3, 4.71, 1 << 14);
    CHECK_NEAR(work(0.3, 4.71, 64), turned, 1e-4 * turned);  // 9e-4
}

/// Falling stiffness would give energy: none of it comes back, at whatever pressure a place sticks.
void check_no_gain() {
    for (const double pressure : {2.0, 4.9, 5.1, 20.0}) {
        Flat flat;
        flat.at(0.0, 0.0), flat.at(0.01, 0.0);
        const double before = flat.work();
        flat.at(0.012, 0.005, pressure);
        CHECK(flat.work() >= before - 1e-16);
        CHECK((flat.work() > before + 1e-6) == (pressure > 5.0));
    }
}

/// The way is that in the frame of the tool: one that carries the place does no work, one that slides under it all.
void check_moving_tool() {
    Flat carried, slid, turned;
    for (Flat* flat : {&carried, &slid, &turned}) flat->at(0.0, 0.0), flat->at(0.3, 0.0);
    const double before = carried.work();
    Pose away;
    away.Q = Mat3{{std::cos(0.7), 0.0, std::sin(0.7), 0.0, 1.0, 0.0, -std::sin(0.7), 0.0, std::cos(0.7)}};
    away.c = {3.0, -2.0, 1.0};
    carried.at(0.3, 0.0, 5.0, away);
    CHECK_NEAR(carried.work(), before, 1e-14);
    CHECK_NEAR(carried.slip(), 0.3, 1e-14);
    turned.at(0.9, 0.0, 5.0, away), slid.at(0.9, 0.0);
    CHECK_NEAR(turned.work(), slid.work(), 1e-14);
    CHECK_NEAR(slid.work(), before + 1.5 * 0.6, 1e-14);
}

/// Multipliers take over a traction in the frame of the tool: at rest it stays once they have, and nothing of it is stored.
void check_multipliers() {
    const Coulomb rubbing{50.0, 0.4, std::numeric_limits<double>::infinity(), law().friction};
    double state[numbers]{}, trial[numbers]{}, read[numbers]{};
    Pose pose;
    pose.Q = Mat3{{std::cos(0.7), 0.0, std::sin(0.7), 0.0, 1.0, 0.0, -std::sin(0.7), 0.0, std::cos(0.7)}};
    const auto ask = [&](const Vec3& z, const double* before, const Vec3* carry = nullptr) {
        const Ball ball(z);
        const Vec3 x = pose.to_space(z), n = pose.turn(ball.n);
        const Mat3 H = pose.turn(ball.H);
        const Place place{ball.gap, x, n, H, pose};
        Reaction reaction{};
        if (carry != nullptr)
            rubbing.augment(place, *carry, before, trial);
        else
            CHECK(rubbing.respond(place, before, trial, reaction));
        return reaction.tangential;
    };
    rubbing.leave({0.0, 0.0, 2.0}, state, state);
    ask({0.0, 0.0, 1.9}, state);
    std::copy_n(trial, numbers, state);
    const Vec3 z{0.02, 0.01, 1.9}, back{0.0, 0.0, 1.9};
    const Vec3 t = ask(z, state);
    CHECK_NEAR(rubbing.rubbing(trial).stored, square(t) / 40.0, 1e-14);
    ask(z, state, &t);
    std::copy_n(state, numbers, read);
    rubbing.put_wanted(trial, read);
    CHECK(read[Coulomb::Change] == trial[Coulomb::Change] && read[Coulomb::Change] != 0.0);
    const Vec3 taken = ask(back, state);  // the multipliers bear it where the place first stuck
    CHECK_NEAR(square(taken), square(t), 1e-4 * square(t));
    CHECK_NEAR(rubbing.rubbing(trial).stored, 0.0, 1e-15);
    for (int k = 0; k < 3; ++k) CHECK_NEAR(rubbing.rubbing(trial).elastic_slip[k], 0.0, 1e-15);
    rubbing.settle(trial);
    std::copy_n(trial, numbers, state);
    const Vec3 rest = ask(back, state);
    for (int k = 0; k < 3; ++k) CHECK_NEAR(rest[k], taken[k], 1e-14);
    pose.Q = Mat3{{1, 0, 0, 0, 1, 0, 0, 0, 1}};  // the tool turns and carries the place along
    CHECK_NEAR(square(ask(back, state)), square(taken), 1e-14);
    CHECK_NEAR(rubbing.rubbing(trial).stored, 0.0, 1e-15);
}

/// Friction that fades with the distance slid: the stiffness that follows the bound falls with it.
void check_fading() {
    auto friction = std::make_shared<CoulombFriction>();
    friction->pressure = {0.0}, friction->mu = {0.3}, friction->kinetic = 0.5, friction->decay = 0.05;
    const Coulomb fading{50.0, 0.4, 0.05, friction};
    double state[numbers]{}, held[numbers]{};
    fading.leave({0.0, 0.0, 2.3}, state, state);
    check_tangent(fading, {0.04, 0.0, 1.9}, state, false);
    at(fading, {0.04, 0.0, 1.9}, state, held);
    check_tangent(fading, {0.05, 0.01, 1.88}, held, false);
    check_tangent(fading, {0.30, 0.10, 1.88}, held, true);
}

/// A level set (|x|^2 - R^2) / (2 R) in place of a distance: its slope scales the pressure that the bound is for.
void check_level_set() {
    const Coulomb rubbing = law();
    const double R = 2.0;
    const auto respond = [&](const Vec3& x, const double* state, double* trial) {
        Vec3 n;
        Mat3 H{};
        for (int k = 0; k < 3; ++k) n[k] = x[k] / R, H(k, k) = 1.0 / R;
        Reaction reaction{};
        CHECK(rubbing.respond({(dot(x, x) - R * R) / (2.0 * R), x, n, H, Pose{}}, state, trial, reaction));
        reaction.tangential = reaction.traction(n);
        return reaction;
    };
    double state[numbers]{}, held[numbers]{}, trial[numbers]{};
    rubbing.leave({0.0, 0.0, 2.3}, state, state);
    respond({0.04, 0.0, 1.9}, state, held);
    for (const Vec3& x : {Vec3{0.05, 0.01, 1.7}, {0.30, 0.10, 1.7}}) {
        const Reaction reaction = respond(x, held, trial);
        CHECK(reaction.slipping == (x[0] > 0.2));
        for (int j = 0; j < 3; ++j) {
            Vec3 ahead = x, behind = x;
            ahead[j] += 1e-6, behind[j] -= 1e-6;
            const Vec3 t = respond(ahead, held, trial).tangential, s = respond(behind, held, trial).tangential;
            for (int i = 0; i < 3; ++i) CHECK_NEAR(reaction.K[i][j], -(t[i] - s[i]) / 2e-6, 2e-7);
        }
    }
}

/// Whatever the direction of the slide, a state at the bound sticks at rest, and slips as soon as it slides on.
void check_rest() {
    const Coulomb rubbing = law();
    for (int i = 0; i < 100; ++i) {
        double state[numbers]{}, held[numbers]{}, after[numbers]{}, again[numbers]{};
        const double angle = 0.063 * i, c = std::cos(angle), s = std::sin(angle);
        rubbing.leave({0.0, 0.0, 1.95}, state, state);
        at(rubbing, {0.01 * c, 0.01 * s, 1.93}, state, held);
        const Vec3 slid{0.3 * c, 0.3 * s, 1.93 - 0.0005 * i};
        CHECK(at(rubbing, slid, held, after).slipping);
        CHECK(!at(rubbing, slid, after, again).slipping);
        CHECK(!at(rubbing, slid, again, held).slipping);
        check_tangent(rubbing, {slid[0] - 1e-4 * c, slid[1] - 1e-4 * s, slid[2]}, after, false);
        check_tangent(rubbing, {slid[0] + 1e-4 * c, slid[1] + 1e-4 * s, slid[2]}, after, true);
    }
}

/// A sheet and a tool that are turned together, after a slide, feel the same traction, turned: all is kept in the frame of the tool.
void check_frame() {
    const Coulomb rubbing = law();
    const double c = std::cos(0.7), s = std::sin(0.7);
    Pose turned;
    turned.Q = Mat3{{c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c}};
    turned.c = {0.3, -0.2, 0.1};
    double plain[numbers]{}, moved[numbers]{}, after[numbers]{};
    rubbing.leave({0.0, 0.0, 1.95}, plain, plain);
    std::copy_n(plain, numbers, moved);
    for (const Vec3& x : {Vec3{0.02, 0.01, 1.93}, Vec3{0.30, 0.10, 1.88}, Vec3{0.33, 0.20, 1.87}}) {
        const Ball ball(x);
        const Vec3 y = turned.to_space(x), n = turned.turn(ball.n);
        const Mat3 H = turned.turn(ball.H);
        const Reaction here = at(rubbing, x, plain, after);
        std::copy_n(after, numbers, plain);
        Reaction there{};
        there.held = rubbing.respond({ball.gap, y, n, H, turned}, moved, after, there);
        std::copy_n(after, numbers, moved);
        const Vec3 expected = turned.turn(here.tangential);
        CHECK(there.held && there.slipping == here.slipping);
        for (int k = 0; k < 3; ++k) CHECK_NEAR(there.tangential[k], expected[k], 1e-13);
    }
    for (int k = 0; k < numbers; ++k) CHECK_NEAR(moved[k], plain[k], 1e-13);
}

/// A full circle about an axis brings a vector along the tool back to where it was, turned by the holonomy of the cap.
void check_transport() {
    const double colatitude = 0.5;
    const int steps = 4000;
    Vec3 a{std::cos(colatitude), 0.0, -std::sin(colatitude)};  // along the meridian
    Vec3 before = Ball({2.0 * std::sin(colatitude), 0.0, 2.0 * std::cos(colatitude)}).n;
    const Pose pose;
    for (int i = 1; i <= steps; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / steps;
        const Vec3 x{2.0 * std::sin(colatitude) * std::cos(angle), 2.0 * std::sin(colatitude) * std::sin(angle),
                     2.0 * std::cos(colatitude)};
        const Ball ball(x);
        const Facing facing({ball.gap, x, ball.n, ball.H, pose});
        a = Carried(pose, facing, a, before, true).value;
        CHECK_NEAR(dot(a, ball.n), 0.0, 1e-12);
        before = ball.n;
    }
    const double turned = 2.0 * std::numbers::pi * std::cos(colatitude);
    CHECK_NEAR(dot(a, a), 1.0, 1e-12);
    CHECK_NEAR(a[0], std::cos(turned) * std::cos(colatitude), 1e-5);
    CHECK_NEAR(std::abs(a[1]), std::abs(std::sin(turned)), 1e-5);
}

/// The slope over the distance slid, by differences.
void check_fading_slope() {
    CoulombFriction friction;
    friction.pressure = {0.0}, friction.mu = {0.2}, friction.kinetic = 0.4, friction.decay = 0.3;
    const double h = 1e-6, p = 7.0;
    for (const double slip : {0.0, 0.1, 2.0}) {
        const double ahead = friction.bound(p, slip + h, {}).value, behind = friction.bound(p, slip - h, {}).value;
        CHECK_NEAR(friction.bound(p, slip, {}).by_slip, (ahead - behind) / (2.0 * h), 1e-9);
    }
    CHECK_NEAR(friction.bound(p, 0.0, {}).value, 0.2 * p, 1e-15);
    CHECK_NEAR(friction.bound(p, 1e3, {}).value, 0.08 * p, 1e-15);
}

void check_laws() {
    CoulombFriction friction;
    friction.pressure = {1.0, 3.0}, friction.mu = {0.1, 0.3};
    CHECK_NEAR(friction.bound(2.0, 0.0, {}).value, 0.4, 1e-15);
    CHECK_NEAR(friction.bound(2.0, 0.0, {}).by_pressure, 0.4, 1e-15);
    CHECK_NEAR(friction.bound(9.0, 0.0, {}).value, 2.7, 1e-15);
    friction.cap = 0.35;
    CHECK(friction.bound(2.0, 0.0, {}).value == 0.35 && friction.bound(2.0, 0.0, {}).by_pressure == 0.0);
}

}  // namespace

int main() {
    check_states();
    check_fading();
    check_level_set();
    check_rest();
    check_frame();
    check_transport();
    check_slides();
    check_order();
    check_no_gain();
    check_moving_tool();
    check_multipliers();
    check_fading_slope();
    check_laws();
    return report("contact friction");
}
