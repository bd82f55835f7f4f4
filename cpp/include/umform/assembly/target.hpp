// How a block of elements or facets adds its share to residual and tangent.
#pragma once

#include <array>

#include "umform/assembly/scatter.hpp"

namespace umform {

/// Where a block adds its share. Arrays over all degrees of freedom, but `values` over the entries of the pattern. Without
/// `values` and `du` the residual is asked for only: the tangent costs nothing then.
struct Target {
    double* f;                   // internal forces
    double* values = nullptr;    // if given: tangent over the free degrees of freedom
    const double* du = nullptr;  // if given: increment of the prescribed degrees of freedom ...
    double* Kdu = nullptr;       // ... and K du

    bool wants_tangent() const { return values != nullptr || du != nullptr; }
};

/// Outcome of `evaluate`: the first element whose strain left the domain of its law or whose
/// enhanced parameters cannot be eliminated (or -1), and sum |f_e|^2, the scale
/// of the forces that a residual is measured against.
struct Outcome {
    int failed = -1;
    double force_scale_squared = 0.0;
};

/// Reads the nodal values of one element into its order by direction.
template <int Nodes>
void gather(const Connectivity& part, int element, const double* field, double* local) {
    const std::int32_t* ids = part[element];
    for (int a = 0; a < Nodes; ++a)
        for (int k = 0; k < 3; ++k) local[k * Nodes + a] = field[3 * ids[a] + k];
}

/// Adds K, f (and K du of prescribed increments) of one element, as far as they are asked for. K holds its upper
/// triangle, which is completed where that is needed, or all of a matrix that is not symmetric (`full`).
template <int Nodes>
void scatter_element(const Connectivity& part, const Scatter& scatter, int element, double* K, const double* f,
                     const Target& target, bool full = false) {
    constexpr int size = 3 * Nodes;
    const std::int32_t* ids = part[element];
    for (int a = 0; a < Nodes; ++a)
        for (int k = 0; k < 3; ++k) target.f[3 * ids[a] + k] += f[k * Nodes + a];
    if (!target.wants_tangent()) return;
    if (!full && (!scatter.symmetric || target.du != nullptr))
        for (int i = 0; i < size; ++i)
            for (int j = 0; j < i; ++j) K[i * size + j] = K[j * size + i];
    if (target.du != nullptr) {
        std::array<double, size> du;
        gather<Nodes>(part, element, target.du, du.data());
        for (int a = 0; a < Nodes; ++a)
            for (int k = 0; k < 3; ++k) {
                double sum = 0.0;
                for (int j = 0; j < size; ++j) sum += K[(k * Nodes + a) * size + j] * du[j];
                target.Kdu[3 * ids[a] + k] += sum;
            }
    }
    if (target.values != nullptr) scatter.add(element, K, target.values);
}

}  // namespace umform
