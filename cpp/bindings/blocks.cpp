#include <nanobind/stl/array.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include "evaluate.hpp"
#include "umform/elements/block.hpp"
#include "umform/elements/cauchy.hpp"

using namespace umform;

namespace {

/// Abscissae and weights (points,), or of each column (columns, points).
ThicknessRule to_rule(const Input& x, const Input& w) {
    require(x.size() == w.size() && x.size() > 0 && x.ndim() <= 2, "there is one weight for each thickness point");
    const std::size_t count = x.shape(x.ndim() - 1);
    std::vector<Rule> columns;
    for (std::size_t at = 0; at < x.size(); at += count)
        columns.push_back({{x.data() + at, x.data() + at + count}, {w.data() + at, w.data() + at + count}});
    return columns;
}

std::unique_ptr<ShellBlock> shell_block(const Technology& technology, const SurfacePoints& surface_points,
                                        const Input& t, const Input& w, std::shared_ptr<Material> material,
                                        const InputIds& connectivity, const Input& X,
                                        const std::optional<Input>& rolling) {
    Connectivity part = to_connectivity(connectivity);
    std::vector<double> directions;
    if (rolling) directions = to_vector(*rolling);
    if (part.nodes == 8)
        return std::make_unique<ShellBlockOf<8>>(technology, surface_points, to_rule(t, w), std::move(material),
                                                 std::move(part), to_vector(X), std::move(directions));
    if (part.nodes == 18)
        return std::make_unique<ShellBlockOf<18>>(technology, surface_points, to_rule(t, w), std::move(material),
                                                  std::move(part), to_vector(X), std::move(directions));
    throw std::invalid_argument("a solid-shell has 8 or 18 nodes");
}

nb::object point_fields(ShellBlock& block, const Input& u) {
    const std::size_t elements = block.connectivity().size(), points = block.points(), count = elements * points;
    std::vector<double> E(6 * count), S(6 * count), frame(9 * count), F(9 * count), dV(count);
    const double* position = nodal(block, u);
    {
        const nb::gil_scoped_release release;
        block.fields(position, PointFields{E.data(), S.data(), frame.data(), F.data(), dV.data()});
    }
    return nb::make_tuple(to_numpy(std::move(E), {elements, points, 6}), to_numpy(std::move(S), {elements, points, 6}),
                          to_numpy(std::move(frame), {elements, points, 3, 3}),
                          to_numpy(std::move(F), {elements, points, 3, 3}),
                          to_numpy(std::move(dV), {elements, points}));
}

nb::object cell_fields(ShellBlock& block, const Input& u, int scalar) {
    const std::size_t elements = block.connectivity().size();
    require(scalar < block.state_size(), "the history of a point has no such number");
    std::array<std::vector<double>, 4> stress;
    std::vector<double> mises(elements), mean, largest;
    CellFields out{{}, mises.data()};
    for (int kind = 0; kind < 4; ++kind) {
        stress[kind].resize(6 * elements);
        out.stresses[kind] = stress[kind].data();
    }
    if (scalar >= 0) {
        mean.resize(elements), largest.resize(elements);
        out.mean = mean.data(), out.largest = largest.data(), out.scalar = scalar;
    }
    const double* position = nodal(block, u);
    {
        const nb::gil_scoped_release release;
        block.fields(position, out);
    }
    nb::list found;
    for (std::vector<double>& values : stress) found.append(to_numpy(std::move(values), {elements, 6}));
    found.append(to_numpy(std::move(mises), {elements}));
    if (scalar >= 0) {
        found.append(to_numpy(std::move(mean), {elements}));
        found.append(to_numpy(std::move(largest), {elements}));
    }
    return found;
}

/// Reads `Size` numbers of each of the points first ... of an array, for the lanes.
template <int Size>
std::array<Lanes, Size> at_points(const Input& array, std::size_t first, std::size_t count) {
    std::array<Lanes, Size> values;
    for (int i = 0; i < Size; ++i)
        values[i] = by_lane([&](int lane) { return array.data()[Size * std::min(first + lane, count - 1) + i]; });
    return values;
}

nb::object point_stresses(const Input& E, const Input& S, const Input& frame, const Input& F) {
    const std::size_t count = E.size() / 6;
    require(S.size() == 6 * count && frame.size() == 9 * count && F.size() == 9 * count,
            "E, S, frame and F are of as many points");
    std::array<std::vector<double>, 3> out;
    for (std::vector<double>& values : out) values.resize(6 * count);
    for (std::size_t first = 0; first < count; first += lane_count) {
        const auto found = stresses<Lanes>(at_points<6>(E, first, count), at_points<6>(S, first, count),
                                           {at_points<9>(frame, first, count)}, {at_points<9>(F, first, count)});
        const std::array<const Vec<Lanes, 6>*, 3> parts{&found.cauchy_local, &found.cauchy, &found.pk2};
        for (std::size_t at = first; at < std::min(first + lane_count, count); ++at)
            for (int kind = 0; kind < 3; ++kind)
                for (int p = 0; p < 6; ++p) out[kind][6 * at + p] = (*parts[kind])[p][at - first];
    }
    return nb::make_tuple(to_numpy(std::move(out[0]), {count, 6}), to_numpy(std::move(out[1]), {count, 6}),
                          to_numpy(std::move(out[2]), {count, 6}));
}

nb::object total_energy(ShellBlock& block, const Input& u) {
    const double* position = nodal(block, u);
    Energy total;
    {
        const nb::gil_scoped_release release;
        total = block.energy(position);
    }
    return nb::make_tuple(total.elastic, total.plastic);
}

nb::object element_matrix(ShellBlock& block, int e, const Input& u) {
    const std::size_t size = 3 * block.connectivity().nodes;
    std::vector<double> K(size * size), f(size);
    require(e >= 0 && e < block.connectivity().size(), "there is no such element");
    block.element(e, nodal(block, u), K.data(), f.data());
    return nb::make_tuple(to_numpy(std::move(K), {size, size}), to_numpy(std::move(f), {size}));
}

}  // namespace

