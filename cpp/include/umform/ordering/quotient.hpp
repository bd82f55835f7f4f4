// Equations with the same neighbours as one vertex: the graph that is ordered in place of the matrix.
#pragma once

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace umform::ordering {

/// Undirected graph without loops; the neighbours of vertex v are to[start[v]] ... to[start[v + 1] - 1].
struct Graph {
    std::vector<std::int32_t> start{0};
    std::vector<std::int32_t> to;
    int size() const { return static_cast<int>(start.size()) - 1; }
};

/// Equations whose rows have entries in the same columns are indistinguishable: no order of elimination gains by parting
/// them. In a sheet these are the directions of a node, or of the nodes of a fibre. (A. George & J. W. H. Liu, Computer
/// Solution of Large Sparse Positive Definite Systems, Prentice-Hall 1981, ch. 5)
struct Quotient {
    Graph graph;
    std::vector<std::int32_t> group;  // [equation] -> vertex; vertices are numbered by their first equation
};

namespace detail {

/// Mixes the bits of a number, as the generator SplitMix64 does (G. L. Steele, D. Lea & C. H. Flood, OOPSLA 2014).
inline std::uint64_t mixed(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15U;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31);
}

/// A number for the set of columns of each row. Two of n sets have the same number by chance once in 2^65 / n^2 matrices: the
/// order is poorer then, and blocks refuse their entries.
inline std::vector<std::uint64_t> row_keys(const std::int32_t* indptr, const std::int32_t* indices, int n) {
    std::vector<std::uint64_t> key(n), mix(n);
    for (int row = 0; row < n; ++row) key[row] = mix[row] = mixed(row);  // the diagonal
    for (int row = 0; row < n; ++row) {
        const std::uint64_t mine = mix[row];
        std::uint64_t sum = 0;
        for (int k = indptr[row]; k < indptr[row + 1]; ++k) {
            const int column = indices[k];
            if (column == row) continue;
            sum += mix[column], key[column] += mine;
        }
        key[row] += sum;
    }
    return key;
}

/// Number of the set of columns of each row, counted in the order in which they are met.
inline std::vector<std::int32_t> equal_rows(const std::int32_t* indptr, const std::int32_t* indices, int n) {
    const std::vector<std::uint64_t> key = row_keys(indptr, indices, n);
    std::vector<std::int32_t> set(n);
    std::unordered_map<std::uint64_t, std::int32_t> known;
    known.reserve(n / 4);
    for (int row = 0; row < n; ++row) {
        if (row > 0 && key[row] == key[row - 1])
            set[row] = set[row - 1];
        else
            set[row] = known.try_emplace(key[row], static_cast<std::int32_t>(known.size())).first->second;
    }
    return set;
}

/// Splits sets of equations that are larger than those that most equations are in, and returns the first equation of each
/// group. At the edges of a mesh of quadratic cells the nodes of two fibres have the same neighbours, at its corners four.
inline std::vector<std::int32_t> split(std::vector<std::int32_t>& group) {
    const int sets = group.empty() ? 0 : 1 + *std::max_element(group.begin(), group.end());
    std::vector<std::int32_t> members(sets, 0), filled(sets, 0), present(sets, -1), first;
    for (const int set : group) ++members[set];
    std::vector<std::int32_t> frequency(1, 0);
    for (const int size : members) {
        if (size >= static_cast<int>(frequency.size())) frequency.resize(size + 1, 0);
        frequency[size] += size;
    }
    const auto usual = std::max_element(frequency.begin(), frequency.end()) - frequency.begin();
    for (std::size_t row = 0; row < group.size(); ++row) {
        const int set = group[row];
        if (filled[set]++ % usual == 0) {
            present[set] = static_cast<std::int32_t>(first.size());
            first.push_back(static_cast<std::int32_t>(row));
        }
        group[row] = present[set];
    }
    return first;
}

}  // namespace detail

/// Quotient graph of a symmetric pattern whose upper triangle with the diagonal is stored by rows.
inline Quotient make_quotient(const std::int32_t* indptr, const std::int32_t* indices, int n) {
    Quotient quotient;
    quotient.group = detail::equal_rows(indptr, indices, n);
    const std::vector<std::int32_t> first = detail::split(quotient.group);
    // Of two groups the first equations stand for all: their entry is stored in the row of the smaller one.
    const int size = static_cast<int>(first.size());
    std::vector<std::int32_t>& start = quotient.graph.start;
    start.assign(size + 1, 0);
    const auto each_edge = [&](const auto& visit) {
        for (int a = 0; a < size; ++a)
            for (int k = indptr[first[a]]; k < indptr[first[a] + 1]; ++k) {
                const int b = quotient.group[indices[k]];
                if (b != a && first[b] == indices[k]) visit(a, b);
            }
    };
    each_edge([&](int a, int b) { ++start[a + 1], ++start[b + 1]; });
    for (int a = 0; a < size; ++a) start[a + 1] += start[a];
    quotient.graph.to.resize(start[size]);
    std::vector<std::int32_t> next(start.begin(), start.end() - 1);
    each_edge([&](int a, int b) { quotient.graph.to[next[a]++] = b, quotient.graph.to[next[b]++] = a; });
    return quotient;
}

}  // namespace umform::ordering
