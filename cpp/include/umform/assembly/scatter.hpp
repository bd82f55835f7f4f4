// The map from element matrices into a sparse pattern.
#pragma once

#include "umform/assembly/pattern.hpp"

namespace umform {

/// Where the entries of an element matrix go. The local order is by direction: i = direction * nodes + node. Symmetric: the
/// upper triangle by rows; else the whole matrix by rows.
///
/// The rows of a node whose directions are all free follow each other, with the columns of its neighbours in threes. So the
/// place of one entry of two nodes and the length of a row give those of all nine: a ninth of the memory.
struct Scatter {
    bool symmetric = true;
    int size = 0;                        // rows of an element matrix
    std::size_t entries = 0;             // of the pattern
    std::vector<std::int64_t> start{0};  // [element] -> its part of `position`
    /// Length of the first row of each node, then the place of the first entry of each pair of nodes, ~ of it if the row is that
    /// of the second one. Of elements with prescribed degrees of freedom the places of all entries, -1 where one is prescribed.
    std::vector<std::int32_t> position;

    int nodes() const { return size / 3; }
    int elements() const { return static_cast<int>(start.size()) - 1; }
    std::size_t bytes() const { return position.size() * sizeof(position[0]) + start.size() * sizeof(start[0]); }
    /// Numbers of an element all of whose degrees of freedom are free.
    int by_nodes() const {
        const int n = nodes();
        return n + (symmetric ? n * (n + 1) / 2 : n * n);
    }

    /// Adds the matrix `K` of one element (symmetric patterns read its upper triangle).
    void add(int element, const double* K, double* values) const {
        const std::int32_t* p = position.data() + start[element];
        if (start[element + 1] - start[element] == by_nodes()) {
            symmetric ? add_triangle(p, K, values) : add_whole(p, K, values);
            return;
        }
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

  private:
    /// Rows of a node become shorter by its own equations.
    void add_triangle(const std::int32_t* p, const double* K, double* values) const {
        const int n = nodes(), down = n * size;  // to the next direction of rows
        const std::int32_t *length = p, *place = p + n;
        for (int a = 0; a < n; ++a)
            for (int b = a; b < n; ++b, ++place) {
                const bool turned = *place < 0;
                const int r = turned ? b : a, c = turned ? a : b;  // nodes of rows and of columns
                const double *above = K + r * size + c, *below = K + c * size + r, *same = turned ? below : above;
                double *first = values + (turned ? ~*place : *place), *second = first + length[r] - 1,
                       *third = second + length[r] - 2;
                first[0] += same[0], first[1] += above[n], first[2] += above[2 * n];
                second[1] += same[down + n], second[2] += above[down + 2 * n], third[2] += same[2 * (down + n)];
                if (a != b) second[0] += below[n], third[0] += below[2 * n], third[1] += below[down + 2 * n];
            }
    }

    void add_whole(const std::int32_t* p, const double* K, double* values) const {
        const int n = nodes();
        const std::int32_t *length = p, *place = p + n;
        for (int a = 0; a < n; ++a)
            for (int b = 0; b < n; ++b, ++place)
                for (int k = 0; k < 3; ++k) {
                    double* row = values + *place + static_cast<std::ptrdiff_t>(k) * length[a];
                    for (int l = 0; l < 3; ++l) row[l] += K[(k * n + a) * size + l * n + b];
                }
    }
};

namespace detail {

/// Adds the places of an element to a map if its nodes are different and their directions free.
inline bool place_nodes(const Pattern& pattern, const std::int32_t* ids, Scatter& scatter) {
    const int nodes = scatter.nodes();
    const std::int32_t* equation = pattern.equation.data();
    for (int a = 0; a < nodes; ++a) {
        const std::int32_t* e = equation + 3 * static_cast<std::ptrdiff_t>(ids[a]);
        if (e[0] < 0 || e[1] != e[0] + 1 || e[2] != e[0] + 2) return false;
        for (int b = 0; b < a; ++b)
            if (ids[a] == ids[b]) return false;
    }
    const auto first = [&](int a) { return equation[3 * static_cast<std::ptrdiff_t>(ids[a])]; };
    for (int a = 0; a < nodes; ++a)
        scatter.position.push_back(static_cast<std::int32_t>(pattern.indptr[first(a) + 1] - pattern.indptr[first(a)]));
    for (int a = 0; a < nodes; ++a)
        for (int b = scatter.symmetric ? a : 0; b < nodes; ++b) {
            const bool turned = scatter.symmetric && first(b) < first(a);
            const std::int32_t place = turned ? pattern.find(first(b), first(a)) : pattern.find(first(a), first(b));
            scatter.position.push_back(turned ? ~place : place);
        }
    return true;
}

/// Adds the places of all entries of an element to a map.
inline void place_entries(const Pattern& pattern, const std::int32_t* ids, Scatter& scatter) {
    const int nodes = scatter.nodes();
    const auto row = [&](int i) {
        return pattern.equation[3 * static_cast<std::ptrdiff_t>(ids[i % nodes]) + i / nodes];
    };
    for (int i = 0; i < scatter.size; ++i)
        for (int j = pattern.symmetric ? i : 0; j < scatter.size; ++j) {
            if (row(i) < 0 || row(j) < 0)
                scatter.position.push_back(-1);
            else if (pattern.symmetric)
                scatter.position.push_back(pattern.find(std::min(row(i), row(j)), std::max(row(i), row(j))));
            else
                scatter.position.push_back(pattern.find(row(i), row(j)));
        }
}

}  // namespace detail

/// The map for the elements of `part`. Throws std::out_of_range if the pattern was made without their couplings.
inline Scatter make_scatter(const Pattern& pattern, const Connectivity& part) {
    check_nodes(part, pattern.nodes());
    Scatter scatter;
    scatter.symmetric = pattern.symmetric;
    scatter.size = 3 * part.nodes;
    scatter.entries = pattern.indices.size();
    scatter.start.reserve(part.size() + 1);
    scatter.position.reserve(static_cast<std::size_t>(scatter.by_nodes()) * part.size());
    for (int e = 0; e < part.size(); ++e) {
        if (!detail::place_nodes(pattern, part[e], scatter)) detail::place_entries(pattern, part[e], scatter);
        scatter.start.push_back(static_cast<std::int64_t>(scatter.position.size()));
    }
    scatter.position.shrink_to_fit();
    return scatter;
}

}  // namespace umform
