// The symmetric eigenproblem on random, close, equal and badly scaled roots; inverse, Cholesky, Voigt order.
#include <algorithm>
#include <random>

#include "check.hpp"
#include "umform/algebra/tensor.hpp"

using namespace umform;

namespace {

std::mt19937 generator(7);

double normal() { return std::normal_distribution<double>()(generator); }

Mat3 multiply(const Mat3& a, const Mat3& b) {
    Mat3 c;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k) c(i, j) += a(i, k) * b(k, j);
    return c;
}

Mat3 transposed(const Mat3& a) {
    Mat3 t;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) t(i, j) = a(j, i);
    return t;
}

double largest(const Mat3& a) {
    double size = 0.0;
    for (const double value : a.a) size = std::max(size, std::abs(value));
    return size;
}

double distance(const Mat3& a, const Mat3& b) {
    Mat3 difference;
    for (int i = 0; i < 9; ++i) difference.a[i] = a.a[i] - b.a[i];
    return largest(difference);
}

const Mat3 one{{1, 0, 0, 0, 1, 0, 0, 0, 1}};

Mat3 diagonal(const Vec3& d) { return Mat3{{d[0], 0, 0, 0, d[1], 0, 0, 0, d[2]}}; }

Mat3 rotation() {
    const Vec3 a = normalised(Vec3{normal(), normal(), normal()});
    const Vec3 b = normalised(cross(a, Vec3{normal(), normal(), normal()})), c = cross(a, b);
    return Mat3{{a[0], b[0], c[0], a[1], b[1], c[1], a[2], b[2], c[2]}};
}

Mat3 symmetric(const Vec3& roots, const Mat3& Q) {
    const Mat3 A = multiply(multiply(Q, diagonal(roots)), transposed(Q));
    Mat3 S;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) S(i, j) = 0.5 * (A(i, j) + A(j, i));
    return S;
}

/// A V = V diag, V orthonormal, and the roots that were put in, all to round-off.
void check_eigen(Vec3 roots, const Mat3& Q) {
    const Mat3 A = symmetric(roots, Q);
    Vec3 values;
    Mat3 V;
    eigen_symmetric(A, values, V);
    const double round_off = 4e-15 * std::max({std::abs(roots[0]), std::abs(roots[1]), std::abs(roots[2])});
    CHECK_NEAR(distance(multiply(V, transposed(V)), one), 0.0, 4e-15);
    CHECK_NEAR(distance(multiply(multiply(V, diagonal(values)), transposed(V)), A), 0.0, round_off);
    std::sort(values.begin(), values.end());
    std::sort(roots.begin(), roots.end());
    for (int i = 0; i < 3; ++i) CHECK_NEAR(values[i], roots[i], round_off);
}

void eigenproblem() {
    for (int trial = 0; trial < 200; ++trial) {
        check_eigen({normal(), normal(), normal()}, rotation());
        check_eigen({1e-8 * normal(), normal(), 1e6 * normal()}, rotation());
    }
    for (int k = 1; k <= 17; ++k) {
        const double gap = std::pow(10.0, -k);
        check_eigen({1.0, 1.0 + gap, 2.0}, rotation());
        check_eigen({1.0, 1.0 + gap, 1.0 - gap}, rotation());
        check_eigen({gap, 2 * gap, -gap}, rotation());
    }
    for (const Mat3& Q : {one, rotation(), rotation()}) {
        check_eigen({3.0, 3.0, 3.0}, Q);
        check_eigen({3.0, 3.0, -1.0}, Q);
        check_eigen({0.0, 0.0, 0.0}, Q);
        check_eigen({0.0, 0.0, 1e-100}, Q);
        check_eigen({1e150, -1e150, 1e149}, Q);
    }
}

void determinant_and_inverse() {
    for (int trial = 0; trial < 50; ++trial) {
        Mat3 A;
        for (double& value : A.a) value = normal();
        for (int i = 0; i < 3; ++i) A(i, i) += 4.0;
        CHECK_NEAR(distance(multiply(A, inverse(A)), one), 0.0, 1e-13);
        CHECK_NEAR(det(A) * det(inverse(A)), 1.0, 1e-13);
        const Vec3 columns[3] = {{A(0, 0), A(1, 0), A(2, 0)}, {A(0, 1), A(1, 1), A(2, 1)}, {A(0, 2), A(1, 2), A(2, 2)}};
        CHECK_NEAR(det(A), dot(columns[0], cross(columns[1], columns[2])), 1e-12 * std::abs(det(A)));
    }
}

void cholesky_factor() {
    for (int trial = 0; trial < 50; ++trial) {
        const Mat3 A = symmetric({std::exp(normal()), std::exp(normal()), std::exp(normal())}, rotation());
        Mat3 L;
        CHECK(cholesky(A, L));
        CHECK_NEAR(distance(multiply(L, transposed(L)), A), 0.0, 1e-14 * largest(A));
        CHECK(L(0, 1) == 0.0 && L(0, 2) == 0.0 && L(1, 2) == 0.0);
        CHECK(!cholesky(symmetric({1.0, -0.1, 2.0}, rotation()), L));
    }
    Mat3 L;
    CHECK(!cholesky(Mat3{}, L));
    CHECK(!cholesky(diagonal({1.0, std::nan(""), 1.0}), L));
}

void voigt_order() {
    for (int p = 0; p < 6; ++p) {
        const auto [i, j] = voigt_pair[p];
        CHECK(voigt_index[i][j] == p && voigt_index[j][i] == p);
    }
    const Mat3 E = from_voigt({1, 2, 3, 4, 5, 6}, 0.5);
    CHECK(E(0, 1) == 2.0 && E(1, 2) == 2.5 && E(0, 2) == 3.0 && E(1, 0) == 2.0 && E(2, 2) == 3.0);
}

}  // namespace

int main() {
    eigenproblem();
    determinant_and_inverse();
    cholesky_factor();
    voigt_order();
    return report("tensor");
}
