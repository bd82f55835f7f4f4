// Approximate minimum degree: the order of elimination of a graph that is not that of a sheet.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "umform/ordering/quotient.hpp"

namespace umform::ordering {

/// The vertex whose elimination couples the fewest equations comes next, by a bound on their number that is cheap to keep up
/// to date. (P. R. Amestoy, T. A. Davis & I. S. Duff, SIAM J. Matrix Anal. Appl. 17 (1996) 886-905)
///
/// An eliminated vertex becomes an element: the list of those that it has coupled. An element that lies within another one is
/// absorbed by it, vertices with the same neighbours are joined to one. Vertices with very many neighbours come last.
class MinimumDegree {
  public:
    MinimumDegree(const Graph& graph, std::vector<std::int32_t> weight)
        : size_(graph.size()), weight_(std::move(weight)), neighbours_(size_), elements_(size_), coupled_(size_),
          degree_(size_, 0), mark_(size_, 0), reach_(size_, 0), outside_(size_, 0), seen_(size_, 0), joined_(size_),
          next_(size_, kNone), before_(size_, kNone) {
        total_ = std::accumulate(weight_.begin(), weight_.end(), std::int64_t{0});
        first_.assign(total_ + 1, kNone);
        for (int v = 0; v < size_; ++v) {
            neighbours_[v].assign(graph.to.begin() + graph.start[v], graph.to.begin() + graph.start[v + 1]);
            for (const int w : neighbours_[v]) degree_[v] += weight_[w];
        }
    }

    /// The vertices in their order of elimination.
    std::vector<std::int32_t> run() {
        std::vector<std::int32_t> last = set_dense_apart();
        for (int v = 0; v < size_; ++v)
            if (weight_[v] > 0) insert(v);
        for (std::int64_t done = 0, all = left_; done < all;) done += eliminate(least());
        order_.insert(order_.end(), last.begin(), last.end());
        return std::move(order_);
    }

  private:
    static constexpr std::int32_t kNone = -1;
    int size_;
    std::vector<std::int32_t> weight_;  // equations; 0 of a vertex that is no variable any more
    std::vector<std::vector<std::int32_t>> neighbours_, elements_, coupled_;
    std::vector<std::int32_t> degree_, mark_;
    std::vector<std::int32_t> reach_, outside_,
        seen_;  // of an element: equations that it has coupled; those beyond the new one
    std::vector<std::vector<std::int32_t>> joined_;    // vertices that go with one
    std::vector<std::int32_t> first_, next_, before_;  // lists of the vertices of each degree
    std::vector<std::int32_t> order_, todo_;
    std::vector<std::pair<std::uint64_t, std::int32_t>> keys_;
    std::int64_t total_ = 0, left_ = 0;
    int stamp_ = 0, least_ = 0;

    /// Vertices with more neighbours than this many times the root of all would cost more to keep than they are worth.
    std::vector<std::int32_t> set_dense_apart() {
        const double dense = std::max(16.0, 10.0 * std::sqrt(static_cast<double>(total_)));
        std::vector<std::int32_t> last;
        for (int v = 0; v < size_; ++v)
            if (degree_[v] > dense) last.push_back(v);
        for (const int v : last) weight_[v] = 0;
        for (int v = 0; v < size_; ++v) left_ += weight_[v];
        if (!last.empty())
            for (int v = 0; v < size_; ++v) {
                std::erase_if(neighbours_[v], [&](int w) { return weight_[w] == 0; });
                degree_[v] = 0;
                for (const int w : neighbours_[v]) degree_[v] += weight_[w];
            }
        return last;
    }

    void insert(int v) {
        const int degree = degree_[v];
        next_[v] = first_[degree], before_[v] = kNone;
        if (next_[v] != kNone) before_[next_[v]] = v;
        first_[degree] = v;
        least_ = std::min(least_, degree);
    }

    void remove(int v) {
        if (before_[v] != kNone)
            next_[before_[v]] = next_[v];
        else
            first_[degree_[v]] = next_[v];
        if (next_[v] != kNone) before_[next_[v]] = before_[v];
    }

    int least() {
        while (first_[least_] == kNone) ++least_;
        return first_[least_];
    }

    /// A vertex and all that have been joined with it.
    void put(int v) {
        todo_.assign(1, v);
        while (!todo_.empty()) {
            const int w = todo_.back();
            todo_.pop_back();
            order_.push_back(w);
            todo_.insert(todo_.end(), joined_[w].begin(), joined_[w].end());
        }
    }

