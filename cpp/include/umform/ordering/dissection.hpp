// Nested dissection: a sparse graph is parted by few vertices, which are eliminated last, and so are its parts.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "umform/ordering/quotient.hpp"
#include "umform/ordering/separator.hpp"

namespace umform::ordering {

/// Order of elimination of the vertices of a graph by nested dissection (A. George, SIAM J. Numer. Anal. 10 (1973) 345-363).
///
/// A connected part is parted across its length: u and w are vertices far from each other, found by searches in breadth,
/// and vertices are sorted by d(u, .) - d(w, .), steps from u less steps from w. Those in the middle are looked through
/// for the fewest vertices that part the ends. Nothing is random: an order depends on the graph and its numbering alone.
class Dissection {
  public:
    explicit Dissection(const Graph& graph, bool solid = false)
        : solid_(solid), graph_(graph), order_(graph.size()), part_(graph.size(), 0), local_(graph.size(), 0),
          best_(graph.size(), 0) {
        for (auto& steps : steps_) steps.resize(graph.size());
        std::iota(order_.begin(), order_.end(), 0);
    }

    /// The vertices in their order of elimination; none if the graph is not that of a sheet, or of a solid if requested.
    std::vector<std::int32_t> run() {
        todo_.emplace_back(0, graph_.size());
        while (!todo_.empty()) {
            const auto [begin, end] = todo_.back();
            todo_.pop_back();
            if (end - begin <= kSmall || !connected(begin, end)) continue;
            find_separator(end - begin);
            if (end - begin >= kLarge && fewest_ > most(end - begin)) return {};
            if (fewest_ <= end - begin) place(begin);
        }
        return std::move(order_);
    }

  private:
    static constexpr int kSmall = 4;         // parts up to this size are not divided
    static constexpr double kMiddle = 0.35;  // share of the vertices among which the separator is sought
    static constexpr double kGood = 1.05;  // a separator is good enough at so many times the mean number at a distance
    static constexpr double kWide = 2.0;   // so many times what parts a square or a cube, and the graph is none
    static constexpr int kLarge = 1000;
    bool solid_;
    const Graph& graph_;
    std::vector<std::int32_t> order_, part_, local_, found_, sorted_, count_;
    std::vector<std::int32_t> members_;   // of the part that is being cut
    std::vector<std::int32_t> steps_[4];  // from far to far, and aside
    std::vector<std::pair<int, int>> todo_;
    std::vector<std::int8_t> side_, best_;
    Between between_;
    int parts_ = 0, fewest_ = 0;

    /// A square of m vertices is parted by sqrt(m) of them, a cube by m^(2/3).
    double most(int size) const {
        return kWide * (solid_ ? std::cbrt(static_cast<double>(size) * size) : std::sqrt(size));
    }

    /// Appends to `found_` what can be reached from a vertex within its part, with the steps it takes; the part is renamed.
    void search(int from, std::vector<std::int32_t>& steps) {
        const int part = part_[from], renamed = ++parts_;
        std::size_t k = found_.size();
        found_.push_back(from);
        part_[from] = renamed, steps[from] = 0;
        for (; k < found_.size(); ++k) {
            const int v = found_[k];
            for (int j = graph_.start[v]; j < graph_.start[v + 1]; ++j) {
                const int next = graph_.to[j];
                if (part_[next] != part) continue;
                part_[next] = renamed, steps[next] = steps[v] + 1;
                found_.push_back(next);
            }
        }
    }

    /// Is the part connected? If not, its pieces are put in its place, to be parted on their own.
    bool connected(int begin, int end) {
        const int part = part_[order_[begin]];
        found_.clear();
        std::vector<int> bounds{begin};
        for (int k = begin; k < end; ++k) {
            if (part_[order_[k]] != part) continue;
            search(order_[k], steps_[0]);
            bounds.push_back(begin + static_cast<int>(found_.size()));
        }
        if (bounds.size() == 2) return true;
        std::copy(found_.begin(), found_.end(), order_.begin() + begin);
        for (std::size_t k = 1; k < bounds.size(); ++k) todo_.emplace_back(bounds[k - 1], bounds[k]);
        return false;
    }

