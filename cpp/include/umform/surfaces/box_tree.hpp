// Tree of boxes around items in space, eight to a node: finds the items that may be nearest to a point, near ones first.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "umform/algebra/lanes.hpp"
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

/// Brings what a search reads soon from memory: it would wait for each of these otherwise.
template <class T>
void prefetch(const T& thing) {
    for (std::size_t line = 0; line < sizeof(T); line += 64)
        __builtin_prefetch(reinterpret_cast<const char*>(&thing) + line);
}

class BoxTree {
  public:
    /// Divides the items by medians of their centres along the longest sides, until each box has one item.
    explicit BoxTree(const std::vector<Box>& boxes) : order_(boxes.size()) {
        std::iota(order_.begin(), order_.end(), 0);
        nodes_.reserve(boxes.size());
        if (!boxes.empty()) split(boxes, {0, static_cast<int>(boxes.size())});
    }

    /// The items in the order of the leaves.
    const std::vector<int>& order() const { return order_; }

    /// Calls visit(place in the order) for each item whose box is no farther than the square of a distance, which visit
    /// returns and which may only fall; ahead(place in the order) for each item that may be visited soon.
    template <class Visit, class Ahead>
    void near_first(const Vec3& x, double square, const Visit& visit, const Ahead& ahead) const {
        std::array<Waiting, (width - 1) * deepest + 1> stack;
        int waiting = 0;
        stack[waiting++] = {0, 0.0};
        while (waiting > 0) {
            const Waiting next = stack[--waiting];
            if (next.square > square) continue;
            if (next.child < 0) {
                square = visit(~next.child);
                continue;
            }
            const Node& node = nodes_[next.child];
            const Squares squares = node.squares_to(x);
            const int first = waiting;
            for (int i = 0; i < node.count; ++i) {
                const double own = squares[i];
                if (own > square) continue;
                int at = waiting++;  // the nearest one on top
                for (; at > first && stack[at - 1].square < own; --at) stack[at] = stack[at - 1];
                stack[at] = {node.child[i], own};
                if (node.child[i] < 0)
                    ahead(~node.child[i]);
                else
                    prefetch(nodes_[node.child[i]]);
            }
        }
    }

  private:
    static constexpr int registers = 2, width = registers * lane_count, deepest = 11;  // enough for 8^10 items

    /// A node, or an item by the complement of its place; the square of the distance of its box.
    struct Waiting {
        int child;
        double square;
    };

    struct Range {
        int first, last;
        int count() const { return last - first; }
    };

    using Squares = std::array<double, width>;

    /// The boxes of its children, one in each lane of some registers.
    struct Node {
        std::array<std::array<Lanes, registers>, 3> low, high;
        std::array<int, width> child;
        int count;

        Squares squares_to(const Vec3& x) const {
            Squares all;
            for (int r = 0; r < registers; ++r) {
                Lanes squares = 0.0;
                for (int k = 0; k < 3; ++k) {
                    const Lanes below = low[k][r] - Lanes(x[k]), above = Lanes(x[k]) - high[k][r];
                    const Lanes farther = select(below < above, above, below);
                    const Lanes d = select(farther < Lanes(0.0), Lanes(0.0), farther);
                    squares += d * d;
                }
                for (int i = 0; i < lane_count; ++i) all[r * lane_count + i] = squares[i];
            }
            return all;
        }
    };

    int split(const std::vector<Box>& boxes, Range range) {
        const int at = static_cast<int>(nodes_.size());
        nodes_.push_back({});
        std::array<Range, width> parts{range};
        int count = 1;
        while (count < width) {
            const auto largest = std::max_element(parts.begin(), parts.begin() + count,
                                                  [](const Range& a, const Range& b) { return a.count() < b.count(); });
            if (largest->count() < 2) break;
            const int half = halve(boxes, *largest);
            std::move_backward(largest + 1, parts.begin() + count, parts.begin() + count + 1);
            *(largest + 1) = {half, largest->last};
            largest->last = half;
            ++count;
        }
        nodes_[at].count = count;
        for (int i = 0; i < count; ++i) {
            Box around = Box::empty();
            for (int j = parts[i].first; j < parts[i].last; ++j)
                around.take_in(boxes[order_[j]].low), around.take_in(boxes[order_[j]].high);
            for (int k = 0; k < 3; ++k) {
                nodes_[at].low[k][i / lane_count].set(i % lane_count, around.low[k]);
                nodes_[at].high[k][i / lane_count].set(i % lane_count, around.high[k]);
            }
            const int child = parts[i].count() == 1 ? ~parts[i].first : split(boxes, parts[i]);
            nodes_[at].child[i] = child;
        }
        return at;
    }

    /// Partitions a range of items at the median of their centres along the longest side.
    int halve(const std::vector<Box>& boxes, Range range) {
        Box middles = Box::empty();
        for (int i = range.first; i < range.last; ++i) middles.take_in(middle(boxes[order_[i]]));
        int axis = 0;
        for (int k = 1; k < 3; ++k)
            if (middles.high[k] - middles.low[k] > middles.high[axis] - middles.low[axis]) axis = k;
        const int half = range.first + range.count() / 2;
        std::nth_element(order_.begin() + range.first, order_.begin() + half, order_.begin() + range.last,
                         [&](int i, int k) {
                             const double one = middle(boxes[i])[axis], other = middle(boxes[k])[axis];
                             return one < other || (one == other && i < k);
                         });
        return half;
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
