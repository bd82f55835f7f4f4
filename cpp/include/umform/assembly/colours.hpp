// Groups of elements that share no node.
#pragma once

#include <algorithm>
#include <stdexcept>

#include "umform/assembly/connectivity.hpp"

namespace umform {

using Colours = std::vector<std::vector<std::int32_t>>;

/// Elements of each colour, which share no node: they are added in parallel, colour after colour, so that every sum is formed
/// in the same order with any number of threads. eq. (5.15) An element takes the first colour that its neighbours leave; or,
/// with a number of colours that is given, the one of them that has the fewest elements so far. Empty if these do not suffice.
inline Colours make_colours(const Connectivity& part, int given = 0) {
    const int nodes = part.ids.empty() ? 0 : 1 + *std::max_element(part.ids.begin(), part.ids.end());
    std::vector<std::uint64_t> used(nodes, 0);  // bit c: the node has an element of colour c
    Colours colours(given);
    for (int e = 0; e < part.size(); ++e) {
        std::uint64_t taken = 0;
        for (int a = 0; a < part.nodes; ++a) taken |= used[part[e][a]];
        const auto is_free = [&](int colour) { return (taken >> colour & 1U) == 0; };
        int colour = 0;
        while (colour < 63 && !is_free(colour)) ++colour;
        if (colour == 63) throw std::invalid_argument("more than 62 elements share a node");
        if (given > 0 && colour >= given) return {};
        for (int other = colour + 1; other < given; ++other)
            if (is_free(other) && colours[other].size() < colours[colour].size()) colour = other;
        for (int a = 0; a < part.nodes; ++a) used[part[e][a]] |= std::uint64_t{1} << colour;
        if (colour == static_cast<int>(colours.size())) colours.emplace_back();
        colours[colour].push_back(e);
    }
    return colours;
}

/// Groups of `width` elements of one colour that the colours take.
inline std::size_t groups_of(const Colours& colours, int width) {
    std::size_t groups = 0;
    for (const auto& elements : colours) groups += (elements.size() + width - 1) / width;
    return groups;
}

/// Colours that take few groups of `width`: in a small mesh some more colours leave fewer groups that are not full.
inline Colours make_colours_of_groups(const Connectivity& part, int width) {
    constexpr int small = 400, most = 4;  // beyond so many elements it makes no difference
    Colours best = make_colours(part);
    const int first = static_cast<int>(best.size());
    if (part.size() > small) return best;
    for (int count = first; count < std::min(first + most, 63); ++count) {
        Colours colours = make_colours(part, count);
        if (!colours.empty() && groups_of(colours, width) < groups_of(best, width)) best = std::move(colours);
    }
    return best;
}

}  // namespace umform
