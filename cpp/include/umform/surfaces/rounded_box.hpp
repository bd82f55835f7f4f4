// Solid box whose edges are cylinders and whose corners are spheres.
#pragma once

#include <algorithm>

#include "umform/surfaces/concept.hpp"

namespace umform {

struct RoundedBox {
    Vec3 centre;
    Mat3 axes;  // rows: unit directions of its edges
    Vec3 core;  // half of the edges, less the radius
    double radius;

    static constexpr bool is_distance = true;

    /// Distance to the core less the radius; n and H live in the directions in which x lies beyond the core. eq. (4.27)
    Gap gap(const Vec3& x) const {
        const Vec3 d{x[0] - centre[0], x[1] - centre[1], x[2] - centre[2]};
        Vec3 beyond, side;
        double squared = 0.0;
        for (int k = 0; k < 3; ++k) {
            const double along = axes(k, 0) * d[0] + axes(k, 1) * d[1] + axes(k, 2) * d[2];
            side[k] = along < 0.0 ? -1.0 : 1.0;
            beyond[k] = std::abs(along) - core[k];
            if (beyond[k] > 0.0) squared += beyond[k] * beyond[k];
        }
        if (squared == 0.0) return from_inside(beyond, side);
        const double rho = std::sqrt(squared);
        Vec3 n{};
        int directions = 0;
        for (int k = 0; k < 3; ++k)
            if (beyond[k] > 0.0) n[k] = side[k] * beyond[k] / rho, ++directions;
        Mat3 H{};
        if (directions > 1)
            for (int k = 0; k < 3; ++k)
                for (int l = 0; l < 3; ++l) H(k, l) = ((k == l && beyond[k] > 0.0 ? 1.0 : 0.0) - n[k] * n[l]) / rho;
        return to_space(rho - radius, n, H);
    }

  private:
    /// In the core the nearest face counts, the first of equals.
    Gap from_inside(const Vec3& beyond, const Vec3& side) const {
        const auto k = std::max_element(beyond.begin(), beyond.end()) - beyond.begin();
        Vec3 n{};
        n[k] = side[k];
        return to_space(beyond[k] - radius, n, {});
    }

    Gap to_space(double g, const Vec3& n, const Mat3& H) const {
        Gap gap{g, {}, {}};
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) {
                gap.n[i] += axes(k, i) * n[k];
                double row = 0.0;  // (H axes)_ki
                for (int l = 0; l < 3; ++l) row += H(k, l) * axes(l, i);
                for (int j = 0; j < 3; ++j) gap.H(j, i) += axes(k, j) * row;
            }
        return gap;
    }
};

}  // namespace umform
