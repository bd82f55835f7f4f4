// Plane profile led around a rectangle with rounded corners: its x is the distance outwards from the rectangle.
#pragma once

#include <algorithm>

#include "umform/surfaces/concept.hpp"
#include "umform/surfaces/profile.hpp"

namespace umform {

struct LedAround {
    Profile profile;
    Vec3 origin;
    Mat3 axes;                   // rows: along the sides of the rectangle, and across it
    std::array<double, 2> core;  // half of the sides, less the radius of the corners
    double corner;

    static constexpr bool is_distance = true;

    /// As of a profile turned about an axis, but the radius is the distance from the core as it is in a rounded box: along
    /// the sides there is no curvature around. eqs. (4.26), (4.27)
    Gap gap(const Vec3& at) const {
        const Vec3 d{at[0] - origin[0], at[1] - origin[1], at[2] - origin[2]};
        Vec3 local{};
        for (int k = 0; k < 3; ++k)
            for (int i = 0; i < 3; ++i) local[k] += axes(k, i) * d[i];
        std::array<double, 2> side, beyond;
        for (int k = 0; k < 2; ++k) {
            side[k] = local[k] < 0.0 ? -1.0 : 1.0;
            beyond[k] = std::abs(local[k]) - core[k];
        }
        const bool at_corner = beyond[0] > 0.0 && beyond[1] > 0.0;
        const double rho = at_corner ? std::hypot(beyond[0], beyond[1]) : std::max(beyond[0], beyond[1]);
        std::array<double, 2> e{};
        if (at_corner)
            for (int k = 0; k < 2; ++k) e[k] = side[k] * beyond[k] / rho;
        else
            e[beyond[0] < beyond[1]] = side[beyond[0] < beyond[1]];
        const PlaneGap plane = profile.gap({rho - corner, local[2]});
        const double hoop = at_corner ? plane.n[0] / rho : 0.0;
        const Vec3 n{plane.n[0] * e[0], plane.n[0] * e[1], plane.n[1]};
        const Vec3 t{-plane.n[1] * e[0], -plane.n[1] * e[1], plane.n[0]}, h{-e[1], e[0], 0.0};
        return to_space(plane.g, n, t, plane.k, h, hoop);
    }

  private:
    Gap to_space(double g, const Vec3& n, const Vec3& t, double k, const Vec3& h, double hoop) const {
        Gap gap{g, {}, {}};
        Vec3 along{}, around{};
        for (int i = 0; i < 3; ++i)
            for (int l = 0; l < 3; ++l) {
                gap.n[i] += axes(l, i) * n[l];
                along[i] += axes(l, i) * t[l];
                around[i] += axes(l, i) * h[l];
            }
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) gap.H(i, j) = k * along[i] * along[j] + hoop * around[i] * around[j];
        return gap;
    }
};

}  // namespace umform
