// Friction at one place: stick, slip, first touch, a tool that moves, what is remembered, and tangents by differences.
#include "check.hpp"
#include "umform/contact/coulomb.hpp"

using namespace umform;

namespace {

constexpr int numbers = 20;

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

Reaction at(const Coulomb& law, const Vec3& x, const double* state, double* trial) {
    const Ball ball(x);
    const Pose pose;
    Reaction reaction{};
    reaction.held = law.respond({ball.gap, x, ball.n, ball.H, pose}, 1.0, state, trial, reaction);
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
    CHECK_NEAR(state[4], 2.3, 0.0);

    // First touch: of a way of 0.4 down and 0.04 aside, 0.0484 along the tool there, a quarter is in the tool.
    const Vec3 touched{0.04, 0.0, 1.9};
    const Reaction first = at(rubbing, touched, state, held);
    CHECK(first.held && !first.slipping);
    const double stiffness = 0.3 * first.pressure / 0.05;  // of the bound over the elastic slip that is allowed
    CHECK(stiffness > 50.0 * 0.4);
    CHECK_NEAR(first.tangential[0], -stiffness * 0.25 * 0.0484, 1e-3);
    check_tangent(rubbing, touched, state, false);
    CHECK_NEAR(held[18], 0.0, 1e-15);  // elastic slip stores all of the work

    // It sticks, then slips: the traction is at its bound, against the way.
    check_tangent(rubbing, {0.06, 0.01, 1.9}, held, false);
    check_tangent(rubbing, {0.30, 0.10, 1.88}, held, true);
    const Reaction slip = at(rubbing, {0.30, 0.10, 1.88}, held, after);
    CHECK_NEAR(std::sqrt(dot(slip.tangential, slip.tangential)), 0.3 * slip.pressure, 1e-13);
    CHECK_NEAR(dot(slip.tangential, Ball({0.30, 0.10, 1.88}).n), 0.0, 1e-14);
    CHECK(slip.tangential[0] < 0.0 && slip.tangential[1] < 0.0);
    CHECK(after[18]
          > held[18]);  // friction has cost work: that of the mean traction along the way, less what is stored
    const double stored =
        (dot(slip.tangential, slip.tangential) / after[19] - dot(first.tangential, first.tangential) / held[19]) / 2.0;
    const Vec3 x = {0.30, 0.10, 1.88}, way{0.26, 0.10, -0.02};
    const Vec3 n = Ball(x).n,
               t_n = Carried(Pose{}, Facing({0.0, x, n, Ball(x).H, Pose{}}), first.tangential, Ball(touched).n, true)
                         .value;
    double work = 0.0;
    for (int k = 0; k < 3; ++k) work -= 0.5 * (t_n[k] + slip.tangential[k]) * (way[k] - n[k] * dot(n, way));
    CHECK_NEAR(after[18], work - stored, 1e-12);
    CHECK(after[17] > held[17]);

    // At rest nothing moves, and the tangent sticks.
    double again[numbers]{};
    const Reaction rest = at(rubbing, {0.30, 0.10, 1.88}, after, again);
    CHECK(!rest.slipping);
    for (int k = 0; k < 3; ++k) CHECK_NEAR(rest.tangential[k], slip.tangential[k], 1e-14);
    CHECK_NEAR(again[18], after[18], 1e-15);

    // It lets go: what is left is the place, the distance slid and the work.
    double gone[numbers]{};
    CHECK(!at(rubbing, {0.30, 0.10, 2.1}, after, gone).held);
    CHECK(gone[1] == 0.0 && gone[8] == 0.0 && gone[17] == after[17] && gone[18] == after[18]);
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
        CHECK(rubbing.respond({(dot(x, x) - R * R) / (2.0 * R), x, n, H, Pose{}}, 1.0, state, trial, reaction));
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
        there.held = rubbing.respond({ball.gap, y, n, H, turned}, 1.0, moved, after, there);
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
        const double angle = 2.0 * M_PI * i / steps;
        const Vec3 x{2.0 * std::sin(colatitude) * std::cos(angle), 2.0 * std::sin(colatitude) * std::sin(angle),
                     2.0 * std::cos(colatitude)};
        const Ball ball(x);
        const Facing facing({ball.gap, x, ball.n, ball.H, pose});
        a = Carried(pose, facing, a, before, true).value;
        CHECK_NEAR(dot(a, ball.n), 0.0, 1e-12);
        before = ball.n;
    }
    const double turned = 2.0 * M_PI * std::cos(colatitude);
    CHECK_NEAR(dot(a, a), 1.0, 1e-12);
    CHECK_NEAR(a[0], std::cos(turned) * std::cos(colatitude), 1e-5);
    CHECK_NEAR(std::abs(a[1]), std::abs(std::sin(turned)), 1e-5);
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
    check_laws();
    return report("contact friction");
}
