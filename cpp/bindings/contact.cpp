#include <bit>

#include <nanobind/stl/array.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include "evaluate.hpp"
#include "umform/contact/bead.hpp"
#include "umform/contact/cells.hpp"
#include "umform/contact/coulomb.hpp"
#include "umform/contact/facet_block.hpp"
#include "umform/contact/own_pressure.hpp"
#include "umform/contact/penalty.hpp"

using namespace umform;

namespace {

using Vectors = std::vector<Vec3>;

using SharedSurface = std::shared_ptr<Surface>;
using SharedLaw = std::shared_ptr<ContactLaw>;

template <template <int> class FaceRule>
std::unique_ptr<ContactBlock> block_of(const InputIds& facets, const Input& X, typename FaceRule<4>::Setting setting,
                                       const SharedSurface& surface, const SharedLaw& law) {
    const Connectivity part = to_connectivity(facets);
    if (part.nodes == 4)
        return std::make_unique<ContactBlockOf<4, FaceRule<4>>>(part, to_vector(X), setting, surface, law);
    if (part.nodes == 9)
        return std::make_unique<ContactBlockOf<9, FaceRule<9>>>(part, to_vector(X), setting, surface, law);
    throw std::invalid_argument("a facet has 4 or 9 nodes");
}

std::unique_ptr<ContactBlock> contact_block(const InputIds& facets, const Input& X, const SurfacePoints& points,
                                            bool at_nodes, const SharedSurface& surface, const SharedLaw& law) {
    return block_of<AtPoints>(facets, X, {points, at_nodes}, surface, law);
}

std::unique_ptr<ContactBlock> contact_cells(const InputIds& facets, const Input& X, int cells,
                                            const SharedSurface& surface, const SharedLaw& law) {
    require(cells >= 1, "a facet has at least one cell");
    return block_of<OverCells>(facets, X, {cells}, surface, law);
}

nb::object copied(const std::vector<double>& values) { return to_numpy(values, {values.size()}); }

nb::object copied(const Vectors& vectors) {
    std::vector<double> values;
    values.reserve(3 * vectors.size());
    for (const Vec3& v : vectors) values.insert(values.end(), v.begin(), v.end());
    return to_numpy(std::move(values), {vectors.size(), 3});
}

/// Read-only arrays that the object owns.
template <class T>
using View = nb::ndarray<const T, nb::numpy, nb::c_contig, nb::device::cpu>;
template <class T>
View<T> view(const std::vector<T>& values) {
    return View<T>(values.data(), {values.size()});
}
View<double> view(const Vectors& vectors) {
    return View<double>(vectors.empty() ? nullptr : vectors[0].data(), {vectors.size(), 3});
}

/// Adds a read-only array of the class.
template <class T>
void add_array(nb::class_<ContactFound>& found, const char* name, std::vector<T> ContactFound::* values,
               const char* what) {
    constexpr const char* kind = std::is_same_v<T, std::uint8_t>   ? "uint8"
                                 : std::is_same_v<T, std::int32_t> ? "int32"
                                                                   : "float64";
    const std::string signature = std::string("def ") + name + "(self) -> NDArray[" + kind + "]";
    found.def_prop_ro(
        name, [values](const ContactFound& f) { return view(f.*values); }, nb::rv_policy::reference_internal,
        nb::sig(signature.c_str()), what);
}

void bind_found(nb::module_& m) {
    using Found = ContactFound;
    nb::class_<Found> found(
        m, "ContactFound", "What an evaluation of a contact came across: a copy that later evaluations do not change.");
    add_array(found, "active", &Found::active,
              "For each contact point 1 where the tool holds it, 2 where it slips as well, else 0.");
    add_array(found, "tangential_stiffness", &Found::tangential_stiffness, "Traction per elastic slip, shape (held,).");
    add_array(found, "elastic_slip", &Found::elastic_slip,
              "Elastic slips along the tool (held, 3), zero without friction.");
    add_array(found, "slip", &Found::slip, "Distances slid so far (held,).");
    add_array(found, "points", &Found::points,
              "Numbers of the points that are held, ascending; the arrays that follow are of these points.");
    add_array(found, "x", &Found::x, "Positions (held, 3).");
    add_array(found, "normal", &Found::normal, "Unit normals out of the tool (held, 3).");
    add_array(found, "traction", &Found::traction,
              "Tractions of the tool on the sheet, on the reference area (held, 3).");
    add_array(found, "force", &Found::force, "Forces of the sheet on the tool (held, 3).");
    add_array(found, "gap", &Found::gap, "Signed distances (held,), negative in penetration.");
    add_array(found, "pressure", &Found::pressure, "Normal parts of the tractions (held,).");
    add_array(found, "area", &Found::area, "Reference areas (held,).");
    add_array(found, "share", &Found::share, "Parts of the areas that are held (held,), 1 at points.");
    found.def_ro("stored", &Found::stored, "Energy of the elastic slip.")
        .def_ro("friction_work", &Found::friction_work, "Work of friction so far, at all points.")
        .def_ro("work_above_mean", &Found::work_above_mean,
                "Part of the work of friction that the mean of the forces at both ends of each increment misses.")
        .def_ro("contact_work", &Found::contact_work,
                "Work of the pressure so far, of rules that measure it along the way; zero at points.")
        .def_ro("penetration", &Found::penetration, "The largest penetration, zero if there is none.")
        .def_ro("round_off_squared", &Found::round_off_squared,
                "Square of what a relative error 1 of all positions makes of the residual.");
}

void bind_friction(nb::module_& m) {
    nb::class_<FrictionLaw>(m, "FrictionLaw", "The largest tangential traction that a tool can bear.")
        .def(
            "bound",
            [](const FrictionLaw& law, double pressure, double slip, const Vec3& z) {
                const Bound bound = law.bound(pressure, slip, z);
                return std::make_tuple(bound.value, bound.by_pressure, bound.by_slip);
            },
            nb::arg("pressure"), nb::arg("slip") = 0.0, nb::arg("z") = Vec3{},
            "Largest traction at a pressure, a distance slid and a place in the frame of the tool, and its derivatives with respect to pressure and slip.");
    m.def(
        "coulomb_friction",
        [](std::vector<double> pressure, std::vector<double> mu, double kinetic, double decay,
           double cap) -> std::shared_ptr<FrictionLaw> {
            auto law = std::make_shared<CoulombFriction>();
            law->pressure = std::move(pressure), law->mu = std::move(mu);
            law->kinetic = kinetic, law->decay = decay, law->cap = cap;
            return law;
        },
        nb::arg("pressure"), nb::arg("mu"), nb::arg("kinetic"), nb::arg("decay"), nb::arg("cap"),
        "min(mu p, cap), with mu from a table over the pressure, that falls to its kinetic part by exp(-slip/decay) if decay > 0.");
    m.def(
        "friction_by_region",
        [](const std::vector<std::tuple<Vec3, Vec3, std::shared_ptr<FrictionLaw>>>& regions,
           std::shared_ptr<FrictionLaw> elsewhere) -> std::shared_ptr<FrictionLaw> {
            auto law = std::make_shared<FrictionByRegion>();
            for (const auto& [lower, upper, inside] : regions) law->regions.push_back({lower, upper, inside});
            law->elsewhere = std::move(elsewhere);
            return law;
        },
        nb::arg("regions"), nb::arg("elsewhere"), "Other laws within boxes in the frame of the tool.");
    m.def(
        "friction_from_function",
        [](FrictionFunction::Function function) -> std::shared_ptr<FrictionLaw> {
            return std::make_shared<FrictionFunction>(std::move(function));
        },
        nb::arg("function"), "The bound from a function of pressure, slip and place.");
}

/// A Python function gap (n,) -> (pressure (n,), derivative (n,)).
std::shared_ptr<NormalLaw> normal_from_function(nb::callable function, std::string name, double reach) {
    auto call = [function = std::move(function)](int n, const double* gap, double* pressure, double* slope) {
        const nb::gil_scoped_acquire gil;
        const std::size_t count = n;
        const auto answer = nb::cast<nb::tuple>(function(to_numpy(std::vector<double>(gap, gap + n), {count})));
        copy_result(answer[0], pressure, count);
        copy_result(answer[1], slope, count);
    };
    return std::make_shared<NormalLaw>(std::move(name), reach, std::move(call));
}

nb::object pressures(const NormalLaw& law, const Input& gap) {
    const std::size_t n = gap.size();
    std::vector<double> pressure(n), slope(n);
    law.pressures(static_cast<int>(n), gap.data(), pressure.data(), slope.data());
    return nb::make_tuple(to_numpy(std::move(pressure), {n}), to_numpy(std::move(slope), {n}));
}

void raise(const RefusedPressure& refused) {
    const nb::object kind = nb::module_::import_("umform.errors").attr("NotFinite");
    const std::string where = refused.law + ", gap " + std::to_string(refused.gap);
    const nb::object error =
        kind(refused.wrong.c_str(), nb::arg("where") = where, nb::arg("value") = refused.value,
             nb::arg("cause") = "a root or a power of a gap outside of its domain, or the pressure with the wrong sign",
             nb::arg("remedy") = "umform.check_contact_law(law, gaps) at the gaps from the deepest to the reach");
    PyErr_SetObject(kind.ptr(), error.ptr());
}

void bind_own_pressure(nb::module_& m) {
    nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
        try {
            std::rethrow_exception(thrown);
        } catch (const RefusedPressure& refused) {
            raise(refused);
        }
    });
    nb::class_<NormalLaw>(m, "NormalLaw", "The pressure of a contact over its gap, by a function of a user.")
        .def_prop_ro("reach", &NormalLaw::reach, "The largest gap at which there is a pressure.")
        .def("pressures", &pressures, nb::arg("gap"),
             nb::sig("def pressures(self, gap: NDArray[float64]) -> tuple[NDArray[float64], NDArray[float64]]"),
             "Pressures and their derivatives with respect to the gap (n,).")
        .def(
            "energies",
            [](const NormalLaw& law, const Input& gap, int parts) {
                return copied(law.energies(static_cast<int>(gap.size()), gap.data(), parts));
            },
            nb::arg("gap"), nb::arg("parts") = 16,
            nb::sig("def energies(self, gap: NDArray[float64], parts: int = 16) -> NDArray[float64]"),
            "Energy per area (n,): the integral of the pressure from each gap up to the reach.");
    m.def(
        "normal_from_function", &normal_from_function, nb::arg("function"), nb::arg("name"), nb::arg("reach"),
        nb::sig(
            "def normal_from_function(function: Callable[[NDArray[float64]], tuple[NDArray[float64], NDArray[float64]]], name: str, reach: float) -> NormalLaw"),
        "A law from a function gap (n,) -> (pressure (n,), its derivative (n,)).");
    m.def(
        "compiled_normal_law",
        [](std::uintptr_t function, const std::string& name, std::vector<double> properties, double reach,
           bool parallel) {
            return compiled_normal_law(std::bit_cast<CompiledPressure*>(function), name, std::move(properties), reach,
                                       parallel);
        },
        nb::arg("function"), nb::arg("name"), nb::arg("properties"), nb::arg("reach"), nb::arg("parallel"),
        "A law from the address of a C function.");
    m.def(
        "own_law",
        [](double penalty, std::shared_ptr<NormalLaw> normal) -> std::shared_ptr<ContactLaw> {
            return std::make_shared<ContactLawOf<OwnPressure<Penalty>>>(
                OwnPressure<Penalty>(Penalty{penalty}, std::move(normal)));
        },
        nb::arg("penalty"), nb::arg("normal"),
        "Frictionless contact with a law of the pressure; penalty is a measure of its stiffness.");
    m.def(
        "own_coulomb_law",
        [](double penalty, double ratio, double slip, std::shared_ptr<FrictionLaw> friction,
           std::shared_ptr<NormalLaw> normal) -> std::shared_ptr<ContactLaw> {
            return std::make_shared<ContactLawOf<OwnPressure<Coulomb>>>(
                OwnPressure<Coulomb>(Coulomb{penalty, ratio, slip, std::move(friction)}, std::move(normal)));
        },
        nb::arg("penalty"), nb::arg("ratio"), nb::arg("slip"), nb::arg("friction"), nb::arg("normal"),
        "The same with friction.");
}

