// Which facets of the other face a facet may meet within some way of both.
#pragma once

#include "umform/assembly/connectivity.hpp"
#include "umform/assembly/threads.hpp"
#include "umform/contact/sheets/boxes.hpp"
#include "umform/contact/sheets/facet_at.hpp"

namespace umform {

/// Facets of the other face by facet of this one; `near` are those that are never met unless they face each other: of the same sheet
/// within some way along it. Facets that share a node are never met.
class Candidates {
  public:
    std::vector<std::vector<std::int32_t>> of, near;  // [facet] sorted

    bool close(int e, std::int32_t other) const {
        return !near.empty() && std::binary_search(near[e].begin(), near[e].end(), other);
    }

    /// Those whose boxes, given for the other face, are within `reach` of each other, and that may meet(e, m).
    template <int Nodes, class MayMeet>
    void search(const Connectivity& part, const Connectivity& others, std::vector<FacetBox> boxes,
                const std::vector<Vec3>& x, double reach, int threads, const MayMeet& may_meet) {
        const FacetTree tree(std::move(boxes));
        of.resize(part.size());
        for_each_range(part.size(), part.size() < facets_worth_a_team ? 1 : threads, [&](int first, int last) {
            for (int e = first; e < last; ++e) {
                of[e].clear();
                FacetBox box = box_of<Nodes>(nodes_of<Nodes>(part[e], x));
                box.grow(reach);
                tree.meeting(box, [&](int m) {
                    if (!share_a_node<Nodes>(part[e], others[m]) && may_meet(e, m)) of[e].push_back(m);
                });
                std::sort(of[e].begin(), of[e].end());
            }
        });
    }

  private:
    template <int Nodes>
    static bool share_a_node(const std::int32_t* one, const std::int32_t* other) {
        for (int a = 0; a < Nodes; ++a)
            for (int b = 0; b < Nodes; ++b)
                if (one[a] == other[b]) return true;
        return false;
    }
};

}  // namespace umform
