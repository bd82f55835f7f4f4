// Places of one face that go through another one between two states.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "umform/assembly/connectivity.hpp"
#include "umform/contact/sheets/boxes.hpp"
#include "umform/contact/sheets/facet_at.hpp"

namespace umform {

/// A place of a facet that was in front of a facet of the other face, and is behind it.
struct Crossing {
    std::int32_t facet = -1, other = -1;
    Vec3 x{};
    double depth = 0.0;
};

/// The distance from a facet along its normal at the nearest point of it, continued beyond its edges.
template <int Nodes>
struct AboveFacet {
    double r = 0.0, s = 0.0, gap = 0.0;

    AboveFacet(const std::array<Vec3, Nodes>& facet, const Vec3& x) {
        for (int iteration = 0; iteration < 8; ++iteration) {
            const FaceShape<Nodes> shape = face_shape<Nodes>(r, s);
            const Vec3 y = combined<Nodes>(shape.N, facet), a = combined<Nodes>(shape.Nr, facet),
                       b = combined<Nodes>(shape.Ns, facet), d{x[0] - y[0], x[1] - y[1], x[2] - y[2]};
            gap = dot(normalised(cross(a, b)), d);
            const double aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), da = dot(d, a), db = dot(d, b);
            const double scale = 1.0 / (aa * bb - ab * ab), dr = scale * (bb * da - ab * db),
                         ds = scale * (aa * db - ab * da);
            r = std::clamp(r + dr, -farthest, farthest), s = std::clamp(s + ds, -farthest, farthest);
            if (std::abs(dr) + std::abs(ds) < 1e-6) break;
        }
    }
    bool inside() const { return std::max(std::abs(r), std::abs(s)) <= 1.0 + edge; }

  private:
    static constexpr double farthest = 3.0, edge = 0.05;  // in natural coordinates
};

/// Positions of the nodes of two faces at two states, straight lines between them.
struct Motion {
    std::vector<Vec3> before, now;

    Vec3 at(std::int32_t node, double part) const {
        const Vec3 &a = before[node], &b = now[node];
        return {a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]), a[2] + part * (b[2] - a[2])};
    }
    template <int Nodes>
    std::array<Vec3, Nodes> at(const std::int32_t* ids, double part) const {
        std::array<Vec3, Nodes> x;
        for (int a = 0; a < Nodes; ++a) x[a] = at(ids[a], part);
        return x;
    }
};

/// The deepest place of each facet of a part that goes through a facet of the other face, more than `deepest` behind it: it was before
/// that, and where it passes the surface it is over the facet. eq. (4.321) Places: nodes and middle. Facets that share a node are never passed.
template <int Nodes>
std::vector<Crossing> crossings(const Connectivity& part, const Motion& of_part, const Connectivity& others,
                                const Motion& of_others, double deepest) {
    const auto swept = [](const Connectivity& facets, int m, const Motion& motion) {
        FacetBox box = box_of<Nodes>(motion.at<Nodes>(facets[m], 0.0));
        box.add(box_of<Nodes>(motion.at<Nodes>(facets[m], 1.0)));
        return box;
    };
    std::vector<FacetBox> boxes;
    for (int m = 0; m < others.size(); ++m) boxes.push_back(swept(others, m, of_others));
    const FacetTree tree(std::move(boxes));
    const auto middle = face_shape<Nodes>(0.0, 0.0).N;
    std::vector<Crossing> found;
    for (int e = 0; e < part.size(); ++e) {
        Crossing worst;
        tree.meeting(swept(part, e, of_part), [&](int m) {
            const std::int32_t *own = part[e], *other = others[m];
            if (std::any_of(own, own + Nodes,
                            [&](auto node) { return std::find(other, other + Nodes, node) < other + Nodes; }))
                return;
            const auto facet = of_others.at<Nodes>(other, 1.0);
            for (int place = 0; place <= Nodes; ++place) {
                const auto x = [&](double part_of) {
                    return place < Nodes ? of_part.at(own[place], part_of)
                                         : combined<Nodes>(middle, of_part.at<Nodes>(own, part_of));
                };
                const double now = AboveFacet<Nodes>(facet, x(1.0)).gap;
                if (now >= -deepest || -now <= worst.depth) continue;
                const double before = AboveFacet<Nodes>(of_others.at<Nodes>(other, 0.0), x(0.0)).gap;
                if (before < -deepest) continue;
                const double when = before > 0.0 ? before / (before - now) : 0.0;
                if (!AboveFacet<Nodes>(of_others.at<Nodes>(other, when), x(when)).inside()) continue;
                worst = {e, m, x(1.0), -now};
            }
        });
        if (worst.facet >= 0) found.push_back(worst);
    }
    return found;
}

}  // namespace umform
