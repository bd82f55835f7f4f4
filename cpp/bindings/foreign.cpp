#include <bit>

#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "umform/materials/compiled.hpp"
#include "umform/materials/umat.hpp"

using namespace umform;

namespace {

using Names = std::vector<std::pair<std::string, int>>;

ForeignTraits traits(std::string name, std::vector<double> properties, const Names& state,
                     const std::vector<double>& initial, bool symmetric, bool parallel, bool sees_points) {
    ForeignTraits made{std::move(name), std::move(properties), parallel, {{}, initial, symmetric, sees_points}};
    std::size_t named = 0;
    for (const auto& [part, numbers] : state) {
        made.law.state.push_back({part, numbers});
        named += numbers;
    }
    if (named != initial.size())
        throw std::invalid_argument("the names of the history do not have the size of the initial one");
    return made;
}

void raise(const RefusedAnswer& answer) {
    std::string where = answer.law;
    if (answer.cell >= 0) where += ", cell " + std::to_string(answer.cell);
    if (answer.point >= 0) where += ", point " + std::to_string(answer.point);
    const char* cause =
        "properties in another order or number, state variables that were not set, or a strain "
        "outside of what the law is made for";
    const char* remedy =
        "call the law at that strain alone; a law that wants a smaller increment says so by PNEWDT "
        "below 1, or by an answer other than 0";
    if (answer.kind == RefusedAnswer::BeyondItsArrays) {
        cause = "a state of fewer numbers than the law has, or a loop over one point too many";
        remedy =
            "as many state variables as the law writes: state=, NSTATV of a UMAT; what it overwrites is lost otherwise";
    }
    if (answer.kind == RefusedAnswer::Asymmetric) {
        cause = "flow that is not associated, back stresses with recall, or a mistake in the tangent";
        remedy = "symmetric=False where it is meant, else correct it";
    }
    const nb::object kind = nb::module_::import_("umform.errors")
                                .attr(answer.kind == RefusedAnswer::NotFinite ? "NotFinite" : "InvalidValue");
    const nb::object error =
        kind(answer.wrong.c_str(), nb::arg("where") = where, nb::arg("cause") = cause, nb::arg("remedy") = remedy);
    PyErr_SetObject(kind.ptr(), error.ptr());
}

}  // namespace

void bind_foreign(nb::module_& m) {
    nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
        try {
            std::rethrow_exception(thrown);
        } catch (const RefusedAnswer& answer) {
            raise(answer);
        }
    });
    m.def(
        "compiled_law",
        [](std::uintptr_t function, std::uintptr_t energy, std::string name, std::vector<double> properties,
           const Names& state, const std::vector<double>& initial, bool symmetric, bool parallel, bool sees_points) {
            return compiled_law(
                std::bit_cast<CompiledFunction*>(function), std::bit_cast<CompiledEnergy*>(energy),
                traits(std::move(name), std::move(properties), state, initial, symmetric, parallel, sees_points));
        },
        nb::arg("function"), nb::arg("energy"), nb::arg("name"), nb::arg("properties"), nb::arg("state"),
        nb::arg("initial"), nb::arg("symmetric"), nb::arg("parallel"), nb::arg("sees_points"),
        "A law from the address of a C function, and that of its energy or 0.");
    m.def(
        "umat_law",
        [](std::uintptr_t function, bool energies, std::string name, std::vector<double> properties, Names state,
           const std::vector<double>& initial, bool symmetric, bool parallel) {
            Names all;
            for (const HistoryVariable& part : UmatState::table.list()) all.emplace_back(part.name, part.size);
            all.insert(all.end(), state.begin(), state.end());
            std::vector<double> begin(UmatState::variables, 0.0);
            begin.insert(begin.end(), initial.begin(), initial.end());
            return umat_law(std::bit_cast<UmatFunction*>(function), energies,
                            traits(std::move(name), std::move(properties), all, begin, symmetric, parallel, true));
        },
        nb::arg("function"), nb::arg("energies"), nb::arg("name"), nb::arg("properties"), nb::arg("state"),
        nb::arg("initial"), nb::arg("symmetric"), nb::arg("parallel"),
        "A small-strain law from the address of a UMAT; with `energies` it fills SSE, SPD and SCD.");
}
