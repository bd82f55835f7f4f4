// The order of elimination of a matrix: that of a sheet, or the better one of two for all else.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "umform/multifrontal/supernodes.hpp"
#include "umform/ordering/dissection.hpp"
#include "umform/ordering/minimum_degree.hpp"
#include "umform/ordering/quotient.hpp"

namespace umform::multifrontal {

/// Supernodes of a pattern whose quotient graph is given. Sheets are ordered by nested dissection. Of solids and stacks that
/// does best where they are flat, minimum degree where they are small or without a shape: both are tried and their
/// multiplications counted. Equations that hardly share their neighbours are left to minimum degree.
inline Supernodes eliminate(const ordering::Quotient& quotient) {
    const ordering::Graph& graph = quotient.graph;
    std::vector<std::int32_t> weight(graph.size(), 0);
    for (const int v : quotient.group) ++weight[v];
    const bool fibres = 2 * static_cast<std::size_t>(graph.size()) <= quotient.group.size();
    if (fibres) {
        const auto order = ordering::Dissection(graph).run();
        if (!order.empty()) return {graph, weight, order};
    }
    Supernodes least(graph, weight, ordering::MinimumDegree(graph, weight).run());
    if (fibres) {
        const auto order = ordering::Dissection(graph, true).run();
        if (order.empty()) return least;
        Supernodes parted(graph, weight, order);
        if (parted.work() < least.work()) return parted;
    }
    return least;
}

}  // namespace umform::multifrontal