void bind_law(nb::module_& m) {
    nb::class_<ContactLaw>(m, "ContactLaw", "Traction at a place of a face from its gap, and what it remembers.")
        .def_prop_rw("penalty", &ContactLaw::penalty, &ContactLaw::set_penalty, "Pressure per penetration.")
        .def_prop_ro("symmetric", &ContactLaw::symmetric, "Whether its tangent is symmetric.");
    bind_friction(m);
    m.def(
        "coulomb_law",
        [](double penalty, double ratio, double slip,
           std::shared_ptr<FrictionLaw> friction) -> std::shared_ptr<ContactLaw> {
            return std::make_shared<ContactLawOf<Coulomb>>(Coulomb{penalty, ratio, slip, std::move(friction)});
        },
        nb::arg("penalty"), nb::arg("ratio"), nb::arg("slip"), nb::arg("friction"),
        "Contact with friction: a penalty and multipliers in both directions; ratio is the tangential over the normal stiffness at "
        "first touch, slip the elastic slip that is allowed.");
    m.def(
        "bead_law",
        [](const std::vector<Vec3>& curve, bool closed, double half_width, double restraint, double uplift, double slip,
           double off) -> std::shared_ptr<ContactLaw> {
            auto line = std::make_shared<const BeadLine>(curve, closed, half_width);
            return std::make_shared<ContactLawOf<Bead>>(Bead(line, half_width, restraint, uplift, slip, off));
        },
        nb::arg("curve"), nb::arg("closed"), nb::arg("half_width"), nb::arg("restraint"), nb::arg("uplift"),
        nb::arg("slip"), nb::arg("off"),
        "An equivalent draw bead along a polyline in the frame of the tool: forces per length across it and off the tool, within a band; slip is the elastic one, off the gap at which it ends.");
    m.def(
        "penalty_law",
        [](double penalty) -> std::shared_ptr<ContactLaw> {
            return std::make_shared<ContactLawOf<Penalty>>(Penalty{penalty});
        },
        nb::arg("penalty"), "Frictionless contact: a pressure of penalty times penetration, and multipliers.");
}

