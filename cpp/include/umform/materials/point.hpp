// Data of the points at which a law is evaluated: the axes of the sheet, the size of the element, the step.
#pragma once

#include <cstdint>

#include "umform/algebra/tensor.hpp"

namespace umform {

/// One point, or the same point of the elements in the lanes. The axes are those of the local frame: e_3 is normal to the sheet,
/// e_1 along the rolling direction where there is one, else along G_1. eqs. (1.13), (1.26)
template <class Real>
struct Point {
    Axes<Real> axes{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
    Real size = 0.0;    // root of the area of the undeformed mid-surface of the element
    double step = 0.0;  // increment of time
};

/// The points of the elements in the lanes.
struct LanePoints {
    std::array<std::int32_t, lane_count> cell{};  // numbers of the elements, for messages
    const Axes<Lanes>* axes = nullptr;            // [n]; null unless the law needs its points
    Lanes size = 0.0;
    double step = 0.0;
};

}  // namespace umform
