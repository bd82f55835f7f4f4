// A place of a face that the other face holds: on one of its facets, or on the rim of a cut edge.
#pragma once

#include <variant>

#include "umform/contact/sheets/rim_standing.hpp"
#include "umform/contact/sheets/standing.hpp"

namespace umform {

template <int Nodes>
class SheetPlace {
  public:
    using Values = std::array<double, Nodes>;
    using Rows = PartRows<Nodes>;
    const FacetFoot& foot;

    /// N: shape functions of the place x on its own facet.
    SheetPlace(const FacetFoot& foot, const Values& N, const Vec3& x, bool tangent, const OtherFace<Nodes>& face,
               LoosePart& part, std::vector<Slot>& met)
        : foot(foot), standing_(made(foot, N, x, tangent, face, part, met)) {}

    /// None on a rim.
    const Standing<Nodes>* on_facet() const { return std::get_if<Standing<Nodes>>(&standing_); }

    /// Adds a factor times the change of the gap to the first row.
    void add_gap(double factor, Rows& rows) const {
        if (const auto* on = on_facet())
            rows.add_gap(factor, on->moves, on->d, on->turn);
        else
            rim().add_gap(factor, rows.row(0));
    }

    /// Adds a pressure times a weight at both faces, and its derivatives; slope: of the pressure. Returns the traction.
    Vec3 add_pressure(double weight, double pressure, Rows& slope, bool tangent, LoosePart& part) const {
        if (const auto* on = on_facet()) {
            SheetReaction reaction;
            press<Nodes>(foot, on->moves, pressure, reaction);
            on->add_force(weight, reaction, slope, tangent, part);
            return reaction.traction;
        }
        rim().add_pressure(weight, pressure, slope.row(0), tangent, part);
        return {pressure * foot.n[0], pressure * foot.n[1], pressure * foot.n[2]};
    }

  private:
    using Either = std::variant<Standing<Nodes>, RimStanding<Nodes>>;
    Either standing_;

    const RimStanding<Nodes>& rim() const { return std::get<RimStanding<Nodes>>(standing_); }

    static Either made(const FacetFoot& foot, const Values& N, const Vec3& x, bool tangent,
                       const OtherFace<Nodes>& face, LoosePart& part, std::vector<Slot>& met) {
        if (foot.rim >= 0) return RimStanding<Nodes>(foot, N, x, face, part, met);
        return Standing<Nodes>(foot, N, tangent, face, part, met);
    }
};

}  // namespace umform
