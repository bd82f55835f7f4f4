// The face that the places of a half pass meet: its facets at present positions, and the foot of a place on them.
#pragma once

#include <limits>

#include "umform/contact/sheets/boxes.hpp"
#include "umform/contact/sheets/normals.hpp"
#include "umform/contact/sheets/part_rows.hpp"
#include "umform/contact/sheets/rims.hpp"

namespace umform {

template <int Nodes>
class OtherFace {
  public:
    static constexpr double edge = 0.05;  // a foot may be so far beyond the edge of its facet, in natural coordinates

    /// x: positions [node of the model], which move.
    OtherFace(Connectivity facets, CutEdges edges, const std::vector<Vec3>& x)
        : facets_(std::move(facets)), x_(x), smooth_(facets_), rims_(std::move(edges), facets_.size(), x) {}

    const Connectivity& facets() const { return facets_; }
    const Rims<Nodes>& rims() const { return rims_; }
    /// Nodes that the normals of a facet depend on.
    const std::vector<std::int32_t>& around(int facet) const { return smooth_.around(facet); }

    /// After a motion: normals, with their derivatives if requested, and boxes.
    void update(bool slopes, int threads) {
        smooth_.update(x_, slopes, threads), rims_.update();
        normals_.resize(facets_.size()), boxes_.resize(facets_.size());
        for_each_range(facets_.size(), threads, [&](int first, int last) {
            for (int m = first; m < last; ++m) {
                const SmoothFacet<Nodes> facet = at(m);
                normals_[m] = OnFacet<Nodes>(facet, 0.0, 0.0).n, boxes_[m] = box_of<Nodes>(facet.x);
            }
        });
    }

    SmoothFacet<Nodes> at(int facet) const { return {nodes_of<Nodes>(facets_[facet], x_), smooth_.of(facet)}; }
    /// Boxes of all facets with their rims, at present positions.
    std::vector<FacetBox> boxes() const {
        std::vector<FacetBox> boxes(facets_.size());
        for (int m = 0; m < facets_.size(); ++m) {
            boxes[m] = box_of<Nodes>(nodes_of<Nodes>(facets_[m], x_));
            for (const int edge : rims_.of(m)) boxes[m].add(rims_.box_at(edge));
        }
        return boxes;
    }
    const Vec3& normal(int facet) const { return normals_[facet]; }
    const FacetBox& box(int facet) const { return boxes_[facet]; }

    /// The foot of a place on some facets, with a gap from -deepest to highest: the nearest. A facet goes on so far beyond its cut edges.
    void closest(const std::vector<std::int32_t>& near, const Vec3& x, double deepest, double highest, double over_cut,
                 FacetFoot& best) const {
        double least = std::numeric_limits<double>::infinity();
        for (const std::int32_t m : near) {
            if (!boxes_[m].has(x, std::max({deepest, highest, over_cut}))) continue;
            FacetFoot foot;
            const SmoothFacet<Nodes> smooth = at(m);
            const auto& facet = smooth.x;
            const Vec3 diagonal{facet[2][0] - facet[0][0], facet[2][1] - facet[0][1], facet[2][2] - facet[0][2]};
            const double size = std::sqrt(dot(diagonal, diagonal));
            if (!project<Nodes>(smooth, x, std::max(edge, 2.0 * over_cut / size), foot)) continue;
            if (foot.gap < -deepest || foot.gap > highest || !ends(m, foot, 2.0 * over_cut / size)) continue;
            const double cost = std::abs(foot.gap) + off_edge * foot.beyond() * size;
            if (cost < least) least = cost, foot.facet = m, best = foot;
        }
    }

    /// The foot of a place beyond cut edges on their rims, where its normal n and that of the rim look at each other.
    void closest_rim(const std::vector<NearRim>& near, const Vec3& n, const Vec3& x, double deepest, double highest,
                     FacetFoot& best) const {
        double least = std::numeric_limits<double>::infinity();
        for (const NearRim& one : near) {
            FacetFoot foot;
            double along = 0.0;
            if (!rims_.box(one.edge).has(x, highest) || !rims_.at(one.edge).project(x, foot, along)) continue;
            if (foot.gap < -deepest || foot.gap > highest || dot(n, foot.n) >= one.facing) continue;
            if (!beyond_cut(one.edge, x, foot)) continue;
            const double cost = std::abs(foot.gap) + off_edge * along;
            if (cost < least) least = cost, foot.facet = rims_.facet(one.edge), foot.rim = one.edge, best = foot;
        }
    }

