// Patches of fourth degree: derivatives, feet; the tree of boxes; a flat square with rims.
#include "check.hpp"
#include "umform/surfaces/triangulated.hpp"

using namespace umform;

namespace {

/// A patch whose height over the triangle (0, 0), (2, 0), (0, 2) is that of its points.
QuarticPatch patch(double bulge) {
    QuarticPatch made;
    for (int row = 0, k = 0; row < 5; ++row)
        for (int i = 0; i < 5 - row; ++i, ++k)
            made.control[k] = {0.5 * i, 0.5 * row, bulge * (1.0 + 0.3 * i) * (4 - row - i) * (1.0 + 0.2 * row)};
    return made;
}

void test_derivatives() {
    const QuarticPatch made = patch(0.1);
    const double h = 1e-5;
    for (const PatchParameter p : {PatchParameter{0.2, 0.3}, {0.0, 0.6}, {0.5, 0.5}}) {
        const PatchPoint at = made.at(p), u0 = made.at({p.u - h, p.v}), u1 = made.at({p.u + h, p.v});
        const PatchPoint v0 = made.at({p.u, p.v - h}), v1 = made.at({p.u, p.v + h});
        for (int k = 0; k < 3; ++k) {
            CHECK_NEAR(at.Su[k], (u1.S[k] - u0.S[k]) / (2 * h), 1e-9);
            CHECK_NEAR(at.Sv[k], (v1.S[k] - v0.S[k]) / (2 * h), 1e-9);
            CHECK_NEAR(at.Suu[k], (u1.Su[k] - u0.Su[k]) / (2 * h), 1e-8);
            CHECK_NEAR(at.Suv[k], (v1.Su[k] - v0.Su[k]) / (2 * h), 1e-8);
            CHECK_NEAR(at.Svv[k], (v1.Sv[k] - v0.Sv[k]) / (2 * h), 1e-8);
        }
    }
}

/// The foot on a flat triangle is in it, and what is left of the way to it leads out of the triangle: no corner lies on its side.
void test_flat_foot() {
    const Vec3 a{0.1, 0.0, 0.2}, b{2.0, 0.3, -0.1}, c{0.4, 1.5, 0.6};
    int inside = 0, edges = 0, corners = 0;
    for (int i = 0; i < 1000; ++i) {
        const Vec3 x{4.0 * std::fmod(0.61803 * i, 1.0) - 1.0, 4.0 * std::fmod(0.41421 * i, 1.0) - 1.5,
                     2.0 * std::fmod(0.73205 * i, 1.0) - 1.0};
        const FlatFoot foot = foot_on_triangle(x, a, b, c);
        const auto [u, v] = foot.p;
        CHECK(u >= 0.0 && v >= 0.0 && u + v <= 1.0 + 1e-15);
        Vec3 y;
        for (int k = 0; k < 3; ++k) y[k] = a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k]);
        const Vec3 r = difference(x, y);
        CHECK_NEAR(foot.square, dot(r, r), 1e-13);
        for (const Vec3& corner : {a, b, c}) CHECK(dot(r, difference(corner, y)) <= 1e-13);
        const int zeros = (u == 0.0) + (v == 0.0) + (u + v == 1.0);
        ++(zeros == 0 ? inside : zeros == 1 ? edges : corners);
    }
    CHECK(inside > 50 && edges > 50 && corners > 50);
}

/// No point of a fine grid is nearer than the foot.
void test_foot() {
    const QuarticPatch made = patch(0.1);
    for (const Vec3 x : {Vec3{0.5, 0.6, 1.5}, {-1.0, 0.4, 0.3}, {1.5, 1.5, 0.0}, {3.0, -1.0, 0.2}, {0.3, 0.3, -0.4}}) {
        const FlatFoot flat = foot_on_triangle(x, made.control[0], made.control[4], made.control[14]);
        const PatchFoot foot = FootSearch(made, x).from(flat.p);
        CHECK(foot.p.u >= 0.0 && foot.p.v >= 0.0 && foot.p.u + foot.p.v <= 1.0);
        for (int i = 0; i <= 100; ++i)
            for (int k = 0; k <= 100 - i; ++k) {
                const Vec3 d = difference(x, made.at({0.01 * i, 0.01 * k}).S);
                CHECK(foot.square <= dot(d, d) + 1e-13);
            }
    }
}

void test_tree() {
    std::vector<Box> boxes;
    for (int i = 0; i < 200; ++i) {
        const double a = std::fmod(0.37 * i, 1.0), b = std::fmod(0.73 * i, 1.0), c = std::fmod(0.11 * i * i, 1.0);
        boxes.push_back({{a, b, c}, {a + 0.02, b + 0.01, c + 0.03}});
    }
    const BoxTree tree(boxes);
    for (const Vec3 x : {Vec3{0.5, 0.5, 0.5}, {-1.0, 2.0, 0.0}, {0.1, 0.9, 0.4}}) {
        double least = 1e300, found = 1e300;
        for (const Box& box : boxes) least = std::min(least, box.square_to(x));
        std::vector<int> announced(boxes.size(), 0);
        tree.near_first(
            x, 1e300,
            [&](int i) {
                CHECK(announced[i] == 1);
                return found = std::min(found, boxes[tree.order()[i]].square_to(x));
            },
            [&](int i) { ++announced[i]; });
        CHECK_NEAR(found, least, 0.0);
    }
}

}  // namespace

int main() {
    test_derivatives();
    test_flat_foot();
    test_foot();
    test_tree();
    return report("triangulated");
}
