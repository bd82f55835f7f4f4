// Quadrature on [-1, 1]: Gauss, Lobatto, and Gauss split at the middle.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

namespace umform {

struct Rule {
    std::vector<double> x, w;
    int size() const { return static_cast<int>(x.size()); }
};

/// Rules through the thickness, of the columns of points that stand on the surface: one for all, or one for each.
class ThicknessRule {
  public:
    ThicknessRule(Rule same) : columns_{std::move(same)} {}
    ThicknessRule(std::vector<Rule> columns) : columns_(std::move(columns)) {
        if (columns_.empty()) throw std::invalid_argument("a thickness rule has one column or more");
        for (const Rule& column : columns_)
            if (column.size() != size()) throw std::invalid_argument("all columns have as many thickness points");
    }

    /// Points of a column.
    int size() const { return columns_.front().size(); }
    const Rule& operator[](int column) const { return columns_.size() == 1 ? columns_.front() : columns_.at(column); }
    void require(int columns) const {
        if (columns_.size() != 1 && columns_.size() != static_cast<std::size_t>(columns))
            throw std::invalid_argument("there is one thickness rule for all points of the surface, or one for each");
    }

  private:
    std::vector<Rule> columns_;
};

/// Rules along the coordinates r and s of the surface.
struct SurfaceRule {
    Rule r, s;
    int size() const { return r.size() * s.size(); }
};

/// Numbers of Gauss points along r and s.
using SurfacePoints = std::array<int, 2>;

/// Legendre polynomial P_n and its derivative at x.
struct Legendre {
    double value, slope;
};

inline Legendre legendre(int n, double x) {
    double p0 = 1.0, p1 = x, d0 = 0.0, d1 = 1.0;
    if (n == 0) return {p0, d0};
    for (int k = 2; k <= n; ++k) {
        const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
        const double d2 = d0 + (2 * k - 1) * p1;
        p0 = p1, p1 = p2, d0 = d1, d1 = d2;
    }
    return {p1, d1};
}

/// Gauss-Legendre rule, exact to degree 2n - 1.
inline Rule gauss(int n) {
    if (n < 1) throw std::invalid_argument("a Gauss rule needs at least one point");
    Rule rule{std::vector<double>(n), std::vector<double>(n)};
    for (int i = 0; i < n; ++i) {
        double x = -std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
        for (int iteration = 0; iteration < 10; ++iteration) x -= legendre(n, x).value / legendre(n, x).slope;
        if (2 * i + 1 == n) x = 0.0;
        const double slope = legendre(n, x).slope;
        rule.x[i] = x;
        rule.w[i] = 2.0 / ((1.0 - x * x) * slope * slope);
    }
    return rule;
}

inline SurfaceRule gauss(const SurfacePoints& points) { return {gauss(points[0]), gauss(points[1])}; }

/// Gauss-Lobatto rule with both ends, exact to degree 2n - 3.
inline Rule lobatto(int n) {
    if (n < 2) throw std::invalid_argument("a Lobatto rule needs at least two points");
    Rule rule{std::vector<double>(n), std::vector<double>(n)};
    const int m = n - 1;
    for (int i = 0; i < n; ++i) {
        double x = -std::cos(std::numbers::pi * i / m);
        if (i > 0 && i < m) {
            for (int iteration = 0; iteration < 20; ++iteration) {  // roots of P_m'
                const Legendre p = legendre(m, x);
                const double curvature = (2.0 * x * p.slope - m * (m + 1) * p.value) / (1.0 - x * x);
                x -= p.slope / curvature;
            }
            if (2 * i == m) x = 0.0;
        }
        const double value = legendre(m, x).value;
        rule.x[i] = x;
        rule.w[i] = 2.0 / (n * m * value * value);
    }
    return rule;
}

/// n/2 Gauss points in each half of the interval: exact for a function with a kink in the middle.
inline Rule split(int n) {
    if (n < 2 || n % 2 != 0) throw std::invalid_argument("a split rule needs an even number of points");
    const Rule half = gauss(n / 2);
    Rule rule;
    for (const double side : {-0.5, 0.5})
        for (int i = 0; i < half.size(); ++i) {
            rule.x.push_back(0.5 * half.x[i] + side);
            rule.w.push_back(0.5 * half.w[i]);
        }
    return rule;
}

}  // namespace umform
