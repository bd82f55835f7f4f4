// What a rule is to the facets: where on a face a law is asked, and how much of the tool its places feel.
#pragma once

#include "umform/contact/concept.hpp"

namespace umform {

/// A part of -dt that follows from nodes by other functions than the traction is spread by: -dt = S sum_b c_b du_b.
template <int Nodes>
struct Spread {
    Mat3 S;
    std::array<double, Nodes> c;
};

// A rule R<Nodes> is made of a connectivity, reference coordinates and a Setting, and has
//   N, area, count(), largest_motion()   shape functions at the places, [place] or [facet][place], and their areas
//   symmetric                            whether it leaves a symmetric law so
//   remembers, quantities()              what it keeps of a place after the quantities of the law
//   reach(locator, facet)                by how much its places feel farther than the law
//   respond(law, locator, facet, weights, rows, work)   the reactions of a facet, and what else it needs later
//   spread(work, place)                  see Spread; none where the traction follows from the place alone
//   gap, penetration, share              what is reported of a place: its gap and the part of its area that is held
//   leave(state, trial), contact_work(row)   of its own quantities: the tool is far; work of the pressure so far
// `points.hpp` and `cells.hpp` are such rules.

}  // namespace umform
