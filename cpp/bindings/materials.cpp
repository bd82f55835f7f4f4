#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "umform/materials/function.hpp"
#include "umform/materials/j2.hpp"
#include "umform/materials/neo_hooke_logarithmic.hpp"
#include "umform/materials/neo_hooke_power.hpp"
#include "umform/materials/point_path.hpp"
#include "umform/materials/saint_venant_kirchhoff.hpp"

using namespace umform;

namespace {

template <class Law>
std::shared_ptr<Material> material(Law law) {
    return std::make_shared<MaterialOf<Law>>(std::move(law));
}

/// The axes (3, 3) of all points, or those of the global frame.
Point<double> to_point(const std::optional<Input>& axes, double size, double step) {
    Point<double> point;
    if (axes && axes->size() != 9) throw std::invalid_argument("axes must have shape (3, 3)");
    for (int i = 0; axes && i < 9; ++i) point.axes[i / 3][i % 3] = axes->data()[i];
    point.size = size;
    point.step = step;
    return point;
}

nb::object respond(const Material& material, const Input& E, const Input& state, const std::optional<Input>& axes,
                   double size, double step) {
    const std::size_t n = E.shape(0), numbers = material.state_size();
    if (E.ndim() != 2 || E.shape(1) != 6 || state.size() != n * numbers)
        throw std::invalid_argument("E must have shape (n, 6) and state (n, state_size)");
    std::vector<double> S(6 * n), CC(36 * n), trial(n * numbers);
    const int done = material.respond(static_cast<int>(n), reinterpret_cast<const Voigt*>(E.data()), state.data(),
                                      reinterpret_cast<Voigt*>(S.data()), reinterpret_cast<Voigt66*>(CC.data()),
                                      trial.data(), to_point(axes, size, step));
    if (done != static_cast<int>(n))
        throw std::domain_error("the law has no answer at point " + std::to_string(done)
                                + ": the strain is outside of its domain, or its equations could not be solved");
    return nb::make_tuple(to_numpy(std::move(S), {n, 6}), to_numpy(std::move(CC), {n, 6, 6}),
                          to_numpy(std::move(trial), {n, numbers}));
}

/// Strains (n, 6), stresses (n, 6) and histories of the rows of a path, up to the first that cannot be reached.
nb::object lead(const Material& material, const Input& turn, const Input& strain, const Input& stress,
                const Input& steps, bool finite) {
    const std::size_t n = steps.size(), numbers = material.state_size();
    if (turn.size() != 36 || strain.size() != 6 * n || stress.size() != 6 * n)
        throw std::invalid_argument("turn must have shape (6, 6), strain and stress (n, 6), steps (n,)");
    Voigt66 rotation;
    std::copy_n(turn.data(), 36, rotation.a.begin());
    PointWalk walk(material, rotation, finite);
    PointState at;
    at.history.resize(numbers);
    material.initial(at.history.data());
    std::vector<double> strains, stresses, histories;
    std::size_t reached = 0;
    for (; reached < n; ++reached) {
        PointTarget target;
        std::copy_n(strain.data() + 6 * reached, 6, target.strain.begin());
        std::copy_n(stress.data() + 6 * reached, 6, target.stress.begin());
        target.step = steps.data()[reached];
        if (!walk.reach(at, target)) break;
        strains.insert(strains.end(), at.strain.begin(), at.strain.end());
        stresses.insert(stresses.end(), at.stress.begin(), at.stress.end());
        histories.insert(histories.end(), at.history.begin(), at.history.end());
    }
    return nb::make_tuple(to_numpy(std::move(strains), {reached, 6}), to_numpy(std::move(stresses), {reached, 6}),
                          to_numpy(std::move(histories), {reached, numbers}));
}

nb::object energy(const Material& material, const Input& E, const Input& state) {
    const std::size_t n = E.shape(0);
    if (E.ndim() != 2 || E.shape(1) != 6 || state.size() != n * material.state_size())
        throw std::invalid_argument("E must have shape (n, 6) and state (n, state_size)");
    std::vector<Energy> energies(n);
    material.energy(static_cast<int>(n), reinterpret_cast<const Voigt*>(E.data()), state.data(), energies.data(), -1);
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

/// A Python function (E (n, 6), state (n, size), cell) -> (elastic (n,), plastic (n,)), called once for each element.
MaterialFromFunction::EnergyFunction energy_from_function(nb::callable function, std::size_t size) {
    return [function = std::move(function), size](int n, const Voigt* E, const double* state, Energy* energies,
                                                  std::int32_t cell) {
        const nb::gil_scoped_acquire gil;
        const std::size_t count = n;
        const nb::tuple points = point_arguments(count, size, E, state);
        const auto answer = nb::cast<nb::tuple>(function(points[0], points[1], cell));
        std::vector<double> elastic(count), plastic(count);
        copy_result(answer[0], elastic.data(), count);
        copy_result(answer[1], plastic.data(), count);
        for (std::size_t q = 0; q < count; ++q) energies[q] = {elastic[q], plastic[q]};
    };
}

/// Axes of the points (n, 3, 3), size of the element and step, or None for a law that does not need them.
nb::object context(const FunctionArguments& at) {
    if (at.axes == nullptr) return nb::none();
    const auto* axes = reinterpret_cast<const double*>(at.axes);
    const std::size_t count = at.n;
    return nb::make_tuple(to_numpy(std::vector<double>(axes, axes + 9 * count), {count, 3, 3}), at.size, at.step);
}

/// A Python function (E (n, 6), state (n, size), cell, context) -> (S, CC, new state), called once for each element.
std::shared_ptr<Material> material_from_function(nb::callable function, std::vector<double> initial,
                                                 const std::vector<std::pair<std::string, int>>& state,
                                                 std::optional<nb::callable> energy, bool symmetric, bool sees_points) {
    const std::size_t size = initial.size();
    MaterialFromFunction::Traits traits{{}, std::move(initial), symmetric, sees_points};
    std::size_t named = 0;
    for (const auto& [name, numbers] : state) {
        traits.state.push_back({name, numbers});
        named += numbers;
    }
    if (named != size) throw std::invalid_argument("the names of the history do not have the size of the initial one");
    auto call = [function, size](const FunctionArguments& at, const FunctionAnswer& out) {
        const nb::gil_scoped_acquire gil;
        const std::size_t count = at.n;
        const nb::tuple points = point_arguments(count, size, at.E, at.state);
        const auto answer = nb::cast<nb::tuple>(function(points[0], points[1], at.cell, context(at)));
        copy_result(answer[0], reinterpret_cast<double*>(out.S), 6 * count);
        copy_result(answer[1], reinterpret_cast<double*>(out.CC), 36 * count);
        copy_result(answer[2], out.trial, size * count);
        return at.n;
    };
    MaterialFromFunction::EnergyFunction energies;
    if (energy) energies = energy_from_function(std::move(*energy), size);
    return std::make_shared<MaterialFromFunction>(std::move(call), std::move(traits), std::move(energies));
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
        .def_prop_ro(
            "history_variables", [](const Material& law) { return to_dict(law.history_variables()); },
            nb::sig("def history_variables(self) -> dict[str, int]"),
            "Parts of the history of a point, in their order.")
        .def_prop_ro("symmetric", &Material::symmetric, "Whether the tangent is symmetric at any strain.")
        .def_prop_ro("sees_points", &Material::sees_points, "Whether the law asks for axes, size and step.")
        .def_prop_ro("staged_returns", &Material::staged_returns,
                     "Points at which its return map has gone through stages of a shrinking yield surface so far.")
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
            "respond", &respond, nb::arg("E"), nb::arg("state"), nb::arg("axes") = nb::none(), nb::arg("size") = 0.0,
            nb::arg("step") = 0.0,
            nb::sig(
                "def respond(self, E: NDArray[float64], state: NDArray[float64], axes: NDArray[float64] | None = None, size: float = 0.0, step: float = 0.0) -> tuple[NDArray[float64], NDArray[float64], NDArray[float64]]"),
            "S (n, 6), CC (n, 6, 6) and the new history at n points with the same axes (3, 3), size and step.")
        .def(
            "lead", &lead, nb::arg("turn"), nb::arg("strain"), nb::arg("stress"), nb::arg("steps"),
            nb::arg("finite") = false,
            nb::sig(
                "def lead(self, turn: NDArray[float64], strain: NDArray[float64], stress: NDArray[float64], steps: NDArray[float64], finite: bool = False) -> tuple[NDArray[float64], NDArray[float64], NDArray[float64]]"),
            "A law of logarithmic strains, or of Green-Lagrange strains (finite), along a path of logarithmic strains (n, 6), NaN where the stress is prescribed: strains, stresses, histories behind the rows up to the first that cannot be reached.")
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
        "material_from_function", &material_from_function, nb::arg("function"), nb::arg("initial"), nb::arg("state"),
        nb::arg("energy").none(), nb::arg("symmetric"), nb::arg("sees_points"),
        nb::sig(
            "def material_from_function(function: Callable[[NDArray[float64], NDArray[float64], int, tuple[NDArray[float64], float, float] | None], tuple[NDArray[float64], NDArray[float64], NDArray[float64]]], initial: Sequence[float], state: Sequence[tuple[str, int]], energy: Callable[[NDArray[float64], NDArray[float64], int], tuple[NDArray[float64], NDArray[float64]]] | None, symmetric: bool, sees_points: bool) -> Material"),
        "A law from a function (E (n, 6), state (n, size), cell, (axes (n, 3, 3), size, step) or None) -> (S (n, 6), CC (n, 6, 6), new state (n, size)); its energy (E, state, cell) -> (elastic (n,), plastic (n,)).");
}
