// How often return maps have gone through stages of a shrinking yield surface, their last resort: a count of the process.
#pragma once

#include <atomic>
#include <cstdint>

#include "umform/algebra/lanes.hpp"

namespace umform {

/// The count; threads add to it, and its sum does not depend on their order.
inline std::atomic<std::uint64_t>& staged_returns() {
    static std::atomic<std::uint64_t> count{0};
    return count;
}

/// Lanes whose return map used stages since the last count, on this thread.
inline LaneMask& lanes_in_stages() {
    static thread_local LaneMask lanes = false;
    return lanes;
}

inline void note_stages(LaneMask staged) { lanes_in_stages() = lanes_in_stages() | staged; }
inline void note_stages(bool) {}  // counted in elements and point paths only

/// Count the lanes among those that were asked.
inline void count_stages(LaneMask asked) {
    const LaneMask staged = lanes_in_stages();
    if (!any(staged)) return;
    for (int lane = 0; lane < lane_count; ++lane)
        if (staged[lane] && asked[lane]) staged_returns().fetch_add(1, std::memory_order_relaxed);
    lanes_in_stages() = false;
}

}  // namespace umform
