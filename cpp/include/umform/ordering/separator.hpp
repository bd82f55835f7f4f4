// The fewest vertices that part two sides of a graph: maximal flow through vertices of capacity one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

namespace umform::ordering {

/// Vertices between two sides. A path from side to side takes each vertex once; the most paths that share no vertex are as
/// many as the fewest vertices that part the sides (Menger). They are found by searches in depth, many in one pass over the
/// graph (A. Pothen & C.-J. Fan, ACM Trans. Math. Softw. 16 (1990) 303-324), which go to the last side by the shortest way.
///
/// Each vertex v is split into its entry 2 v and its exit 2 v + 1. A vertex on a path may be entered again only to send
/// the path that is there another way: from its entry back to the exit of the vertex before it. The separators nearest to the
/// sides do not depend on the paths that were found.
class Between {
  public:
    std::vector<std::int32_t> start{0}, to;       // neighbours among the vertices between the sides
    std::vector<std::uint8_t> at_first, at_last;  // vertices with a neighbour on the first side, on the last one

    void clear() {
        start.assign(1, 0);
        to.clear(), at_first.clear(), at_last.clear();
    }

    int size() const { return static_cast<int>(start.size()) - 1; }

    /// Finds the paths. Afterwards `side` has -1, 0 or 1 for vertices of the first side, of the separator and of the last
    /// side. Of the two separators nearest to the sides the one that leaves them more equal is taken.
    ///
    /// `surplus` is how many vertices more than the last side the first one has without those between. Returns the number of
    /// vertices of the separator; from `limit` on it is only known to be so large or larger, and `side` is not set.
    int part(int surplus, int limit, std::vector<std::int8_t>& side) {
        const int n = size();
        before_.assign(n, kNone), after_.assign(n, kNone), used_.assign(n, 0);
        count_steps();
        int fewest = 0;
        for (int more = 1; more > 0; fewest += more) {
            if (fewest >= limit) return fewest;
            more = paths();
        }
        std::vector<std::int8_t> near_last(n);
        side.resize(n);
        reach_last();
        int here = surplus, there = surplus;
        for (int v = 0; v < n; ++v) {
            side[v] = reached_[2 * v] == 0 ? 1 : reached_[2 * v + 1] == 0 ? 0 : -1;
            near_last[v] = back_[2 * v + 1] == 0 ? -1 : back_[2 * v] == 0 ? 0 : 1;
            here -= side[v], there -= near_last[v];
        }
        if (std::abs(there) < std::abs(here)) side = std::move(near_last);
        return fewest;
    }

  private:
    static constexpr std::int32_t kNone = -1, kLast = -2, kFar = std::numeric_limits<std::int32_t>::max();
    std::vector<std::int32_t> before_, after_;  // of each vertex on a path its neighbours there, or none: a side
    std::vector<std::uint8_t> used_;            // is it on a path?
    bool forward_ = false;                      // direction in which neighbours are tried
    std::vector<std::int32_t> left_;            // of each vertex its steps to the last side
    std::vector<std::int32_t> arc_, queue_, way_;
    std::vector<std::uint8_t> reached_, back_;  // from the first side, to the last side

    /// Steps from each vertex to the last side while there is no path, `kFar` where there is no way.
    void count_steps() {
        left_.assign(size(), kFar);
        queue_.clear();
        for (int v = 0; v < size(); ++v)
            if (at_last[v]) left_[v] = 0, queue_.push_back(v);
        for (std::size_t k = 0; k < queue_.size(); ++k) {
            const int v = queue_[k];
            for (int j = start[v]; j < start[v + 1]; ++j)
                if (left_[to[j]] == kFar) left_[to[j]] = left_[v] + 1, queue_.push_back(to[j]);
        }
    }

    /// Takes paths that share no state, until there are no more; their number. If there is none, `reached_` has all that can be
    /// reached from the first side.
    int paths() {
        reached_.assign(2 * size(), 0), arc_.assign(2 * size(), 0);
        forward_ = !forward_;  // so that passes do not repeat each other
        int number = 0;
        for (int v = 0; v < size(); ++v) {
            if (!at_first[v] || reached_[2 * v]) continue;
            way_.assign(1, 2 * v);
            reached_[2 * v] = 1;
            while (!way_.empty()) {
                const int next = follow(way_.back());
                if (next == kLast) {
                    take();
                    ++number;
                    break;
                }
                if (next == kNone) {
                    way_.pop_back();
                } else {
                    reached_[next] = 1;
                    way_.push_back(next);
                }
            }
        }
        return number;
    }

    /// A state that follows one and has not been reached: vertices nearer to the last side come first.
    int follow(int state) {
        const int v = state / 2;
        std::int32_t& arc = arc_[state];
        if (state % 2 == 0) {
            if (arc++ > 0) return kNone;
            const int next = !used_[v] ? state + 1 : before_[v] != kNone ? 2 * before_[v] + 1 : kNone;
            return next != kNone && !reached_[next] ? next : kNone;
        }
        if (at_last[v]) return kLast;
        const int degree = start[v + 1] - start[v];
        const int begin = forward_ ? start[v] : start[v + 1] - 1, step = forward_ ? 1 : -1;
        while (arc < 2 * degree) {
            const bool nearer = arc < degree;
            const int next = to[begin + step * (arc - (nearer ? 0 : degree))];
            ++arc;
            if ((left_[next] < left_[v]) == nearer && !reached_[2 * next]) return 2 * next;
        }
        return arc++ == 2 * degree && used_[v] && !reached_[2 * v] ? 2 * v : kNone;
    }

    /// Adds the path `way_` to those that are there.
    void take() {
        before_[way_.front() / 2] = kNone;
        for (std::size_t k = 0; k + 1 < way_.size(); ++k) {
            const int a = way_[k] / 2, b = way_[k + 1] / 2;
            const bool leaves = way_[k] % 2 == 1;
            if (a == b)
                used_[a] = !leaves;
            else if (leaves)
                after_[a] = b, before_[b] = a;
        }
        after_[way_.back() / 2] = kNone;
    }

    /// Marks the states from which the last side can be reached.
    void reach_last() {
        back_.assign(2 * size(), 0);
        queue_.clear();
        const auto mark = [&](int state) {
            if (!back_[state]) back_[state] = 1, queue_.push_back(state);
        };
        for (int v = 0; v < size(); ++v)
            if (at_last[v]) mark(2 * v + 1);
        for (std::size_t k = 0; k < queue_.size(); ++k) {
            const int state = queue_[k], v = state / 2;
            if (state % 2 == 0) {
                if (used_[v]) mark(state + 1);
                for (int j = start[v]; j < start[v + 1]; ++j) mark(2 * to[j] + 1);
            } else if (!used_[v]) {
                mark(2 * v);
            } else if (after_[v] != kNone) {
                mark(2 * after_[v]);
            }
        }
    }
};

}  // namespace umform::ordering
