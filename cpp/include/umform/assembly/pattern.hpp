// The sparse pattern over the free degrees of freedom.
#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>

#include "umform/assembly/connectivity.hpp"

namespace umform {

/// Compressed sparse rows with sorted columns. A symmetric pattern holds the upper triangle only.
struct Pattern {
    bool symmetric = true;
    std::vector<std::int32_t> equation;  // [dof] -> row, or -1 where the dof is prescribed
    std::vector<std::int64_t> indptr;
    std::vector<std::int32_t> indices;

    int rows() const { return static_cast<int>(indptr.size()) - 1; }
    int nodes() const { return static_cast<int>(equation.size()) / 3; }

    /// Position of an entry in `indices`. Throws std::out_of_range for a pair that is not in the pattern.
    std::int32_t find(int row, int column) const {
        if (row >= 0 && row < rows()) {
            const auto begin = indices.begin() + indptr[row], end = indices.begin() + indptr[row + 1];
            const auto at = std::lower_bound(begin, end, column);
            if (at != end && *at == column) return static_cast<std::int32_t>(at - indices.begin());
        }
        throw std::out_of_range("row " + std::to_string(row) + " and column " + std::to_string(column)
                                + " are not in the sparse pattern: no term couples them");
    }
};

/// Throws std::out_of_range for a node that the model does not have.
inline void check_nodes(const Connectivity& part, int nodes) {
    for (const std::int32_t node : part.ids)
        if (node < 0 || node >= nodes)
            throw std::out_of_range("node " + std::to_string(node) + " of an element, the model has "
                                    + std::to_string(nodes) + " nodes");
}

/// For each node the nodes that share an element with it, sorted, itself among them.
inline std::vector<std::vector<std::int32_t>> make_neighbours(int nodes,
                                                              const std::vector<const Connectivity*>& parts) {
    std::vector<std::vector<std::int32_t>> neighbours(nodes);
    for (int node = 0; node < nodes; ++node) neighbours[node].push_back(node);
    for (const Connectivity* part : parts) {
        check_nodes(*part, nodes);
        for (int e = 0; e < part->size(); ++e)
            for (int a = 0; a < part->nodes; ++a) {
                auto& list = neighbours[(*part)[e][a]];
                list.insert(list.end(), (*part)[e], (*part)[e] + part->nodes);
            }
    }
    for (auto& list : neighbours) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
    return neighbours;
}

/// The pattern of all couplings: `parts` are the connectivities of all terms of the model.
inline Pattern make_pattern(std::vector<std::int32_t> equation, const std::vector<const Connectivity*>& parts,
                            bool symmetric) {
    const int nodes = static_cast<int>(equation.size()) / 3;
    const std::vector<std::vector<std::int32_t>> neighbours = make_neighbours(nodes, parts);
    Pattern pattern;
    pattern.symmetric = symmetric;
    const int rows = equation.empty() ? 0 : 1 + *std::max_element(equation.begin(), equation.end());
    std::vector<std::int32_t> dof_of(rows);
    for (int dof = 0; dof < 3 * nodes; ++dof)
        if (equation[dof] >= 0) dof_of[equation[dof]] = dof;
    pattern.indptr.assign(1, 0);
    std::vector<std::int32_t> columns;
    for (int row = 0; row < rows; ++row) {
        columns.clear();
        for (const int node : neighbours[dof_of[row] / 3])
            for (int k = 0; k < 3; ++k) {
                const int column = equation[3 * node + k];
                if (column >= (symmetric ? row : 0)) columns.push_back(column);
            }
        std::sort(columns.begin(), columns.end());
        pattern.indices.insert(pattern.indices.end(), columns.begin(), columns.end());
        pattern.indptr.push_back(static_cast<std::int64_t>(pattern.indices.size()));
    }
    if (pattern.indices.size() > INT32_MAX) throw std::length_error("more than 2^31 entries in one matrix");
    pattern.equation = std::move(equation);
    return pattern;
}

}  // namespace umform
