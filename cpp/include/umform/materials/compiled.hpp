// A law that is a C function in a shared library, or one that numba or ctypes has made.
#pragma once

#include "umform/materials/foreign.hpp"

namespace umform {

extern "C" {
/// Arrays are those of the points one after the other: strain [6], state [size], axes [3][3] (null unless needed), stress [6],
/// tangent [6][6] = dstress/dstrain by rows, new_state [size]. `length` of the element is 0 unless asked for; `step` is the increment
/// of time. Returns 0, else there is no answer and the increment is cut.
using CompiledFunction = int(int points, const double* strain, const double* state, const double* properties,
                             const double* axes, double length, double step, double* stress, double* tangent,
                             double* new_state);
/// energies [2]: elastic energy and plastic work of each point, with the history that belongs to the strain.
using CompiledEnergy = int(int points, const double* strain, const double* state, const double* properties,
                           double* energies);
}

inline std::shared_ptr<Material> compiled_law(CompiledFunction* function, CompiledEnergy* energy,
                                              const ForeignTraits& traits) {
    const Gate gate(traits.parallel);
    auto call = [=](const FunctionArguments& at, const FunctionAnswer& out) {
        const auto* axes = reinterpret_cast<const double*>(at.axes);
        const std::size_t n = at.n, size = n * traits.law.initial.size();
        GuardedAnswer& guarded = GuardedAnswer::of_thread();
        double *S = guarded.stress.reset(6 * n), *CC = guarded.tangent.reset(36 * n),
               *trial = guarded.state.reset(size);
        const int refused = gate.pass([&] {
            return function(at.n, at.E->data(), at.state, traits.properties.data(), axes, at.size, at.step, S, CC,
                            trial);
        });
        guarded.require_intact(traits.name, at.cell, -1);
        if (refused != 0) return 0;
        std::copy_n(S, 6 * n, out.S->data());
        std::copy_n(CC, 36 * n, out.CC->a.data());
        std::copy_n(trial, size, out.trial);
        require_sound(traits, at, out);
        return at.n;
    };
    MaterialFromFunction::EnergyFunction energies;
    if (energy != nullptr)
        energies = [=](int n, const Voigt* E, const double* state, Energy* out, std::int32_t cell) {
            std::vector<double> both(2 * static_cast<std::size_t>(n));
            const int refused =
                gate.pass([&] { return energy(n, E->data(), state, traits.properties.data(), both.data()); });
            if (refused != 0 || !all_finite(both.data(), both.size()))
                throw RefusedAnswer(traits.name, "the energy of a law is not finite", RefusedAnswer::NotFinite, cell,
                                    0);
            for (int q = 0; q < n; ++q) out[q] = {both[2 * q], both[2 * q + 1]};
        };
    return std::make_shared<MaterialFromFunction>(std::move(call), traits.law, std::move(energies));
}

}  // namespace umform
