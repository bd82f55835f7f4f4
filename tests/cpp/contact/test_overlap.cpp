// Integrals of a linear gap over the part of a cell where it is negative, against sums over a fine grid and by hand.
#include <array>
#include <random>

#include "check.hpp"
#include "umform/contact/overlap.hpp"

using namespace umform;

namespace {

using Corners = std::array<double, 4>;

Corners corners(double g, double p, double q) {
    return {g - 0.5 * p - 0.5 * q, g + 0.5 * p - 0.5 * q, g + 0.5 * p + 0.5 * q, g - 0.5 * p + 0.5 * q};
}

Overlap cut(double g, double p, double q) { return Cut(corners(g, p, q)).overlap; }

/// Sums over strips along eta, each integrated exactly in xi by its two ends.
Overlap summed(double g, double p, double q) {
    Overlap sum;
    const int strips = 20000;
    for (int j = 0; j < strips; ++j) {
        const double eta = (j + 0.5) / strips - 0.5, G = g + q * eta;
        double first = -0.5, last = 0.5;
        if (G - 0.5 * p > 0.0 && G + 0.5 * p > 0.0) continue;
        if (G - 0.5 * p > 0.0) first = -G / p;
        if (G + 0.5 * p > 0.0) last = -G / p;
        const double width = (last - first) / strips, middle = 0.5 * (first + last), at = G + p * middle;
        sum.share += width;
        sum.gap += width * at;
        sum.m_xi += width * middle;
        sum.m_eta += width * eta;
        sum.half_square += 0.5 * width * (at * at + p * p * (last - first) * (last - first) / 12.0);
    }
    return sum;
}

void check_equal(const Overlap& a, const Overlap& b, double tolerance) {
    CHECK_NEAR(a.gap, b.gap, tolerance);
    CHECK_NEAR(a.half_square, b.half_square, tolerance);
    CHECK_NEAR(a.share, b.share, tolerance);
    CHECK_NEAR(a.m_xi, b.m_xi, tolerance);
    CHECK_NEAR(a.m_eta, b.m_eta, tolerance);
}

void check_random() {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    int partly = 0;
    for (int trial = 0; trial < 200; ++trial) {
        const double g = 0.5 * normal(random), p = normal(random), q = normal(random);
        const Overlap overlap = cut(g, p, q);
        partly += overlap.share > 0.0 && overlap.share < 1.0 ? 1 : 0;
        check_equal(overlap, summed(g, p, q), 1e-6);
    }
    CHECK(partly > 80);
}

void check_by_hand() {
    check_equal(cut(-0.1, 0.0, 0.0), {.gap = -0.1, .half_square = 0.005, .share = 1.0}, 1e-16);
    check_equal(cut(0.0, 0.0, 0.0), {.share = 1.0}, 0.0);  // a tool that just touches can hold
    check_equal(cut(1e-12, 0.0, 0.0), {}, 0.0);
    check_equal(cut(0.0, 1.0, 0.0), {.gap = -0.125, .half_square = 1.0 / 48, .share = 0.5, .m_xi = -0.125}, 1e-16);
    check_equal(cut(0.0, 0.0, -1.0), {.gap = -0.125, .half_square = 1.0 / 48, .share = 0.5, .m_eta = 0.125}, 1e-16);
    check_equal(cut(0.5, 1.0, 0.0), {}, 0.0);  // an edge that touches
    CHECK(cut(std::nan(""), 1.0, 0.0).share == 0.0);
    const Overlap tiny = cut(0.0, 1e-300, 1e-300);  // nothing is divided by a slope
    CHECK_NEAR(tiny.share, 0.5, 1e-15);
}

/// d gap = m00 dg + m10 dp + m01 dq, wherever the edge is.
void check_derivative() {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    const double h = 1e-5;
    for (int trial = 0; trial < 200; ++trial) {
        const double g = 0.5 * normal(random), p = normal(random), q = normal(random);
        const Overlap at = cut(g, p, q);
        CHECK_NEAR(at.share, (cut(g + h, p, q).gap - cut(g - h, p, q).gap) / (2 * h), 2e-9 + 1e-9 / std::hypot(p, q));
        CHECK_NEAR(at.m_xi, (cut(g, p + h, q).gap - cut(g, p - h, q).gap) / (2 * h), 2e-9 + 1e-9 / std::hypot(p, q));
        CHECK_NEAR(at.m_eta, (cut(g, p, q + h).gap - cut(g, p, q - h).gap) / (2 * h), 2e-9 + 1e-9 / std::hypot(p, q));
        CHECK_NEAR(at.gap, (cut(g + h, p, q).half_square - cut(g - h, p, q).half_square) / (2 * h), 1e-9);
        for (int i = 0; i < 4; ++i) {
            Corners more = corners(g, p, q), less = more;
            more[i] += h, less[i] -= h;
            const double slope = (Cut(more).overlap.gap - Cut(less).overlap.gap) / (2 * h);
            CHECK_NEAR(at.by_corner[i], slope, 2e-9 + 1e-9 / std::hypot(p, q));
        }
    }
}

}  // namespace

int main() {
    check_random();
    check_by_hand();
    check_derivative();
    return report("contact overlap");
}
