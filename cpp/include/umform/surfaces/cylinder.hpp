// Solid round bar of endless length, or the space around a bore of the same radius.
#pragma once

#include "umform/surfaces/concept.hpp"

namespace umform {

struct Cylinder {
    Vec3 centre, axis;  // a point of the axis and its unit direction
    double radius;
    bool inside;  // the sheet lies inside of the bore

    static constexpr bool is_distance = true;

    /// H = (1 - a a^T - n n^T) / rho with rho the distance to the axis. eq. (4.3)
    Gap gap(const Vec3& x) const {
        Vec3 d{x[0] - centre[0], x[1] - centre[1], x[2] - centre[2]};
        const double along = dot(d, axis);
        for (int i = 0; i < 3; ++i) d[i] -= along * axis[i];
        const double rho = std::sqrt(dot(d, d));
        Gap gap{rho - radius, {d[0] / rho, d[1] / rho, d[2] / rho}, {}};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                gap.H(i, j) = ((i == j ? 1.0 : 0.0) - axis[i] * axis[j] - gap.n[i] * gap.n[j]) / rho;
        return inside ? turned_inside(gap) : gap;
    }
};

}  // namespace umform
