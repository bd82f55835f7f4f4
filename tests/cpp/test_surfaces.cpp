// Profiles, swept tools, boxes and placed tools: closed forms, differences, joints, corners, the axis.
#include "check.hpp"
#include "umform/surfaces/cylinder.hpp"
#include "umform/surfaces/extruded.hpp"
#include "umform/surfaces/placed.hpp"
#include "umform/surfaces/revolved.hpp"
#include "umform/surfaces/rounded_box.hpp"
#include "umform/surfaces/sphere.hpp"

using namespace umform;

namespace {

constexpr ProfileEnd joined = ProfileEnd::Joined, endless = ProfileEnd::Endless, on_axis = ProfileEnd::OnAxis;

Segment line(Vec2 a, Vec2 b) { return {a, b, {}, 0}; }

Profile circle(Vec2 centre, double radius, int turn) {
    const Vec2 start{centre[0] + radius, centre[1]};
    return Profile({{start, start, centre, turn}}, joined, joined);
}

/// Square of side 2 about the origin, solid inside.
Profile square() {
    return Profile({line({-1, -1}, {1, -1}), line({1, -1}, {1, 1}), line({1, 1}, {-1, 1}), line({-1, 1}, {-1, -1})},
                   joined, joined);
}

/// A block at the left of x = 0 and below y = 0 with a fillet of radius 1.
Profile step() {
    return Profile({line({0, -2}, {0, -1}), {{0, -1}, {-1, 0}, {-1, -1}, 1}, line({-1, 0}, {-2, 0})}, endless, endless);
}

void check_same(const Gap& a, const Gap& b, double tolerance) {
    CHECK_NEAR(a.g, b.g, tolerance);
    for (int i = 0; i < 3; ++i) CHECK_NEAR(a.n[i], b.n[i], tolerance);
    for (int i = 0; i < 9; ++i) CHECK_NEAR(a.H.a[i], b.H.a[i], tolerance);
}

/// n against differences of g, H against differences of n, |n| = 1, H n = 0, H symmetric.
template <class Tool>
void check_derivatives(const Tool& tool, const Vec3& x) {
    const double h = 1e-5;
    const Gap at = tool.gap(x);
    CHECK_NEAR(dot(at.n, at.n), 1.0, 1e-14);
    for (int k = 0; k < 3; ++k) {
        Vec3 ahead = x, behind = x;
        ahead[k] += h, behind[k] -= h;
        const Gap plus = tool.gap(ahead), minus = tool.gap(behind);
        CHECK_NEAR(at.n[k], (plus.g - minus.g) / (2 * h), 1e-9);
        double Hn = 0.0;
        for (int i = 0; i < 3; ++i) {
            CHECK_NEAR(at.H(i, k), (plus.n[i] - minus.n[i]) / (2 * h), 1e-9);
            CHECK_NEAR(at.H(i, k), at.H(k, i), 1e-15);
            Hn += at.H(k, i) * at.n[i];
        }
        CHECK_NEAR(Hn, 0.0, 1e-14);
    }
}

const Vec3 axis = normalised({1, -2, 0.5}), across = normalised({2, 1, 0}), third = cross(axis, across);
const std::vector<Vec3> places{{4, 1, 2}, {-1, 3, 0.5}, {0.3, 0.4, -2.5}, {-2, -2, 5}, {1.5, 2.5, 3.1}};

void circles_are_cylinders_and_spheres() {
    for (const int turn : {1, -1}) {
        const Extruded bar{circle({0, 0}, 2, turn), {1, 2, 3}, across, third};
        const Revolved ball{
            Profile({{{0, -2.0 * turn}, {0, 2.0 * turn}, {0, 0}, turn}}, on_axis, on_axis), {1, 2, 3}, axis};
        for (const Vec3& x : places) {
            check_same(bar.gap(x), Cylinder{{1, 2, 3}, axis, 2, turn < 0}.gap(x), 1e-14);
            check_same(ball.gap(x), Sphere{{1, 2, 3}, 2, turn < 0}.gap(x), 1e-14);
        }
    }
}

void derivatives() {
    const Extruded bar{square(), {0.1, 0.2, 0.3}, across, third};
    const Revolved ring{circle({2, 0}, 1, 1), {0.1, 0.2, 0.3}, axis};
    const RoundedBox box{
        {0.1, 0.2, 0.3},
        Mat3{{axis[0], axis[1], axis[2], across[0], across[1], across[2], third[0], third[1], third[2]}},
        {1, 0.5, 0.25},
        0.2};
    for (const Vec3& x : places) check_derivatives(bar, x), check_derivatives(ring, x), check_derivatives(box, x);
}

void corners_and_joints() {
    const Profile corner = square();
    CHECK_NEAR(corner.gap({4, 5}).g, 5.0, 1e-15);
    CHECK_NEAR(corner.gap({4, 5}).n[0], 0.6, 1e-15);
    CHECK_NEAR(corner.gap({4, 5}).k, 0.2, 1e-15);
    CHECK_NEAR(corner.gap({0.9, -0.2}).g, -0.1, 1e-15);
    const PlaneGap at = corner.gap({1, 1});
    CHECK(at.g == 0.0 && at.k == 0.0);
    CHECK_NEAR(at.n[0], std::sqrt(0.5), 1e-15);
    CHECK(corner.gap({0, 0}).n[1] == -1.0);  // the first of four equals
    for (const double side : {-0.3, 0.4}) {  // both sides of the joint of line and arc, in the solid and in the void
        const PlaneGap before = step().gap({side, -1 - 1e-9}), after = step().gap({side, -1 + 1e-9});
        CHECK_NEAR(before.g, side, 1e-15);
        CHECK_NEAR(after.g, side, 1e-15);
        CHECK_NEAR(before.n[1], after.n[1], 1e-8);
        CHECK(before.k == 0.0);
        CHECK_NEAR(after.k, 1 / (1 + side), 1e-8);
    }
    CHECK_NEAR(step().gap({-1, -1}).g, -1.0, 1e-15);                           // at the centre of the arc
    CHECK(step().gap({-1, -1}).n[0] == 1.0 && step().gap({-1, -1}).k == 0.0);  // equally near: the first line
    CHECK_NEAR(step().gap({3e5, -1e9}).g, 3e5, 1e-9);
    CHECK_NEAR(step().gap({-1e9, 2}).g, 2, 1e-15);
}

void on_the_axis() {
    const Revolved ball{Profile({{{0, -2}, {0, 2}, {0, 0}, 1}}, on_axis, on_axis), {0, 0, 0}, {0, 0, 1}};
    for (const double z : {3.0, -5.0, -1.0}) {
        const Gap at = ball.gap({0, 0, z});
        CHECK_NEAR(at.g, std::abs(z) - 2, 1e-15);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) CHECK_NEAR(at.H(i, j), i == j && i < 2 ? 1 / std::abs(z) : 0.0, 1e-15);
    }
    const Revolved cone{Profile({line({3, -3}, {0, 0})}, endless, on_axis), {0, 0, 0}, {0, 0, 1}};
    CHECK_NEAR(cone.gap({0.1, 0, 5}).g, std::hypot(0.1, 5), 1e-15);  // above the tip
    CHECK_NEAR(cone.gap({0, 0, 5}).H(1, 1), 0.2, 1e-15);
    CHECK_NEAR(cone.gap({0.1, 0, -5}).g, -4.9 * std::sqrt(0.5), 1e-14);
    const Revolved pit{Profile({line({0, 0}, {3, -3})}, on_axis, endless), {0, 0, 0}, {0, 0, 1}};
    CHECK_NEAR(pit.gap({0, 0.1, 5}).g, -std::hypot(0.1, 5), 1e-15);
    for (const double value : cone.gap({0, 0, -5}).H.a) CHECK(std::isfinite(value));
}

