// The way of the entries of a matrix into the fronts.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "structure.hpp"

namespace umform {

/// Entries that follow each other in the matrix and in a front: the directions of a fibre have neighbouring columns. A run has
/// 9 bytes, so that sheets take 3 bytes an entry.
class EntryRuns {
  public:
    /// Of a row of the matrix, from entry `source` on; `target` is the place of the first in the columns of the front.
    struct Run {
        std::int32_t source, target;
    };

    EntryRuns() = default;
    /// `place` of each equation; for each place the front that it is eliminated in.
    EntryRuns(const Rows& matrix, const std::vector<std::int32_t>& place, const std::vector<std::int32_t>& owner,
              std::size_t fronts)
        : start_(fronts + 1, 0) {
        walk(matrix, place, owner, [&](int f, int, int, int) { ++start_[f + 1]; });
        for (std::size_t f = 0; f < fronts; ++f) start_[f + 1] += start_[f];
        runs_.resize(start_[fronts]), length_.resize(start_[fronts]);
        std::vector<std::int64_t> next(start_.begin(), start_.end() - 1);
        walk(matrix, place, owner, [&](int f, int row, int source, int length) {
            const std::int64_t here = next[f]++;
            runs_[here] = {source, row}, length_[here] = static_cast<std::uint8_t>(length);
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

    /// Calls take(source, target) for each entry of a front; neighbours in a row of the front are `stride` apart.
    template <class Take>
    void for_each(int f, int stride, const Take& take) const {
        for (std::int64_t r = start_[f]; r < start_[f + 1]; ++r) {
            const int length = length_[r] & ~kAcross, step = (length_[r] & kAcross) != 0 ? stride : 1;
            for (int k = 0; k < length; ++k) take(runs_[r].source + k, runs_[r].target + k * step);
        }
    }

  private:
    static constexpr int kAcross = 128, kLongest = 127;
    std::vector<std::int64_t> start_;  // [front] -> run
    std::vector<Run> runs_;
    std::vector<std::uint8_t> length_;

    /// Calls take(front, row, entry, length) for runs of neighbouring places on the same side of the diagonal and of the pivots.
    template <class Take>
    static void walk(const Rows& matrix, const std::vector<std::int32_t>& place, const std::vector<std::int32_t>& owner,
                     const Take& take) {
        for (int i = 0; i < matrix.n; ++i) {
            const int mine = place[i], end = matrix.indptr[i + 1];
            for (int k = matrix.indptr[i]; k < end;) {
                const int there = place[matrix.indices[k]];
                int length = 1;
                while (k + length < end && length < kLongest) {
                    const int next = place[matrix.indices[k + length]];
                    if (next != there + length || next == mine || owner[next] != owner[there]) break;
                    ++length;
                }
                take(owner[std::min(mine, there)], i, k, length);
                k += length;
            }
        }
    }
};

}  // namespace umform
