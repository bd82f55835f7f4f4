// A law of the pressure over the gap, of a user: a function of arrays, or a C function.
#pragma once

#include <cmath>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "umform/elements/quadrature.hpp"
#include "umform/materials/foreign.hpp"

namespace umform {

extern "C" {
/// Pressures (zero or more) and their derivatives with respect to the gap at gaps [points]. Returns 0, else it has no answer.
using CompiledPressure = int(int points, const double* gap, const double* properties, double* pressure, double* slope);
}

/// A pressure that is refused, and the run with it.
struct RefusedPressure final : std::exception {
    std::string law, wrong;
    double gap, value;

    RefusedPressure(std::string name, std::string what, double at, double number)
        : law(std::move(name)), wrong(std::move(what)), gap(at), value(number) {}
    const char* what() const noexcept override { return wrong.c_str(); }
};

/// Pressure p(g) >= 0 of a gap up to `reach`, beyond which there is none. eq. (4.280)
class NormalLaw {
  public:
    /// gap [n] -> pressure [n], derivative with respect to the gap [n]
    using Function = std::function<void(int, const double*, double*, double*)>;

    NormalLaw(std::string name, double reach, Function function)
        : name_(std::move(name)), reach_(reach), function_(std::move(function)) {}

    double reach() const { return reach_; }

    void pressures(int n, const double* gap, double* pressure, double* slope) const {
        if (n == 0) return;
        function_(n, gap, pressure, slope);
        for (int i = 0; i < n; ++i) {
            if (!std::isfinite(pressure[i]) || pressure[i] < 0.0)
                throw RefusedPressure(name_, "a contact law must give finite pressures that are not negative", gap[i],
                                      pressure[i]);
            if (!std::isfinite(slope[i]))
                throw RefusedPressure(name_, "a contact law must give a finite derivative of its pressure", gap[i],
                                      slope[i]);
        }
    }

    /// Energy per area, the integral of the pressure from a gap up to the reach, by Gauss points of parts of it. eq. (4.281)
    std::vector<double> energies(int n, const double* gap, int parts) const {
        static const Rule rule = gauss(4);
        const int each = parts * rule.size();
        std::vector<double> at(static_cast<std::size_t>(n) * each), p(at.size()), slope(at.size()), energy(n);
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < each; ++k) at[i * each + k] = gap[i] + place(rule, k, parts) * (reach_ - gap[i]);
        pressures(static_cast<int>(at.size()), at.data(), p.data(), slope.data());
        for (int i = 0; i < n; ++i) {
            if (!(gap[i] < reach_)) continue;
            for (int k = 0; k < each; ++k)
                energy[i] += 0.5 * rule.w[k % rule.size()] / parts * (reach_ - gap[i]) * p[i * each + k];
        }
        return energy;
    }

  private:
    /// Point k of the way from 0 to 1.
    static double place(const Rule& rule, int k, int parts) {
        const int part = k / rule.size();
        return (part + 0.5 * (1.0 + rule.x[k % rule.size()])) / parts;
    }

    std::string name_;
    double reach_;
    Function function_;
};

inline std::shared_ptr<NormalLaw> compiled_normal_law(CompiledPressure* function, const std::string& name,
                                                      std::vector<double> properties, double reach, bool parallel) {
    const Gate gate(parallel);
    auto call = [=, values = std::move(properties)](int n, const double* gap, double* pressure, double* slope) {
        GuardedAnswer& guarded = GuardedAnswer::of_thread();
        double *p = guarded.stress.reset(n), *dp = guarded.tangent.reset(n);
        const int refused = gate.pass([&] { return function(n, gap, values.data(), p, dp); });
        if (!guarded.stress.intact() || !guarded.tangent.intact())
            throw RefusedPressure(name, "a contact law has written beyond its pressures", gap[0], std::nan(""));
        if (refused != 0)
            throw RefusedPressure(name, "a contact law has no answer", gap[0], static_cast<double>(refused));
        std::copy_n(p, n, pressure);
        std::copy_n(dp, n, slope);
    };
    return std::make_shared<NormalLaw>(name, reach, std::move(call));
}

}  // namespace umform
