// The logarithmic strain: the second divided difference over three principal values, where they are close and where they are not; its values.
#include "check.hpp"
#include "umform/materials/logarithmic_strain.hpp"

using namespace umform;

namespace {

/// That of ln(1 + x)/2, in long double.
double divided(long double x, long double y, long double z) {
    const auto first = [](long double a, long double b) { return (std::log1p(a) - std::log1p(b)) / 2 / (a - b); };
    return static_cast<double>((first(x, y) - first(y, z)) / (x - z));
}

/// A shear stress in the axes 1 and 2 makes one entry of the tangent from all three principal values. eq. (3.67)
double of_three(double x, double y, double z) {
    LogarithmicStrain<double> strain;
    CHECK(strain.set({0.5 * x, 0.5 * y, 0.5 * z, 0, 0, 0}));
    Voigt S;
    Voigt66 CC;
    strain.pull_back({0, 0, 0, 1, 0, 0}, Voigt66{}, true, S, CC);
    return 0.5 * CC(4, 5);
}

/// Series below a spread of 2 %, quotient above: both to all digits but those that a quotient of close values loses. eq. (3.65)
void check_difference_of_three() {
    for (const double mean : {-0.2, 0.0, 0.3})
        for (const double spread : {4e-3, 1e-2, 1.9e-2 * (1.0 + mean), 2.1e-2 * (1.0 + mean), 0.1})
            for (const double middle : {0.05, 0.3, 0.5, 0.9}) {
                const double x = mean - 0.4 * spread, z = x + spread, y = x + middle * spread;
                const double expected = divided(x, y, z);
                CHECK_NEAR(of_three(x, y, z) / expected, 1.0, 2e-13);
                CHECK_NEAR(of_three(z, x, y) / expected, 1.0, 2e-13);
            }
    for (const double mean : {-0.2, 0.0, 0.3})
        CHECK_NEAR(of_three(mean, mean + 1e-14, mean - 1e-14) * (1.0 + mean) * (1.0 + mean), -0.25, 1e-13);
}

/// ln(1 + x)/2 by the series of artanh up to |s| = 1/3 of s = x/(2 + x), and by the function beyond. eq. (3.63)
void check_values() {
    for (const double x : {-0.9, -0.51, -0.49, -0.1, 1e-13, 1e-3, 0.02, 0.3, 0.9, 0.99, 1.01, 8.0}) {
        LogarithmicStrain<double> strain;
        CHECK(strain.set({0.5 * x, 0, 0, 0, 0, 0}));
        CHECK_NEAR(strain.h[0] / (0.5 * std::log1p(x)), 1.0, 1e-14);
        CHECK_NEAR(strain.h[1], 0.0, 1e-16);
    }
}

}  // namespace

int main() {
    check_values();
    check_difference_of_three();
    return report("logarithmic strain");
}
