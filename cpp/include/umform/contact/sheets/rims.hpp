// Cut edges of a face, rounded with half the thickness: the nearest point of such a rim, and the gap's first and second derivatives.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "umform/assembly/connectivity.hpp"
#include "umform/contact/sheets/boxes.hpp"
#include "umform/contact/sheets/foot.hpp"

namespace umform {

/// Cut edges: the nodes of each on its face, then those across the thickness; the facet that each belongs to, and its side there:
/// from corner k to corner k + 1.
struct CutEdges {
    Connectivity nodes;
    std::vector<std::array<std::int32_t, 2>> at;  // [edge] facet, side
};

/// An edge: the middle of the thickness c and half the vector w across it, at its nodes.
template <int Nodes>
struct Rim {
    static constexpr int count = Nodes == 4 ? 2 : 3;
    using Values = std::array<double, count>;
    std::array<Vec3, count> c, w;

    struct At {
        Values L;
        Vec3 e, c1, c2, m, w, w1, w2,
            nu;  // from c to the place, derivatives along the edge; unit vectors along e and w
        double distance, radius;

        double gap() const { return distance - radius; }
        double slope() const { return -dot(m, c1) - dot(nu, w1); }
        double curvature() const {
            const double a = dot(m, c1), b = dot(nu, w1);
            return (dot(c1, c1) - a * a) / distance - (dot(w1, w1) - b * b) / radius - dot(m, c2) - dot(nu, w2);
        }
    };

    static std::array<Values, 3> shape(double s) {
        if constexpr (count == 2)
            return {Values{0.5 * (1 - s), 0.5 * (1 + s)}, Values{-0.5, 0.5}, Values{0.0, 0.0}};
        else
            return {Values{0.5 * s * (s - 1), 0.5 * s * (s + 1), 1 - s * s}, Values{s - 0.5, s + 0.5, -2 * s},
                    Values{1.0, 1.0, -2.0}};
    }

    At at(const Vec3& x, double s) const {
        const auto [L, L1, L2] = shape(s);
        At at{L, x, {}, {}, {}, {}, {}, {}, {}, 0.0, 0.0};
        for (int i = 0; i < count; ++i)
            for (int k = 0; k < 3; ++k) {
                at.e[k] -= L[i] * c[i][k], at.c1[k] += L1[i] * c[i][k], at.c2[k] += L2[i] * c[i][k];
                at.w[k] += L[i] * w[i][k], at.w1[k] += L1[i] * w[i][k], at.w2[k] += L2[i] * w[i][k];
            }
        at.distance = std::sqrt(dot(at.e, at.e)), at.radius = std::sqrt(dot(at.w, at.w));
        for (int k = 0; k < 3; ++k) at.m[k] = at.e[k] / at.distance, at.nu[k] = at.w[k] / at.radius;
        return at;
    }

    /// The point between the ends with the least gap, and the way of the place beyond the nearer end; none in the middle. eq. (4.331)
    bool project(const Vec3& x, FacetFoot& foot, double& beyond) const {
        double s = 0.0;
        beyond = 0.0;
        for (int iteration = 0; iteration < 50; ++iteration) {
            const At here = at(x, s);
            if (!(here.distance > 0.1 * here.radius)) return false;
            // To the nearest point of the middle first: from afar, Newton's method on the distance jumps to and fro.
            const double curvature = here.curvature();
            const double step = iteration < 4 || !(curvature > 0.0) ? dot(here.e, here.c1) / dot(here.c1, here.c1)
                                                                    : -here.slope() / curvature;
            const double next = std::clamp(s + step, -1.0, 1.0);
            const double side = std::sqrt(dot(here.c1, here.c1));
            const bool still = iteration > 4 && std::abs(next - s) < no_change(1e-14, x, side);
            s = next;
            if (!still) continue;
            foot.r = s, foot.s = 0.0, foot.gap = here.gap(), foot.n = here.m;
            if (std::abs(s) == 1.0) beyond = std::max(s * dot(here.e, here.c1), 0.0) / side;
            return true;
        }
        return false;
    }

    /// First and second derivatives of the gap with respect to the place, the nodes on the face, and those across. eqs. (4.332), (4.333)
    struct Derivatives {
        static constexpr int blocks = 1 + 2 * count, size = 3 * blocks;
        std::array<double, size> first{};
        std::array<double, size * size> second{};
    };

