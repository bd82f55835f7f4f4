// Which nodes the tangent of a half pass couples: only those that an entry of it may have.
#pragma once

#include <algorithm>
#include <vector>

#include "umform/contact/sheets/other_face.hpp"
#include "umform/contact/sheets/search.hpp"

namespace umform {

/// The forces of a place act on its facet and on that of its foot, and depend on both and on the nodes around the latter. With
/// `together`, whatever a facet may meet acts on all of that: corners of one cell, a foot and where it was before.
template <int Nodes>
class Couplings {
  public:
    Couplings(const Connectivity& part, const OtherFace<Nodes>& other, const Candidates& candidates, bool together,
              int nodes)
        : depends_(part.size()), rows_(nodes) {
        std::vector<std::vector<std::int32_t>> around(other.facets().size());
        for (int m = 0; m < other.facets().size(); ++m) {
            around[m] = other.around(m);
            for (const int edge : other.rims().of(m)) append(around[m], other.rims().nodes(), edge);
            sort_unique(around[m]);
        }
        std::vector<std::vector<std::int32_t>> on(nodes);  // [node] lists of nodes that a force there depends on
        std::vector<const std::vector<std::int32_t>*> lists;
        const auto act = [&](const Connectivity& at, int k, int list) {
            for (int a = 0; a < at.nodes; ++a) on[at[k][a]].push_back(list);
        };
        std::vector<std::vector<std::int32_t>> own(part.size());
        for (int e = 0; e < part.size(); ++e) {
            if (candidates.of[e].empty()) continue;
            append(own[e], part, e), depends_[e] = own[e];
            for (const std::int32_t m : candidates.of[e])
                depends_[e].insert(depends_[e].end(), around[m].begin(), around[m].end());
            sort_unique(depends_[e]);
            lists.push_back(&depends_[e]);
            act(part, e, static_cast<int>(lists.size()) - 1);
            lists.push_back(together ? &depends_[e] : &own[e]);
            for (const std::int32_t m : candidates.of[e]) act_on(other, m, static_cast<int>(lists.size()) - 1, act);
        }
        std::vector<char> met(other.facets().size(), 0);
        for (const auto& of : candidates.of)
            for (const std::int32_t m : of) met[m] = 1;
        for (int m = 0; m < other.facets().size(); ++m)
            if (met[m] != 0) lists.push_back(&around[m]), act_on(other, m, static_cast<int>(lists.size()) - 1, act);
        std::vector<std::int32_t> last(nodes, -1);
        for (int i = 0; i < nodes; ++i) {
            for (const std::int32_t list : on[i])
                for (const std::int32_t j : *lists[list])
                    if (j != i && last[j] != i) last[j] = i, rows_[std::min(i, j)].push_back(std::max(i, j));
        }
        for (auto& row : rows_) sort_unique(row);
    }

    /// Pairs of nodes, the smaller first, in order.
    Connectivity pairs() const {
        Connectivity pairs{2, {}};
        for (std::size_t i = 0; i < rows_.size(); ++i)
            for (const std::int32_t j : rows_[i])
                pairs.ids.push_back(static_cast<std::int32_t>(i)), pairs.ids.push_back(j);
        return pairs;
    }

  private:
    static void append(std::vector<std::int32_t>& into, const Connectivity& from, int k) {
        into.insert(into.end(), from[k], from[k] + from.nodes);
    }
    static void sort_unique(std::vector<std::int32_t>& ids) {
        std::sort(ids.begin(), ids.end());
        ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    }
    template <class Act>
    static void act_on(const OtherFace<Nodes>& other, int m, int list, const Act& act) {
        act(other.facets(), m, list);
        for (const int edge : other.rims().of(m)) act(other.rims().nodes(), edge, list);
    }

    std::vector<std::vector<std::int32_t>> depends_;  // [facet]
    std::vector<std::vector<std::int32_t>> rows_;     // [node]
};

}  // namespace umform
