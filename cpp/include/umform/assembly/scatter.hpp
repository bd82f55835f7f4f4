// The map from element matrices into a sparse pattern.
#pragma once

#include "umform/assembly/pattern.hpp"

namespace umform {

/// Where the entries of an element matrix go; -1 where a degree of freedom is prescribed. The local order is by direction:
/// i = direction * nodes + node. Symmetric: the upper triangle by rows; else the whole matrix by rows.
struct Scatter {
    bool symmetric = true;
    int size = 0;             // rows of an element matrix
    std::size_t entries = 0;  // of the pattern
    std::vector<std::int32_t> position;

    std::size_t stride() const { return static_cast<std::size_t>(symmetric ? size * (size + 1) / 2 : size * size); }
    int elements() const { return size == 0 ? 0 : static_cast<int>(position.size() / stride()); }

    /// Adds the matrix `K` of one element (symmetric patterns read its upper triangle).
    void add(int element, const double* K, double* values) const {
        const std::int32_t* p = position.data() + element * stride();
        for (int i = 0; i < size; ++i)
            for (int j = symmetric ? i : 0; j < size; ++j, ++p)
                if (*p >= 0) values[*p] += K[i * size + j];
    }

    /// Throws std::invalid_argument, with the name of the term, if a tangent that is not symmetric would lose a triangle here.
    void require(bool symmetric_tangent, const std::string& term) const {
        if (symmetric && !symmetric_tangent)
            throw std::invalid_argument("the tangent of " + term
                                        + " is not symmetric: its matrix needs a pattern of both triangles");
    }
};

/// The map for the elements of `part`. Throws std::out_of_range if the pattern was made without their couplings.
inline Scatter make_scatter(const Pattern& pattern, const Connectivity& part) {
    check_nodes(part, pattern.nodes());
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

}  // namespace umform
