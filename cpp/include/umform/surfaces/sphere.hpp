// Solid ball, or the space around a bowl of the same radius.
#pragma once

#include "umform/surfaces/concept.hpp"

namespace umform {

struct Sphere {
    Vec3 centre;
    double radius;
    bool inside;  // the sheet lies inside of the sphere

    static constexpr bool is_distance = true;

    /// H = (1 - n n^T) / rho with rho the distance to the centre. eq. (4.3)
    Gap gap(const Vec3& x) const {
        const Vec3 d{x[0] - centre[0], x[1] - centre[1], x[2] - centre[2]};
        const double rho = std::sqrt(dot(d, d));
        Gap gap{rho - radius, {d[0] / rho, d[1] / rho, d[2] / rho}, {}};
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) gap.H(i, j) = ((i == j ? 1.0 : 0.0) - gap.n[i] * gap.n[j]) / rho;
        return inside ? turned_inside(gap) : gap;
    }
};

}  // namespace umform
