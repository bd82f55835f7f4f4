// The point of a deformable facet whose normal meets a place, and how it moves with both.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "umform/contact/sheets/facet_at.hpp"

namespace umform {

/// Where a place meets the other face: on which facet or, beyond it, on which of its cut edges; where on it, at which gap. A facet
/// below zero: nowhere. An edge below zero: on the facet; r runs along an edge.
struct FacetFoot {
    std::int32_t facet = -1, rim = -1;
    double r = 0.0, s = 0.0, gap = 0.0;
    Vec3 n{};

    bool found() const { return facet >= 0; }
    /// How far it is beyond the edges of its facet, in natural coordinates.
    double beyond() const { return std::max({std::abs(r) - 1.0, std::abs(s) - 1.0, 0.0}); }
};

/// Inverse of the derivative of x = y(r, s) + g n(r, s) with respect to r, s and g.
template <int Nodes>
Mat3 inverse_of_moves(const OnFacet<Nodes>& at, double g) {
    Mat3 J;
    for (int i = 0; i < 3; ++i) {
        J(i, 0) = at.tau[0][i] + g * at.dn[0][i];
        J(i, 1) = at.tau[1][i] + g * at.dn[1][i];
        J(i, 2) = at.n[i];
    }
    return inverse(J);
}

/// Change of a natural coordinate at a place that is none: far from the origin the positions have no more digits. side: length of
/// the tangent.
inline double no_change(double least, const Vec3& x, double side) {
    const double far = std::max({std::abs(x[0]), std::abs(x[1]), std::abs(x[2])});
    return std::max(least, 16.0 * std::numeric_limits<double>::epsilon() * far / side);
}

/// The point of a facet, continued beyond its edges up to `farthest`, from which its normal leads to x; whether there is one. eq. (4.301)
template <int Nodes>
bool project(const SmoothFacet<Nodes>& facet, const Vec3& x, double farthest, FacetFoot& foot) {
    double r = 0.0, s = 0.0, g = 0.0;
    for (int iteration = 0; iteration < 30; ++iteration) {
        const OnFacet<Nodes> at(facet, r, s);
        if (iteration == 0) g = at.n[0] * (x[0] - at.y[0]) + at.n[1] * (x[1] - at.y[1]) + at.n[2] * (x[2] - at.y[2]);
        Vec3 left;
        for (int k = 0; k < 3; ++k) left[k] = x[k] - at.y[k] - g * at.n[k];
        Vec3 step = product(inverse_of_moves(at, g), left);
        const double longest = std::max(std::abs(step[0]), std::abs(step[1]));
        if (!std::isfinite(longest + step[2])) return false;
        if (longest > 1.0)
            for (double& value : step) value /= longest;
        r += step[0], s += step[1], g += step[2];
        if (std::max(std::abs(r), std::abs(s)) > farthest + 2.0) return false;
        const double shorter = std::sqrt(std::min(dot(at.tau[0], at.tau[0]), dot(at.tau[1], at.tau[1])));
        if (longest < no_change(1e-13, x, shorter)) {
            foot.r = r, foot.s = s, foot.gap = g, foot.n = OnFacet<Nodes>(facet, r, s).n;
            return std::max(std::abs(r), std::abs(s)) <= 1.0 + farthest;
        }
    }
    return false;
}

/// Derivatives of the natural coordinates, the gap and the normal of a foot with respect to w = (d, h): the difference of place and
/// foot, and the normal there, both at fixed coordinates. eqs. (4.303), (4.304)
template <int Nodes>
struct FootMoves {
    std::array<std::array<Vec3, 2>, 2> xi;  // [coordinate][of w]: a row of three numbers
    std::array<Vec3, 2> gap;                // [of w]
    std::array<Mat3, 2> n;                  // [of w]
    std::array<Vec3, 2> dual;               // of the tangents across the normal: tau_a . dual_b = delta_ab

    FootMoves(const OnFacet<Nodes>& at, const FacetFoot& foot) {
        const Mat3 inverse = inverse_of_moves(at, foot.gap);
        for (int j = 0; j < 3; ++j) {
            for (int a = 0; a < 2; ++a) xi[a][0][j] = inverse(a, j), xi[a][1][j] = -foot.gap * inverse(a, j);
            gap[0][j] = inverse(2, j), gap[1][j] = -foot.gap * inverse(2, j);
        }
        for (int w = 0; w < 2; ++w)
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    n[w](i, j) = (w == 1 && i == j ? 1.0 : 0.0) + at.dn[0][i] * xi[0][w][j] + at.dn[1][i] * xi[1][w][j];
        const Vec3 one = across(at.tau[0], at.n), two = across(at.tau[1], at.n);
        const double m00 = dot(one, one), m01 = dot(one, two), m11 = dot(two, two);
        const double scale = 1.0 / (m00 * m11 - m01 * m01);
        for (int k = 0; k < 3; ++k) {
            dual[0][k] = scale * (m11 * one[k] - m01 * two[k]);
            dual[1][k] = scale * (m00 * two[k] - m01 * one[k]);
        }
    }
};

}  // namespace umform
