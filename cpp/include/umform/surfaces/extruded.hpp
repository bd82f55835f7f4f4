// Plane profile drawn out endlessly at right angles to its plane.
#pragma once

#include "umform/surfaces/concept.hpp"
#include "umform/surfaces/profile.hpp"

namespace umform {

struct Extruded {
    Profile profile;
    Vec3 origin, x, y;  // where the profile has its origin and its two directions

    static constexpr bool is_distance = true;

    /// H = k t t^T, t = n_x y - n_y x. eq. (4.25)
    Gap gap(const Vec3& at) const {
        const Vec3 d{at[0] - origin[0], at[1] - origin[1], at[2] - origin[2]};
        const PlaneGap plane = profile.gap({dot(d, x), dot(d, y)});
        Gap gap{plane.g, {}, {}};
        Vec3 t;
        for (int i = 0; i < 3; ++i) {
            gap.n[i] = plane.n[0] * x[i] + plane.n[1] * y[i];
            t[i] = plane.n[0] * y[i] - plane.n[1] * x[i];
        }
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) gap.H(i, j) = plane.k * t[i] * t[j];
        return gap;
    }
};

}  // namespace umform