    Derivatives derivatives(const Vec3& x, double s) const {
        Derivatives d;
        const At here = at(x, s);
        const Values L1 = shape(s)[1];
        Mat3 A, B;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const double one = i == j ? 1.0 : 0.0;
                A(i, j) = (one - here.m[i] * here.m[j]) / here.distance;
                B(i, j) = (one - here.nu[i] * here.nu[j]) / here.radius;
            }
        const Vec3 Ac = product(A, here.c1), Bw = product(B, here.w1);
        // Each block has its part in e and in w, and in their derivatives along the edge.
        std::array<double, Derivatives::blocks> in_e{1.0}, in_w{}, in_c1{}, in_w1{};
        for (int i = 0; i < count; ++i)
            for (int side = 0; side < 2; ++side) {
                const int block = 1 + side * count + i;
                const double sign = side == 0 ? 0.5 : -0.5;
                in_e[block] = -0.5 * here.L[i], in_w[block] = sign * here.L[i];
                in_c1[block] = 0.5 * L1[i], in_w1[block] = sign * L1[i];
            }
        std::array<double, Derivatives::size> moves{};  // of the slope
        for (int a = 0; a < Derivatives::blocks; ++a)
            for (int i = 0; i < 3; ++i) {
                d.first[3 * a + i] = in_e[a] * here.m[i] - in_w[a] * here.nu[i];
                moves[3 * a + i] = -in_e[a] * Ac[i] - in_c1[a] * here.m[i] - in_w[a] * Bw[i] - in_w1[a] * here.nu[i];
            }
        const double along = std::abs(s) < 1.0 ? 1.0 / here.curvature() : 0.0;  // an end stays an end
        for (int a = 0; a < Derivatives::blocks; ++a)
            for (int b = 0; b < Derivatives::blocks; ++b)
                for (int i = 0; i < 3; ++i)
                    for (int j = 0; j < 3; ++j)
                        d.second[(3 * a + i) * Derivatives::size + 3 * b + j] =
                            in_e[a] * in_e[b] * A(i, j) - in_w[a] * in_w[b] * B(i, j)
                            - along * moves[3 * a + i] * moves[3 * b + j];
        return d;
    }
};

/// A rim that a facet may meet: places whose normal n has n . m below `facing` of the rim's.
struct NearRim {
    std::int32_t edge;
    double facing;
};

/// Rims of a face at present positions.
template <int Nodes>
class Rims {
  public:
    Rims(CutEdges edges, int facets, const std::vector<Vec3>& x) : edges_(std::move(edges)), x_(x), of_(facets) {
        for (std::size_t k = 0; k < edges_.at.size(); ++k) of_[edges_.at[k][0]].push_back(static_cast<int>(k));
        boxes_.resize(edges_.at.size());
    }

    const std::vector<std::int32_t>& of(int facet) const { return of_[facet]; }
    const Connectivity& nodes() const { return edges_.nodes; }
    int facet(int edge) const { return edges_.at[edge][0]; }
    const FacetBox& box(int edge) const { return boxes_[edge]; }
    bool cut(int facet, int side) const {
        return std::any_of(of_[facet].begin(), of_[facet].end(), [&](int k) { return edges_.at[k][1] == side; });
    }

    void update() {
        for (std::size_t k = 0; k < boxes_.size(); ++k) boxes_[k] = box_at(static_cast<int>(k));
    }

    Rim<Nodes> at(int edge) const {
        constexpr int count = Rim<Nodes>::count;
        Rim<Nodes> rim;
        for (int i = 0; i < count; ++i) {
            const Vec3 &a = x_[edges_.nodes[edge][i]], &b = x_[edges_.nodes[edge][count + i]];
            for (int k = 0; k < 3; ++k) rim.c[i][k] = 0.5 * (a[k] + b[k]), rim.w[i][k] = 0.5 * (a[k] - b[k]);
        }
        return rim;
    }

    FacetBox box_at(int edge) const {
        const Rim<Nodes> rim = at(edge);
        FacetBox box;
        double radius = 0.0;
        for (int i = 0; i < Rim<Nodes>::count; ++i)
            box.add(rim.c[i]), radius = std::max(radius, std::sqrt(dot(rim.w[i], rim.w[i])));
        if constexpr (Nodes == 9) {  // of a parabola: the Bezier point
            Vec3 middle;
            for (int k = 0; k < 3; ++k) middle[k] = 2.0 * rim.c[2][k] - 0.5 * (rim.c[0][k] + rim.c[1][k]);
            box.add(middle);
        }
        box.grow(radius);
        return box;
    }

    /// How far natural coordinates are beyond the side of an edge.
    double beyond(int edge, const FacetFoot& foot) const { return beyond_side(edges_.at[edge][1], foot); }
    static double beyond_side(int side, const FacetFoot& foot) {
        const std::array<double, 4> out{-foot.s, foot.r, foot.s, -foot.r};
        return out[side] - 1.0;
    }

  private:
    CutEdges edges_;
    const std::vector<Vec3>& x_;
    std::vector<std::vector<std::int32_t>> of_;  // [facet]
    std::vector<FacetBox> boxes_;                // [edge]
};

}  // namespace umform
