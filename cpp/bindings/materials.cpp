#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "umform/materials/j2.hpp"
#include "umform/materials/neo_hooke.hpp"
#include "umform/materials/saint_venant_kirchhoff.hpp"

using namespace umform;

namespace {

template <class Law>
std::shared_ptr<Material> material(Law law) {
    return std::make_shared<MaterialOf<Law>>(std::move(law));
}

nb::object respond(const Material& material, const Input& E, const Input& state) {
    const std::size_t n = E.shape(0), size = material.state_size();
    if (E.ndim() != 2 || E.shape(1) != 6 || state.size() != n * size)
        throw std::invalid_argument("E must have shape (n, 6) and state (n, state_size)");
    std::vector<double> S(6 * n), CC(36 * n), trial(n * size);
    const int done =
        material.respond(static_cast<int>(n), reinterpret_cast<const Voigt*>(E.data()), state.data(),
                         reinterpret_cast<Voigt*>(S.data()), reinterpret_cast<Voigt66*>(CC.data()), trial.data());
    if (done != static_cast<int>(n)) throw std::domain_error("the strain is outside of the domain of the law");
    return nb::make_tuple(to_numpy(std::move(S), {n, 6}), to_numpy(std::move(CC), {n, 6, 6}),
                          to_numpy(std::move(trial), {n, size}));
}

nb::object energy(const Material& material, const Input& E, const Input& state) {
    const std::size_t n = E.shape(0);
    if (E.ndim() != 2 || E.shape(1) != 6 || state.size() != n * material.state_size())
        throw std::invalid_argument("E must have shape (n, 6) and state (n, state_size)");
    std::vector<Energy> energies(n);
    material.energy(static_cast<int>(n), reinterpret_cast<const Voigt*>(E.data()), state.data(), energies.data());
    std::vector<double> elastic(n), plastic(n);
    for (std::size_t q = 0; q < n; ++q) {
        elastic[q] = energies[q].elastic;
        plastic[q] = energies[q].plastic;
    }
    return nb::make_tuple(to_numpy(std::move(elastic), {n}), to_numpy(std::move(plastic), {n}));
}

/// Arguments of a user's function at n points: copies of E (n, 6) and state (n, size).
nb::tuple point_arguments(std::size_t n, std::size_t size, const Voigt* E, const double* state) {
    const auto* strain = reinterpret_cast<const double*>(E);
    return nb::make_tuple(to_numpy(std::vector<double>(strain, strain + 6 * n), {n, 6}),
                          to_numpy(std::vector<double>(state, state + size * n), {n, size}));
}

/// A Python function (E (n, 6), state (n, size)) -> (elastic (n,), plastic (n,)), called once for each element.
MaterialFromFunction::EnergyFunction energy_from_function(nb::callable function, std::size_t size) {
    return [function = std::move(function), size](int n, const Voigt* E, const double* state, Energy* energies) {
        const nb::gil_scoped_acquire gil;
        const std::size_t count = n;
        const auto answer = nb::cast<nb::tuple>(function(*point_arguments(count, size, E, state)));
        std::vector<double> elastic(count), plastic(count);
        copy_result(answer[0], elastic.data(), count);
        copy_result(answer[1], plastic.data(), count);
        for (std::size_t q = 0; q < count; ++q) energies[q] = {elastic[q], plastic[q]};
    };
}

/// A Python function (E (n, 6), state (n, size)) -> (S, CC, new state), called once for each element.
std::shared_ptr<Material> material_from_function(nb::callable function, std::vector<double> initial,
                                                 std::optional<nb::callable> energy) {
    const std::size_t size = initial.size();
    auto call = [function, size](int n, const Voigt* E, const double* state, Voigt* S, Voigt66* CC, double* trial) {
        const nb::gil_scoped_acquire gil;
        const std::size_t count = n;
        const auto answer = nb::cast<nb::tuple>(function(*point_arguments(count, size, E, state)));
        copy_result(answer[0], reinterpret_cast<double*>(S), 6 * count);
        copy_result(answer[1], reinterpret_cast<double*>(CC), 36 * count);
        copy_result(answer[2], trial, size * count);
        return n;
    };
    MaterialFromFunction::EnergyFunction energies;
    if (energy) energies = energy_from_function(std::move(*energy), size);
    return std::make_shared<MaterialFromFunction>(std::move(call), std::move(initial), std::move(energies));
}

}  // namespace

