#include <nanobind/stl/array.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include "evaluate.hpp"
#include "umform/contact/sheets/crossing.hpp"
#include "umform/contact/sheets/half_pass.hpp"

using namespace umform;

namespace {

using Near = std::vector<std::vector<std::int32_t>>;
using EdgesAt = std::vector<std::array<std::int32_t, 2>>;

template <int Nodes>
std::unique_ptr<SheetPass> pass_of(const InputIds& facets, const InputIds& others, CutEdges edges, const Input& X,
                                   const SurfacePoints& points, int cells, SheetSetting setting, Near near) {
    const Connectivity part = to_connectivity(facets), other = to_connectivity(others);
    require(edges.nodes.nodes == 2 * Rim<Nodes>::count, "a cut edge has 4 nodes, with 9 nodes a facet 6");
    if (cells > 0)
        return std::make_unique<HalfPass<Nodes, FacetCells>>(part, other, std::move(edges), to_vector(X),
                                                             CellSetting{cells}, std::move(setting), std::move(near));
    return std::make_unique<HalfPass<Nodes, FacetPoints>>(
        part, other, std::move(edges), to_vector(X), ContactRule{points, false}, std::move(setting), std::move(near));
}

std::unique_ptr<SheetPass> sheet_pass(const InputIds& facets, const InputIds& others, const InputIds& edges, EdgesAt at,
                                      const Input& X, const SurfacePoints& points, int cells, double penalty,
                                      double deepest, double highest, Near near, std::shared_ptr<FrictionLaw> friction,
                                      double stiffness) {
    SheetSetting setting;
    setting.penalty = penalty, setting.deepest = deepest, setting.highest = highest;
    setting.friction = {std::move(friction), stiffness};
    require(facets.shape(1) == others.shape(1), "both faces have facets of one kind");
    require(edges.shape(0) == at.size(), "each cut edge has a facet and a side");
    CutEdges cut{to_connectivity(edges), std::move(at)};
    for (const auto& [facet, side] : cut.at)
        require(facet >= 0 && static_cast<std::size_t>(facet) < others.shape(0) && side >= 0 && side < 4,
                "a cut edge has a facet of the other face, and one of its four sides");
    if (facets.shape(1) == 4)
        return pass_of<4>(facets, others, std::move(cut), X, points, cells, std::move(setting), std::move(near));
    if (facets.shape(1) == 9)
        return pass_of<9>(facets, others, std::move(cut), X, points, cells, std::move(setting), std::move(near));
    throw std::invalid_argument("a facet has 4 or 9 nodes");
}

double evaluate_pass(SheetPass& pass, const Input& u, const Pattern& pattern, Output f, std::optional<Output> values,
                     std::optional<Input> du, std::optional<Output> Kdu) {
    require(f.size() == pass.dofs() && (!Kdu || Kdu->size() == pass.dofs()),
            "f or Kdu has another length than the model");
    require(!values || values->size() == pattern.indices.size(), "values has another length than the pattern");
    require(du.has_value() == Kdu.has_value(), "du and Kdu belong together");
    const double* position = nodal(pass, u);
    const Target target{f.data(), values ? values->data() : nullptr, du ? nodal(pass, *du) : nullptr,
                        Kdu ? Kdu->data() : nullptr};
    const nb::gil_scoped_release release;
    return pass.evaluate(position, pattern, target).force_scale_squared;
}

nb::object vectors(const std::vector<Vec3>& values) {
    std::vector<double> flat;
    flat.reserve(3 * values.size());
    for (const Vec3& v : values) flat.insert(flat.end(), v.begin(), v.end());
    return to_numpy(std::move(flat), {values.size(), 3});
}

nb::dict found(const SheetPass& pass) {
    const SheetFound all = pass.found();
    nb::dict values;
    values["status"] = to_numpy(all.status, {all.status.size()});
    values["facet"] = to_numpy(all.facet, {all.facet.size()});
    values["gap"] = to_numpy(all.gap, {all.gap.size()});
    values["pressure"] = to_numpy(all.pressure, {all.pressure.size()});
    values["slip"] = to_numpy(all.slip, {all.slip.size()});
    values["x"] = vectors(all.x);
    values["normal"] = vectors(all.normal);
    values["traction"] = vectors(all.traction);
    values["contact_energy"] = all.contact_energy;
    values["stored"] = all.stored;
    values["friction_work"] = all.friction_work;
    values["penetration"] = all.penetration;
    values["round_off_squared"] = all.round_off_squared;
    return values;
}

Motion motion_of(const Input& before, const Input& now) {
    require(before.size() == now.size(), "two states have the same nodes");
    Motion motion{std::vector<Vec3>(before.size() / 3), std::vector<Vec3>(now.size() / 3)};
    for (std::size_t i = 0; i < before.size(); ++i)
        motion.before[i / 3][i % 3] = before.data()[i], motion.now[i / 3][i % 3] = now.data()[i];
    return motion;
}

nb::tuple sheet_crossings(const InputIds& facets, const std::array<Input, 2>& x, const InputIds& others,
                          const std::array<Input, 2>& y, double deepest) {
    require(facets.shape(1) == others.shape(1), "both faces have facets of one kind");
    const Connectivity part = to_connectivity(facets), other = to_connectivity(others);
    const Motion one = motion_of(x[0], x[1]), two = motion_of(y[0], y[1]);
    const auto all = facets.shape(1) == 4 ? crossings<4>(part, one, other, two, deepest)
                                          : crossings<9>(part, one, other, two, deepest);
    std::vector<Vec3> places;
    std::vector<double> depths;
    for (const Crossing& crossing : all) places.push_back(crossing.x), depths.push_back(crossing.depth);
    return nb::make_tuple(vectors(places), to_numpy(std::move(depths), {all.size()}));
}

}  // namespace

