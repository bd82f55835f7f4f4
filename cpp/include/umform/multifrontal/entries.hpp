// The way of the entries of a matrix into the fronts.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "umform/multifrontal/structure.hpp"

namespace umform::multifrontal {

/// Entries that follow each other in the matrix and in a front, of one row or of the three of a node, which have the same
/// columns. A run has 10 bytes, so that sheets take little more than one byte an entry.
class EntryRuns {
  public:
    /// Of a row of the matrix, from entry `source` on; `target` is the place of the first in the columns of the front.
    struct Run {
        std::int32_t source, target;
    };

    EntryRuns() = default;
    /// `place` of each equation; for each place the front that it is eliminated in.
    EntryRuns(const Rows& matrix, bool symmetric, const std::vector<std::int32_t>& place,
              const std::vector<std::int32_t>& owner, std::size_t fronts)
        : shorter_(symmetric ? 1 : 0), start_(fronts + 1, 0) {
        walk(matrix, place, owner, [&](int f, int, int, int, int) { ++start_[f + 1]; });
        for (std::size_t f = 0; f < fronts; ++f) start_[f + 1] += start_[f];
        runs_.resize(start_[fronts]), length_.resize(start_[fronts]), row_length_.resize(start_[fronts]);
        std::vector<std::int64_t> next(start_.begin(), start_.end() - 1);
        walk(matrix, place, owner, [&](int f, int row, int source, int length, int row_length) {
            const std::int64_t here = next[f]++;
            runs_[here] = {source, row}, length_[here] = static_cast<std::uint8_t>(length);
            row_length_[here] = static_cast<std::uint8_t>(row_length);
        });
    }

    /// Calls locate(row, entry, down) -> target for the runs of a front, where `down` takes whether the targets are a row of the
    /// front, one below the other in no column. To be called once for each front.
    template <class Locate>
    void locate(int f, const Locate& target_of) {
        for (std::int64_t r = start_[f]; r < start_[f + 1]; ++r) {
            bool across = false;
            runs_[r].target = target_of(runs_[r].target, runs_[r].source, across);
            if (across) length_[r] |= kAcross;
        }
    }

    /// Calls take(source, target) for each entry of a front of `size` rows, the first `pivots` of which are eliminated.
    template <class Take>
    void for_each(int f, int size, int pivots, const Take& take) const {
        for (std::int64_t r = start_[f]; r < start_[f + 1]; ++r) {
            const int length = length_[r] & ~kAcross;
            int source = runs_[r].source, target = runs_[r].target;
            const bool across = (length_[r] & kAcross) != 0;
            const int step = across ? size : 1, down = across ? 1 : target < pivots * size ? size : size - pivots;
            for (int k = 0; k < length; ++k) take(source + k, target + k * step);
            if (row_length_[r] == 0) continue;
            for (int row = 1; row < 3; ++row) {
                source += row_length_[r] - row * shorter_, target += down;
                for (int k = 0; k < length; ++k) take(source + k, target + k * step);
            }
        }
    }

  private:
    static constexpr int kAcross = 128, kLongest = 127, kRow = 255;  // longer rows are taken alone
    int shorter_ = 0;                  // entries by which the next row of a node is shorter
    std::vector<std::int64_t> start_;  // [front] -> run
    std::vector<Run> runs_;
    std::vector<std::uint8_t> length_;
    std::vector<std::uint8_t> row_length_;  // of the first of three rows, or 0 for a run of one row

    /// Calls take(front, row, entry, length, row length) for runs of neighbouring places on the same side of the diagonal and of
    /// the pivots.
    template <class Take>
    void walk(const Rows& matrix, const std::vector<std::int32_t>& place, const std::vector<std::int32_t>& owner,
              const Take& take) const {
        const auto part = [&](int i, int from, int end, int row_length) {
            const int mine = place[i];
            for (int k = from; k < end;) {
                const int there = place[matrix.indices[k]];
                int length = 1;
                while (k + length < end && length < kLongest) {
                    const int next = place[matrix.indices[k + length]];
                    if (next != there + length || next == mine || owner[next] != owner[there]) break;
                    ++length;
                }
                take(owner[std::min(mine, there)], i, k, length, row_length);
                k += length;
            }
        };
        for (int i = 0; i < matrix.n;) {
            const int begin = matrix.indptr[i], end = matrix.indptr[i + 1];
            const int own = three_rows(matrix, place, owner, i);  // columns before those of the node
            if (own < 0) {
                part(i++, begin, end, 0);
                continue;
            }
            part(i, begin, begin + own, end - begin);
            part(i, begin + own + 3, end, end - begin);
            for (int row = 0; row < 3; ++row, ++i) {
                const int first = matrix.indptr[i] + own;
                part(i, first, first + 3 - row * shorter_, 0);
            }
        }
    }

    /// Have the row and the next two the same columns, apart from those that are left out below the diagonal, and are they
    /// eliminated together? Then the number of columns before theirs, else -1.
    int three_rows(const Rows& matrix, const std::vector<std::int32_t>& place, const std::vector<std::int32_t>& owner,
                   int i) const {
        if (i + 3 > matrix.n) return -1;
        const int mine = place[i];
        const std::int32_t *begin = matrix.indices + matrix.indptr[i], *end = matrix.indices + matrix.indptr[i + 1];
        if (end - begin > kRow) return -1;
        const std::int32_t* own = std::lower_bound(begin, end, i);
        if (end - own < 3 || own[0] != i || own[1] != i + 1 || own[2] != i + 2) return -1;
        for (int row = 1; row < 3; ++row) {
            const std::int32_t* other = matrix.indices + matrix.indptr[i + row];
            if (place[i + row] != mine + row || owner[mine + row] != owner[mine]) return -1;
            if (!std::equal(begin + row * shorter_, end, other, matrix.indices + matrix.indptr[i + row + 1])) return -1;
        }
        return static_cast<int>(own - begin);
    }
};

}  // namespace umform::multifrontal
