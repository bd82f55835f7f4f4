#include <optional>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "umform/contact/facets.hpp"
#include "umform/elements/block.hpp"
#include "umform/loads/pressure.hpp"

using namespace umform;

namespace {

Rule to_rule(const Input& x, const Input& w) { return {to_vector(x), to_vector(w)}; }

std::unique_ptr<ShellBlock> shell_block(const Technology& technology, int surface_points, const Input& t,
                                        const Input& w, std::shared_ptr<Material> material,
                                        const InputIds& connectivity, const Input& X) {
    Connectivity part = to_connectivity(connectivity);
    if (part.nodes == 8)
        return std::make_unique<ShellBlockOf<8>>(technology, surface_points, to_rule(t, w), std::move(material),
                                                 std::move(part), to_vector(X));
    if (part.nodes == 18)
        return std::make_unique<ShellBlockOf<18>>(technology, surface_points, to_rule(t, w), std::move(material),
                                                  std::move(part), to_vector(X));
    throw std::invalid_argument("a solid-shell has 8 or 18 nodes");
}

std::unique_ptr<ContactBlock> contact_block(const InputIds& facets, const Input& X, int points, bool at_nodes,
                                            std::shared_ptr<Surface> surface) {
    Connectivity part = to_connectivity(facets);
    const ContactRule rule{points, at_nodes};
    if (part.nodes == 4)
        return std::make_unique<ContactBlockOf<4>>(std::move(part), to_vector(X), rule, std::move(surface));
    if (part.nodes == 9)
        return std::make_unique<ContactBlockOf<9>>(std::move(part), to_vector(X), rule, std::move(surface));
    throw std::invalid_argument("a facet has 4 or 9 nodes");
}

std::unique_ptr<PressureBlock> pressure_block(const InputIds& facets, const Input& X) {
    Connectivity part = to_connectivity(facets);
    if (part.nodes == 4) return std::make_unique<PressureBlockOf<4>>(std::move(part), to_vector(X));
    if (part.nodes == 9) return std::make_unique<PressureBlockOf<9>>(std::move(part), to_vector(X));
    throw std::invalid_argument("a facet has 4 or 9 nodes");
}

void require(bool right, const char* what) {
    if (!right) throw std::invalid_argument(what);
}

template <class Block>
const double* nodal(const Block& block, const Input& values) {
    require(values.size() == block.dofs(), "an array over the degrees of freedom has another length than the model");
    return values.data();
}

/// Adds the share of a block to f and values (and K du to Kdu); returns (first failed element or -1, sum |f_e|^2).
template <class Block>
std::pair<int, double> evaluate(Block& block, const Input& u, const Scatter& scatter, Output f, Output values,
                                std::optional<Input> du, std::optional<Output> Kdu) {
    require(f.size() == block.dofs() && (!Kdu || Kdu->size() == block.dofs()),
            "f or Kdu has another length than the model");
    require(values.size() == scatter.entries, "values has another length than the pattern");
    require(du.has_value() == Kdu.has_value(), "du and Kdu belong together");
    const double* position = nodal(block, u);
    const Target target{f.data(), values.data(), du ? nodal(block, *du) : nullptr, Kdu ? Kdu->data() : nullptr};
    const nb::gil_scoped_release release;
    const Outcome outcome = block.evaluate(position, scatter, target);
    return {outcome.failed, outcome.force_scale_squared};
}

template <class Block>
void bind_common(nb::class_<Block>& type) {
    type.def_prop_ro("connectivity", &Block::connectivity, nb::rv_policy::reference_internal)
        .def(
            "evaluate", &evaluate<Block>, nb::arg("u"), nb::arg("scatter"), nb::arg("f"), nb::arg("values"),
            nb::arg("du").none(), nb::arg("Kdu").none(),
            nb::sig(
                "def evaluate(self, u: NDArray[float64], scatter: Scatter, f: NDArray[float64], values: NDArray[float64], du: NDArray[float64] | None, Kdu: NDArray[float64] | None) -> tuple[int, float]"),
            "Add the share of the block to f and values (and K du to Kdu); returns the first failed element (or -1) and sum |f_e|^2.");
}

nb::object point_fields(ShellBlock& block, const Input& u) {
    const std::size_t elements = block.connectivity().size(), points = block.points(), count = elements * points;
    std::vector<double> E(6 * count), S(6 * count), frame(9 * count), F(9 * count), dV(count);
    block.fields(nodal(block, u), {E.data(), S.data(), frame.data(), F.data(), dV.data()});
    return nb::make_tuple(to_numpy(std::move(E), {elements, points, 6}), to_numpy(std::move(S), {elements, points, 6}),
                          to_numpy(std::move(frame), {elements, points, 3, 3}),
                          to_numpy(std::move(F), {elements, points, 3, 3}),
                          to_numpy(std::move(dV), {elements, points}));
}

nb::object energy(ShellBlock& block, const Input& u) {
    const double* position = nodal(block, u);
    Energy total;
    {
        const nb::gil_scoped_release release;
        total = block.energy(position);
    }
    return nb::make_tuple(total.elastic, total.plastic);
}

nb::object element_matrix(ShellBlock& block, int e, const Input& u) {
    const std::size_t size = 3 * block.connectivity().nodes;
    std::vector<double> K(size * size), f(size);
    require(e >= 0 && e < block.connectivity().size(), "there is no such element");
    block.element(e, nodal(block, u), K.data(), f.data());
    return nb::make_tuple(to_numpy(std::move(K), {size, size}), to_numpy(std::move(f), {size}));
}

}  // namespace

