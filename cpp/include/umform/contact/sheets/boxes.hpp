// Boxes around facets, and a tree of them that finds those that a box meets.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "umform/algebra/tensor.hpp"

namespace umform {

struct FacetBox {
    Vec3 lower{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
               std::numeric_limits<double>::infinity()};
    Vec3 upper{-lower[0], -lower[1], -lower[2]};

    void add(const Vec3& x) {
        for (int k = 0; k < 3; ++k) lower[k] = std::min(lower[k], x[k]), upper[k] = std::max(upper[k], x[k]);
    }
    void add(const FacetBox& other) { add(other.lower), add(other.upper); }
    void grow(double way) {
        for (int k = 0; k < 3; ++k) lower[k] -= way, upper[k] += way;
    }
    bool meets(const FacetBox& other) const {
        for (int k = 0; k < 3; ++k)
            if (lower[k] > other.upper[k] || other.lower[k] > upper[k]) return false;
        return true;
    }
    bool has(const Vec3& x, double beyond) const {
        for (int k = 0; k < 3; ++k)
            if (x[k] < lower[k] - beyond || x[k] > upper[k] + beyond) return false;
        return true;
    }
};

/// Box of a bilinear facet, or of a biquadratic one: that of its Bezier points, which contain it.
template <int Nodes>
FacetBox box_of(const std::array<Vec3, Nodes>& x) {
    FacetBox box;
    if constexpr (Nodes == 4) {
        for (const Vec3& corner : x) box.add(corner);
    } else {
        constexpr std::array<std::array<int, 3>, 3> row{{{0, 4, 1}, {7, 8, 5}, {3, 6, 2}}};
        std::array<std::array<Vec3, 3>, 3> b;
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) b[j][i] = x[row[j][i]];
        const auto middle = [](const Vec3& a, const Vec3& m, const Vec3& c) {
            return Vec3{2 * m[0] - 0.5 * (a[0] + c[0]), 2 * m[1] - 0.5 * (a[1] + c[1]), 2 * m[2] - 0.5 * (a[2] + c[2])};
        };
        for (int j = 0; j < 3; ++j) b[j][1] = middle(b[j][0], b[j][1], b[j][2]);
        for (int i = 0; i < 3; ++i) b[1][i] = middle(b[0][i], b[1][i], b[2][i]);
        for (const auto& line : b)
            for (const Vec3& point : line) box.add(point);
    }
    return box;
}

/// Halves of halves along the longest side, down to a few boxes.
class FacetTree {
  public:
    explicit FacetTree(std::vector<FacetBox> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
        std::iota(order_.begin(), order_.end(), 0);
        if (!order_.empty()) build(0, static_cast<int>(order_.size()));
    }

    /// Calls visit(number) for all boxes that meet another one, in no particular order.
    template <class Visit>
    void meeting(const FacetBox& box, const Visit& visit) const {
        if (!nodes_.empty()) descend(0, box, visit);
    }

  private:
    static constexpr int few = 4;
    struct Node {
        FacetBox box;
        int first, last, second;  // its boxes in order_; the other half, or -1 of a leaf; the first half follows
    };

    int build(int first, int last) {
        const int at = static_cast<int>(nodes_.size());
        FacetBox box;
        for (int i = first; i < last; ++i) box.add(boxes_[order_[i]]);
        nodes_.push_back({box, first, last, -1});
        if (last - first <= few) return at;
        int axis = 0;
        for (int k = 1; k < 3; ++k)
            if (box.upper[k] - box.lower[k] > box.upper[axis] - box.lower[axis]) axis = k;
        const int middle = first + (last - first) / 2;
        const auto centre = [&](int i) { return boxes_[i].lower[axis] + boxes_[i].upper[axis]; };
        std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                         [&](int a, int b) { return centre(a) < centre(b) || (centre(a) == centre(b) && a < b); });
        build(first, middle);
        const int second = build(middle, last);
        nodes_[at].second = second;
        return at;
    }

    template <class Visit>
    void descend(int at, const FacetBox& box, const Visit& visit) const {
        const Node& node = nodes_[at];
        if (!node.box.meets(box)) return;
        if (node.second < 0) {
            for (int i = node.first; i < node.last; ++i)
                if (boxes_[order_[i]].meets(box)) visit(order_[i]);
            return;
        }
        descend(at + 1, box, visit);
        descend(node.second, box, visit);
    }

    std::vector<FacetBox> boxes_;
    std::vector<int> order_;
    std::vector<Node> nodes_;
};

}  // namespace umform
