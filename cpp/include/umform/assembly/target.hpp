// How a block of elements or facets adds its share to residual and tangent.
#pragma once

#include <array>

#include "umform/assembly/scatter.hpp"

namespace umform {

/// Where a block adds its share. Arrays over all degrees of freedom, but `values` over the entries of the pattern. Without
/// `values` and `du` only the residual is requested: the tangent then costs nothing.
struct Target {
    double* f;                   // internal forces
    double* values = nullptr;    // if given: tangent over the free degrees of freedom
    const double* du = nullptr;  // if given: increment of the prescribed degrees of freedom ...
    double* Kdu = nullptr;       // ... and K du

    bool wants_tangent() const { return values != nullptr || du != nullptr; }
};

/// Why an element has no residual.
enum class Failure : char {
    None,
    Inverted,   // det J of the current configuration is not positive at a Gauss point
    Law,        // its law has no answer
    Condensed,  // its enhanced parameters cannot be eliminated
};

/// Why an element has no residual, in words that follow "cell 7 "; empty if it has one.
inline const char* describe(Failure failure) {
    switch (failure) {
        case Failure::None:
            return "";
        case Failure::Inverted:
            return "is turned inside out: det F is not positive at one of its Gauss points";
        case Failure::Law:
            return "is strained beyond the domain of its material law, or the law found no stress";
        case Failure::Condensed:
            return "is strained so far that its enhanced parameters cannot be eliminated";
    }
    return "";
}

/// Outcome of `evaluate`: the first element that has no residual (or -1) and why, and sum |f_e|^2, the scale of the forces that a
/// residual is measured against.
struct Outcome {
    int failed = -1;
    Failure failure = Failure::None;
    double force_scale_squared = 0.0;
};

/// Reads the nodal values of one element into its order by direction.
template <int Nodes>
void gather(const Connectivity& part, int element, const double* field, double* local) {
    const std::int32_t* ids = part[element];
    for (int a = 0; a < Nodes; ++a)
        for (int k = 0; k < 3; ++k) local[k * Nodes + a] = field[3 * ids[a] + k];
}

/// Adds K, f (and K du of prescribed increments) of one element, as far as they are requested. K holds its upper
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
