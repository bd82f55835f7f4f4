// Groups of elements that share no node.
#pragma once

#include <algorithm>
#include <stdexcept>

#include "umform/assembly/connectivity.hpp"

namespace umform {

/// Elements of each colour, which share no node: they are added in parallel, colour after colour, so that every sum is formed
/// in the same order with any number of threads. eq. (5.15)
inline std::vector<std::vector<std::int32_t>> make_colours(const Connectivity& part) {
    const int nodes = part.ids.empty() ? 0 : 1 + *std::max_element(part.ids.begin(), part.ids.end());
    std::vector<std::uint64_t> used(nodes, 0);  // bit c: the node has an element of colour c
    std::vector<std::vector<std::int32_t>> colours;
    for (int e = 0; e < part.size(); ++e) {
        std::uint64_t taken = 0;
        for (int a = 0; a < part.nodes; ++a) taken |= used[part[e][a]];
        int colour = 0;
        while (colour < 63 && (taken >> colour & 1U) != 0) ++colour;
        if (colour == 63) throw std::invalid_argument("more than 62 elements share a node");
        for (int a = 0; a < part.nodes; ++a) used[part[e][a]] |= std::uint64_t{1} << colour;
        if (colour == static_cast<int>(colours.size())) colours.emplace_back();
        colours[colour].push_back(e);
    }
    return colours;
}

}  // namespace umform
