// Rules of up to 15 points integrate polynomials as far as they promise, and not further; Legendre polynomials.
#include "check.hpp"
#include "umform/elements/quadrature.hpp"

using namespace umform;

namespace {

double integrate(const Rule& rule, int degree) {
    double sum = 0.0;
    for (int i = 0; i < rule.size(); ++i) sum += rule.w[i] * std::pow(rule.x[i], degree);
    return sum;
}

double exact(int degree) { return degree % 2 == 0 ? 2.0 / (degree + 1) : 0.0; }

void check_rule(const Rule& rule, int points, int degree) {
    CHECK(rule.size() == points);
    for (int k = 0; k <= degree; ++k) CHECK_NEAR(integrate(rule, k), exact(k), 2e-14);
    for (int i = 0; i < points; ++i) {
        CHECK(rule.w[i] > 0.0);
        CHECK(i == 0 || rule.x[i] > rule.x[i - 1]);
        CHECK_NEAR(rule.x[i], -rule.x[points - 1 - i], 1e-15);
        CHECK_NEAR(rule.w[i], rule.w[points - 1 - i], 1e-14);
    }
}

/// The first even degree beyond the promise is wrong: the rule is not another, better one.
void check_limit(const Rule& rule, int degree) { CHECK(std::abs(integrate(rule, degree) - exact(degree)) > 1e-10); }

void rules() {
    for (int n = 1; n <= 15; ++n) {
        check_rule(gauss(n), n, 2 * n - 1);
        if (n <= 10) check_limit(gauss(n), 2 * n);
    }
    for (int n = 2; n <= 15; ++n) {
        const Rule rule = lobatto(n);
        check_rule(rule, n, 2 * n - 3);
        CHECK(rule.x.front() == -1.0 && rule.x.back() == 1.0);
        if (n <= 10) check_limit(rule, 2 * n - 2);
    }
    for (int n = 2; n <= 14; n += 2) {
        const Rule rule = split(n);
        check_rule(rule, n, n - 1);
        double kink = 0.0;
        for (int i = 0; i < n; ++i) kink += rule.w[i] * std::abs(rule.x[i]);
        CHECK_NEAR(kink, 1.0, 1e-14);
    }
    const Rule three = gauss(3);
    CHECK_NEAR(three.x[2], std::sqrt(0.6), 1e-15);
    CHECK_NEAR(three.w[1], 8.0 / 9.0, 1e-15);
    CHECK_NEAR(lobatto(3).w[1], 4.0 / 3.0, 1e-15);
}

void refusals() {
    CHECK(throws<std::invalid_argument>([] { gauss(0); }));
    CHECK(throws<std::invalid_argument>([] { lobatto(1); }));
    CHECK(throws<std::invalid_argument>([] { split(3); }));
    CHECK(throws<std::invalid_argument>([] { split(0); }));
}

void legendre_polynomials() {
    for (const double x : {-1.0, -0.3, 0.0, 0.7, 1.0}) {
        CHECK_NEAR(legendre(2, x).value, 0.5 * (3 * x * x - 1), 1e-15);
        CHECK_NEAR(legendre(3, x).value, 0.5 * (5 * x * x * x - 3 * x), 1e-15);
        CHECK_NEAR(legendre(4, x).value, (35 * std::pow(x, 4) - 30 * x * x + 3) / 8, 1e-15);
        for (int n = 0; n <= 15; ++n) {
            const double h = 1e-6, slope = (legendre(n, x + h).value - legendre(n, x - h).value) / (2 * h);
            CHECK_NEAR(legendre(n, x).slope, slope, 1e-5);
        }
    }
    const Rule rule = gauss(10);
    for (int n = 0; n <= 8; ++n)
        for (int m = 0; m <= n; ++m) {
            double sum = 0.0;
            for (int i = 0; i < rule.size(); ++i)
                sum += rule.w[i] * legendre(n, rule.x[i]).value * legendre(m, rule.x[i]).value;
            CHECK_NEAR(sum, n == m ? 2.0 / (2 * n + 1) : 0.0, 1e-14);
        }
}

}  // namespace

int main() {
    rules();
    refusals();
    legendre_polynomials();
    return report("quadrature");
}