    /// Eliminates a vertex and those whose only neighbour is its element; returns the number of their equations.
    int eliminate(int pivot) {
        remove(pivot);
        put(pivot);
        int done = std::exchange(weight_[pivot], 0);
        std::vector<std::int32_t>& couples = couple(pivot);
        std::int64_t sum = 0;
        for (const int v : couples) remove(v), sum += weight_[v];
        left_ -= done;
        count_outside(couples);
        keys_.clear();
        for (const int v : couples) {
            const std::int64_t beside = sum - weight_[v];
            const auto [degree, key] = renew(v, pivot);
            if (neighbours_[v].empty() && elements_[v].size() == 1) {
                put(v);
                done += weight_[v], left_ -= weight_[v], sum -= weight_[v];
                weight_[v] = 0;
                continue;
            }
            degree_[v] =
                static_cast<std::int32_t>(std::min({left_ - weight_[v], degree_[v] + beside, beside + degree}));
            keys_.emplace_back(key, v);
        }
        join();
        std::erase_if(couples, [&](int v) { return weight_[v] == 0; });
        for (const int v : couples) insert(v);
        reach_[pivot] = static_cast<std::int32_t>(sum);
        return done;
    }

    /// Vertices that the elimination of one couples; elements that they were in are absorbed.
    std::vector<std::int32_t>& couple(int pivot) {
        std::vector<std::int32_t>& couples = coupled_[pivot];
        couples.clear();
        ++stamp_;
        const auto add = [&](int v) {
            if (weight_[v] > 0 && mark_[v] != stamp_) mark_[v] = stamp_, couples.push_back(v);
        };
        for (const int v : neighbours_[pivot]) add(v);
        for (const int e : elements_[pivot]) {
            for (const int v : coupled_[e]) add(v);
            std::vector<std::int32_t>().swap(coupled_[e]);
        }
        std::vector<std::int32_t>().swap(neighbours_[pivot]);
        elements_[pivot].clear();
        return couples;
    }

    /// For each element that shares a vertex with the new one: equations that it has beyond.
    void count_outside(const std::vector<std::int32_t>& couples) {
        for (const int v : couples)
            for (const int e : elements_[v]) {
                if (coupled_[e].empty()) continue;
                if (seen_[e] != stamp_) seen_[e] = stamp_, outside_[e] = reach_[e];
                outside_[e] -= weight_[v];
            }
    }

    /// Brings the lists of a vertex up to date; returns how many equations it is coupled with beyond the new element, and a
    /// number for its lists.
    std::pair<std::int64_t, std::uint64_t> renew(int v, int pivot) {
        std::int64_t degree = 0;
        std::uint64_t key = 0;
        std::erase_if(elements_[v], [&](int e) {
            if (coupled_[e].empty() || outside_[e] == 0) return true;
            degree += outside_[e], key += detail::mixed(e);
            return false;
        });
        elements_[v].push_back(pivot);
        std::erase_if(neighbours_[v], [&](int w) {
            if (weight_[w] == 0 || mark_[w] == stamp_) return true;
            degree += weight_[w], key += detail::mixed(w);
            return false;
        });
        return {degree, key};
    }

    /// Joins vertices with the same lists.
    void join() {
        std::sort(keys_.begin(), keys_.end());
        for (std::size_t k = 0; k < keys_.size(); ++k) {
            const int v = keys_[k].second;
            if (weight_[v] == 0) continue;
            bool sorted = false;
            for (std::size_t l = k + 1; l < keys_.size() && keys_[l].first == keys_[k].first; ++l) {
                const int w = keys_[l].second;
                if (weight_[w] == 0 || elements_[w].size() != elements_[v].size()
                    || neighbours_[w].size() != neighbours_[v].size())
                    continue;
                if (!std::exchange(sorted, true)) sort_lists(v);
                sort_lists(w);
                if (elements_[w] != elements_[v] || neighbours_[w] != neighbours_[v]) continue;
                degree_[v] -= weight_[w];
                weight_[v] += std::exchange(weight_[w], 0);
                joined_[v].push_back(w);
                std::vector<std::int32_t>().swap(neighbours_[w]);
                elements_[w].clear();
            }
        }
    }

    void sort_lists(int v) {
        std::sort(elements_[v].begin(), elements_[v].end());
        std::sort(neighbours_[v].begin(), neighbours_[v].end());
    }
};

}  // namespace umform::ordering