void bind_blocks(nb::module_& m) {
    nb::class_<Tying>(m, "Tying", "One row of an assumed-strain rule.")
        .def(nb::init<int, std::vector<double>, std::vector<double>, bool>(), nb::arg("component"), nb::arg("r"),
             nb::arg("s"), nb::arg("at_layer"));
    nb::class_<Polynomial>(m, "Polynomial", "factor * r^a s^b P_c(t) of an enhanced mode in one covariant component.")
        .def(nb::init<int, double, int, int, int>(), nb::arg("component"), nb::arg("factor"), nb::arg("a"),
             nb::arg("b"), nb::arg("c"));
    nb::class_<Technology>(m, "Technology", "Which strains are tied where, and which are enhanced by what.")
        .def(nb::init<std::vector<Tying>, std::vector<Mode>>(), nb::arg("tying"), nb::arg("modes"));

    auto shell = nb::class_<ShellBlock>(m, "ShellBlock", "All solid-shell elements of one kind with their history.");
    bind_common(shell);
    shell.def_prop_ro("points", &ShellBlock::points)
        .def_prop_ro("modes", &ShellBlock::modes)
        .def_prop_ro("state_size", &ShellBlock::state_size)
        .def_prop_ro(
            "history_variables", [](const ShellBlock& b) { return to_dict(b.history_variables()); },
            nb::sig("def history_variables(self) -> dict[str, int]"),
            "Parts of the history of a point, in their order.")
        .def_prop_ro("symmetric", &ShellBlock::symmetric, "Whether the tangent is symmetric.")
        .def(
            "failing_point",
            [](ShellBlock& b, int e, const Input& u) {
                require(e >= 0 && e < b.connectivity().size(), "there is no such element");
                const auto [q, E] = b.failing_point(e, nodal(b, u));
                return nb::make_tuple(q, to_numpy(std::vector<double>(E.begin(), E.end()), {6}));
            },
            nb::arg("e"), nb::arg("u"),
            nb::sig("def failing_point(self, e: int, u: NDArray[float64]) -> tuple[int, NDArray[float64]]"),
            "First point of an element at which its law has no answer, or -1, and its Green-Lagrange strain (6,).")
        .def_rw("step", &ShellBlock::step, "Increment of time, for laws that ask for it.")
        .def(
            "set_numbers",
            [](ShellBlock& b, const InputIds& numbers) {
                require(numbers.size() == static_cast<std::size_t>(b.connectivity().size()),
                        "there is one number for each cell");
                b.set_numbers({numbers.data(), numbers.data() + numbers.size()});
            },
            nb::arg("numbers"), nb::sig("def set_numbers(self, numbers: NDArray[int32]) -> None"),
            "Numbers of the cells for messages, where they are a part of a larger mesh.")
        .def(
            "recover", [](ShellBlock& b, const Input& du, bool mixed) { b.recover(nodal(b, du), mixed); },
            nb::arg("du"), nb::arg("mixed") = false,
            nb::sig("def recover(self, du: NDArray[float64], mixed: bool = False) -> None"),
            "Update the enhanced parameters after u += du; mixed: the geometric stiffness is of the foreseen stress.")
        .def(
            "recover_by",
            [](ShellBlock& b, const Input& change) {
                if (change.size() != b.alpha().size()) throw std::invalid_argument("alpha has another size");
                b.recover_by(change.data());
            },
            nb::arg("change"), nb::sig("def recover_by(self, change: NDArray[float64]) -> None"),
            "Add a known change to the enhanced parameters.")
        .def_prop_ro(
            "keeps_blocks", &ShellBlock::keeps_blocks,
            "Whether enhanced parameters can be recovered from the converged state without an evaluation there.")
        .def_prop_ro(
            "enhanced_change", &ShellBlock::enhanced_change,
            "Largest change of an enhanced parameter that a recovery without a displacement makes after the last evaluation.")
        .def_prop_ro("staged_returns", &ShellBlock::staged_returns,
                     "Points at which return maps have gone through stages of a shrinking yield surface so far.")
        .def("take_blocks", &ShellBlock::take_blocks, nb::arg("of"),
             "Take the tangent with which enhanced parameters are recovered from the same elements of a similar run.")
        .def("follow", &ShellBlock::follow,
             "After an evaluation of forces alone: the next recover takes its residual, with the previous tangent.")
        .def("shorten", &ShellBlock::shorten, nb::arg("part"),
             "Shorten what the last recover has changed to a part of it.")
        .def("commit", &ShellBlock::commit, "Make the trial history the converged one.")
        .def("revert", &ShellBlock::revert, "Go back to the converged history.")
        .def_prop_ro(
            "state",
            [](const ShellBlock& b) {
                return to_numpy(
                    b.state(), {static_cast<std::size_t>(b.connectivity().size()), static_cast<std::size_t>(b.points()),
                                static_cast<std::size_t>(b.state_size())});
            },
            nb::sig("def state(self) -> NDArray[float64]"), "Converged history (elements, points, state_size).")
        .def_prop_ro(
            "flowing",
            [](const ShellBlock& b) {
                std::vector<std::uint8_t> flows = b.flowing();
                const std::size_t points = flows.size();
                return to_numpy(std::move(flows), {points});
            },
            nb::sig("def flowing(self) -> NDArray[uint8]"),
            "For each point 1 where the last evaluation has changed its history, else 0; empty without a history.")
        .def_prop_ro(
            "alpha",
            [](const ShellBlock& b) {
                return to_numpy(b.alpha(), {static_cast<std::size_t>(b.connectivity().size()),
                                            static_cast<std::size_t>(b.modes())});
            },
            nb::sig("def alpha(self) -> NDArray[float64]"), "Converged enhanced parameters (elements, modes).")
        .def(
            "restore",
            [](ShellBlock& b, const Input& state, const Input& alpha) {
                if (state.size() != b.state().size() || alpha.size() != b.alpha().size())
                    throw std::invalid_argument("state or alpha has another size");
                b.restore(state.data(), alpha.data());
            },
            nb::arg("state"), nb::arg("alpha"),
            nb::sig("def restore(self, state: NDArray[float64], alpha: NDArray[float64]) -> None"),
            "Put a stored history back.")
        .def(
            "point_fields", &point_fields, nb::arg("u"),
            nb::sig(
                "def point_fields(self, u: NDArray[float64]) -> tuple[NDArray[float64], NDArray[float64], NDArray[float64], NDArray[float64], NDArray[float64]]"),
            "E, S (elements, points, 6) in the local frame, the frame and F (elements, points, 3, 3), dV (elements, points).")
        .def(
            "cell_fields", &cell_fields, nb::arg("u"), nb::arg("scalar") = -1,
            nb::sig("def cell_fields(self, u: NDArray[float64], scalar: int = -1) -> list[NDArray[float64]]"),
            "Means (elements, 6) of the Cauchy stress in global and local axes and of S in both; largest von Mises stress; mean and largest value of a number of the history.")
        .def(
            "energy", &total_energy, nb::arg("u"),
            nb::sig("def energy(self, u: NDArray[float64]) -> tuple[float, float]"),
            "Elastic energy and plastic work of the block at the converged state u; NaN if the law does not know them.")
        .def("element", &element_matrix, nb::arg("e"), nb::arg("u"),
             nb::sig("def element(self, e: int, u: NDArray[float64]) -> tuple[NDArray[float64], NDArray[float64]]"),
             "Condensed K and f of one element.");
    m.def(
        "point_stresses", &point_stresses, nb::arg("E"), nb::arg("S"), nb::arg("frame"), nb::arg("F"),
        nb::sig(
            "def point_stresses(E: NDArray[float64], S: NDArray[float64], frame: NDArray[float64], F: NDArray[float64]) -> tuple[NDArray[float64], NDArray[float64], NDArray[float64]]"),
        "From what point_fields gives, (points, 6): Cauchy stress in the local frame and in global axes, S in global axes.");
    m.def(
        "shell_block", &shell_block, nb::arg("technology"), nb::arg("surface_points"), nb::arg("t"), nb::arg("w"),
        nb::arg("material"), nb::arg("connectivity"), nb::arg("X"), nb::arg("rolling") = nb::none(),
        nb::sig(
            "def shell_block(technology: Technology, surface_points: tuple[int, int], t: NDArray[float64], w: NDArray[float64], material: Material, connectivity: NDArray[int32], X: NDArray[float64], rolling: NDArray[float64] | None = None) -> ShellBlock"),
        "Solid-shells on the cells of a mesh; rolling: direction of e_1, one vector (3,) or one for each cell (cells, 3).");
}
