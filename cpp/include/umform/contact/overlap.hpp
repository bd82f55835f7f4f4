// The part of a cell that is inside a tool whose gap is linear over the cell, in closed form.
#pragma once

#include <array>

namespace umform {

/// Integrals of min(G, 0) over the square |xi|, |eta| <= 1/2 with G = g + p xi + q eta. eqs. (4.83), (4.84)
struct Overlap {
    double gap = 0.0;                   // int min(G, 0)
    double half_square = 0.0;           // int min(G, 0)^2 / 2
    double share = 0.0;                 // m00: area where G <= 0, zero where the tool does not hold the cell
    double m_xi = 0.0, m_eta = 0.0;     // m10, m01: its first moments
    std::array<double, 4> by_corner{};  // derivatives of the first with respect to the values at the corners
};

/// Overlap of a cell from values at its corners: G is the plane next to them, and the square is cut with the line G = 0. No step divides by p or q, so that a cell along the tool is no
/// special case.
class Cut {
  public:
    Overlap overlap;

    explicit Cut(const std::array<double, 4>& G) {
        const double g = 0.25 * (G[0] + G[1] + G[2] + G[3]);
        const double p = 0.5 * (G[1] + G[2] - G[0] - G[3]), q = 0.5 * (G[2] + G[3] - G[0] - G[1]);
        cut(g, p, q);
        const double half_xi = 0.5 * overlap.m_xi, half_eta = 0.5 * overlap.m_eta, quarter = 0.25 * overlap.share;
        overlap.by_corner = {quarter - half_xi - half_eta, quarter + half_xi - half_eta, quarter + half_xi + half_eta,
                             quarter - half_xi + half_eta};
    }

  private:
    struct Vertex {
        double xi, eta, G;
    };

    void cut(double g, double p, double q) {
        constexpr std::array<std::array<double, 2>, 4> corners{{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}};
        std::array<Vertex, 5> inside;
        int count = 0, held = 0;
        Vertex before{corners[3][0], corners[3][1], g - 0.5 * p + 0.5 * q};
        for (const auto& corner : corners) {
            const Vertex now{corner[0], corner[1], g + corner[0] * p + corner[1] * q};
            if ((before.G <= 0.0) != (now.G <= 0.0)) inside[count++] = between(before, now);
            if (now.G <= 0.0) inside[count++] = now, ++held;
            before = now;
        }
        if (held == 4) {
            overlap.gap = g, overlap.share = 1.0;
            overlap.half_square = 0.5 * (g * g + (p * p + q * q) / 12.0);
            return;
        }
        for (int i = 2; i < count; ++i) add(inside[0], inside[i - 1], inside[i]);
    }

    /// Where G vanishes between a vertex inside and one outside.
    static Vertex between(const Vertex& a, const Vertex& b) {
        const double part = a.G / (a.G - b.G);
        return {a.xi + part * (b.xi - a.xi), a.eta + part * (b.eta - a.eta), 0.0};
    }

    void add(const Vertex& a, const Vertex& b, const Vertex& c) {
        const double area = 0.5 * ((b.xi - a.xi) * (c.eta - a.eta) - (c.xi - a.xi) * (b.eta - a.eta));
        const double sum = a.G + b.G + c.G;
        overlap.gap += area * sum / 3.0;
        overlap.half_square += area * (a.G * a.G + b.G * b.G + c.G * c.G + sum * sum) / 24.0;
        overlap.share += area;
        overlap.m_xi += area * (a.xi + b.xi + c.xi) / 3.0;
        overlap.m_eta += area * (a.eta + b.eta + c.eta) / 3.0;
    }
};

}  // namespace umform
