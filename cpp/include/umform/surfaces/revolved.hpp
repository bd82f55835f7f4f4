// Plane profile turned about an axis: its x is the distance to the axis, its y goes along the axis.
#pragma once

#include "umform/surfaces/concept.hpp"
#include "umform/surfaces/profile.hpp"

namespace umform {

struct Revolved {
    Profile profile;
    Vec3 origin, axis;

    static constexpr bool is_distance = true;

    /// H = k t t^T + (n_rho / rho) h h^T with h around the axis. eq. (4.26)
    Gap gap(const Vec3& at) const {
        Vec3 e{at[0] - origin[0], at[1] - origin[1], at[2] - origin[2]};
        const double z = dot(e, axis);
        for (int i = 0; i < 3; ++i) e[i] -= z * axis[i];
        const double rho = std::sqrt(dot(e, e));
        const PlaneGap plane = profile.gap({rho, z});
        e = rho > 0.0 ? Vec3{e[0] / rho, e[1] / rho, e[2] / rho} : across_axis();
        const Vec3 h = cross(axis, e);
        const double hoop = hoop_curvature(plane, rho, z);
        Gap gap{plane.g, {}, {}};
        Vec3 t;
        for (int i = 0; i < 3; ++i) {
            gap.n[i] = plane.n[0] * e[i] + plane.n[1] * axis[i];
            t[i] = plane.n[0] * axis[i] - plane.n[1] * e[i];
        }
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) gap.H(i, j) = plane.k * t[i] * t[j] + hoop * h[i] * h[j];
        return gap;
    }

  private:
    /// On the axis of a smooth surface the two curvatures are equal. Where n leaves the axis at an angle there is a kink: 0.
    double hoop_curvature(const PlaneGap& plane, double rho, double z) const {
        if (rho > 1e-12 * (profile.size() + std::abs(z))) return plane.n[0] / rho;
        return std::abs(plane.n[0]) < 1e-6 ? plane.k : 0.0;
    }

    /// The coordinate direction that is farthest from the axis, made perpendicular to it.
    Vec3 across_axis() const {
        int least = 0;
        for (int i = 1; i < 3; ++i)
            if (std::abs(axis[i]) < std::abs(axis[least])) least = i;
        Vec3 e{};
        e[least] = 1.0;
        for (int i = 0; i < 3; ++i) e[i] -= axis[least] * axis[i];
        return normalised(e);
    }
};

}  // namespace umform
