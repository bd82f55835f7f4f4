// The extension module umform._core.
#include "arrays.hpp"
#include "umform/assembly/threads.hpp"

#ifndef UMFORM_BUILD
    #define UMFORM_BUILD "unknown"  // CMake says it; tools that parse this file alone do not
#endif

#if defined(_WIN32)
extern "C" __declspec(dllimport) int __stdcall IsProcessorFeaturePresent(unsigned long feature);
#endif

namespace {

#if defined(UMFORM_X86_64_V3) && defined(__x86_64__)
/// Whether this processor has AVX2 and FMA; Windows is asked for AVX2 only.
bool has_instructions() {
    #if defined(_WIN32)                         // clang for Windows has no library for the question below
    return IsProcessorFeaturePresent(40) != 0;  // PF_AVX2_INSTRUCTIONS_AVAILABLE
    #else
    __builtin_cpu_init();
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    #endif
}
#endif

/// Kernels are compiled for an instruction set; this file alone is not, so that a processor without it gets a sentence.
void require_instructions() {
#if defined(UMFORM_X86_64_V3) && defined(__x86_64__)
    if (!has_instructions())
        throw std::runtime_error(
            "this umform is built for processors with AVX2 and FMA (x86-64-v3), which this one lacks; "
            "build it from source with: pip install --no-binary umform umform -C cmake.define.UMFORM_ARCH=");
#endif
}

int default_threads() { return nb::cast<int>(nb::module_::import_("umform.processors").attr("threads")()); }

}  // namespace

NB_MODULE(_core, m) {
    require_instructions();
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
    bind_sheets(m);
    m.def("build", [] { return UMFORM_BUILD; }, "Compiler, kind of build and instruction set of the kernels.");
    umform::thread_count() = default_threads();
    m.def(
        "threads", [] { return umform::thread_count().load(); },
        "Number of threads that the kernels use; by default one for each free processor, or OMP_NUM_THREADS.");
    m.def(
        "set_threads",
        [](int count) {
            if (count < 1) throw std::invalid_argument("at least one thread");
            umform::thread_count() = count;
        },
        nb::arg("count"), "Set the number of threads that the kernels use.");
}
