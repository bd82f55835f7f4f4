// The symbolic part of a factorisation: fronts, and the way of each entry of the matrix into them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <new>
#include <vector>

#include "umform/multifrontal/entries.hpp"
#include "umform/multifrontal/panels.hpp"
#include "umform/multifrontal/structure.hpp"
#include "umform/multifrontal/supernodes.hpp"
#include "umform/ordering/quotient.hpp"

namespace umform::multifrontal {

/// A dense matrix in which the equations of a supernode are eliminated. Its first `pivots` rows and columns are those, the
/// others the equations of ancestors that they change.
struct Front {
    int first = 0, pivots = 0, size = 0;  // place of the first pivot; rows that may be eliminated, all rows
    int parent = -1;
    std::int64_t rows = 0;    // begin of the places of the other rows in Plan::rows, and in Plan::seat
    std::int64_t factor = 0;  // begin of the columns of the factor
    std::int64_t work = 0;    // multiplications of the subtree that ends here
    int updates() const { return size - pivots; }
};

/// Everything about a factorisation that does not depend on values. Places count equations in their order of elimination.
///
/// Of a front of size m the factor has `pivots` columns, stored by panels. If the matrix is not symmetric, these have m entries,
/// and the rows of the other factor follow behind the diagonal block in the same way, transposed.
struct Plan {
    int n = 0;
    bool symmetric = true;
    std::vector<std::int32_t> place, equation;           // [equation] -> place, [place] -> equation
    std::vector<Front> fronts;                           // children before parents, subtrees together
    std::vector<std::int32_t> children_start, children;  // fronts of which the parent is front f
    std::vector<std::int32_t> rows, seat;  // place of each row of an update; its row in the front of the parent
    EntryRuns entries;                     // of the matrix, with their places in the columns of the fronts
    std::int64_t factor_size = 0;          // numbers that are stored
    std::int64_t fill = 0;                 // entries of the factors: without the upper triangles of L

    Plan(const Rows& matrix, bool is_symmetric, const ordering::Quotient& quotient, const Supernodes& tree)
        : n(matrix.n), symmetric(is_symmetric), place(matrix.n), equation(matrix.n) {
        const int vertices = quotient.graph.size();
        std::vector<std::int32_t> weight(vertices, 0);
        for (const int v : quotient.group) ++weight[v];
        std::vector<std::int32_t> begin(vertices);
        number(tree, weight, quotient.group, begin);
        make_fronts(tree, weight, begin);
        link_children();
        map_rows();
    }

    /// Finds the way of the entries into the fronts.
    void map_entries(const Rows& matrix) {
        std::vector<std::int32_t> owner(n), local(n, 0);
        for (std::size_t f = 0; f < fronts.size(); ++f)
            std::fill_n(owner.begin() + fronts[f].first, fronts[f].pivots, static_cast<std::int32_t>(f));
        entries = EntryRuns(matrix, symmetric, place, owner, fronts.size());
        for (std::size_t f = 0; f < fronts.size(); ++f) {
            const Front& front = fronts[f];
            const int m = front.size, p = front.pivots;
            for (int k = 0; k < p; ++k) local[front.first + k] = k;
            for (int k = p; k < m; ++k) local[rows[front.rows + k - p]] = k;
            entries.locate(static_cast<int>(f), [&](int row, int entry, bool& across) {
                const int mine = place[row], there = place[matrix.indices[entry]];
                const int i = local[mine], j = local[there];
                across = there < mine || (!symmetric && j < p);
                if (there < mine || symmetric) return std::min(i, j) * m + std::max(i, j);
                return j < p ? j * m + i : p * m + i * (m - p) + j - p;
            });
        }
    }

  private:
    /// Places of the equations.
    void number(const Supernodes& tree, const std::vector<std::int32_t>& weight, const std::vector<std::int32_t>& group,
                std::vector<std::int32_t>& begin) {
        int next = 0;
        for (const auto& node : tree.nodes)
            for (const int v : node.pivots) begin[v] = next, next += weight[v];
        std::vector<std::int32_t> filled = begin;
        for (int i = 0; i < n; ++i) place[i] = filled[group[i]]++, equation[place[i]] = i;
    }

    void make_fronts(const Supernodes& tree, const std::vector<std::int32_t>& weight,
                     const std::vector<std::int32_t>& begin) {
        fronts.reserve(tree.nodes.size());
        std::vector<std::int32_t> sorted;
        for (const auto& node : tree.nodes) {
            Front front;
            front.first = begin[node.pivots.front()];
            front.pivots = static_cast<int>(node.columns), front.size = static_cast<int>(node.height);
            front.parent = node.parent;
            front.rows = static_cast<std::int64_t>(rows.size());
            sorted = node.rows;
            std::sort(sorted.begin(), sorted.end(), [&](int a, int b) { return begin[a] < begin[b]; });
            for (const int v : sorted)
                for (int k = 0; k < weight[v]; ++k) rows.push_back(begin[v] + k);
            front.factor = factor_size;
            const std::int64_t p = front.pivots, m = front.size;
            if (2 * p * m > std::numeric_limits<std::int32_t>::max()) throw std::bad_alloc();
            factor_size += static_cast<std::int64_t>(Panels::of_factor(m, p, symmetric).size());
            if (!symmetric) factor_size += p * (m - p);
            fill += p * m - p * (p - 1) / 2;
            for (std::int64_t k = 0; k < p; ++k) front.work += (m - k) * (m - k) / (symmetric ? 2 : 1);
            fronts.push_back(front);
        }
        if (!symmetric) fill = 2 * fill - n;
        for (const Front& front : fronts)
            if (front.parent >= 0) fronts[front.parent].work += front.work;
    }

    void link_children() {
        const int count = static_cast<int>(fronts.size());
        children_start.assign(count + 1, 0);
        for (const Front& front : fronts)
            if (front.parent >= 0) ++children_start[front.parent + 1];
        for (int f = 0; f < count; ++f) children_start[f + 1] += children_start[f];
        children.resize(children_start[count]);
        std::vector<std::int32_t> next(children_start.begin(), children_start.end() - 1);
        for (int f = 0; f < count; ++f)
            if (fronts[f].parent >= 0) children[next[fronts[f].parent]++] = f;
    }

    /// Rows of the updates in the fronts of the parents: both are sorted.
    void map_rows() {
        seat.resize(rows.size());
        for (const Front& front : fronts) {
            if (front.parent < 0) continue;
            const Front& parent = fronts[front.parent];
            std::int64_t there = parent.rows;
            for (std::int64_t k = front.rows; k < front.rows + front.updates(); ++k) {
                if (rows[k] < parent.first + parent.pivots) {
                    seat[k] = rows[k] - parent.first;
                    continue;
                }
                while (rows[there] != rows[k]) ++there;
                seat[k] = parent.pivots + static_cast<int>(there - parent.rows);
            }
        }
    }
};

}  // namespace umform::multifrontal
