// The pattern of a sparse matrix as the factorisation sees it: symmetric, for any values.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <vector>

namespace umform::multifrontal {

/// Rows of a pattern, compressed: the columns of row i are indices[indptr[i]] ... indices[indptr[i + 1] - 1], sorted.
struct Rows {
    const std::int32_t* indptr;
    const std::int32_t* indices;
    int n;
};

/// Entries of a pattern by columns, sorted by rows, and where each is stored.
struct Columns {
    std::vector<std::int32_t> start, row, entry;

    explicit Columns(const Rows& rows) : start(rows.n + 1, 0), row(rows.indptr[rows.n]), entry(rows.indptr[rows.n]) {
        for (int k = 0; k < rows.indptr[rows.n]; ++k) ++start[rows.indices[k] + 1];
        for (int j = 0; j < rows.n; ++j) start[j + 1] += start[j];
        std::vector<std::int32_t> next(start.begin(), start.end() - 1);
        for (int i = 0; i < rows.n; ++i)
            for (int k = rows.indptr[i]; k < rows.indptr[i + 1]; ++k) {
                const int here = next[rows.indices[k]]++;
                row[here] = i, entry[here] = k;
            }
    }
};

/// Upper triangle with the diagonal of the pattern of K + K^T.
struct UpperTriangle {
    std::vector<std::int32_t> indptr{0}, indices;

    UpperTriangle(const Rows& rows, const Columns& columns) {
        for (int i = 0; i < rows.n; ++i) {
            const auto* to = rows.indices + rows.indptr[i + 1];
            const auto* from = std::lower_bound(rows.indices + rows.indptr[i], to, i);
            const auto below = columns.row.begin() + columns.start[i + 1];
            const auto begin = std::lower_bound(columns.row.begin() + columns.start[i], below, i);
            std::set_union(from, to, begin, below, std::back_inserter(indices));
            indptr.push_back(static_cast<std::int32_t>(indices.size()));
        }
    }
};

}  // namespace umform::multifrontal