void bind_blocks(nb::module_& m) {
    nb::class_<Tying>(m, "Tying", "One row of an assumed-strain rule.")
        .def(nb::init<int, std::vector<double>, std::vector<double>, bool>(), nb::arg("component"), nb::arg("r"),
             nb::arg("s"), nb::arg("at_layer"));
    nb::class_<Term>(m, "Term", "factor * r^a s^b P_c(t) of an enhanced mode in one covariant component.")
        .def(nb::init<int, double, int, int, int>(), nb::arg("component"), nb::arg("factor"), nb::arg("a"),
             nb::arg("b"), nb::arg("c"));
    nb::class_<Technology>(m, "Technology", "Which strains are tied where, and which are enhanced by what.")
        .def(nb::init<std::vector<Tying>, std::vector<Mode>>(), nb::arg("tying"), nb::arg("modes"));

    auto shell = nb::class_<ShellBlock>(m, "ShellBlock", "All solid-shell elements of one kind with their history.");
    bind_common(shell);
    shell.def_prop_ro("points", &ShellBlock::points)
        .def_prop_ro("modes", &ShellBlock::modes)
        .def_prop_ro("state_size", &ShellBlock::state_size)
        .def(
            "recover", [](ShellBlock& b, const Input& du, double s, bool mixed) { b.recover(nodal(b, du), s, mixed); },
            nb::arg("du"), nb::arg("s"), nb::arg("mixed") = false,
            nb::sig("def recover(self, du: NDArray[float64], s: float, mixed: bool = False) -> None"),
            "Update the enhanced parameters after u += s du; mixed: the geometric stiffness is of the foreseen stress.")
        .def("undo_recover", &ShellBlock::undo_recover, "Take the last recover back.")
        .def("commit", &ShellBlock::commit, "Make the trial history the converged one.")
        .def("revert", &ShellBlock::revert, "Go back to the converged history.")
        .def_prop_ro(
            "state",
            [](const ShellBlock& b) {
                return to_numpy(
                    b.state(), {static_cast<std::size_t>(b.connectivity().size()), static_cast<std::size_t>(b.points()),
                                static_cast<std::size_t>(b.state_size())});
            },
            nb::sig("def state(self) -> NDArray[float64]"), "Converged history (elements, points, state_size).")
        .def_prop_ro(
            "flowing",
            [](const ShellBlock& b) {
                std::vector<std::uint8_t> flows = b.flowing();
                const std::size_t points = flows.size();
                return to_numpy(std::move(flows), {points});
            },
            nb::sig("def flowing(self) -> NDArray[uint8]"),
            "For each point 1 where the last evaluation has changed its history, else 0; empty without a history.")
        .def_prop_ro(
            "alpha",
            [](const ShellBlock& b) {
                return to_numpy(b.alpha(), {static_cast<std::size_t>(b.connectivity().size()),
                                            static_cast<std::size_t>(b.modes())});
            },
            nb::sig("def alpha(self) -> NDArray[float64]"), "Converged enhanced parameters (elements, modes).")
        .def(
            "restore",
            [](ShellBlock& b, const Input& state, const Input& alpha) {
                if (state.size() != b.state().size() || alpha.size() != b.alpha().size())
                    throw std::invalid_argument("state or alpha has another size");
                b.restore(state.data(), alpha.data());
            },
            nb::arg("state"), nb::arg("alpha"),
            nb::sig("def restore(self, state: NDArray[float64], alpha: NDArray[float64]) -> None"),
            "Put a stored history back.")
        .def(
            "point_fields", &point_fields, nb::arg("u"),
            nb::sig(
                "def point_fields(self, u: NDArray[float64]) -> tuple[NDArray[float64], NDArray[float64], NDArray[float64], NDArray[float64], NDArray[float64]]"),
            "E, S (elements, points, 6) in the local frame, the frame and F (elements, points, 3, 3), dV (elements, points).")
        .def(
            "energy", &energy, nb::arg("u"), nb::sig("def energy(self, u: NDArray[float64]) -> tuple[float, float]"),
            "Elastic energy and plastic work of the block at the converged state u; NaN if the law does not know them.")
        .def("element", &element_matrix, nb::arg("e"), nb::arg("u"),
             nb::sig("def element(self, e: int, u: NDArray[float64]) -> tuple[NDArray[float64], NDArray[float64]]"),
             "Condensed K and f of one element.");
    m.def(
        "shell_block", &shell_block, nb::arg("technology"), nb::arg("surface_points"), nb::arg("t"), nb::arg("w"),
        nb::arg("material"), nb::arg("connectivity"), nb::arg("X"),
        nb::sig(
            "def shell_block(technology: Technology, surface_points: int, t: NDArray[float64], w: NDArray[float64], material: Material, connectivity: NDArray[int32], X: NDArray[float64]) -> ShellBlock"));

    auto contact = nb::class_<ContactBlock>(m, "ContactBlock", "Contact of element faces with one rigid tool.");
    bind_common(contact);
    contact.def_rw("penalty", &ContactBlock::penalty)
        .def(
            "set_pose",
            [](ContactBlock& b, const Input& Q, const Input& c) {
                require(Q.size() == 9 && c.size() == 3, "a pose is a matrix Q (3, 3) and a vector c (3,)");
                std::copy_n(Q.data(), 9, b.pose.Q.a.begin());
                std::copy_n(c.data(), 3, b.pose.c.begin());
            },
            nb::arg("Q"), nb::arg("c"), nb::sig("def set_pose(self, Q: NDArray[float64], c: NDArray[float64]) -> None"),
            "Place the tool: x = Q X + c.")
        .def(
            "locate", [](ContactBlock& b, const Input& u) { b.locate(nodal(b, u)); }, nb::arg("u"),
            nb::sig("def locate(self, u: NDArray[float64]) -> None"),
            "Move the contact points to X + u and measure the gaps.")
        .def_prop_ro(
            "shape_values",
            [](const ContactBlock& b) {
                const std::size_t nodes = b.connectivity().nodes;
                std::vector<double> values = b.shape_values();
                const std::size_t points = values.size() / nodes;
                return to_numpy(std::move(values), {points, nodes});
            },
            nb::sig("def shape_values(self) -> NDArray[float64]"),
            "Shape functions at the points of a facet (points, nodes).")
        .def_prop_ro("points", &ContactBlock::points)
        .def_prop_ro(
            "positions", [](const ContactBlock& b) { return to_numpy(b.positions(), {b.gaps().size(), 3}); },
            nb::sig("def positions(self) -> NDArray[float64]"))
        .def_prop_ro(
            "gaps", [](const ContactBlock& b) { return to_numpy(b.gaps(), {b.gaps().size()}); },
            nb::sig("def gaps(self) -> NDArray[float64]"))
        .def_prop_ro(
            "normals", [](const ContactBlock& b) { return to_numpy(b.normals(), {b.gaps().size(), 3}); },
            nb::sig("def normals(self) -> NDArray[float64]"))
        .def_prop_ro(
            "areas", [](const ContactBlock& b) { return to_numpy(b.areas(), {b.areas().size()}); },
            nb::sig("def areas(self) -> NDArray[float64]"))
        .def_prop_ro(
            "round_off_squared", &ContactBlock::round_off_squared,
            "Square of what a relative error 1 of all positions makes of the residual, at the last evaluation.")
        .def_prop_rw(
            "multipliers", [](const ContactBlock& b) { return to_numpy(b.multipliers(), {b.multipliers().size()}); },
            [](ContactBlock& b, const Input& values) {
                require(values.size() == b.multipliers().size(), "there is one multiplier for each contact point");
                b.set_multipliers(values.data());
            },
            nb::for_getter(nb::sig("def multipliers(self) -> NDArray[float64]")),
            nb::for_setter(nb::sig("def multipliers(self, values: NDArray[float64], /) -> None")),
            "Pressures at the contact points that are there without a penetration.");
    m.def(
        "contact_block", &contact_block, nb::arg("facets"), nb::arg("X"), nb::arg("points"), nb::arg("at_nodes"),
        nb::arg("surface"),
        nb::sig(
            "def contact_block(facets: NDArray[int32], X: NDArray[float64], points: int, at_nodes: bool, surface: Surface) -> ContactBlock"));

    auto pressure = nb::class_<PressureBlock>(m, "PressureBlock", "Follower pressure on element faces.");
    bind_common(pressure);
    pressure.def_rw("pressure", &PressureBlock::pressure);
    m.def("pressure_block", &pressure_block, nb::arg("facets"), nb::arg("X"),
          nb::sig("def pressure_block(facets: NDArray[int32], X: NDArray[float64]) -> PressureBlock"));
}
