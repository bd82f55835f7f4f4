// Triangular Bezier patch of degree 4: position and derivatives, foot of a point.
#pragma once

#include <algorithm>
#include <cstring>

#include "umform/algebra/lanes.hpp"
#include "umform/algebra/tensor.hpp"

namespace umform {

inline Vec3 difference(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// Place of a patch with its derivatives by u and v.
struct PatchPoint {
    Vec3 S, Su, Sv, Suu, Suv, Svv;
};

/// Weights of the corners a, b, c of a patch are (1 - u - v, u, v).
struct PatchParameter {
    double u, v;
};

struct QuarticPatch {
    /// Rows from the edge a b to the corner c, of 5, 4, 3, 2 and 1 points, each from the side of a to that of b.
    std::array<Vec3, 15> control;

    static constexpr int a = 0, b = 4, c = 14;

    /// Two steps of de Casteljau's algorithm leave the six points that second derivatives need. The coordinates are lanes.
    PatchPoint at(const PatchParameter& p) const {
        static_assert(lane_count == 4 && sizeof(control) == 45 * sizeof(double));
        const Lanes r = 1.0 - p.u - p.v, u = p.u, v = p.v;
        std::array<Lanes, 15> quartic;
        std::array<Lanes, 10> cubic;
        std::array<Lanes, 6> q;
        const char* numbers = reinterpret_cast<const char*>(&control);
        for (int i = 0; i < 14; ++i)  // the fourth lane is unused
            std::memcpy(&quartic[i], numbers + i * sizeof(Vec3), sizeof(Lanes));
        quartic[14] = Lanes::Vector{control[14][0], control[14][1], control[14][2], 0.0};
        reduce<4>(quartic.data(), r, u, v, cubic.data());
        reduce<3>(cubic.data(), r, u, v, q.data());
        const Lanes A = r * q[0] + u * q[1] + v * q[3];
        const Lanes B = r * q[1] + u * q[2] + v * q[4];
        const Lanes C = r * q[3] + u * q[4] + v * q[5];
        return {vector(r * A + u * B + v * C),
                vector(4.0 * (B - A)),
                vector(4.0 * (C - A)),
                vector(12.0 * (q[2] - 2.0 * q[1] + q[0])),
                vector(12.0 * (q[4] - q[1] - q[3] + q[0])),
                vector(12.0 * (q[5] - 2.0 * q[3] + q[0]))};
    }

  private:
    static Vec3 vector(Lanes x) { return {x[0], x[1], x[2]}; }

    /// From the points of degree Degree to those of one less.
    template <int Degree>
    static void reduce(const Lanes* from, Lanes r, Lanes u, Lanes v, Lanes* to) {
        for (int row = 0; row < Degree; ++row) {
            const int width = Degree + 1 - row;
            for (int i = 0; i < width - 1; ++i, ++to) *to = r * from[i] + u * from[i + 1] + v * from[width + i];
            from += width;
        }
    }
};

/// Nearest point of a flat triangle: its weights, and the square of its distance.
struct FlatFoot {
    PatchParameter p;
    double square;
};

/// The Voronoi regions of corners, edges and face determine where the foot lies.
inline FlatFoot foot_on_triangle(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = difference(b, a), ac = difference(c, a), ax = difference(x, a);
    const auto with = [&](double u, double v) {
        Vec3 d;
        for (int k = 0; k < 3; ++k) d[k] = ax[k] - u * ab[k] - v * ac[k];
        return FlatFoot{{u, v}, dot(d, d)};
    };
    const double d1 = dot(ab, ax), d2 = dot(ac, ax);
    if (d1 <= 0.0 && d2 <= 0.0) return with(0.0, 0.0);
    const Vec3 bx = difference(x, b);
    const double d3 = dot(ab, bx), d4 = dot(ac, bx);
    if (d3 >= 0.0 && d4 <= d3) return with(1.0, 0.0);
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return with(d1 / (d1 - d3), 0.0);
    const Vec3 cx = difference(x, c);
    const double d5 = dot(ab, cx), d6 = dot(ac, cx);
    if (d6 >= 0.0 && d5 <= d6) return with(0.0, 1.0);
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return with(0.0, d2 / (d2 - d6));
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
        const double v = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return with(1.0 - v, v);
    }
    return with(vb / (va + vb + vc), vc / (va + vb + vc));
}

}  // namespace umform
