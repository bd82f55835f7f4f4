#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>

#include "evaluate.hpp"
#include "umform/loads/pressure.hpp"

using namespace umform;

namespace {

std::unique_ptr<PressureBlock> pressure_block(const InputIds& facets, const Input& X) {
    Connectivity part = to_connectivity(facets);
    if (part.nodes == 4) return std::make_unique<PressureBlockOf<4>>(std::move(part), to_vector(X));
    if (part.nodes == 9) return std::make_unique<PressureBlockOf<9>>(std::move(part), to_vector(X));
    throw std::invalid_argument("a facet has 4 or 9 nodes");
}

}  // namespace

void bind_loads(nb::module_& m) {
    auto pressure = nb::class_<PressureBlock>(m, "PressureBlock", "Follower pressure on element faces.");
    bind_common(pressure);
    pressure.def_rw("pressure", &PressureBlock::pressure)
        .def_rw("name", &PressureBlock::name, "For messages.")
        .def_ro_static("symmetric", &PressureBlock::symmetric, "Whether its tangent is symmetric.");
    m.def("pressure_block", &pressure_block, nb::arg("facets"), nb::arg("X"),
          nb::sig("def pressure_block(facets: NDArray[int32], X: NDArray[float64]) -> PressureBlock"));
}
