// Small fixed-size algebra: vectors, matrices, Voigt order, the symmetric 3x3 eigenproblem.
#pragma once

#include <array>
#include <cmath>
#include <utility>

#include "umform/algebra/lanes.hpp"

namespace umform {

template <class T, int N>
using Vec = std::array<T, N>;

/// Dense matrix of fixed size, stored by rows.
template <class T, int Rows, int Cols>
struct Mat {
    std::array<T, Rows * Cols> a{};

    constexpr T& operator()(int i, int j) { return a[i * Cols + j]; }
    constexpr const T& operator()(int i, int j) const { return a[i * Cols + j]; }
};

/// Orthonormal axes e_1, e_2, e_3, each in global components.
template <class T>
using Axes = std::array<Vec<T, 3>, 3>;

using Vec3 = Vec<double, 3>;
using Mat3 = Mat<double, 3, 3>;

/// Voigt order of symmetric tensors: 11 22 33 12 23 13. Strains carry engineering shears (2 E_ij).
using Voigt = Vec<double, 6>;
using Voigt66 = Mat<double, 6, 6>;

enum Component : int { C11, C22, C33, C12, C23, C13 };

/// Tensor indices (i, j) of a Voigt component.
inline constexpr std::array<std::array<int, 2>, 6> voigt_pair{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};

/// Voigt component of the tensor indices (i, j).
inline constexpr std::array<std::array<int, 3>, 3> voigt_index{{{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}};

template <class T, std::size_t N>
constexpr T dot(const std::array<T, N>& a, const std::array<T, N>& b) {
    T sum{};
    for (std::size_t i = 0; i < N; ++i) sum += a[i] * b[i];
    return sum;
}

template <class T>
constexpr Vec<T, 3> cross(const Vec<T, 3>& a, const Vec<T, 3>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

template <class T = double>
Vec<T, 3> normalised(const Vec<T, 3>& a) {
    const T inverse_length = 1.0 / sqrt(dot(a, a));
    return {a[0] * inverse_length, a[1] * inverse_length, a[2] * inverse_length};
}

template <class T>
constexpr T det(const Mat<T, 3, 3>& m) {
    return m(0, 0) * (m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1)) - m(0, 1) * (m(1, 0) * m(2, 2) - m(1, 2) * m(2, 0))
           + m(0, 2) * (m(1, 0) * m(2, 1) - m(1, 1) * m(2, 0));
}

template <class T>
constexpr Mat<T, 3, 3> product(const Mat<T, 3, 3>& a, const Mat<T, 3, 3>& b) {
    Mat<T, 3, 3> c;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) c(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
    return c;
}

inline Vec3 product(const Mat3& m, const Vec3& a) {
    Vec3 b;
    for (int i = 0; i < 3; ++i) b[i] = m(i, 0) * a[0] + m(i, 1) * a[1] + m(i, 2) * a[2];
    return b;
}

template <class T>
constexpr Mat<T, 3, 3> inverse(const Mat<T, 3, 3>& m) {
    const T f = T(1) / det(m);
    Mat<T, 3, 3> c;
    c(0, 0) = f * (m(1, 1) * m(2, 2) - m(1, 2) * m(2, 1));
    c(0, 1) = f * (m(0, 2) * m(2, 1) - m(0, 1) * m(2, 2));
    c(0, 2) = f * (m(0, 1) * m(1, 2) - m(0, 2) * m(1, 1));
    c(1, 0) = f * (m(1, 2) * m(2, 0) - m(1, 0) * m(2, 2));
    c(1, 1) = f * (m(0, 0) * m(2, 2) - m(0, 2) * m(2, 0));
    c(1, 2) = f * (m(0, 2) * m(1, 0) - m(0, 0) * m(1, 2));
    c(2, 0) = f * (m(1, 0) * m(2, 1) - m(1, 1) * m(2, 0));
    c(2, 1) = f * (m(0, 1) * m(2, 0) - m(0, 0) * m(2, 1));
    c(2, 2) = f * (m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0));
    return c;
}

/// Symmetric tensor from its Voigt components; `shear` is 1 for stresses, 1/2 for engineering strains.
template <class T = double>
constexpr Mat<T, 3, 3> from_voigt(const Vec<T, 6>& v, double shear) {
    Mat<T, 3, 3> m;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) m(i, j) = (i == j ? 1.0 : shear) * v[voigt_index[i][j]];
    return m;
}

/// Eigenvalues and orthonormal eigenvectors (the columns of V) of a symmetric 3x3 matrix by cyclic Jacobi rotations.
/// Errors are of the order of round-off times the norm of A, for close and equal roots too. A lane that has converged
/// is turned by zero angles while others go on.
template <class T>
void eigen_symmetric(Mat<T, 3, 3> A, Vec<T, 3>& values, Mat<T, 3, 3>& V) {
    V = Mat<T, 3, 3>{{1, 0, 0, 0, 1, 0, 0, 0, 1}};
    constexpr std::array<std::array<int, 3>, 3> plane{{{0, 1, 2}, {0, 2, 1}, {1, 2, 0}}};
    for (int sweep = 0; sweep < 20; ++sweep) {
        const T off = A(0, 1) * A(0, 1) + A(0, 2) * A(0, 2) + A(1, 2) * A(1, 2);
        const T diagonal = A(0, 0) * A(0, 0) + A(1, 1) * A(1, 1) + A(2, 2) * A(2, 2);
        const Mask<T> done = off <= 1e-33 * diagonal;
        if (all(done)) break;
        for (const auto& [p, q, r] : plane) {
            // tan of the angle: 2 a / (D +- sqrt(D^2 + 4 a^2)), the smaller of two roots. No quotient where a = 0.
            const T a = A(p, q), D = A(q, q) - A(p, p);
            const T root = sqrt(D * D + 4.0 * a * a), nearer = D + select(D >= 0.0, root, -root);
            const Mask<T> idle = done | (a == 0.0);
            const T t = select(idle, 0.0, 2.0 * a / select(idle, 1.0, nearer));
            const T c = 1.0 / sqrt(t * t + 1.0), s = t * c;
            A(p, p) -= t * a;
            A(q, q) += t * a;
            A(p, q) = A(q, p) = select(done, a, 0.0);
            const T rp = A(r, p), rq = A(r, q);
            A(r, p) = A(p, r) = c * rp - s * rq;
            A(r, q) = A(q, r) = s * rp + c * rq;
            for (int k = 0; k < 3; ++k) {
                const T vp = V(k, p), vq = V(k, q);
                V(k, p) = c * vp - s * vq;
                V(k, q) = s * vp + c * vq;
            }
        }
    }
    values = {A(0, 0), A(1, 1), A(2, 2)};
}

/// Lower Cholesky factor of a symmetric 3x3 matrix; false where it is not positive definite.
template <class T>
Mask<T> cholesky(const Mat<T, 3, 3>& A, Mat<T, 3, 3>& L) {
    L = Mat<T, 3, 3>{};
    Mask<T> positive = true;
    for (int j = 0; j < 3; ++j) {
        T d = A(j, j);
        for (int k = 0; k < j; ++k) d -= L(j, k) * L(j, k);
        positive = positive & (d > 0.0);
        L(j, j) = sqrt(d);
        const T reciprocal = 1.0 / L(j, j);
        for (int i = j + 1; i < 3; ++i) {
            T sum = A(i, j);
            for (int k = 0; k < j; ++k) sum -= L(i, k) * L(j, k);
            L(i, j) = sum * reciprocal;
        }
    }
    return positive;
}

}  // namespace umform