/// What is measured at the contact points.
void bind_points(nb::class_<ContactBlock>& contact) {
    contact
        .def_prop_ro(
            "positions", [](ContactBlock& b) { return copied(b.positions()); },
            nb::sig("def positions(self) -> NDArray[float64]"), "Of all points (points, 3).")
        .def_prop_ro(
            "gaps", [](ContactBlock& b) { return copied(b.gaps()); }, nb::sig("def gaps(self) -> NDArray[float64]"),
            "Of all points; those of far facets are measured now.")
        .def_prop_ro(
            "normals", [](ContactBlock& b) { return copied(b.normals()); },
            nb::sig("def normals(self) -> NDArray[float64]"), "Of all points (points, 3).")
        .def_prop_ro(
            "areas", [](const ContactBlock& b) { return copied(b.areas()); },
            nb::sig("def areas(self) -> NDArray[float64]"))
        .def_prop_ro(
            "active",
            [](ContactBlock& b) {
                std::vector<std::uint8_t> active;
                for (const Reaction& reaction : b.reactions()) active.push_back(reaction.held ? 1 : 0);
                return to_numpy(std::move(active), {static_cast<std::size_t>(b.points())});
            },
            nb::sig("def active(self) -> NDArray[uint8]"), "For each point 1 where the tool holds it, else 0.")
        .def_prop_ro(
            "pressures",
            [](ContactBlock& b) {
                std::vector<double> pressures;
                for (const Reaction& reaction : b.reactions()) pressures.push_back(reaction.pressure);
                return copied(pressures);
            },
            nb::sig("def pressures(self) -> NDArray[float64]"), "Normal parts of the tractions at all points.")
        .def_prop_ro(
            "tractions",
            [](ContactBlock& b) {
                const ContactFound found = b.found();
                Vectors tractions(b.points(), Vec3{});
                for (std::size_t i = 0; i < found.points.size(); ++i) tractions[found.points[i]] = found.traction[i];
                return copied(tractions);
            },
            nb::sig("def tractions(self) -> NDArray[float64]"),
            "Of the tool on the sheet at all points (points, 3), on the reference area.")
        .def_prop_ro("penetration", &ContactBlock::penetration, "The largest, zero if there is none.")
        .def_prop_ro(
            "round_off_squared", &ContactBlock::round_off_squared,
            "Square of what a relative error 1 of all positions makes of the residual, at the last evaluation.")
        .def_prop_ro("far_facets", &ContactBlock::far_facets,
                     "Facets so far from the tool that nothing was measured there since the last evaluation.");
}

