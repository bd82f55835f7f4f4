// The mean pressure of a cell whose gap is linear over it, by a law of a user.
#pragma once

#include <cmath>
#include <vector>

#include "umform/contact/normal_law.hpp"
#include "umform/contact/overlap.hpp"

namespace umform {

/// Integrals over the square |xi|, |eta| <= 1/2 of a pressure that follows from G = g + p xi + q eta. eqs. (4.283), (4.284)
struct OwnOverlap {
    double pressure = 0.0, energy = 0.0;
    double gap = 0.0;                   // int G over the part within the reach
    double share = 0.0;                 // area of that part
    std::array<double, 4> by_corner{};  // minus the derivatives of the pressure with respect to G at the corners
};

/// A number and its derivatives with respect to g, p and q of the plane.
struct OfPlane {
    double value = 0.0;
    std::array<double, 3> d{};

    friend OfPlane operator+(const OfPlane& a, const OfPlane& b) { return a.with(a.value + b.value, 1.0, b, 1.0); }
    friend OfPlane operator-(const OfPlane& a, const OfPlane& b) { return a.with(a.value - b.value, 1.0, b, -1.0); }
    friend OfPlane operator*(const OfPlane& a, const OfPlane& b) {
        return a.with(a.value * b.value, b.value, b, a.value);
    }
    friend OfPlane operator*(double factor, const OfPlane& a) { return a.with(factor * a.value, factor, a, 0.0); }
    friend OfPlane operator/(const OfPlane& a, const OfPlane& b) {
        return a.with(a.value / b.value, 1.0 / b.value, b, -a.value / (b.value * b.value));
    }
    friend bool inside(const OfPlane& a) { return a.value <= 0.0; }

  private:
    OfPlane with(double made, double of_this, const OfPlane& other, double of_other) const {
        OfPlane out{made, {}};
        for (int k = 0; k < 3; ++k) out.d[k] = of_this * d[k] + of_other * other.d[k];
        return out;
    }
};

/// Overlaps of some cells, from values at their corners: the part of each cell within the reach of the law is divided into triangles,
/// each with a rule of degree 5; one call of the law for all points of all cells. The derivatives are those of this rule.
class OwnCuts {
  public:
    OwnCuts(const NormalLaw& law, double scale, const std::vector<std::array<double, 4>>& corners)
        : overlaps(corners.size()), reach_(law.reach()) {
        for (std::size_t cell = 0; cell < corners.size(); ++cell) add(cell, corners[cell]);
        const int n = static_cast<int>(gap_.size());
        std::vector<double> pressure(n), slope(n);
        law.pressures(n, gap_.data(), pressure.data(), slope.data());
        const std::vector<double> energy = law.energies(n, gap_.data(), parts);
        for (int k = 0; k < n; ++k) {
            const Sample& at = samples_[k];
            OwnOverlap& overlap = overlaps[at.cell];
            overlap.pressure += scale * at.weight.value * pressure[k];
            overlap.energy += scale * at.weight.value * energy[k];
            std::array<double, 3> d;
            for (int j = 0; j < 3; ++j)
                d[j] = at.weight.d[j] * pressure[k] + at.weight.value * slope[k] * at.above.d[j];
            for (int i = 0; i < 4; ++i) {
                const double of_p = i == 1 || i == 2 ? 0.5 : -0.5, of_q = i >= 2 ? 0.5 : -0.5;  // as `Cut` has them
                overlap.by_corner[i] -= scale * (0.25 * d[0] + of_p * d[1] + of_q * d[2]);
            }
        }
    }

    std::vector<OwnOverlap> overlaps;

  private:
    using Vertex = VertexOf<OfPlane>;
    struct Sample {
        std::size_t cell;
        OfPlane weight, above;  // above: G less the reach
    };

    /// Parts of the way up to the reach in the energy of a point.
    static constexpr int parts = 4;

    void add(std::size_t cell, std::array<double, 4> G) {
        for (double& value : G) value -= reach_;
        const CellPlane plane(G);
        const auto part = inside_of(OfPlane{plane.g, {1.0, 0.0, 0.0}}, OfPlane{plane.p, {0.0, 1.0, 0.0}},
                                    OfPlane{plane.q, {0.0, 0.0, 1.0}});
        for (int i = 2; i < part.count; ++i) add(cell, part.vertices[0], part.vertices[i - 1], part.vertices[i]);
    }

    /// Radon's rule of seven points for a triangle.
    void add(std::size_t cell, const Vertex& a, const Vertex& b, const Vertex& c) {
        const OfPlane area = 0.5 * ((b.xi - a.xi) * (c.eta - a.eta) - (c.xi - a.xi) * (b.eta - a.eta));
        const double root = std::sqrt(15.0), third = 1.0 / 3.0;
        const double u = (6.0 - root) / 21.0, v = (6.0 + root) / 21.0;
        const auto point = [&](double weight, double L, double M, double N) {
            samples_.push_back({cell, weight * area, L * a.G + M * b.G + N * c.G});
            const Sample& at = samples_.back();
            gap_.push_back(std::min(reach_ + at.above.value, reach_));
            overlaps[cell].share += at.weight.value;
            overlaps[cell].gap += at.weight.value * gap_.back();
        };
        point(9.0 / 40.0, third, third, third);
        for (const auto& [weight, L] : {std::pair{(155.0 - root) / 1200.0, u}, std::pair{(155.0 + root) / 1200.0, v}}) {
            point(weight, 1.0 - 2.0 * L, L, L);
            point(weight, L, 1.0 - 2.0 * L, L);
            point(weight, L, L, 1.0 - 2.0 * L);
        }
    }

    double reach_;
    std::vector<Sample> samples_;
    std::vector<double> gap_;
};

}  // namespace umform
