// Number of threads of all kernels, and the loop over colours that gives the same sums for any number of them.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <vector>

#ifdef _OPENMP
    #include <omp.h>
#endif

namespace umform {

inline int& thread_count() {
#ifdef _OPENMP
    static int count = omp_get_max_threads();
#else
    static int count = 1;
#endif
    return count;
}

inline int thread_index() {
#ifdef _OPENMP
    return omp_get_thread_num();
#else
    return 0;
#endif
}

/// Calls work(element, thread) for every element, colour after colour. Small sets run on one thread: starting a team
/// costs more than it brings. The first exception (a user's function may throw) ends the work and is thrown again outside
/// of the team.
template <class Work>
void for_each_by_colour(const std::vector<std::vector<std::int32_t>>& colours, int size, const Work& work) {
    constexpr int worth_a_team = 256;
    [[maybe_unused]] const int threads = size < worth_a_team ? 1 : thread_count();
    std::exception_ptr thrown;
    std::atomic<bool> stopped{false};
    const auto guarded = [&](std::int32_t element, int thread) {
        if (stopped.load(std::memory_order_relaxed)) return;
        try {
            work(element, thread);
        } catch (...) {
            stopped = true;
#pragma omp critical
            if (!thrown) thrown = std::current_exception();
        }
    };
#pragma omp parallel num_threads(threads) if (threads > 1)
    {
        const int thread = thread_index();
        for (const auto& colour : colours) {
            const int count = static_cast<int>(colour.size());
#pragma omp for schedule(static)
            for (int k = 0; k < count; ++k) guarded(colour[k], thread);
        }
    }
    if (thrown) std::rethrow_exception(thrown);
}

}  // namespace umform
