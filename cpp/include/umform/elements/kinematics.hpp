// Convected base vectors, covariant strains and their passage to the local orthonormal frame.
#pragma once

#include "umform/algebra/tensor.hpp"

namespace umform {

/// Derivative of a nodal field: sum_a dN[a] v_a; the field is stored by direction, v[direction * nodes + a].
template <int Nodes, class Real>
Vec<Real, 3> derivative(const double* dN, const Real* v) {
    Vec<Real, 3> sum{};
    for (int k = 0; k < 3; ++k)
        for (int a = 0; a < Nodes; ++a) sum[k] += dN[a] * v[k * Nodes + a];
    return sum;
}

/// Covariant Green-Lagrange strain E_ij = (G_i.h_j + h_i.G_j + h_i.h_j) / 2 with h_i = u,i: the metric difference
/// (g_i.g_j - G_i.G_j) / 2 without its cancellation. Shears are engineering shears. eq. (1.7)
template <class Real>
[[gnu::always_inline]] inline Real covariant_strain(int i, int j, const std::array<Vec<Real, 3>, 3>& G,
                                                    const std::array<Vec<Real, 3>, 3>& h) {
    const Real twice = dot(G[i], h[j]) + dot(h[i], G[j]) + dot(h[i], h[j]);
    return i == j ? 0.5 * twice : twice;
}

/// What is quadratic in h of the covariant strain. eq. (1.7)
template <class Real>
[[gnu::always_inline]] inline Real quadratic_strain(int i, int j, const std::array<Vec<Real, 3>, 3>& h) {
    return i == j ? 0.5 * dot(h[i], h[i]) : dot(h[i], h[j]);
}

/// The base vectors as the columns of a matrix.
template <class Real>
Mat<Real, 3, 3> columns(const std::array<Vec<Real, 3>, 3>& v) {
    return {{v[0][0], v[1][0], v[2][0], v[0][1], v[1][1], v[2][1], v[0][2], v[1][2], v[2][2]}};
}

/// Local orthonormal frame (e_1, e_2, e_3): e_3 normal to the layer, e_1 along G_1. eq. (1.13)
template <class Real>
Axes<Real> local_frame(const std::array<Vec<Real, 3>, 3>& G) {
    const Vec<Real, 3> e3 = normalised(cross(G[0], G[1])), e1 = normalised(G[0]);
    return {e1, cross(e3, e1), e3};
}

/// The same with e_1 along the rolling direction, which is projected onto the layer. eq. (1.26)
template <class Real>
Axes<Real> local_frame(const std::array<Vec<Real, 3>, 3>& G, const Vec<Real, 3>& rolling) {
    const Vec<Real, 3> e3 = normalised(cross(G[0], G[1]));
    const Real out_of_plane = dot(rolling, e3);
    Vec<Real, 3> in_plane;
    for (int k = 0; k < 3; ++k) in_plane[k] = rolling[k] - out_of_plane * e3[k];
    const Vec<Real, 3> e1 = normalised(in_plane);
    return {e1, cross(e3, e1), e3};
}

/// J^-1 in the local frame with J_ki = e_k.G_i. Like J it is an upper triangle, since e_3 is normal to G_1 and G_2 and
/// e_1 is along G_1; what is below it is not read. eq. (1.14)
template <class Real>
[[gnu::always_inline]] inline Mat<Real, 3, 3> local_inverse(const std::array<Vec<Real, 3>, 3>& G) {
    const std::array<Vec<Real, 3>, 3> e = local_frame(G);
    const Real J01 = dot(e[0], G[1]), J02 = dot(e[0], G[2]), J12 = dot(e[1], G[2]);
    Mat<Real, 3, 3> A;
    for (int i = 0; i < 3; ++i) A(i, i) = 1.0 / dot(e[i], G[i]);
    A(0, 1) = -J01 * A(0, 0) * A(1, 1);
    A(1, 2) = -J12 * A(1, 1) * A(2, 2);
    A(0, 2) = (J01 * J12 * A(1, 1) - J02) * A(0, 0) * A(2, 2);
    return A;
}

/// J^-1 in any local frame whose e_3 is normal to G_1 and G_2: its third row is (0, 0, 1 / J_33). eq. (1.27)
template <class Real>
Mat<Real, 3, 3> local_inverse(const std::array<Vec<Real, 3>, 3>& G, const Axes<Real>& e) {
    const Real J00 = dot(e[0], G[0]), J01 = dot(e[0], G[1]), J10 = dot(e[1], G[0]), J11 = dot(e[1], G[1]);
    const Real J02 = dot(e[0], G[2]), J12 = dot(e[1], G[2]), f = 1.0 / (J00 * J11 - J01 * J10);
    Mat<Real, 3, 3> A;
    A(0, 0) = f * J11, A(0, 1) = -f * J01;
    A(1, 0) = -f * J10, A(1, 1) = f * J00;
    A(2, 2) = 1.0 / dot(e[2], G[2]);
    for (int i = 0; i < 2; ++i) A(i, 2) = -(A(i, 0) * J02 + A(i, 1) * J12) * A(2, 2);
    return A;
}

/// E_local = A^T E_cov A with the upper triangle A = J^-1. eq. (1.15)
template <class Real>
[[gnu::always_inline]] inline Vec<Real, 6> to_local(const Mat<Real, 3, 3>& A, const Vec<Real, 6>& covariant) {
    const Mat<Real, 3, 3> E = from_voigt(covariant, 0.5);
    Mat<Real, 3, 3> EA;
    for (int i = 0; i < 3; ++i)
        for (int l = i > 1 ? i : 0; l < 3; ++l) {
            Real sum = E(i, 0) * A(0, l);
            for (int j = 1; j <= l; ++j) sum += E(i, j) * A(j, l);
            EA(i, l) = sum;
        }
    Vec<Real, 6> local;
    for (int p = 0; p < 6; ++p) {
        const auto [k, l] = voigt_pair[p];
        Real sum = A(0, k) * EA(0, l);
        for (int i = 1; i <= k; ++i) sum += A(i, k) * EA(i, l);
        local[p] = p < 3 ? sum : 2.0 * sum;
    }
    return local;
}

/// S_con = A S_local A^T with the upper triangle A = J^-1: the first half of eq. (1.17); applied to the columns and then
/// to the rows of CC it is the second half. Components of S are `stride` apart.
template <class Real>
[[gnu::always_inline]] inline void to_contravariant(const Mat<Real, 3, 3>& A, const Real* S, int stride, Real* out) {
    const Real S11 = S[0], S22 = S[stride], S33 = S[2 * stride], S12 = S[3 * stride], S23 = S[4 * stride],
               S13 = S[5 * stride];
    // Rows of A S on and to the right of the diagonal.
    const Real P11 = A(0, 0) * S11 + A(0, 1) * S12 + A(0, 2) * S13, P12 = A(0, 0) * S12 + A(0, 1) * S22 + A(0, 2) * S23,
               P13 = A(0, 0) * S13 + A(0, 1) * S23 + A(0, 2) * S33;
    const Real P22 = A(1, 1) * S22 + A(1, 2) * S23, P23 = A(1, 1) * S23 + A(1, 2) * S33, P33 = A(2, 2) * S33;
    out[C11] = P11 * A(0, 0) + P12 * A(0, 1) + P13 * A(0, 2);
    out[C22] = P22 * A(1, 1) + P23 * A(1, 2);
    out[C33] = P33 * A(2, 2);
    out[C12] = P12 * A(1, 1) + P13 * A(1, 2);
    out[C23] = P23 * A(2, 2);
    out[C13] = P13 * A(2, 2);
}

/// `to_local` with a full matrix A.
template <class Real>
Vec<Real, 6> to_local_full(const Mat<Real, 3, 3>& A, const Vec<Real, 6>& covariant) {
    const Mat<Real, 3, 3> EA = product(from_voigt(covariant, 0.5), A);
    Vec<Real, 6> local;
    for (int p = 0; p < 6; ++p) {
        const auto [k, l] = voigt_pair[p];
        const Real sum = A(0, k) * EA(0, l) + A(1, k) * EA(1, l) + A(2, k) * EA(2, l);
        local[p] = p < 3 ? sum : 2.0 * sum;
    }
    return local;
}

/// `to_contravariant` with a full matrix A.
template <class Real>
void to_contravariant_full(const Mat<Real, 3, 3>& A, const Real* S, int stride, Real* out) {
    Mat<Real, 3, 3> tensor;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) tensor(i, j) = S[voigt_index[i][j] * stride];
    const Mat<Real, 3, 3> AS = product(A, tensor);
    for (int p = 0; p < 6; ++p) {
        const auto [k, l] = voigt_pair[p];
        out[p] = AS(k, 0) * A(l, 0) + AS(k, 1) * A(l, 1) + AS(k, 2) * A(l, 2);
    }
}

}  // namespace umform