/// What the contact points remember.
void bind_history(nb::class_<ContactBlock>& contact) {
    contact
        .def_prop_rw(
            "multipliers", [](const ContactBlock& b) { return copied(b.multipliers()); },
            [](ContactBlock& b, const Input& values) {
                require(values.size() == static_cast<std::size_t>(b.points()),
                        "there is one multiplier for each contact point");
                b.set_multipliers(values.data());
            },
            nb::for_getter(nb::sig("def multipliers(self) -> NDArray[float64]")),
            nb::for_setter(nb::sig("def multipliers(self, values: NDArray[float64], /) -> None")),
            "Pressures that are there without a penetration: those of now, which commit makes the converged ones.")
        .def_prop_ro(
            "history_variables", [](const ContactBlock& b) { return to_dict(b.history().history_variables()); },
            nb::sig("def history_variables(self) -> dict[str, int]"),
            "Parts of the history of a point, in their order.")
        .def_prop_ro(
            "state",
            [](const ContactBlock& b) {
                return to_numpy(b.history().state(),
                                {static_cast<std::size_t>(b.points()), static_cast<std::size_t>(b.history().size())});
            },
            nb::sig("def state(self) -> NDArray[float64]"),
            "Converged history (points, size) in the order of the history_variables.")
        .def_prop_ro(
            "read",
            [](const ContactBlock& b) {
                return to_numpy(b.read(),
                                {static_cast<std::size_t>(b.points()), static_cast<std::size_t>(b.history().size())});
            },
            nb::sig("def read(self) -> NDArray[float64]"),
            "The history that the last evaluation has read, with the multipliers that it was to take (points, size).")
        .def_prop_ro("begun", &ContactBlock::begun, "Whether there is a converged history.")
        .def(
            "begin", &ContactBlock::begin,
            "Take the places where the points are now as those of a sheet that was never held; nothing once there is a history.")
        .def(
            "augment",
            [](ContactBlock& b, const Input& tractions) {
                require(tractions.size() == 3 * static_cast<std::size_t>(b.points()),
                        "there is one traction for each contact point");
                Vectors t(b.points());
                for (std::size_t i = 0; i < tractions.size(); ++i) t[i / 3][i % 3] = tractions.data()[i];
                b.augment(t.data());
            },
            nb::arg("tractions"), nb::sig("def augment(self, tractions: NDArray[float64]) -> None"),
            "Let multipliers carry tractions (points, 3) along the tool at the points that are held.")
        .def("commit", &ContactBlock::commit, "Make the trial history the converged one.")
        .def("revert", &ContactBlock::revert, "Go back to the converged history.")
        .def(
            "restore", [](ContactBlock& b, const Input& state) { b.restore(state.data(), state.size()); },
            nb::arg("state"), nb::sig("def restore(self, state: NDArray[float64]) -> None"),
            "Put a stored history back.");
}

}  // namespace

