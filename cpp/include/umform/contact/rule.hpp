// Interface of a rule for facets: where on a face a law is evaluated, and the resulting nodal forces.
#pragma once

#include "umform/contact/concept.hpp"

namespace umform {

// A rule R<Nodes> is made of a connectivity, reference coordinates and a Setting, and has
//   N, places(), largest_motion()        shape functions at the places of a facet that are measured, [place] or [facet][place]
//   count(), area                        the first `count` of them are the points where the law is evaluated; [facet][point]
//   symmetric                            whether it leaves a symmetric law so
//   remembers, table                     what it keeps of a point after the history_variables of the law
//   respond(law, locator, facet, rows, work)   the reactions of a facet, and what else it needs later
//   add(law, locator, facet, point, area, work, tangent, K, f)   forces and tangent of a point that is held
//   gap, penetration, share              what is reported of a point: its gap and the part of its area that is held
//   leave(state, trial), contact_work(row)   for its own history_variables: the tool is far; work of the pressure so far
// `points.hpp` and `cells.hpp` are such rules.

}  // namespace umform
