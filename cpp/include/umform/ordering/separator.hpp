// The fewest vertices that part two sides of a graph: maximal flow through vertices of capacity one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

namespace umform {

/// Vertices between two sides. A path from side to side takes each vertex once; the most paths that share no vertex are as
/// many as the fewest vertices that part the sides (Menger). Paths are found by Dinic's algorithm (Soviet Math. Dokl. 11
/// (1970) 1277-1280): shortest ones first, many in one pass.
///
/// Each vertex v is split into its entry 2 v and its exit 2 v + 1. A vertex on a path may be entered again only to send
/// the path that is there another way: from its entry back to the exit of the vertex before it.
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
    /// `surplus` is how many vertices more than the last side the first one has without those between.
    void part(int surplus, std::vector<std::int8_t>& side) {
        const int n = size();
        before_.assign(n, kNone), after_.assign(n, kNone), used_.assign(n, 0);
        while (layers()) paths();
        // From the first side: entry reached and exit not. `layer_` is that of the last, vain search.
        std::vector<std::int8_t> near_last(n);
        side.resize(n);
        reach_last();
        int here = surplus, there = surplus;
        for (int v = 0; v < n; ++v) {
            side[v] = layer_[2 * v] < 0 ? 1 : layer_[2 * v + 1] < 0 ? 0 : -1;
            near_last[v] = back_[2 * v + 1] == 0 ? -1 : back_[2 * v] == 0 ? 0 : 1;
            here -= side[v], there -= near_last[v];
        }
        if (std::abs(there) < std::abs(here)) side = std::move(near_last);
    }

  private:
    static constexpr std::int32_t kNone = -1;
    std::vector<std::int32_t> before_, after_;  // of each vertex on a path its neighbours there, or none: a side
    std::vector<std::uint8_t> used_;            // is it on a path?
    std::vector<std::int32_t> layer_, arc_, queue_, way_;
    std::vector<std::uint8_t> back_;

    /// Visits the states that follow one, until `visit` returns true; -1 is the last side. Begins at `arc`.
    template <class Visit>
    bool follow(int state, std::int32_t& arc, const Visit& visit) const {
        const int v = state / 2;
        if (state % 2 == 0) {
            if (arc++ > 0) return false;
            if (!used_[v]) return visit(state + 1);
            return before_[v] != kNone && visit(2 * before_[v] + 1);
        }
        for (const int degree = start[v + 1] - start[v]; arc < degree + 2;) {
            const int k = arc++;
            if (k == 0) {
                if (at_last[v] && visit(-1)) return true;
            } else if (k == 1) {
                if (used_[v] && visit(2 * v)) return true;
            } else if (visit(2 * to[start[v] + k - 2])) {
                return true;
            }
        }
        return false;
    }

    /// Steps from the first side to each state; is the last side reached?
    bool layers() {
        layer_.assign(2 * size(), -1);
        queue_.clear();
        for (int v = 0; v < size(); ++v)
            if (at_first[v]) layer_[2 * v] = 0, queue_.push_back(2 * v);
        bool reached = false;
        for (std::size_t k = 0; k < queue_.size(); ++k) {
            const int state = queue_[k];
            std::int32_t arc = 0;
            follow(state, arc, [&](int next) {
                if (next < 0)
                    reached = true;
                else if (layer_[next] < 0)
                    layer_[next] = layer_[state] + 1, queue_.push_back(next);
                return false;
            });
        }
        return reached;
    }

    /// Takes paths that go up one layer with each step until there are no more.
    void paths() {
        arc_.assign(2 * size(), 0);
        for (int v = 0; v < size(); ++v) {
            if (!at_first[v] || layer_[2 * v] != 0) continue;
            way_.assign(1, 2 * v);
            while (!way_.empty()) {
                const int state = way_.back();
                int next = -2;
                follow(state, arc_[state], [&](int candidate) {
                    if (candidate >= 0 && layer_[candidate] != layer_[state] + 1) return false;
                    next = candidate;
                    return true;
                });
                if (next == -1) {
                    take();
                    break;
                }
                if (next == -2) {
                    layer_[state] = -1;  // leads nowhere
                    way_.pop_back();
                } else {
                    way_.push_back(next);
                }
            }
        }
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
        for (const int state : way_) layer_[state] = -1;  // each state on one path of a pass
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

}  // namespace umform
