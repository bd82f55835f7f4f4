// A user subroutine with the interface UMAT of Abaqus, three-dimensional, for small strains: it is evaluated in logarithmic space, in the
// axes of the sheet. docs/theory, 3.15
#pragma once

#include <array>

#include "umform/materials/foreign.hpp"

namespace umform {

extern "C" {
/// Abaqus user subroutines reference, UMAT. The length of the name comes last, as Fortran compilers pass it; C does not see it.
using UmatFunction = void(double* stress, double* statev, double* ddsdde, double* sse, double* spd, double* scd,
                          double* rpl, double* ddsddt, double* drplde, double* drpldt, const double* stran,
                          const double* dstran, const double* time, const double* dtime, const double* temp,
                          const double* dtemp, const double* predef, const double* dpred, const char* cmname,
                          const int* ndi, const int* nshr, const int* ntens, const int* nstatv, const double* props,
                          const int* nprops, const double* coords, const double* drot, double* pnewdt,
                          const double* celent, const double* dfgrd0, const double* dfgrd1, const int* noel,
                          const int* npt, const int* layer, const int* kspt, const int* jstep, const int* kinc,
                          std::size_t cmname_length);
}

/// Its history: what a UMAT gets at the beginning of an increment and would not know else, then its state variables.
struct UmatState {
    static constexpr VariableTable table{{{"umat_stress", 6}, {"umat_strain", 6}, {"umat_time"}, {"umat_energies", 3}}};
    static constexpr int stress = table["umat_stress"], strain = table["umat_strain"], time = table["umat_time"],
                         energies = table["umat_energies"], variables = table.size();
};

/// One point. False if it requests a smaller increment (PNEWDT below 1). eqs. (3.126)-(3.128)
class Umat {
  public:
    Umat(UmatFunction* function, const ForeignTraits& traits) : function_(function), traits_(traits) {
        name_.fill(' ');
        std::copy_n(traits.name.begin(), std::min(traits.name.size(), name_.size()), name_.begin());
        variables_ = static_cast<int>(traits.law.initial.size()) - UmatState::variables;
    }

    bool operator()(const FunctionArguments& at, int q, const FunctionAnswer& out) const {
        const std::size_t size = traits_.law.initial.size();
        double* state = out.trial + size * q;
        std::copy_n(at.state + size * q, size, state);
        std::array<double, 6> strain, change, expansion{}, coupling{};
        GuardedAnswer& guarded = GuardedAnswer::of_thread();
        double *stress = guarded.stress.reset(6), *tangent = guarded.tangent.reset(36);
        double* variables = guarded.state.reset(variables_);
        std::copy_n(state + UmatState::variables, variables_, variables);
        for (int p = 0; p < 6; ++p) {
            const int from = order[p];
            stress[p] = state[UmatState::stress + from];
            strain[p] = state[UmatState::strain + from];
            change[p] = at.E[q][from] - strain[p];
        }
        // A converged state is evaluated with a tiny time increment: zero rates stay finite, and nothing relaxes.
        const double before = state[UmatState::time], step = at.step > 0.0 ? at.step : 1e-30;
        const std::array<double, 2> time{before, before};
        const std::array<int, 4> jstep{1, 1, 0, 0};
        const std::array<double, 9> identity{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
        const std::array<double, 3> nowhere{};
        const int ndi = 3, nshr = 3, ntens = 6, one = 1, nprops = static_cast<int>(traits_.properties.size());
        const int noel = at.cell + 1, npt = q + 1, kinc = before > 0.0 ? 2 : 1;
        const double zero = 0.0;
        double rpl = 0.0, drpldt = 0.0, pnewdt = 1.0;
        double* energies = state + UmatState::energies;
        function_(stress, variables, tangent, energies, energies + 1, energies + 2, &rpl, expansion.data(),
                  coupling.data(), &drpldt, strain.data(), change.data(), time.data(), &step, &zero, &zero, &zero,
                  &zero, name_.data(), &ndi, &nshr, &ntens, &variables_, traits_.properties.data(), &nprops,
                  nowhere.data(), identity.data(), &pnewdt, &at.size, identity.data(), identity.data(), &noel, &npt,
                  &one, &one, jstep.data(), &kinc, name_.size());
        guarded.require_intact(traits_.name, at.cell, q);
        std::copy_n(variables, variables_, state + UmatState::variables);
        for (int p = 0; p < 6; ++p) {
            out.S[q][order[p]] = state[UmatState::stress + order[p]] = stress[p];
            state[UmatState::strain + order[p]] = at.E[q][order[p]];
            for (int r = 0; r < 6; ++r) out.CC[q](order[p], order[r]) = tangent[6 * r + p];  // columns come first
        }
        state[UmatState::time] = before + at.step;
        return !(pnewdt < 1.0);
    }

  private:
    /// Abaqus has 11 22 33 12 13 23.
    static constexpr std::array<int, 6> order{0, 1, 2, 3, 5, 4};

    UmatFunction* function_;
    ForeignTraits traits_;
    std::array<char, 80> name_;
    int variables_;
};

/// With `energies` its SSE is the elastic energy, SPD and SCD are the plastic work; else they are not known.
inline std::shared_ptr<Material> umat_law(UmatFunction* function, bool energies, const ForeignTraits& traits) {
    const Gate gate(traits.parallel);
    const Umat umat(function, traits);
    auto call = [=](const FunctionArguments& at, const FunctionAnswer& out) {
        const int done = gate.pass([&] {
            int q = 0;
            while (q < at.n && umat(at, q, out)) ++q;
            return q;
        });
        if (done == at.n) require_sound(traits, at, out);
        return done;
    };
    MaterialFromFunction::EnergyFunction known;
    if (energies)
        known = [size = traits.law.initial.size()](int n, const Voigt*, const double* state, Energy* out,
                                                   std::int32_t) {
            for (int q = 0; q < n; ++q) {
                const double* kept = state + size * q + UmatState::energies;
                out[q] = {kept[0], kept[1] + kept[2]};
            }
        };
    return std::make_shared<MaterialFromFunction>(std::move(call), traits.law, std::move(known));
}

}  // namespace umform
