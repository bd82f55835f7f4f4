// A grid of quadrilaterals with prescribed degrees of freedom.
#pragma once

#include <algorithm>
#include <random>

#include "umform/assembly/connectivity.hpp"

/// n x m quadrilaterals with their node ids shuffled.
inline umform::Connectivity grid(int n, int m, unsigned seed) {
    std::vector<std::int32_t> number((n + 1) * (m + 1));
    for (std::size_t k = 0; k < number.size(); ++k) number[k] = static_cast<std::int32_t>(k);
    std::shuffle(number.begin(), number.end(), std::mt19937(seed));
    umform::Connectivity part{4, {}};
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j)
            for (const auto& [di, dj] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
                part.ids.push_back(number[(i + di) * (m + 1) + j + dj]);
    return part;
}

/// Equation numbers with every fifth degree of freedom prescribed.
inline std::vector<std::int32_t> equations(int nodes) {
    std::vector<std::int32_t> equation(3 * nodes);
    std::int32_t next = 0;
    for (int dof = 0; dof < 3 * nodes; ++dof) equation[dof] = dof % 5 == 2 ? -1 : next++;
    return equation;
}