void bind_materials(nb::module_& m) {
    nb::class_<Hardening>(m, "Hardening", "Yield stress as a function of the accumulated plastic strain.")
        .def(
            "__call__",
            [](const Hardening& h, double eqps) {
                return nb::make_tuple(yield_stress(h, eqps).value, yield_stress(h, eqps).slope);
            },
            nb::arg("eqps"), nb::sig("def __call__(self, eqps: float) -> tuple[float, float]"),
            "Yield stress and its slope.")
        .def("work", &plastic_work, nb::arg("eqps"), "Integral of the yield stress from 0 to eqps.");
    m.def(
        "linear_voce",
        [](double y0, double modulus, double saturation, double rate) {
            return Hardening(LinearVoce{y0, modulus, saturation, rate});
        },
        nb::arg("y0"), nb::arg("modulus"), nb::arg("saturation"), nb::arg("rate"));
    m.def(
        "swift",
        [](double strength, double offset, double exponent) { return Hardening(Swift{strength, offset, exponent}); },
        nb::arg("strength"), nb::arg("offset"), nb::arg("exponent"));
    m.def(
        "tabulated",
        [](std::vector<double> eqps, std::vector<double> stress) {
            return Hardening(Tabulated{std::move(eqps), std::move(stress)});
        },
        nb::arg("eqps"), nb::arg("stress"));

    nb::class_<Material>(m, "Material", "A material law: strain and history in, stress, tangent and new history out.")
        .def_prop_ro("state_size", &Material::state_size)
        .def(
            "initial",
            [](const Material& law) {
                std::vector<double> state(law.state_size());
                law.initial(state.data());
                const std::size_t size = state.size();
                return to_numpy(std::move(state), {size});
            },
            nb::sig("def initial(self) -> NDArray[float64]"), "History of the virgin material.")
        .def(
            "respond", &respond, nb::arg("E"), nb::arg("state"),
            nb::sig(
                "def respond(self, E: NDArray[float64], state: NDArray[float64]) -> tuple[NDArray[float64], NDArray[float64], NDArray[float64]]"),
            "S (n, 6), CC (n, 6, 6) and the new history at n points.")
        .def(
            "energy", &energy, nb::arg("E"), nb::arg("state"),
            nb::sig(
                "def energy(self, E: NDArray[float64], state: NDArray[float64]) -> tuple[NDArray[float64], NDArray[float64]]"),
            "Elastic energy and plastic work per reference volume at n points, with the history that belongs to E; NaN where not known.");
    m.def(
        "saint_venant_kirchhoff", [](double lambda, double mu) { return material(SaintVenantKirchhoff{lambda, mu}); },
        nb::arg("lambda_"), nb::arg("mu"));
    m.def(
        "neo_hooke_logarithmic", [](double lambda, double mu) { return material(NeoHookeLogarithmic{lambda, mu}); },
        nb::arg("lambda_"), nb::arg("mu"));
    m.def(
        "neo_hooke_power", [](double mu, double beta) { return material(NeoHookePower{mu, beta}); }, nb::arg("mu"),
        nb::arg("beta"));
    m.def(
        "j2", [](double kappa, double mu, const Hardening& hardening) { return material(J2{kappa, mu, hardening}); },
        nb::arg("kappa"), nb::arg("mu"), nb::arg("hardening"));
    m.def(
        "material_from_function", &material_from_function, nb::arg("function"), nb::arg("initial"),
        nb::arg("energy").none(),
        nb::sig(
            "def material_from_function(function: Callable[[NDArray[float64], NDArray[float64]], tuple[NDArray[float64], NDArray[float64], NDArray[float64]]], initial: Sequence[float], energy: Callable[[NDArray[float64], NDArray[float64]], tuple[NDArray[float64], NDArray[float64]]] | None) -> Material"),
        "A law from a function (E (n, 6), state (n, size)) -> (S (n, 6), CC (n, 6, 6), new state (n, size)); its energy -> (elastic (n,), plastic (n,)).");
}
