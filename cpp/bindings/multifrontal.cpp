#include <cstring>
#include <memory>

#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "umform/assembly/threads.hpp"
#include "umform/multifrontal/elimination.hpp"
#include "umform/multifrontal/equilibration.hpp"
#include "umform/multifrontal/factors.hpp"
#include "umform/multifrontal/pivots.hpp"
#include "umform/multifrontal/residual.hpp"
#include "umform/multifrontal/substitution.hpp"

namespace umform::multifrontal {

namespace {

/// The plan for a pattern, whose arrays are those of Python, and factors.
class Multifrontal {
  public:
    Multifrontal(InputIds indptr, InputIds indices, bool symmetric)
        : indptr_(std::move(indptr)), indices_(std::move(indices)), symmetric_(symmetric) {
        if (symmetric) {
            plan(rows());
        } else {
            const UpperTriangle upper(rows(), Columns(rows()));
            plan({upper.indptr.data(), upper.indices.data(), rows().n});
        }
        plan_->map_entries(rows());
        factors_ = std::make_unique<Factors>(*plan_);
    }

    Rows rows() const { return {indptr_.data(), indices_.data(), static_cast<int>(indptr_.size()) - 1}; }
    bool symmetric() const { return symmetric_; }
    const Plan& plan() const { return *plan_; }
    Factors& factors() { return *factors_; }

  private:
    InputIds indptr_, indices_;
    bool symmetric_;
    std::unique_ptr<Plan> plan_;
    std::unique_ptr<Factors> factors_;

