// Positions, tangents and their derivatives on a deformable facet.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "umform/algebra/tensor.hpp"
#include "umform/elements/topology.hpp"

namespace umform {

template <int Nodes>
Vec3 combined(const std::array<double, Nodes>& N, const std::array<Vec3, Nodes>& x) {
    Vec3 sum{};
    for (int a = 0; a < Nodes; ++a)
        for (int k = 0; k < 3; ++k) sum[k] += N[a] * x[a][k];
    return sum;
}

/// Positions of some nodes.
template <int Nodes>
std::array<Vec3, Nodes> nodes_of(const std::int32_t* ids, const std::vector<Vec3>& x) {
    std::array<Vec3, Nodes> found;
    for (int a = 0; a < Nodes; ++a) found[a] = x[ids[a]];
    return found;
}

/// Some (I - n n^T) / length times a matrix.
inline Mat3 across(const Mat3& m, const Vec3& n, double length) {
    Mat3 out;
    for (int j = 0; j < 3; ++j) {
        const double along = n[0] * m(0, j) + n[1] * m(1, j) + n[2] * m(2, j);
        for (int i = 0; i < 3; ++i) out(i, j) = (m(i, j) - along * n[i]) / length;
    }
    return out;
}

/// What is left of a vector across n.
inline Vec3 across(const Vec3& q, const Vec3& n) {
    const double along = dot(n, q);
    return {q[0] - along * n[0], q[1] - along * n[1], q[2] - along * n[2]};
}

/// A deformable facet: its nodes, and the normals there.
template <int Nodes>
struct SmoothFacet {
    std::array<Vec3, Nodes> x, nu;
};

/// Position, tangents, unit normal and its derivatives at (r, s) of a facet, where it interpolates the normals of its nodes. eq. (4.302)
template <int Nodes>
struct OnFacet {
    FaceShape<Nodes> shape;
    Vec3 y, n;
    std::array<Vec3, 2> tau, dn;
    double length;  // of the interpolated normal

    OnFacet(const SmoothFacet<Nodes>& facet, double r, double s) : shape(face_shape<Nodes>(r, s)) {
        y = combined<Nodes>(shape.N, facet.x);
        tau = {combined<Nodes>(shape.Nr, facet.x), combined<Nodes>(shape.Ns, facet.x)};
        const Vec3 nu = combined<Nodes>(shape.N, facet.nu);
        length = std::sqrt(dot(nu, nu));
        for (int k = 0; k < 3; ++k) n[k] = nu[k] / length;
        dn = {across(combined<Nodes>(shape.Nr, facet.nu), n), across(combined<Nodes>(shape.Ns, facet.nu), n)};
        for (Vec3& slope : dn)
            for (double& value : slope) value /= length;
    }
};

}  // namespace umform
