// What a search for the nearest part of a tool leaves to the next search for the same point.
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "umform/algebra/tensor.hpp"

namespace umform {

/// The parts of a tool that were nearest to a point at some place, near ones first, and what bounds their distances and those
/// of all others from below. While the point is not far from this place no search is needed: a distance falls no faster
/// than the point moves. It changes how the nearest part is found, not which one it is.
struct Nearby {
    static constexpr int most = 6;
    Vec3 place{};
    int count = 0;  // none: nothing is known
    std::array<int, most> part{};
    std::array<double, most> least{};
    double others = 0.0;

    /// Begins a search at a place.
    void clear(const Vec3& x) { place = x, count = 0, others = std::numeric_limits<double>::infinity(); }
    bool has(int i) const { return std::find(part.begin(), part.begin() + count, i) != part.begin() + count; }
    /// Takes in a part that is no nearer than a distance; the farthest one gives way.
    void add(int i, double distance) {
        if (count == most) {
            others = std::min(others, std::max(distance, least[most - 1]));
            if (!(distance < least[most - 1])) return;
        }
        int at = count < most ? count++ : most - 1;
        for (; at > 0 && least[at - 1] > distance; --at) part[at] = part[at - 1], least[at] = least[at - 1];
        part[at] = i, least[at] = distance;
    }
};

}  // namespace umform
