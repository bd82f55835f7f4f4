// Patches of fourth degree: derivatives, feet; the tree of boxes; searches that begin with what was near before.
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

/// A number between -1 and 1.
double spread(int i) { return 2.0 * std::fmod(0.6180339887 * i, 1.0) - 1.0; }

/// A wavy square of 8 x 8 cells between -4 and 4, whose thirds bulge; its normals point up.
Triangulated wavy(Across across) {
    const auto corner = [](int i, int k) {
        return Vec3{i - 4.0, k - 4.0, 0.7 * std::sin(1.3 * i) * std::cos(1.1 * k)};
    };
    std::vector<Third> thirds;
    const auto triangle = [&](const std::array<Vec3, 3>& corners) {
        Vec3 middle{};
        for (const Vec3& x : corners)
            for (int j = 0; j < 3; ++j) middle[j] += x[j] / 3.0;
        for (int side = 0; side < 3; ++side) {
            const Vec3 &a = corners[side], &b = corners[(side + 1) % 3];
            Third third{{}, across, -1, {0, 0}, -1};
            for (int row = 0, at = 0; row < 5; ++row)
                for (int i = 0; i < 5 - row; ++i, ++at)
                    for (int j = 0; j < 3; ++j)
                        third.patch.control[at][j] = 0.25 * ((4 - row - i) * a[j] + i * b[j] + row * middle[j])
                                                     + (j == 2 ? 0.02 * i * (4 - row - i) : 0.0);
            thirds.push_back(third);
        }
    };
    for (int i = 0; i < 8; ++i)
        for (int k = 0; k < 8; ++k) {
            triangle({corner(i, k), corner(i + 1, k), corner(i + 1, k + 1)});
            triangle({corner(i, k), corner(i + 1, k + 1), corner(i, k + 1)});
        }
    return {thirds, {{{0.0, 0.0, 1.0}, across}}, {}};
}

/// Points that creep, run and jump, near and far, also along the edges of the triangles, and one that is lost for a while: the
/// answer has the same bits whatever was found before.
void test_searches_that_remember(Across across) {
    constexpr int points = 300;
    const Triangulated tool = wavy(across);
    std::vector<double> x(3 * points), g(points), n(3 * points), H(9 * points), again(13 * points);
    std::vector<Nearby> nearby(points);
    int seed = 0, known = 0, wrong = 0;
    for (int round = 0; round < 60; ++round) {
        const double step = round % 20 == 0 ? 4.0 : round % 5 == 0 ? 0.3 : 0.01;
        for (int q = 0; q < points; ++q)
            for (int k = 0; k < 3; ++k) {
                double& value = x[3 * q + k];
                value = std::isnan(value) ? 0.0 : value + step * (k == 2 && q % 3 > 0 ? 0.1 : 1.0) * spread(++seed);
                if (std::abs(value) > 4.5) value *= 0.5;
                if (q % 5 == 0 && k == 0) value = std::round(value);
            }
        if (round % 7 == 3) x[30] = std::nan("");
        for (const Nearby& one : nearby) known += one.count == Nearby::most ? 1 : 0;
        tool.gap(points, x.data(), g.data(), n.data(), H.data());
        tool.gap_again(points, x.data(), nearby.data(), again.data(), &again[points], &again[4 * points]);
        for (int q = 0; q < points; ++q) {
            if (std::isnan(x[3 * q])) continue;
            wrong += g[q] == again[q] ? 0 : 1;
            for (int k = 0; k < 3; ++k) wrong += n[3 * q + k] == again[points + 3 * q + k] ? 0 : 1;
            for (int k = 0; k < 9; ++k) wrong += H[9 * q + k] == again[4 * points + 9 * q + k] ? 0 : 1;
        }
    }
    CHECK(wrong == 0);
    CHECK(known > 20 * points);
}

void test_nearby() {
    Nearby nearby;
    nearby.clear({1.0, 2.0, 3.0});
    for (int i = 0; i < 50; ++i) nearby.add(i, std::fmod(7.0 * i, 50.0));
    CHECK(nearby.count == Nearby::most);
    for (int k = 0; k < Nearby::most; ++k) {
        CHECK_NEAR(nearby.least[k], k, 0.0);
        CHECK_NEAR(std::fmod(7.0 * nearby.part[k], 50.0), k, 0.0);
        CHECK(nearby.has(nearby.part[k]));
    }
    CHECK_NEAR(nearby.others, Nearby::most, 0.0);
    CHECK(!nearby.has(-1));
}

}  // namespace

int main() {
    test_derivatives();
    test_flat_foot();
    test_foot();
    test_tree();
    test_nearby();
    test_searches_that_remember(Across::Smooth);
    test_searches_that_remember(Across::Rim);
    return report("triangulated");
}