void placed_tools() {
    const auto bar = std::make_shared<SurfaceOf<Cylinder>>(Cylinder{{1, 2, 3}, axis, 2, false});
    const Mat3 mirror{{1, 0, 0, 0, 1, 0, 0, 0, -1}};
    const Placed placed(bar, mirror, {0, 0, 4});
    const Cylinder image{{1, 2, 1}, {axis[0], axis[1], -axis[2]}, 2, false};
    for (const Vec3& x : places) {
        Gap at{};
        placed.gap(1, x.data(), &at.g, at.n.data(), at.H.a.data());
        check_same(at, image.gap(x), 1e-15);
    }
}

void box_inside_and_outside() {
    const RoundedBox box{{0, 0, 0}, Mat3{{1, 0, 0, 0, 1, 0, 0, 0, 1}}, {3, 2, 1}, 0.5};
    CHECK_NEAR(box.gap({0, 0, 0}).g, -1.5, 1e-15);
    CHECK(box.gap({0, 0, 0}).n[2] == 1.0);
    CHECK_NEAR(box.gap({-3.2, 0, 0.1}).g, -0.3, 1e-15);
    CHECK_NEAR(box.gap({6, 6, 0}).g, 4.5, 1e-15);
    CHECK_NEAR(box.gap({6, 6, 0}).H(0, 1), -0.6 * 0.8 / 5, 1e-15);
    CHECK(box.gap({6, 6, 0}).H(2, 2) == 0.0);
    CHECK_NEAR(box.gap({-4, 4, 3}).g, 2.5, 1e-15);
}

}  // namespace

int main() {
    circles_are_cylinders_and_spheres();
    derivatives();
    corners_and_joints();
    on_the_axis();
    placed_tools();
    box_inside_and_outside();
    return report("surfaces");
}
