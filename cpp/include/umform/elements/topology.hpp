// Faces Quad4 and Quad9 and the solid-shells Hex8 and Hex18 that stand on them.
//
//   Quad4            Quad9             s          a solid-shell: the nodes of the lower face (t = -1),
//   3 ----- 2        3 -- 6 -- 2       |          then those of the upper face (t = +1) in the same order:
//   |       |        |    |    |       +-- r      Hex8 = 0..3 + 4..7, Hex18 = 0..8 + 9..17
//   |       |        7 -- 8 -- 5
//   0 ----- 1        0 -- 4 -- 1
#pragma once

#include <array>
#include <cmath>

namespace umform {

/// Shape functions of a face at one point with their derivatives in r and s.
template <int Nodes>
struct FaceShape {
    std::array<double, Nodes> N, Nr, Ns;
};

inline FaceShape<4> quad4(double r, double s) {
    constexpr std::array<double, 4> ra{-1, 1, 1, -1}, sa{-1, -1, 1, 1};
    FaceShape<4> shape{};
    for (int a = 0; a < 4; ++a) {
        shape.N[a] = 0.25 * (1 + ra[a] * r) * (1 + sa[a] * s);
        shape.Nr[a] = 0.25 * ra[a] * (1 + sa[a] * s);
        shape.Ns[a] = 0.25 * sa[a] * (1 + ra[a] * r);
    }
    return shape;
}

inline FaceShape<9> quad9(double r, double s) {
    // Lagrange polynomials on {-1, 0, 1} and their slopes; rounded once, so that all translation units have the same bits.
    const double Nr = std::fma(-r, r, 1.0), Ns = std::fma(-s, s, 1.0);
    const std::array<double, 3> Lr{0.5 * r * (r - 1), Nr, 0.5 * r * (r + 1)}, dLr{r - 0.5, -2 * r, r + 0.5};
    const std::array<double, 3> Ls{0.5 * s * (s - 1), Ns, 0.5 * s * (s + 1)}, dLs{s - 0.5, -2 * s, s + 0.5};
    constexpr std::array<int, 9> ir{0, 2, 2, 0, 1, 2, 1, 0, 1}, is{0, 0, 2, 2, 0, 1, 2, 1, 1};
    FaceShape<9> shape{};
    for (int a = 0; a < 9; ++a) {
        shape.N[a] = Lr[ir[a]] * Ls[is[a]];
        shape.Nr[a] = dLr[ir[a]] * Ls[is[a]];
        shape.Ns[a] = Lr[ir[a]] * dLs[is[a]];
    }
    return shape;
}

template <int Nodes>
FaceShape<Nodes> face_shape(double r, double s) {
    static_assert(Nodes == 4 || Nodes == 9);
    if constexpr (Nodes == 4)
        return quad4(r, s);
    else
        return quad9(r, s);
}

/// Derivatives of the shape functions of a solid-shell, dN[i][node] with i = r, s, t. eq. (1.1)
template <int Nodes>
using ShellGradient = std::array<std::array<double, Nodes>, 3>;

template <int Nodes>
ShellGradient<Nodes> shell_gradient(double r, double s, double t) {
    constexpr int face = Nodes / 2;
    const FaceShape<face> shape = face_shape<face>(r, s);
    ShellGradient<Nodes> dN;
    for (int a = 0; a < face; ++a)
        for (int side = 0; side < 2; ++side) {
            const double sign = side == 0 ? -1.0 : 1.0, Nt = 0.5 * (1.0 + sign * t);
            dN[0][a + side * face] = shape.Nr[a] * Nt;
            dN[1][a + side * face] = shape.Ns[a] * Nt;
            dN[2][a + side * face] = shape.N[a] * 0.5 * sign;
        }
    return dN;
}

/// Shape functions of a solid-shell.
template <int Nodes>
std::array<double, Nodes> shell_shape(double r, double s, double t) {
    constexpr int face = Nodes / 2;
    const FaceShape<face> shape = face_shape<face>(r, s);
    std::array<double, Nodes> N;
    for (int a = 0; a < face; ++a) {
        N[a] = 0.5 * (1.0 - t) * shape.N[a];
        N[a + face] = 0.5 * (1.0 + t) * shape.N[a];
    }
    return N;
}

}  // namespace umform
