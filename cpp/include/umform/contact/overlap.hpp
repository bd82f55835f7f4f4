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

template <class Real>
struct VertexOf {
    Real xi, eta, G;
};

/// A part of the square, counterclockwise, and how many corners of the square it has.
template <class Real>
struct PolygonOf {
    std::array<VertexOf<Real>, 5> vertices;
    int count = 0, held = 0;
};

inline bool inside(double G) { return G <= 0.0; }

/// The part of the square where G = g + p xi + q eta is not positive.
template <class Real>
PolygonOf<Real> inside_of(const Real& g, const Real& p, const Real& q) {
    constexpr std::array<std::array<double, 2>, 4> corners{{{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}}};
    const auto at = [&](const std::array<double, 2>& corner) {
        return VertexOf<Real>{Real{corner[0]}, Real{corner[1]}, g + corner[0] * p + corner[1] * q};
    };
    PolygonOf<Real> part;
    VertexOf<Real> before = at(corners[3]);
    for (const auto& corner : corners) {
        const VertexOf<Real> now = at(corner);
        if (inside(before.G) != inside(now.G)) {  // where G vanishes between a vertex inside and one outside
            const Real share = before.G / (before.G - now.G);
            part.vertices[part.count++] = {before.xi + share * (now.xi - before.xi),
                                           before.eta + share * (now.eta - before.eta), Real{0.0}};
        }
        if (inside(now.G)) part.vertices[part.count++] = now, ++part.held;
        before = now;
    }
    return part;
}

/// The plane next to values at the corners of the square.
struct CellPlane {
    double g, p, q;

    explicit CellPlane(const std::array<double, 4>& G)
        : g(0.25 * (G[0] + G[1] + G[2] + G[3])), p(0.5 * (G[1] + G[2] - G[0] - G[3])),
          q(0.5 * (G[2] + G[3] - G[0] - G[1])) {}
};

/// Overlap of a cell from values at its corners: G is the plane next to them, and the square is cut with the line G = 0. No step divides by p or q, so that a cell along the tool is no
/// special case.
class Cut {
  public:
    Overlap overlap;

    explicit Cut(const std::array<double, 4>& G) {
        cut(CellPlane(G));
        const double half_xi = 0.5 * overlap.m_xi, half_eta = 0.5 * overlap.m_eta, quarter = 0.25 * overlap.share;
        overlap.by_corner = {quarter - half_xi - half_eta, quarter + half_xi - half_eta, quarter + half_xi + half_eta,
                             quarter - half_xi + half_eta};
    }

  private:
    using Vertex = VertexOf<double>;

    void cut(const CellPlane& plane) {
        const auto& [g, p, q] = plane;
        const PolygonOf<double> part = inside_of(g, p, q);
        if (part.held == 4) {
            overlap.gap = g, overlap.share = 1.0;
            overlap.half_square = 0.5 * (g * g + (p * p + q * q) / 12.0);
            return;
        }
        for (int i = 2; i < part.count; ++i) add(part.vertices[0], part.vertices[i - 1], part.vertices[i]);
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
