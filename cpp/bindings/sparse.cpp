#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "umform/ordering/sheet_order.hpp"

using namespace umform;

void bind_sparse(nb::module_& m) {
    nb::class_<Connectivity>(m, "Connectivity", "Node ids of the elements of one kind.")
        .def("__len__", &Connectivity::size);
    nb::class_<Scatter>(m, "Scatter", "Map from the element matrices of one kind into a pattern.")
        .def_prop_ro("bytes", [](const Scatter& s) { return s.position.size() * sizeof(s.position[0]); });
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
        .def(
            "scatter",
            [](const Pattern& p, const Connectivity& part) {
                nb::gil_scoped_release release;
                return make_scatter(p, part);
            },
            nb::arg("part"), "The map for the elements of one kind.");
    nb::class_<BlockPattern>(m, "BlockPattern", "Upper triangle in square blocks, one for two neighbouring groups.")
        .def_prop_ro("size", &BlockPattern::size, "Rows of a block.")
        .def_prop_ro(
            "indptr", [](const BlockPattern& p) { return to_numpy(p.indptr(), {p.indptr().size()}); },
            nb::sig("def indptr(self) -> NDArray[int32]"))
        .def_prop_ro(
            "indices", [](const BlockPattern& p) { return to_numpy(p.indices(), {p.indices().size()}); },
            nb::sig("def indices(self) -> NDArray[int32]"))
        .def_prop_ro(
            "place", [](const BlockPattern& p) { return to_numpy(p.place(), {p.place().size()}); },
            nb::sig("def place(self) -> NDArray[int32]"), "Row of each equation; other rows say x = 0.")
        .def(
            "fill",
            [](const BlockPattern& p, const InputIds& indptr, const InputIds& indices, const Input& values,
               const Output& out) {
                nb::gil_scoped_release release;
                p.fill(indptr.data(), indices.data(), values.data(), out.data());
            },
            nb::arg("indptr"), nb::arg("indices"), nb::arg("values"), nb::arg("out"),
            nb::sig("def fill(self, indptr: NDArray[int32], indices: NDArray[int32], values: NDArray[float64], "
                    "out: NDArray[float64]) -> None"),
            "Entries of the blocks from those of the pattern.");
    nb::class_<SheetOrder>(m, "SheetOrder", "Order of elimination of a sheet, from the upper triangle of its pattern.")
        .def(
            "__init__",
            [](SheetOrder* self, const InputIds& indptr, const InputIds& indices) {
                nb::gil_scoped_release release;
                new (self) SheetOrder(indptr.data(), indices.data(), static_cast<int>(indptr.size()) - 1);
            },
            nb::arg("indptr"), nb::arg("indices"),
            nb::sig("def __init__(self, indptr: NDArray[int32], indices: NDArray[int32]) -> None"))
        .def_prop_ro(
            "vertices", [](const SheetOrder& s) { return to_numpy(s.vertices, {s.vertices.size()}); },
            nb::sig("def vertices(self) -> NDArray[int32]"), "Groups in their order; empty if it is no sheet.")
        .def_prop_ro(
            "equations",
            [](const SheetOrder& s) {
                const std::vector<std::int32_t> order = s.equations();
                return to_numpy(order, {order.size()});
            },
            nb::sig("def equations(self) -> NDArray[int32]"), "Equations in their order; empty if it is no sheet.")
        .def_prop_ro("largest", &SheetOrder::largest, "Equations of the largest group.")
        .def(
            "blocks", [](const SheetOrder& s) { return BlockPattern(s.quotient); },
            "The matrix in blocks, one row of them for each group.");
}
