// Convected base vectors, covariant strains and their passage to the local orthonormal frame.
#pragma once

#include "umform/tensor.hpp"

namespace umform {

/// Derivative of a nodal field: sum_a dN[a] v_a; the field is stored by direction, v[direction * nodes + a].
template <int Nodes>
Vec3 derivative(const double* dN, const double* v) {
    Vec3 sum;
    for (int k = 0; k < 3; ++k) {
        double s = 0.0;
#pragma omp simd reduction(+ : s)
        for (int a = 0; a < Nodes; ++a) s += dN[a] * v[k * Nodes + a];
        sum[k] = s;
    }
    return sum;
}

/// Covariant Green-Lagrange strain E_ij = (G_i.h_j + h_i.G_j + h_i.h_j) / 2 with h_i = u,i: the metric difference
/// (g_i.g_j - G_i.G_j) / 2 without its cancellation. Shears are engineering shears. eq. (1.7)
inline double covariant_strain(int i, int j, const Vec3& Gi, const Vec3& Gj, const Vec3& hi, const Vec3& hj) {
    const double twice = dot(Gi, hj) + dot(hi, Gj) + dot(hi, hj);
    return i == j ? 0.5 * twice : twice;
}

/// Local orthonormal frame (columns e_1, e_2, e_3): e_3 normal to the layer, e_1 along G_1. eq. (1.13)
inline std::array<Vec3, 3> local_frame(const std::array<Vec3, 3>& G) {
    const Vec3 e3 = normalised(cross(G[0], G[1])), e1 = normalised(G[0]);
    return {e1, cross(e3, e1), e3};
}

/// T with E_local = T E_covariant in Voigt components, from J^-1 with J_ki = e_k.G_i. eq. (1.16)
inline Voigt66 strain_transform(const Mat3& Jinv) {
    Voigt66 T;
    for (int p = 0; p < 6; ++p) {
        const auto [k, l] = voigt_pair[p];
        for (int q = 0; q < 6; ++q) {
            const auto [i, j] = voigt_pair[q];
            T(p, q) = Jinv(i, k) * Jinv(j, l) + (p < 3 ? 0.0 : Jinv(i, l) * Jinv(j, k));
        }
    }
    return T;
}

}  // namespace umform
