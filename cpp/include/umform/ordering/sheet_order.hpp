// Order of elimination of a sheet, and its matrix in blocks of indistinguishable equations.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <stdexcept>
#include <utility>
#include <vector>

#include "umform/ordering/dissection.hpp"
#include "umform/ordering/quotient.hpp"

namespace umform::ordering {

/// Order of elimination of the equations of a symmetric pattern, whose upper triangle is stored by rows. There is none
/// where few equations are indistinguishable, or where the graph is not that of a sheet.
struct SheetOrder {
    Quotient quotient;
    std::vector<std::int32_t> vertices;  // in their order of elimination

    SheetOrder(const std::int32_t* indptr, const std::int32_t* indices, int n)
        : quotient(make_quotient(indptr, indices, n)) {
        if (2 * quotient.graph.size() <= n) vertices = Dissection(quotient.graph).run();
    }

    /// Equations of the largest group.
    int largest() const {
        std::vector<std::int32_t> members(quotient.graph.size(), 0);
        for (const int v : quotient.group) ++members[v];
        return members.empty() ? 0 : *std::max_element(members.begin(), members.end());
    }

    /// The order of the equations: those of a vertex follow each other.
    std::vector<std::int32_t> equations() const {
        if (vertices.empty()) return {};
        std::vector<std::int32_t> next(quotient.graph.size(), 0), order(quotient.group.size());
        for (const int v : quotient.group) ++next[v];
        int begin = 0;
        for (const int v : vertices) begin += std::exchange(next[v], begin);
        for (std::size_t row = 0; row < order.size(); ++row)
            order[next[quotient.group[row]]++] = static_cast<std::int32_t>(row);
        return order;
    }
};

/// Upper triangle by rows of square blocks, one for two groups that are neighbours. All blocks have the size of the largest
/// group: smaller groups are filled up with equations x = 0 that touch no other one.
class BlockPattern {
  public:
    explicit BlockPattern(const Quotient& quotient) : group_(quotient.group), place_(quotient.group.size()) {
        const Graph& graph = quotient.graph;
        std::vector<std::int32_t> members(graph.size(), 0);
        for (std::size_t row = 0; row < group_.size(); ++row) place_[row] = members[group_[row]]++;
        size_ = members.empty() ? 0 : *std::max_element(members.begin(), members.end());
        for (std::size_t row = 0; row < group_.size(); ++row) place_[row] += group_[row] * size_;
        for (int v = 0; v < graph.size(); ++v) {
            indices_.push_back(v);
            std::copy_if(graph.to.begin() + graph.start[v], graph.to.begin() + graph.start[v + 1],
                         std::back_inserter(indices_), [&](int w) { return w > v; });
            std::sort(indices_.begin() + indptr_.back(), indices_.end());
            indptr_.push_back(static_cast<std::int32_t>(indices_.size()));
        }
    }

    int size() const { return size_; }
    const std::vector<std::int32_t>& indptr() const { return indptr_; }
    const std::vector<std::int32_t>& indices() const { return indices_; }
    const std::vector<std::int32_t>& place() const { return place_; }  // [equation] -> row of the filled-up matrix

    std::size_t entries() const { return indices_.size() * size_ * size_; }

    /// Entries of the blocks from those of the pattern. Blocks on the diagonal get both of their triangles. Throws if an
    /// entry lies in none of the blocks: the pattern is another one, or unequal rows were taken for equal ones.
    void fill(const std::int32_t* indptr, const std::int32_t* indices, const double* values, double* out) const {
        std::fill_n(out, entries(), 0.0);
        for (std::size_t v = 0; v + 1 < indptr_.size(); ++v)
            for (int a = 0; a < size_; ++a) *entry(indptr_[v], a, a, out) = 1.0;
        std::vector<std::int32_t> block(indptr_.size(), 0);  // of a column in the present row
        int present = -1;
        for (std::size_t row = 0; row < group_.size(); ++row) {
            const int v = group_[row], a = place_[row] - v * size_;
            if (v != present)
                for (int k = indptr_[v]; k < indptr_[v + 1]; ++k) block[indices_[k]] = k;
            present = v;
            for (int k = indptr[row]; k < indptr[row + 1]; ++k) {
                const int w = group_[indices[k]], b = place_[indices[k]] - w * size_;
                const int here = w < v ? find(w, v) : block[w];
                check(here, std::min(v, w), std::max(v, w));
                *(w < v ? entry(here, b, a, out) : entry(here, a, b, out)) = values[k];
                if (w == v) *entry(here, b, a, out) = values[k];
            }
        }
    }

  private:
    std::vector<std::int32_t> group_, place_, indptr_{0}, indices_;
    int size_ = 0;

    double* entry(int block, int a, int b, double* out) const {
        return out + (static_cast<std::size_t>(block) * size_ + a) * size_ + b;
    }

    void check(int block, int row, int column) const {
        if (block < indptr_[row] || block >= indptr_[row + 1] || indices_[block] != column)
            throw std::invalid_argument("an entry of the matrix lies in none of the blocks");
    }

    int find(int row, int column) const {
        const auto begin = indices_.begin() + indptr_[row], end = indices_.begin() + indptr_[row + 1];
        return static_cast<int>(std::lower_bound(begin, end, column) - indices_.begin());
    }
};

}  // namespace umform::ordering
