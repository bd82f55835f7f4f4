// The extension module umform._core.
#include "arrays.hpp"
#include "umform/threads.hpp"

NB_MODULE(_core, m) {
    nb::set_leak_warnings(false);  // functions of users may close over the model: a cycle that ends with the process
    m.doc() = "Kernels of umform: elements, materials, surfaces, contact, sparse patterns.";
    m.attr("build") = UMFORM_BUILD;  // compiler and instruction set, for benchmarks
    bind_quadrature(m);
    bind_materials(m);
    bind_surfaces(m);
    bind_sparse(m);
    bind_blocks(m);
    m.def("threads", [] { return umform::thread_count(); }, "Number of threads that the kernels use.");
    m.def(
        "set_threads",
        [](int count) {
            if (count < 1) throw std::invalid_argument("at least one thread");
            umform::thread_count() = count;
        },
        nb::arg("count"), "Set the number of threads that the kernels use.");
}