    /// Finds few vertices that part a connected part; `best_` has -1, 0 or 1 for a vertex of the first side, of the
    /// separator and of the last side. `found_` has the vertices, one far from another at the end.
    ///
    /// Steps count along a diagonal of a mesh as along an edge, so the sum of two such differences between opposite
    /// corners runs across a square where each of them alone runs along its diagonal.
    void find_separator(int size) {
        walk(found_.back(), 0);
        const int far = found_.front(), opposite = found_.back(), length = steps_[0][opposite];
        walk(opposite, 1);
        members_ = found_;
        fewest_ = size + 1;
        attempt([&](int v) { return steps_[0][v] - steps_[1][v]; });
        if (fewest_ * (length + 1) <= kGood * size) return;
        int aside = far;
        const auto nearer = [&](int v) { return std::min(steps_[0][v], steps_[1][v]); };
        for (const int v : members_)
            if (nearer(v) > nearer(aside)) aside = v;
        walk(aside, 2);
        walk(found_.back(), 3);
        for (const int sign : {1, -1})
            attempt([&](int v) { return steps_[0][v] - steps_[1][v] + sign * (steps_[2][v] - steps_[3][v]); });
    }

    /// Steps from a vertex to all others of its part; `found_` has them by their distance.
    void walk(int from, int k) {
        found_.clear();
        search(from, steps_[k]);
    }

    /// Looks for a separator among the vertices in the middle of an order by `key`; kept if it has the fewest so far.
    template <class Key>
    void attempt(const Key& key) {
        sort(key);
        const int size = static_cast<int>(sorted_.size());
        const int margin = static_cast<int>(0.5 * (1.0 - kMiddle) * size);
        const int first = ++parts_, middle = ++parts_, last = ++parts_;
        for (int k = 0; k < size; ++k) part_[sorted_[k]] = k < margin ? first : k < size - margin ? middle : last;
        // A vertex of the first side with a neighbour on the last one may be needed to part them.
        int firsts = margin;
        for (int k = 0; k < margin; ++k)
            if (touches(sorted_[k], last)) part_[sorted_[k]] = middle, --firsts;
        gather(first, middle, last);
        const int few = between_.part(firsts - margin, fewest_, side_);
        if (firsts > 0 && few < fewest_) {
            fewest_ = few;
            for (const int v : sorted_) best_[v] = part_[v] == first ? -1 : part_[v] == last ? 1 : side_[local_[v]];
        }
        const int whole = ++parts_;
        for (const int v : members_) part_[v] = whole;
    }

    /// Sorts the vertices by a key; those with the same key stay in the order of `members_`.
    template <class Key>
    void sort(const Key& key) {
        int least = key(members_[0]), most = least;
        for (const int v : members_) least = std::min(least, key(v)), most = std::max(most, key(v));
        count_.assign(most - least + 2, 0);
        for (const int v : members_) ++count_[key(v) - least + 1];
        std::partial_sum(count_.begin(), count_.end(), count_.begin());
        sorted_.resize(members_.size());
        for (const int v : members_) sorted_[count_[key(v) - least]++] = v;
    }

    /// Has a vertex a neighbour in this part?
    bool touches(int v, int part) const {
        for (int j = graph_.start[v]; j < graph_.start[v + 1]; ++j)
            if (part_[graph_.to[j]] == part) return true;
        return false;
    }

    /// Graph of the vertices in the middle; `found_` has their numbers.
    void gather(int first, int middle, int last) {
        found_.clear();
        for (const int v : sorted_)
            if (part_[v] == middle) local_[v] = static_cast<int>(found_.size()), found_.push_back(v);
        between_.clear();
        for (const int v : found_) {
            bool at_first = false, at_last = false;
            for (int j = graph_.start[v]; j < graph_.start[v + 1]; ++j) {
                const int next = graph_.to[j];
                if (part_[next] == middle) between_.to.push_back(local_[next]);
                at_first |= part_[next] == first, at_last |= part_[next] == last;
            }
            between_.start.push_back(static_cast<int>(between_.to.size()));
            between_.at_first.push_back(at_first), between_.at_last.push_back(at_last);
        }
    }

    /// Puts the first side, the last side and the separator in the place of the part.
    void place(int begin) {
        int end = begin;
        for (const int side : {-1, 1, 0}) {
            const int from = end, part = ++parts_;
            for (const int v : members_)
                if (best_[v] == side) part_[v] = part, order_[end++] = v;
            if (side != 0) todo_.emplace_back(from, end);
        }
    }
};

}  // namespace umform::ordering
