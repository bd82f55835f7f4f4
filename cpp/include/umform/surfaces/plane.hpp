// Half-space behind a plane.
#pragma once

#include "umform/surfaces/concept.hpp"

namespace umform {

struct Plane {
    Vec3 point, normal;  // unit normal, out of the tool

    static constexpr bool is_distance = true;

    Gap gap(const Vec3& x) const {
        return {dot({x[0] - point[0], x[1] - point[1], x[2] - point[2]}, normal), normal, Mat3{}};
    }
};

}  // namespace umform
