#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/unique_ptr.h>

#include "evaluate.hpp"
#include "umform/contact/facets.hpp"

using namespace umform;

namespace {

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

}  // namespace

void bind_contact(nb::module_& m) {
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
}
