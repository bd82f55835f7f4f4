#include <nanobind/stl/array.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "umform/surfaces/cylinder.hpp"
#include "umform/surfaces/extruded.hpp"
#include "umform/surfaces/led_around.hpp"
#include "umform/surfaces/offset.hpp"
#include "umform/surfaces/offset_field.hpp"
#include "umform/surfaces/placed.hpp"
#include "umform/surfaces/plane.hpp"
#include "umform/surfaces/revolved.hpp"
#include "umform/surfaces/rounded_box.hpp"
#include "umform/surfaces/sphere.hpp"
#include "umform/surfaces/triangulated.hpp"

using namespace umform;

namespace {

template <class Shape>
std::shared_ptr<Surface> surface(const Shape& shape) {
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

/// Rows of start, end, centre and turn.
Profile profile(const Input& rows, ProfileEnd start, ProfileEnd end) {
    if (rows.ndim() != 2 || rows.shape(0) == 0 || rows.shape(1) != 7)
        throw std::invalid_argument("segments must have shape (n, 7), n > 0");
    std::vector<Segment> segments;
    for (std::size_t i = 0; i < rows.shape(0); ++i) {
        const double* r = rows.data() + 7 * i;
        segments.push_back({{r[0], r[1]}, {r[2], r[3]}, {r[4], r[5]}, static_cast<int>(r[6])});
    }
    return {segments, start, end};
}

Mat3 matrix(const Input& values) {
    if (values.ndim() != 2 || values.shape(0) != 3 || values.shape(1) != 3)
        throw std::invalid_argument("the matrix must have shape (3, 3)");
    Mat3 m;
    std::copy_n(values.data(), 9, m.a.begin());
    return m;
}

void require(bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(what);
}

/// The thirds of triangles with what lies around them.
std::shared_ptr<Surface> triangulated(const Input& control, const InputIds& across, const InputIds& neighbour,
                                      const InputIds& ends, const InputIds& face, const Input& normals,
                                      const InputIds& corner, const std::vector<std::shared_ptr<Surface>>& faces,
                                      double trust) {
    const std::size_t count = control.shape(0), corners = normals.shape(0);
    require(count > 0 && control.ndim() == 3 && control.shape(1) == 15 && control.shape(2) == 3,
            "control must have shape (n, 15, 3), n > 0");
    require(across.size() == count && neighbour.size() == count && face.size() == count && ends.size() == 2 * count,
            "across, neighbour, face and ends must have n rows");
    require(normals.size() == 3 * corners && corner.size() == corners, "normals and corner must have as many rows");
    std::vector<Third> thirds(count);
    for (std::size_t i = 0; i < count; ++i) {
        Third& third = thirds[i];
        for (int k = 0; k < 15; ++k) std::copy_n(control.data() + 45 * i + 3 * k, 3, third.patch.control[k].begin());
        third.across = static_cast<Across>(across.data()[i]);
        third.neighbour = neighbour.data()[i];
        third.face = face.data()[i];
        require(third.face < static_cast<int>(faces.size()), "a face must be one of the exact ones");
        third.ends = {ends.data()[2 * i], ends.data()[2 * i + 1]};
        require(third.neighbour < static_cast<int>(count), "a neighbour must be a row of control");
        for (const int end : third.ends) require(end >= 0 && end < static_cast<int>(corners), "ends must be corners");
    }
    std::vector<Corner> around(corners);
    for (std::size_t i = 0; i < corners; ++i) {
        std::copy_n(normals.data() + 3 * i, 3, around[i].normal.begin());
        around[i].across = static_cast<Across>(corner.data()[i]);
    }
    return std::make_shared<Triangulated>(thirds, std::move(around), ExactFaces{{faces.begin(), faces.end()}, trust});
}

/// Tools of lines and arcs, of triangles, and tools that others give.
void bind_shapes(nb::module_& m) {
    nb::enum_<ProfileEnd>(m, "ProfileEnd", "What the first and the last segment of a profile do.")
        .value("joined", ProfileEnd::Joined)
        .value("endless", ProfileEnd::Endless)
        .value("on_axis", ProfileEnd::OnAxis);
    m.def(
        "extruded",
        [](const Input& segments, ProfileEnd start, ProfileEnd end, Vec3 origin, Vec3 x, Vec3 y) {
            return surface(Extruded{profile(segments, start, end), origin, x, y});
        },
        nb::arg("segments"), nb::arg("start"), nb::arg("end"), nb::arg("origin"), nb::arg("x"), nb::arg("y"),
        nb::sig("def extruded(segments: NDArray[float64], start: ProfileEnd, end: ProfileEnd, origin: Sequence[float], "
                "x: Sequence[float], y: Sequence[float]) -> Surface"),
        "A profile of segments (n, 7): start, end, centre, turn; drawn out across its directions x and y.");
    m.def(
        "revolved",
        [](const Input& segments, ProfileEnd start, ProfileEnd end, Vec3 origin, Vec3 axis) {
            return surface(Revolved{profile(segments, start, end), origin, axis});
        },
        nb::arg("segments"), nb::arg("start"), nb::arg("end"), nb::arg("origin"), nb::arg("axis"),
        nb::sig("def revolved(segments: NDArray[float64], start: ProfileEnd, end: ProfileEnd, origin: Sequence[float], "
                "axis: Sequence[float]) -> Surface"),
        "A profile of segments (n, 7): start, end, centre, turn; turned about an axis.");
    m.def(
        "led_around",
        [](const Input& segments, Vec3 origin, const Input& axes, std::array<double, 2> core, double corner) {
            const Profile section = profile(segments, ProfileEnd::Endless, ProfileEnd::Endless);
            return surface(LedAround{section, origin, matrix(axes), core, corner});
        },
        nb::arg("segments"), nb::arg("origin"), nb::arg("axes"), nb::arg("core"), nb::arg("corner"),
        nb::sig("def led_around(segments: NDArray[float64], origin: Sequence[float], axes: NDArray[float64], "
                "core: Sequence[float], corner: float) -> Surface"),
        "A profile of segments (n, 7): start, end, centre, turn; led around a rectangle with rounded corners.");
    m.def(
        "rounded_box",
        [](Vec3 centre, const Input& axes, Vec3 core, double radius) {
            return surface(RoundedBox{centre, matrix(axes), core, radius});
        },
        nb::arg("centre"), nb::arg("axes"), nb::arg("core"), nb::arg("radius"),
        nb::sig("def rounded_box(centre: Sequence[float], axes: NDArray[float64], core: Sequence[float], "
                "radius: float) -> Surface"));
    m.def(
        "triangulated", &triangulated, nb::arg("control"), nb::arg("across"), nb::arg("neighbour"), nb::arg("ends"),
        nb::arg("face"), nb::arg("normals"), nb::arg("corner"), nb::arg("faces"), nb::arg("trust"),
        nb::sig("def triangulated(control: NDArray[float64], across: NDArray[int32], neighbour: NDArray[int32], "
                "ends: NDArray[int32], face: NDArray[int32], normals: NDArray[float64], corner: NDArray[int32], "
                "faces: Sequence[Surface], trust: float) -> Surface"),
        "Thirds of triangles: points (n, 15, 3) of quartic patches; across their edge 0 smooth, 1 sharp, 2 a rim; the "
        "third on its other side or -1; its two corners (n, 2); its exact face or -1. Of the corners: the sum of normals (m, 3), and 0, 1, 2.");
    m.def(
        "offset",
        [](std::shared_ptr<Surface> tool, double distance, int side) -> std::shared_ptr<Surface> {
            return std::make_shared<Offset>(std::move(tool), distance, side);
        },
        nb::arg("tool"), nb::arg("distance"), nb::arg("side"),
        "The tool grown by a distance (side 1), or all that is farther from it (side -1).");
    m.def(
        "offset_by_field",
        [](std::shared_ptr<Surface> tool, const Input& axes, const Input& values) -> std::shared_ptr<Surface> {
            require(axes.ndim() == 2 && axes.shape(0) > 0 && axes.shape(0) <= 3 && axes.shape(1) == 6,
                    "axes must have shape (n, 6), n from 1 to 3");
            std::vector<SplineField::Axis> along;
            std::size_t count = 1;
            for (std::size_t i = 0; i < axes.shape(0); ++i) {
                const double* a = axes.data() + 6 * i;
                require(a[4] > 0.0 && a[5] >= 1.0, "an axis needs a distance above 0 and 1 or more coefficients");
                along.push_back({{a[0], a[1], a[2]}, a[3], a[4], static_cast<int>(a[5])});
                count *= along.back().count;
            }
            require(values.size() == count, "there must be a value for each coefficient");
            return std::make_shared<OffsetByField>(std::move(tool),
                                                   SplineField{along, {values.data(), values.data() + count}});
        },
        nb::arg("tool"), nb::arg("axes"), nb::arg("values"),
        nb::sig("def offset_by_field(tool: Surface, axes: NDArray[float64], values: NDArray[float64]) -> Surface"),
        "The tool grown by a cubic B-spline over its directions (n, 6): direction, place of the first coefficient, "
        "distance of two, number. The last direction runs fastest in the values.");
    m.def(
        "placed",
        [](std::shared_ptr<Surface> tool, const Input& Q, Vec3 shift) -> std::shared_ptr<Surface> {
            return std::make_shared<Placed>(std::move(tool), matrix(Q), shift);
        },
        nb::arg("tool"), nb::arg("matrix"), nb::arg("shift"),
        nb::sig("def placed(tool: Surface, matrix: NDArray[float64], shift: Sequence[float]) -> Surface"));
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
             "Signed distance (n,), normal (n, 3) and Hessian (n, 3, 3) at the positions x (n, 3).")
        .def_prop_ro("is_distance", &Surface::is_distance,
                     "Whether the gap changes by no more than a point moves: contact leaves out what is far then.");
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
    bind_shapes(m);
}
