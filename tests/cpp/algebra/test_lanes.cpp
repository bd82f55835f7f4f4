// Lanes: arithmetic, masks and functions agree with those of double, and no lane sees another.
#include <array>

#include "check.hpp"
#include "umform/algebra/condensation.hpp"
#include "umform/materials/remainders.hpp"

using namespace umform;

namespace {

const std::array<double, 4> sample{0.3, -1.5, 4.0, 2.25};

Lanes of(const std::array<double, 4>& values) {
    return by_lane([&](int lane) { return values[lane % 4]; });
}

void check_arithmetic() {
    const Lanes a = of(sample), b = of({2.0, -0.5, 4.0, 1e-3});
    for (int lane = 0; lane < lane_count; ++lane) {
        const double x = a[lane], y = b[lane];
        CHECK_NEAR((a + b)[lane], x + y, 0.0);
        CHECK_NEAR((2.0 * a - b)[lane], 2.0 * x - y, 1e-15);
        CHECK_NEAR((a / b)[lane], x / y, 0.0);
        CHECK_NEAR(sqrt(abs(a))[lane], std::sqrt(std::abs(x)), 0.0);
        CHECK_NEAR(select(a < b, a, b)[lane], std::min(x, y), 0.0);
        CHECK((a == a)[lane] && !(a < a)[lane] && (!(a < a))[lane]);
    }
    CHECK(any(a > 3.0) && !any(a > 5.0) && all(a > -2.0) && !all(a > 0.0));
    LaneMask mask = false;
    mask.set(2, true);
    CHECK(any(mask) && !all(mask) && mask[2] && !mask[1] && all(mask | !mask) && !any(mask & !mask));
}

/// Against long double, on both sides of the switch between series and library.
void check_functions() {
    for (int k = -400; k <= 400; ++k) {
        const double x = 1e-3 * k + 1e-5;
        const long double exact = x;
        const Lanes mixed = of({x, 0.5, x, 1e-9});
        const double log_ratio = static_cast<double>(std::log1p(exact) / exact);
        CHECK_NEAR(log1p_ratio(x) / log_ratio, 1.0, 5e-16);
        CHECK_NEAR(log1p_ratio(mixed)[0] / log_ratio, 1.0, 5e-16);
        CHECK_NEAR(exp(mixed)[0] / static_cast<double>(std::exp(exact)), 1.0, 3e-16);
        CHECK_NEAR(expm1(mixed)[0] / static_cast<double>(std::expm1(exact)), 1.0, 5e-16);
        CHECK_NEAR(exp(mixed)[0], exp(of({x, x, x, x}))[0], 0.0);  // whatever the others hold
        CHECK_NEAR(log1p_ratio(mixed)[2], log1p_ratio(of({x, x, x, x}))[2], 0.0);
    }
    CHECK_NEAR(log1p_ratio(Lanes(0.0))[0], 1.0, 0.0);
}

/// Products by tiles against sums, over the blocks of a row set, and only on and above the diagonal if that is asked for.
void check_products() {
    constexpr int columns = 6, blocks = 2, rows = 3, stride = 4 * columns;  // the last row of a block does not count
    std::array<double, blocks * stride> A, B;
    for (int i = 0; i < blocks * stride; ++i) A[i] = std::sin(1.0 + i), B[i] = std::cos(2.0 * i);
    for (const bool upper : {false, true}) {
        std::array<double, columns * columns> sum{}, transposed{};
        transposed_product<columns>({blocks, rows, stride, columns}, A.data(), B.data(), upper,
                                    [&](int i, int j, const Tile<double>& values) {
                                        add_tile<columns>(sum.data(), i, j, 2.0, values);
                                        add_transposed_tile<columns>(transposed.data(), i, j, 2.0, values);
                                    });
        for (int i = 0; i < columns; ++i)
            for (int j = 0; j < columns; ++j) {
                double expected = 0.0;
                for (int block = 0; block < blocks; ++block)
                    for (int row = 0; row < rows; ++row)
                        expected += 2.0 * A[block * stride + row * columns + i] * B[block * stride + row * columns + j];
                if (upper && i / tile > j / tile) expected = 0.0;
                CHECK_NEAR(sum[i * columns + j], expected, 1e-14);
                CHECK_NEAR(transposed[j * columns + i], expected, 1e-14);
            }
    }
}

/// L D L^T of a different matrix in each lane; a singular one is told without spoiling the others.
void check_factors() {
    constexpr int n = 3;
    std::array<Lanes, n * n> A, LD;
    std::array<Lanes, n> y;
    for (int i = 0; i < n; ++i) {
        y[i] = of({1.0 + i, 2.0, -1.0, 0.5 * i});
        for (int j = 0; j < n; ++j) {
            A[i * n + j] = of({1.0 / (1 + i + j), 0.2, 1.0, -0.3});  // the third lane has ones only
            if (i == j) A[i * n + j] += of({2.0, 1.0 + i, 0.0, 4.0});
        }
    }
    LD = A;
    std::array<Lanes, n> x = y;
    const LaneMask regular = factor_ldlt(LD.data(), n);
    solve_ldlt(LD.data(), n, x.data(), 1);
    for (const int lane : {0, 1, 3}) {
        CHECK(regular[lane]);
        for (int i = 0; i < n; ++i) {
            double sum = 0.0;
            for (int j = 0; j < n; ++j) sum += A[i * n + j][lane] * x[j][lane];
            CHECK_NEAR(sum, y[i][lane], 1e-14);
        }
    }
    CHECK(!regular[2]);
}

}  // namespace

int main() {
    check_arithmetic();
    check_functions();
    check_products();
    check_factors();
    return report("lanes");
}
