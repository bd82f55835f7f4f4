// Supernodes: vertices that are eliminated together since their columns of the factors have the same structure.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "umform/ordering/quotient.hpp"

namespace umform::multifrontal {

/// Tree of supernodes of a graph and its order of elimination. (J. W. H. Liu, The multifrontal method for sparse matrix
/// solution, SIAM Review 34 (1992) 82-109)
///
/// A vertex joins its child if only itself is missing from the structure of its column. A supernode joins its
/// parent where few entries that are zero are added by that, since large dense blocks are worked on faster than small ones.
struct Supernodes {
    struct Node {
        std::vector<std::int32_t> pivots;  // vertices
        std::vector<std::int32_t> rows;    // vertices of the ancestors that the columns reach, in their order
        int parent = -1;
        std::int64_t columns = 0, height = 0, zeros = 0;  // equations of pivots, of pivots and rows; entries filled up
    };
    std::vector<Node> nodes;  // children before parents

    Supernodes(const ordering::Graph& graph, const std::vector<std::int32_t>& weight,
               const std::vector<std::int32_t>& order) {
        eliminate(graph, weight, order);
        amalgamate();
        sort();
    }

    /// Multiplications of a symmetric factorisation, and as many again where it is not.
    double work() const {
        double sum = 0.0;
        for (const Node& node : nodes) {
            const double p = static_cast<double>(node.columns), m = static_cast<double>(node.height);
            sum += 0.5 * p * (m * m - m * p + p * p / 3.0);
        }
        return sum;
    }

  private:
    static constexpr std::int64_t kTiny = 24, kSmall = 96;                          // columns of a supernode
    static constexpr double tiny_fill = 0.5, small_fill = 0.08, large_fill = 0.03;  // share of zeros that may be added

    /// Structure of each column from those of its children.
    void eliminate(const ordering::Graph& graph, const std::vector<std::int32_t>& weight,
                   const std::vector<std::int32_t>& order) {
        const int size = graph.size();
        std::vector<std::int32_t> when(size), mark(size, -1), owner(size, -1), child(size, -1), sibling(size, -1), rows;
        for (int t = 0; t < size; ++t) when[order[t]] = t;
        for (int t = 0; t < size; ++t) {
            const int v = order[t];
            rows.clear();
            mark[v] = v;
            const auto add = [&](int w) {
                if (when[w] > t && mark[w] != v) mark[w] = v, rows.push_back(w);
            };
            int home = -1;  // supernode of the child whose structure is that of v
            for (int c = child[t]; c >= 0; c = sibling[c])
                for (const int w : nodes[c].rows) add(w);
            for (int k = graph.start[v]; k < graph.start[v + 1]; ++k) add(graph.to[k]);
            for (int c = child[t]; c >= 0; c = sibling[c])
                if (nodes[c].rows.size() == rows.size() + 1) home = c;
            if (home < 0) {
                home = static_cast<int>(nodes.size());
                nodes.emplace_back();
                std::sort(rows.begin(), rows.end(), [&](int a, int b) { return when[a] < when[b]; });
                nodes[home].rows = rows;
                for (const int w : rows) nodes[home].height += weight[w];
            } else {
                auto& left = nodes[home].rows;  // sorted: v comes first
                left.erase(left.begin());
                nodes[home].height -= weight[v];
            }
            Node& node = nodes[home];
            node.pivots.push_back(v);
            node.columns += weight[v];
            for (int c = child[t]; c >= 0; c = sibling[c])
                if (c != home) nodes[c].parent = home;
            if (!node.rows.empty()) {
                const int next = when[node.rows.front()];
                sibling[home] = child[next], child[next] = home;
            }
        }
        for (Node& node : nodes) node.height += node.columns;
        number_by_last_pivot(when);
    }

    /// Children before parents: a supernode was numbered by its first pivot.
    void number_by_last_pivot(const std::vector<std::int32_t>& when) {
        std::vector<std::int32_t> by_last(nodes.size());
        std::iota(by_last.begin(), by_last.end(), 0);
        std::sort(by_last.begin(), by_last.end(),
                  [&](int a, int b) { return when[nodes[a].pivots.back()] < when[nodes[b].pivots.back()]; });
        renumber(by_last);
    }

    void renumber(const std::vector<std::int32_t>& order) {
        std::vector<std::int32_t> number(nodes.size(), -1);
        for (std::size_t k = 0; k < order.size(); ++k) number[order[k]] = static_cast<std::int32_t>(k);
        std::vector<Node> sorted;
        sorted.reserve(order.size());
        for (const int s : order) {
            sorted.push_back(std::move(nodes[s]));
            if (sorted.back().parent >= 0) sorted.back().parent = number[sorted.back().parent];
        }
        nodes = std::move(sorted);
    }

    /// Joins supernodes with their parents where that adds few zeros.
    void amalgamate() {
        const int count = static_cast<int>(nodes.size());
        std::vector<std::int32_t> into(count, -1);
        for (int s = 0; s < count; ++s) {
            const int p = nodes[s].parent;
            if (p < 0) continue;
            Node &node = nodes[s], &parent = nodes[p];
            const std::int64_t columns = node.columns + parent.columns, height = node.columns + parent.height;
            const std::int64_t zeros =
                node.zeros + parent.zeros + node.columns * (parent.height - (node.height - node.columns));
            const std::int64_t entries = columns * height - columns * (columns - 1) / 2;
            const double share = columns <= kTiny ? tiny_fill : columns <= kSmall ? small_fill : large_fill;
            if (static_cast<double>(zeros) > share * static_cast<double>(entries)) continue;
            into[s] = p;
            node.pivots.insert(node.pivots.end(), parent.pivots.begin(), parent.pivots.end());
            parent.pivots = std::move(node.pivots);
            parent.columns = columns, parent.height = height, parent.zeros = zeros;
            node.rows.clear();
        }
        std::vector<std::int32_t> stay;
        for (int s = 0; s < count; ++s) {
            if (into[s] >= 0) continue;
            stay.push_back(s);
            int& parent = nodes[s].parent;
            while (parent >= 0 && into[parent] >= 0) parent = into[parent];
        }
        renumber(stay);
    }

    /// Postorder, with the children first whose updates take much memory on the way.
    void sort() {
        const int count = static_cast<int>(nodes.size());
        std::vector<std::vector<std::int32_t>> children(count + 1);
        for (int s = 0; s < count; ++s) children[nodes[s].parent < 0 ? count : nodes[s].parent].push_back(s);
        std::vector<std::int64_t> peak(count, 0);
        const auto update = [&](int s) {
            return (nodes[s].height - nodes[s].columns) * (nodes[s].height - nodes[s].columns);
        };
        for (int s = 0; s < count; ++s) {
            std::sort(children[s].begin(), children[s].end(), [&](int a, int b) {
                const std::int64_t more = (peak[a] - update(a)) - (peak[b] - update(b));
                return more != 0 ? more > 0 : a < b;
            });
            std::int64_t held = 0;
            for (const int c : children[s]) peak[s] = std::max(peak[s], held + peak[c]), held += update(c);
            peak[s] = std::max(peak[s], held + update(s));
        }
        std::vector<std::int32_t> order, todo(children[count].rbegin(), children[count].rend());
        std::vector<std::uint8_t> open(count, 0);
        while (!todo.empty()) {
            const int s = todo.back();
            if (open[s] != 0) {
                order.push_back(s);
                todo.pop_back();
                continue;
            }
            open[s] = 1;
            todo.insert(todo.end(), children[s].rbegin(), children[s].rend());
        }
        renumber(order);
    }
};

}  // namespace umform::multifrontal
