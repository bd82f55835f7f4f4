// Tree of boxes around things in space, in flat arrays: those that may lie nearest to a point, the near ones first.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "umform/algebra/tensor.hpp"

namespace umform {

struct Box {
    Vec3 low, high;

    static Box empty() {
        const double all = std::numeric_limits<double>::infinity();
        return {{all, all, all}, {-all, -all, -all}};
    }
    void take_in(const Vec3& x) {
        for (int k = 0; k < 3; ++k) low[k] = std::min(low[k], x[k]), high[k] = std::max(high[k], x[k]);
    }
    double square_to(const Vec3& x) const {
        double square = 0.0;
        for (int k = 0; k < 3; ++k) {
            const double d = std::max({low[k] - x[k], x[k] - high[k], 0.0});
            square += d * d;
        }
        return square;
    }
};

class BoxTree {
  public:
    /// Halves the things at the median of their middles along the longest side, until no more than `leaf_size` are left.
    explicit BoxTree(const std::vector<Box>& boxes) : order_(boxes.size()) {
        std::iota(order_.begin(), order_.end(), 0);
        nodes_.reserve(2 * boxes.size());
        if (!boxes.empty()) split(boxes, 0, static_cast<int>(boxes.size()));
    }

    /// The things in the order of the leaves.
    const std::vector<int>& order() const { return order_; }

    /// Calls visit(place in the order) for each thing whose box is no farther than the square of a distance, which visit
    /// returns and which may only fall.
    template <class Visit>
    void near_first(const Vec3& x, double square, const Visit& visit) const {
        struct Waiting {
            int node;
            double square;
        };
        std::array<Waiting, deepest> stack;
        int waiting = 0;
        stack[waiting++] = {0, 0.0};
        while (waiting > 0) {
            const Waiting next = stack[--waiting];
            if (next.square > square) continue;
            const Node& node = nodes_[next.node];
            if (node.right == 0) {
                for (int i = node.first; i < node.last; ++i) square = visit(i);
                continue;
            }
            const Waiting left{next.node + 1, nodes_[next.node + 1].box.square_to(x)};
            const Waiting right{node.right, nodes_[node.right].box.square_to(x)};
            const bool left_first = left.square <= right.square;
            stack[waiting++] = left_first ? right : left;
            stack[waiting++] = left_first ? left : right;
        }
    }

  private:
    static constexpr int leaf_size = 2, deepest = 64;  // more than 2^60 things do not exist

    struct Node {
        Box box;
        int first, last;
        int right;  // the left child follows its parent; 0 marks a leaf
    };

    int split(const std::vector<Box>& boxes, int first, int last) {
        const int at = static_cast<int>(nodes_.size());
        Box around = Box::empty(), middles = Box::empty();
        for (int i = first; i < last; ++i) {
            const Box& box = boxes[order_[i]];
            around.take_in(box.low), around.take_in(box.high);
            middles.take_in(middle(box));
        }
        nodes_.push_back({around, first, last, 0});
        if (last - first <= leaf_size) return at;
        int axis = 0;
        for (int k = 1; k < 3; ++k)
            if (middles.high[k] - middles.low[k] > middles.high[axis] - middles.low[axis]) axis = k;
        const int half = first + (last - first) / 2;
        std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + last, [&](int i, int k) {
            const double one = middle(boxes[i])[axis], other = middle(boxes[k])[axis];
            return one < other || (one == other && i < k);
        });
        split(boxes, first, half);
        const int right = split(boxes, half, last);
        nodes_[at].right = right;
        return at;
    }

    static Vec3 middle(const Box& box) {
        Vec3 middle;
        for (int k = 0; k < 3; ++k) middle[k] = 0.5 * (box.low[k] + box.high[k]);
        return middle;
    }

    std::vector<int> order_;
    std::vector<Node> nodes_;
};

}  // namespace umform
