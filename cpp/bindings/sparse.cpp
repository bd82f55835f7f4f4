#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "umform/assembly/scatter.hpp"
#include "umform/ordering/sheet_order.hpp"

using namespace umform;

namespace {

/// Adds matrices of all elements, whose degrees of freedom are in the order 3 * node + direction.
void add_matrices(const Scatter& scatter, const Input& matrices, const Output& values) {
    const std::size_t size = scatter.size, nodes = size / 3;
    if (matrices.ndim() != 3 || matrices.shape(0) != static_cast<std::size_t>(scatter.elements())
        || matrices.shape(1) != size || matrices.shape(2) != size)
        throw std::invalid_argument("matrices must have shape (elements, 3 nodes, 3 nodes)");
    if (values.size() != scatter.entries) throw std::invalid_argument("values has another length than the pattern");
    std::vector<double> K(size * size);
    const auto local = [nodes](std::size_t i) { return i % 3 * nodes + i / 3; };
    for (int e = 0; e < scatter.elements(); ++e) {
        const double* given = matrices.data() + e * size * size;
        for (std::size_t i = 0; i < size; ++i)
            for (std::size_t j = 0; j < size; ++j) K[local(i) * size + local(j)] = given[i * size + j];
        scatter.add(e, K.data(), values.data());
    }
}

}  // namespace

void bind_sparse(nb::module_& m) {
    nb::class_<Connectivity>(m, "Connectivity", "Node ids of the elements of one kind: what a term couples.")
        .def(
            "__init__",
            [](Connectivity* self, const InputIds& ids) {
                if (ids.ndim() != 2) throw std::invalid_argument("ids must have shape (elements, nodes)");
                new (self) Connectivity(to_connectivity(ids));
            },
            nb::arg("ids"), nb::sig("def __init__(self, ids: NDArray[int32]) -> None"))
        .def_prop_ro(
            "ids",
            [](const Connectivity& c) {
                return to_numpy(c.ids, {static_cast<std::size_t>(c.size()), static_cast<std::size_t>(c.nodes)});
            },
            nb::sig("def ids(self) -> NDArray[int32]"), "Node ids (elements, nodes).")
        .def("__len__", &Connectivity::size);
    nb::class_<Scatter>(m, "Scatter", "Map from the element matrices of one kind into a pattern.")
        .def_ro("symmetric", &Scatter::symmetric)
        .def("require", &Scatter::require, nb::arg("symmetric_tangent"), nb::arg("term"),
             "Refuse a tangent that is not symmetric, by the name of its term, if the pattern holds one triangle only.")
        .def(
            "add", &add_matrices, nb::arg("matrices"), nb::arg("values"),
            nb::sig("def add(self, matrices: NDArray[float64], values: NDArray[float64]) -> None"),
            "Add matrices (elements, 3 nodes, 3 nodes), in the order 3 * node + direction, to the entries of the pattern.")
        .def_prop_ro("bytes", &Scatter::bytes);
    nb::class_<Pattern>(m, "Pattern", "Sparse pattern over the free degrees of freedom (upper triangle if symmetric).")
        .def(
            "__init__",
            [](Pattern* self, const InputIds& equation, const std::vector<const Connectivity*>& parts, bool symmetric) {
                nb::gil_scoped_release release;
                new (self)
                    Pattern(make_pattern({equation.data(), equation.data() + equation.size()}, parts, symmetric));
            },
            nb::arg("equation"), nb::arg("parts"), nb::arg("symmetric"),
            nb::sig(
                "def __init__(self, equation: NDArray[int32], parts: Sequence[Connectivity], symmetric: bool) -> None"))
        .def_prop_ro(
            "indptr", [](const Pattern& p) { return to_numpy(p.indptr, {p.indptr.size()}); },
            nb::sig("def indptr(self) -> NDArray[int64]"))
        .def_prop_ro(
            "indices", [](const Pattern& p) { return to_numpy(p.indices, {p.indices.size()}); },
            nb::sig("def indices(self) -> NDArray[int32]"))
        .def_ro("symmetric", &Pattern::symmetric)
        .def("find", &Pattern::find, nb::arg("row"), nb::arg("column"),
             "Position of an entry; IndexError for a pair that is not in the pattern.")
        .def(
            "scatter",
            [](const Pattern& p, const Connectivity& part) {
                nb::gil_scoped_release release;
                return make_scatter(p, part);
            },
            nb::arg("part"), "The map for the elements of one kind.");
    nb::class_<ordering::BlockPattern>(m, "BlockPattern",
                                       "Upper triangle in square blocks, one for two neighbouring groups.")
        .def_prop_ro("size", &ordering::BlockPattern::size, "Rows of a block.")
        .def_prop_ro(
            "indptr", [](const ordering::BlockPattern& p) { return to_numpy(p.indptr(), {p.indptr().size()}); },
            nb::sig("def indptr(self) -> NDArray[int32]"))
        .def_prop_ro(
            "indices", [](const ordering::BlockPattern& p) { return to_numpy(p.indices(), {p.indices().size()}); },
            nb::sig("def indices(self) -> NDArray[int32]"))
        .def_prop_ro(
            "place", [](const ordering::BlockPattern& p) { return to_numpy(p.place(), {p.place().size()}); },
            nb::sig("def place(self) -> NDArray[int32]"), "Row of each equation; other rows say x = 0.")
        .def(
            "fill",
            [](const ordering::BlockPattern& p, const InputIds& indptr, const InputIds& indices, const Input& values,
               const Output& out) {
                nb::gil_scoped_release release;
                p.fill(indptr.data(), indices.data(), values.data(), out.data());
            },
            nb::arg("indptr"), nb::arg("indices"), nb::arg("values"), nb::arg("out"),
            nb::sig("def fill(self, indptr: NDArray[int32], indices: NDArray[int32], values: NDArray[float64], "
                    "out: NDArray[float64]) -> None"),
            "Entries of the blocks from those of the pattern.");
    nb::class_<ordering::SheetOrder>(m, "SheetOrder",
                                     "Order of elimination of a sheet, from the upper triangle of its pattern.")
        .def(
            "__init__",
            [](ordering::SheetOrder* self, const InputIds& indptr, const InputIds& indices) {
                nb::gil_scoped_release release;
                new (self) ordering::SheetOrder(indptr.data(), indices.data(), static_cast<int>(indptr.size()) - 1);
            },
            nb::arg("indptr"), nb::arg("indices"),
            nb::sig("def __init__(self, indptr: NDArray[int32], indices: NDArray[int32]) -> None"))
        .def_prop_ro(
            "vertices", [](const ordering::SheetOrder& s) { return to_numpy(s.vertices, {s.vertices.size()}); },
            nb::sig("def vertices(self) -> NDArray[int32]"), "Groups in their order; empty if it is no sheet.")
        .def_prop_ro(
            "equations",
            [](const ordering::SheetOrder& s) {
                const std::vector<std::int32_t> order = s.equations();
                return to_numpy(order, {order.size()});
            },
            nb::sig("def equations(self) -> NDArray[int32]"), "Equations in their order; empty if it is no sheet.")
        .def_prop_ro("largest", &ordering::SheetOrder::largest, "Equations of the largest group.")
        .def(
            "blocks", [](const ordering::SheetOrder& s) { return ordering::BlockPattern(s.quotient); },
            "The matrix in blocks, one row of them for each group.");
}
