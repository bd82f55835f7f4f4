#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "umform/dissection.hpp"

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
    m.def(
        "dissect",
        [](const InputIds& indptr, const InputIds& indices) {
            std::vector<std::int32_t> order;
            {
                nb::gil_scoped_release release;
                order = dissect(indptr.data(), indices.data(), static_cast<int>(indptr.size()) - 1);
            }
            const std::size_t size = order.size();
            return to_numpy(std::move(order), {size});
        },
        nb::arg("indptr"), nb::arg("indices"),
        nb::sig("def dissect(indptr: NDArray[int32], indices: NDArray[int32]) -> NDArray[int32]"),
        "Order of elimination of the equations of a sheet, from the upper triangle of their pattern; empty for others.");
}
