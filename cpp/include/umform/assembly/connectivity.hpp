// Which nodes belong to an element, a facet, or anything else that couples degrees of freedom.
#pragma once

#include <cstdint>
#include <vector>

namespace umform {

/// Elements of one kind: `nodes` node ids each. Degree of freedom = 3 * node + direction.
struct Connectivity {
    int nodes = 0;
    std::vector<std::int32_t> ids;  // [element][nodes]
    int size() const { return nodes == 0 ? 0 : static_cast<int>(ids.size()) / nodes; }
    const std::int32_t* operator[](int element) const { return ids.data() + static_cast<std::size_t>(element) * nodes; }
};

}  // namespace umform
