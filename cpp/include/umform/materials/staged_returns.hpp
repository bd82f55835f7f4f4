// How often return maps have gone through stages of a shrinking yield surface, their last resort: each law has a count.
#pragma once

#include "umform/algebra/lanes.hpp"

namespace umform {

/// Lanes whose return map used stages since the last count, on this thread.
inline LaneMask& lanes_in_stages() {
    static thread_local LaneMask lanes = false;
    return lanes;
}

inline void note_stages(LaneMask staged) { lanes_in_stages() = lanes_in_stages() | staged; }
inline void note_stages(bool) {}  // counted in elements and point paths only

/// Number of these lanes among those that were asked; the next count begins.
inline int take_stages(LaneMask asked) {
    const LaneMask staged = lanes_in_stages();
    if (!any(staged)) return 0;
    int count = 0;
    for (int lane = 0; lane < lane_count; ++lane) count += staged[lane] && asked[lane];
    lanes_in_stages() = false;
    return count;
}

}  // namespace umform
