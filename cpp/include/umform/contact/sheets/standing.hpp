// A place of a face with its foot: the forces at both, and their derivatives.
#pragma once

#include "umform/contact/sheets/other_face.hpp"
#include "umform/contact/sheets/traction.hpp"

namespace umform {

template <int Nodes>
struct Standing {
    using Values = std::array<double, Nodes>;
    using Sum = NodeSum<Nodes>;
    using Rows = PartRows<Nodes>;
    static constexpr Slot own{-1, 0, 0};

    const FacetFoot& foot;
    Slot slot;
    OnFacet<Nodes> there;
    FootMoves<Nodes> moves;
    Sum d;
    Turn turn;

    /// N: shape functions of the place on its own facet.
    Standing(const FacetFoot& foot, const Values& N, bool tangent, const OtherFace<Nodes>& face, LoosePart& part,
             std::vector<Slot>& met)
        : foot(foot), slot(face.slot(part, met, foot.facet)), there(face.at(foot.facet), foot.r, foot.s),
          moves(there, foot), turn{slot, {}} {
        d.add(own, N, 1.0), d.add(slot, there.shape.N, -1.0);
        if (tangent) turn = face.turn(slot, there);
    }

    /// Adds a traction times a weight at the place and at its foot, and its derivatives; slope: of the pressure. eqs. (4.305), (4.306)
    void add_force(double weight, const SheetReaction& reaction, Rows& slope, bool tangent, LoosePart& part) const {
        for (int k = 0; k < d.count; ++k)
            for (int a = 0; a < Nodes; ++a)
                for (int i = 0; i < 3; ++i)
                    part.f[3 * (d.at[k].row + a) + i] -= weight * d.by[k][a] * reaction.traction[i];
        if (!tangent) return;
        const auto scaled = [](Mat3 block, double factor) {
            for (double& value : block.a) value *= factor;
            return block;
        };
        Rows rows(3, part.columns());
        rows.add(scaled(reaction.K[0], -weight), d), rows.add(scaled(reaction.K[1], -weight), turn);
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < part.columns(); ++j)
                rows.row(i)[j] -= weight * reaction.by_pressure[i] * slope.row(0)[j];
        rows.spread(d, part);
        for (int a = 0; a < 2; ++a) {  // the foot moves below the force
            const auto& xi = moves.xi[a];
            Rows moved(3, part.columns());
            moved.add(detail::outer(reaction.traction, xi[0]), d);
            moved.add(detail::outer(reaction.traction, xi[1]), turn);
            Sum along;
            along.add(slot, a == 0 ? there.shape.Nr : there.shape.Ns, weight);
            moved.spread(along, part);
        }
    }

    /// Adds the derivatives with respect to the converged foot `then`, where it is now.
    void add_anchor(double weight, const SheetReaction& reaction, const Values& N, const FaceShape<Nodes>& of_anchor,
                    const Slot& then, LoosePart& part) const {
        std::array<Sum, 3> w;
        w[0].add(own, N, 1.0), w[0].add(then, of_anchor.N, -1.0);
        w[1].add(then, of_anchor.Nr, 1.0), w[2].add(then, of_anchor.Ns, 1.0);
        Rows rows(3, part.columns());
        for (int i = 0; i < 3; ++i) {
            Mat3 block = reaction.K0[i];
            for (double& value : block.a) value *= -weight;
            rows.add(block, w[i]);
        }
        rows.spread(d, part);
    }
};

}  // namespace umform
