// Arrays that cross the border to Python: NumPy float64 and int32, contiguous, on the CPU.
#pragma once

#include <algorithm>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include "umform/assembly/connectivity.hpp"
#include "umform/assembly/history.hpp"

namespace nb = nanobind;

template <class T>
using Array = nb::ndarray<T, nb::numpy, nb::c_contig, nb::device::cpu>;
using Input = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
using InputIds = nb::ndarray<const std::int32_t, nb::c_contig, nb::device::cpu>;
using Output = nb::ndarray<double, nb::c_contig, nb::device::cpu>;

/// A new NumPy array that owns a copy of `values`.
template <class T>
nb::object to_numpy(std::vector<T> values, std::initializer_list<std::size_t> shape) {
    auto* data = new std::vector<T>(std::move(values));
    nb::capsule owner(data, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
    return nb::cast(Array<T>(data->data(), shape, owner));
}

inline std::vector<double> to_vector(const Input& array) { return {array.data(), array.data() + array.size()}; }

/// Copies an array that a user's function has returned; its shape has been checked in Python.
inline void copy_result(nb::handle result, double* out, std::size_t size) {
    const auto array = nb::cast<Input>(result);
    if (array.size() != size) throw std::invalid_argument("a function has returned an array of another size");
    std::copy_n(array.data(), size, out);
}

/// Names and sizes of the parts of a history, in their order.
inline nb::dict to_dict(const std::vector<umform::HistoryVariable>& history_variables) {
    nb::dict names;
    for (const umform::HistoryVariable& quantity : history_variables) names[quantity.name.c_str()] = quantity.size;
    return names;
}

inline umform::Connectivity to_connectivity(const InputIds& ids) {
    return {static_cast<int>(ids.shape(1)), {ids.data(), ids.data() + ids.size()}};
}

void bind_quadrature(nb::module_& m);
void bind_materials(nb::module_& m);
void bind_metals(nb::module_& m);
void bind_foreign(nb::module_& m);
void bind_surfaces(nb::module_& m);
void bind_sparse(nb::module_& m);
void bind_multifrontal(nb::module_& m);
void bind_blocks(nb::module_& m);
void bind_contact(nb::module_& m);
void bind_loads(nb::module_& m);
void bind_sheets(nb::module_& m);