void bind_contact(nb::module_& m) {
    bind_found(m);
    bind_law(m);
    bind_own_pressure(m);
    auto contact = nb::class_<ContactBlock>(m, "ContactBlock", "Contact of element faces with one rigid tool.");
    bind_common(contact);
    contact.def_rw("name", &ContactBlock::name, "For messages.")
        .def_rw("open", &ContactBlock::open,
                "Whether the tool has been taken away: it holds no point, wherever it stands.")
        .def(
            "keep",
            [](ContactBlock& b, nb::ndarray<const std::uint8_t, nb::ndim<1>, nb::c_contig, nb::device::cpu> points) {
                require(points.size() == static_cast<std::size_t>(b.points()),
                        "there is one mark for each contact point");
                b.kept.assign(points.data(), points.data() + points.size());
            },
            nb::arg("points"), nb::sig("def keep(self, points: NDArray[uint8]) -> None"),
            "Points that the next evaluation holds, without friction, wherever they are: not 0.")
        .def_prop_ro("law", &ContactBlock::law)
        .def_prop_ro("symmetric", &ContactBlock::symmetric, "Whether its tangent is symmetric.")
        .def_prop_rw(
            "penalty", [](const ContactBlock& b) { return b.law()->penalty(); },
            [](ContactBlock& b, double value) { b.law()->set_penalty(value); }, "That of its law.")
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
        .def(
            "row",
            [](ContactBlock& b, const Vec3& w, const Vec3& omega, const Vec3& p) { return copied(b.row(w, omega, p)); },
            nb::arg("w"), nb::arg("omega") = Vec3{}, nb::arg("p") = Vec3{},
            nb::sig(
                "def row(self, w: Sequence[float], omega: Sequence[float] = ..., p: Sequence[float] = ...) -> NDArray[float64]"),
            "Derivative of the sum of the tractions times areas times the way w + omega x (x - p) with respect to u.")
        .def("found", &ContactBlock::found, "What is known of the points that are held now, as a copy.")
        .def_prop_ro(
            "shape_values",
            [](const ContactBlock& b) {
                const std::size_t nodes = b.connectivity().nodes, points = b.per_facet();
                std::vector<double> values = b.shape_values();
                const std::size_t kinds = values.size() / (points * nodes);
                return to_numpy(std::move(values), {kinds, points, nodes});
            },
            nb::sig("def shape_values(self) -> NDArray[float64]"),
            "Shape functions at the points of all facets (1, points, nodes), or of each (facets, points, nodes).")
        .def_prop_ro("points", &ContactBlock::points)
        .def_prop_ro("per_facet", &ContactBlock::per_facet, "Contact points of each facet.");
    bind_points(contact);
    bind_history(contact);
    m.def(
        "contact_block", &contact_block, nb::arg("facets"), nb::arg("X"), nb::arg("points"), nb::arg("at_nodes"),
        nb::arg("surface"), nb::arg("law"),
        nb::sig(
            "def contact_block(facets: NDArray[int32], X: NDArray[float64], points: tuple[int, int], at_nodes: bool, surface: Surface, law: ContactLaw) -> ContactBlock"));
    m.def(
        "contact_cells", &contact_cells, nb::arg("facets"), nb::arg("X"), nb::arg("cells"), nb::arg("surface"),
        nb::arg("law"),
        nb::sig(
            "def contact_cells(facets: NDArray[int32], X: NDArray[float64], cells: int, surface: Surface, law: ContactLaw) -> ContactBlock"),
        "Contact integrated over cells x cells cells of each facet.");
}
