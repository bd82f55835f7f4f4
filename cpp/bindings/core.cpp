// The extension module umform._core.
#include "arrays.hpp"
#include "umform/assembly/threads.hpp"

#ifndef UMFORM_BUILD
    #define UMFORM_BUILD "unknown"  // CMake says it; tools that parse this file alone do not
#endif

NB_MODULE(_core, m) {
    nb::set_leak_warnings(false);  // functions of users may close over the model: a cycle that ends with the process
    m.doc() = "Kernels of umform: elements, materials, surfaces, contact, sparse patterns.";
    bind_quadrature(m);
    bind_materials(m);
    bind_metals(m);
    bind_foreign(m);
    bind_surfaces(m);
    bind_sparse(m);
    bind_multifrontal(m);
    bind_blocks(m);
    bind_contact(m);
    bind_loads(m);
    m.def("build", [] { return UMFORM_BUILD; }, "Compiler, kind of build and instruction set of the kernels.");
    m.def("threads", [] { return umform::thread_count().load(); }, "Number of threads that the kernels use.");
    m.def(
        "set_threads",
        [](int count) {
            if (count < 1) throw std::invalid_argument("at least one thread");
            umform::thread_count() = count;
        },
        nb::arg("count"), "Set the number of threads that the kernels use.");
}
