// The sparse pattern over the free degrees of freedom and the map from element matrices into it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace umform {

/// Elements of one kind: `nodes` node ids each. Degree of freedom = 3 * node + direction.
struct Connectivity {
    int nodes = 0;
    std::vector<std::int32_t> ids;  // [element][nodes]
    int size() const { return nodes == 0 ? 0 : static_cast<int>(ids.size()) / nodes; }
    const std::int32_t* operator[](int element) const { return ids.data() + static_cast<std::size_t>(element) * nodes; }
};

/// Compressed sparse rows with sorted columns. A symmetric pattern holds the upper triangle only.
struct Pattern {
    bool symmetric = true;
    std::vector<std::int32_t> equation;  // [dof] -> row, or -1 where the dof is prescribed
    std::vector<std::int64_t> indptr;
    std::vector<std::int32_t> indices;

    int rows() const { return static_cast<int>(indptr.size()) - 1; }

    std::int32_t find(int row, int column) const {
        const auto begin = indices.begin() + indptr[row], end = indices.begin() + indptr[row + 1];
        return static_cast<std::int32_t>(std::lower_bound(begin, end, column) - indices.begin());
    }
};

inline Pattern make_pattern(std::vector<std::int32_t> equation, const std::vector<const Connectivity*>& parts,
                            bool symmetric) {
    const int nodes = static_cast<int>(equation.size()) / 3;
    std::vector<std::vector<std::int32_t>> neighbours(nodes);
    for (int node = 0; node < nodes; ++node) neighbours[node].push_back(node);
    for (const Connectivity* part : parts)
        for (int e = 0; e < part->size(); ++e)
            for (int a = 0; a < part->nodes; ++a) {
                auto& list = neighbours[(*part)[e][a]];
                list.insert(list.end(), (*part)[e], (*part)[e] + part->nodes);
            }
    Pattern pattern;
    pattern.symmetric = symmetric;
    const int rows = 1 + *std::max_element(equation.begin(), equation.end());
    std::vector<std::int32_t> dof_of(rows);
    for (int dof = 0; dof < 3 * nodes; ++dof)
        if (equation[dof] >= 0) dof_of[equation[dof]] = dof;
    for (auto& list : neighbours) {
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
    }
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

/// Where the entries of an element matrix go; -1 where a degree of freedom is prescribed. The local order is by direction:
/// i = direction * nodes + node. Symmetric: the upper triangle by rows; else the whole matrix by rows.
struct Scatter {
    bool symmetric = true;
    int size = 0;             // rows of an element matrix
    std::size_t entries = 0;  // of the pattern
    std::vector<std::int32_t> position;

    std::size_t stride() const { return static_cast<std::size_t>(symmetric ? size * (size + 1) / 2 : size * size); }

    /// Adds the matrix `K` of one element (symmetric patterns read its upper triangle).
    void add(int element, const double* K, double* values) const {
        const std::int32_t* p = position.data() + element * stride();
        for (int i = 0; i < size; ++i)
            for (int j = symmetric ? i : 0; j < size; ++j, ++p)
                if (*p >= 0) values[*p] += K[i * size + j];
    }
};

inline Scatter make_scatter(const Pattern& pattern, const Connectivity& part) {
    Scatter scatter;
    scatter.symmetric = pattern.symmetric;
    scatter.size = 3 * part.nodes;
    scatter.entries = pattern.indices.size();
    scatter.position.reserve(scatter.stride() * part.size());
    std::vector<int> row(scatter.size);
    for (int e = 0; e < part.size(); ++e) {
        for (int i = 0; i < scatter.size; ++i) row[i] = pattern.equation[3 * part[e][i % part.nodes] + i / part.nodes];
        for (int i = 0; i < scatter.size; ++i)
            for (int j = pattern.symmetric ? i : 0; j < scatter.size; ++j) {
                if (row[i] < 0 || row[j] < 0)
                    scatter.position.push_back(-1);
                else if (pattern.symmetric)
                    scatter.position.push_back(pattern.find(std::min(row[i], row[j]), std::max(row[i], row[j])));
                else
                    scatter.position.push_back(pattern.find(row[i], row[j]));
            }
    }
    return scatter;
}

/// Groups of elements that share no node: the elements of a colour are added in parallel, colour after colour, so that
/// every sum is formed in the same order with any number of threads.
inline std::vector<std::vector<std::int32_t>> make_colours(const Connectivity& part) {
    const int nodes = part.ids.empty() ? 0 : 1 + *std::max_element(part.ids.begin(), part.ids.end());
    std::vector<std::uint64_t> used(nodes, 0);  // bit c: the node has an element of colour c
    std::vector<std::vector<std::int32_t>> colours;
    for (int e = 0; e < part.size(); ++e) {
        std::uint64_t taken = 0;
        for (int a = 0; a < part.nodes; ++a) taken |= used[part[e][a]];
        int colour = 0;
        while (colour < 63 && (taken >> colour & 1U) != 0) ++colour;
        if (colour == 63) throw std::invalid_argument("more than 62 elements share a node");
        for (int a = 0; a < part.nodes; ++a) used[part[e][a]] |= std::uint64_t{1} << colour;
        if (colour == static_cast<int>(colours.size())) colours.emplace_back();
        colours[colour].push_back(e);
    }
    return colours;
}

}  // namespace umform
