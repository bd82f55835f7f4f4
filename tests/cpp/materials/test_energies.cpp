// Energies of the laws: remainders of exp and log, integrals of the yield curves, elastic energy on both sides of its switch.
#include "check.hpp"
#include "umform/elements/quadrature.hpp"
#include "umform/materials/function.hpp"
#include "umform/materials/j2.hpp"
#include "umform/materials/neo_hooke_logarithmic.hpp"
#include "umform/materials/neo_hooke_power.hpp"
#include "umform/materials/saint_venant_kirchhoff.hpp"

using namespace umform;

namespace {

/// Against long double, whose digits are enough for the differences away from zero, and against the series at zero.
void check_remainders() {
    for (int k = -200; k <= 200; ++k) {
        const long double z = 0.02L * k + 0.001L;
        const double at = static_cast<double>(z);
        const long double exact = at, exp_exact = (std::expm1(exact) - exact) / (exact * exact);
        CHECK_NEAR(exp_remainder(at) / static_cast<double>(exp_exact), 1.0, 2e-15);
        if (at > -0.99) {
            const auto log_exact = static_cast<double>(exact - std::log1p(exact));
            CHECK_NEAR(log_remainder(at) / log_exact, 1.0, 3e-15);
        }
    }
    for (const double x : {1e-3, 1e-8, 1e-150}) {
        CHECK_NEAR(exp_remainder(x), 0.5 + x / 6.0 + x * x / 24.0 + x * x * x / 120.0, 1e-14);
        CHECK_NEAR(log_remainder(x) / (x * x), 0.5 - x / 3.0 + x * x / 4.0, 1e-9);
    }
    CHECK_NEAR(exp_remainder(0.0), 0.5, 0.0);
    CHECK_NEAR(exp_remainder(-800.0), 799.0 / 640000.0, 1e-17);
    CHECK_NEAR(log_remainder(0.0), 0.0, 0.0);
}

/// By Gauss points between the given places: kinks, or ever longer ways from a steep start.
double integral(const Hardening& hardening, std::vector<double> places, double end) {
    places.push_back(end);
    const Rule rule = gauss(10);
    double sum = 0.0, start = 0.0;
    for (const double place : places) {
        const double stop = std::min(place, end);
        const int parts = 40;
        for (int part = 0; part < parts; ++part)
            for (int q = 0; q < rule.size(); ++q) {
                const double length = (stop - start) / parts;
                const double e = start + length * (part + 0.5 * (1.0 + rule.x[q]));
                sum += 0.5 * rule.w[q] * length * yield_stress(hardening, e).value;
            }
        start = stop;
    }
    return sum;
}

void check_plastic_work() {
    const std::vector<Hardening> smooth{
        LinearVoce{160, 0, 160, 0},    LinearVoce{160, 500, 160, 0},  LinearVoce{160, 0, 320, 15},
        LinearVoce{160, 300, 250, 40}, LinearVoce{160, 0, 320, 1e-9}, Swift{500, 0.004, 0.21},
        Swift{500, 0.5, 0.0},          Swift{500, 1e-3, 1.0},
    };
    const Tabulated table{{0.0, 0.02, 0.1, 0.5}, {160.0, 220.0, 220.0, 400.0}};
    for (const double end : {1e-12, 1e-6, 0.01, 0.02, 0.06, 0.1, 0.3, 0.5, 2.0}) {
        for (const Hardening& hardening : smooth)
            CHECK_NEAR(plastic_work(hardening, end) / integral(hardening, {1e-3, 1e-2, 0.1}, end), 1.0, 1e-12);
        CHECK_NEAR(plastic_work(table, end) / integral(table, {0.02, 0.1, 0.5}, end), 1.0, 1e-12);
    }
    for (const Hardening& hardening : smooth) CHECK_NEAR(plastic_work(hardening, 0.0), 0.0, 0.0);
    CHECK_NEAR(plastic_work(table, 0.0), 0.0, 0.0);
}

/// Principal stretches on the axes: the elastic energy in closed form, by the series and by the roots.
void check_logarithmic_energy() {
    const double kappa = 175e3, mu = 80.77e3;
    const J2 law{kappa, mu, LinearVoce{160, 500, 160, 0}};
    const Vec3 direction{1.0, -0.45, 0.2};
    for (const double size : {1e-13, 1e-8, 1e-4, 2e-3, 0.01, 0.0125, 0.0135, 0.014, 0.02, 0.3}) {
        for (const double metric : {1.0, 1.7}) {  // a plastic stretch of the first axis, at constant volume
            std::array<double, J2::size> state;
            law.initial(state.data());
            state[J2::Metric] = metric, state[J2::Metric + 1] = 1.0 / metric, state[J2::Eqps] = 0.1;
            Voigt E{};
            Vec3 eps;
            for (int i = 0; i < 3; ++i) {
                eps[i] = size * direction[i];
                const double m = state[J2::Metric + i];
                E[i] = 0.5 * (std::expm1(2.0 * eps[i]) / m + (1.0 - m) / m);
            }
            const double trace = eps[0] + eps[1] + eps[2];
            const double expected = 0.5 * kappa * trace * trace + mu * (dot(eps, eps) - trace * trace / 3.0);
            const double round_off = metric == 1.0 ? 1e-13 : 1e-13 + 4e-16 / size;
            const Energy energy = law.energy(E, state.data());
            CHECK_NEAR(energy.elastic / expected, 1.0, round_off);
            CHECK_NEAR(energy.plastic, 16.0 + 2.5, 1e-12);
        }
    }
}

/// All laws are that of Hooke at small strains, and none of them loses digits.
void check_small_strains() {
    const double lambda = 121e3, mu = 80e3, nu = 0.5 * lambda / (lambda + mu);
    const J2 j2{lambda + 2.0 / 3.0 * mu, mu, LinearVoce{1e9, 0, 1e9, 0}};
    std::array<double, 7> virgin;
    j2.initial(virgin.data());
    const Voigt direction{0.3, -0.5, 0.9, 0.4, -0.7, 0.2};
    const double scale = SaintVenantKirchhoff{lambda, mu}.energy(direction, nullptr).elastic;
    for (const double size : {1e-3, 1e-6, 1e-10, 1e-15, 1e-30}) {
        Voigt E = direction;
        for (double& component : E) component *= size;
        const double tolerance = 1e-13 + 10.0 * size;
        const double square = size * size;
        CHECK_NEAR(SaintVenantKirchhoff({lambda, mu}).energy(E, nullptr).elastic / scale / square, 1.0, 1e-14);
        CHECK_NEAR(NeoHookeLogarithmic({lambda, mu}).energy(E, nullptr).elastic / scale / square, 1.0, tolerance);
        CHECK_NEAR(NeoHookePower({mu, nu / (1 - 2 * nu)}).energy(E, nullptr).elastic / scale / square, 1.0, tolerance);
        CHECK_NEAR(j2.energy(E, virgin.data()).elastic / scale / square, 1.0, tolerance);
    }
}

void check_unknown() {
    const Voigt impossible{-0.6, 0, 0, 0, 0, 0};
    std::array<double, 7> virgin;
    const J2 j2{1.0, 1.0, LinearVoce{1, 0, 1, 0}};
    j2.initial(virgin.data());
    CHECK(std::isnan(j2.energy(impossible, virgin.data()).elastic));
    CHECK(std::isnan(NeoHookeLogarithmic({1.0, 1.0}).energy(impossible, nullptr).elastic));
    CHECK(std::isnan(NeoHookePower({1.0, 0.5}).energy(impossible, nullptr).elastic));
    const MaterialFromFunction law([](const FunctionArguments& at, const FunctionAnswer&) { return at.n; }, {},
                                   nullptr);
    std::array<Energy, 2> energies{Energy{1.0, 1.0}, {1.0, 1.0}};
    law.energy(2, &impossible, nullptr, energies.data(), -1);
    for (const Energy& energy : energies) CHECK(std::isnan(energy.elastic) && std::isnan(energy.plastic));
}

}  // namespace

int main() {
    check_remainders();
    check_plastic_work();
    check_logarithmic_energy();
    check_small_strains();
    check_unknown();
    return report("materials");
}