void bind_sheets(nb::module_& m) {
    nb::class_<SheetPass>(m, "SheetPass", "Contact points of one face against the facets of another that deforms.")
        .def_rw("name", &SheetPass::name, "For messages.")
        .def_prop_ro("dofs", &SheetPass::dofs, "Degrees of freedom of the model.")
        .def_prop_ro("symmetric", &SheetPass::symmetric, "Whether its tangent is symmetric.")
        .def_prop_ro("points", &SheetPass::points)
        .def_prop_ro("per_facet", &SheetPass::per_facet, "Contact points of each facet.")
        .def_prop_ro(
            "areas", [](const SheetPass& p) { return to_numpy(p.areas(), {p.areas().size()}); },
            nb::sig("def areas(self) -> NDArray[float64]"), "Reference areas of the points.")
        .def_prop_rw(
            "penalty", [](const SheetPass& p) { return p.setting.penalty; },
            [](SheetPass& p, double value) { p.setting.penalty = value; }, "Pressure per penetration.")
        .def(
            "search",
            [](SheetPass& p, const Input& u, double way, double turn) {
                const double* position = nodal(p, u);
                const nb::gil_scoped_release release;
                p.search(position, way, turn);
            },
            nb::arg("u"), nb::arg("way"), nb::arg("turn"),
            nb::sig("def search(self, u: NDArray[float64], way: float, turn: float) -> None"),
            "Find the facets that each facet may meet while no node moves farther than a way and no facet turns farther.")
        .def(
            "moved_since_search",
            [](SheetPass& p, const Input& u) {
                const double* position = nodal(p, u);
                const nb::gil_scoped_release release;
                return p.moved_since_search(position);
            },
            nb::arg("u"), nb::sig("def moved_since_search(self, u: NDArray[float64]) -> list[float]"),
            "Largest way of a node of both faces and largest turn of a facet since the search, infinite before the first one.")
        .def("couplings", &SheetPass::couplings,
             "Pairs of nodes that its tangent couples, as the last search found them.")
        .def(
            "evaluate", &evaluate_pass, nb::arg("u"), nb::arg("pattern"), nb::arg("f"), nb::arg("values").none(),
            nb::arg("du").none(), nb::arg("Kdu").none(),
            nb::sig(
                "def evaluate(self, u: NDArray[float64], pattern: Pattern, f: NDArray[float64], values: NDArray[float64] | None, du: NDArray[float64] | None, Kdu: NDArray[float64] | None) -> float"),
            "Add forces to f (and the tangent to values, K du to Kdu, where given); returns the sum of the squares of the forces.")
        .def("found", &found, nb::sig("def found(self) -> dict[str, object]"),
             "Results of the last evaluation, as copies.")
        .def_prop_ro(
            "history_variables", [](SheetPass& p) { return to_dict(p.history().history_variables()); },
            nb::sig("def history_variables(self) -> dict[str, int]"),
            "Parts of the history of a point, in their order.")
        .def_prop_ro(
            "state",
            [](SheetPass& p) {
                return to_numpy(p.history().state(),
                                {static_cast<std::size_t>(p.points()), static_cast<std::size_t>(p.history().size())});
            },
            nb::sig("def state(self) -> NDArray[float64]"), "Converged history (points, size).")
        .def_prop_rw(
            "augmented", [](const SheetPass& p) { return p.setting.augmented; },
            [](SheetPass& p, bool value) { p.setting.augmented = value; },
            "Whether multipliers carry pressure without penetration.")
        .def_prop_rw(
            "multipliers",
            [](const SheetPass& p) {
                std::vector<double> values(static_cast<std::size_t>(p.points()));
                for (int q = 0; q < p.points(); ++q) values[q] = p.multiplier(q);
                return to_numpy(std::move(values), {static_cast<std::size_t>(p.points())});
            },
            [](SheetPass& p, const Input& values) {
                require(values.size() == static_cast<std::size_t>(p.points()),
                        "there is one multiplier for each point");
                p.set_multipliers(values.data());
            },
            nb::for_getter(nb::sig("def multipliers(self) -> NDArray[float64]")),
            nb::for_setter(nb::sig("def multipliers(self, values: NDArray[float64], /) -> None")),
            "Pressures at zero penetration: of the converged state, or what was set since then.")
        .def_prop_ro(
            "shape_values",
            [](const SheetPass& p) {
                std::vector<double> values = p.shape_values();
                const std::size_t nodes = p.nodes(), points = p.per_facet();
                const std::size_t facets = values.size() / (nodes * points);
                return to_numpy(std::move(values), {facets, points, nodes});
            },
            nb::sig("def shape_values(self) -> NDArray[float64]"),
            "Shape functions (1 or facets, points, nodes) of this face at its points.")
        .def("commit", &SheetPass::commit, "Make the trial history the converged one.")
        .def("revert", &SheetPass::revert, "Go back to the converged history.")
        .def(
            "restore", [](SheetPass& p, const Input& state) { p.restore(state.data(), state.size()); },
            nb::arg("state"), nb::sig("def restore(self, state: NDArray[float64]) -> None"),
            "Put a stored history back.");
    m.def(
        "sheet_crossings", &sheet_crossings, nb::arg("facets"), nb::arg("x"), nb::arg("others"), nb::arg("y"),
        nb::arg("deepest"),
        nb::sig(
            "def sheet_crossings(facets: NDArray[int32], x: tuple[NDArray[float64], NDArray[float64]], others: NDArray[int32], y: tuple[NDArray[float64], NDArray[float64]], deepest: float) -> tuple[NDArray[float64], NDArray[float64]]"),
        "Places and depths (one for each facet) where a face goes through another, farther than deepest, from the first to the second positions of both.");
    m.def(
        "sheet_pass", &sheet_pass, nb::arg("facets"), nb::arg("others"), nb::arg("edges"), nb::arg("at"), nb::arg("X"),
        nb::arg("points"), nb::arg("cells"), nb::arg("penalty"), nb::arg("deepest"), nb::arg("highest"),
        nb::arg("near"), nb::arg("friction").none(), nb::arg("stiffness"),
        nb::sig(
            "def sheet_pass(facets: NDArray[int32], others: NDArray[int32], edges: NDArray[int32], at: Sequence[Sequence[int]], X: NDArray[float64], points: tuple[int, int], cells: int, penalty: float, deepest: float, highest: float, near: Sequence[Sequence[int]], friction: FrictionLaw | None, stiffness: float) -> SheetPass"),
        "A half pass, over cells x cells cells of each facet, or at Gauss points where cells is 0. `edges` are the nodes of "
        "cut edges of the other face, then those across the thickness; `at` their facets and sides there.");
}
