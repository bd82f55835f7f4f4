// What an evaluation of a contact came across: a value that later evaluations do not change.
#pragma once

#include <cstdint>
#include <vector>

#include "umform/algebra/tensor.hpp"

namespace umform {

struct ContactFound {
    std::vector<std::uint8_t> active;  // for each contact point, 1 where the tool holds it, 2 where it slips as well
    // Of the points that are held, in their order:
    std::vector<std::int32_t> points;          // their numbers
    std::vector<Vec3> x, normal;               // position, unit normal out of the tool
    std::vector<Vec3> traction;                // of the tool on the sheet, on the reference area
    std::vector<Vec3> force;                   // of the sheet on the tool: -traction times area
    std::vector<double> gap, pressure, area;   // pressure: the normal part of the traction
    std::vector<double> share;                 // of the area that is held, 1 at points
    std::vector<Vec3> elastic_slip;            // along the tool; zero without friction
    std::vector<double> tangential_stiffness;  // traction per elastic slip
    std::vector<double> slip;                  // distance slid so far
    // Energy of the elastic slip, and the work of friction so far, at all points:
    double stored = 0.0, friction_work = 0.0;
    double work_above_mean = 0.0;    // part of the work of friction that no mean of forces has. eq. (4.220)
    double contact_work = 0.0;       // of the pressure so far, of rules that measure it along the way
    double penetration = 0.0;        // the largest, zero if there is none
    double round_off_squared = 0.0;  // see ContactBlock
};

}  // namespace umform
