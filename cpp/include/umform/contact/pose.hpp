// Where a rigid tool stands.
#pragma once

#include "umform/algebra/tensor.hpp"

namespace umform {

/// Rigid position of a tool: a point X of the tool's own frame lies at x = Q X + c.
struct Pose {
    Mat3 Q{{1, 0, 0, 0, 1, 0, 0, 0, 1}};
    Vec3 c{};

    /// Place in the frame of the tool, Q^T (x - c).
    Vec3 to_tool(const Vec3& x) const {
        Vec3 z;
        for (int k = 0; k < 3; ++k) {
            double value = 0.0;
            for (int m = 0; m < 3; ++m) value += Q(m, k) * (x[m] - c[m]);
            z[k] = value;
        }
        return z;
    }
    /// Q^T a.
    Vec3 turn_back(const Vec3& a) const {
        Vec3 b;
        for (int k = 0; k < 3; ++k) b[k] = Q(0, k) * a[0] + Q(1, k) * a[1] + Q(2, k) * a[2];
        return b;
    }
    Vec3 turn(const Vec3& a) const {
        Vec3 b;
        for (int i = 0; i < 3; ++i) b[i] = sum(&Q.a[3 * i], a[0], a[1], a[2]);
        return b;
    }
    Vec3 to_space(const Vec3& z) const {
        Vec3 x = turn(z);
        for (int i = 0; i < 3; ++i) x[i] += c[i];
        return x;
    }
    /// Q H Q^T.
    Mat3 turn(const Mat3& H) const {
        Mat3 QH, QHQ;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) QH(i, j) = sum(&Q.a[3 * i], H(0, j), H(1, j), H(2, j));
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) QHQ(i, j) = sum(&QH.a[3 * i], Q(j, 0), Q(j, 1), Q(j, 2));
        return QHQ;
    }

  private:
    /// In an order that no compiler changes, so that all translation units have the same bits.
    static double sum(const double* row, double a, double b, double c) {
        return std::fma(row[2], c, std::fma(row[0], a, row[1] * b));
    }
};

}  // namespace umform
