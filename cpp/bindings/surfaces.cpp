#include <nanobind/stl/array.h>
#include <nanobind/stl/shared_ptr.h>

#include "arrays.hpp"
#include "umform/surfaces/cylinder.hpp"
#include "umform/surfaces/plane.hpp"
#include "umform/surfaces/sphere.hpp"

using namespace umform;

namespace {

template <class Shape>
std::shared_ptr<Surface> surface(Shape shape) {
    return std::make_shared<SurfaceOf<Shape>>(shape);
}

/// A Python function x (n, 3) -> (g, n, H), called once for all contact points of a pair.
std::shared_ptr<Surface> surface_from_function(nb::callable function) {
    return std::make_shared<SurfaceFromFunction>(
        [function](int count, const double* x, double* g, double* n, double* H) {
            const nb::gil_scoped_acquire gil;
            const std::size_t size = count;
            const nb::object answer = function(to_numpy(std::vector<double>(x, x + 3 * size), {size, 3}));
            const auto parts = nb::cast<nb::tuple>(answer);
            copy_result(parts[0], g, size), copy_result(parts[1], n, 3 * size), copy_result(parts[2], H, 9 * size);
        });
}

nb::object gap(const Surface& surface, const Input& x) {
    if (x.ndim() != 2 || x.shape(1) != 3) throw std::invalid_argument("x must have shape (n, 3)");
    const std::size_t count = x.shape(0);
    std::vector<double> g(count), n(3 * count), H(9 * count);
    surface.gap(static_cast<int>(count), x.data(), g.data(), n.data(), H.data());
    return nb::make_tuple(to_numpy(std::move(g), {count}), to_numpy(std::move(n), {count, 3}),
                          to_numpy(std::move(H), {count, 3, 3}));
}

}  // namespace

void bind_surfaces(nb::module_& m) {
    nb::class_<Surface>(m, "Surface", "A rigid tool: signed distance, normal and Hessian as functions of position.")
        .def("gap", &gap, nb::arg("x"),
             nb::sig(
                 "def gap(self, x: NDArray[float64]) -> tuple[NDArray[float64], NDArray[float64], NDArray[float64]]"),
             "Signed distance (n,), normal (n, 3) and Hessian (n, 3, 3) at the positions x (n, 3).");
    m.def(
        "plane", [](Vec3 point, Vec3 normal) { return surface(Plane{point, normal}); }, nb::arg("point"),
        nb::arg("normal"));
    m.def(
        "sphere", [](Vec3 centre, double radius, bool inside) { return surface(Sphere{centre, radius, inside}); },
        nb::arg("centre"), nb::arg("radius"), nb::arg("inside"));
    m.def(
        "cylinder",
        [](Vec3 centre, Vec3 axis, double radius, bool inside) {
            return surface(Cylinder{centre, axis, radius, inside});
        },
        nb::arg("centre"), nb::arg("axis"), nb::arg("radius"), nb::arg("inside"));
    m.def(
        "surface_from_function", &surface_from_function, nb::arg("function"),
        nb::sig(
            "def surface_from_function(function: Callable[[NDArray[float64]], tuple[NDArray[float64], NDArray[float64], NDArray[float64]]]) -> Surface"),
        "A tool from a function x (n, 3) -> (g (n,), n (n, 3), H (n, 3, 3)).");
}
