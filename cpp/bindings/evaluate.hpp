// What all blocks share: connectivity and evaluation.
#pragma once

#include <optional>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/tuple.h>

#include "arrays.hpp"
#include "umform/assembly/target.hpp"

inline void require(bool right, const char* what) {
    if (!right) throw std::invalid_argument(what);
}

template <class Block>
const double* nodal(const Block& block, const Input& values) {
    require(values.size() == block.dofs(), "an array over the degrees of freedom has another length than the model");
    return values.data();
}

/// Adds the share of a block to f (and the tangent to values, K du to Kdu, where given); returns (first failed element or -1,
/// sum |f_e|^2, why it has failed).
template <class Block>
std::tuple<int, double, const char*> evaluate(Block& block, const Input& u, const umform::Scatter& scatter, Output f,
                                              std::optional<Output> values, std::optional<Input> du,
                                              std::optional<Output> Kdu) {
    require(f.size() == block.dofs() && (!Kdu || Kdu->size() == block.dofs()),
            "f or Kdu has another length than the model");
    require(!values || values->size() == scatter.entries, "values has another length than the pattern");
    require(du.has_value() == Kdu.has_value(), "du and Kdu belong together");
    const double* position = nodal(block, u);
    const umform::Target target{f.data(), values ? values->data() : nullptr, du ? nodal(block, *du) : nullptr,
                                Kdu ? Kdu->data() : nullptr};
    const nb::gil_scoped_release release;
    const umform::Outcome outcome = block.evaluate(position, scatter, target);
    return {outcome.failed, outcome.force_scale_squared, umform::describe(outcome.failure)};
}

template <class Block>
void bind_common(nb::class_<Block>& type) {
    type.def_prop_ro("connectivity", &Block::connectivity, nb::rv_policy::reference_internal)
        .def_prop_ro("dofs", &Block::dofs, "Degrees of freedom of the model.")
        .def(
            "evaluate", &evaluate<Block>, nb::arg("u"), nb::arg("scatter"), nb::arg("f"), nb::arg("values").none(),
            nb::arg("du").none(), nb::arg("Kdu").none(),
            nb::sig(
                "def evaluate(self, u: NDArray[float64], scatter: Scatter, f: NDArray[float64], values: NDArray[float64] | None, du: NDArray[float64] | None, Kdu: NDArray[float64] | None) -> tuple[int, float, str]"),
            "Add the share of the block to f (and the tangent to values, K du to Kdu, where given); returns the first failed element (or -1), sum |f_e|^2 and why it has failed, in words that follow its number.");
}
