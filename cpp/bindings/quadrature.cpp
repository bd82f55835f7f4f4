#include "umform/elements/quadrature.hpp"

#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>

#include "arrays.hpp"
#include "umform/elements/topology.hpp"

using namespace umform;

namespace {

nb::object rule_to_numpy(const Rule& rule) {
    const std::size_t n = rule.x.size();
    return nb::make_tuple(to_numpy(rule.x, {n}), to_numpy(rule.w, {n}));
}

template <int Nodes>
nb::object shell_functions(const Input& points) {
    const std::size_t count = points.shape(0);
    std::vector<double> N, dN;
    for (std::size_t q = 0; q < count; ++q) {
        const double *p = points.data() + 3 * q, r = p[0], s = p[1], t = p[2];
        const auto value = shell_shape<Nodes>(r, s, t);
        const auto slope = shell_gradient<Nodes>(r, s, t);
        N.insert(N.end(), value.begin(), value.end());
        for (const auto& row : slope) dN.insert(dN.end(), row.begin(), row.end());
    }
    return nb::make_tuple(to_numpy(std::move(N), {count, Nodes}), to_numpy(std::move(dN), {count, 3, Nodes}));
}

}  // namespace

void bind_quadrature(nb::module_& m) {
    m.def(
        "gauss", [](int n) { return rule_to_numpy(gauss(n)); }, nb::arg("n"),
        nb::sig("def gauss(n: int) -> tuple[NDArray[float64], NDArray[float64]]"),
        "Gauss rule of n points on [-1, 1]: abscissae and weights.");
    m.def(
        "lobatto", [](int n) { return rule_to_numpy(lobatto(n)); }, nb::arg("n"),
        nb::sig("def lobatto(n: int) -> tuple[NDArray[float64], NDArray[float64]]"),
        "Gauss-Lobatto rule of n points on [-1, 1]: abscissae and weights.");
    m.def(
        "split", [](int n) { return rule_to_numpy(split(n)); }, nb::arg("n"),
        nb::sig("def split(n: int) -> tuple[NDArray[float64], NDArray[float64]]"),
        "Gauss rule of n/2 points on each half of [-1, 1]: abscissae and weights.");
    m.def(
        "shell_functions",
        [](int nodes, const Input& points) {
            if (nodes != 8 && nodes != 18) throw std::invalid_argument("a solid-shell has 8 or 18 nodes");
            if (points.ndim() != 2 || points.shape(1) != 3)
                throw std::invalid_argument("points must have shape (count, 3)");
            return nodes == 8 ? shell_functions<8>(points) : shell_functions<18>(points);
        },
        nb::arg("nodes"), nb::arg("points"),
        nb::sig(
            "def shell_functions(nodes: int, points: NDArray[float64]) -> tuple[NDArray[float64], NDArray[float64]]"),
        "Shape functions (count, nodes) and their derivatives (count, 3, nodes) at natural points (count, 3).");
}
