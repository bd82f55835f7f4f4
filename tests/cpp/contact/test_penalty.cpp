// The penalty law at one place.
#include "check.hpp"
#include "umform/contact/penalty.hpp"

using namespace umform;

namespace {

const Penalty law{50.0};
const Pose pose;
const Vec3 x{1.0, 2.0, 3.0}, n{0.6, 0.0, 0.8};
const Mat3 H{{0.64, 0.0, -0.48, 0.0, 1.0, 0.0, -0.48, 0.0, 0.36}};

Reaction at(double gap, double multiplier) {
    Reaction reaction{};
    reaction.held = law.respond({gap, x, n, H, pose}, nullptr, &multiplier, reaction);
    return reaction;
}

void check_pressure() {
    CHECK(at(0.0, 0.0).held && at(0.0, 0.0).pressure == 0.0);  // a tool that just touches can hold
    CHECK(!at(1e-9, 0.0).held);
    CHECK_NEAR(at(-0.2, 0.0).pressure, 10.0, 1e-14);
    CHECK_NEAR(at(-0.2, 3.0).pressure, 13.0, 1e-14);
    CHECK_NEAR(at(0.05, 3.0).pressure, 0.5, 1e-14);  // held at an open gap by its multiplier
    CHECK(!at(0.07, 3.0).held);
    CHECK(!at(std::nan(""), 3.0).held);
    const double multiplier = 3.0;
    CHECK_NEAR(law.reach(&multiplier), 0.06, 1e-17);
}

void check_parts() {
    const Reaction reaction = at(-0.2, 3.0);
    for (int k = 0; k < 3; ++k) {
        CHECK_NEAR(reaction.tangential[k], 0.0, 0.0);
        CHECK_NEAR(reaction.traction(n)[k], 13.0 * n[k], 1e-14);
        CHECK_NEAR(reaction.force(n, 0.25)[k], 0.25 * 13.0 * n[k], 1e-14);
        for (int l = k; l < 3; ++l) CHECK_NEAR(reaction.K[k][l], 50.0 * n[k] * n[l] - 13.0 * H(k, l), 1e-13);
    }
}

/// A given pressure, of a cell: the traction is along the normal, and turns with it as the place moves.
void check_press() {
    Reaction reaction{};
    law.press({-0.2, x, n, H, pose}, 3.0, nullptr, nullptr, reaction);
    CHECK_NEAR(reaction.pressure, 3.0, 1e-15);
    for (int k = 0; k < 3; ++k) {
        CHECK_NEAR(reaction.tangential[k], 0.0, 0.0);
        CHECK_NEAR(reaction.by_pressure[k], n[k], 1e-15);
        for (int l = k; l < 3; ++l) CHECK_NEAR(reaction.K[k][l], -3.0 * H(k, l), 1e-15);
    }
}

/// A law whose places remember nothing else has one number a place; laws of several places reach as far as their farthest.
void check_wrapped() {
    ContactLawOf<Penalty> wrapped{law};
    CHECK(wrapped.symmetric() && wrapped.history_variables().size() == 1
          && wrapped.history_variables()[0].name == "multiplier");
    const std::vector<double> multipliers{1.0, 4.0, 2.0};
    CHECK_NEAR(wrapped.reach(3, multipliers.data(), 1), 0.08, 1e-17);
    wrapped.set_penalty(100.0);
    CHECK_NEAR(wrapped.reach(3, multipliers.data(), 1), 0.04, 1e-17);
}

}  // namespace

int main() {
    check_pressure();
    check_parts();
    check_press();
    check_wrapped();
    return report("contact penalty");
}