    /// The foot of a place with a foot on a rim on the facet there, continued beyond its cut edge; whether there is one.
    bool over_cut(const Vec3& x, const FacetFoot& on_rim, FacetFoot& foot) const {
        if (!project<Nodes>(at(on_rim.facet), x, 4.0, foot)) return false;
        foot.facet = on_rim.facet;
        return true;
    }

    /// Where a facet is in a part, which gets its nodes and those around it when it is met first.
    Slot slot(LoosePart& part, std::vector<Slot>& met, std::int32_t facet) const {
        return slot(part, met, {facet, 0, 0, -1}, facets_[facet], Nodes, around(facet));
    }
    /// The same for the facet or the cut edge of a foot.
    Slot slot(LoosePart& part, std::vector<Slot>& met, const FacetFoot& foot) const {
        if (foot.rim < 0) return slot(part, met, foot.facet);
        const std::int32_t* first = rims_.nodes()[foot.rim];
        const int count = rims_.nodes().nodes;
        return slot(part, met, {foot.facet, 0, 0, foot.rim}, first, count, {first, first + count});
    }

    /// How the normal of a point of a facet turns with the nodes around.
    Turn turn(const Slot& slot, const OnFacet<Nodes>& there) const {
        Turn turn{slot, {}};
        smooth_.slope(slot.facet, there.shape.N, turn.by);
        for (Mat3& by : turn.by) by = across(by, there.n, there.length);
        return turn;
    }

  private:
    static constexpr double off_edge = 10.0;  // a way beyond an edge counts as so much of a gap

    static Slot slot(LoosePart& part, std::vector<Slot>& met, Slot wanted, const std::int32_t* nodes, int count,
                     const std::vector<std::int32_t>& others) {
        for (const Slot& known : met)
            if (known.facet == wanted.facet && known.rim == wanted.rim) return known;
        wanted.row = static_cast<int>(part.nodes.size()), wanted.column = static_cast<int>(part.others.size());
        part.nodes.insert(part.nodes.end(), nodes, nodes + count);
        part.others.insert(part.others.end(), others.begin(), others.end());
        met.push_back(wanted);
        return wanted;
    }

    /// Whether a foot is on a facet, or beyond it as far as the facet goes on: at its cut edges not at all, or so far.
    bool ends(int facet, const FacetFoot& foot, double over_cut) const {
        for (int side = 0; side < 4; ++side) {
            const double beyond = Rims<Nodes>::beyond_side(side, foot);
            if (beyond > 0.0 && beyond > (rims_.cut(facet, side) ? over_cut : edge)) return false;
        }
        return true;
    }

    /// Whether a place is beyond a cut edge: by its foot on the continued facet or, far away, by its direction from the edge.
    bool beyond_cut(int edge, const Vec3& x, const FacetFoot& on_rim) const {
        const int m = rims_.facet(edge);
        const SmoothFacet<Nodes> facet = at(m);
        FacetFoot foot;
        if (project<Nodes>(facet, x, 2.0, foot)) return rims_.beyond(edge, foot) > 0.0;
        const auto there = rims_.at(edge).at(x, on_rim.r);
        Vec3 inside = combined<Nodes>(face_shape<Nodes>(0.0, 0.0).N, facet.x);
        for (int k = 0; k < 3; ++k) inside[k] -= x[k] - there.e[k] + there.w[k];
        const Vec3 across_edge = cross(there.c1, there.w);
        return dot(there.e, across_edge) * dot(inside, across_edge) < 0.0;
    }

    Connectivity facets_;
    const std::vector<Vec3>& x_;
    NodalNormals<Nodes> smooth_;
    Rims<Nodes> rims_;
    std::vector<Vec3> normals_;  // [facet] at its middle
    std::vector<FacetBox> boxes_;
};

}  // namespace umform