    void plan(const Rows& upper) {
        const ordering::Quotient quotient = ordering::make_quotient(upper.indptr, upper.indices, upper.n);
        plan_ = std::make_unique<Plan>(rows(), symmetric_, quotient, eliminate(quotient));
    }
};

/// Address of a function of BLAS that takes 32-bit integers by address.
template <class Function>
Function take(const nb::dict& api, const char* name) {
    const nb::object capsule = api[name];
    const char* signature = PyCapsule_GetName(capsule.ptr());
    if (signature == nullptr || std::strstr(signature, "int *") == nullptr || std::strstr(signature, "long") != nullptr)
        throw std::invalid_argument(std::string("BLAS function with unknown integers: ") + name);
    return reinterpret_cast<Function>(PyCapsule_GetPointer(capsule.ptr(), signature));
}

void bind(nb::module_& m) {
    m.def(
        "set_blas",
        [](const nb::dict& api, std::uintptr_t set_threads, std::uintptr_t get_threads) {
            Blas& functions = blas();
            functions.gemm_ = take<Blas::Gemm>(api, "dgemm");
            functions.gemv_ = take<Blas::Gemv>(api, "dgemv");
            functions.trsm_ = take<Blas::Trsm>(api, "dtrsm");
            functions.trsv_ = take<Blas::Trsv>(api, "dtrsv");
            functions.set_threads =
                reinterpret_cast<Blas::SetThreads>(set_threads);  // NOLINT(performance-no-int-to-ptr)
            functions.get_threads =
                reinterpret_cast<Blas::GetThreads>(get_threads);  // NOLINT(performance-no-int-to-ptr)
        },
        nb::arg("api"), nb::arg("set_threads"), nb::arg("get_threads"),
        nb::sig("def set_blas(api: dict[str, object], set_threads: int, get_threads: int) -> None"),
        "Take BLAS from capsules of Cython's kind.");
    nb::class_<Outcome>(m, "Outcome", "How a factorisation has ended.")
        .def_prop_ro("done", [](const Outcome& o) { return o.state == Outcome::Done; })
        .def_prop_ro("not_positive", [](const Outcome& o) { return o.state == Outcome::NotPositive; })
        .def_ro("equation", &Outcome::equation, "That of the pivot which has ended it; -1 if there is none.");
    nb::class_<Pivots>(m, "Pivots", "What the pivots tell.")
        .def_ro("negative", &Pivots::negative)
        .def_ro("odd", &Pivots::odd, "Whether the determinant is negative.")
        .def_prop_ro(
            "size", [](const Pivots& p) { return to_numpy(p.size, {p.size.size()}); },
            nb::sig("def size(self) -> NDArray[float64]"), "Pivot of each equation.");
    nb::class_<Multifrontal>(m, "Multifrontal", "Multifrontal factors of matrices with one pattern.")
        .def(
            "__init__",
            [](Multifrontal* self, InputIds indptr, InputIds indices, bool symmetric) {
                nb::gil_scoped_release release;
                new (self) Multifrontal(std::move(indptr), std::move(indices), symmetric);
            },
            nb::arg("indptr"), nb::arg("indices"), nb::arg("symmetric"),
            nb::sig("def __init__(self, indptr: NDArray[int32], indices: NDArray[int32], symmetric: bool) -> None"))
        .def_prop_ro(
            "fill", [](const Multifrontal& s) { return s.plan().fill; }, "Entries of the factors.")
        .def_prop_ro(
            "bytes", [](Multifrontal& s) { return 8 * s.factors().schedule().end; },
            "Memory of the factors and of what is on the way to them, on one thread.")
        .def(
            "factor",
            [](Multifrontal& s, const Input& values, bool positive) {
                nb::gil_scoped_release release;
                const Kind kind = !s.symmetric() ? Kind::Unsymmetric : positive ? Kind::Positive : Kind::Symmetric;
                // Cholesky's factors of D K D are D L: powers of two change nothing
                Scaling scaling = positive ? Scaling() : equilibrated(s.rows(), s.symmetric(), values.data());
                return s.factors().factor(kind, values.data(), std::move(scaling), thread_count());
            },
            nb::arg("values"), nb::arg("positive"),
            nb::sig("def factor(self, values: NDArray[float64], positive: bool) -> Outcome"))
        .def("pivots", [](Multifrontal& s) { return Pivots(s.factors()); })
        .def(
            "solve",
            [](Multifrontal& s, const Input& b, const Output& x) {
                nb::gil_scoped_release release;
                const std::size_t n = s.plan().n;
                const int columns = static_cast<int>(b.size() / n), threads = thread_count();
                for (int j = 0; j < columns; j += Substitution::most_columns)
                    Substitution(s.factors(), std::min(columns - j, Substitution::most_columns), threads)
                        .run(b.data() + j * n, x.data() + j * n);
            },
            nb::arg("b"), nb::arg("x"), nb::sig("def solve(self, b: NDArray[float64], x: NDArray[float64]) -> None"),
            "Solve for rows of b, each a right-hand side.")
        .def(
            "residual",
            [](const Multifrontal& s, const Input& values, const Input& b, const Input& x, const Output& r) {
                nb::gil_scoped_release release;
                const int columns = static_cast<int>(b.size() / s.plan().n);
                residual(s.rows(), s.symmetric(), values.data(), b.data(), x.data(), columns, r.data());
            },
            nb::arg("values"), nb::arg("b"), nb::arg("x"), nb::arg("r"),
            nb::sig("def residual(self, values: NDArray[float64], b: NDArray[float64], x: NDArray[float64], "
                    "r: NDArray[float64]) -> None"))
        .def(
            "residual_of_magnitudes",
            [](const Multifrontal& s, const Input& values, const Input& b, const Input& x, const Output& r) {
                nb::gil_scoped_release release;
                residual_of_magnitudes(s.rows(), s.symmetric(), values.data(), b.data(), x.data(), r.data());
            },
            nb::arg("values"), nb::arg("b"), nb::arg("x"), nb::arg("r"),
            nb::sig("def residual_of_magnitudes(self, values: NDArray[float64], b: NDArray[float64], "
                    "x: NDArray[float64], r: NDArray[float64]) -> None"),
            "r = b - |K| x, without a copy of the matrix.")
        .def_prop_ro(
            "column_sizes",
            [](Multifrontal& s) {
                const std::vector<double>& size = s.factors().scaling().size;
                return to_numpy(size, {size.size()});
            },
            nb::sig("def column_sizes(self) -> NDArray[float64]"),
            "Largest entry of each column of the matrix that was eliminated; none for Cholesky.")
        .def_prop_ro(
            "scales",
            [](Multifrontal& s) {
                const Scaling& scaling = s.factors().scaling();
                const std::size_t n = scaling.row.size();
                return std::pair(to_numpy(scaling.row, {n}), to_numpy(scaling.column, {n}));
            },
            nb::sig("def scales(self) -> tuple[NDArray[float64], NDArray[float64]]"),
            "Powers of two for rows and columns of that; empty where it is the matrix itself.");
}

}  // namespace

}  // namespace umform::multifrontal

void bind_multifrontal(nb::module_& m) { umform::multifrontal::bind(m); }
